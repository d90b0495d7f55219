//! How dense the nodes of tables are for an error budget: how far linear interpolation over log
//! speed can be off, whatever the spectrum.
//!
//! A tabulated power is a sum of the filter's power gain `H²` at the bins' frequencies, weighted
//! with powers that are never negative, so its relative error is at most the largest relative error
//! of interpolating `H²` itself over log frequency. That depends on the filter and on the distance
//! of the nodes only, and is known before any spectrum is.

use std::ops::Range;
use std::sync::Arc;

use super::segments::Segments;
use selvedge_foundation::numerics::{extent, to_index};
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
    fn within(filters: &Filters, budget_db: f64) -> Self {
        let bands = Band::ALL.map(|band| Samples::new(filters, band));
        let at = |per_octave: u32| {
            let errors_db = bands.iter().map(|band| band.error_db(per_octave));
            let level_db = errors_db.fold(0.0, f64::max) + ROUNDING_DB;
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

impl Grid {
    /// The nodes for these filters within this budget.
    pub(crate) fn new(filters: &Filters, budget_db: f64) -> Self {
        let density = Density::within(filters, budget_db);
        Self {
            segments: Arc::new(Segments::new(density.per_octave)),
            density,
        }
    }
}

/// log₂ of the lowest frequency at which a bin can sound.
fn lowest_log2() -> f64 {
    (MIN_SPEED_MM_PER_S * BIN_SPACING_PER_MM).log2()
}

/// Samples of a filter over all frequencies at which a bin can sound, evenly over log₂ f, and one
/// octave more: intervals may begin anywhere below 1 kHz.
fn n_samples() -> usize {
    let octaves = MAX_FREQUENCY_HZ.log2() - lowest_log2() + 1.0;
    to_index((octaves * f64::from(SAMPLES_PER_OCTAVE)).ceil())
}

/// A band's filter, sampled.
struct Samples<'a> {
    /// The power gain of a sample.
    gain: Box<dyn Fn(usize) -> f64 + 'a>,
    /// Top and half width between the power gains that are bounded, samples, of a bell.
    bell: Option<[f64; 2]>,
}

impl<'a> Samples<'a> {
    fn new(filters: &'a Filters, band: Band) -> Self {
        let gain = move |sample: usize| {
            let octaves = sample as f64 / f64::from(SAMPLES_PER_OCTAVE);
            filters.power_gain(band, (lowest_log2() + octaves).exp2())
        };
        match filters {
            Filters::LogGaussian { octaves } => {
                let top = band.carrier_hz().log2() - lowest_log2();
                let reach = 0.5 * octaves * (-MIN_POWER_GAIN.log2()).sqrt();
                Self {
                    gain: Box::new(gain),
                    bell: Some([top, reach].map(|x| x * f64::from(SAMPLES_PER_OCTAVE))),
                }
            }
            Filters::Receptor => {
                let gains: Vec<f64> = (0..n_samples()).map(gain).collect();
                Self {
                    gain: Box::new(move |sample| gains[sample]),
                    bell: None,
                }
            }
        }
    }

    /// The largest level error in dB of interpolating between samples 1/`per_octave` octave apart,
    /// wherever they lie.
    fn error_db(&self, per_octave: u32) -> f64 {
        let n_steps = (SAMPLES_PER_OCTAVE / per_octave) as usize;
        self.largest_error_db(n_steps, self.worst_starts(n_steps))
    }

    /// Where intervals of so many samples begin at which interpolation is farthest off.
    ///
    /// Over log₂ f a log-Gaussian filter's `H²` is a bell: what a straight line lies above it, as a
    /// share, grows with the distance from its top, and it lies below only around the top. Those of
    /// the receptors are straight over two logarithms between kinks: what is worst is worst in the
    /// middle of its interval, but for a few parts in a hundred.
    fn worst_starts(&self, n_steps: usize) -> Vec<usize> {
        let (last, length) = (n_samples() - 1 - n_steps, n_steps as f64);
        if let Some([top, reach]) = self.bell {
            let worst = [top - reach, top + reach - length, top - 0.5 * length];
            // Rounding: the ones on either side too.
            let around =
                |start: f64| [-1.0, 0.0, 1.0, 2.0].map(|by| to_index(start + by).min(last));
            return worst.into_iter().flat_map(around).collect();
        }
        let middle = |&start: &usize| {
            let ratio = self
                .ratios(start, n_steps, n_steps / 2..n_steps / 2 + 1)
                .next();
            ratio.map_or(0.0, f64::ln)
        };
        let [below, above] = extent((0..=last).map(|start| middle(&start)));
        let is_worst = |start: &usize| {
            let off = middle(start);
            off >= 0.8 * above || off <= 0.8 * below
        };
        (0..=last).filter(is_worst).collect()
    }

    /// The largest of those intervals of so many samples that begin there.
    fn largest_error_db(&self, n_steps: usize, starts: impl IntoIterator<Item = usize>) -> f64 {
        let starts = starts.into_iter();
        let ratios = starts.flat_map(|start| self.ratios(start, n_steps, 1..n_steps));
        let [min, max] = extent(ratios.chain([1.0]));
        // Between samples the error may be a little larger than at them.
        1.02 * 10.0 * max.log10().max(-min.log10())
    }

    /// What a straight line over so many samples gives at some of them, as multiples of what is
    /// there; nothing where its ends are not bounded.
    fn ratios(
        &self,
        start: usize,
        n_steps: usize,
        steps: Range<usize>,
    ) -> impl Iterator<Item = f64> {
        let [low, high] = [start, start + n_steps].map(&self.gain);
        let is_bounded = low.min(high) >= MIN_POWER_GAIN;
        steps.filter(move |_| is_bounded).map(move |step| {
            let share = step as f64 / n_steps as f64;
            (low + (high - low) * share) / (self.gain)(start + step)
        })
    }
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

    #[test]
    fn the_worst_places_tell_the_error_of_all() {
        let bells = [0.3, 1.0, 2.0, 4.0].map(|octaves| Filters::LogGaussian { octaves });
        for filters in bells.into_iter().chain([Filters::Receptor]) {
            for (band, n_steps) in [(Band::Low, 32), (Band::High, 12), (Band::High, 4)] {
                let samples = Samples::new(&filters, band);
                let every = 0..n_samples() - n_steps;
                let expected_db = samples.largest_error_db(n_steps, every.clone());
                let starts = samples.worst_starts(n_steps);
                assert!(2 * starts.len() < every.len() && expected_db > 0.0);
                let found_db = samples.largest_error_db(n_steps, starts);
                assert_eq!(found_db, expected_db, "{filters:?}, {band:?}, {n_steps}");
            }
        }
    }
}
