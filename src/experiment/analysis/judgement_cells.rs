//! What was called real by material and condition: percentages and their analysis of variance.

use super::answers::judgements;
use super::draw::{Bar, share_bars};
use super::included_trials::{Experiment, Subject};
use super::model::Section;
use super::tables::{summaries, tests};
use super::variance::effects;
use crate::Record;
use crate::design::{Design, Stimulus};
use selvedge_statistics::variance::{Answer as CellAnswer, Crossed, Repeated};
use selvedge_statistics::{Computed, Outcome, Undefined, mean, paired_t};

/// What was called real, by material and condition (Table 3 and Fig. 9 of the paper): of all, and
/// of each group of stimuli by itself.
pub(super) fn sections(experiment: &Experiment<'_>) -> Vec<Section> {
    let groups = experiment.groups();
    let apart = groups.iter().map(|group| section(experiment, Some(group)));
    [section(experiment, None)]
        .into_iter()
        .chain(apart)
        .collect()
}

fn section(experiment: &Experiment<'_>, group: Option<&str>) -> Section {
    let named = |what: &str, between: &str| match group {
        None => what.to_owned(),
        Some(group) => format!("{what}{between}{group}"),
    };
    let key = super::model::file_name(&named("called-real", "-"), '-');
    let title = named("called real, by material and condition", ": ");
    let mut section = experiment.section(&key, &title);
    section.note(
        "Percentages of trials in which it was called real. Of few trials a cell they take few \
         values, so the analysis of variance is approximate; see the test by flipped signs.",
    );
    let answers = cell_answers(experiment, group);
    let crossed = Crossed::of_answers(&["material", "condition"], &answers);
    let (materials, conditions) = (
        levels(experiment, group, |s| &s.material),
        levels(experiment, group, |s| &s.condition),
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
    let variance = crossed.and_then(|table| Repeated::two_way(&table));
    section.table(effects(
        "anova",
        "Two-way analysis of variance, both factors within subjects",
        &variance,
    ));
    let all = differences(&conditions, |condition| of(None, Some(condition)));
    section.table(tests("differences", "Conditions, subject by subject", &all));
    let title = experiment.titled(&named("called real by material", ", "));
    let words = (title.as_str(), "called real, %");
    section.figure(share_bars("materials", words, &shown, (50.0, "half")));
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
pub(super) fn levels(
    experiment: &Experiment<'_>,
    group: Option<&str>,
    level: fn(&Stimulus) -> &String,
) -> Vec<String> {
    let mut levels: Vec<String> = Vec::new();
    for stimulus in experiment
        .design
        .stimuli
        .iter()
        .filter(|one| one.is_of(group))
    {
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

fn cell_answers(experiment: &Experiment<'_>, group: Option<&str>) -> Vec<CellAnswer> {
    let subjects = experiment.subjects.iter();
    let rows = subjects.map(|subject| (subject.name.to_owned(), subject.trials()));
    called_real(experiment.design, rows, group)
}

/// 100 for every judgement of a group's stimuli that calls one real, 0 for the others, by material
/// and condition.
pub(crate) fn called_real<'a>(
    design: &Design,
    subjects: impl Iterator<Item = (String, impl Iterator<Item = &'a Record>)>,
    group: Option<&str>,
) -> Vec<CellAnswer> {
    let mut all = Vec::new();
    for (subject, rows) in subjects {
        for judged in rows.flat_map(judgements) {
            let stimulus = &design.stimuli[judged.item];
            if stimulus.is_of(group) {
                all.push(CellAnswer {
                    subject: subject.clone(),
                    levels: vec![stimulus.material.clone(), stimulus.condition.clone()],
                    value: if judged.called_real { 100.0 } else { 0.0 },
                });
            }
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

/// How much more often one condition was called real than another, points, subject by subject, of
/// all and of each group of stimuli; none where a subject lacks one of them.
pub(super) fn differences_of_conditions(experiment: &Experiment<'_>) -> Vec<(String, Vec<f64>)> {
    let groups = experiment.groups();
    let of_group = |group: Option<&String>| {
        let group = group.map(String::as_str);
        let answers = cell_answers(experiment, group);
        let of = |condition: &str| by_subject(experiment, &answers, [None, Some(condition)]);
        let less = |(what, [a, b]): TwoConditions| {
            let is_whole = a.len() == b.len();
            let differences = a.iter().zip(&b).map(|(a, b)| a - b);
            let what = group.map_or_else(|| what.clone(), |group| format!("{group}: {what}"));
            (what, differences.filter(|_| is_whole).collect())
        };
        let conditions = levels(experiment, group, |s| &s.condition);
        let all = pairs_of(&conditions, of).into_iter().map(less);
        all.collect::<Vec<(String, Vec<f64>)>>()
    };
    let groups = [None].into_iter().chain(groups.iter().map(Some));
    groups.flat_map(of_group).collect()
}
