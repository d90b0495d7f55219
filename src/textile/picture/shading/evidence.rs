//! Which model a picture speaks for: shading under a light from some side, or dark is deep.
//!
//! Shading shows the slope towards the light: the power of a wave is that of the relief by
//! `cos²(angle to the light)`. Dark is deep shows all directions alike. The logarithm of the power
//! over direction, each octave about its own mean, is set beside both. What a weave has of
//! directions of its own is in the way of either alike: where it rules, the residual of both is
//! large and the odds stay even.

use std::f64::consts::PI;

use super::shape::mean;
use selvedge_foundation::numerics::{Grid, PlaneTransform};

/// Sectors of half a turn.
const N_SECTORS: usize = 24;
/// Rings an octave wide, from the highest wavenumber down, and that one in cycles a px: above it
/// slopes are sampled badly and noise rules.
const N_RINGS: usize = 4;
const HIGHEST_PER_PX: f64 = 0.25;
/// Share of the power that is seen across the light: steep slopes, noise.
const ACROSS: f64 = 0.05;
/// Sectors that tell something of their own: what neighbours and rings share counts once.
const N_INDEPENDENT: f64 = 12.0;

/// The power of a picture over direction.
#[derive(Debug, Clone)]
pub(crate) struct Evidence {
    /// Logarithm of the power by sector, about its mean; sector i is at (i + ½)·180°/n from +x.
    log_power: Vec<f64>,
}

impl Evidence {
    /// Of brightness, row 0 the lowest y.
    pub(crate) fn of(brightness: &Grid<f64>) -> Self {
        let (width, height) = (brightness.width(), brightness.height());
        let level = mean(brightness).max(f64::MIN_POSITIVE);
        let transform = PlaneTransform::new(width, height);
        let spectrum = transform.forward(&brightness.map(|e| e / level - 1.0));
        // Sum of log power and count, by ring and sector.
        let mut sums = vec![[0.0_f64; 2]; N_RINGS * N_SECTORS];
        for row in 0..height {
            let y = signed(row, height);
            for (column, f) in spectrum.row(row).iter().enumerate() {
                let x = signed(column, width);
                let octaves = (HIGHEST_PER_PX / x.hypot(y)).log2();
                if !(0.0..N_RINGS as f64).contains(&octaves) {
                    continue;
                }
                let turn = y.atan2(x).rem_euclid(PI) / PI;
                let sector = (turn * N_SECTORS as f64) as usize % N_SECTORS;
                let sum = &mut sums[octaves as usize * N_SECTORS + sector];
                *sum = [sum[0] + f.norm_sqr().max(1e-12).ln(), sum[1] + 1.0];
            }
        }
        let mut log_power = vec![0.0; N_SECTORS];
        for ring in sums
            .chunks(N_SECTORS)
            .filter(|ring| ring.iter().all(|sum| sum[1] > 0.0))
        {
            let by_sector: Vec<f64> = ring.iter().map(|[sum, n]| sum / n).collect();
            let middle = by_sector.iter().sum::<f64>() / N_SECTORS as f64;
            for (sum, log) in log_power.iter_mut().zip(by_sector) {
                *sum += (log - middle) / N_RINGS as f64;
            }
        }
        Self { log_power }
    }

    /// Logarithm of the odds for shading under light of a tilt (degrees from +x), against dark is
    /// deep.
    pub(crate) fn log_odds(&self, tilt_deg: f64) -> f64 {
        let seen = |sector: usize| {
            let angle = (sector as f64 + 0.5) * PI / N_SECTORS as f64 - tilt_deg.to_radians();
            (angle.cos().powi(2) + ACROSS).ln()
        };
        let expected: Vec<f64> = (0..N_SECTORS).map(seen).collect();
        let [shading, deep] = [1.0, 0.0].map(|factor| self.misfit(&expected, factor));
        0.5 * N_INDEPENDENT * (deep / shading).ln()
    }

    /// Mean square of what a model of the power over direction leaves.
    fn misfit(&self, expected: &[f64], factor: f64) -> f64 {
        let n = N_SECTORS as f64;
        let middle = expected.iter().sum::<f64>() / n;
        let left = self.log_power.iter().zip(expected);
        let squares = left.map(|(log, e)| (log - factor * (e - middle)).powi(2));
        squares.sum::<f64>() / n + 1e-3
    }
}

/// Wavenumber of bin k of n, cycles a px.
fn signed(k: usize, n: usize) -> f64 {
    let k = k as f64;
    let n = n as f64;
    if 2.0 * k > n { k / n - 1.0 } else { k / n }
}
