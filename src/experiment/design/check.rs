//! What makes a design's values wrong, and how to mend them.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::ops::RangeInclusive;

use super::check_levels::{check_level, check_levels};
use super::{
    Adjusting, Design, Judging, JudgingProtocol, Medium, Method, Rating, Source, Standard, Tunable,
    is_name,
};
use crate::schedule::is_ranked;
use selvedge_foundation::files::{Flaw, Place};

/// Most stimuli of a design: schedules are made at once.
pub(super) const MOST_STIMULI: usize = 400;
/// Most times that a stimulus may come.
pub(super) const MOST_REPEATS: usize = 1000;

type Checked = Result<(), Flaw>;

/// A flaw, unless all is right.
pub(super) fn need(
    is_right: bool,
    place: Place,
    what: impl Into<String>,
    mend: impl Into<String>,
) -> Checked {
    if is_right {
        return Ok(());
    }
    Err(Flaw::new(place, what, mend))
}

/// A flaw, unless a number lies within bounds.
pub(super) fn need_within<T: PartialOrd + Display>(
    place: Place,
    value: &T,
    bounds: RangeInclusive<T>,
    unit: &str,
) -> Checked {
    let mend = format!("give {} to {}{unit}", bounds.start(), bounds.end());
    need(
        bounds.contains(value),
        place,
        format!("{} is {value}", place.2),
        mend,
    )
}

/// The first thing that is wrong with a design, whose first `n_named` stimuli are those of
/// `textiles`.
pub(super) fn check(design: &Design, n_named: usize) -> Checked {
    for (key, name) in [("study", &design.study), ("experiment", &design.experiment)] {
        let mend = "give 1 to 64 letters, digits, - and _: files are named by it";
        need(
            is_name(name),
            ("", 0, key),
            format!("{key} is {name:?}"),
            mend,
        )?;
    }
    check_stimuli(design, n_named)?;
    check_method(design)?;
    check_course(design)?;
    let Some(error) = design
        .tuning
        .as_ref()
        .and_then(|tuning| tuning.check().err())
    else {
        return Ok(());
    };
    let place = ("tuning", 0, error.key());
    Err(Flaw::described(
        place,
        &error.to_string(),
        "give a finite number",
    ))
}

fn check_stimuli(design: &Design, n_named: usize) -> Checked {
    let n = design.stimuli.len();
    let mend = format!("give {MOST_STIMULI} at most");
    let what = format!("there are {n} stimuli");
    need(n <= MOST_STIMULI, ("", 0, "textiles"), what, mend)?;
    let mut seen = BTreeSet::new();
    for (at, stimulus) in design.stimuli.iter().enumerate() {
        // Those of `textiles` come first; the rest stand in tables of their own.
        let place = |key| match at.checked_sub(n_named) {
            None => ("", 0, "textiles"),
            Some(nth) => ("stimulus", nth, key),
        };
        let id = &stimulus.id;
        need(
            !id.is_empty(),
            place("id"),
            "a stimulus has no name",
            "give it an id",
        )?;
        let what = format!("two stimuli are called {id:?}");
        need(
            seen.insert(id),
            place("id"),
            what,
            "give each an id of its own",
        )?;
        check_source(&stimulus.source, design.medium, place)?;
    }
    Ok(())
}

