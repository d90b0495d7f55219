//! One row of a log: a trial, what was answered, when, and on which apparatus.
//!
//! Every log has the same columns around those of its method, each declared in [`columns`].
//! Positions, blocks, trials and attempts count from 1 in files, from 0 in code; stimuli go by
//! their ids.

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

use super::design::{Design, JudgingProtocol, Method, Subject};
use super::presentation::Presentation;
use super::trial::{Answer, Grade, Task, Trial};
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
    let (task, answer) = question(&design.method);
    Record {
        trial: Trial {
            block: 0,
            number: 0,
            is_practice: false,
            task,
        },
        attempt: 1,
        outcome: Outcome::Answered(answer),
        is_correct: None,
        timing: Timing::default(),
        apparatus: Apparatus::default(),
        presentation: Presentation::default(),
        note: String::new(),
    }
}

/// What a method asks, and an answer to it.
fn question(method: &Method) -> (Task, Answer) {
    let (item, items) = (0, [0; 2]);
    let chosen = Answer::Chosen {
        position: 0,
        confidence: None,
    };
    let judged = Answer::Judged {
        is_real: false,
        confidence: None,
    };
    match method {
        Method::Ranking(_) => {
            let (target, alternatives) = (0, [0; 4]);
            let task = Task::Rank {
                target,
                alternatives,
            };
            (task, Answer::Ranks([0; 4]))
        }
        Method::OddOneOut(_) => {
            let (items, odd) = ([0; 3], 0);
            let (position, grade) = (0, Grade::Normal);
            (Task::OddOne { items, odd }, Answer::Odd { position, grade })
        }
        Method::Adjustment(adjusting) => {
            let (starts, steps) = (vec![0.0; adjusting.parameters.len()], Vec::new());
            let values = starts.clone();
            (
                Task::Adjust { item, starts },
                Answer::Adjusted { values, steps },
            )
        }
        Method::Judgement(judging) => match judging.protocol {
            JudgingProtocol::Single => (
                Task::Judge {
                    item,
                    is_real: false,
                },
                judged,
            ),
            JudgingProtocol::Pair => (Task::JudgePair { items, real: 0 }, chosen),
        },
        Method::Levels(_) => {
            let (track, level_db, signal) = (0, 0.0, 0);
            let task = Task::Interval {
                track,
                level_db,
                signal,
            };
            (task, chosen)
        }
        Method::Magnitude { .. } => (Task::Estimate { item }, Answer::Magnitude(0.0)),
        Method::Rating(rating) => {
            let places = vec![0.0; rating.scales.len()];
            (Task::Rate { item }, Answer::Ratings(places))
        }
    }
}
