//! The sound of what is felt, as the user switched it: a stream while it is on, none otherwise.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use selvedge_engine::{SoundOutput, SoundState};

/// Sound, as far as it was begun.
#[derive(Debug, Default)]
pub(crate) struct Sound {
    pub(crate) output: Option<Output>,
    /// Whether nothing is to be heard for now, though sound is on.
    pub(crate) is_held: bool,
    /// Whether the user knows why nothing is heard.
    pub(crate) is_told: bool,
}

/// What plays.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) output: SoundOutput,
    pub(crate) as_driven: Arc<AtomicBool>,
}

impl Sound {
    /// How it stands with what plays, if anything is to.
    pub(crate) fn state(&self) -> Option<SoundState> {
        self.output.as_ref().map(|playing| playing.output.state())
    }
}