fn check_source(source: &Source, medium: Medium, place: impl Fn(&'static str) -> Place) -> Checked {
    match source {
        Source::RealCloth(cloth) => {
            let what = format!("{cloth:?} is cloth on the table, and the medium is \"array\"");
            let mend = "name a textile of the library, or set medium = \"real-cloth\"";
            need(medium != Medium::Array, place("cloth"), what, mend)
        }
        Source::Textile { id, gain_db } => {
            let what = format!("{id:?} is virtual, and the medium is \"real-cloth\"");
            let is_virtual = medium != Medium::RealCloth;
            need(is_virtual, place("textile"), what, "give cloth = \"…\"")?;
            let what = format!("gain_db is {gain_db}");
            need(
                gain_db.is_finite(),
                place("gain_db"),
                what,
                "give a finite number of dB",
            )
        }
        Source::Vibration { level_db, .. } => check_level(place("level_db"), *level_db),
    }
}

fn check_method(design: &Design) -> Checked {
    let n = design.stimuli.len();
    let table = design.method.name();
    let at_least = |least: usize| {
        let mend = format!("name at least {least} in textiles = […] or as [[stimulus]]");
        need(
            n >= least,
            (table, 0, ""),
            format!("there are {n} stimuli"),
            mend,
        )
    };
    match &design.method {
        Method::Ranking(ranking) => check_ranking(ranking.target, design.medium, n),
        Method::OddOneOut(choosing) => {
            at_least(2)?;
            let weights = choosing.weights;
            let is_share = weights.iter().all(|weight| (0.0..=1.0).contains(weight));
            let what = format!("weights is {weights:?}");
            let place = ("odd_one_out", 0, "weights");
            need(is_share, place, what, "give three numbers from 0 to 1")
        }
        Method::Adjustment(adjusting) => {
            at_least(1)?;
            check_repeats(table, adjusting.repeats)?;
            check_adjusting(adjusting)
        }
        Method::Judgement(judging) => {
            at_least(2)?;
            check_judging(design, judging)?;
            check_repeats(table, judging.repeats)
        }
        Method::Levels(levels) => check_levels(levels),
        Method::Magnitude { repeats, modulus } => {
            at_least(2)?;
            check_repeats(table, *repeats)?;
            let value = modulus.unwrap_or(1.0);
            let is_right = value.is_finite() && value > 0.0;
            let (what, mend) = (
                format!("modulus is {value}"),
                "give a finite number above 0",
            );
            need(is_right, ("magnitude", 0, "modulus"), what, mend)
        }
        Method::Rating(rating) => {
            at_least(1)?;
            check_rating(rating)?;
            check_repeats(table, rating.repeats)
        }
    }
}

fn check_ranking(target: Standard, medium: Medium, n: usize) -> Checked {
    let place = ("ranking", 0, "target");
    let what = format!("{n} stimuli cannot be ranked in fours");
    need(is_ranked(n), place, what, "give 4, 7, 10, 13, 16 … of them")?;
    let mend = match target {
        Standard::None => "give \"virtual\" or \"real-cloth\"",
        Standard::Virtual if medium == Medium::RealCloth => {
            "give \"real-cloth\": nothing is virtual here"
        }
        _ => return Ok(()),
    };
    Err(Flaw::new(place, "there is no target to rank against", mend))
}

pub(super) fn check_repeats(table: &'static str, repeats: usize) -> Checked {
    need_within((table, 0, "repeats"), &repeats, 1..=MOST_REPEATS, "")
}

fn check_adjusting(adjusting: &Adjusting) -> Checked {
    let n = adjusting.parameters.len();
    let what = format!("{n} parameters are turned at once");
    need(
        (1..=2).contains(&n),
        ("adjustment", 0, "standard"),
        what,
        "give one or two",
    )?;
    let mut seen: Vec<Tunable> = Vec::new();
    for (nth, parameter) in adjusting.parameters.iter().enumerate() {
        let place = |key| ("adjustment.parameter", nth, key);
        let name = parameter.what.name();
        let what = format!("{name} is turned twice");
        let is_new = !seen.contains(&parameter.what);
        need(is_new, place("key"), what, "give another parameter")?;
        seen.push(parameter.what);
        let [from, to, step] = [parameter.from, parameter.to, parameter.step];
        let is_range = from.is_finite() && to.is_finite() && from < to;
        let is_step = step > 0.0 && step <= to - from;
        let what = format!("{name} goes from {from} to {to} in steps of {step}");
        let mend = "give from below to, and a step between";
        need(is_range && is_step, place("from"), what, mend)?;
        let is_inside = parameter.what != Tunable::Compression || from >= 0.0 && to <= 1.0;
        let what = format!("compression goes from {from} to {to}");
        need(is_inside, place("from"), what, "stay between 0 and 1")?;
    }
    Ok(())
}

fn check_judging(design: &Design, judging: &Judging) -> Checked {
    let stimuli = design.stimuli.iter();
    let (real, generated): (Vec<_>, Vec<_>) = stimuli.partition(|s| s.condition == judging.real);
    let which = if real.is_empty() { "no" } else { "every" };
    let what = format!("{which} stimulus has the condition {:?}", judging.real);
    let mend = "give each [[stimulus]] its condition, at least one of them another";
    let are_both = !real.is_empty() && !generated.is_empty();
    need(are_both, ("judgement", 0, "real"), what, mend)?;
    let mut alone = generated.iter();
    let lone = alone.find(|one| !real.iter().any(|other| other.material == one.material));
    match lone.filter(|_| judging.protocol == JudgingProtocol::Pair) {
        None => Ok(()),
        Some(lone) => {
            let what = format!("no real stimulus has the material {:?}", lone.material);
            let mend = "pairs share their material: state it for both";
            Err(Flaw::new(("judgement", 0, "protocol"), what, mend))
        }
    }
}

fn check_rating(rating: &Rating) -> Checked {
    let mend = "add [[rating.scale]] with key, low and high";
    let is_any = !rating.scales.is_empty();
    need(is_any, ("rating", 0, "repeats"), "there is no scale", mend)?;
    let mut seen = BTreeSet::new();
    for (nth, scale) in rating.scales.iter().enumerate() {
        let is_key = is_name(&scale.key) && !scale.key.contains('-') && seen.insert(&scale.key);
        let what = format!("a scale is called {:?}", scale.key);
        let mend = "give each a name of its own, of letters, digits and _";
        need(is_key, ("rating.scale", nth, "key"), what, mend)?;
        let place = ("rating.scale", nth, "points");
        let mend = "give 2 or more, or 0 for a line without points";
        need(scale.points != 1, place, "a scale of one point", mend)?;
    }
    Ok(())
}

fn check_course(design: &Design) -> Checked {
    let course = &design.course;
    need_within(
        ("course", 0, "break_s"),
        &course.break_s,
        0.0..=3600.0,
        " s",
    )?;
    let n = course.practice_trials;
    let what = format!("practice_trials is {n}");
    let mend = format!("give {MOST_REPEATS} at most");
    need(
        n <= MOST_REPEATS,
        ("course", 0, "practice_trials"),
        what,
        mend,
    )?;
    for (nth, movement) in course.familiarisation.iter().enumerate() {
        let is_time = (0.0..=3600.0).contains(&movement.for_s);
        let is_speed = (1.0..=1000.0).contains(&movement.speed_mm_per_s);
        let what = format!("{} s at {} mm/s", movement.for_s, movement.speed_mm_per_s);
        let mend = "give 0 to 3600 s at 1 to 1000 mm/s";
        let place = ("course.familiarisation", nth, "for_s");
        need(is_time && is_speed, place, what, mend)?;
    }
    let rules = &design.rules;
    let place = ("rules", 0, "least_share_correct");
    need_within(place, &rules.least_share_correct, 0.0..=1.0, "")?;
    let least_s = rules.least_response_s;
    let is_right = least_s >= 0.0 && least_s.is_finite();
    let what = format!("least_response_s is {least_s}");
    let place = ("rules", 0, "least_response_s");
    need(is_right, place, what, "give a number of s from 0")
}
