//! What is played in a trial, one after the other: vibrations, or textiles that lie upon each other
//! and are uncovered one at a time.

use super::Layout;
use crate::design::{Design, Shown, Source, Tunable};
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
    let ms = match presentation.shown {
        Shown::Intervals => presentation.interval_ms,
        _ => ALONE_MS,
    };
    let played = match presentation.shown {
        Shown::Intervals if !design.plays_vibrations() => textiles(design, task),
        _ => vibrations(design, task),
    };
    let mut steps = Vec::new();
    for (played, own_ms) in played {
        if !steps.is_empty() {
            steps.push(SequenceStep::silence(ticks(PAUSE_MS)));
        }
        let n_ticks = ticks(own_ms.unwrap_or(ms));
        steps.push(SequenceStep { played, n_ticks });
    }
    steps
}

/// The textiles of a trial in the order in which they are uncovered.
fn textiles(design: &Design, task: &Task) -> Vec<(Played, Option<u32>)> {
    let places = Layout::of(design, task).places;
    let compared = |is_compared: bool| {
        let numbered = places.iter().enumerate();
        let of = numbered.filter(move |(_, place)| place.number.is_none() == is_compared);
        of.map(|(textile, _)| (Played::Textile(textile), None))
    };
    compared(true).chain(compared(false)).collect()
}

/// The vibrations of a trial, and how long those last that have a length of their own, ms.
fn vibrations(design: &Design, task: &Task) -> Vec<(Played, Option<u32>)> {
    let composition = &design.composition;
    let presentation = &composition.presentation;
    let adaptation = composition.adaptation.as_ref();
    let adaptation = adaptation.filter(|_| task.adapted.is_some());
    let levels: Vec<(Band, Option<f64>, Option<u32>)> = match adaptation {
        Some(adaptation) if adaptation.is_vibration() => {
            let interval = |at| (adaptation.band, task.adapted_at(adaptation, at), None);
            (0..presentation.n).map(interval).collect()
        }
        _ => {
            let lasts = adaptation.filter(|adaptation| adaptation.parameter == Tunable::Duration);
            let ms_at = |at| lasts.and_then(|lasts| task.adapted_at(lasts, at));
            let felt = task.reference.iter().chain(&task.items).enumerate();
            let vibration = |(at, item): (usize, &usize)| match design.stimuli.get(*item)?.source {
                Source::Vibration { band, level_db } => {
                    Some((band, Some(level_db), ms_at(at).map(to_whole)))
                }
                _ => None,
            };
            felt.filter_map(vibration).collect()
        }
    };
    let played = |(band, level_db, ms): (Band, Option<f64>, Option<u32>)| {
        let mut levels_db = [presentation.masker_db; 2];
        levels_db[band.index()] = level_db;
        // A band without a level is silent.
        let um = levels_db.map(|level_db| level_db.map_or(0.0, amplitude_of));
        (Played::Vibration(um), ms)
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
