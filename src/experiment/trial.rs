//! One trial: what is presented, and what may be answered. Stimuli are numbers into the design's.

use thiserror::Error;

pub use selvedge_statistics::ranking::Grade;

/// Alternatives of a ranking.
pub const N_RANKED: usize = 4;
/// Items of a triad.
pub const N_TRIAD: usize = 3;

/// One trial of a session.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The block, from 0.
    pub block: usize,
    /// Its number among the trials that count, or among those of practice, from 0.
    pub number: usize,
    /// Practice does not count.
    pub is_practice: bool,
    /// What is asked.
    pub task: Task,
}

/// What is asked in a trial.
#[derive(Debug, Clone, PartialEq)]
pub enum Task {
    /// Rank alternatives by their likeness to the target, which is one of them.
    Rank {
        /// The target.
        target: usize,
        /// The alternatives by position.
        alternatives: [usize; N_RANKED],
    },
    /// Find the odd one of three, and say how hard that was.
    OddOne {
        /// The stimuli by position.
        items: [usize; N_TRIAD],
        /// The position of the odd one.
        odd: usize,
    },
    /// Turn the design's parameters until the stimulus is as asked.
    Adjust {
        /// The stimulus.
        item: usize,
        /// Where the parameters begin, in the design's order.
        starts: Vec<f64>,
    },
    /// Say whether a stimulus is real or generated.
    Judge {
        /// The stimulus.
        item: usize,
        /// Whether it is real.
        is_real: bool,
    },
    /// Say which of two is real.
    JudgePair {
        /// The stimuli by position.
        items: [usize; 2],
        /// The position of the real one.
        real: usize,
    },
    /// Find the interval that holds the (stronger) vibration.
    Interval {
        /// Which of the interleaved series, from 0.
        track: usize,
        /// The level of the signal, dB re 1 µm.
        level_db: f64,
        /// The interval that holds it, from 0.
        signal: usize,
    },
    /// Say how strong a stimulus is.
    Estimate {
        /// The stimulus.
        item: usize,
    },
    /// Place a stimulus on the design's scales.
    Rate {
        /// The stimulus.
        item: usize,
    },
}

/// A change of a parameter on the way to an adjustment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adjustment {
    /// Since the trial began, ms.
    pub at_ms: f64,
    /// Which of the design's parameters, from 0.
    pub parameter: usize,
    /// What it was turned to.
    pub value: f64,
}

/// What a person answered.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// The rank of each position, 1 for the most alike; each rank once.
    Ranks([u8; N_RANKED]),
    /// The position that was called odd, and how hard it was.
    Odd {
        /// The position, from 0.
        position: usize,
        /// How hard it was.
        grade: Grade,
    },
    /// What the parameters were left at, and how they came there.
    Adjusted {
        /// In the design's order.
        values: Vec<f64>,
        /// Every change in order of time.
        steps: Vec<Adjustment>,
    },
    /// Whether it was called real, and how sure that was from 1, where the design asks.
    Judged {
        /// It was called real.
        is_real: bool,
        /// From 1 (guessed); `None` where it was not asked for.
        confidence: Option<u8>,
    },
    /// The position or interval that was chosen, from 0, and how sure that was, where asked.
    Chosen {
        /// From 0.
        position: usize,
        /// From 1 (guessed); `None` where it was not asked for.
        confidence: Option<u8>,
    },
    /// How strong it is: a number above 0.
    Magnitude(f64),
    /// The place on each scale, in the design's order.
    Ratings(Vec<f64>),
}

/// An answer that does not answer the question.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AnswerError {
    /// The answer belongs to another kind of trial.
    #[error("this answers another question; {mend}")]
    OtherKind {
        /// What is asked.
        mend: &'static str,
    },
    /// A value that cannot be.
    #[error("{what}; {mend}")]
    Value {
        /// What is wrong.
        what: String,
        /// What to answer.
        mend: String,
    },
}

impl AnswerError {
    pub(super) fn value(what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self::Value {
            what: what.into(),
            mend: mend.into(),
        }
    }
}

impl Answer {
    /// Whether a choice is one of `n`.
    pub(super) fn check_choice(&self, n: usize) -> Result<(), AnswerError> {
        match self {
            Self::Chosen { position, .. } => check_position(*position, n),
            _ => Ok(()),
        }
    }
}

