//! Experiments of one folder beside each other: a real against a virtual target, say.

use std::collections::BTreeMap;

use super::answers::{Rankings, rankings};
use super::included_trials::{Experiment, Subject};
use super::model::{Section, Table, cells};
use super::tables::{summaries, tests};
use crate::design::Kind;
use selvedge_statistics::variance::{holm, kruskal_wallis, one_way, welch};
use selvedge_statistics::{
    Computed, Outcome, Summary, TwoSamples, Undefined, paired_t, two_sample_t,
};

/// What Welch's t of two samples is called.
const WELCH: &str = "Welch t, two samples";

/// A score of every subject, %.
type Scores = Vec<(String, f64)>;

/// The experiments of every method whose answers are right or wrong: every two of them, and all
/// where there are three or more.
pub(super) fn compared(experiments: &[Experiment<'_>]) -> Option<Section> {
    let mut by_method: BTreeMap<&str, Vec<(&str, Scores)>> = BTreeMap::new();
    for experiment in experiments {
        if let Some(scores) = scores(experiment) {
            let of_method = by_method
                .entry(experiment.design.composition.kind().name())
                .or_default();
            of_method.push((&experiment.key, scores));
        }
    }
    by_method.retain(|_, all| all.len() > 1);
    if by_method.is_empty() {
        return None;
    }
    let mut section = Section::new("comparison", "Experiments compared");
    section.note(
        "Scores are shares of right answers by subject. Welch's t is the one to believe where \
         spreads differ; the paired test is of subjects who took part in both. Where there are \
         three experiments or more, p by Holm is Welch's, adjusted for all that are compared.",
    );
    let all = || by_method.values().flatten();
    let means: Vec<(String, Vec<f64>)> = all()
        .map(|(key, scores)| (format!("{key}, %"), values(scores)))
        .collect();
    section.table(summaries("means", "Right answers", &means));
    let found: Vec<Tested> = by_method
        .iter()
        .flat_map(|(name, all)| method(name, all))
        .collect();
    section.table(tests("tests", "Differences", &found));
    if by_method.values().any(|all| all.len() > 2) {
        section.table(adjusted(&found));
    }
    Some(section)
}

/// What was tested, and what came of it.
type Tested = (String, Computed<Outcome>);

/// The tests of one method's experiments.
fn method(name: &str, all: &[(&str, Scores)]) -> Vec<Tested> {
    let mut found = Vec::new();
    if all.len() > 2 {
        let groups: Vec<Vec<f64>> = all.iter().map(|(_, scores)| values(scores)).collect();
        let what = format!("all of {name}, %");
        found.push((what.clone(), one_way(&groups)));
        found.push((what.clone(), welch(&groups)));
        found.push((what, kruskal_wallis(&groups)));
    }
    for (i, (a, first)) in all.iter().enumerate() {
        for (b, second) in &all[i + 1..] {
            found.extend(two(&format!("{a}, less {b}, %"), first, second));
        }
    }
    found
}

/// Welch's p values, adjusted for each other.
fn adjusted(found: &[Tested]) -> Table {
    let columns = [
        ("what", "of what"),
        ("p", "p (Welch)"),
        ("p_holm", "p by Holm"),
    ];
    let mut table = Table::new("holm", "Differences, adjusted for each other", &columns);
    let outcomes = found
        .iter()
        .filter_map(|(what, found)| Some((what, found.as_ref().ok()?)));
    let (names, p): (Vec<&String>, Vec<f64>) = outcomes
        .filter(|(_, outcome)| outcome.test == WELCH)
        .map(|(what, outcome)| (what, outcome.p))
        .unzip();
    for ((what, p), p_holm) in names.iter().zip(&p).zip(holm(&p)) {
        table.push(cells![*what, *p, p_holm]);
    }
    table
}

fn values(scores: &Scores) -> Vec<f64> {
    scores.iter().map(|(_, score)| *score).collect()
}

fn two(what: &str, first: &Scores, second: &Scores) -> Vec<(String, Computed<Outcome>)> {
    let summaries =
        Summary::of(&values(first)).and_then(|a| Ok((a, Summary::of(&values(second))?)));
    let both = summaries.and_then(|(a, b)| two_sample_t(&a, &b));
    let part = |of: fn(TwoSamples) -> Outcome| both.clone().map(of);
    let common: Vec<[f64; 2]> = first
        .iter()
        .filter_map(|(name, score)| {
            let other = second.iter().find(|(other, _)| other == name)?;
            Some([*score, other.1])
        })
        .collect();
    let side = |at: usize| common.iter().map(|pair| pair[at]).collect::<Vec<f64>>();
    let paired = if common.is_empty() {
        Err(Undefined::because("no subject took part in both"))
    } else {
        paired_t(&side(0), &side(1))
    };
    vec![
        (what.to_owned(), part(|both| both.welch)),
        (what.to_owned(), part(|both| both.student)),
        (what.to_owned(), paired),
    ]
}

fn scores(experiment: &Experiment<'_>) -> Option<Scores> {
    let is_scored = match experiment.design.composition.kind() {
        Kind::Ranking => {
            let all = rankings(experiment);
            let of = |r: &Rankings<'_>| (r.subject.to_owned(), r.percent());
            return Some(all.iter().map(of).collect());
        }
        Kind::OddOneOut | Kind::Judgement | Kind::Choice => true,
        _ => false,
    };
    let of = |subject: &Subject<'_>| {
        let right: Vec<bool> = subject.trials().filter_map(|r| r.is_correct).collect();
        let n = right.iter().filter(|is_right| **is_right).count();
        (
            subject.name.to_owned(),
            100.0 * n as f64 / right.len() as f64,
        )
    };
    is_scored.then(|| experiment.subjects.iter().map(of).collect())
}
