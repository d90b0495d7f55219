//! The sound of what is felt, as the user switched it: a stream while it is on, none otherwise.

use selvedge_engine::{SoundControl, SoundOutput, SoundState};

/// Sound, as far as it was begun.
#[derive(Debug, Default)]
pub(crate) struct Sound {
    pub(crate) playing: Option<(SoundOutput, SoundControl)>,
    /// What of the display is heard.
    pub(crate) of_display: Heard,
    /// Whether the line of time is dragged: what every view shows is heard, though it is held.
    pub(crate) is_scrubbed: bool,
    /// Whether the user knows why nothing is heard.
    pub(crate) is_told: bool,
}

impl Sound {
    /// How it stands with what plays, if anything is to.
    pub(crate) fn state(&self) -> Option<SoundState> {
        self.playing.as_ref().map(|(output, _)| output.state())
    }
}

/// What of the display is heard, as long as sound is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Heard {
    /// All of it.
    #[default]
    All,
    /// The chosen contactor alone.
    Alone,
    /// Nothing for now.
    Nothing,
}
