//! What was called real by material and condition: percentages and their analysis of variance.

use super::answers::judgements;
use super::draw::{Bar, bars};
use super::included_trials::{Experiment, Subject};
use super::model::Section;
use super::tables::{summaries, tests};
use super::variance::effects;
use crate::design::Stimulus;
use selvedge_statistics::variance::{Answer as CellAnswer, Crossed, repeated_two_way};
use selvedge_statistics::{Computed, Outcome, Undefined, mean, paired_t};

/// What was called real, by material and condition (Table 3 and Fig. 9 of the paper).
pub(super) fn section(experiment: &Experiment<'_>) -> Section {
    let mut section = experiment.section("called-real", "called real, by material and condition");
    section.note(
        "Percentages of trials in which it was called real. Of few trials a cell they take few \
         values, so the analysis of variance is approximate; see the test by flipped signs.",
    );
    let answers = cell_answers(experiment);
    let crossed = Crossed::of_answers(&["material", "condition"], &answers);
    let (materials, conditions) = (
        levels(experiment, |s| &s.material),
        levels(experiment, |s| &s.condition),
    );
    let of = |material: Option<&str>, condition: Option<&str>| {
        by_subject(experiment, &answers, [material, condition])
    };
    let (rows, shown) = cells(&materials, &conditions, &of);
    section.table(summaries(
        "cells",
        "Called real (as Table 3 of the paper)",
        &rows,
    ));
    let variance = crossed.and_then(|table| repeated_two_way(&table));
    section.table(effects(
        "anova",
        "Two-way analysis of variance, both factors within subjects",
        &variance,
    ));
    let all = differences(&conditions, |condition| of(None, Some(condition)));
    section.table(tests("differences", "Conditions, subject by subject", &all));
    let title = experiment.titled("called real by material");
    let label = "called real, % (95 % interval)";
    section.figure(bars(
        "materials",
        &title,
        label,
        (&shown, Some([0.0, 100.0])),
        &[(50.0, "half")],
    ));
    section
}

/// Percentages of subjects by what they are of.
type Rows = Vec<(String, Vec<f64>)>;

/// The percentages of a material and a condition, or of all of them.
type Of<'a> = dyn Fn(Option<&str>, Option<&str>) -> Vec<f64> + 'a;

/// Every cell, each condition over all materials, and what is drawn of them.
fn cells(materials: &[String], conditions: &[String], of: &Of<'_>) -> (Rows, Vec<Bar>) {
    let mut rows: Rows = Vec::new();
    let mut shown = Vec::new();
    for condition in conditions {
        for material in materials {
            let values = of(Some(material), Some(condition));
            shown.extend(Bar::mean(material, condition, &values));
            rows.push((format!("{material}, {condition}, %"), values));
        }
        rows.push((
            format!("all materials, {condition}, %"),
            of(None, Some(condition)),
        ));
    }
    (rows, shown)
}

/// Levels of a factor in the order of the design.
pub(super) fn levels(experiment: &Experiment<'_>, level: fn(&Stimulus) -> &String) -> Vec<String> {
    let mut levels: Vec<String> = Vec::new();
    for stimulus in &experiment.design.stimuli {
        if !levels.contains(level(stimulus)) {
            levels.push(level(stimulus).clone());
        }
    }
    levels
}

/// Every subject's percentage in some cells.
fn by_subject(
    experiment: &Experiment<'_>,
    answers: &[CellAnswer],
    [material, condition]: [Option<&str>; 2],
) -> Vec<f64> {
    let of = |subject: &Subject<'_>| {
        let own = answers.iter().filter(|a| {
            a.subject == subject.name
                && material.is_none_or(|m| a.levels[0] == m)
                && condition.is_none_or(|c| a.levels[1] == c)
        });
        let values: Vec<f64> = own.map(|a| a.value).collect();
        mean(&values).ok()
    };
    experiment.subjects.iter().filter_map(of).collect()
}

fn cell_answers(experiment: &Experiment<'_>) -> Vec<CellAnswer> {
    let mut all = Vec::new();
    for subject in &experiment.subjects {
        for judged in subject.trials().flat_map(judgements) {
            let stimulus = &experiment.design.stimuli[judged.item];
            all.push(CellAnswer {
                subject: subject.name.to_owned(),
                levels: vec![stimulus.material.clone(), stimulus.condition.clone()],
                value: if judged.called_real { 100.0 } else { 0.0 },
            });
        }
    }
    all
}

/// What is compared of two conditions, and the percentages of both.
type TwoConditions = (String, [Vec<f64>; 2]);

fn pairs_of(conditions: &[String], of: impl Fn(&str) -> Vec<f64>) -> Vec<TwoConditions> {
    let mut all = Vec::new();
    for (i, first) in conditions.iter().enumerate() {
        for second in &conditions[i + 1..] {
            let what = format!("{first} less {second}, %");
            all.push((what, [of(first), of(second)]));
        }
    }
    all
}

fn differences(
    conditions: &[String],
    of: impl Fn(&str) -> Vec<f64>,
) -> Vec<(String, Computed<Outcome>)> {
    let tested = |(what, [a, b]): TwoConditions| {
        let outcome = if a.len() == b.len() {
            paired_t(&a, &b)
        } else {
            Err(Undefined::because("a subject lacks one of the conditions"))
        };
        (what, outcome)
    };
    pairs_of(conditions, of).into_iter().map(tested).collect()
}

/// How much more often one condition was called real than another, points, subject by subject; none
/// where a subject lacks one of them.
pub(super) fn differences_of_conditions(experiment: &Experiment<'_>) -> Vec<(String, Vec<f64>)> {
    let answers = cell_answers(experiment);
    let of = |condition: &str| by_subject(experiment, &answers, [None, Some(condition)]);
    let less = |(what, [a, b]): TwoConditions| {
        let is_whole = a.len() == b.len();
        let differences = a.iter().zip(&b).map(|(a, b)| a - b);
        (what, differences.filter(|_| is_whole).collect())
    };
    let conditions = levels(experiment, |s| &s.condition);
    pairs_of(&conditions, of).into_iter().map(less).collect()
}
