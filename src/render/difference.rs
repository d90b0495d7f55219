//! By how much the levels of two runs on the same path differ: by contactor, over time, in all.
//!
//! Differences are `20 log₁₀(b/a)` dB where both sound. Silence has no level: where only one of
//! them sounds that is said, and no number is made up for it. Memory does not grow with the path
//! beyond [`MAX_ENTRIES`] entries. Renders nothing.

use super::array::DisplayFrame;
use selvedge_foundation::quantity::level_db;
use selvedge_textile::tactile::{Perception, vibrating_mean_um};

/// An amplitude below this counts as silence, µm: a nanometre, 49 dB or more below any threshold
/// of detection.
pub(crate) const SILENT_UM: f64 = 1e-3;
/// Entries of the difference over time. A path with more ticks (27 minutes) has several in each.
const MAX_ENTRIES: u64 = 1 << 16;

/// Two amplitudes beside each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Contrast {
    /// Neither sounds.
    Silent,
    /// The first sounds, the second does not.
    OnlyA,
    /// The second sounds, the first does not.
    OnlyB,
    /// Both sound: the second's level less the first's, dB.
    Both(f64),
}

impl Contrast {
    /// Of two amplitudes in µm; what is no number is silence.
    pub(crate) fn of(a_um: f64, b_um: f64) -> Self {
        let sounds = |um: f64| um >= SILENT_UM && um.is_finite();
        match (sounds(a_um), sounds(b_um)) {
            (false, false) => Self::Silent,
            (true, false) => Self::OnlyA,
            (false, true) => Self::OnlyB,
            (true, true) => Self::Both(level_db(b_um) - level_db(a_um)),
        }
    }
}

/// The largest difference of a run, and where it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// The difference, dB.
    pub difference_db: f64,
    /// The tick.
    pub tick: u64,
    /// The contactor of the display that is compared.
    pub contactor: usize,
}

/// Contrasts, counted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tally {
    sum_db: f64,
    /// Where both sounded.
    pub n_both: u64,
    /// Where only the first, and only the second sounded.
    pub n_only: [u64; 2],
    /// The largest difference, by its size.
    pub largest: Option<Largest>,
}

impl Tally {
    /// Of one difference alone.
    pub fn of_one(only: Largest) -> Self {
        let mut tally = Self::default();
        let contrast = Contrast::Both(only.difference_db);
        tally.add(contrast, only.tick, only.contactor);
        tally
    }

    fn add(&mut self, contrast: Contrast, tick: u64, contactor: usize) {
        match contrast {
            Contrast::Silent => {}
            Contrast::OnlyA => self.n_only[0] += 1,
            Contrast::OnlyB => self.n_only[1] += 1,
            Contrast::Both(difference_db) => {
                self.n_both += 1;
                self.sum_db += difference_db;
                let is_larger = |l: &Largest| difference_db.abs() > l.difference_db.abs();
                if self.largest.as_ref().is_none_or(is_larger) {
                    self.largest = Some(Largest {
                        difference_db,
                        tick,
                        contactor,
                    });
                }
            }
        }
    }

    /// The mean difference over all that sounded in both, dB; `None` when nothing did.
    pub fn mean_db(&self) -> Option<f64> {
        (self.n_both > 0).then(|| self.sum_db / self.n_both as f64)
    }
}

/// A band during one entry of the difference over time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spread {
    /// The least and the most difference of level, dB; `None` when never both sounded.
    pub range_db: Option<[f64; 2]>,
    /// Whether at some tick only the first, only the second sounded.
    pub is_only: [bool; 2],
}

impl Spread {
    fn add(&mut self, contrast: Contrast) {
        match contrast {
            Contrast::Silent => {}
            Contrast::OnlyA => self.is_only[0] = true,
            Contrast::OnlyB => self.is_only[1] = true,
            Contrast::Both(db) => {
                let [least, most] = self.range_db.unwrap_or([db; 2]);
                self.range_db = Some([least.min(db), most.max(db)]);
            }
        }
    }

    fn join(&mut self, other: &Self) {
        if let Some([least, most]) = other.range_db {
            self.add(Contrast::Both(least));
            self.add(Contrast::Both(most));
        }
        self.is_only = [0, 1].map(|side| self.is_only[side] || other.is_only[side]);
    }
}

/// By how much two runs differ; bands by [`selvedge_textile::tactile::Band::index`].
#[derive(Debug, Clone, PartialEq)]
pub struct LevelDifference {
    /// Ticks that were compared.
    pub n_ticks: u64,
    /// Ticks in each entry of `over_time`.
    pub ticks_per_entry: u64,
    /// By contactor of the display that is compared.
    pub by_contactor: Vec<[Tally; 2]>,
    /// Over time: the level of the mean over all contactors.
    pub over_time: Vec<[Spread; 2]>,
    /// Of all contactors and ticks.
    pub in_all: [Tally; 2],
    /// How far the first run lay above the threshold of each channel on average while it sounded,
    /// dB, by the model of [`Perception`]; `None` when it never did.
    pub perceptual_level_db: [Option<f64>; 2],
}

