//! The level error of a run against the reference, perhaps of one that goes on: nobody knows yet
//! how strong it will become.
//!
//! An error is a matter of level where the reference reaches a thousandth of its band's largest
//! amplitude in the run. As the run goes on that largest amplitude grows, and what counted before
//! may count no more; so errors are kept by the octave of the reference's amplitude, and whole
//! octaves are let go once they are below. The octave that the limit runs through still counts:
//! the error found is never too small.

use std::collections::BTreeMap;

use super::{Histogram, LevelError};
use selvedge_foundation::numerics::to_whole;

/// Share of a band's largest amplitude from which on an error is a matter of level.
const AUDIBLE_SHARE: f64 = 1e-3;

/// The level error of an amplitude against that of the reference, dB; not negative.
fn level_error_db(a: f64, a_ref: f64) -> f64 {
    (20.0 * (a / a_ref).log10()).abs()
}

/// Collects the level error of a run, amplitude by amplitude.
#[derive(Debug, Clone, Default)]
pub struct ErrorMeter {
    bands: [BandRun; 2],
}

/// One band of a run.
#[derive(Debug, Clone, Default)]
struct BandRun {
    /// The reference's largest amplitude since gains or the scene changed last, µm.
    largest_um: f64,
    /// By the octave of the reference's amplitude.
    octaves: BTreeMap<i32, Octave>,
    /// The largest `|a − a_ref|` of what does not count as a level, µm.
    below_um: f64,
    /// The same as a share of the largest amplitude, before gains or the scene changed last.
    below_share: f64,
    /// Level errors before gains or the scene changed last, dB.
    before_db: Histogram,
}

#[derive(Debug, Clone, Default)]
struct Octave {
    levels_db: Histogram,
    max_um: f64,
}

impl ErrorMeter {
    /// A meter for a run in which these are the reference's largest amplitudes, by band, µm; by
    /// default they are found on the way.
    pub fn new(largest_um: [f64; 2]) -> Self {
        let mut meter = Self::default();
        meter.reach(largest_um);
        meter
    }

    /// Adds the amplitudes of a contactor in a tick, µm, beside those of the reference.
    pub fn add(&mut self, amplitudes_um: [f64; 2], reference_um: [f64; 2]) {
        for (b, band) in self.bands.iter_mut().enumerate() {
            band.add(amplitudes_um[b], reference_um[b]);
        }
    }

    /// Raises the largest amplitudes to those of a tick that is about to be added, µm.
    pub fn reach(&mut self, reference_um: [f64; 2]) {
        for (b, band) in self.bands.iter_mut().enumerate() {
            band.reach(reference_um[b]);
        }
    }

    /// The level error of both bands against the reference, dB; `None` where it is no matter of
    /// level.
    pub fn judge(&self, amplitudes_um: [f64; 2], reference_um: [f64; 2]) -> [Option<f64>; 2] {
        [0, 1].map(|b| {
            let (a, a_ref) = (amplitudes_um[b], reference_um[b]);
            let counts = self.bands[b].counts(a_ref);
            counts.then(|| level_error_db(a, a_ref))
        })
    }

    /// Gains or the scene have changed: amplitudes from now on are not compared with the strength
    /// of those before. Errors found stay.
    pub fn begin_section(&mut self) {
        self.bands.iter_mut().for_each(BandRun::begin_section);
    }

    /// The level errors of a band, dB.
    pub fn levels_db(&self, band: usize) -> Histogram {
        self.bands[band].levels_db()
    }

    /// The error of a band as far as the run went.
    pub fn of_band(&self, band: usize) -> LevelError {
        let run = &self.bands[band];
        level_error(&run.levels_db(), run.max_share_below())
    }

    /// The error of both bands together.
    pub fn finish(&self) -> LevelError {
        let mut levels_db = self.levels_db(0);
        levels_db.merge(&self.levels_db(1));
        let [low, high] = &self.bands;
        level_error(
            &levels_db,
            low.max_share_below().max(high.max_share_below()),
        )
    }
}

fn level_error(levels_db: &Histogram, max_share_below: f64) -> LevelError {
    LevelError {
        max_db: levels_db.largest(),
        p99_db: levels_db.quantile(0.99),
        n_amplitudes: levels_db.count(),
        max_share_below,
    }
}

impl BandRun {
    fn limit_um(&self) -> f64 {
        AUDIBLE_SHARE * self.largest_um
    }

    fn counts(&self, a_ref: f64) -> bool {
        a_ref > 0.0 && a_ref >= self.limit_um()
    }

    fn reach(&mut self, a_ref: f64) {
        if a_ref <= self.largest_um || a_ref.is_nan() {
            return;
        }
        self.largest_um = a_ref;
        // The octave that the limit lies in stays; all below it go.
        let kept = self.octaves.split_off(&octave_of(self.limit_um()));
        let gone = std::mem::replace(&mut self.octaves, kept);
        let max_um = gone.values().map(|octave| octave.max_um);
        self.below_um = max_um.fold(self.below_um, f64::max);
    }

