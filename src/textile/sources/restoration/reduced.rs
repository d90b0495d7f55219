//! Data reduction and restoration of one profile.

use std::f64::consts::TAU;

use super::period::{line, period};
use crate::error::TextileError;
use crate::recipe::{Group, KeySpec, keys, parameters_of};
use crate::surface::{Profile, mean_deviation};
use selvedge_foundation::numerics::{
    Complex, Random, RealTransform, bisected, to_index, without_line,
};

/// Bands an octave of the residual.
const BANDS_PER_OCTAVE: f64 = 3.0;
/// A harmonic is kept if its power exceeds that between the harmonics this many times.
const OVER_NOISE: f64 = 4.0;
/// Most harmonics that are looked at.
const MAX_HARMONICS: u32 = 100;
/// Fewest samples of a profile.
const MIN_SAMPLES: usize = 64;

keys! {
    /// What is kept of a profile: a few dozen numbers for thousands of samples.
    table pub Reduced {
        /// Mean absolute deviation of the profile, µm: what the restored one is brought to.
        pub smd_um: f64
            => "Roughness SMD" 0.0 ..= 1e5 "µm" "What the restored profile is brought to",
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub period_mm: Option<f64>
            => "Period" 1e-3 ..= 1e3 "mm" "The period of its harmonics",
        /// Strongest first.
        #[serde(default)]
        pub harmonics: Vec<u32>
            => "Harmonics" 1.0 ..= 100_000.0 "" "Which harmonics of the period are kept",
        #[serde(default)]
        pub amplitude_um: Vec<f64>
            => "Amplitudes" 0.0 ..= 1e5 "µm" "Amplitudes of the harmonics",
        /// Of `A cos(2πkx/p + φ)`.
        #[serde(default)]
        pub(crate) phase_deg: Vec<f64>
            => "Phases" -1e6 ..= 1e6 "°" "Phases of the harmonics",
        pub(crate) residual_from_per_mm: f64
            => "Residual from" 1e-4 ..= 1e3 "/mm"
            "Where the first band of the residual begins, cycles per mm",
        #[serde(default)]
        pub(crate) residual_um: Vec<f64>
            => "Residual" 0.0 ..= 1e5 "µm" "The residual in bands of a third of an octave, rms",
    }
}

impl Reduced {
    /// Reduces a profile to at most `n_harmonics` harmonics and the spectrum of the rest.
    ///
    /// # Errors
    /// Fewer than 64 samples.
    pub fn of(profile: &Profile, n_harmonics: usize) -> Result<Self, TextileError> {
        let n = profile.heights_um().len();
        if n < MIN_SAMPLES {
            return Err(TextileError::Model(format!(
                "{n} samples are no profile to restore; give {MIN_SAMPLES} or more"
            )));
        }
        let step_mm = profile.step_mm();
        let heights = without_line(profile.heights_um());
        let mut reduced = Self {
            smd_um: mean_deviation(&heights),
            period_mm: None,
            harmonics: Vec::new(),
            amplitude_um: Vec::new(),
            phase_deg: Vec::new(),
            residual_from_per_mm: 0.5 / (n as f64 * step_mm),
            residual_um: Vec::new(),
        };
        if let Some(period) = period(&heights) {
            reduced.period_mm = Some(period * step_mm);
            reduced.keep_harmonics(&heights, period, n_harmonics);
        }
        let waves = reduced.waves_um(n, step_mm);
        let rest: Vec<f64> = heights
            .iter()
            .zip(&waves)
            .map(|(z, wave)| z - wave)
            .collect();
        reduced.residual_um = band_rms_um(&rest, step_mm, reduced.residual_from_per_mm);
        Ok(reduced)
    }

    /// Its parameters as those of a table.
    pub(super) fn group(table: &'static str, title: &'static str) -> Group {
        let first = &["smd_um", "period_mm", "residual_from_per_mm"];
        let parameters = parameters_of(table, Self::KEYS, first);
        Group { title, parameters }
    }

    fn keep_harmonics(&mut self, heights: &[f64], period: f64, n_harmonics: usize) {
        let n_whole = to_index(((heights.len() as f64 / period).floor() * period).round());
        let whole = &heights[..n_whole.min(heights.len())];
        let at = |k: f64| line(whole, k / period);
        let harmonics = 1..=MAX_HARMONICS;
        let all: Vec<u32> = harmonics
            .take_while(|&k| 2.0 * f64::from(k) < period)
            .collect();
        // Between harmonics there is noise alone.
        let between = |k: &u32| at(f64::from(*k) - 0.5).norm_sqr();
        let past = all.len() as f64 + 0.5;
        let mut gaps: Vec<f64> = all.iter().map(between).collect();
        gaps.push(at(past).norm_sqr());
        let kept = |(gap, &k): (&[f64], &u32)| {
            let (here, noise) = (at(f64::from(k)), 0.5 * (gap[0] + gap[1]));
            let power = here.norm_sqr();
            (power > OVER_NOISE * noise).then(|| (k, (power - noise).sqrt(), here.arg()))
        };
        let pairs = gaps.windows(2).zip(&all);
        let mut found: Vec<(u32, f64, f64)> = pairs.filter_map(kept).collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        let strongest = found.first().map_or(0.0, |wave| wave.1);
        found.retain(|wave| wave.1 > 1e-6 * strongest);
        for (k, amplitude_um, phase) in found.into_iter().take(n_harmonics) {
            self.harmonics.push(k);
            self.amplitude_um.push(amplitude_um);
            self.phase_deg.push(phase.to_degrees());
        }
    }

