//! What can be wrong with an experiment: one line each.

use super::schedule::ScheduleError;
use super::trial::AnswerError;
use selvedge_foundation::files::FileError;
use selvedge_foundation::progress::Cancelled;
use selvedge_textile::TextileError;

/// What can be wrong with a design, a session or a log.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// A file: what, where and how to mend it.
    #[error(transparent)]
    File(#[from] FileError),
    /// No schedule exists.
    #[error(transparent)]
    Schedule(#[from] ScheduleError),
    /// An answer that does not answer the question.
    #[error(transparent)]
    Answer(#[from] AnswerError),
    /// A textile or a library.
    #[error(transparent)]
    Textile(#[from] TextileError),
    /// Work that was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A value that did not come from a file.
    #[error("{what}; {mend}")]
    Value {
        /// What is wrong.
        what: String,
        /// What to do about it.
        mend: String,
    },
}

impl ExperimentError {
    /// A value that did not come from a file.
    pub fn value(what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self::Value {
            what: what.into(),
            mend: mend.into(),
        }
    }
}
