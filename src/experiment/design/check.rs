//! What makes a design's values wrong, and how to mend them.

use std::collections::BTreeSet;

use super::check_levels::{level_flaw, levels_flaw};
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

/// The first thing that is wrong with a design, whose first `n_named` stimuli are those of
/// `textiles`.
pub(super) fn flaw(design: &Design, n_named: usize) -> Option<Flaw> {
    names_flaw(design)
        .or_else(|| stimuli_flaw(design, n_named))
        .or_else(|| method_flaw(design))
        .or_else(|| course_flaw(design))
        .or_else(|| tuning_flaw(design))
}

fn names_flaw(design: &Design) -> Option<Flaw> {
    let names = [("study", &design.study), ("experiment", &design.experiment)];
    names.into_iter().find_map(|(key, name)| {
        let mend = "give 1 to 64 letters, digits, - and _: files are named by it";
        (!is_name(name)).then(|| Flaw::new(("", 0, key), format!("{key} is {name:?}"), mend))
    })
}

fn stimuli_flaw(design: &Design, n_named: usize) -> Option<Flaw> {
    let n = design.stimuli.len();
    if n > MOST_STIMULI {
        let what = format!("there are {n} stimuli");
        return Some(Flaw::new(
            ("", 0, "textiles"),
            what,
            format!("give {MOST_STIMULI} at most"),
        ));
    }
    let mut seen = BTreeSet::new();
    design
        .stimuli
        .iter()
        .enumerate()
        .find_map(|(at, stimulus)| {
            // Those of `textiles` come first; the rest stand in tables of their own.
            let place = |key| match at.checked_sub(n_named) {
                None => ("", 0, "textiles"),
                Some(nth) => ("stimulus", nth, key),
            };
            let id = &stimulus.id;
            if id.is_empty() {
                return Some(Flaw::new(
                    place("id"),
                    "a stimulus has no name",
                    "give it an id",
                ));
            }
            if !seen.insert(id) {
                let what = format!("two stimuli are called {id:?}");
                return Some(Flaw::new(place("id"), what, "give each an id of its own"));
            }
            source_flaw(&stimulus.source, design.medium, place)
        })
}

