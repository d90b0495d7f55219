//! Rating scales: means by stimulus, how scales go together, and with what was measured.

use super::draw::{Bar, bars};
use super::included_trials::{Experiment, Subject};
use super::model::{Drawn, Section, Table, cells, file_name};
use super::options::Options;
use super::properties::Measures;
use super::tables::{SUMMARY, summary_cells, tests};
use super::variance::{complete_rows, effects, every_two};
use crate::AnswerValue;
use crate::design::Scale;
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::variance::{Answer as CellAnswer, Crossed, Repeated, friedman};
use selvedge_statistics::{Computed, Outcome, mean, pearson, spearman};

/// A subject's mean rating of every stimulus on one scale; `None` where it was not rated.
type Subjects = Vec<Vec<Option<f64>>>;

fn ratings(experiment: &Experiment<'_>, scale: usize) -> Subjects {
    let n = experiment.design.stimuli.len();
    let of = |subject: &Subject<'_>| {
        let mut sums = vec![[0.0; 2]; n];
        for record in subject.trials() {
            if let (Some(item), Some(AnswerValue::Ratings(values))) =
                (record.trial.task.item(), record.value())
                && let Some(value) = values.get(scale)
            {
                sums[item][0] += value;
                sums[item][1] += 1.0;
            }
        }
        let mean = |[sum, n]: [f64; 2]| (n > 0.0).then(|| sum / n);
        sums.into_iter().map(mean).collect()
    };
    experiment.subjects.iter().map(of).collect()
}

/// Over subjects, of every stimulus or pair that anybody rated, in the order of the design.
pub(super) fn means(subjects: &[Vec<Option<f64>>], n_items: usize) -> Vec<Option<f64>> {
    let of = |item: usize| {
        let values: Vec<f64> = subjects.iter().filter_map(|s| s[item]).collect();
        mean(&values).ok()
    };
    (0..n_items).map(of).collect()
}

pub(super) fn sections(
    experiment: &Experiment<'_>,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<Vec<Section>, Cancelled> {
    let names = experiment.ids();
    let measures = Measures::of(experiment, options, progress)?;
    let mut section = experiment.section("ratings", "ratings");
    section.note(
        "Means over subjects of each subject's mean over repeats. Correlations are between these \
         means, n the stimuli.",
    );
    let columns = format!("scale; item: stimulus; {SUMMARY}");
    let mut table = Table::new("means", "Ratings by scale and stimulus", &columns);
    let mut by_scale: Vec<(String, Vec<Option<f64>>)> = Vec::new();
    let mut found: Vec<(String, Computed<Outcome>)> = Vec::new();
    for (nth, scale) in experiment.design.composition.scales().iter().enumerate() {
        let all = ratings(experiment, nth);
        let mut shown = Vec::new();
        for (item, name) in names.iter().enumerate() {
            let values: Vec<f64> = all.iter().filter_map(|s| s[item]).collect();
            table.push(cells![&scale.key, name, summary_cells(&values)]);
            shown.extend(Bar::mean(name, "", &values));
        }
        section.figure(picture(experiment, scale, &shown));
        let key = file_name(&scale.key, '-');
        let crossed = crossed(experiment, &names, &all);
        let rows = complete_rows(&crossed);
        let pairs = every_two(&format!("pairs-{key}"), &crossed);
        found.push((scale.key.clone(), rows.and_then(|rows| friedman(&rows))));
        let variance = crossed.and_then(|table| Repeated::one_way(&table));
        let title = format!("Stimuli on the scale {}, within subjects", scale.key);
        section.table(effects(&format!("anova-{key}"), &title, &variance));
        section.table(pairs);
        by_scale.push((scale.key.clone(), means(&all, names.len())));
    }
    section.tables.insert(0, table);
    let title = "Do subjects agree? (Friedman; W is their concordance)";
    section.table(tests("agreement", title, &found));
    section.table(tests(
        "scales",
        "Scales with each other",
        &between(&by_scale),
    ));
    measures.describe(&mut section);
    if !measures.all.is_empty() {
        section.table(measures.table(&names));
        let with = with_measures(&by_scale, &measures);
        section.table(tests("physical", "Scales with what was measured", &with));
    }
    Ok(vec![section])
}

fn picture(experiment: &Experiment<'_>, scale: &Scale, shown: &[Bar]) -> Drawn {
    let title = format!("{}: {}", experiment.design.title, scale.key);
    let label = format!("{} to {} (95 % interval)", scale.low, scale.high);
    let key = format!("scale-{}", file_name(&scale.key, '-'));
    bars(&key, &title, &label, (shown, Some(scale.bounds())), &[])
}

/// A number of every subject for every stimulus, crossed; what is missing is left out.
pub(super) fn crossed(
    experiment: &Experiment<'_>,
    names: &[String],
    all: &[Vec<Option<f64>>],
) -> Computed<Crossed> {
    let mut answers = Vec::new();
    for (subject, values) in experiment.subjects.iter().zip(all) {
        for (name, value) in names.iter().zip(values) {
            answers.extend(value.map(|value| CellAnswer {
                subject: subject.name.to_owned(),
                levels: vec![name.clone()],
                value,
            }));
        }
    }
    Crossed::of_answers(&["stimulus"], &answers)
}

/// Values of both where both are known.
fn both(a: &[Option<f64>], b: &[Option<f64>]) -> [Vec<f64>; 2] {
    let pairs: Vec<(f64, f64)> = a.iter().zip(b).filter_map(|(a, b)| (*a).zip(*b)).collect();
    let (a, b) = pairs.into_iter().unzip();
    [a, b]
}

fn between(scales: &[(String, Vec<Option<f64>>)]) -> Vec<(String, Computed<Outcome>)> {
    let mut all = Vec::new();
    for (i, (first, a)) in scales.iter().enumerate() {
        for (second, b) in &scales[i + 1..] {
            let [a, b] = both(a, b);
            all.push((format!("{first} with {second}"), pearson(&a, &b)));
            all.push((format!("{first} with {second}"), spearman(&a, &b)));
        }
    }
    all
}

fn with_measures(
    scales: &[(String, Vec<Option<f64>>)],
    measures: &Measures,
) -> Vec<(String, Computed<Outcome>)> {
    let mut all = Vec::new();
    for (scale, values) in scales {
        for measure in &measures.all {
            let own: Vec<Option<f64>> = measure.values.iter().copied().map(Some).collect();
            let [a, b] = both(values, &own);
            all.push((format!("{scale} with {}", measure.heading), pearson(&a, &b)));
        }
    }
    all
}
