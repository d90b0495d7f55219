//! What makes a composition wrong: parts that do not go together, and how to mend them.

use std::collections::BTreeSet;

use super::check_adaptation::check_adaptation;
use super::check_presentation::{MOST_PLACES, MOST_SET, check_presentation};
use super::needs::{MOST_REPEATS, need, need_within};
use super::{
    Composition, Confidence, Design, Form, Response, Right, Scale, Sequence, Sets, Standard,
    Tunable, TunedParameter,
};
use crate::schedule::is_ranked;
use selvedge_foundation::files::Flaw;

/// Most stimuli that are put in order at once.
const MOST_RANKED: usize = 5;

type Checked = Result<(), Flaw>;

/// The first parts of a design's composition that do not go together.
pub(super) fn check_composition(design: &Design) -> Checked {
    let composition = &design.composition;
    check_presentation(design)?;
    check_order(design)?;
    check_response(design)?;
    if let Some(adaptation) = &composition.adaptation {
        return check_adaptation(design, adaptation);
    }
    let is_right = composition.order.sets != Sets::Adapted;
    let mend = "add [adaptation], or give other sets";
    need(is_right, ("order", 0, "sets"), "nothing is adapted", mend)
}

fn check_order(design: &Design) -> Checked {
    let composition = &design.composition;
    let (order, n) = (&composition.order, composition.presentation.n);
    let n_stimuli = design.stimuli.len();
    let sets = order.sets;
    let wrong = |what: String, mend: &str| Err(Flaw::new(("order", 0, "sets"), what, mend));
    need_within(
        ("order", 0, "repeats"),
        &order.repeats,
        1..=MOST_REPEATS,
        "",
    )?;
    let (places, least) = match sets {
        Sets::Each => (1..=1, 1),
        Sets::Pairs | Sets::Opposed => (2..=2, 2),
        Sets::Triads => (3..=3, 2),
        Sets::Targets => (2..=4, n),
        Sets::Balanced => (2..=MOST_PLACES, n),
        Sets::All => (2..=MOST_SET, 2),
        Sets::Adapted => (1..=8, 0),
    };
    if !places.contains(&n) || sets == Sets::Targets && n == 3 {
        let mend = match sets {
            Sets::Each => "give [presentation] kind = \"single\"",
            Sets::Pairs | Sets::Opposed => "give [presentation] kind = \"pair\"",
            Sets::Triads => "give [presentation] kind = \"places\", n = 3",
            Sets::Targets => "give [presentation] kind = \"places\", n = 2 or 4",
            _ => "give as many places as there are stimuli, or fewer",
        };
        return wrong(format!("{:?} of {n} at once", sets.name()), mend);
    }
    if n_stimuli < least {
        let mend = format!("name at least {least} in textiles = […] or as [[stimulus]]");
        return wrong(format!("there are {n_stimuli} stimuli"), &mend);
    }
    if sets == Sets::All && n != n_stimuli {
        return wrong(
            format!("{n_stimuli} stimuli at {n} places"),
            "give n as many, or leave it out",
        );
    }
    if sets == Sets::Targets && n == 4 && !is_ranked(n_stimuli) {
        let what = format!("{n_stimuli} stimuli cannot be ranked in fours");
        return wrong(what, "give 4, 7, 10, 13, 16 … of them");
    }
    let is_compared = composition.presentation.reference != Standard::None;
    if sets == Sets::Targets && !is_compared {
        let place = ("presentation", 0, "reference");
        let mend = "give reference = \"virtual\" or \"real-cloth\"";
        return Err(Flaw::new(place, "there is no target to compare with", mend));
    }
    check_sequence(composition)
}

fn check_sequence(composition: &Composition) -> Checked {
    let order = &composition.order;
    let name = order.sets.name();
    let is_square = matches!(order.sets, Sets::Each | Sets::Pairs);
    let is_sequenced = order.sequence == Sequence::Random || is_square;
    let what = format!("{name:?} are not put in a square");
    let place = ("order", 0, "sequence");
    need(is_sequenced, place, what, "give sequence = \"random\"")?;
    let catches = order.catch_trials;
    let is_none_right = order.sets == Sets::Pairs && composition.response.right.is_none();
    let can_catch = catches == 0 || is_none_right && catches <= MOST_REPEATS;
    let mend = "give catch_trials to pairs of which none is right, or take it away";
    let what = format!("{catches} catch trials of {name:?}");
    need(can_catch, ("order", 0, "catch_trials"), what, mend)
}

