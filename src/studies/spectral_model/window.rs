//! Local spectra with any window length and bin spacing: the product's own model with its two
//! numbers let free.
//!
//! As `surface::SpectralPlan`: a periodic Hamming window, the weighted mean taken off, one-sided
//! powers `P_k = 2|X_k|²/(n_w Σw²)`. Bins closer than one over the window's length share its power:
//! they are scaled by spacing × length, so that `√(2 Σ P)` stays a sinusoid's amplitude.

use std::f64::consts::TAU;

use super::surfaces::Surface;
use crate::readable::whole;
use selvedge_foundation::numerics::{ChirpTransform, Complex, RealTransform};
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ};

/// The highest wavenumber of any model, cycles/mm.
const HIGHEST_PER_MM: f64 = 115.0;

/// A window and the bins behind it.
#[derive(Debug, Clone)]
pub(super) struct Model {
    /// Distance between bins, cycles/mm.
    spacing_per_mm: f64,
    window: Vec<f64>,
    transform: Transform,
    scale: f64,
}

#[derive(Debug, Clone)]
enum Transform {
    Plain(RealTransform),
    Chirp(ChirpTransform),
}

impl Model {
    /// The model for profiles sampled every `step_mm`; the window is rounded to whole samples.
    pub(super) fn new(step_mm: f64, window_mm: f64, spacing_per_mm: f64) -> Self {
        let n_window = whole(window_mm / step_mm + 0.5).max(2);
        let n_bins = whole(HIGHEST_PER_MM / spacing_per_mm + 1e-6);
        let hamming = |i: usize| 0.54 - 0.46 * (TAU * i as f64 / n_window as f64).cos();
        let window: Vec<f64> = (0..n_window).map(hamming).collect();
        let own_spacing = 1.0 / (n_window as f64 * step_mm);
        let is_plain = (own_spacing / spacing_per_mm - 1.0).abs() < 1e-9;
        let transform = if is_plain {
            Transform::Plain(RealTransform::new(n_window))
        } else {
            Transform::Chirp(ChirpTransform::new(
                n_window,
                n_bins + 1,
                spacing_per_mm * step_mm,
            ))
        };
        let squares: f64 = window.iter().map(|w| w * w).sum();
        let share = spacing_per_mm / own_spacing;
        Self {
            spacing_per_mm,
            scale: 2.0 * share / (n_window as f64 * squares),
            window,
            transform,
        }
    }

    /// Number of samples in a window.
    pub(super) fn n_window(&self) -> usize {
        self.window.len()
    }

    /// Powers of bins 1, 2, … of one window of heights in µm, µm².
    pub(super) fn powers_um2(&self, heights_um: &[f64]) -> Vec<f64> {
        let pairs = || self.window.iter().zip(heights_um);
        let mean = pairs().map(|(w, z)| w * z).sum::<f64>() / self.window.iter().sum::<f64>();
        let weighted: Vec<f64> = pairs().map(|(w, z)| w * (z - mean)).collect();
        let spectrum = match &self.transform {
            Transform::Plain(transform) => transform.forward(&weighted),
            Transform::Chirp(transform) => transform.forward(&weighted),
        };
        let n_bins = whole(HIGHEST_PER_MM / self.spacing_per_mm + 1e-6);
        let bins = spectrum.iter().skip(1).take(n_bins);
        bins.map(|x: &Complex| self.scale * x.norm_sqr()).collect()
    }

    /// Powers at places along a surface, so many to a mm, as far as windows fit.
    pub(super) fn powers_along(&self, surface: &Surface, per_mm: f64) -> Vec<Vec<f64>> {
        let slack = surface.heights_um.len().saturating_sub(self.n_window());
        let start = |n: u16| whole(f64::from(n) / per_mm / surface.step_mm + 0.5);
        let starts = (0..).map(start).take_while(|start| *start <= slack);
        let window = |start: usize| &surface.heights_um[start..start + self.n_window()];
        starts.map(|start| self.powers_um2(window(start))).collect()
    }

    /// `[A40², A320²]` of powers at a speed, µm².
    pub(super) fn squared_amplitudes_um2(
        &self,
        powers_um2: &[f64],
        speed_mm_per_s: f64,
        filters: &Filters,
    ) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (k, power) in (1..).zip(powers_um2) {
            let frequency_hz = speed_mm_per_s * self.spacing_per_mm * f64::from(k);
            if frequency_hz >= MAX_FREQUENCY_HZ {
                break;
            }
            for band in Band::ALL {
                sums[band.index()] += 2.0 * power * filters.power_gain(band, frequency_hz);
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;
    use selvedge_textile::surface::{BIN_SPACING_PER_MM, LocalSpectra, Profile, WINDOW_LENGTH_MM};

    #[test]
    fn with_the_products_numbers_it_is_the_products_model() {
        let mut random = Random::new(2);
        let heights: Vec<f64> = (0..4600).map(|_| random.normal()).collect();
        let profile = Profile::new(1.0 / 230.0, heights.clone()).unwrap();
        let spectra = LocalSpectra::of(&profile, false).unwrap();
        let model = Model::new(1.0 / 230.0, WINDOW_LENGTH_MM, BIN_SPACING_PER_MM);
        assert_eq!(model.n_window(), 1000);
        let powers = model.powers_um2(&heights[3 * 230..3 * 230 + 1000]);
        assert_eq!(powers.len(), 500);
        for (k, (ours, theirs)) in powers
            .iter()
            .zip(spectra.powers_um2(3))
            .enumerate()
            .take(499)
        {
            assert!(
                (ours - theirs).abs() < 1e-12,
                "bin {}: {ours} and {theirs}",
                k + 1
            );
        }
    }

    #[test]
    fn a_short_wave_has_its_amplitude_whatever_window_and_spacing() {
        let wave = |i: u32| 3.0 * (TAU * f64::from(i) / 230.0 * 4.0 + 0.4).sin();
        let heights: Vec<f64> = (0..4600).map(wave).collect();
        for (window_mm, spacing_per_mm) in [
            (2.0, 0.5),
            (2.0, 0.23),
            (3.79, 0.23),
            (8.0, 0.125),
            (8.0, 0.05),
            (16.0, 0.0625),
        ] {
            let model = Model::new(1.0 / 230.0, window_mm, spacing_per_mm);
            let powers = model.powers_um2(&heights[100..100 + model.n_window()]);
            let amplitude = (2.0 * powers.iter().sum::<f64>()).sqrt();
            assert!(
                (amplitude - 3.0).abs() < 0.02,
                "{window_mm} mm: {amplitude} µm"
            );
        }
    }
}
