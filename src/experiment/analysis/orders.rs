//! Sets that were put in order, or of which the best and the worst were chosen, and pairs of which
//! one was preferred: scores, and the scales of the comparisons that they hold.

use super::draw::{Bar, bars};
use super::included_trials::{Experiment, Subject};
use super::model::{Section, Table, cells};
use super::options::Options;
use super::pairs::{NOTE, Pairs};
use super::rating::crossed;
use super::tables::{SUMMARY, summary_cells, tests};
use super::variance::complete_rows;
use crate::{AnswerValue, Record};
use selvedge_statistics::ranking::Preferences;
use selvedge_statistics::variance::friedman;

/// What a trial put before what, as numbers of stimuli.
fn comparisons(record: &Record) -> Vec<[usize; 2]> {
    let items = &record.trial.task.items;
    let all = 0..items.len();
    let before: Vec<[usize; 2]> = match record.value() {
        Some(AnswerValue::Ranks(ranks)) => {
            let pairs = all.clone().flat_map(|a| all.clone().map(move |b| [a, b]));
            pairs.filter(|[a, b]| ranks[*a] < ranks[*b]).collect()
        }
        Some(AnswerValue::BestWorst([best, worst])) => {
            let others = all.clone().filter(|at| at != best && at != worst);
            let over = others.flat_map(|at| [[*best, at], [at, *worst]]);
            over.chain([[*best, *worst]]).collect()
        }
        Some(AnswerValue::Chosen(chosen)) => {
            let others = all.filter(|at| at != chosen);
            others.map(|at| [*chosen, at]).collect()
        }
        _ => Vec::new(),
    };
    let of = |at: usize| items.get(at).copied();
    let named = before.into_iter();
    let named = named.filter_map(|[a, b]| Some([of(a)?, of(b)?]));
    named.filter(|[a, b]| a != b).collect()
}

/// A subject's score of every stimulus, −1 to 1: how much more often it was put before another than
/// behind it; `None` where it was never compared. Of the best and worst that is (best − worst) over
/// how often it was shown, as only the ends count.
fn scores(subject: &Subject<'_>, n_items: usize) -> Vec<Option<f64>> {
    let mut sums = vec![[0.0; 2]; n_items];
    for record in subject.trials() {
        let ends = match record.value() {
            Some(AnswerValue::BestWorst(ends)) => Some(ends),
            _ => None,
        };
        let Some([best, worst]) = ends else {
            for [upper, lower] in comparisons(record) {
                for (item, by) in [(upper, 1.0), (lower, -1.0)] {
                    sums[item][0] += by;
                    sums[item][1] += 1.0;
                }
            }
            continue;
        };
        for (at, &item) in record.trial.task.items.iter().enumerate() {
            sums[item][0] += f64::from(u8::from(at == *best)) - f64::from(u8::from(at == *worst));
            sums[item][1] += 1.0;
        }
    }
    let score = |[sum, n]: [f64; 2]| (n > 0.0).then(|| sum / n);
    sums.into_iter().map(score).collect()
}

/// Scores and scales.
pub(super) fn sections(experiment: &Experiment<'_>, options: &Options) -> Vec<Section> {
    vec![scored(experiment), scaled(experiment, options)]
}

fn scored(experiment: &Experiment<'_>) -> Section {
    let names = experiment.ids();
    let mut section = experiment.section("scores", "scores");
    section.note(
        "How much more often a stimulus was put first than last, over how often it was shown, from \
         −1 to 1: of the best and the worst, of orders and pairs over all comparisons. Means over \
         subjects with Student's interval.",
    );
    let all: Vec<Vec<Option<f64>>> = (experiment.subjects.iter())
        .map(|subject| scores(subject, names.len()))
        .collect();
    let columns = format!("item: stimulus; {SUMMARY}");
    let mut table = Table::new("scores", "Scores by stimulus", &columns);
    let mut shown = Vec::new();
    for (item, name) in names.iter().enumerate() {
        let values: Vec<f64> = all.iter().filter_map(|own| own[item]).collect();
        table.push(cells![name, summary_cells(&values)]);
        shown.extend(Bar::mean(name, "", &values));
    }
    section.table(table);
    let rows = complete_rows(&crossed(experiment, &names, &all));
    let agreement = [("scores", rows.and_then(|rows| friedman(&rows)))];
    let title = "Do subjects agree? (Friedman; W is their concordance)";
    section.table(tests("agreement", title, &agreement));
    let (title, range) = (experiment.titled("scores"), Some([-1.0, 1.0]));
    let label = "score (95 % interval)";
    section.figure(bars(
        "bars",
        &title,
        label,
        (&shown, range),
        &[(0.0, "as often")],
    ));
    section
}

fn scaled(experiment: &Experiment<'_>, options: &Options) -> Section {
    let mut section = experiment.section("scales", "scales of the comparisons");
    section.note(NOTE);
    section.note(
        "Every set is taken apart into the pairs that its answer puts in order. **Pairs of one set \
         are not independent**: errors over subjects are the ones to quote.",
    );
    let names = experiment.ids();
    let of = |subject: &Subject<'_>| {
        let mut wins = vec![vec![0; names.len()]; names.len()];
        for [upper, lower] in subject.trials().flat_map(comparisons) {
            wins[upper][lower] += 1;
        }
        Preferences::of_wins(&wins)
    };
    let subjects = experiment.subjects.iter();
    match Pairs::of(&names, subjects.map(|subject| (subject.name, of(subject)))) {
        Ok(pairs) => pairs.describe("stimuli", "stimuli", options, &mut section),
        Err(why) => section.note(format!("No scale: {}.", why.reason)),
    }
    section
}
