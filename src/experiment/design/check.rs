//! What makes a design's values wrong, and how to mend them.

use std::collections::BTreeSet;

use super::check_adaptation::check_level;
use super::check_composition::check_composition;
use super::needs::{MOST_REPEATS, MOST_STIMULI, need, need_within};
use super::{Design, Form, Medium, Source};
use selvedge_foundation::files::{Flaw, Place};

type Checked = Result<(), Flaw>;

/// The first thing that is wrong with a design, whose first `n_named` stimuli are those of
/// `textiles`.
pub(super) fn check(design: &Design, n_named: usize) -> Checked {
    for (key, name) in [("study", &design.study), ("experiment", &design.experiment)] {
        let mend = "give 1 to 64 letters, digits, - and _: files are named by it";
        need(
            Design::is_name(name),
            ("", 0, key),
            format!("{key} is {name:?}"),
            mend,
        )?;
    }
    check_stimuli(design, n_named)?;
    check_composition(design)?;
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
        Source::Textile { id, variant } => {
            let what = format!("{id:?} is virtual, and the medium is \"real-cloth\"");
            let is_virtual = medium != Medium::RealCloth;
            need(is_virtual, place("textile"), what, "give cloth = \"…\"")?;
            for (key, value, unit) in variant.numbers() {
                let mend = format!("give a finite number of {unit}");
                need(
                    value.is_finite(),
                    place(key),
                    format!("{key} is {value}"),
                    mend,
                )?;
            }
            Ok(())
        }
        Source::Vibration { level_db, .. } => check_level(place("level_db"), *level_db),
    }
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
    let place = ("rules", 0, "least_share_caught");
    need_within(place, &rules.least_share_caught, 0.0..=1.0, "")?;
    let (order, form) = (&design.composition.order, &design.composition.response.form);
    let can_be_right = order.catch_trials > 0 && *form != Form::Choice;
    let is_possible = rules.least_share_caught <= 0.0 || can_be_right;
    let what = "no catch trial here can be answered rightly";
    let mend = "add catch_trials to [order] of pairs that are rated, numbered or called the same, \
                or take it away";
    need(is_possible, place, what, mend)?;
    let least_s = rules.least_response_s;
    let is_right = least_s >= 0.0 && least_s.is_finite();
    let what = format!("least_response_s is {least_s}");
    let place = ("rules", 0, "least_response_s");
    need(is_right, place, what, "give a number of s from 0")
}
