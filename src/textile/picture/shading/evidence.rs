//! Which model a picture speaks for: shading under a light from some side, or dark is deep.
//!
//! Shading shows the slope towards the light: the power of a wave is that of the relief by
//! `cos²(angle to the light)`; dark is deep shows all directions alike. The logarithm of the finest
//! waves' power over direction is fitted by `b·cos 2(angle − tilt)`, and b compared with what
//! either model leads to expect. What a weave has of directions of its own is in the way of both,
//! which is why b is known to no more than [`SPREAD`].

use std::f64::consts::PI;

use super::shape::mean;
use selvedge_foundation::numerics::{Grid, PlaneTransform, to_index};

/// Sectors of half a turn.
const N_SECTORS: usize = 24;
/// Rings an octave wide, from the highest wavenumber down, and that one in cycles a px: above it
/// slopes are sampled badly and noise rules; below, a weave's own directions do.
const N_RINGS: usize = 2;
const HIGHEST_PER_PX: f64 = 0.25;
/// b under shading by contrast (deviation over mean): steep slopes are dark whichever way they
/// face, self-shadow above all, so that the light's side fades. Within these ends.
const B_BY_CONTRAST: f64 = 0.09;
const B_ENDS: [f64; 2] = [0.2, 1.0];
/// How far b lies from that, or from 0 where dark is deep: a standard deviation over the known
/// cloths of the study of routes.
const SPREAD: f64 = 0.35;

/// What a picture shows of direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Evidence {
    /// Amplitudes of `cos 2a` and `sin 2a` in the logarithm of the power.
    wave: [f64; 2],
    /// b if it is shading.
    expected: f64,
}

impl Evidence {
    /// Of brightness, row 0 the lowest y.
    pub(crate) fn of(brightness: &Grid<f64>) -> Self {
        let (width, height) = (brightness.width(), brightness.height());
        let level = mean(brightness).max(f64::MIN_POSITIVE);
        let contrast = brightness.map(|e| e / level - 1.0);
        let spectrum = PlaneTransform::new(width, height).forward(&contrast);
        // Sum of log power and count, by ring and sector.
        let mut sums = [[[0.0_f64; 2]; N_SECTORS]; N_RINGS];
        for row in 0..height {
            let y = per_px(row, height);
            for (column, f) in spectrum.row(row).iter().enumerate() {
                let x = per_px(column, width);
                let octaves = (HIGHEST_PER_PX / x.hypot(y)).log2();
                if !(0.0..N_RINGS as f64).contains(&octaves) {
                    continue;
                }
                let turn = y.atan2(x).rem_euclid(PI) / PI;
                let sector = to_index(turn * N_SECTORS as f64) % N_SECTORS;
                let sum = &mut sums[to_index(octaves)][sector];
                *sum = [sum[0] + f.norm_sqr().max(1e-12).ln(), sum[1] + 1.0];
            }
        }
        let mut wave = [0.0; 2];
        for (sector, [sum, n]) in sums.iter().flat_map(|ring| ring.iter().enumerate()) {
            let twice = 2.0 * (sector as f64 + 0.5) * PI / N_SECTORS as f64;
            let log = 2.0 * sum / n.max(1.0) / (N_SECTORS * N_RINGS) as f64;
            wave = [wave[0] + log * twice.cos(), wave[1] + log * twice.sin()];
        }
        let squares = contrast.values().iter().map(|c| c * c).sum::<f64>();
        let deviation = (squares / contrast.values().len().max(1) as f64).sqrt();
        let [least, most] = B_ENDS;
        Self {
            wave,
            expected: (B_BY_CONTRAST / deviation.max(1e-9)).clamp(least, most),
        }
    }

    /// Logarithm of the odds for shading under light of a tilt (degrees from +x), against dark is
    /// deep.
    pub(crate) fn log_odds(&self, tilt_deg: f64) -> f64 {
        let (sin, cos) = (2.0 * tilt_deg.to_radians()).sin_cos();
        let b = self.wave[0] * cos + self.wave[1] * sin;
        self.expected * (b - 0.5 * self.expected) / (SPREAD * SPREAD)
    }
}

/// Wavenumber of bin k of n, cycles a px.
fn per_px(k: usize, n: usize) -> f64 {
    let share = k as f64 / n as f64;
    if share > 0.5 { share - 1.0 } else { share }
}
