//! Local spectra: the power of a profile by wavenumber, every millimetre along it.
//!
//! After Philpott & Summers (2012), section 2.2: 0.23 to 115 cycles/mm, a Hamming window of about
//! 2 mm effective width. The window is 1000/230 mm long (full width at half maximum 2.29 mm),
//! periodic, and no longer than the transform: no zero padding, no resampling, no line fit.

use std::f64::consts::TAU;

use super::{Profile, SurfaceError};
use selvedge_foundation::numerics::{ChirpTransform, Complex, RealTransform, to_index};

/// Number of bins: wavenumbers 0.23 k cycles/mm, k = 1 … 500.
pub const N_BINS: usize = 500;
/// Distance between bins, cycles/mm.
pub const BIN_SPACING_PER_MM: f64 = 0.23;
/// Length of the window, mm.
pub const WINDOW_LENGTH_MM: f64 = 1000.0 / 230.0;

/// What the spectra of all profiles with the same step share: window and transform.
#[derive(Debug, Clone)]
pub(crate) struct SpectralPlan {
    step_mm: f64,
    window: Vec<f64>,
    transform: Transform,
}

#[derive(Debug, Clone)]
enum Transform {
    /// The window holds a whole number of steps: bins are those of a plain DFT.
    Plain(RealTransform),
    /// It does not: the sum is evaluated at the bins' own spacing.
    Chirp(ChirpTransform),
}

impl SpectralPlan {
    /// The plan for profiles sampled every `step_mm`.
    pub(crate) fn new(step_mm: f64) -> Self {
        Self::with_bins(step_mm, N_BINS)
    }

    /// The same for the first `n_bins` bins only.
    pub(super) fn with_bins(step_mm: f64, n_bins: usize) -> Self {
        let samples = WINDOW_LENGTH_MM / step_mm;
        let n_window = to_index(samples + 0.5);
        let hamming = |i: usize| 0.54 - 0.46 * (TAU * i as f64 / samples).cos();
        let is_whole = (samples - n_window as f64).abs() < 1e-9 * samples;
        let transform = if is_whole {
            Transform::Plain(RealTransform::new(n_window))
        } else {
            let spacing = BIN_SPACING_PER_MM * step_mm;
            Transform::Chirp(ChirpTransform::new(n_window, n_bins + 1, spacing))
        };
        Self {
            step_mm,
            window: (0..n_window).map(hamming).collect(),
            transform,
        }
    }

    /// Number of samples in one window.
    pub(crate) fn n_window(&self) -> usize {
        self.window.len()
    }

    /// One-sided powers `P_k = 2|X_k|²/(n_w Σw²)`, k = 1 … 500, in µm², of one window of heights
    /// in µm; zero above the Nyquist wavenumber, halved at it.
    ///
    /// `Σ_k P_k` is the w²-weighted mean square about the w-weighted mean; a sinusoid's amplitude
    /// is `√(2 Σ P)`.
    pub(super) fn powers_um2(&self, heights_um: &[f64], powers: &mut [f64]) {
        // Heights relative to the first one: a flat profile is silent to the last bit.
        let first = heights_um[0];
        let pairs = || {
            self.window
                .iter()
                .zip(heights_um.iter().map(|height| height - first))
        };
        let mean = pairs().map(|(w, z)| w * z).sum::<f64>() / self.window.iter().sum::<f64>();
        let weighted: Vec<f64> = pairs().map(|(w, z)| w * (z - mean)).collect();
        let spectrum = match &self.transform {
            Transform::Plain(transform) => transform.forward(&weighted),
            Transform::Chirp(transform) => transform.forward(&weighted),
        };
        let squares: f64 = self.window.iter().map(|w| w * w).sum();
        let scale = 2.0 / (self.window.len() as f64 * squares);
        let nyquist_per_mm = 0.5 / self.step_mm;
        for (k, power) in (1_u16..).zip(powers) {
            let wavenumber_per_mm = BIN_SPACING_PER_MM * f64::from(k);
            let is_heard = wavenumber_per_mm <= nyquist_per_mm * (1.0 + 1e-9);
            let bin = spectrum.get(usize::from(k)).filter(|_| is_heard);
            *power = scale * bin.map_or(0.0, Complex::norm_sqr);
        }
    }

    /// Whether bin 500 is the Nyquist bin, which a one-sided spectrum must not count twice.
    pub(super) fn ends_at_nyquist(&self) -> bool {
        let last_per_mm = BIN_SPACING_PER_MM * N_BINS as f64;
        (0.5 / self.step_mm - last_per_mm).abs() < 1e-9 * last_per_mm
    }
}

