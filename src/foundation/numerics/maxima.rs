//! The peak between samples: a quadratic surface by least squares through nine values.

/// The top of a quadratic surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadraticPeak {
    /// Place from the middle sample, in samples: x along a row, y from row to row; within ±1.
    pub offset: [f64; 2],
    /// Height of the surface there; never below the middle sample.
    pub height: f64,
}

impl QuadraticPeak {
    /// The peak of nine samples, rows first, whose middle one is a local maximum. Where the surface
    /// has no top within a sample of the middle (a ridge, a plateau), the middle itself.
    pub fn of(values: &[[f64; 3]; 3]) -> Self {
        let middle = values[1][1];
        let column = |i: usize| values[0][i] + values[1][i] + values[2][i];
        let row = |i: usize| values[i].iter().sum::<f64>();
        let (gx, gy) = ((column(2) - column(0)) / 6.0, (row(2) - row(0)) / 6.0);
        let hxx = (column(0) - 2.0 * column(1) + column(2)) / 3.0;
        let hyy = (row(0) - 2.0 * row(1) + row(2)) / 3.0;
        let hxy = (values[0][0] + values[2][2] - values[0][2] - values[2][0]) / 4.0;
        let determinant = hxx * hyy - hxy * hxy;
        let offset = [
            (hxy * gy - hyy * gx) / determinant,
            (hxy * gx - hxx * gy) / determinant,
        ];
        let is_top = hxx < 0.0 && determinant > 0.0 && offset.iter().all(|x| x.abs() <= 1.0);
        if !is_top {
            return Self {
                offset: [0.0; 2],
                height: middle,
            };
        }
        // The constant of the least-squares surface.
        let sum: f64 = values.iter().flatten().sum();
        let flat = sum / 9.0 - (hxx + hyy) / 3.0;
        let height = flat + 0.5 * (gx * offset[0] + gy * offset[1]);
        Self {
            offset,
            height: height.max(middle),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_a_quadratic_surface_is_exact() {
        let place = [0.3, -0.4];
        let surface = |x: f64, y: f64| {
            let (u, v) = (x - place[0], y - place[1]);
            0.9 - 0.2 * u * u - 0.1 * v * v + 0.05 * u * v
        };
        let row = |y: f64| [-1.0, 0.0, 1.0].map(|x| surface(x, y));
        let peak = QuadraticPeak::of(&[row(-1.0), row(0.0), row(1.0)]);
        assert!((peak.offset[0] - place[0]).abs() < 1e-12, "{peak:?}");
        assert!((peak.offset[1] - place[1]).abs() < 1e-12, "{peak:?}");
        assert!((peak.height - 0.9).abs() < 1e-12, "{peak:?}");
    }

    #[test]
    fn a_plateau_and_a_ridge_stay_at_their_sample() {
        let flat = QuadraticPeak::of(&[[0.5; 3]; 3]);
        assert_eq!((flat.offset, flat.height), ([0.0; 2], 0.5));
        let ridge = QuadraticPeak::of(&[[0.0, 0.5, 0.0]; 3]);
        assert_eq!((ridge.offset, ridge.height), ([0.0; 2], 0.5));
    }
}
