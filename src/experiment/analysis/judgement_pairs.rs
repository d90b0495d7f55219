//! Pairs of which the real one was to be found, as comparisons: what was taken for real rather than
//! what.

use super::included_trials::{Experiment, Subject};
use super::judgement_cells::levels;
use super::model::Section;
use super::options::Options;
use super::pairs::{NOTE, Pairs};
use crate::{AnswerValue, Record};
use selvedge_statistics::Computed;
use selvedge_statistics::ranking::Preferences;

/// The stimulus that was taken for real, and the other.
fn chosen(record: &Record) -> Option<[usize; 2]> {
    match (record.trial.task.items.as_slice(), record.value()) {
        (&[first, second], Some(AnswerValue::Chosen(0))) => Some([first, second]),
        (&[first, second], Some(AnswerValue::Chosen(_))) => Some([second, first]),
        _ => None,
    }
}

/// Scales of conditions and of stimuli.
pub(super) fn section(experiment: &Experiment<'_>, options: &Options) -> Section {
    let mut section = experiment.section("pairs", "taken for real, pair by pair");
    section.note(NOTE);
    section.note(
        "Preferred is what was taken for real. Conditions are compared over all materials; stimuli \
         are on one scale only where pairs join them.",
    );
    let conditions = levels(experiment, None, |s| &s.condition);
    let condition_of = |item: usize| {
        let own = &experiment.design.stimuli[item].condition;
        conditions.iter().position(|condition| condition == own)
    };
    let names = experiment.ids();
    for (of, names, subjects) in [
        (
            "conditions",
            &conditions,
            comparisons(experiment, conditions.len(), condition_of),
        ),
        (
            "stimuli",
            &names,
            comparisons(experiment, names.len(), Some),
        ),
    ] {
        match Pairs::of(names, subjects.into_iter()) {
            Ok(pairs) => pairs.describe(of, of, options, &mut section),
            Err(why) => section.note(format!("No scale of {of}: {}.", why.reason)),
        }
    }
    section
}

/// Each subject's comparisons of what stimuli stand for; two of one kind are none.
fn comparisons<'a>(
    experiment: &Experiment<'a>,
    n_items: usize,
    item_of: impl Fn(usize) -> Option<usize>,
) -> Vec<(&'a str, Computed<Preferences>)> {
    let of = |subject: &Subject<'a>| {
        let mut wins = vec![vec![0; n_items]; n_items];
        for [upper, lower] in subject.trials().filter_map(chosen) {
            if let Some((upper, lower)) = item_of(upper).zip(item_of(lower))
                && upper != lower
            {
                wins[upper][lower] += 1;
            }
        }
        (subject.name, Preferences::of_wins(&wins))
    };
    experiment.subjects.iter().map(of).collect()
}
