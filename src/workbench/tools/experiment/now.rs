//! What happens in a session at the moment, and since when.

use std::time::{Instant, SystemTime};

use selvedge_experiment::design::Familiarisation;
use selvedge_experiment::{Step, Trial};

/// What happens now, kept while the session is away to be written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Now {
    /// The participant reads.
    Instructions(String),
    /// A movement is practised.
    Familiarisation(Familiarisation),
    /// A trial waits for its answer.
    Trial(Trial),
    /// A break of at least so many seconds.
    Break {
        /// The block that was ended, from 0.
        after_block: usize,
        /// Its least length, s.
        least_s: f64,
    },
    /// All is answered.
    Finished,
}

impl Now {
    pub(crate) fn of(step: &Step<'_>) -> Self {
        match *step {
            Step::Instructions(text) => Self::Instructions(text.to_owned()),
            Step::Familiarisation(movement) => Self::Familiarisation(movement),
            Step::Trial(trial) => Self::Trial(trial.clone()),
            Step::Break {
                after_block,
                least_s,
            } => Self::Break {
                after_block,
                least_s,
            },
            Step::Finished => Self::Finished,
        }
    }
}

/// Whether the session rests between two trials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Pause {
    /// No.
    #[default]
    None,
    /// Before the next trial.
    Wanted,
    /// Now.
    On,
}

/// When the present step began.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Began {
    /// By the clock on the wall.
    pub utc: SystemTime,
    /// By one that never jumps.
    pub at: Instant,
    /// By the toolkit's, s.
    pub shown_s: f64,
}
