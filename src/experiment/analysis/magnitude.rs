//! Magnitude estimation: exponents of Stevens' law by condition and subject.

use super::draw::{Bar, bars, scatter};
use super::included_trials::Experiment;
use super::model::{Cell, Section, Table, cells};
use super::tables::{summaries, tests};
use crate::design::Source;
use crate::{AnswerValue, Record};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::quantity::{factor_of_gain, fixed};
use selvedge_statistics::psychometric::stevens::{Estimate, PowerLaw, Stevens};
use selvedge_statistics::{Summary, mean, paired_t};

/// Estimates of one condition's stimuli, in amplitudes.
fn estimates(experiment: &Experiment<'_>, condition: &str) -> Vec<Estimate> {
    let mut all = Vec::new();
    for subject in &experiment.subjects {
        for record in subject.trials() {
            let (Some(item), Some(AnswerValue::Number(value))) =
                (record.trial.task.item(), record.value())
            else {
                continue;
            };
            let stimulus = &experiment.design.stimuli[item];
            if let Source::Vibration { level_db, .. } = stimulus.source
                && stimulus.condition == condition
            {
                all.push(Estimate {
                    subject: subject.name.to_owned(),
                    stimulus: factor_of_gain(level_db),
                    value: *value,
                });
            }
        }
    }
    all
}

const EXPONENTS: &str = "condition; subject; stimuli; exponent; ci_low: 95 % CI from; ci_high: \
    to; constant: number at 1 µm; r_squared: r²";

pub(super) fn sections(experiment: &Experiment<'_>) -> Vec<Section> {
    let mut section = experiment.section("exponents", "Stevens' exponents");
    section.note(
        "Number = constant · amplitude^exponent, a line between logarithms through \
         geometric means; every subject's modulus is made that of the group first, which \
         changes no exponent. The group's line has an interval by its scatter, the mean \
         exponent one over subjects.",
    );
    let conditions = conditions(experiment);
    if conditions.is_empty() {
        section.note("**No exponents**: no stimulus is a vibration of a known level.");
        section.table(means(experiment));
        return vec![section];
    }
    let mut table = Table::new("exponents", "Exponents", EXPONENTS);
    let mut found: Vec<(&str, Stevens)> = Vec::new();
    for condition in conditions {
        match Stevens::fit(&estimates(experiment, condition), 0.95) {
            Ok(law) => {
                for (name, own) in &law.subjects {
                    table.push(row(condition, name, law.stimuli.len(), own));
                }
                table.push(row(condition, "group", law.stimuli.len(), &law.group));
                found.push((condition, law));
            }
            Err(why) => {
                let blank = vec![Cell::none(&why.reason); table.columns.len() - 2];
                table.push(cells![condition, "all", blank]);
            }
        }
    }
    section.table(table);
    let means: Vec<(String, Vec<f64>)> = found
        .iter()
        .map(|(condition, law)| (format!("exponent, {condition}"), exponents(law)))
        .collect();
    section.table(summaries("group", "Exponents over subjects", &means));
    if let [(first, a), (second, b)] = found.as_slice()
        && a.subjects.len() == b.subjects.len()
    {
        let what = format!("exponent, {first} less {second}");
        let all = [(what, paired_t(&exponents(a), &exponents(b)))];
        section.table(tests("tests", "Conditions, subject by subject", &all));
    }
    draw(experiment, &found, &mut section);
    vec![section]
}

/// Geometric means of every stimulus over subjects, of each subject's numbers over their own mean.
fn means(experiment: &Experiment<'_>) -> Table {
    let columns = "item: stimulus; n: subjects; mean: geometric mean, over that of all; ci_low: \
        95 % CI from; ci_high: to";
    let mut table = Table::new("means", "Numbers by stimulus", columns);
    let logarithms: Vec<Vec<(usize, f64)>> = (experiment.subjects.iter())
        .map(|subject| {
            let number = |record: &Record| match (record.trial.task.item(), record.value()) {
                (Some(item), Some(AnswerValue::Number(value))) => Some((item, value.ln())),
                _ => None,
            };
            subject.trials().filter_map(number).collect()
        })
        .collect();
    for (item, name) in experiment.ids().iter().enumerate() {
        let of = |own: &Vec<(usize, f64)>| {
            let all: Vec<f64> = own.iter().map(|(_, ln)| *ln).collect();
            let its: Vec<f64> = own
                .iter()
                .filter(|(i, _)| *i == item)
                .map(|(_, ln)| *ln)
                .collect();
            Some(mean(&its).ok()? - mean(&all).ok()?)
        };
        let values: Vec<f64> = logarithms.iter().filter_map(of).collect();
        let interval = Summary::of(&values).and_then(|summary| summary.interval(0.95));
        let interval = interval.map(|interval| interval.map(f64::exp));
        let centre = mean(&values).map(f64::exp);
        table.push(cells![name, values.len(), centre, interval]);
    }
    table
}

/// The conditions of vibrations, in the design's order.
fn conditions<'a>(experiment: &Experiment<'a>) -> Vec<&'a str> {
    let mut conditions: Vec<&str> = Vec::new();
    for stimulus in &experiment.design.stimuli {
        let is_vibration = matches!(stimulus.source, Source::Vibration { .. });
        if is_vibration && !conditions.contains(&stimulus.condition.as_str()) {
            conditions.push(&stimulus.condition);
        }
    }
    conditions
}

fn row(condition: &str, subject: &str, n: usize, law: &PowerLaw) -> Vec<Cell> {
    let (interval, r_squared) = (&law.interval, &law.r_squared);
    cells![
        condition,
        subject,
        n,
        law.exponent,
        interval,
        law.constant,
        r_squared
    ]
}

fn draw(experiment: &Experiment<'_>, found: &[(&str, Stevens)], section: &mut Section) {
    let mut all = Vec::new();
    let mut shown = Vec::new();
    for (condition, law) in found {
        let PowerLaw {
            constant, exponent, ..
        } = law.group;
        let means = law.stimuli.iter().zip(&law.means).map(|(x, y)| [*x, *y]);
        all.push(Series::of(*condition, Style::Dots, means));
        let name = format!("{condition}, exponent {}", fixed(exponent, 2));
        let line = law
            .stimuli
            .iter()
            .map(|x| [*x, constant * x.powf(exponent)]);
        all.push(Series::of(name, Style::Line, line));
        for (name, own) in &law.subjects {
            let interval = own.interval.as_ref().ok().map(|i| [i.low, i.high]);
            shown.push(Bar::of(name, condition, own.exponent, interval));
        }
        shown.extend(Bar::mean("mean", condition, &exponents(law)));
    }
    if all.is_empty() {
        return;
    }
    let axes = ["amplitude, µm", "geometric mean of numbers"].map(Axis::log);
    section.figure(scatter(
        "law",
        &experiment.titled("numbers over amplitude"),
        axes,
        all,
    ));
    let (title, label) = (experiment.titled("exponents"), "exponent (95 % interval)");
    section.figure(bars("bars", &title, label, (&shown, None), &[]));
}

fn exponents(law: &Stevens) -> Vec<f64> {
    law.subjects.iter().map(|(_, law)| law.exponent).collect()
}
