//! What a material is to the Fourier method: mean and standard deviation of the coefficients of
//! each harmonic, learnt from several profiles [Wall & Harwin 1999].
//!
//! Conventions, where the paper leaves them open or prints them otherwise:
//! - a harmonic n is `a_n cos(2π n ν₀ x) + b_n sin(2π n ν₀ x)`: ν₀ is in cycles, so 2π is written
//! - n counts cycles in the fundamental length: n = 1 is the fundamental (a numbering from 1 that
//!   calls the constant the first harmonic is one higher); bands are given in cycles/m, not in n
//! - the fundamental is 1/(N·dx), N samples dx apart: 19.8 cycles/m for 101 samples at 0.5 mm, not
//!   the 20 of 1/50 mm
//! - `a_n = 2/N Re X_n`, `b_n = −2/N Im X_n` of the DFT X: heights in µm, peak. The printed 1/N
//!   with a one-sided sum gives half of them

use crate::error::TextileError;
use crate::recipe::{KeySpec, KeyType, ParameterKind, keys};
use crate::surface::Profile;
use selvedge_foundation::numerics::RealTransform;

/// Most harmonics of a template.
pub(super) const MAX_HARMONICS: usize = 2000;

keys! {
    /// Mean and standard deviation of the coefficients of harmonics 1, 2, 3 …
    table pub FourierTemplate {
        /// What it is called.
        pub name: String,
        /// Where it comes from, one line.
        #[serde(default)]
        pub notes: String,
        pub fundamental_per_m: f64
            => "Harmonic 1" 0.1 ..= 10_000.0 "/m" "Harmonic 1, cycles per metre",
        pub mean_cos_um: Vec<f64>
            => "Cosines, mean" -1e6 ..= 1e6 "µm" "Mean of the cosines",
        pub(crate) sd_cos_um: Vec<f64>
            => "Cosines, sd" 0.0 ..= 1e6 "µm" "Spread of the cosines",
        pub(crate) mean_sin_um: Vec<f64>
            => "Sines, mean" -1e6 ..= 1e6 "µm" "Mean of the sines",
        pub(crate) sd_sin_um: Vec<f64>
            => "Sines, sd" 0.0 ..= 1e6 "µm" "Spread of the sines",
    }
}

impl FourierTemplate {
    /// The template of a material by several of its profiles, with harmonics 1 … `n_harmonics` (as
    /// many as the samples allow, if fewer).
    ///
    /// # Errors
    /// Fewer than two profiles; profiles that differ in samples or step.
    pub fn learn(
        name: &str,
        profiles: &[Profile],
        n_harmonics: usize,
    ) -> Result<Self, TextileError> {
        let [first, _, ..] = profiles else {
            let n = profiles.len();
            let mend = "a standard deviation takes two or more, of different places";
            return Err(TextileError::Model(format!("profiles given: {n}; {mend}")));
        };
        let (n, step_mm) = (first.heights_um().len(), first.step_mm());
        for (index, profile) in profiles.iter().enumerate() {
            let (n_here, step_here) = (profile.heights_um().len(), profile.step_mm());
            if n_here != n || (step_here - step_mm).abs() > 1e-3 * step_mm {
                return Err(TextileError::Model(format!(
                    "profile {}: {n_here} samples {step_here:.4} mm apart, the first has {n} \
                     {step_mm:.4} mm apart; cut and resample them alike",
                    index + 1
                )));
            }
        }
        let transform = RealTransform::new(n);
        let n_harmonics = n_harmonics.clamp(1, MAX_HARMONICS).min((n - 1) / 2);
        let spectra: Vec<_> = profiles
            .iter()
            .map(|profile| transform.forward(profile.heights_um()))
            .collect();
        let scale = 2.0 / n as f64;
        let mut template = Self {
            name: name.to_owned(),
            notes: format!("Learnt from {} profiles of {n} samples.", profiles.len()),
            fundamental_per_m: 1000.0 / (n as f64 * step_mm),
            mean_cos_um: Vec::new(),
            sd_cos_um: Vec::new(),
            mean_sin_um: Vec::new(),
            sd_sin_um: Vec::new(),
        };
        for k in 1..=n_harmonics {
            let (mean, sd) = moments(spectra.iter().map(|x| scale * x[k].re));
            template.mean_cos_um.push(mean);
            template.sd_cos_um.push(sd);
            let (mean, sd) = moments(spectra.iter().map(|x| -scale * x[k].im));
            template.mean_sin_um.push(mean);
            template.sd_sin_um.push(sd);
        }
        Ok(template)
    }

    /// What is wrong with it, if anything: the key, what, and how to mend it.
    pub fn fault(&self) -> Option<(&'static str, String, String)> {
        let n = self.mean_cos_um.len();
        if n == 0 || n > MAX_HARMONICS {
            let what = format!("{n} harmonics");
            return Some(("mean_cos_um", what, format!("give 1 to {MAX_HARMONICS}")));
        }
        for (key, found) in [
            ("sd_cos_um", self.sd_cos_um.len()),
            ("mean_sin_um", self.mean_sin_um.len()),
            ("sd_sin_um", self.sd_sin_um.len()),
        ] {
            if found != n {
                let what = format!("{key} has {found} values, mean_cos_um {n}");
                return Some((key, what, "give one a harmonic".to_owned()));
            }
        }
        let (key, value, [min, max]) = KeySpec::outside(Self::KEYS, self)?;
        let (what, mend) = match key {
            "fundamental_per_m" => ("is", "give"),
            _ => ("holds", "give numbers from"),
        };
        let mend = format!("{mend} {min} to {max}");
        Some((key, format!("{key} {what} {value}"), mend))
    }

    /// Harmonic numbers within a band of cycles a metre.
    pub fn harmonics(&self, [lowest_per_m, highest_per_m]: [f64; 2]) -> Vec<usize> {
        let is_within = |n: &usize| {
            let per_m = *n as f64 * self.fundamental_per_m;
            per_m >= lowest_per_m * (1.0 - 1e-9) && per_m <= highest_per_m * (1.0 + 1e-9)
        };
        (1..=self.mean_cos_um.len()).filter(is_within).collect()
    }

    /// Wavenumber of a harmonic, cycles/mm.
    pub(super) fn per_mm(&self, n: usize) -> f64 {
        n as f64 * self.fundamental_per_m / 1000.0
    }

    /// Mean square of the two coefficients of a harmonic, µm²: what it adds to the variance of the
    /// heights.
    pub(super) fn variance_um2(&self, n: usize) -> f64 {
        let [a, b, c, d] = [
            self.mean_cos_um[n - 1],
            self.sd_cos_um[n - 1],
            self.mean_sin_um[n - 1],
            self.sd_sin_um[n - 1],
        ];
        0.5 * (a * a + b * b + c * c + d * d)
    }
}

impl KeyType for FourierTemplate {
    fn kind(_: [f64; 2], _: &'static str) -> ParameterKind {
        ParameterKind::Template { is_optional: false }
    }
}

impl KeyType for Option<FourierTemplate> {
    fn kind(_: [f64; 2], _: &'static str) -> ParameterKind {
        ParameterKind::Template { is_optional: true }
    }
}

/// Mean and standard deviation (of a sample: n − 1) of some numbers.
fn moments(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let squares: f64 = values.map(|x| (x - mean).powi(2)).sum();
    (mean, (squares / (n - 1.0)).sqrt())
}