impl LevelDifference {
    /// The whole over time in at most `n_columns`, in which no extreme is lost.
    pub fn columns(&self, n_columns: usize) -> Vec<[Spread; 2]> {
        let n = self.over_time.len();
        let n_columns = n_columns.min(n);
        let joined = |entries: &[[Spread; 2]]| {
            let mut column = [Spread::default(); 2];
            for entry in entries {
                for (whole, part) in column.iter_mut().zip(entry) {
                    whole.join(part);
                }
            }
            column
        };
        (0..n_columns)
            .map(|i| joined(&self.over_time[i * n / n_columns..(i + 1) * n / n_columns]))
            .collect()
    }
}

/// Gathers the differences of two runs, tick by tick.
#[derive(Debug, Clone)]
pub struct DifferenceMeter {
    found: LevelDifference,
    sensation_sum_db: [f64; 2],
    n_sounding: [u64; 2],
}

impl DifferenceMeter {
    /// For a path of this many ticks.
    pub fn new(n_ticks: u64) -> Self {
        Self {
            found: LevelDifference {
                n_ticks: 0,
                ticks_per_entry: n_ticks.div_ceil(MAX_ENTRIES).max(1),
                by_contactor: Vec::new(),
                over_time: Vec::new(),
                in_all: [Tally::default(); 2],
                perceptual_level_db: [None; 2],
            },
            sensation_sum_db: [0.0; 2],
            n_sounding: [0; 2],
        }
    }

    /// Takes a tick of both runs: the frames of every display, of which this one counts.
    pub fn add(&mut self, tick: u64, display: usize, frames: [&[DisplayFrame]; 2]) {
        if let [Some(a), Some(b)] = frames.map(|frames| frames.get(display)) {
            let n_contactors = a.n_contactors().min(b.n_contactors());
            let pair = |contactor| [a.amplitude_um(contactor), b.amplitude_um(contactor)];
            self.add_amplitudes(tick, (0..n_contactors).map(pair));
        }
    }

    /// Takes a tick of both runs: the amplitudes of every contactor in A and B, µm.
    pub fn add_amplitudes(
        &mut self,
        tick: u64,
        pairs_um: impl Iterator<Item = [[f64; 2]; 2]> + Clone,
    ) {
        let found = &mut self.found;
        let mut sums_um = [[0.0; 2]; 2];
        for (contactor, [a, b]) in pairs_um.clone().enumerate() {
            if found.by_contactor.len() <= contactor {
                found.by_contactor.push([Tally::default(); 2]);
            }
            for band in 0..2 {
                let contrast = Contrast::of(a[band], b[band]);
                found.by_contactor[contactor][band].add(contrast, tick, contactor);
                found.in_all[band].add(contrast, tick, contactor);
                sums_um[0][band] += a[band];
                sums_um[1][band] += b[band];
            }
        }
        if found.n_ticks.is_multiple_of(found.ticks_per_entry) {
            found.over_time.push([Spread::default(); 2]);
        }
        found.n_ticks += 1;
        if let Some(entry) = found.over_time.last_mut() {
            for (band, spread) in entry.iter_mut().enumerate() {
                spread.add(Contrast::of(sums_um[0][band], sums_um[1][band]));
            }
        }
        let (n_vibrating, mean_um) = vibrating_mean_um(pairs_um.map(|[a, _]| a));
        let felt = Perception::of(mean_um, n_vibrating);
        for band in 0..2 {
            if felt.perceptual_level_db[band].is_finite() {
                self.sensation_sum_db[band] += felt.perceptual_level_db[band];
                self.n_sounding[band] += 1;
            }
        }
    }

