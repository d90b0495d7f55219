//! What makes levels and the way they are found wrong, and how to mend them.

use std::ops::RangeInclusive;

use super::check::{MOST_REPEATS, MOST_STIMULI};
use super::{Levels, QuestPlusTrack, StaircaseTrack, Stopping, Track};
use selvedge_foundation::files::{Flaw, Place};

/// Most trials that a series of levels may take: what never ends is stopped.
const MOST_TRIALS: usize = 10_000;
/// Levels that make sense, dB re 1 µm.
const LEVELS_DB: RangeInclusive<f64> = -120.0..=60.0;

pub(super) fn levels_flaw(levels: &Levels) -> Option<Flaw> {
    let place = |key| ("levels", 0, key);
    let [low, high] = levels.range_db;
    if !(2..=8).contains(&levels.intervals) {
        let what = format!("intervals is {}", levels.intervals);
        return Some(Flaw::new(place("intervals"), what, "give 2 to 8"));
    }
    if !(50..=5000).contains(&levels.interval_ms) {
        let what = format!("interval_ms is {}", levels.interval_ms);
        return Some(Flaw::new(place("interval_ms"), what, "give 50 to 5000"));
    }
    if !(LEVELS_DB.contains(&low) && LEVELS_DB.contains(&high) && low < high) {
        let what = format!("range_db is {low} to {high}");
        let mend = "give a lower and a higher level between -120 and 60 dB re 1 µm";
        return Some(Flaw::new(place("range_db"), what, mend));
    }
    if let Some(reference) = levels
        .reference_db
        .filter(|db| !(db.is_finite() && *db <= low))
    {
        let what = format!("reference_db is {reference}, not below the lowest level, {low}");
        let mend = "levels are what is compared with it: raise range_db or lower it";
        return Some(Flaw::new(place("reference_db"), what, mend));
    }
    track_flaw(levels).or_else(|| stopping_flaw(&levels.stopping, &levels.track))
}

fn track_flaw(levels: &Levels) -> Option<Flaw> {
    let [low, high] = levels.range_db;
    let outside = |values: &[f64]| values.iter().copied().find(|db| !(low..=high).contains(db));
    match &levels.track {
        Track::Staircase(staircase) => staircase_flaw(staircase).or_else(|| {
            let db = outside(&staircase.starts_db)?;
            let what = format!("a series begins at {db} dB, outside range_db");
            let mend = format!("begin between {low} and {high} dB");
            Some(Flaw::new(("levels.staircase", 0, "starts_db"), what, mend))
        }),
        Track::QuestPlus(track) => quest_plus_flaw(track, high - low),
        Track::Constant { levels_db, repeats } => {
            let place = |key| ("levels.constant", 0, key);
            if levels_db.is_empty() || levels_db.len() > MOST_STIMULI {
                let what = format!("there are {} levels", levels_db.len());
                let mend = format!("give 1 to {MOST_STIMULI}");
                return Some(Flaw::new(place("levels_db"), what, mend));
            }
            if let Some(db) = outside(levels_db) {
                let what = format!("{db} dB lies outside range_db");
                let mend = format!("stay between {low} and {high} dB");
                return Some(Flaw::new(place("levels_db"), what, mend));
            }
            let is_right = (1..=MOST_REPEATS).contains(repeats);
            let what = format!("repeats is {repeats}");
            let mend = format!("give 1 to {MOST_REPEATS}");
            (!is_right).then(|| Flaw::new(place("repeats"), what, mend))
        }
    }
}

fn quest_plus_flaw(track: &QuestPlusTrack, span_db: f64) -> Option<Flaw> {
    let place = |key| ("levels.quest_plus", 0, key);
    let grid_db = track.grid_db;
    if !(grid_db > 0.0 && (1.0..=500.0).contains(&(span_db / grid_db))) {
        let what = format!("grid_db is {grid_db}");
        let mend = "give a step that divides range_db into 1 to 500";
        return Some(Flaw::new(place("grid_db"), what, mend));
    }
    let widths = &track.widths;
    let is_width = |&width: &f64| width > 0.0 && width.is_finite();
    if widths.is_empty() || widths.len() > 100 || !widths.iter().all(is_width) {
        let what = format!("the widths are {widths:?}");
        let mend = "give 1 to 100 numbers above 0";
        return Some(Flaw::new(place("widths_db"), what, mend));
    }
    let lapses = &track.lapses;
    let is_lapse = |lapse: &f64| (0.0..=0.5).contains(lapse);
    let is_right = !lapses.is_empty() && lapses.len() <= 20 && lapses.iter().all(is_lapse);
    let what = format!("lapses is {lapses:?}");
    let mend = "give 1 to 20 shares from 0 to 0.5";
    (!is_right).then(|| Flaw::new(place("lapses"), what, mend))
}

fn staircase_flaw(staircase: &StaircaseTrack) -> Option<Flaw> {
    let place = |key| ("levels.staircase", 0, key);
    if !(1..=10).contains(&staircase.up) || !(1..=10).contains(&staircase.down) {
        let what = format!("{} up, {} down", staircase.up, staircase.down);
        return Some(Flaw::new(place("up"), what, "give 1 to 10 for each"));
    }
    let is_step = |&step: &f64| step > 0.0 && step.is_finite();
    if staircase.steps_db.is_empty() || !staircase.steps_db.iter().all(is_step) {
        let what = format!("steps_db is {:?}", staircase.steps_db);
        return Some(Flaw::new(
            place("steps_db"),
            what,
            "give one or more numbers above 0",
        ));
    }
    if !is_step(&staircase.up_over_down) {
        let what = format!("up_over_down is {}", staircase.up_over_down);
        return Some(Flaw::new(
            place("up_over_down"),
            what,
            "give a finite number above 0",
        ));
    }
    if staircase.starts_db.is_empty() || staircase.starts_db.len() > 16 {
        let what = format!("{} series are interleaved", staircase.starts_db.len());
        return Some(Flaw::new(
            place("starts_db"),
            what,
            "give where 1 to 16 series begin",
        ));
    }
    let n = staircase.reversals_averaged;
    let is_even = n > 0 && n.is_multiple_of(2);
    let what = || format!("reversals_averaged is {n}");
    let mend = "give an even number above 0: as many peaks as valleys";
    (!is_even).then(|| Flaw::new(place("reversals_averaged"), what(), mend))
}

fn stopping_flaw(stopping: &Stopping, track: &Track) -> Option<Flaw> {
    let place = |key| ("levels.stop", 0, key);
    let Track::Constant { .. } = track else {
        let most = stopping.trials;
        if most > MOST_TRIALS {
            let mend = format!("give {MOST_TRIALS} at most");
            return Some(Flaw::new(
                place("trials"),
                format!("trials is {most}"),
                mend,
            ));
        }
        let ends = match track {
            Track::Staircase(_) => most > 0 || stopping.reversals > 0,
            _ => most > 0 || stopping.posterior_sd_db > 0.0,
        };
        let mend = match track {
            Track::Staircase(_) => "state trials or reversals in [levels.stop]",
            _ => "state trials or posterior_sd_db in [levels.stop]",
        };
        return (!ends).then(|| Flaw::new(place("trials"), "nothing ends a series", mend));
    };
    None
}

/// A level that no array has.
pub(super) fn level_flaw(place: Place, level_db: f64) -> Option<Flaw> {
    let what = || format!("{} holds {level_db} dB", place.2);
    let mend = "give levels from -120 to 60 dB re 1 µm";
    (!LEVELS_DB.contains(&level_db)).then(|| Flaw::new(place, what(), mend))
}