/// Spectra at points 1 mm apart: along a profile, or over an area along many profiles side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalSpectra {
    /// Points × bins, row by row, µm².
    powers_um2: Vec<f64>,
    /// Bins kept at every point: all, or those up to the Nyquist wavenumber.
    n_bins: usize,
    /// Points along the direction; across it there are as many as fill the rest.
    n_along: usize,
    /// The largest power of any point.
    largest_um2: f64,
}

impl LocalSpectra {
    /// The spectra of a profile. Points are numbered along the forward axis: point j of a reverse
    /// profile covers the same textile as point j of the forward one.
    ///
    /// # Errors
    /// A profile shorter than one window.
    pub fn of(profile: &Profile, is_reverse: bool) -> Result<Self, SurfaceError> {
        let plan = SpectralPlan::new(profile.step_mm());
        let heights_um = profile.heights_um();
        let (n_samples, n_window) = (heights_um.len(), plan.n_window());
        let Some(slack) = n_samples.checked_sub(n_window).filter(|_| n_samples > 0) else {
            return Err(SurfaceError::TooShort {
                n_samples,
                n_window,
            });
        };
        let starts = starts_of_points(slack, profile.step_mm());
        let mut powers_um2 = vec![0.0; starts.len() * N_BINS];
        for (start, powers) in starts.iter().zip(powers_um2.chunks_exact_mut(N_BINS)) {
            let start = if is_reverse { slack - start } else { *start };
            plan.powers_um2(&heights_um[start..start + n_window], powers);
            if plan.ends_at_nyquist() {
                powers[N_BINS - 1] *= 0.5;
            }
        }
        Ok(Self::over_area(powers_um2, starts.len(), N_BINS))
    }

    /// Spectra over an area: profile by profile a row of `n_along` points, at each point the
    /// powers of its first `n_bins` bins, µm²; bins beyond are 0.
    pub(super) fn over_area(powers_um2: Vec<f64>, n_along: usize, n_bins: usize) -> Self {
        Self {
            largest_um2: largest_um2(&powers_um2, n_bins),
            powers_um2,
            n_bins,
            n_along,
        }
    }

    /// The spectra with a constant power density taken off: `P_k ← max(0, P_k − 0.23·density)`.
    #[must_use]
    pub(crate) fn minus_noise_floor(mut self, noise_floor_um2_mm: f64) -> Self {
        let floor = BIN_SPACING_PER_MM * noise_floor_um2_mm;
        if floor > 0.0 {
            for power in &mut self.powers_um2 {
                *power = (*power - floor).max(0.0);
            }
            self.largest_um2 = largest_um2(&self.powers_um2, self.n_bins);
        }
        self
    }

    /// Number of points, at least one: those along times those across. Point (i, j), i along and
    /// j across the direction, is number `j·n_along + i`.
    pub fn n_points(&self) -> usize {
        self.powers_um2.len() / self.n_bins
    }

    /// Points along the direction, and across it: 1 for a profile.
    pub fn shape(&self) -> [usize; 2] {
        [self.n_along, self.n_points() / self.n_along]
    }

    /// Whether spectra vary across the direction too.
    pub fn is_areal(&self) -> bool {
        self.n_points() > self.n_along
    }

    /// Bins kept at every point, at most 500; those beyond are 0.
    pub fn n_bins(&self) -> usize {
        self.n_bins
    }

    /// The largest power `Σ_k P_k` of any point, µm².
    pub fn largest_um2(&self) -> f64 {
        self.largest_um2
    }

    /// Memory that the powers take, bytes.
    pub fn n_bytes(&self) -> usize {
        size_of_val(&self.powers_um2[..])
    }

    /// The powers at a point, µm²: [`LocalSpectra::n_bins`] values, bin k in slot k − 1.
    ///
    /// # Panics
    /// When `point` is not below [`LocalSpectra::n_points`].
    pub fn powers_um2(&self, point: usize) -> &[f64] {
        &self.powers_um2[point * self.n_bins..(point + 1) * self.n_bins]
    }
}

/// The largest sum of the powers of a point.
fn largest_um2(powers_um2: &[f64], n_bins: usize) -> f64 {
    let points = powers_um2.chunks_exact(n_bins);
    points.map(|bins| bins.iter().sum()).fold(0.0, f64::max)
}

