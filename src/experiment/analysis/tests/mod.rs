//! Analyses of answers whose numbers are known beforehand.

mod bad;
mod choices;
mod composed;
mod files;
mod groups;
mod inference;
mod pairs;
mod ranking;
mod settings;
mod speeds;

use std::path::{Path, PathBuf};

use super::*;
use crate::design::{Design, Subject};
use crate::{
    Answer, AnswerValue, Apparatus, Course, Grade, Outcome, Presentation, Proof, Record, Step,
    Task, Timing, Trial,
};
use selvedge_foundation::progress::Progress;

/// Few of everything: these tests are of numbers that do not hang on it.
fn few() -> Options {
    Options {
        n_resamples: 100,
        n_permutations: 99,
        n_maps: 3,
        n_starts: 2,
        n_starts_on_a_line: 4,
        n_random_data: 0,
        ..Options::default()
    }
}

fn analysed(found: &[Found]) -> Analysis {
    Progress::unheard(|progress| Analysis::of(found, &few(), progress)).unwrap()
}

fn record(trial: Trial, answer: Answer, is_correct: Option<bool>) -> Record {
    let start_ns = trial.number as u64 * 100_000_000_000;
    Record {
        trial,
        attempt: 1,
        outcome: Outcome::Answered(answer),
        is_correct,
        timing: Timing {
            start_utc: "2026-01-01T00:00:00Z".to_owned(),
            response_utc: "2026-01-01T00:00:05Z".to_owned(),
            start_ns,
            response_ns: start_ns + 5_000_000_000,
        },
        apparatus: Apparatus::default(),
        presentation: Presentation::confirmed(Proof::Array),
        note: String::new(),
    }
}

/// A whole session, answered by a function of task and number.
fn held(
    design: &Design,
    (nth, session): (usize, u32),
    mut answer: impl FnMut(&Task, usize) -> Answer,
) -> Found {
    let subject = Subject {
        pseudonym: format!("p{:02}", nth + 1),
        nth,
        session,
    };
    let mut course = Course::begin(design, &subject).unwrap();
    let mut records = Vec::new();
    loop {
        match course.step() {
            Step::Finished => break,
            Step::Trial(trial) => {
                let trial = trial.clone();
                let said = answer(&trial.task, trial.number);
                let is_correct = course.answer(&said).unwrap();
                records.push(record(trial, said, is_correct));
            }
            _ => course.pass(),
        }
    }
    let log = format!("{}_{}_{session}.csv", design.experiment, subject.pseudonym);
    Found::of_records(
        PathBuf::from("nowhere").join(log),
        (design, subject),
        records,
    )
}

fn table<'a>(analysis: &'a Analysis, section: &str, key: &str) -> &'a Table {
    let found = analysis.sections.iter().find(|s| s.key == section);
    let keys: Vec<&str> = analysis.sections.iter().map(|s| s.key.as_str()).collect();
    let section = found.unwrap_or_else(|| panic!("no {section} among {keys:?}"));
    let table = section.tables.iter().find(|t| t.key == key);
    table.unwrap_or_else(|| panic!("no table {key} in {}", section.key))
}

fn value(table: &Table, row: usize, column: &str) -> f64 {
    match table.cell(row, column) {
        Some(Cell::Number(value)) => *value,
        other => panic!("{} {row} {column}: {other:?}", table.key),
    }
}

fn odd(task: &Task, is_right: bool, grade: Grade) -> Answer {
    let odd = task.right.unwrap();
    let position = if is_right { odd } else { (odd + 1) % 3 };
    let grade = Grade::ALL.iter().zip(1..).find(|(one, _)| **one == grade);
    Answer::chosen(position, grade.map(|(_, n)| n))
}

/// The shipped design of judgements with two side by side.
fn pair_design() -> Design {
    let text = Design::shipped_text("real-or-generated").unwrap();
    let text = text
        .replace("\"single\"", "\"pair\"")
        .replace(
            "\"yes-no\"\nwords = [\"real\", \"generated\"]",
            "\"choice\"",
        )
        .replace("[order]", "[order]\nsets = \"opposed\"")
        .replace("least_trials = 32", "least_trials = 1");
    Design::from_toml(&text, Path::new("pair.toml")).unwrap()
}

/// How far the odd one stands from the others in the design.
fn apart(task: &Task) -> usize {
    let odd = task.right.unwrap();
    task.items[odd].abs_diff(task.items[(odd + 1) % 3])
}

/// Of one alone: called real or not, so sure; of two: right or not.
fn judged(task: &Task, said: bool, confidence: u8) -> Answer {
    if task.items.len() == 1 {
        return Answer::chosen(usize::from(!said), Some(confidence));
    }
    let right = task.right.unwrap();
    Answer::chosen(if said { right } else { 1 - right }, None)
}