fn check_response(design: &Design) -> Checked {
    let composition = &design.composition;
    if let Some((what, mend)) = composition.misfit() {
        return Err(Flaw::new(("response", 0, "kind"), what, mend));
    }
    match &composition.response.form {
        Form::Words(words) | Form::BestWorst(words) => check_words(words)?,
        Form::Scales(scales) => check_scales(scales)?,
        Form::Number { modulus } => {
            let what = format!("modulus is {}", modulus.unwrap_or_default());
            let is_right = modulus.is_none_or(|value| value > 0.0 && value.is_finite());
            let place = ("response", 0, "modulus");
            need(is_right, place, what, "give a finite number above 0")?;
        }
        Form::Adjustment(parameters) => check_adjusting(parameters)?,
        Form::Choice | Form::SameDifferent | Form::Rank | Form::Piles => {}
    }
    check_right(design)?;
    check_confidence(&composition.response)
}

impl Composition {
    /// Why a form of answers does not go with what comes together, and how to mend it.
    fn misfit(&self) -> Option<(&'static str, &'static str)> {
        let (sets, n) = (self.order.sets, self.presentation.n);
        let is_ordered = matches!(sets, Sets::Balanced | Sets::All);
        let is_one_or_two = matches!(sets, Sets::Each | Sets::Pairs);
        let (is_right, what, mend) = match &self.response.form {
            Form::Choice => (
                n > 1,
                "there is one alone to choose",
                "give it two or more places",
            ),
            Form::Words(_) => (
                sets == Sets::Each || sets == Sets::Adapted && n == 1,
                "yes and no are said of one alone",
                "give [presentation] kind = \"single\"",
            ),
            Form::SameDifferent => (
                sets == Sets::Pairs,
                "only two are the same or different",
                "give [presentation] kind = \"pair\" and sets = \"pairs\"",
            ),
            Form::Rank => (
                (is_ordered || sets == Sets::Targets && n == 4) && n <= MOST_RANKED,
                "these are not ranked",
                "give sets = \"targets\" with 4 places, or \"balanced\" or \"all\" with 5 at most",
            ),
            Form::BestWorst(_) => (
                is_ordered && n > 2,
                "these have no two ends",
                "give sets = \"balanced\" and 3 places or more",
            ),
            Form::Scales(scales) if is_one_or_two => (
                sets == Sets::Each || scales.len() == 1,
                "two are rated on one scale",
                "keep one [[response.scale]]",
            ),
            Form::Scales(_) | Form::Number { .. } => (
                is_one_or_two,
                "numbers are given to one or two",
                "give [presentation] kind = \"single\" or \"pair\"",
            ),
            Form::Piles => (
                sets == Sets::All,
                "only all at once are put into piles",
                "give [presentation] kind = \"set\"",
            ),
            Form::Adjustment(_) => (
                sets == Sets::Each,
                "one alone is adjusted",
                "give [presentation] kind = \"single\" without [adaptation]",
            ),
        };
        (!is_right).then_some((what, mend))
    }
}

fn check_words(words: &[String; 2]) -> Checked {
    let is_word = |word: &String| !word.trim().is_empty() && !word.contains(['\n', ',']);
    let is_right = words.iter().all(is_word) && words[0] != words[1];
    let what = format!("the words are {words:?}");
    let mend = "give two different words";
    need(is_right, ("response", 0, "words"), what, mend)
}

fn check_confidence(response: &Response) -> Checked {
    let place = |key| ("response", 0, key);
    let is_chosen = matches!(
        response.form,
        Form::Choice | Form::Words(_) | Form::SameDifferent
    );
    let n = response.confidence.n_grades();
    let (what, mend) = ("confidence is asked of no choice", "take it away");
    need(n == 0 || is_chosen, place("confidence_grades"), what, mend)?;
    let what = format!("there are {n} grades of confidence");
    need(
        n != 1 && n <= 9,
        place("confidence_grades"),
        what,
        "give 2 to 9",
    )?;
    let Confidence::Words(words) = &response.confidence else {
        return Ok(());
    };
    let is_share = words.iter().all(|(_, weight)| (0.0..=1.0).contains(weight));
    let what = "a weight lies outside 0 to 1";
    need(
        is_share,
        place("confidence_weights"),
        what,
        "give numbers from 0 to 1",
    )?;
    let mut seen = BTreeSet::new();
    let are_words = words
        .iter()
        .all(|(word, _)| !word.is_empty() && seen.insert(word));
    let what = "two grades of confidence have one name";
    need(
        are_words,
        place("confidence_words"),
        what,
        "give each a word of its own",
    )
}