fn source_flaw(
    source: &Source,
    medium: Medium,
    place: impl Fn(&'static str) -> Place,
) -> Option<Flaw> {
    match source {
        Source::RealCloth(cloth) if medium == Medium::Array => {
            let what = format!("{cloth:?} is cloth on the table, and the medium is \"array\"");
            let mend = "name a textile of the library, or set medium = \"real-cloth\"";
            Some(Flaw::new(place("cloth"), what, mend))
        }
        Source::Textile { id, .. } if medium == Medium::RealCloth => {
            let what = format!("{id:?} is virtual, and the medium is \"real-cloth\"");
            Some(Flaw::new(place("textile"), what, "give cloth = \"…\""))
        }
        Source::Textile { gain_db, .. } if !gain_db.is_finite() => {
            let what = format!("gain_db is {gain_db}");
            Some(Flaw::new(
                place("gain_db"),
                what,
                "give a finite number of dB",
            ))
        }
        Source::Vibration { level_db, .. } => level_flaw(place("level_db"), *level_db),
        Source::RealCloth(_) | Source::Textile { .. } => None,
    }
}

fn method_flaw(design: &Design) -> Option<Flaw> {
    let n = design.stimuli.len();
    let table = design.method.name();
    match &design.method {
        Method::Ranking(ranking) => {
            let place = ("ranking", 0, "target");
            let what = format!("{n} stimuli cannot be ranked in fours");
            let mend = "give 4, 7, 10, 13, 16 … of them";
            let too_few = (!is_ranked(n)).then(|| Flaw::new(place, what, mend));
            too_few.or_else(|| {
                let is_real = design.medium == Medium::RealCloth;
                let mend = match ranking.target {
                    Standard::None => "give \"virtual\" or \"real-cloth\"",
                    Standard::Virtual if is_real => "give \"real-cloth\": nothing is virtual here",
                    _ => return None,
                };
                Some(Flaw::new(place, "there is no target to rank against", mend))
            })
        }
        Method::OddOneOut(choosing) => too_few(table, n, 2).or_else(|| {
            let place = ("odd_one_out", 0, "weights");
            let is_share = choosing
                .weights
                .iter()
                .all(|weight| (0.0..=1.0).contains(weight));
            let what = format!("weights is {:?}", choosing.weights);
            (!is_share).then(|| Flaw::new(place, what, "give three numbers from 0 to 1"))
        }),
        Method::Adjustment(adjusting) => too_few(table, n, 1)
            .or_else(|| repeats_flaw(table, adjusting.repeats))
            .or_else(|| adjusting_flaw(adjusting)),
        Method::Judgement(judging) => {
            too_few(table, n, 2).or_else(|| judging_flaw(design, judging))
        }
        Method::Levels(levels) => levels_flaw(levels),
        Method::Magnitude { repeats, modulus } => too_few(table, n, 2)
            .or_else(|| repeats_flaw(table, *repeats))
            .or_else(|| {
                let value = modulus.filter(|value| !(value.is_finite() && *value > 0.0))?;
                let what = format!("modulus is {value}");
                let mend = "give a finite number above 0";
                Some(Flaw::new(("magnitude", 0, "modulus"), what, mend))
            }),
        Method::Rating(rating) => too_few(table, n, 1).or_else(|| rating_flaw(rating)),
    }
}

fn too_few(table: &'static str, n: usize, least: usize) -> Option<Flaw> {
    let what = || format!("there are {n} stimuli");
    let mend = || format!("name at least {least} in textiles = […] or as [[stimulus]]");
    (n < least).then(|| Flaw::new((table, 0, ""), what(), mend()))
}

fn repeats_flaw(table: &'static str, repeats: usize) -> Option<Flaw> {
    let what = || format!("repeats is {repeats}");
    let mend = || format!("give 1 to {MOST_REPEATS}");
    let is_right = (1..=MOST_REPEATS).contains(&repeats);
    (!is_right).then(|| Flaw::new((table, 0, "repeats"), what(), mend()))
}

fn adjusting_flaw(adjusting: &Adjusting) -> Option<Flaw> {
    let n = adjusting.parameters.len();
    if n == 0 || n > 2 {
        let what = format!("{n} parameters are turned at once");
        return Some(Flaw::new(
            ("adjustment", 0, "standard"),
            what,
            "give one or two",
        ));
    }
    let mut seen: Vec<Tunable> = Vec::new();
    adjusting
        .parameters
        .iter()
        .enumerate()
        .find_map(|(nth, parameter)| {
            let place = |key| ("adjustment.parameter", nth, key);
            let name = parameter.what.name();
            if seen.contains(&parameter.what) {
                let what = format!("{name} is turned twice");
                return Some(Flaw::new(place("key"), what, "give another parameter"));
            }
            seen.push(parameter.what);
            let [from, to, step] = [parameter.from, parameter.to, parameter.step];
            let is_range = from.is_finite() && to.is_finite() && from < to;
            let is_step = step > 0.0 && step <= to - from;
            if !is_range || !is_step {
                let what = format!("{name} goes from {from} to {to} in steps of {step}");
                let mend = "give from below to, and a step between";
                return Some(Flaw::new(place("from"), what, mend));
            }
            let is_outside = parameter.what == Tunable::Compression && (from < 0.0 || to > 1.0);
            let what = format!("compression goes from {from} to {to}");
            is_outside.then(|| Flaw::new(place("from"), what, "stay between 0 and 1"))
        })
}

fn judging_flaw(design: &Design, judging: &Judging) -> Option<Flaw> {
    let is_real = |at: &usize| design.stimuli[*at].condition == judging.real;
    let (real, generated): (Vec<usize>, Vec<usize>) = (0..design.stimuli.len()).partition(is_real);
    if real.is_empty() || generated.is_empty() {
        let which = if real.is_empty() { "no" } else { "every" };
        let what = format!("{which} stimulus has the condition {:?}", judging.real);
        let mend = "give each [[stimulus]] its condition, at least one of them another";
        return Some(Flaw::new(("judgement", 0, "real"), what, mend));
    }
    if judging.protocol == JudgingProtocol::Pair {
        let material = |at: usize| &design.stimuli[at].material;
        let lone = generated
            .iter()
            .find(|&&at| !real.iter().any(|&other| material(other) == material(at)));
        if let Some(&at) = lone {
            let what = format!("no real stimulus has the material {:?}", material(at));
            let mend = "pairs share their material: state it for both";
            return Some(Flaw::new(("judgement", 0, "protocol"), what, mend));
        }
    }
    repeats_flaw("judgement", judging.repeats)
}

fn rating_flaw(rating: &Rating) -> Option<Flaw> {
    if rating.scales.is_empty() {
        let mend = "add [[rating.scale]] with key, low and high";
        return Some(Flaw::new(
            ("rating", 0, "repeats"),
            "there is no scale",
            mend,
        ));
    }
    let mut seen = BTreeSet::new();
    let flaw = rating.scales.iter().enumerate().find_map(|(nth, scale)| {
        let place = ("rating.scale", nth, "key");
        let is_key = is_name(&scale.key) && !scale.key.contains('-');
        if !is_key || !seen.insert(&scale.key) {
            let what = format!("a scale is called {:?}", scale.key);
            let mend = "give each a name of its own, of letters, digits and _";
            return Some(Flaw::new(place, what, mend));
        }
        let place = ("rating.scale", nth, "points");
        let mend = "give 2 or more, or 0 for a line without points";
        (scale.points == 1).then(|| Flaw::new(place, "a scale of one point", mend))
    });
    flaw.or_else(|| repeats_flaw("rating", rating.repeats))
}

fn course_flaw(design: &Design) -> Option<Flaw> {
    let course = &design.course;
    let is_time = |s: f64| (0.0..=3600.0).contains(&s);
    if !is_time(course.break_s) {
        let what = format!("break_s is {}", course.break_s);
        return Some(Flaw::new(
            ("course", 0, "break_s"),
            what,
            "give 0 to 3600 s",
        ));
    }
    if course.practice_trials > MOST_REPEATS {
        let what = format!("practice_trials is {}", course.practice_trials);
        let mend = format!("give {MOST_REPEATS} at most");
        return Some(Flaw::new(("course", 0, "practice_trials"), what, mend));
    }
    let movements = course.familiarisation.iter().enumerate();
    let flaw = movements.into_iter().find_map(|(nth, movement)| {
        let is_speed = (1.0..=1000.0).contains(&movement.speed_mm_per_s);
        let what = format!("{} s at {} mm/s", movement.for_s, movement.speed_mm_per_s);
        let mend = "give 0 to 3600 s at 1 to 1000 mm/s";
        let place = ("course.familiarisation", nth, "for_s");
        (!is_time(movement.for_s) || !is_speed).then(|| Flaw::new(place, what, mend))
    });
    flaw.or_else(|| rules_flaw(design))
}

fn rules_flaw(design: &Design) -> Option<Flaw> {
    let share = design.rules.least_share_correct;
    if !(0.0..=1.0).contains(&share) {
        let place = ("rules", 0, "least_share_correct");
        let what = format!("least_share_correct is {share}");
        return Some(Flaw::new(place, what, "give 0 to 1"));
    }
    let least_s = design.rules.least_response_s;
    let what = format!("least_response_s is {least_s}");
    let is_right = least_s >= 0.0 && least_s.is_finite();
    let place = ("rules", 0, "least_response_s");
    (!is_right).then(|| Flaw::new(place, what, "give a number of s from 0"))
}

fn tuning_flaw(design: &Design) -> Option<Flaw> {
    let error = design.tuning.as_ref()?.check().err()?;
    let place = ("tuning", 0, error.key());
    Some(Flaw::told(
        place,
        &error.to_string(),
        "give a finite number",
    ))
}
