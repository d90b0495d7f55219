//! Magnitude estimation: exponents of Stevens' law by condition and subject.

use super::draw::{Bar, bars, scatter};
use super::included_trials::Experiment;
use super::model::{Cell, Section, Table, ends, summaries, tests, undefined};
use crate::design::Source;
use crate::{Answer, Task};
use selvedge_chart::{Axis, Scale, Series, Style};
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_statistics::psychometric::stevens::{Estimate, PowerLaw, Stevens, stevens};
use selvedge_statistics::{Summary, paired_t};

/// Estimates of one condition's stimuli, in amplitudes.
fn estimates(experiment: &Experiment<'_>, condition: &str) -> Vec<Estimate> {
    let mut all = Vec::new();
    for subject in &experiment.subjects {
        for record in subject.trials() {
            let (Task::Estimate { item }, Some(Answer::Magnitude(value))) =
                (&record.trial.task, record.answer())
            else {
                continue;
            };
            let stimulus = &experiment.design.stimuli[*item];
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

const EXPONENTS: [(&str, &str); 8] = [
    ("condition", "condition"),
    ("subject", "subject"),
    ("stimuli", "stimuli"),
    ("exponent", "exponent"),
    ("ci_low", "95 % CI from"),
    ("ci_high", "to"),
    ("constant", "number at 1 µm"),
    ("r_squared", "r²"),
];

pub(super) fn sections(experiment: &Experiment<'_>) -> Vec<Section> {
    let title = format!("{}: Stevens' exponents", experiment.design.title);
    let mut section = Section::new(experiment.key("exponents"), title);
    section.note(
        "Number = constant · amplitude^exponent, a line between logarithms through \
         geometric means; every subject's modulus is made that of the group first, which \
         changes no exponent. The group's line has an interval by its scatter, the mean \
         exponent one over subjects.",
    );
    let conditions = conditions(experiment);
    if conditions.is_empty() {
        section.note("**No exponents**: no stimulus is a vibration of a known level.");
    }
    let mut table = Table::new("exponents", "Exponents", &EXPONENTS);
    let mut found: Vec<(&str, Stevens)> = Vec::new();
    for condition in conditions {
        match stevens(&estimates(experiment, condition), 0.95) {
            Ok(law) => {
                for (name, own) in &law.subjects {
                    table.push(row(condition, name, law.stimuli.len(), own));
                }
                table.push(row(condition, "group", law.stimuli.len(), &law.group));
                found.push((condition, law));
            }
            Err(why) => {
                let mut row = vec![Cell::from(condition), "all".into()];
                row.extend(undefined(&why, EXPONENTS.len() - 2));
                table.push(row);
            }
        }
    }
    section.tables.push(table);
    let exponents = |law: &Stevens| {
        law.subjects
            .iter()
            .map(|(_, l)| l.exponent)
            .collect::<Vec<f64>>()
    };
    let means: Vec<(String, Vec<f64>)> = found
        .iter()
        .map(|(condition, law)| (format!("exponent, {condition}"), exponents(law)))
        .collect();
    section
        .tables
        .push(summaries("group", "Exponents over subjects", &means));
    if let [(first, a), (second, b)] = found.as_slice()
        && a.subjects.len() == b.subjects.len()
    {
        let what = format!("exponent, {first} less {second}");
        let all = [(what, paired_t(&exponents(a), &exponents(b)))];
        section
            .tables
            .push(tests("tests", "Conditions, subject by subject", &all));
    }
    draw(experiment, &found, &mut section);
    vec![section]
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
    let mut row = vec![
        Cell::from(condition),
        subject.into(),
        n.into(),
        law.exponent.into(),
    ];
    row.extend(ends(&law.interval));
    row.extend([law.constant.into(), Cell::of(&law.r_squared)]);
    row
}

fn draw(experiment: &Experiment<'_>, found: &[(&str, Stevens)], section: &mut Section) {
    let mut series = Vec::new();
    let mut shown = Vec::new();
    for (condition, law) in found {
        let line = |x: &f64| [*x, law.group.constant * x.powf(law.group.exponent)];
        series.push(Series {
            name: (*condition).to_owned(),
            points: law
                .stimuli
                .iter()
                .zip(&law.means)
                .map(|(x, y)| [*x, *y])
                .collect(),
            ..Series::default()
        });
        series.push(Series {
            name: format!(
                "{condition}, exponent {}",
                selvedge_foundation::quantity::fixed(law.group.exponent, 2)
            ),
            points: law.stimuli.iter().map(line).collect(),
            style: Style::Line,
            ..Series::default()
        });
        for (name, own) in &law.subjects {
            shown.push(Bar {
                name: name.clone(),
                group: (*condition).to_owned(),
                value: own.exponent,
                interval: own.interval.as_ref().ok().map(|i| [i.low, i.high]),
            });
        }
        let values: Vec<f64> = law.subjects.iter().map(|(_, l)| l.exponent).collect();
        if let Ok(s) = Summary::of(&values) {
            shown.push(Bar {
                name: "mean ± SE".to_owned(),
                group: (*condition).to_owned(),
                value: s.mean,
                interval: Some([s.mean - s.se, s.mean + s.se]),
            });
        }
    }
    if series.is_empty() {
        return;
    }
    let axes = ["amplitude, µm", "geometric mean of numbers"].map(|label| {
        let mut axis = Axis::linear(label);
        axis.scale = Scale::Log;
        axis
    });
    let title = format!("{}: numbers over amplitude", experiment.design.title);
    section.figures.push(scatter("law", &title, axes, series));
    let title = format!("{}: exponents", experiment.design.title);
    section.figures.push(bars(
        "bars",
        &title,
        "exponent (95 % interval)",
        (&shown, None),
        &[],
    ));
}