fn check_adjusting(parameters: &[TunedParameter]) -> Checked {
    let n = parameters.len();
    let what = format!("{n} parameters are turned at once");
    let mend = "give one or two [[response.parameter]]";
    need((1..=2).contains(&n), ("response", 0, "kind"), what, mend)?;
    let mut seen: Vec<Tunable> = Vec::new();
    for (nth, parameter) in parameters.iter().enumerate() {
        let place = |key| ("response.parameter", nth, key);
        let name = parameter.what.name();
        let what = format!("{name} is turned twice");
        let is_new = !seen.contains(&parameter.what);
        need(is_new, place("key"), what, "give another parameter")?;
        seen.push(parameter.what);
        let what = format!("{name} is not turned by hand");
        let mend = "give a gain or compression, or adapt it with [adaptation]";
        need(parameter.what.is_of_tuning(), place("key"), what, mend)?;
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

fn check_right(design: &Design) -> Checked {
    let composition = &design.composition;
    let place = ("response", 0, "right");
    let sets = composition.order.sets;
    let is_word = matches!(composition.response.form, Form::Words(_));
    let real = match &composition.response.right {
        None if sets == Sets::Opposed => {
            let mend = "add right = \"…\", the condition of what is to be chosen";
            return Err(Flaw::new(place, "nothing says which of two is right", mend));
        }
        None if is_word && sets == Sets::Each => {
            let mend = "add right = \"…\", the condition to which the first word is right";
            return Err(Flaw::new(place, "nothing says which word is right", mend));
        }
        None => return Ok(()),
        Some(Right::Later) => {
            let is_pair = sets == Sets::Pairs && composition.response.form == Form::Choice;
            let (what, mend) = (
                "there is no later one",
                "give it to a choice of sets = \"pairs\"",
            );
            return need(is_pair, place, what, mend);
        }
        Some(Right::Condition(real)) => real,
    };
    let is_used = sets == Sets::Opposed || is_word && sets == Sets::Each;
    let mend = "give it to \"yes-no\" of single stimuli or to sets = \"opposed\"";
    need(
        is_used,
        place,
        "a condition is right or wrong nowhere here",
        mend,
    )?;
    let stimuli = design.stimuli.iter();
    let (yes, no): (Vec<_>, Vec<_>) = stimuli.partition(|s| s.condition == *real);
    let which = if yes.is_empty() { "no" } else { "every" };
    let what = format!("{which} stimulus has the condition {real:?}");
    let mend = "give each [[stimulus]] its condition, at least one of them another";
    need(!yes.is_empty() && !no.is_empty(), place, what, mend)?;
    let lone = no
        .iter()
        .find(|one| !yes.iter().any(|other| other.material == one.material));
    match lone.filter(|_| sets == Sets::Opposed) {
        None => Ok(()),
        Some(lone) => {
            let what = format!(
                "no stimulus of that condition has the material {:?}",
                lone.material
            );
            let mend = "pairs share their material: state it for both";
            Err(Flaw::new(place, what, mend))
        }
    }
}

fn check_scales(scales: &[Scale]) -> Checked {
    let mend = "add [[response.scale]] with key, low and high";
    let is_any = !scales.is_empty();
    need(is_any, ("response", 0, "kind"), "there is no scale", mend)?;
    let mut seen = BTreeSet::new();
    for (nth, scale) in scales.iter().enumerate() {
        let is_key =
            Design::is_name(&scale.key) && !scale.key.contains('-') && seen.insert(&scale.key);
        let what = format!("a scale is called {:?}", scale.key);
        let mend = "give each a name of its own, of letters, digits and _";
        need(is_key, ("response.scale", nth, "key"), what, mend)?;
        let place = ("response.scale", nth, "points");
        let mend = "give 2 or more, or 0 for a line without points";
        need(scale.points != 1, place, "a scale of one point", mend)?;
    }
    Ok(())
}
