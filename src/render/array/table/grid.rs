//! How dense the nodes of tables are for an error budget: how far linear interpolation over log
//! speed can be off, whatever the spectrum.
//!
//! A tabulated power is a sum of the filter's power gain `H²` at the bins' frequencies, weighted
//! with powers that are never negative, so its relative error is at most the largest relative error
//! of interpolating `H²` itself over log frequency. That depends on the filter and on the distance
//! of the nodes only, and is known before any spectrum is.

use std::sync::Arc;

use super::segments::Segments;
use selvedge_textile::surface::BIN_SPACING_PER_MM;
use selvedge_textile::tactile::{Band, Filters, MAX_FREQUENCY_HZ, MIN_SPEED_MM_PER_S};

/// Nodes an octave to choose from.
const DENSITIES: [u32; 8] = [24, 32, 48, 64, 96, 128, 192, 384];
/// Samples of the filter an octave: at least two for each part of the densest choice.
const SAMPLES_PER_OCTAVE: u32 = 768;
/// Power gains below this do not survive f32 beside a power of 1, so they are not bounded.
pub(super) const MIN_POWER_GAIN: f64 = 1e-33;
/// What rounding to f32 may add, dB: a few units of 6e-8, of power.
const ROUNDING_DB: f64 = 2e-6;

/// Nodes an octave, and the level error that they keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Density {
    pub(crate) per_octave: u32,
    pub(crate) level_db: f64,
}

impl Density {
    /// The fewest nodes an octave that keep within a budget, else the most there can be.
    pub(crate) fn within(filters: &Filters, budget_db: f64) -> Self {
        let samples = Band::ALL.map(|band| sampled(filters, band));
        let at = |per_octave: u32| {
            let of_band = |gains: &Vec<f64>| error_db(gains, per_octave);
            let level_db = samples.iter().map(of_band).fold(0.0, f64::max) + ROUNDING_DB;
            Self {
                per_octave,
                level_db,
            }
        };
        let densest = DENSITIES[DENSITIES.len() - 1];
        let fitting = DENSITIES
            .into_iter()
            .map(at)
            .find(|found| found.level_db <= budget_db);
        fitting.unwrap_or_else(|| at(densest))
    }
}

/// The nodes of tables for filters and an error budget, and the error that they keep to.
#[derive(Debug, Clone)]
pub(crate) struct Grid {
    pub(crate) density: Density,
    pub(super) segments: Arc<Segments>,
}

/// The filter's power gains over all frequencies at which a bin can sound, evenly over log₂ f.
fn sampled(filters: &Filters, band: Band) -> Vec<f64> {
    let lowest = (MIN_SPEED_MM_PER_S * BIN_SPACING_PER_MM).log2();
    let per_octave = f64::from(SAMPLES_PER_OCTAVE);
    let gain = |step: u32| {
        let frequency_hz = (lowest + f64::from(step) / per_octave).exp2();
        filters.power_gain(band, frequency_hz)
    };
    let octaves = MAX_FREQUENCY_HZ.log2() - lowest;
    // One octave more: intervals may begin anywhere below 1 kHz.
    let n_steps = (0..30 * SAMPLES_PER_OCTAVE)
        .take_while(|&step| f64::from(step) < (octaves + 1.0) * per_octave)
        .count();
    (0..).map(gain).take(n_steps).collect()
}

/// The largest level error in dB of interpolating between samples 1/`per_octave` octave apart,
/// wherever they lie.
fn error_db(gains: &[f64], per_octave: u32) -> f64 {
    let n_steps = (SAMPLES_PER_OCTAVE / per_octave) as usize;
    let (mut max, mut min) = (1.0_f64, 1.0_f64);
    for part in gains.windows(n_steps + 1) {
        let (start, end) = (part[0], part[n_steps]);
        if start.min(end) < MIN_POWER_GAIN {
            continue;
        }
        for (step, &exact) in part.iter().enumerate().skip(1).take(n_steps - 1) {
            let share = step as f64 / n_steps as f64;
            let ratio = (start + (end - start) * share) / exact;
            max = max.max(ratio);
            min = min.min(ratio);
        }
    }
    // Between samples the error may be a little larger than at them.
    1.02 * 10.0 * max.log10().max(-min.log10())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_filter_keeps_within_its_budget_with_few_nodes() {
        let density = Density::within(&Filters::default(), 0.05);
        assert!(
            density.per_octave <= 64 && density.level_db <= 0.05,
            "{density:?}"
        );
        // h²/8·(slope² − 2 ln 2) with slope 2 ln 2·9 octaves at 1e-33⁠ is the closed form.
        let octaves = (110.0_f64 * 0.996).sqrt();
        let slope = 2.0 * std::f64::consts::LN_2 * octaves;
        let h = 1.0 / f64::from(density.per_octave);
        let closed_db = 10.0 * (1.0 + h * h / 8.0 * (slope * slope - 1.39)).log10();
        assert!(
            (density.level_db / closed_db - 1.0).abs() < 0.1,
            "{density:?}, {closed_db}"
        );
    }

    #[test]
    fn a_smaller_budget_takes_more_nodes_and_none_too_few() {
        for filters in [
            Filters::default(),
            Filters::Receptor,
            Filters::LogGaussian { octaves: 1.0 },
        ] {
            let mut before = 0;
            for budget_db in [0.5, 0.05, 0.01, 0.002] {
                let density = Density::within(&filters, budget_db);
                assert!(density.per_octave >= before, "{density:?}");
                assert!(
                    density.level_db <= budget_db || density.per_octave == 384,
                    "{density:?}"
                );
                before = density.per_octave;
            }
        }
    }

    #[test]
    fn a_filter_too_narrow_to_tabulate_says_so() {
        let density = Density::within(&Filters::LogGaussian { octaves: 0.01 }, 0.05);
        assert!(density.level_db > 0.05, "{density:?}");
    }
}