/// The first sample of every point's window: points 1 mm apart, as many as fit into `slack`
/// samples beyond one window.
pub(super) fn starts_of_points(slack: usize, step_mm: f64) -> Vec<usize> {
    let last = to_index(slack as f64 * step_mm + 1e-6);
    (0..=last)
        .map(|j| to_index(j as f64 / step_mm + 0.5).min(slack))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const KES_STEP_MM: f64 = 1.0 / 230.0;

    fn sine(step_mm: f64, n: usize, wavelength_mm: f64) -> Profile {
        let height = |i: usize| (TAU * i as f64 * step_mm / wavelength_mm + 0.3).sin();
        Profile::new(step_mm, (0..n).map(height).collect()).unwrap()
    }

    #[test]
    fn twenty_millimetres_give_sixteen_spectra() {
        let spectra = LocalSpectra::of(&sine(KES_STEP_MM, 4600, 0.5), false).unwrap();
        assert_eq!(spectra.n_points(), 16);
        let one = LocalSpectra::of(&sine(KES_STEP_MM, 1000, 0.5), false).unwrap();
        assert_eq!(one.n_points(), 1);
        let short = LocalSpectra::of(&sine(KES_STEP_MM, 999, 0.5), false).unwrap_err();
        assert_eq!(
            short,
            SurfaceError::TooShort {
                n_samples: 999,
                n_window: 1000
            }
        );
    }

    #[test]
    fn a_sine_has_its_amplitude_whatever_the_step() {
        for step_mm in [KES_STEP_MM, 0.001, 0.005, 0.01, 0.02] {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "small"
            )]
            let n = (20.0 / step_mm) as usize;
            let spectra = LocalSpectra::of(&sine(step_mm, n, 0.5), false).unwrap();
            let power: f64 = spectra.powers_um2(7).iter().sum();
            let amplitude = (2.0 * power).sqrt();
            assert!(
                (amplitude - 1.0).abs() < 0.003,
                "step {step_mm} mm: {amplitude}"
            );
        }
    }

    #[test]
    fn power_sums_to_the_weighted_mean_square() {
        let mut random = selvedge_foundation::numerics::Random::new(5);
        let heights: Vec<f64> = (0..1000).map(|_| random.normal()).collect();
        let profile = Profile::new(KES_STEP_MM, heights.clone()).unwrap();
        let spectra = LocalSpectra::of(&profile, false).unwrap();
        let w = |i: usize| 0.54 - 0.46 * (TAU * i as f64 / 1000.0).cos();
        let (mut sum_w, mut sum_wz, mut sum_ww, mut sum_square) = (0.0, 0.0, 0.0, 0.0);
        for (i, z) in heights.iter().enumerate() {
            sum_w += w(i);
            sum_wz += w(i) * z;
            sum_ww += w(i) * w(i);
        }
        for (i, z) in heights.iter().enumerate() {
            sum_square += (w(i) * (z - sum_wz / sum_w)).powi(2);
        }
        let total: f64 = spectra.powers_um2(0).iter().sum();
        assert!(
            (total / (sum_square / sum_ww) - 1.0).abs() < 1e-12,
            "{total}"
        );
    }

    #[test]
    fn a_reversed_profile_has_the_same_powers_point_for_point() {
        let mut random = selvedge_foundation::numerics::Random::new(6);
        let forward: Vec<f64> = (0..4600).map(|_| random.normal()).collect();
        let reverse: Vec<f64> = forward.iter().rev().copied().collect();
        let of = |heights, is_reverse| {
            let profile = Profile::new(KES_STEP_MM, heights).unwrap();
            LocalSpectra::of(&profile, is_reverse).unwrap()
        };
        let (forward, reverse) = (of(forward, false), of(reverse, true));
        for point in 0..16 {
            let (a, b) = (forward.powers_um2(point), reverse.powers_um2(point));
            let total: f64 = a.iter().sum();
            let difference: f64 = a.iter().zip(b).map(|(x, y)| (x - y).abs()).sum();
            // The periodic window is one sample off its mirror image.
            assert!(
                difference < 0.2 * total,
                "point {point}: {difference} of {total}"
            );
        }
    }

    #[test]
    fn flat_heights_are_silent_and_coarse_steps_end_at_nyquist() {
        for height in [0.0, 7.3, 1e12] {
            let flat = Profile::new(KES_STEP_MM, vec![height; 1500]).unwrap();
            let spectra = LocalSpectra::of(&flat, false).unwrap();
            assert!(
                spectra.powers_um2(0).iter().all(|&p| p == 0.0),
                "height {height} µm"
            );
        }
        let coarse = LocalSpectra::of(&sine(0.1, 100, 0.7), false).unwrap();
        assert!(
            coarse.powers_um2(0)[21..].iter().all(|&p| p == 0.0),
            "Nyquist is 5 /mm"
        );
        assert!(coarse.powers_um2(0)[5] > 0.1, "1.43 /mm lies near bin 6");
    }

    #[test]
    fn a_noise_floor_is_taken_off_every_bin_and_never_below_zero() {
        let spectra = LocalSpectra::of(&sine(KES_STEP_MM, 1000, 0.5), false).unwrap();
        let before = spectra.powers_um2(0).to_vec();
        let after = spectra.minus_noise_floor(0.1);
        for (b, a) in before.iter().zip(after.powers_um2(0)) {
            assert_eq!(*a, (b - 0.23 * 0.1).max(0.0));
        }
    }
}
