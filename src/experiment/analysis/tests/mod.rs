//! Analyses of answers whose numbers are known beforehand.

mod bad;
mod choices;
mod files;
mod inference;
mod pairs;
mod ranking;
mod settings;
mod speeds;

use std::path::PathBuf;

use super::*;
use crate::design::{Design, Subject};
use crate::{
    Answer, Apparatus, Course, Grade, Outcome, Presentation, Proof, Record, Step, Task, Timing,
    Trial,
};
use selvedge_foundation::progress::unheard;

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
    unheard(|progress| analyse(found, &few(), progress)).unwrap()
}

fn record(trial: Trial, answer: Answer, response_s: u64) -> Record {
    let is_correct = trial.task.verdict(&answer).unwrap();
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
            response_ns: start_ns + response_s * 1_000_000_000,
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
                course.answer(&said).unwrap();
                records.push(record(trial, said, 5));
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
    let Task::OddOne { odd, .. } = task else {
        panic!("no triad");
    };
    let position = if is_right { *odd } else { (odd + 1) % 3 };
    Answer::Odd { position, grade }
}

fn judged(task: &Task, said: bool, confidence: u8) -> Answer {
    match task {
        Task::Judge { .. } => Answer::Judged {
            is_real: said,
            confidence: Some(confidence),
        },
        Task::JudgePair { real, .. } => Answer::Chosen {
            position: if said { *real } else { 1 - real },
            confidence: None,
        },
        _ => panic!("no judgement"),
    }
}
