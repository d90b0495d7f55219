//! One row of a log: a trial, what was answered, when, and on which apparatus.
//!
//! Every log has the same columns around those of its method, each declared in [`columns`].
//! Positions, blocks, trials and attempts count from 1 in files, from 0 in code; stimuli go by
//! their ids.

mod asked;
mod columns;
mod mark;
mod read;
mod values;

use std::convert::Infallible;
use std::time::SystemTime;

pub(crate) use columns::{
    ColumnDescription, column_names, describe_trial, described_columns, dictionary,
};
pub(crate) use mark::{Mark, MarkKind, read_marks};
pub(crate) use read::{read_records, trials};

use super::design::{Composition, Design, Form, Subject};
use super::presentation::Presentation;
use super::trial::{Adapted, Answer, AnswerValue, Task, Trial};
use columns::{Column, Visit, visit};
use selvedge_foundation::quantity::rfc3339;
use selvedge_textile::tactile::Tuning;
use values::Value;

/// The version of the columns; a log of a later one is refused. The first knew neither proof of
/// presentation nor rows that are bound to each other.
pub(crate) const SCHEMA_VERSION: u32 = 2;
/// What rows of trials are called, which are all in the first version.
const TRIAL: &str = "trial";

/// What came of a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It was answered.
    Answered(Answer),
    /// It was given up, and comes again.
    Aborted,
}

/// When a trial began and was answered, by the clock on the wall and by one that never jumps.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Timing {
    /// The beginning, UTC as RFC 3339.
    pub(crate) start_utc: String,
    /// The answer, UTC as RFC 3339.
    pub response_utc: String,
    /// The beginning on a monotonic clock, ns since the session was opened.
    pub(crate) start_ns: u64,
    /// The answer on the same clock, ns.
    pub(crate) response_ns: u64,
}

impl Timing {
    /// From two moments on either clock.
    pub fn between(utc: [SystemTime; 2], since_opening_ns: [u64; 2]) -> Self {
        let [start, response] = utc.map(rfc3339);
        Self {
            start_utc: start,
            response_utc: response,
            start_ns: since_opening_ns[0],
            response_ns: since_opening_ns[1],
        }
    }

    /// The beginning, ns since the session was opened.
    pub fn start_ns(&self) -> u64 {
        self.start_ns
    }

    /// From the beginning to the answer, ms.
    pub fn response_ms(&self) -> f64 {
        #[expect(
            clippy::cast_precision_loss,
            reason = "sessions take hours, not months"
        )]
        let ns = self.response_ns.saturating_sub(self.start_ns) as f64;
        ns / 1e6
    }
}

/// What presented the stimuli.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Apparatus {
    /// The device as it calls itself; `simulated` or empty where there was none.
    pub device: String,
    /// The tuning in force.
    pub tuning: Tuning,
    /// What the stimuli were made from: a hash that changes when one of them does.
    pub stimulus_hash: String,
}

/// One row.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The trial.
    pub trial: Trial,
    /// Which attempt at it, from 1.
    pub attempt: u32,
    /// What came of it.
    pub outcome: Outcome,
    /// Whether the answer was right, where that can be said.
    pub is_correct: Option<bool>,
    /// When.
    pub timing: Timing,
    /// On what.
    pub apparatus: Apparatus,
    /// Whether it was felt.
    pub presentation: Presentation,
    /// What the experimenter noted.
    pub note: String,
}

impl Record {
    /// The cells of its row, in the order of the columns.
    pub fn cells(&self, design: &Design, subject: &Subject) -> Vec<String> {
        let mut to = Writer(design, Vec::new());
        let who = (subject.pseudonym.as_str(), subject.session);
        let Ok(()) = visit(&mut self.clone(), design, who, &mut to);
        to.1
    }

    /// What was answered, if it was, without how sure that was.
    pub fn value(&self) -> Option<&AnswerValue> {
        self.answer().map(|answer| &answer.value)
    }

    /// What was answered, if it was.
    pub fn answer(&self) -> Option<&Answer> {
        match &self.outcome {
            Outcome::Answered(answer) => Some(answer),
            Outcome::Aborted => None,
        }
    }
}

/// Writes a row.
struct Writer<'a>(&'a Design, Vec<String>);

impl Visit for Writer<'_> {
    type Error = Infallible;

    fn column(&mut self, _: Column, value: &mut dyn Value) -> Result<(), Infallible> {
        self.1.push(value.cell(self.0));
        Ok(())
    }
}

/// A record of a design that says nothing yet.
fn blank(design: &Design) -> Record {
    Record {
        trial: Trial {
            block: 0,
            number: 0,
            is_practice: false,
            task: blank_task(design),
        },
        attempt: 1,
        outcome: Outcome::Answered(blank_answer(&design.composition)),
        is_correct: None,
        timing: Timing::default(),
        apparatus: Apparatus::default(),
        presentation: Presentation::default(),
        note: String::new(),
    }
}

/// A trial of a design that says nothing yet.
fn blank_task(design: &Design) -> Task {
    let composition = &design.composition;
    let n = composition.presentation.n;
    let has_items = !design.stimuli.is_empty();
    Task {
        items: vec![0; if has_items { n } else { 0 }],
        reference: composition.has_reference().then_some(0),
        right: composition.has_right().then_some(0),
        adapted: composition.adaptation.as_ref().map(|_| Adapted::default()),
        starts: vec![0.0; composition.parameters().len()],
        is_catch: false,
    }
}

/// An answer that says nothing yet.
fn blank_answer(composition: &Composition) -> Answer {
    let n = composition.presentation.n;
    let value = match &composition.response.form {
        Form::Choice | Form::Words(_) | Form::SameDifferent => AnswerValue::Chosen(0),
        Form::Rank => AnswerValue::Ranks(vec![0; n]),
        Form::BestWorst(_) => AnswerValue::BestWorst([0; 2]),
        Form::Scales(scales) => AnswerValue::Ratings(vec![0.0; scales.len()]),
        Form::Number { .. } => AnswerValue::Number(0.0),
        Form::Piles => AnswerValue::Piles(vec![0; n]),
        Form::Adjustment(parameters) => AnswerValue::Adjusted {
            values: vec![0.0; parameters.len()],
            steps: Vec::new(),
        },
    };
    value.into()
}
