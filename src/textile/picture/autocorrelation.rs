//! The autocorrelation matrix of a picture: how well it agrees with itself, shifted.
//!
//! Correlation coefficients over the overlap alone, for shifts up to half the size; so a picture
//! may be folded onto itself at a period as long as half of it. Very large pictures are correlated
//! over their middle.

use super::basis::{Place, whole};
use selvedge_foundation::files::GrayImage;
use selvedge_foundation::numerics::{Grid, overlap_autocorrelation};

/// Pixels that are correlated at most; of a larger picture the middle.
const MAX_PIXELS: usize = 1 << 24;

/// Correlation coefficients of a picture with itself.
#[derive(Debug, Clone)]
pub struct Autocorrelation {
    /// Columns −reach … reach, rows 0 … reach.
    rho: Grid<f64>,
    reach: [usize; 2],
}

/// The part of a picture of this size that is correlated: x, y, width, height.
pub(crate) fn correlated_part(width: usize, height: usize) -> [usize; 4] {
    if width * height <= MAX_PIXELS {
        return [0, 0, width, height];
    }
    let side = MAX_PIXELS.isqrt();
    let (w, h) = match (width < side, height < side) {
        (true, _) => (width, MAX_PIXELS / width),
        (_, true) => (MAX_PIXELS / height, height),
        _ => (side, side),
    };
    let (w, h) = (w.min(width), h.min(height));
    [(width - w) / 2, (height - h) / 2, w, h]
}

impl Autocorrelation {
    /// Correlates a picture with itself. The same bytes for any number of threads.
    pub fn of(luminance: &Grid<f64>, n_threads: usize) -> Self {
        let (width, height) = (luminance.width(), luminance.height());
        let [x, y, w, h] = correlated_part(width, height);
        let part = if (w, h) == (width, height) {
            None
        } else {
            luminance.part([x, y, w, h])
        };
        let rho = overlap_autocorrelation(part.as_ref().unwrap_or(luminance), n_threads);
        Self {
            rho,
            reach: [w / 2, h / 2],
        }
    }

    /// Largest shift across and down, px.
    pub fn reach(&self) -> [usize; 2] {
        self.reach
    }

    /// The largest shift that is known in every direction, px.
    pub fn radius(&self) -> f64 {
        self.reach[0].min(self.reach[1]) as f64
    }

    /// ρ at a whole shift; `None` beyond the reach.
    pub fn at(&self, dx: isize, dy: isize) -> Option<f64> {
        let (dx, dy) = if dy < 0 { (-dx, -dy) } else { (dx, dy) };
        let column = (dx + self.reach[0].cast_signed()).cast_unsigned();
        let row = dy.cast_unsigned();
        let is_in = column < self.rho.width() && row < self.rho.height();
        is_in.then(|| self.rho.row(row)[column])
    }

    /// ρ between whole shifts, by cubic convolution (Keys); `None` within a pixel of the reach.
    pub fn between(&self, [x, y]: Place) -> Option<f64> {
        let (left, top) = (x.floor(), y.floor());
        let (wx, wy) = (weights(x - left), weights(y - top));
        let (left, top) = (whole(left) - 1, whole(top) - 1);
        let mut sum = 0.0;
        for (j, wy) in (0_isize..).zip(wy) {
            for (i, wx) in (0_isize..).zip(wx) {
                sum += wx * wy * self.at(left + i, top + j)?;
            }
        }
        Some(sum)
    }

    /// The whole matrix as a grey picture, no shift in its middle: −1 is black, 1 white.
    pub fn picture(&self) -> GrayImage {
        let (reach_x, reach_y) = (self.reach[0].cast_signed(), self.reach[1].cast_signed());
        let shifts = (-reach_y..=reach_y).flat_map(|y| (-reach_x..=reach_x).map(move |x| (x, y)));
        let shares = shifts.map(|(x, y)| 0.5 + 0.5 * self.at(x, y).unwrap_or(0.0));
        GrayImage::of_shares(self.reach.map(|reach| 2 * reach + 1), shares)
    }
}

/// Weights of four samples around a place at `t` behind the second (Keys' cubic, a = −1/2).
fn weights(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        -0.5 * t + t2 - 0.5 * t3,
        1.0 - 2.5 * t2 + 1.5 * t3,
        0.5 * t + 2.0 * t2 - 1.5 * t3,
        -0.5 * t2 + 0.5 * t3,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(width: usize, height: usize, period: f64) -> Grid<f64> {
        let values = (0..width * height).map(|i| {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            (std::f64::consts::TAU * (x + 0.5 * y) / period).sin()
        });
        Grid::from_rows(width, values.collect()).unwrap()
    }

    #[test]
    fn a_shift_and_its_opposite_agree_and_none_is_one() {
        let rho = Autocorrelation::of(&waves(40, 31, 9.0), 1);
        assert_eq!(rho.reach(), [20, 15]);
        assert!((rho.at(0, 0).unwrap() - 1.0).abs() < 1e-12, "no shift");
        assert_eq!(rho.at(7, -3), rho.at(-7, 3));
        assert_eq!(rho.at(21, 0), None);
        assert!((rho.at(9, 0).unwrap() - 1.0).abs() < 1e-9, "a period");
    }

    #[test]
    fn values_between_shifts_follow_the_wave() {
        let rho = Autocorrelation::of(&waves(200, 200, 12.5), 2);
        let at = rho.between([12.5, 0.0]).unwrap();
        assert!((at - 1.0).abs() < 0.01, "{at}");
        assert_eq!(rho.between([99.5, 0.0]), None);
    }

    #[test]
    fn of_a_large_picture_the_middle_is_correlated() {
        assert_eq!(correlated_part(4096, 4096), [0, 0, 4096, 4096]);
        assert_eq!(correlated_part(8000, 8000), [1952, 1952, 4096, 4096]);
        let [x, y, w, h] = correlated_part(64_000, 1000);
        assert_eq!([y, h], [0, 1000]);
        assert!(w * h <= MAX_PIXELS && x > 0, "{w} × {h} from {x}");
    }

    #[test]
    fn the_picture_of_it_is_white_in_the_middle() {
        let picture = Autocorrelation::of(&waves(20, 12, 6.0), 1).picture();
        assert_eq!((picture.width, picture.height), (21, 13));
        assert_eq!(picture.values[6 * 21 + 10], u16::MAX);
    }
}
