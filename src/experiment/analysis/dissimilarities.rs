//! How unlike stimuli are: ratings or numbers of pairs, and how often two were laid in one pile;
//! maps of both.

use super::included_trials::{Experiment, Subject};
use super::map::Mapping;
use super::model::{Section, Table, cells, known};
use super::options::Options;
use super::properties::Measures;
use super::rating;
use super::tables::{SUMMARY, matrix, summary_cells};
use crate::{AnswerValue, Record};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::mds::{Loss, Ties};

/// What a trial says of pairs: two stimuli, and how unlike they are.
fn unlike(record: &Record) -> Vec<([usize; 2], f64)> {
    let items = &record.trial.task.items;
    match (items.as_slice(), record.value()) {
        (&[a, b], Some(AnswerValue::Ratings(values))) => {
            values.iter().map(|value| ([a, b], *value)).collect()
        }
        (&[a, b], Some(AnswerValue::Number(value))) => vec![([a, b], *value)],
        (items, Some(AnswerValue::Piles(piles))) => {
            let pairs = (0..items.len()).flat_map(|b| (0..b).map(move |a| [a, b]));
            let of = |[a, b]: [usize; 2]| {
                let is_apart = piles.get(a) != piles.get(b);
                ([items[a], items[b]], f64::from(u8::from(is_apart)))
            };
            pairs.map(of).collect()
        }
        _ => Vec::new(),
    }
}

/// The mean of every pair, row by row; `None` where it was never asked.
fn means<'a>(n: usize, records: impl Iterator<Item = &'a Record>) -> Vec<Option<f64>> {
    let mut sums = vec![[0.0; 2]; n * n];
    for ([a, b], value) in records.flat_map(unlike) {
        for at in [a * n + b, b * n + a] {
            sums[at][0] += value;
            sums[at][1] += 1.0;
        }
    }
    let mean = |(at, [sum, n_values]): (usize, [f64; 2])| {
        let is_itself = at / n == at % n;
        (n_values > 0.0 && !is_itself).then(|| sum / n_values)
    };
    sums.into_iter().enumerate().map(mean).collect()
}

/// How unlike stimuli are, and maps.
///
/// # Errors
/// It was cancelled.
pub(super) fn sections(
    experiment: &Experiment<'_>,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, Cancelled> {
    let names = experiment.ids();
    let n = names.len();
    let is_sorted = !experiment.design.composition.order.sets.has_pairs();
    let own = |subject: &Subject<'_>| means(n, subject.trials());
    // Subjects use numbers of their own size: each counts as much as any other.
    let subjects: Vec<Vec<Option<f64>>> = experiment
        .subjects
        .iter()
        .map(|subject| {
            if is_sorted {
                own(subject)
            } else {
                equalised(own(subject))
            }
        })
        .collect();
    let together = rating::means(&subjects, n * n);
    let mut sections = vec![if is_sorted {
        piles(experiment, &names, &together)
    } else {
        ratings(experiment, &names, &subjects)
    }];
    let measures = Measures::of(experiment, options, progress)?;
    let mapping = Mapping {
        key: experiment.key("map"),
        title: experiment.titled("map"),
        names,
        values: together,
        subjects,
        loss: Loss::Stress1,
        ties: Ties::Primary,
        measures: &measures,
    };
    sections.push(mapping.section(options, progress)?);
    Ok(sections)
}

/// Over their mean, which makes subjects comparable.
fn equalised(values: Vec<Option<f64>>) -> Vec<Option<f64>> {
    let known: Vec<f64> = values.iter().copied().flatten().collect();
    let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
    let over = |value: f64| if mean > 0.0 { value / mean } else { value };
    values.into_iter().map(|value| value.map(over)).collect()
}

fn ratings(
    experiment: &Experiment<'_>,
    names: &[String],
    subjects: &[Vec<Option<f64>>],
) -> Section {
    let mut section = experiment.section("unlike", "how unlike pairs are");
    section.note(
        "Every subject's answers over its own mean, so that all count as much; means over subjects \
         with Student's interval. Pairs of the same stimulus are left out.",
    );
    let columns = format!("first; second; {SUMMARY}");
    let mut table = Table::new("pairs", "How unlike pairs are", &columns);
    for b in 0..names.len() {
        for a in 0..b {
            let at = a * names.len() + b;
            let values: Vec<f64> = subjects.iter().filter_map(|own| own[at]).collect();
            table.push(cells![&names[a], &names[b], summary_cells(&values)]);
        }
    }
    section.table(table);
    section
}

fn piles(experiment: &Experiment<'_>, names: &[String], apart: &[Option<f64>]) -> Section {
    let mut section = experiment.section("piles", "piles");
    section.note(
        "Together: the share of sortings in which two lay in one pile. What is mapped is one less \
         that.",
    );
    let columns = "subject; piles: piles, mean";
    let mut table = Table::new("counts", "Piles by subject", columns);
    for subject in &experiment.subjects {
        let n_piles = |record: &Record| match record.value() {
            Some(AnswerValue::Piles(piles)) => piles.iter().max().map(|last| *last as f64 + 1.0),
            _ => None,
        };
        let counts: Vec<f64> = subject.trials().filter_map(n_piles).collect();
        table.push(cells![subject.name, selvedge_statistics::mean(&counts)]);
    }
    section.table(table);
    let together = apart
        .iter()
        .map(|value| known(value.map(|apart| 1.0 - apart), "itself"));
    section.table(matrix("together", "In one pile, share", names, together));
    section
}