    /// What is wrong with it, if anything: the key, what, and how to mend it.
    pub fn fault(&self) -> Option<(&'static str, String, String)> {
        let n = self.harmonics.len();
        for (key, found) in [
            ("amplitude_um", self.amplitude_um.len()),
            ("phase_deg", self.phase_deg.len()),
        ] {
            if found != n {
                let what = format!("{key} has {found} values, harmonics {n}");
                return Some((key, what, "give one a harmonic".to_owned()));
            }
        }
        if let Some((key, value, [min, max])) = KeySpec::outside(Self::KEYS, self) {
            let mend = format!("give numbers from {min} to {max}");
            return Some((key, format!("{key} holds {value}"), mend));
        }
        if self.period_mm.is_none() && n > 0 {
            let what = "harmonics of no period".to_owned();
            return Some(("harmonics", what, "add period_mm".to_owned()));
        }
        (self.residual_um.len() > 60).then(|| {
            let what = format!("residual_um has {} bands", self.residual_um.len());
            ("residual_um", what, "give at most 60".to_owned())
        })
    }

    /// The kept harmonics alone, µm.
    pub fn waves_um(&self, n: usize, step_mm: f64) -> Vec<f64> {
        let period_mm = self.period_mm.unwrap_or(f64::INFINITY);
        let waves: Vec<(f64, f64, f64)> = self
            .harmonics
            .iter()
            .zip(self.amplitude_um.iter().zip(&self.phase_deg))
            .map(|(&k, (&a, phase))| (f64::from(k) / period_mm, a, phase.to_radians()))
            .filter(|wave| wave.0 * step_mm < 0.5)
            .collect();
        let height = |i: usize| {
            let x_mm = i as f64 * step_mm;
            let part =
                |&(per_mm, a, phase): &(f64, f64, f64)| a * (TAU * per_mm * x_mm + phase).cos();
            waves.iter().map(part).sum()
        };
        (0..n).map(height).collect()
    }

    /// The restored profile, µm: the harmonics, and noise with the residual's spectrum, as strong
    /// as brings the whole to the measured SMD. Harmonics that are rougher alone are scaled.
    pub fn restored_um(&self, n: usize, step_mm: f64, random: &mut Random) -> Vec<f64> {
        let waves = self.waves_um(n, step_mm);
        let noise = self.residual(n, step_mm, random);
        let with = |share: f64| -> Vec<f64> {
            waves
                .iter()
                .zip(&noise)
                .map(|(a, b)| a + share * b)
                .collect()
        };
        let is_smooth = |share: f64| mean_deviation(&with(share)) < self.smd_um;
        let mut high = 1.0;
        while is_smooth(high) && high < 1e3 {
            high *= 2.0;
        }
        let mut restored = with(bisected([0.0, high], 50, is_smooth));
        let found = mean_deviation(&restored);
        if found > self.smd_um * 1.001 {
            let factor = self.smd_um / found;
            for height in &mut restored {
                *height *= factor;
            }
        }
        restored
    }

    /// Noise with the residual's spectrum, µm.
    fn residual(&self, n: usize, step_mm: f64, random: &mut Random) -> Vec<f64> {
        let mut n_bins = vec![0.0; self.residual_um.len()];
        let band = |bin: usize| {
            let per_mm = bin as f64 / (n as f64 * step_mm);
            band_of(per_mm, self.residual_from_per_mm).filter(|&band| band < self.residual_um.len())
        };
        let bins = 1..n.div_ceil(2);
        for bin in bins.clone() {
            if let Some(band) = band(bin) {
                n_bins[band] += 1.0;
            }
        }
        let mut spectrum = vec![Complex::default(); n / 2 + 1];
        for bin in bins {
            let draw = Complex::new(random.normal(), random.normal());
            if let Some(band) = band(bin) {
                let power = self.residual_um[band].powi(2) / n_bins[band];
                spectrum[bin] = draw * (0.5 * n as f64 * power.sqrt());
            }
        }
        RealTransform::new(n).inverse(&spectrum)
    }
}

/// The band of a wavenumber.
fn band_of(per_mm: f64, from_per_mm: f64) -> Option<usize> {
    let band = (BANDS_PER_OCTAVE * (per_mm / from_per_mm).log2()).floor();
    (0.0..60.0).contains(&band).then(|| to_index(band))
}

/// Rms of a series in bands, µm.
fn band_rms_um(heights_um: &[f64], step_mm: f64, from_per_mm: f64) -> Vec<f64> {
    let n = heights_um.len();
    let mut powers: Vec<f64> = Vec::new();
    let spectrum = RealTransform::new(n).forward(heights_um);
    for (bin, x) in spectrum.iter().enumerate().skip(1) {
        let per_mm = bin as f64 / (n as f64 * step_mm);
        if let Some(band) = band_of(per_mm, from_per_mm) {
            powers.resize(powers.len().max(band + 1), 0.0);
            let times = if 2 * bin == n { 1.0 } else { 2.0 };
            powers[band] += times * x.norm_sqr() / (n as f64 * n as f64);
        }
    }
    powers.into_iter().map(f64::sqrt).collect()
}
