//! What is played in a trial, one after the other: vibrations, or textiles that lie upon each other
//! and are uncovered one at a time.

use super::Layout;
use crate::design::{Design, Shown, Source};
use crate::trial::Task;
use selvedge_engine::{Played, SequenceStep, TICKS_PER_S};
use selvedge_foundation::numerics::{to_single, to_whole};
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_textile::tactile::Band;

/// Between two intervals, ms.
const PAUSE_MS: u32 = 300;
/// A vibration that is felt alone, ms.
const ALONE_MS: u32 = 1000;

/// What is played in a trial, a pause between each two: step 2n is interval n.
///
/// Empty where cloth lies at places. What everything is compared with comes first. A textile goes
/// by its number in the scene of the trial's [`Layout`].
pub fn sequence(design: &Design, task: &Task) -> Vec<SequenceStep> {
    let presentation = &design.composition.presentation;
    let (played, ms) = match presentation.shown {
        Shown::Intervals if !design.plays_vibrations() => {
            (textiles(design, task), presentation.interval_ms)
        }
        Shown::Intervals => (vibrations(design, task), presentation.interval_ms),
        _ => (vibrations(design, task), ALONE_MS),
    };
    let mut steps = Vec::new();
    for played in played {
        if !steps.is_empty() {
            steps.push(SequenceStep::silence(ticks(PAUSE_MS)));
        }
        let n_ticks = ticks(ms);
        steps.push(SequenceStep { played, n_ticks });
    }
    steps
}

/// The textiles of a trial in the order in which they are uncovered.
fn textiles(design: &Design, task: &Task) -> Vec<Played> {
    let places = Layout::of(design, task).places;
    let compared = |is_compared: bool| {
        let numbered = places.iter().enumerate();
        let of = numbered.filter(move |(_, place)| place.number.is_none() == is_compared);
        of.map(|(textile, _)| Played::Textile(textile))
    };
    compared(true).chain(compared(false)).collect()
}

/// The vibrations of a trial.
fn vibrations(design: &Design, task: &Task) -> Vec<Played> {
    let composition = &design.composition;
    let presentation = &composition.presentation;
    let levels: Vec<(Band, Option<f64>)> = match (&composition.adaptation, task.adapted) {
        (Some(adaptation), Some(adapted)) if adaptation.is_vibration() => {
            let level_db = |interval: usize| {
                let is_adapted = presentation.n == 1 || Some(interval) == task.right;
                is_adapted.then_some(adapted.value).or(adaptation.reference)
            };
            let intervals = 0..presentation.n;
            intervals
                .map(|at| (adaptation.band, level_db(at)))
                .collect()
        }
        _ => {
            let felt = task.reference.iter().chain(&task.items);
            let vibration = |item: &usize| match design.stimuli.get(*item)?.source {
                Source::Vibration { band, level_db } => Some((band, Some(level_db))),
                _ => None,
            };
            felt.filter_map(vibration).collect()
        }
    };
    let played = |(band, level_db): (Band, Option<f64>)| {
        let mut levels_db = [presentation.masker_db; 2];
        levels_db[band.index()] = level_db;
        // A band without a level is silent.
        Played::Vibration(levels_db.map(|level_db| level_db.map_or(0.0, amplitude_of)))
    };
    levels.into_iter().map(played).collect()
}

/// A level, dB re 1 µm, as a peak amplitude, µm.
fn amplitude_of(level_db: f64) -> f32 {
    to_single(factor_of_gain(level_db))
}

/// The whole ticks that are nearest to a time, at least one.
fn ticks(ms: u32) -> u32 {
    to_whole((f64::from(ms) * 1e-3 * TICKS_PER_S).round().max(1.0))
}
