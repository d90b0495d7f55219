//! A height map as tracks side by side: what a wire of some width rides on.

use super::HeightMap;
use selvedge_foundation::numerics::{Grid, to_index};

/// The tracks of a map along u, or along w, missing heights filled.
pub(super) struct Tracks {
    /// A row for every track.
    rows: Grid<f64>,
    /// From one track to the next, mm.
    step_mm: f64,
    is_periodic: bool,
}

impl Tracks {
    pub(super) fn of(map: &HeightMap, is_weft: bool) -> Self {
        let filled = map.filled();
        let rows = if is_weft {
            filled.heights_um().transposed()
        } else {
            filled.heights_um().clone()
        };
        Self {
            rows,
            step_mm: map.step_mm()[usize::from(!is_weft)],
            is_periodic: map.is_periodic(),
        }
    }

    /// Heights along the tracks within a wire's width about a place across them, µm, with
    /// `n_beyond` columns more at both ends: see [`HeightMap::strip`].
    pub(super) fn strip(&self, middle_mm: f64, width_mm: f64, n_beyond: usize) -> Grid<f64> {
        let tracks = self.within(middle_mm, width_mm);
        let n = self.rows.width() + 2 * n_beyond;
        let mut strip = Grid::filled(n, tracks.len(), 0.0);
        for (row, track) in tracks.into_iter().enumerate() {
            let from = self.rows.row(track);
            for (i, height) in strip.row_mut(row).iter_mut().enumerate() {
                *height = from[self.place(i, n_beyond, from.len())];
            }
        }
        strip
    }

    /// The point that a strip's column shows, `n_beyond` columns before the map's first.
    fn place(&self, column: usize, n_beyond: usize, n: usize) -> usize {
        if self.is_periodic {
            // As many whole repeats as reach below zero, added first.
            (column + n_beyond.div_ceil(n) * n - n_beyond) % n
        } else {
            column.saturating_sub(n_beyond).min(n - 1)
        }
    }

    /// The tracks within a wire's width about a place across the stroke; at least one.
    fn within(&self, middle_mm: f64, width_mm: f64) -> Vec<usize> {
        let n = self.rows.height();
        let (middle, half) = (
            to_index(middle_mm / self.step_mm),
            to_index(0.5 * width_mm / self.step_mm),
        );
        if self.is_periodic {
            let n_tracks = (2 * half + 1).min(n);
            let first = middle + n - (half % n);
            (0..n_tracks).map(|i| (first + i) % n).collect()
        } else {
            let middle = middle.min(n - 1);
            (middle.saturating_sub(half)..=(middle + half).min(n - 1)).collect()
        }
    }
}
