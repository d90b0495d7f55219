//! Experiments of one folder beside each other: a real against a virtual target, say.

use super::answers::{Rankings, rankings};
use super::included_trials::{Experiment, Subject};
use super::model::Section;
use super::tables::{summaries, tests};
use crate::design::Method;
use selvedge_statistics::{
    Computed, Outcome, Summary, TwoSamples, Undefined, paired_t, two_sample_t,
};

/// A score of every subject, %.
type Scores = Vec<(String, f64)>;

/// Every two experiments of one method whose answers are right or wrong.
pub(super) fn compared(experiments: &[Experiment<'_>]) -> Option<Section> {
    let scored: Vec<(&Experiment<'_>, Scores)> = experiments
        .iter()
        .filter_map(|experiment| Some((experiment, scores(experiment)?)))
        .collect();
    let mut section = Section::new("comparison", "Experiments compared");
    section.note(
        "Scores are shares of right answers by subject. Welch's t is the one to believe where \
         spreads differ; the paired test is of subjects who took part in both.",
    );
    let mut all: Vec<(String, Computed<Outcome>)> = Vec::new();
    let mut entered: Vec<usize> = Vec::new();
    for i in 0..scored.len() {
        for j in i + 1..scored.len() {
            let ((a, first), (b, second)) = (&scored[i], &scored[j]);
            if a.design.method.name() != b.design.method.name() {
                continue;
            }
            entered.extend([i, j]);
            let what = format!("{}, less {}, %", a.key, b.key);
            all.extend(two(&what, first, second));
        }
    }
    entered.sort_unstable();
    entered.dedup();
    let means: Vec<(String, Vec<f64>)> = entered
        .into_iter()
        .map(|at| (format!("{}, %", scored[at].0.key), values(&scored[at].1)))
        .collect();
    if all.is_empty() {
        return None;
    }
    section.table(summaries("means", "Right answers", &means));
    section.table(tests("tests", "Differences", &all));
    Some(section)
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
    let is_scored = match &experiment.design.method {
        Method::Ranking(_) => {
            let all = rankings(experiment);
            let of = |r: &Rankings<'_>| (r.subject.to_owned(), r.percent());
            return Some(all.iter().map(of).collect());
        }
        Method::OddOneOut(_) | Method::Judgement(_) => true,
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
