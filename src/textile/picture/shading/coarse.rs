//! Coarser tiles of a tile, and finer ones, by their waves: what repeats stays what repeats.

use std::f64::consts::PI;

use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform};

/// Tiles whose halves are shorter than this are not halved, px.
const MIN_SIDE: usize = 32;

/// Sizes to solve a tile at, the coarsest first, its own last.
pub(super) fn sizes(width: usize, height: usize) -> Vec<[usize; 2]> {
    let halved = |[width, height]: &[usize; 2]| {
        let half = [width.div_ceil(2), height.div_ceil(2)];
        (half[0].min(half[1]) >= MIN_SIDE).then_some(half)
    };
    let mut all: Vec<_> = std::iter::successors(Some([width, height]), halved).collect();
    all.reverse();
    all
}

/// A grid that repeats at another number of samples over the same extent: the waves that both can
/// hold, pixels about the middle of their share.
pub(super) fn resampled(grid: &Grid<f64>, [width, height]: [usize; 2]) -> Grid<f64> {
    let (w, h) = (grid.width(), grid.height());
    if (w, h) == (width, height) {
        return grid.clone();
    }
    let from = PlaneTransform::new(w, h).forward(grid);
    let mut to = Grid::filled(width / 2 + 1, height, Complex::default());
    // Waves below the Nyquist frequency of the coarser one.
    let [n_x, n_y] = [w.min(width), h.min(height)].map(|n| n.div_ceil(2));
    let scale = (width * height) as f64 / (w * h) as f64;
    let offset = |n: usize, m: usize| PI * (1.0 / n as f64 - 1.0 / m as f64);
    let [turn_x, turn_y] = [offset(width, w), offset(height, h)];
    let turns_x: Vec<Complex> = (0..n_x)
        .map(|k| Complex::from_polar(scale, k as f64 * turn_x))
        .collect();
    for l in 0..n_y {
        for is_negative in [false, true] {
            let is_same = is_negative && l == 0;
            if is_same {
                continue;
            }
            let row = |n: usize| if is_negative { n - l } else { l };
            let y = if is_negative { -(l as f64) } else { l as f64 };
            let from = from.row(row(h));
            let to = to.row_mut(row(height));
            let turn_y = Complex::from_polar(1.0, y * turn_y);
            for (to, (from, turn_x)) in to.iter_mut().zip(from.iter().zip(&turns_x)) {
                *to = from * turn_x * turn_y;
            }
        }
    }
    PlaneTransform::new(width, height).inverse(to)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn wave(width: usize, height: usize) -> Grid<f64> {
        let at = |i: usize, n: usize| (i as f64 + 0.5) / n as f64;
        let values = (0..width * height).map(|i| {
            let (x, y) = (at(i % width, width), at(i / width, height));
            0.4 + (TAU * (2.0 * x - 3.0 * y) + 0.7).cos() + (TAU * x).sin() * (TAU * y).cos()
        });
        Grid::from_rows(width, values.collect()).unwrap()
    }

    #[test]
    fn waves_that_both_can_hold_stay_where_they_are() {
        for [from, to] in [
            [[40, 33], [20, 17]],
            [[20, 17], [40, 33]],
            [[9, 8], [40, 8]],
        ] {
            let found = resampled(&wave(from[0], from[1]), to);
            let truth = wave(to[0], to[1]);
            for (a, b) in found.values().iter().zip(truth.values()) {
                assert!((a - b).abs() < 1e-9, "{from:?} {to:?}: {a} and {b}");
            }
        }
    }

    #[test]
    fn tiles_are_halved_while_they_are_large_both_ways() {
        assert_eq!(sizes(128, 101), [[32, 26], [64, 51], [128, 101]][1..]);
        assert_eq!(sizes(300, 40), [[300, 40]]);
        assert_eq!(sizes(1, 1), [[1, 1]]);
    }
}
