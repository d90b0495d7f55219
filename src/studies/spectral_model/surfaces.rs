//! What the models are tried on: waves whose amplitudes are known, and shipped textiles.

use std::f64::consts::TAU;

use crate::ReportError;
use selvedge_foundation::numerics::Random;
use selvedge_textile::Library;
use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ};

/// Samples of a wave's profile, and their distance, mm.
const N_SAMPLES: u16 = 4600;
const STEP_MM: f64 = 1.0 / 230.0;

/// A profile along the warp.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    /// Its name for tables.
    pub(super) label: String,
    /// Distance between samples, mm.
    pub(super) step_mm: f64,
    /// Heights, µm.
    pub(super) heights_um: Vec<f64>,
    /// The waves that it is the sum of: wavenumber in cycles/mm, amplitude in µm. Empty for a
    /// textile.
    pub(super) waves: Vec<[f64; 2]>,
}

/// Wavelengths in mm and amplitudes in µm of the waves that a surface is made of.
const WAVES: [&[[f64; 2]]; 8] = [
    &[[0.5, 1.0]],
    &[[2.5, 1.0]],
    &[[0.6, 1.0], [1.1, 0.7], [0.31, 0.3]],
    &[[1.0, 1.0]],
    &[[1.6, 1.0]],
    &[[4.35, 1.0]],
    &[[8.0, 1.0]],
    &[[5.0, 2.0], [0.4, 0.5]],
];

/// The first `n` sums of waves, their phases drawn at random.
pub(super) fn sums_of_waves(n: usize, random: &mut Random) -> Vec<Surface> {
    let mut surface = |parts: &&[[f64; 2]]| {
        let waves: Vec<[f64; 2]> = parts.iter().map(|part| [1.0 / part[0], part[1]]).collect();
        let lengths: Vec<String> = parts.iter().map(|part| part[0].to_string()).collect();
        Surface::of_waves(
            &format!("waves of {} mm", lengths.join(" + ")),
            waves,
            random,
        )
    };
    WAVES.iter().take(n).map(&mut surface).collect()
}

/// The warp of the first `n` textiles of the shipped library.
pub(super) fn textiles(n: usize) -> Result<Vec<Surface>, ReportError> {
    let library = Library::shipped()?;
    let mut surfaces = Vec::new();
    for id in library.ids().iter().take(n) {
        let textile = library.load(id)?;
        let direction = textile.surface().taken_from(Direction::WarpForward);
        if let Some(profile) = textile.surface().profile(direction) {
            surfaces.push(Surface {
                label: id.clone(),
                step_mm: profile.step_mm(),
                heights_um: profile.heights_um().to_vec(),
                waves: Vec::new(),
            });
        }
    }
    Ok(surfaces)
}

impl Surface {
    /// A sum of waves: wavenumbers in cycles/mm and amplitudes in µm.
    pub(super) fn of_waves(label: &str, waves: Vec<[f64; 2]>, random: &mut Random) -> Self {
        let phases: Vec<f64> = waves.iter().map(|_| TAU * random.uniform()).collect();
        let height = |i: u16| {
            let x_mm = f64::from(i) * STEP_MM;
            let parts = waves.iter().zip(&phases);
            parts
                .map(|([wavenumber, amplitude], phase)| {
                    amplitude * (TAU * wavenumber * x_mm + phase).sin()
                })
                .sum()
        };
        Self {
            label: label.to_owned(),
            step_mm: STEP_MM,
            heights_um: (0..N_SAMPLES).map(height).collect(),
            waves,
        }
    }

    /// Its length, mm.
    pub(super) fn length_mm(&self) -> f64 {
        self.heights_um.len() as f64 * self.step_mm
    }

    /// `[A40², A320²]` of a sum of waves at a speed by the filters alone, `Σ (a H(vν))²`, µm²;
    /// `None` of a textile.
    pub(super) fn analytic_um2(&self, speed_mm_per_s: f64, filters: &Filters) -> Option<[f64; 2]> {
        if self.waves.is_empty() {
            return None;
        }
        let mut sums = [0.0; 2];
        for [wavenumber, amplitude] in &self.waves {
            let frequency_hz = speed_mm_per_s * wavenumber;
            if frequency_hz < MAX_FREQUENCY_HZ {
                for band in Band::ALL {
                    sums[band.index()] +=
                        amplitude * amplitude * filters.power_gain(band, frequency_hz);
                }
            }
        }
        Some(sums)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_at_its_carriers_speed_has_its_amplitude() {
        let wave = Surface::of_waves("wave", vec![[0.4, 3.0]], &mut Random::new(1));
        let filters = Filters::default();
        let [low, _] = wave.analytic_um2(100.0, &filters).unwrap();
        assert!((low - 9.0).abs() < 1e-9, "{low}");
        assert_eq!(wave.analytic_um2(3000.0, &filters), Some([0.0; 2]));
        let textiles = textiles(2).unwrap();
        assert_eq!(textiles.len(), 2);
        assert!(
            textiles[0].analytic_um2(100.0, &filters).is_none(),
            "a textile is no sum"
        );
    }
}
