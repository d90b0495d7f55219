//! What makes levels and the way they are found wrong, and how to mend them.

use std::ops::RangeInclusive;

use super::check::{MOST_STIMULI, check_repeats, need, need_within};
use super::{Levels, QuestPlusTrack, StaircaseTrack, Stopping, Track};
use selvedge_foundation::files::{Flaw, Place};

/// Most trials that a series of levels may take: what never ends is stopped.
const MOST_TRIALS: usize = 10_000;
/// Levels that make sense, dB re 1 µm.
const LEVELS_DB: RangeInclusive<f64> = -120.0..=60.0;

type Checked = Result<(), Flaw>;

pub(super) fn check_levels(levels: &Levels) -> Checked {
    let place = |key| ("levels", 0, key);
    let [low, high] = levels.range_db;
    need_within(place("intervals"), &levels.intervals, 2..=8, "")?;
    need_within(place("interval_ms"), &levels.interval_ms, 50..=5000, "")?;
    let is_range = LEVELS_DB.contains(&low) && LEVELS_DB.contains(&high) && low < high;
    let mend = "give a lower and a higher level between -120 and 60 dB re 1 µm";
    need(
        is_range,
        place("range_db"),
        format!("range_db is {low} to {high}"),
        mend,
    )?;
    let reference = levels.reference_db.unwrap_or(low);
    let is_below = reference.is_finite() && reference <= low;
    let what = format!("reference_db is {reference}, not below the lowest level, {low}");
    let mend = "levels are what is compared with it: raise range_db or lower it";
    need(is_below, place("reference_db"), what, mend)?;
    check_track(levels)?;
    check_stopping(&levels.stopping, &levels.track)
}

fn check_track(levels: &Levels) -> Checked {
    let [low, high] = levels.range_db;
    let outside = |values: &[f64]| values.iter().copied().find(|db| !(low..=high).contains(db));
    match &levels.track {
        Track::Staircase(staircase) => {
            check_staircase(staircase)?;
            let Some(db) = outside(&staircase.starts_db) else {
                return Ok(());
            };
            let what = format!("a series begins at {db} dB, outside range_db");
            let mend = format!("begin between {low} and {high} dB");
            Err(Flaw::new(("levels.staircase", 0, "starts_db"), what, mend))
        }
        Track::QuestPlus(track) => check_quest_plus(track, high - low),
        Track::Constant { levels_db, repeats } => {
            let place = ("levels.constant", 0, "levels_db");
            let n = levels_db.len();
            let what = format!("there are {n} levels");
            let mend = format!("give 1 to {MOST_STIMULI}");
            need((1..=MOST_STIMULI).contains(&n), place, what, mend)?;
            if let Some(db) = outside(levels_db) {
                let mend = format!("stay between {low} and {high} dB");
                return Err(Flaw::new(
                    place,
                    format!("{db} dB lies outside range_db"),
                    mend,
                ));
            }
            check_repeats("levels.constant", *repeats)
        }
    }
}

fn check_quest_plus(track: &QuestPlusTrack, span_db: f64) -> Checked {
    let place = |key| ("levels.quest_plus", 0, key);
    let QuestPlusTrack {
        grid_db,
        widths,
        lapses,
    } = track;
    let is_step = *grid_db > 0.0 && (1.0..=500.0).contains(&(span_db / grid_db));
    let mend = "give a step that divides range_db into 1 to 500";
    need(
        is_step,
        place("grid_db"),
        format!("grid_db is {grid_db}"),
        mend,
    )?;
    let are_widths =
        (1..=100).contains(&widths.len()) && widths.iter().all(|&value| is_above_0(value));
    let what = format!("the widths are {widths:?}");
    need(
        are_widths,
        place("widths_db"),
        what,
        "give 1 to 100 numbers above 0",
    )?;
    let is_lapse = |lapse: &f64| (0.0..=0.5).contains(lapse);
    let are_lapses = (1..=20).contains(&lapses.len()) && lapses.iter().all(is_lapse);
    let what = format!("lapses is {lapses:?}");
    need(
        are_lapses,
        place("lapses"),
        what,
        "give 1 to 20 shares from 0 to 0.5",
    )
}

fn is_above_0(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn check_staircase(staircase: &StaircaseTrack) -> Checked {
    let place = |key| ("levels.staircase", 0, key);
    let (up, down) = (staircase.up, staircase.down);
    let is_rule = (1..=10).contains(&up) && (1..=10).contains(&down);
    need(
        is_rule,
        place("up"),
        format!("{up} up, {down} down"),
        "give 1 to 10 for each",
    )?;
    let steps_db = &staircase.steps_db;
    let are_steps = !steps_db.is_empty() && steps_db.iter().all(|&value| is_above_0(value));
    let what = format!("steps_db is {steps_db:?}");
    need(
        are_steps,
        place("steps_db"),
        what,
        "give one or more numbers above 0",
    )?;
    let ratio = staircase.up_over_down;
    let what = format!("up_over_down is {ratio}");
    let mend = "give a finite number above 0";
    need(is_above_0(ratio), place("up_over_down"), what, mend)?;
    let n = staircase.starts_db.len();
    let what = format!("{n} series are interleaved");
    let mend = "give where 1 to 16 series begin";
    need((1..=16).contains(&n), place("starts_db"), what, mend)?;
    let n = staircase.reversals_averaged;
    let is_even = n > 0 && n.is_multiple_of(2);
    let what = format!("reversals_averaged is {n}");
    let mend = "give an even number above 0: as many peaks as valleys";
    need(is_even, place("reversals_averaged"), what, mend)
}

fn check_stopping(stopping: &Stopping, track: &Track) -> Checked {
    let place = ("levels.stop", 0, "trials");
    let most = stopping.trials;
    let (is_otherwise_ended, mend) = match track {
        Track::Constant { .. } => return Ok(()),
        Track::Staircase(_) => (
            stopping.reversals > 0,
            "state trials or reversals in [levels.stop]",
        ),
        Track::QuestPlus(_) => (
            stopping.posterior_sd_db > 0.0,
            "state trials or posterior_sd_db in [levels.stop]",
        ),
    };
    let at_most = format!("give {MOST_TRIALS} at most");
    need(
        most <= MOST_TRIALS,
        place,
        format!("trials is {most}"),
        at_most,
    )?;
    need(
        most > 0 || is_otherwise_ended,
        place,
        "nothing ends a series",
        mend,
    )
}

/// Refuses a level that no array has.
pub(super) fn check_level(place: Place, level_db: f64) -> Checked {
    let what = format!("{} holds {level_db} dB", place.2);
    let mend = "give levels from -120 to 60 dB re 1 µm";
    need(LEVELS_DB.contains(&level_db), place, what, mend)
}