impl Task {
    /// Whether an answer is right; `None` where nothing is right or wrong.
    ///
    /// # Errors
    /// The answer is none to this question. How many scales and parameters there are is the
    /// design's to check.
    pub(crate) fn verdict(&self, answer: &Answer) -> Result<Option<bool>, AnswerError> {
        let chosen = |position: usize, n: usize| check_position(position, n).map(|()| position);
        match (self, answer) {
            (
                Self::Rank {
                    target,
                    alternatives,
                },
                Answer::Ranks(ranks),
            ) => {
                check_ranks(*ranks)?;
                let first = ranks.iter().position(|&rank| rank == 1);
                Ok(Some(first.is_some_and(|at| alternatives[at] == *target)))
            }
            (Self::OddOne { odd, .. }, Answer::Odd { position, .. }) => {
                Ok(Some(chosen(*position, N_TRIAD)? == *odd))
            }
            (Self::Adjust { .. }, Answer::Adjusted { values, .. }) => finite(values).map(|()| None),
            (Self::Judge { is_real, .. }, Answer::Judged { is_real: said, .. }) => {
                Ok(Some(said == is_real))
            }
            (Self::JudgePair { real, .. }, Answer::Chosen { position, .. }) => {
                Ok(Some(chosen(*position, 2)? == *real))
            }
            // How many intervals there are is the procedure's to check.
            (Self::Interval { signal, .. }, Answer::Chosen { position, .. }) => {
                Ok(Some(position == signal))
            }
            (Self::Estimate { .. }, Answer::Magnitude(value)) => strength(*value).map(|()| None),
            (Self::Rate { .. }, Answer::Ratings(values)) => finite(values).map(|()| None),
            _ => Err(AnswerError::OtherKind {
                mend: self.question(),
            }),
        }
    }

    /// What is asked, as an imperative.
    pub fn question(&self) -> &'static str {
        match self {
            Self::Rank { .. } => "rank all four, 1 for the one most like the target",
            Self::OddOne { .. } => "choose the odd one, then say how hard that was",
            Self::Adjust { .. } => "adjust until it is as asked",
            Self::Judge { .. } => "say whether this is real or generated",
            Self::JudgePair { .. } => "choose the one that is real",
            Self::Interval { .. } => "choose the interval with the vibration",
            Self::Estimate { .. } => "give a number above 0 for how strong it is",
            Self::Rate { .. } => "place it on every scale",
        }
    }
}

fn check_position(position: usize, n: usize) -> Result<(), AnswerError> {
    if position < n {
        return Ok(());
    }
    let what = format!("there is no number {}", position.saturating_add(1));
    Err(AnswerError::value(what, format!("give 1 to {n}")))
}

fn check_ranks(ranks: [u8; N_RANKED]) -> Result<(), AnswerError> {
    let is_once = (1..=4).all(|rank| ranks.contains(&rank));
    let what = || format!("the ranks are {ranks:?}");
    is_once
        .then_some(())
        .ok_or_else(|| AnswerError::value(what(), "give each of 1, 2, 3 and 4 once"))
}

fn finite(values: &[f64]) -> Result<(), AnswerError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(value) => Err(AnswerError::value(
            format!("{value} is no number"),
            "give a finite number",
        )),
    }
}

fn strength(value: f64) -> Result<(), AnswerError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let what = format!("{value} is no strength");
    Err(AnswerError::value(what, "give a finite number above 0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANK: Task = Task::Rank {
        target: 7,
        alternatives: [3, 7, 1, 2],
    };

    #[test]
    fn a_ranking_is_right_where_the_target_is_first() {
        assert_eq!(RANK.verdict(&Answer::Ranks([2, 1, 3, 4])), Ok(Some(true)));
        assert_eq!(RANK.verdict(&Answer::Ranks([1, 2, 3, 4])), Ok(Some(false)));
    }

    #[test]
    fn ranks_that_are_tied_are_refused_with_what_to_give() {
        let error = RANK.verdict(&Answer::Ranks([1, 1, 3, 4]));
        let text = error.map_err(|error| error.to_string());
        let described = "the ranks are [1, 1, 3, 4]; give each of 1, 2, 3 and 4 once";
        assert_eq!(text, Err(described.to_owned()));
    }

    #[test]
    fn an_answer_to_another_question_is_refused_with_the_question() {
        let error = RANK.verdict(&Answer::Magnitude(1.0)).unwrap_err();
        assert!(error.to_string().contains("rank all four"), "{error}");
    }

    #[test]
    fn strengths_of_zero_and_none_are_refused() {
        let task = Task::Estimate { item: 0 };
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(task.verdict(&Answer::Magnitude(value)).is_err(), "{value}");
        }
        assert_eq!(task.verdict(&Answer::Magnitude(0.5)), Ok(None));
    }
}
