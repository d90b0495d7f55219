//! What visitors of a public stage did: one row a visit, and what can be said of all of them.
//!
//! Nobody is known by it: days and hours, no times to the second, no paths, no names. Knows nothing
//! of windows, and no clock that a caller does not hand in.

mod log;
#[cfg(test)]
mod tests;
mod totals;

pub use log::VisitLog;
pub use totals::Totals;

use std::time::SystemTime;

use selvedge_foundation::quantity::rfc3339;

/// Cloths on a stage, and answers to a guess: chance is one in so many.
pub const N_CLOTHS: usize = 4;

const VISITS: &str = "visits.csv";
const GUESSES: &str = "guesses.csv";
const COMMENTS: &str = "comments.csv";

const VISIT_COLUMNS: [&str; 15] = [
    "visit",
    "day",
    "hour",
    "duration_s",
    "input",
    "array",
    "sound",
    "cloth_1_s",
    "cloth_2_s",
    "cloth_3_s",
    "cloth_4_s",
    "strokes",
    "guesses",
    "right",
    "end",
];
const GUESS_COLUMNS: [&str; 6] = ["visit", "truth", "choice", "order", "sound", "ms"];
const COMMENT_COLUMNS: [&str; 4] = ["visit", "face", "words", "comment"];

/// How a visit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VisitEnd {
    /// The visitor went through all of it.
    Done,
    /// Nothing moved for a while.
    Idle,
    /// The visitor held "restart".
    Restart,
    /// Everything was switched off.
    Stop,
}

impl VisitEnd {
    const ALL: [Self; 4] = [Self::Done, Self::Idle, Self::Restart, Self::Stop];

    fn word(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Idle => "idle",
            Self::Restart => "restart",
            Self::Stop => "stop",
        }
    }
}

/// One answer to "which of four is it?".
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Guess {
    /// The textile that was felt, by its id.
    pub truth: String,
    /// The textile that was chosen.
    pub choice: String,
    /// Which cloths the four pictures showed, in the order of their places: `3142`.
    pub order: String,
    /// Whether what was felt was heard too.
    pub is_heard: bool,
    /// From the question to the answer, ms.
    pub ms: u64,
}

impl Guess {
    /// Whether it is right.
    pub fn is_right(&self) -> bool {
        self.truth == self.choice
    }
}

/// What a visitor thought of it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Comment {
    /// The face that was chosen: `sad`, `so-so`, `glad`.
    pub face: &'static str,
    /// The words that were chosen.
    pub words: Vec<&'static str>,
    /// What was typed.
    pub text: String,
}

impl Comment {
    /// The longest text, characters.
    pub const LONGEST: usize = 200;

    fn is_empty(&self) -> bool {
        self.face.is_empty() && self.words.is_empty() && self.text.is_empty()
    }
}

/// A visit from its first touch to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Visit {
    /// How long it was, s.
    pub duration_s: f64,
    /// What was touched with: `touch`, `mouse`, `keys`.
    pub input: &'static str,
    /// Whether the array was armed at any time.
    pub was_armed: bool,
    /// How loud it was at the end: `off`, `quiet`, `middle`, `loud`.
    pub sound: &'static str,
    /// How long each cloth was stroked, s.
    pub cloth_s: [f64; N_CLOTHS],
    /// Strokes over any cloth.
    pub n_strokes: u32,
    /// What was guessed.
    pub guesses: Vec<Guess>,
    /// What was said of it.
    pub comment: Comment,
    /// How it ended.
    pub end: VisitEnd,
}

impl Visit {
    /// Right guesses.
    fn n_right(&self) -> usize {
        self.guesses.iter().filter(|guess| guess.is_right()).count()
    }

    fn row(&self, number: u64, now: SystemTime) -> Vec<String> {
        let moment = rfc3339(now);
        let part = |range: std::ops::Range<usize>| moment.get(range).unwrap_or_default().to_owned();
        let mut row = vec![
            number.to_string(),
            part(0..10),
            part(11..13),
            format!("{:.0}", self.duration_s),
            self.input.to_owned(),
            if self.was_armed { "armed" } else { "off" }.to_owned(),
            self.sound.to_owned(),
        ];
        row.extend(self.cloth_s.map(|s| format!("{s:.0}")));
        row.push(self.n_strokes.to_string());
        row.push(self.guesses.len().to_string());
        row.push(self.n_right().to_string());
        row.push(self.end.word().to_owned());
        row
    }
}

/// What earlier visitors guessed: told to later ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Visits so far.
    pub n_visits: u64,
    /// Visits with all three guesses.
    pub n_guessed: u64,
    /// Right guesses in those.
    pub n_right: u64,
}

impl Tally {
    /// Right guesses of most people: the mean of those who gave all three.
    pub fn mean_right(self) -> f64 {
        self.n_right as f64 / self.n_guessed.max(1) as f64
    }

    /// Takes in a visit that is over.
    pub fn take(&mut self, visit: &Visit) {
        self.count(visit.guesses.len(), visit.n_right());
    }

    fn count(&mut self, n_guesses: usize, n_right: usize) {
        self.n_visits += 1;
        if n_guesses >= 3 {
            self.n_guessed += 1;
            self.n_right += n_right as u64;
        }
    }
}