    fn add(&mut self, a: f64, a_ref: f64) {
        self.reach(a_ref);
        let error_um = (a - a_ref).abs();
        if self.counts(a_ref) {
            let octave = self.octaves.entry(octave_of(a_ref)).or_default();
            octave.levels_db.add(level_error_db(a, a_ref));
            octave.max_um = octave.max_um.max(error_um);
        } else {
            self.below_um = self.below_um.max(error_um);
        }
    }

    fn levels_db(&self) -> Histogram {
        let mut all = self.before_db.clone();
        let octaves = self.octaves.values();
        octaves.for_each(|octave| all.merge(&octave.levels_db));
        all
    }

    /// The largest error below the limit as a share of the largest amplitude: infinite where there
    /// is sound and the reference has none.
    fn max_share_below(&self) -> f64 {
        let is_silent = self.below_um <= 0.0;
        let share = if is_silent {
            0.0
        } else {
            self.below_um / self.largest_um
        };
        self.below_share.max(share)
    }

    fn begin_section(&mut self) {
        *self = Self {
            below_share: self.max_share_below(),
            before_db: self.levels_db(),
            ..Self::default()
        };
    }
}

fn octave_of(amplitude_um: f64) -> i32 {
    to_whole(amplitude_um.log2().floor())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_went_on_is_judged_like_one_that_is_over() {
        // Strong at its end: what was weak before is then no matter of level.
        let run: Vec<[f64; 2]> = (0..40)
            .map(|n| {
                let exact = 10.0_f64.powf(f64::from(n) / 4.0 - 6.0);
                [exact * (1.0 + 1e-3 / f64::from(n + 1)), exact]
            })
            .collect();
        let largest = run.iter().map(|[_, exact]| *exact).fold(0.0, f64::max);
        let mut meter = ErrorMeter::new([largest, 0.0]);
        let mut running = ErrorMeter::default();
        for [a, exact] in run {
            meter.add([a, 0.0], [exact, 0.0]);
            running.add([a, 0.0], [exact, 0.0]);
        }
        let (over, found) = (meter.finish(), running.finish());
        // At most the octave of the limit counts beside: one more of four a decade.
        let more = found.n_amplitudes - over.n_amplitudes;
        assert!(more <= 2, "{found:?} {over:?}");
        assert!(
            found.max_db >= over.max_db && found.max_db < 1.2 * over.max_db,
            "{found:?} {over:?}"
        );
        assert!(found.max_share_below <= over.max_share_below, "{found:?}");
        assert_eq!(running.of_band(1).n_amplitudes, 0);
    }

    #[test]
    fn a_wrong_amplitude_shows_in_its_band_alone() {
        let mut running = ErrorMeter::default();
        running.add([2.0, 1.0], [1.0, 1.0]);
        assert!((running.of_band(0).max_db - 6.0206).abs() < 1e-4);
        assert_eq!(running.of_band(1).max_db, 0.0);
        let [low, high] = running.judge([1.0, 1e-6], [1.0, 1e-6]);
        assert_eq!((low, high), (Some(0.0), None), "too weak to be a level");
    }

    #[test]
    fn another_gain_begins_a_section_and_forgets_no_error() {
        let mut running = ErrorMeter::default();
        running.add([101.0, 0.0], [100.0, 0.0]);
        running.begin_section();
        // 100 dB less: weak beside what was, but as strong as things are now.
        running.add([2e-3, 0.0], [1e-3, 0.0]);
        let error = running.finish();
        assert_eq!(error.n_amplitudes, 2);
        assert!((error.max_db - 6.0206).abs() < 1e-4, "{error:?}");
        assert_eq!(error.max_share_below, 0.0);
    }

    #[test]
    fn sound_where_the_reference_of_a_run_that_goes_on_is_silent_is_an_infinite_error() {
        let mut running = ErrorMeter::default();
        running.add([0.0, 0.0], [0.0, 0.0]);
        assert_eq!(running.finish().max_share_below, 0.0);
        running.add([1.0, 0.0], [0.0, 1.0]);
        let error = running.finish();
        assert_eq!(error.max_share_below, f64::INFINITY);
        assert_eq!(error.max_db, f64::INFINITY);
    }

    #[test]
    fn level_errors_count_above_a_thousandth_of_the_largest() {
        let mut meter = ErrorMeter::new([10.0, 0.0]);
        meter.add([10.0, 0.0], [10.0, 0.0]);
        meter.add([2.0, 0.0], [1.0, 0.0]);
        meter.add([0.009, 0.0], [0.005, 0.0]);
        let error = meter.finish();
        assert!((error.max_db - 6.0206).abs() < 1e-4, "{error:?}");
        assert_eq!(error.n_amplitudes, 2);
        assert!((error.max_share_below - 4e-4).abs() < 1e-12, "{error:?}");
    }

    #[test]
    fn sound_where_the_reference_is_silent_is_an_infinite_error() {
        let mut meter = ErrorMeter::new([0.0, 1.0]);
        meter.add([1.0, 0.0], [0.0, 1.0]);
        let error = meter.finish();
        assert_eq!(error.max_share_below, f64::INFINITY);
        assert_eq!(error.max_db, f64::INFINITY);
    }
}
