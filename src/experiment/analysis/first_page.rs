//! What a reader wants first: who took part, what was planned, what was left out and why, the
//! answer in a sentence with its interval, and one figure.

use super::included_trials::Experiment;
use super::model::{Cell, Section, Table};
use super::what_counts::describe_proof;
use crate::Participant;
use selvedge_foundation::quantity::with_unit;

/// The first page of an experiment, whose sections follow; it takes their first figure.
pub(super) fn first_page(experiment: &Experiment<'_>, sections: &mut [Section]) -> Section {
    let title = experiment.design.title.clone();
    let mut page = Section::new(experiment.key("first"), format!("{title}: the answer"));
    if let Some(answer) = sections.iter().find_map(answer) {
        page.note(format!("**{answer}**"));
    }
    describe_proof(&experiment.sessions, &mut page);
    page.note(who(experiment));
    page.note(planned(experiment));
    page.note(left_out(experiment));
    let figures = sections
        .iter_mut()
        .find(|section| !section.figures.is_empty());
    if let Some(section) = figures {
        page.figure(section.figures.remove(0));
    }
    page
}

/// The first estimate that has an interval, in a sentence.
fn answer(section: &Section) -> Option<String> {
    section.tables.iter().find_map(|table| {
        let is_there = |name: &str| table.columns.iter().any(|column| column.name == name);
        if is_there("mean") && is_there("ci_low") {
            return (0..table.rows.len()).find_map(|row| of_mean(table, row));
        }
        if is_there("estimate_value") {
            return (0..table.rows.len()).find_map(|row| of_test(table, row));
        }
        None
    })
}

fn of_mean(table: &Table, row: usize) -> Option<String> {
    let what = text(table, row, "what")?;
    let mean = number(table, row, "mean")?;
    let n = table.cell(row, "n").and_then(Cell::number);
    let n = n.map_or_else(String::new, |n| format!("; n = {n}"));
    let interval = interval(table, row, ["ci_low", "ci_high"]);
    Some(format!("{what}: {mean}{interval}{n}."))
}

fn of_test(table: &Table, row: usize) -> Option<String> {
    let (what, test) = (text(table, row, "what")?, text(table, row, "test")?);
    let mut parts = vec![format!("{what}: {test}")];
    if let (Some(statistic), Some(value)) =
        (text(table, row, "statistic"), number(table, row, "value"))
    {
        parts.push(format!("{statistic} = {value}"));
    }
    match table.cell(row, "p") {
        Some(Cell::Number(p)) => parts.push(format!("p = {}", short(*p))),
        Some(Cell::Undefined(why)) if why.starts_with('<') => parts.push(format!("p {why}")),
        _ => return None,
    }
    for (name, value, ends) in [
        ("effect", "effect_value", ["effect_low", "effect_high"]),
        ("estimate", "estimate_value", ["ci_low", "ci_high"]),
    ] {
        if let (Some(name), Some(value)) = (text(table, row, name), number(table, row, value)) {
            parts.push(format!("{name} {value}{}", interval(table, row, ends)));
        }
    }
    Some(format!("{}.", parts.join(", ")))
}

fn interval(table: &Table, row: usize, [low, high]: [&str; 2]) -> String {
    match (number(table, row, low), number(table, row, high)) {
        (Some(low), Some(high)) => format!(" (95 % from {low} to {high})"),
        _ => String::new(),
    }
}

fn text(table: &Table, row: usize, column: &str) -> Option<String> {
    match table.cell(row, column)? {
        Cell::Text(text) if !text.is_empty() => Some(text.clone()),
        _ => None,
    }
}

fn number(table: &Table, row: usize, column: &str) -> Option<String> {
    table.cell(row, column)?.number().map(short)
}

/// So many of something.
fn counted(n: usize, what: &str) -> String {
    let ending = if n == 1 { "" } else { "s" };
    format!("{n} {what}{ending}")
}

/// A number with three digits that count.
fn short(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude > 0.0 && !(1e-3..1e6).contains(&magnitude) {
        return format!("{value:.1e}").replace('-', "−");
    }
    let decimals = if magnitude >= 100.0 {
        0
    } else if magnitude >= 10.0 {
        1
    } else if magnitude >= 1.0 {
        2
    } else {
        3
    };
    with_unit(value, decimals, "").trim_end().to_owned()
}

/// How many took part, and what was told of them.
fn who(experiment: &Experiment<'_>) -> String {
    let mut seen: Vec<&str> = Vec::new();
    let mut told: Vec<&Participant> = Vec::new();
    for session in &experiment.sessions {
        let name = session.subject.pseudonym.as_str();
        if !seen.contains(&name) {
            seen.push(name);
            told.extend(session.participant.as_ref());
        }
    }
    let mut described = vec![format!("{} took part", seen.len())];
    let particular = |at: usize| -> Vec<&str> {
        let words = told.iter().map(|one| one.particulars()[at].as_str());
        words.filter(|word| !word.is_empty()).collect()
    };
    let mut ages: Vec<u32> = particular(0)
        .iter()
        .filter_map(|age| age.parse().ok())
        .collect();
    ages.sort_unstable();
    if let (Some(first), Some(last)) = (ages.first(), ages.last()) {
        let median = ages[ages.len() / 2];
        let n = ages.len();
        described.push(format!(
            "{first} to {last} years, median {median} ({n} told)"
        ));
    }
    for sex in Participant::SEXES {
        let n = particular(1).iter().filter(|one| **one == sex).count();
        if n > 0 {
            described.push(format!("{n} {sex}"));
        }
    }
    described.push(counted(experiment.sessions.len(), "session"));
    format!("{}.", described.join("; "))
}

fn planned(experiment: &Experiment<'_>) -> String {
    let rules = &experiment.design.rules;
    let subjects = match rules.subjects {
        0 => "the number of subjects was left open".to_owned(),
        n => format!("{n} subjects"),
    };
    let plan = experiment
        .sessions
        .iter()
        .find_map(|session| session.plan.as_ref());
    let frozen = plan.map_or(
        "no plan was frozen",
        |_| "a plan was frozen, see the sessions",
    );
    format!("Planned: {subjects}; {frozen}.")
}

fn left_out(experiment: &Experiment<'_>) -> String {
    let kept: usize = experiment
        .subjects
        .iter()
        .map(|subject| subject.sessions.len())
        .sum();
    let n_out = experiment.sessions.len().saturating_sub(kept);
    let n_trials: usize = experiment
        .subjects
        .iter()
        .map(|one| one.trials().count())
        .sum();
    let out = match n_out {
        0 => "No session is left out".to_owned(),
        1 => "1 session is left out, see why among the sessions".to_owned(),
        n => format!("{n} sessions are left out, see why among the sessions"),
    };
    let (trials, subjects) = (
        counted(n_trials, "trial"),
        counted(experiment.subjects.len(), "subject"),
    );
    format!("{out}; {trials} of {subjects} count.")
}
