//! The lattice drawn over the picture.

use super::basis::{Basis, Place, length, whole};
use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::{Grid, to_byte};

/// Pictures are enlarged by a whole factor until a cell measures this.
const CELL_PX: f64 = 30.0;
/// Of what is larger than this then, the middle is shown.
const MAX_SIDE: usize = 2000;
/// Lines of either family, and how much of the picture they cover.
const FIRST: [f64; 3] = [255.0, 176.0, 0.0];
const SECOND: [f64; 3] = [0.0, 190.0, 230.0];
const COVER: f64 = 0.75;

/// The picture with the lines of a lattice, one corner of a cell in its middle.
///
/// Amber along p1, cyan along p2; without a lattice the picture alone. Fine cells are enlarged by a
/// whole factor, and of what becomes too large the middle is shown.
pub fn overlay(luminance: &Grid<f64>, lattice: Option<Basis>) -> Rgb8Image {
    let cell = lattice.map_or(CELL_PX, |basis| basis.shorter());
    let factor = whole((CELL_PX / cell).ceil()).clamp(1, 12).cast_unsigned();
    let size = [luminance.width(), luminance.height()];
    let max = if factor > 1 {
        MAX_SIDE / factor
    } else {
        usize::MAX
    };
    let shown = size.map(|n| n.min(max));
    let first = [0, 1].map(|i| (size[i] - shown[i]) / 2);
    let (low, high) = range(luminance);
    let mut pixels = Vec::with_capacity(shown[0] * shown[1] * factor * factor);
    for y in 0..shown[1] * factor {
        let row = luminance.row(first[1] + y / factor);
        for x in 0..shown[0] * factor {
            let grey = 255.0 * (row[first[0] + x / factor] - low) / (high - low);
            let mut colour = [grey; 3];
            if let Some(basis) = lattice {
                // From the middle of what is shown, in the picture's own pixels.
                let at =
                    |n: usize, i: usize| (n as f64 + 0.5) / factor as f64 - 0.5 * shown[i] as f64;
                for (line, share) in on_lines(&basis, [at(x, 0), at(y, 1)], factor) {
                    for (c, l) in colour.iter_mut().zip(line) {
                        *c += COVER * share * (l - *c);
                    }
                }
            }
            pixels.push(colour.map(|value| to_byte(value.round())));
        }
    }
    Rgb8Image {
        width: shown[0] * factor,
        height: shown[1] * factor,
        pixels,
    }
}

/// The lines that a place lies on, and how much of them.
fn on_lines(basis: &Basis, place: Place, factor: usize) -> [([f64; 3], f64); 2] {
    let [u, v] = basis.coordinates(place);
    // Distance of neighbouring lines along p1 and along p2, px.
    let apart = [
        basis.area() / length(basis.p1),
        basis.area() / length(basis.p2),
    ];
    let share = |t: f64, apart: f64| {
        let off = (t - t.round()).abs() * apart * factor as f64;
        (1.0 - off).clamp(0.0, 1.0)
    };
    [(FIRST, share(v, apart[0])), (SECOND, share(u, apart[1]))]
}

/// The range of all but the most extreme values, so that contrast shows.
pub fn range(grid: &Grid<f64>) -> (f64, f64) {
    let every = (grid.values().len() / 20_000).max(1);
    let mut some: Vec<f64> = grid.values().iter().step_by(every).copied().collect();
    some.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let index = whole(share * (some.len().max(1) - 1) as f64).cast_unsigned();
        some.get(index).copied().unwrap_or(0.0)
    };
    let (low, high) = (at(0.005), at(0.995));
    if high > low {
        (low, high)
    } else {
        (low - 0.5, low + 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_cross_in_the_middle_and_the_picture_shows_between() {
        let grey = Grid::filled(41, 41, 0.5);
        let basis = Basis::new([30.0, 0.0], [0.0, 30.0]);
        let drawn = overlay(&grey, Some(basis));
        assert_eq!((drawn.width, drawn.height), (41, 41));
        let at = |x: usize, y: usize| drawn.pixels[y * 41 + x];
        assert_ne!(at(20, 5), [128; 3], "a line along p2");
        assert_ne!(at(5, 20), at(20, 5), "the two families differ");
        assert_eq!(at(10, 10), [128; 3], "between lines");
        let alone = overlay(&grey, None);
        assert!(
            alone.pixels.iter().all(|p| *p == [128; 3]),
            "no lattice, no lines"
        );
        let small = overlay(&grey, Some(Basis::new([6.0, 0.0], [0.0, 6.0])));
        assert_eq!(small.width, 5 * 41, "enlarged until cells can be seen");
    }
}
