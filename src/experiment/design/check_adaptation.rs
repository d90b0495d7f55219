//! What makes levels and the way they are found wrong, and how to mend them.

use super::needs::{MOST_REPEATS, MOST_STIMULI, need, need_within};
use super::parameter::LEVELS_DB;
use super::{
    Adaptation, Design, Form, QuestPlusTrack, Seeks, Sets, Source, StaircaseTrack, Stopping, Track,
    Tunable,
};
use selvedge_engine::TICKS_PER_S;
use selvedge_foundation::files::{Flaw, Place};

/// Most trials that a series of levels may take: what never ends is stopped.
const MOST_TRIALS: usize = 10_000;
/// From tick to tick, ms: what vibrations last is so many of these.
const TICK_MS: f64 = 1e3 / TICKS_PER_S;

type Checked = Result<(), Flaw>;

pub(super) fn check_adaptation(design: &Design, adaptation: &Adaptation) -> Checked {
    let place = |key| ("adaptation", 0, key);
    check_adapted(design, adaptation)?;
    let [low, high] = adaptation.range;
    let name = adaptation.parameter.name();
    let bounds = adaptation.parameter.bounds();
    let is_range = bounds.contains(&low) && bounds.contains(&high) && low < high;
    let mend = format!(
        "give a lower and a higher value of {} to {}",
        bounds.start(),
        bounds.end()
    );
    need(
        is_range,
        place("range"),
        format!("the range of {name} is {low} to {high}"),
        mend,
    )?;
    let reference = adaptation.reference.unwrap_or(low);
    if adaptation.seeks == Seeks::Difference {
        let is_below = reference.is_finite() && reference <= low;
        let what = format!("the reference is {reference}, not below the lowest value, {low}");
        let mend = "values are what is compared with it: raise the range or lower it";
        need(is_below, place("reference"), what, mend)?;
    }
    check_track(adaptation)?;
    check_ticks(adaptation)?;
    check_stopping(&adaptation.stopping, &adaptation.track)
}

/// What is adapted, and what it is told from.
fn check_adapted(design: &Design, adaptation: &Adaptation) -> Checked {
    let composition = &design.composition;
    let place = |key| ("adaptation", 0, key);
    let (n, n_stimuli) = (composition.presentation.n, design.stimuli.len());
    let is_of_sets = composition.order.sets == Sets::Adapted;
    let mend = "take sets away: what is adapted says what comes together";
    need(
        is_of_sets,
        ("order", 0, "sets"),
        "sets and an adaptation",
        mend,
    )?;
    let parameter = adaptation.parameter;
    let expected = usize::from(!adaptation.is_vibration());
    let what = format!("{n_stimuli} stimuli, and {} is adapted", parameter.name());
    let mend = match expected {
        0 => "name none: the vibration is all that is felt",
        _ => "name one, whose number is adapted",
    };
    need(n_stimuli == expected, place("parameter"), what, mend)?;
    if let Some(stimulus) = design.stimuli.first() {
        let (is_its, mend) = match (parameter, &stimulus.source) {
            (Tunable::Duration, source) => (
                matches!(source, Source::Vibration { .. }),
                "give it band_hz and level_db",
            ),
            (_, source) => (
                matches!(source, Source::Textile { .. }),
                "name a textile of the library",
            ),
        };
        let what = format!("{:?} has no {}", stimulus.id, parameter.name());
        need(is_its, place("parameter"), what, mend)?;
    }
    let needs_reference = n > 1 && !adaptation.is_vibration();
    let mend = "add reference, which the others are at";
    let is_told = !needs_reference || adaptation.reference.is_some();
    need(
        is_told,
        place("parameter"),
        "nothing says what the others are at",
        mend,
    )?;
    let is_equality = adaptation.seeks == Seeks::Equality;
    let (what, mend) = match &composition.response.form {
        Form::Choice if is_equality && (n != 2 || adaptation.reference.is_none()) => {
            ("equality is between two", "give n = 2 and a reference")
        }
        Form::Words(_) if !is_equality => (
            "yes is not right or wrong here",
            "give seeks = \"equality\"",
        ),
        Form::Choice | Form::Words(_) => return Ok(()),
        _ => (
            "answers that say neither more nor less",
            "give [response] kind = \"choice\" or \"yes-no\"",
        ),
    };
    Err(Flaw::new(("response", 0, "kind"), what, mend))
}

