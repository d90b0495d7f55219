//! The sound of what is felt, as the user switched it: a stream while it is on, none otherwise.

use selvedge_engine::{SoundControl, SoundOutput, SoundState};

/// Sound, as far as it was begun.
#[derive(Debug, Default)]
pub(crate) struct Sound {
    pub(crate) playing: Option<(SoundOutput, SoundControl)>,
    /// Whether the chosen contactor alone is heard.
    pub(crate) is_alone: bool,
    /// Whether the line of time is dragged: what every view shows is heard, though it is held.
    pub(crate) is_scrubbed: bool,
    /// Whether nothing is to be heard for now, though sound is on.
    pub(crate) is_held: bool,
    /// Whether the user knows why nothing is heard.
    pub(crate) is_told: bool,
}

impl Sound {
    /// How it stands with what plays, if anything is to.
    pub(crate) fn state(&self) -> Option<SoundState> {
        self.playing.as_ref().map(|(output, _)| output.state())
    }
}
