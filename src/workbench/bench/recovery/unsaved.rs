//! Work as text, with no more steps than can be read back.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::bench::history::History;
use selvedge_foundation::files::{
    FileError, from_json_str, keys_from_str, keys_to_string, to_json_string,
};

/// What it is called in errors.
const WORK: &str = "unsaved work";
/// Bytes of text above which the oldest steps are left out: it is written between two frames.
const MAX_WITH_STEPS: usize = 1_000_000;

/// Work that would be lost.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Unsaved {
    /// What people call it, with its file: `Scene “Sampler” (/home/me/sampler.scene.toml)`.
    pub(crate) name: String,
    /// What has changed: `3 steps, the last: 40 Hz gain`.
    pub(crate) what: String,
    work: Written,
}

/// All of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
enum Written {
    /// As TOML, which has infinite gains and no gaps in lists.
    Keys(String),
    /// As JSON, which has gaps in lists and no infinite gains.
    Json(String),
    /// Why it cannot be written down.
    Fault(String),
}

impl Unsaved {
    /// Work that has no steps.
    pub(crate) fn new(name: String, what: &str, work: &impl Serialize) -> Self {
        let text = to_json_string(work, Path::new(WORK));
        Self::of(name, what, text.map(Written::Json))
    }

    /// Work with as many of its newest steps as there is room for; `whole` puts them together.
    pub(crate) fn with_steps<S, K, W>(
        name: String,
        what: &str,
        history: &History<S, K>,
        whole: impl Fn(History<S, K>) -> W,
    ) -> Self
    where
        S: Clone + PartialEq,
        K: Copy + PartialEq,
        W: Serialize,
    {
        let mut n_steps = history.len();
        loop {
            let work = keys_to_string(&whole(history.newest(n_steps)), Path::new(WORK));
            // What is too long to be read back is no text at all.
            let n_bytes = work.as_ref().map_or(4 * MAX_WITH_STEPS, String::len);
            if n_bytes <= MAX_WITH_STEPS || n_steps == 0 {
                return Self::of(name, what, work.map(Written::Keys));
            }
            n_steps = (n_steps * MAX_WITH_STEPS / n_bytes).min(n_steps - 1);
        }
    }

    fn of(name: String, what: &str, work: Result<Written, FileError>) -> Self {
        Self {
            name,
            what: what.to_owned(),
            work: work.unwrap_or_else(|error| Written::Fault(error.to_string())),
        }
    }

    /// Why a crash would take it.
    pub(super) fn fault(&self) -> Option<&str> {
        match &self.work {
            Written::Fault(line) => Some(line),
            Written::Keys(_) | Written::Json(_) => None,
        }
    }

    /// The work again.
    ///
    /// # Errors
    /// Why it cannot be read, in one line.
    pub(crate) fn read<W: DeserializeOwned>(&self) -> Result<W, String> {
        let read = match &self.work {
            Written::Keys(text) => keys_from_str(text, Path::new(WORK)),
            Written::Json(text) => from_json_str(text, Path::new(WORK)),
            Written::Fault(line) => return Err(line.clone()),
        };
        read.map_err(|error| error.to_string())
    }
}
