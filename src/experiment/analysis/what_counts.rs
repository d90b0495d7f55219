//! What is to be known before any number: how it was felt, what was planned, what does not count.

use super::included_trials::{Subject, answered};
use super::model::{Cell, Section, Table, cells};
use crate::design::{Form, Rules, Scale};
use crate::record::Record;
use crate::session::Found;
use crate::{AnswerValue, Proof, Validity};
use selvedge_foundation::numerics::median;

/// Whether what was asked was tried on the screen.
pub(super) fn is_pilot(found: &Found) -> bool {
    let mut records = found.records.iter();
    records.any(|record| record.presentation.proof == Some(Proof::Screen))
}

/// Presentations that did not count, reason by reason.
pub(super) fn left_out_void(found: &Found, left_out: &mut Table) {
    let mut reasons: Vec<(&str, Vec<&Record>)> = Vec::new();
    for record in &found.records {
        let why = record.presentation.void.as_str();
        if record.trial.is_practice || why.is_empty() {
            continue;
        }
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, records)) => records.push(record),
            None => reasons.push((why, vec![record])),
        }
    }
    for (why, records) in reasons {
        let why = format!("presented again: {why}");
        left_out.push(out_row(found, &records, &why));
    }
}

/// Whether catch trials were answered rightly: called the same, placed in the lower half of every
/// scale, or given less than the median of the subject's other pairs.
pub(super) fn catch_verdicts(subject: &Subject<'_>) -> Vec<bool> {
    let numbers = subject.trials().filter_map(|record| match record.value() {
        Some(AnswerValue::Number(number)) => Some(*number),
        _ => None,
    });
    let middle = median(&mut numbers.collect::<Vec<f64>>());
    let is_low = |(value, scale): (&f64, &Scale)| {
        let [low, high] = scale.bounds();
        *value < 0.5 * (low + high)
    };
    let mut verdicts = Vec::new();
    for found in subject.sessions.iter().map(|session| session.found) {
        let form = &found.design.composition.response.form;
        for record in answered(found, true) {
            verdicts.extend(match (record.value(), form) {
                (Some(AnswerValue::Ratings(values)), Form::Scales(scales)) => {
                    Some(values.iter().zip(scales).all(is_low))
                }
                (Some(AnswerValue::Number(number)), _) => Some(*number < middle),
                _ => record.is_correct,
            });
        }
    }
    verdicts
}

/// What the frozen plan says, beside what was done; `None` where there is none.
pub(super) fn planned(sessions: &[&Found], n_subjects: usize) -> Option<Table> {
    let frozen = sessions.iter().find_map(|found| found.plan.as_ref())?;
    let plan = &frozen.plan;
    let columns = "what; planned; done";
    let mut table = Table::new("plan", "The plan, and what was done", columns);
    table.push(cells!["subjects", plan.subjects, n_subjects]);
    let is_by_it = |found: &&&Found| found.plan_sha256.as_ref() == Some(&frozen.sha256);
    let n_by_it = sessions.iter().filter(is_by_it).count();
    let held = format!("{n_by_it} of {} sessions", sessions.len());
    table.push(cells![
        "held by the plan",
        format!("SHA-256 {}…", &frozen.sha256[..12]),
        held
    ]);
    let left_out = |rules: &Rules| match rules.exclusions().join("; ") {
        none if none.is_empty() => "nothing".to_owned(),
        some => some,
    };
    let [by_plan, done] = [&plan.exclusions, &sessions[0].design.rules].map(left_out);
    table.push(cells!["left out", by_plan, done]);
    if let Some([low, high]) = plan.equivalence {
        table.push(cells![
            "equal between",
            format!("{low} and {high}"),
            "see the intervals"
        ]);
    }
    for hypothesis in &plan.hypotheses {
        let tested = format!("{}, α = {}", hypothesis.test, plan.alpha);
        table.push(cells![&hypothesis.expected, tested, "see below"]);
    }
    Some(table)
}

/// What has to be known of how it was felt before any number.
pub(super) fn describe_proof(sessions: &[&Found], section: &mut Section) {
    let with = |is_it: &dyn Fn(&Record) -> bool| {
        let has_any = |found: &&&Found| found.records.iter().any(is_it);
        sessions.iter().filter(has_any).count()
    };
    let by = |proof: Proof| with(&|record| record.presentation.proof == Some(proof));
    let described = [
        (by(Proof::Emulator), "on an emulator: **felt by nobody**"),
        (
            by(Proof::Screen),
            "a pilot on the screen: **felt by nobody**",
        ),
        (by(Proof::Simulated), "by simulated observers"),
        (
            by(Proof::Elsewhere),
            "presented elsewhere, as the experimenter said",
        ),
        (
            with(&|record| record.presentation.validity() == Validity::Unknown),
            "of **unknown validity**: logs of an earlier version do not say what was felt",
        ),
    ];
    for (n, what) in described.into_iter().filter(|(n, _)| *n > 0) {
        let sessions = if n == 1 { "session" } else { "sessions" };
        section.note(format!("{n} {sessions} {what}."));
    }
}

/// A row of what is left out.
pub(super) fn out_row(found: &Found, trials: &[&Record], why: &str) -> Vec<Cell> {
    let subject = &found.subject;
    cells![&subject.pseudonym, subject.session, numbers(trials), why]
}

/// Numbers of trials as people list them: `1–79, 81`.
fn numbers(trials: &[&Record]) -> String {
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for trial in trials {
        let number = trial.trial.number + 1;
        match runs.last_mut().filter(|run| run[1] + 1 == number) {
            Some(run) => run[1] = number,
            None => runs.push([number; 2]),
        }
    }
    let texts = |[from, to]: &[usize; 2]| {
        if from == to {
            from.to_string()
        } else {
            format!("{from}–{to}")
        }
    };
    runs.iter().map(texts).collect::<Vec<_>>().join(", ")
}
