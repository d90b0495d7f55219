//! What makes one place of a textile differ from another: smooth random variation on a torus.
//!
//! A model textile has no edge: it repeats after its size, so its picture tiles and its yarns close
//! on themselves. Every variation here is periodic too. All have mean 0 and variance 1 (over the
//! draws), so a recipe's figure is the standard deviation that it says.

use selvedge_foundation::numerics::{Random, to_index};

/// Smooth normal noise on a circle, sampled evenly and interpolated.
#[derive(Debug, Clone)]
pub(crate) struct Drift {
    length: f64,
    values: Vec<f64>,
}

impl Drift {
    /// Noise on a circle of `length` whose autocorrelation falls to 1/e after about
    /// `correlation` (the same unit).
    pub(crate) fn new(length: f64, correlation: f64, random: &mut Random) -> Self {
        let n = count(8.0 * length / correlation.max(1e-3 * length)).clamp(8, 4096);
        let white: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let spacing = length / n as f64;
        Self {
            length,
            values: smooth(&white, correlation / (2.0 * spacing)),
        }
    }

    /// The noise at a place of the circle.
    pub(crate) fn at(&self, place: f64) -> f64 {
        let (i, share) = cell(place / self.length, self.values.len());
        let next = self.values[(i + 1) % self.values.len()];
        self.values[i] + (next - self.values[i]) * share
    }
}

/// Smooth normal noise over a torus.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    size: [f64; 2],
    rows: Vec<Vec<f64>>,
}

impl Field {
    /// Noise over a torus of `size` with a correlation length (all mm).
    pub(crate) fn new(size: [f64; 2], correlation: f64, random: &mut Random) -> Self {
        let n = size.map(|length| count(5.0 * length / correlation).clamp(6, 160));
        let deviation = |axis: usize| correlation * n[axis] as f64 / (2.0 * size[axis]);
        let white: Vec<Vec<f64>> = (0..n[1])
            .map(|_| (0..n[0]).map(|_| random.normal()).collect())
            .collect();
        let along: Vec<Vec<f64>> = white.iter().map(|row| smooth(row, deviation(0))).collect();
        let column = |x: usize| along.iter().map(|row| row[x]).collect::<Vec<_>>();
        let across: Vec<Vec<f64>> = (0..n[0])
            .map(|x| smooth(&column(x), deviation(1)))
            .collect();
        let rows = (0..n[1])
            .map(|y| across.iter().map(|column| column[y]).collect())
            .collect();
        Self { size, rows }
    }

    /// The noise at (u, w), mm.
    pub(crate) fn at(&self, u_mm: f64, w_mm: f64) -> f64 {
        let (y, share_y) = cell(w_mm / self.size[1], self.rows.len());
        let (x, share_x) = cell(u_mm / self.size[0], self.rows[0].len());
        let in_row = |row: &[f64]| row[x] + (row[(x + 1) % row.len()] - row[x]) * share_x;
        let (low, high) = (
            in_row(&self.rows[y]),
            in_row(&self.rows[(y + 1) % self.rows.len()]),
        );
        low + (high - low) * share_y
    }
}

/// Periodic Gaussian smoothing by a standard deviation in samples that keeps white noise's
/// variance.
fn smooth(white: &[f64], deviation: f64) -> Vec<f64> {
    let n = white.len();
    let reach = count(3.0 * deviation).clamp(1, n / 2);
    let weight = |k: usize| (-0.5 * (k as f64 / deviation.max(1e-6)).powi(2)).exp();
    let weights: Vec<f64> = (0..=reach).map(weight).collect();
    let energy = 1.0 + 2.0 * weights[1..].iter().map(|w| w * w).sum::<f64>();
    let scale = 1.0 / energy.sqrt();
    let at = |i: usize| {
        let sides = (1..=reach).map(|k| weights[k] * (white[(i + k) % n] + white[(i + n - k) % n]));
        scale * (white[i] + sides.sum::<f64>())
    };
    (0..n).map(at).collect()
}

/// The sample before a place (in turns of the circle) and the share of the way to the next.
fn cell(turns: f64, n: usize) -> (usize, f64) {
    let x = turns.rem_euclid(1.0) * n as f64;
    let i = count(x.floor()).min(n - 1);
    (i, x - i as f64)
}

/// A non-negative number as a count; 0 for what is none.
pub(crate) fn count(x: f64) -> usize {
    to_index(x.ceil())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variation_closes_on_itself_and_has_unit_variance() {
        let mut random = Random::new(5);
        let (mut sum, mut n) = (0.0, 0.0);
        for _ in 0..40 {
            let drift = Drift::new(24.0, 3.0, &mut random);
            assert!(
                (drift.at(0.0) - drift.at(24.0)).abs() < 1e-12,
                "a circle has no seam"
            );
            assert!((drift.at(1.0) - drift.at(1.01)).abs() < 0.1, "smooth");
            sum += (0..240)
                .map(|i| drift.at(f64::from(i) * 0.1).powi(2))
                .sum::<f64>();
            n += 240.0;
        }
        assert!((sum / n - 1.0).abs() < 0.15, "variance {}", sum / n);
        let field = Field::new([22.0, 25.0], 4.0, &mut random);
        assert!(
            (field.at(-1.0, 3.0) - field.at(21.0, 28.0)).abs() < 1e-12,
            "a torus has no seam"
        );
    }
}