    /// What was found.
    pub fn finish(mut self) -> LevelDifference {
        self.found.perceptual_level_db = [0, 1].map(|band| {
            let n = self.n_sounding[band];
            (n > 0).then(|| self.sensation_sum_db[band] / n as f64)
        });
        self.found
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::array::Method;
    use crate::scene::{LoadedScene, Pose, Stroke};
    use crate::{RenderScene, replay_pair};
    use selvedge_foundation::geometry::Point;

    const N_TICKS: u64 = 136;

    fn round() -> impl Iterator<Item = (u64, Pose)> {
        let stroke = Stroke::Circle {
            centre: Point::new(130.0, 130.0),
            radius_mm: 65.0,
            speed_mm_per_s: 120.0,
        };
        (0..N_TICKS).map(move |tick| (tick, stroke.pose_at(tick as f64 / 40.0)))
    }

    fn compared(a: (&RenderScene, Method), b: (&RenderScene, Method)) -> LevelDifference {
        let mut meter = DifferenceMeter::new(N_TICKS);
        let mut sink = |tick, frames: [&[DisplayFrame]; 2]| {
            meter.add(tick, 0, frames);
            ControlFlow::Continue(())
        };
        let end = replay_pair([a, b], (round(), None), &mut sink).unwrap();
        assert!(end.is_continue(), "nobody stopped it");
        meter.finish()
    }

    fn shipped() -> RenderScene {
        RenderScene::of(&LoadedScene::shipped().unwrap())
    }

    #[test]
    fn the_same_run_twice_differs_by_exactly_nothing() {
        let scene = shipped();
        for method in [Method::Reference, Method::Table] {
            let found = compared((&scene, method), (&scene, method));
            assert_eq!((found.n_ticks, found.by_contactor.len()), (N_TICKS, 24));
            let cells = found.by_contactor.iter().flatten();
            for tally in cells.chain(&found.in_all) {
                assert!(tally.n_both > 0 && tally.n_only == [0, 0], "{tally:?}");
                assert_eq!(tally.mean_db(), Some(0.0));
                assert_eq!(tally.largest.unwrap().difference_db, 0.0);
            }
            let heard = found.over_time.iter().flatten().filter_map(|s| s.range_db);
            assert!(heard.clone().count() > 100, "it sounded");
            assert!(heard.into_iter().all(|range| range == [0.0, 0.0]));
        }
    }

    #[test]
    fn six_decibels_of_master_gain_are_six_decibels_wherever_it_sounds() {
        let quiet = shipped();
        let mut loud = quiet.clone();
        loud.tuning.gain_db += 6.0;
        let found = compared((&quiet, Method::Reference), (&loud, Method::Reference));
        for tally in found.by_contactor.iter().flatten() {
            assert!((tally.mean_db().unwrap() - 6.0).abs() < 1e-9, "{tally:?}");
            let largest_db = tally.largest.unwrap().difference_db;
            assert!((largest_db - 6.0).abs() < 1e-9, "{largest_db}");
        }
        let ranges = found.over_time.iter().flatten().filter_map(|s| s.range_db);
        for db in ranges.flatten() {
            assert!((db - 6.0).abs() < 1e-9, "{db}");
        }
        assert!(
            found.perceptual_level_db.iter().all(Option::is_some),
            "it is felt"
        );
    }

    #[test]
    fn a_band_that_one_of_them_lacks_is_said_and_never_a_number() {
        let scene = shipped();
        let mut without = scene.clone();
        without.tuning.gain_320_db = f64::NEG_INFINITY;
        let found = compared((&scene, Method::Table), (&without, Method::Table));
        for [low, high] in &found.by_contactor {
            assert_eq!(low.mean_db(), Some(0.0));
            assert_eq!((high.mean_db(), high.largest), (None, None));
            assert!(high.n_only[0] > 0 && high.n_only[1] == 0, "{high:?}");
        }
        let back = compared((&without, Method::Table), (&scene, Method::Table));
        assert!(back.in_all[1].n_only[1] > 0 && back.in_all[1].n_both == 0);
        assert_eq!(
            back.perceptual_level_db[1], None,
            "the first never sounded there"
        );
        let column = back.columns(1)[0][1];
        assert_eq!((column.range_db, column.is_only), (None, [false, true]));
    }

    #[test]
    fn odd_amplitudes_are_silence() {
        for (a_um, b_um) in [(0.0, f64::NAN), (f64::INFINITY, 0.0), (-1.0, 1e-4)] {
            assert_eq!(Contrast::of(a_um, b_um), Contrast::Silent);
        }
        assert_eq!(Contrast::of(1.0, 0.0), Contrast::OnlyA);
        assert_eq!(Contrast::of(1.0, 10.0), Contrast::Both(20.0));
    }

    #[test]
    fn long_paths_stay_small_and_keep_their_extremes() {
        let n_ticks = 3 * MAX_ENTRIES;
        let mut meter = DifferenceMeter::new(n_ticks);
        for tick in 0..n_ticks {
            let b_um = if tick == 100_000 { 100.0 } else { 1.0 };
            meter.add_amplitudes(tick, std::iter::once([[1.0, 0.0], [b_um, 0.0]]));
        }
        let found = meter.finish();
        assert_eq!((found.n_ticks, found.ticks_per_entry), (n_ticks, 3));
        assert_eq!(found.over_time.len() as u64, MAX_ENTRIES);
        let largest = found.in_all[0].largest.unwrap();
        assert_eq!((largest.tick, largest.contactor), (100_000, 0));
        assert!((largest.difference_db - 40.0).abs() < 1e-9);
        let columns = found.columns(100);
        let peaks = columns.iter().filter_map(|[low, _]| low.range_db);
        assert_eq!(peaks.filter(|range| range[1] > 39.0).count(), 1);
        assert!(columns.iter().all(|[_, high]| *high == Spread::default()));
    }

    #[test]
    fn whoever_has_enough_stops_both_runs() {
        let scene = shipped();
        let mut n_seen = 0;
        let mut sink = |_, _: [&[DisplayFrame]; 2]| {
            n_seen += 1;
            ControlFlow::Break(())
        };
        let pair = [(&scene, Method::Banded), (&scene, Method::Table)];
        let end = replay_pair(pair, (round(), None), &mut sink);
        assert!(end.unwrap().is_break() && n_seen == 1);
    }
}