fn check_track(adaptation: &Adaptation) -> Checked {
    let [low, high] = adaptation.range;
    let outside = |values: &[f64]| values.iter().copied().find(|x| !(low..=high).contains(x));
    match &adaptation.track {
        Track::Staircase(staircase) => {
            check_staircase(staircase)?;
            let Some(start) = outside(&staircase.starts) else {
                return Ok(());
            };
            let what = format!("a series begins at {start}, outside the range");
            let mend = format!("begin between {low} and {high}");
            Err(Flaw::new(("adaptation.staircase", 0, "starts"), what, mend))
        }
        Track::QuestPlus(track) => check_quest_plus(track, high - low),
        Track::Constant { values, repeats } => {
            let place = ("adaptation.constant", 0, "values");
            let n = values.len();
            let what = format!("there are {n} values");
            let mend = format!("give 1 to {MOST_STIMULI}");
            need((1..=MOST_STIMULI).contains(&n), place, what, mend)?;
            if let Some(value) = outside(values) {
                let mend = format!("stay between {low} and {high}");
                let what = format!("{value} lies outside the range");
                return Err(Flaw::new(place, what, mend));
            }
            let place = ("adaptation.constant", 0, "repeats");
            need_within(place, repeats, 1..=MOST_REPEATS, "")
        }
    }
}

/// What vibrations last is whole ticks.
fn check_ticks(adaptation: &Adaptation) -> Checked {
    if adaptation.parameter != Tunable::Duration {
        return Ok(());
    }
    let [low, high] = adaptation.range;
    let mut stated = vec![("adaptation", "range", vec![low, high])];
    stated.extend(
        adaptation
            .reference
            .map(|ms| ("adaptation", "reference", vec![ms])),
    );
    match &adaptation.track {
        Track::Staircase(track) => {
            let up = track.steps.iter().map(|step| step * track.up_over_down);
            stated.extend([
                ("adaptation.staircase", "steps", track.steps.clone()),
                ("adaptation.staircase", "up_over_down", up.collect()),
                ("adaptation.staircase", "starts", track.starts.clone()),
            ]);
        }
        Track::QuestPlus(track) => stated.push(("adaptation.quest_plus", "grid", vec![track.grid])),
        Track::Constant { values, .. } => {
            stated.push(("adaptation.constant", "values", values.clone()));
        }
    }
    let is_off = |ms: &f64| (ms / TICK_MS - (ms / TICK_MS).round()).abs() > 1e-9;
    for (table, key, all) in stated {
        let odd = all.into_iter().find(is_off);
        let what = format!("{key} makes {} ms", odd.unwrap_or_default());
        let mend = "give multiples of 25 ms, the ticks of the array";
        need(odd.is_none(), (table, 0, key), what, mend)?;
    }
    Ok(())
}

fn check_quest_plus(track: &QuestPlusTrack, span: f64) -> Checked {
    let place = |key| ("adaptation.quest_plus", 0, key);
    let QuestPlusTrack {
        grid,
        widths,
        lapses,
    } = track;
    let is_step = *grid > 0.0 && (1.0..=500.0).contains(&(span / grid));
    let mend = "give a step that divides the range into 1 to 500";
    need(is_step, place("grid"), format!("grid is {grid}"), mend)?;
    let are_widths =
        (1..=100).contains(&widths.len()) && widths.iter().all(|&value| is_above_0(value));
    let what = format!("the widths are {widths:?}");
    need(
        are_widths,
        place("widths"),
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
    let place = |key| ("adaptation.staircase", 0, key);
    let (up, down) = (staircase.up, staircase.down);
    let is_rule = (1..=10).contains(&up) && (1..=10).contains(&down);
    need(
        is_rule,
        place("up"),
        format!("{up} up, {down} down"),
        "give 1 to 10 for each",
    )?;
    let steps = &staircase.steps;
    let are_steps = !steps.is_empty() && steps.iter().all(|&value| is_above_0(value));
    let what = format!("steps is {steps:?}");
    need(
        are_steps,
        place("steps"),
        what,
        "give one or more numbers above 0",
    )?;
    let ratio = staircase.up_over_down;
    let what = format!("up_over_down is {ratio}");
    let mend = "give a finite number above 0";
    need(is_above_0(ratio), place("up_over_down"), what, mend)?;
    let n = staircase.starts.len();
    let what = format!("{n} series are interleaved");
    let mend = "give where 1 to 16 series begin";
    need((1..=16).contains(&n), place("starts"), what, mend)?;
    let n = staircase.reversals_averaged;
    let is_even = n > 0 && n.is_multiple_of(2);
    let what = format!("reversals_averaged is {n}");
    let mend = "give an even number above 0: as many peaks as valleys";
    need(is_even, place("reversals_averaged"), what, mend)
}

fn check_stopping(stopping: &Stopping, track: &Track) -> Checked {
    let place = ("adaptation.stop", 0, "trials");
    let most = stopping.trials;
    let (is_otherwise_ended, mend) = match track {
        Track::Constant { .. } => return Ok(()),
        Track::Staircase(_) => (
            stopping.reversals > 0,
            "state trials or reversals in [adaptation.stop]",
        ),
        Track::QuestPlus(_) => (
            stopping.posterior_sd > 0.0,
            "state trials or posterior_sd in [adaptation.stop]",
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
