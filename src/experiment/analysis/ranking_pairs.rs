//! Rankings taken apart into pairs: which textiles seem near to a target whatever it is.

use super::Options;
use super::kept::Experiment;
use super::model::Section;
use super::pairs::{Pairs, TOLD};
use super::ranking::Rankings;
use selvedge_statistics::ranking::{Preferences, RankTrial};

/// The alternatives of a trial that are not its target, the nearest first.
fn others(trial: &RankTrial) -> Vec<usize> {
    let mut all = trial.best_first();
    all.retain(|item| *item != trial.target);
    all
}

/// Scales of all alternatives but the target, over all targets.
pub(super) fn section(
    experiment: &Experiment<'_>,
    all: &[Rankings<'_>],
    options: &Options,
) -> Section {
    let title = format!(
        "{}: nearer to whatever the target was",
        experiment.design.title
    );
    let mut section = Section::new(experiment.key("pairs"), title);
    section.note(
        "Every ranking is taken apart into its pairs of alternatives that were not the target, all \
         targets together: preferred is what was ranked nearer. Values that differ say that some \
         textiles are ranked near whatever the target is.",
    );
    section.note(TOLD);
    section.note(
        "**Pairs of one ranking are not independent**: errors that take them so are too small, and \
         so are their p. Errors over subjects, by drawing subjects again, are the ones to quote.",
    );
    let names = experiment.ids();
    let of = |one: &Rankings<'_>| {
        let rankings: Vec<Vec<usize>> = one.trials.iter().map(others).collect();
        Preferences::of_rankings(names.len(), &rankings)
    };
    let subjects = all.iter().map(|one| (one.subject, of(one)));
    match Pairs::of(&names, subjects) {
        Ok(pairs) => pairs.tell("alternatives", "alternatives", options, &mut section),
        Err(why) => section.note(format!("No pairs: {}.", why.reason)),
    }
    section
}
