//! One row of a log: a trial, what was answered, when, and on which apparatus.
//!
//! Every log has the same columns around those of its method ([`columns`]). Positions, blocks,
//! trials and attempts count from 1 in files, from 0 in code; stimuli go by their ids.

mod read;
mod task;

use std::time::SystemTime;

pub(crate) use read::read_records;

use super::design::{Design, Method, Subject};
use super::trial::{Answer, Trial};
use selvedge_foundation::files::push_number;
use selvedge_foundation::quantity::rfc3339;
use selvedge_textile::tactile::Tuning;

/// The version of the columns; a log of a later one is refused.
pub(super) const SCHEMA_VERSION: u32 = 1;

/// What came of a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It was answered.
    Answered(Answer),
    /// It was given up, and comes again.
    Aborted,
}

/// When a trial began and was answered, by the clock on the wall and by one that never jumps.
#[derive(Debug, Clone, PartialEq, Eq)]
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
    /// What the experimenter noted.
    pub note: String,
}

/// Columns before those of the method.
const BEFORE: [(&str, &str); 9] = [
    ("schema_version", "version of these columns"),
    ("study", "id of the study"),
    ("experiment", "which experiment of the study"),
    ("subject", "pseudonym"),
    ("session", "session of this subject, from 1"),
    ("block", "block, from 1"),
    ("trial", "trial, from 1; practice counts by itself"),
    ("attempt", "attempt at the trial, from 1"),
    ("practice", "1 for practice, which does not count"),
];

/// Columns after those of the method.
const AFTER: [(&str, &str); 18] = [
    (
        "response",
        "what was chosen; empty where several numbers were given",
    ),
    (
        "confidence",
        "how sure that was, from 1; empty where not asked",
    ),
    ("correct", "1 right, 0 wrong, empty where neither"),
    ("rt_ms", "from beginning to answer, ms"),
    ("t_start_utc", "beginning, UTC, RFC 3339"),
    ("t_response_utc", "answer, UTC, RFC 3339"),
    ("t_start_ns", "beginning, ns since the session was opened"),
    ("t_response_ns", "answer, ns since the session was opened"),
    ("stimulus_hash", "what the stimuli were made from"),
    ("device", "the device as it calls itself"),
    ("gain_db", "gain of everything, dB"),
    ("gain_40_db", "gain of the 40 Hz band, dB"),
    ("gain_320_db", "gain of the 320 Hz band, dB"),
    ("compression", "compression, 0 to 1"),
    ("seed", "seed of the study"),
    ("software", "program and version"),
    ("aborted", "1 where the trial was given up and came again"),
    ("note", "the experimenter's note"),
];

/// The columns of a design's logs, each with what it holds.
pub fn columns(design: &Design) -> Vec<(String, String)> {
    let owned = |&(name, what): &(&str, &str)| (name.to_owned(), what.to_owned());
    let before = BEFORE.iter().map(owned);
    let after = AFTER.iter().map(owned);
    before
        .chain(task::columns(&design.method))
        .chain(after)
        .collect()
}

/// The names of the columns of a design's logs.
pub(crate) fn column_names(design: &Design) -> Vec<String> {
    columns(design).into_iter().map(|(name, _)| name).collect()
}

impl Record {
    /// The cells of its row, in the order of [`columns`].
    pub fn cells(&self, design: &Design, subject: &Subject) -> Vec<String> {
        let mut cells = vec![
            SCHEMA_VERSION.to_string(),
            design.study.clone(),
            design.experiment.clone(),
            subject.pseudonym.clone(),
            subject.session.to_string(),
            (self.trial.block + 1).to_string(),
            (self.trial.number + 1).to_string(),
            self.attempt.to_string(),
            flag(self.trial.is_practice),
        ];
        cells.extend(task::cells(design, &self.trial.task, self.answer()));
        let tuning = &self.apparatus.tuning;
        let (response, confidence) = self.answer().map_or_else(Default::default, told);
        cells.extend([
            response,
            confidence,
            self.is_correct.map_or_else(String::new, flag),
            number(self.timing.response_ms()),
            self.timing.start_utc.clone(),
            self.timing.response_utc.clone(),
            self.timing.start_ns.to_string(),
            self.timing.response_ns.to_string(),
            self.apparatus.stimulus_hash.clone(),
            self.apparatus.device.clone(),
            number(tuning.gain_db),
            number(tuning.gain_40_db),
            number(tuning.gain_320_db),
            number(tuning.compression),
            design.seed.to_string(),
            selvedge_foundation::PROGRAM.to_owned(),
            flag(self.outcome == Outcome::Aborted),
            self.note.clone(),
        ]);
        cells
    }

    /// What was answered, if it was.
    pub fn answer(&self) -> Option<&Answer> {
        match &self.outcome {
            Outcome::Answered(answer) => Some(answer),
            Outcome::Aborted => None,
        }
    }
}

/// Response and confidence as cells.
fn told(answer: &Answer) -> (String, String) {
    let sure = |confidence: Option<u8>| confidence.map_or_else(String::new, |c| c.to_string());
    match answer {
        Answer::Ranks(ranks) => {
            let first = ranks.iter().position(|&rank| rank == 1);
            (first.map_or_else(String::new, position), String::new())
        }
        Answer::Odd { position: at, .. } => (position(*at), String::new()),
        Answer::Judged {
            is_real,
            confidence,
        } => {
            let said = if *is_real { "real" } else { "generated" };
            (said.to_owned(), sure(*confidence))
        }
        Answer::Chosen {
            position: at,
            confidence,
        } => (position(*at), sure(*confidence)),
        Answer::Magnitude(value) => (number(*value), String::new()),
        Answer::Adjusted { .. } | Answer::Ratings(_) => Default::default(),
    }
}

fn flag(is_so: bool) -> String {
    u8::from(is_so).to_string()
}

fn position(at: usize) -> String {
    (at + 1).to_string()
}

fn number(value: f64) -> String {
    let mut text = String::new();
    push_number(&mut text, value);
    text
}

#[cfg(test)]
mod tests;
