//! Experiments of one folder beside each other: a real against a virtual target, say.

use std::collections::BTreeMap;

use super::answers::{Rankings, rankings};
use super::included_trials::{Experiment, Subject};
use super::model::{Section, known};
use super::tables::{summaries, tests};
use crate::design::Kind;
use selvedge_statistics::variance::{holm, kruskal_wallis, one_way, welch};
use selvedge_statistics::{Computed, Outcome, Summary, TwoSamples, Undefined, paired_t};

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
         spreads differ; the paired test is of subjects who took part in both. Three experiments \
         or more are compared together first; p by Holm is Welch's t of every two of them, \
         adjusted for each other.",
    );
    let all = || by_method.values().flatten();
    let means: Vec<(String, Vec<f64>)> = all()
        .map(|(key, scores)| (format!("{key}, %"), values(scores)))
        .collect();
    section.table(summaries("means", "Right answers", &means));
    let (mut found, mut p_holm) = (Vec::new(), Vec::new());
    for (name, all) in &by_method {
        let own = method(name, all);
        p_holm.extend(adjusted(&own));
        found.extend(own);
    }
    let mut table = tests("tests", "Differences", &found);
    if p_holm.iter().any(Option::is_some) {
        let why = "Welch's t of three experiments or more alone has it";
        let cells = p_holm.into_iter().map(|p| known(p, why));
        table.column_after("p", ("p_holm", "p by Holm"), cells);
    }
    section.table(table);
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

/// p of Welch's t of every two of three experiments or more, adjusted for each other; nothing in
/// the rows of other tests.
fn adjusted(found: &[Tested]) -> Vec<Option<f64>> {
    let is_welch = |outcome: &&Outcome| outcome.test == WELCH;
    let p = found.iter().map(|(_, found)| {
        let outcome = found.as_ref().ok().filter(is_welch);
        outcome.map(|outcome| outcome.p)
    });
    let p: Vec<Option<f64>> = p.collect();
    let together: Vec<f64> = p.iter().copied().flatten().collect();
    let mut by_holm = holm(&together).into_iter();
    let is_many = together.len() > 1;
    p.into_iter()
        .map(|p| p.and_then(|_| by_holm.next()).filter(|_| is_many))
        .collect()
}

fn values(scores: &Scores) -> Vec<f64> {
    scores.iter().map(|(_, score)| *score).collect()
}

fn two(what: &str, first: &Scores, second: &Scores) -> Vec<(String, Computed<Outcome>)> {
    let summaries =
        Summary::of(&values(first)).and_then(|a| Ok((a, Summary::of(&values(second))?)));
    let both = summaries.and_then(|(a, b)| TwoSamples::of(&a, &b));
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
    let of = |subject: &Subject<'_>| (subject.name.to_owned(), subject.percent_right());
    is_scored.then(|| experiment.subjects.iter().map(of).collect())
}
