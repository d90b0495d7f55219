//! A program without audio: it says so.

use super::{AudioEntry, AudioError, AudioLatency, CardChannels, Silencer};
use selvedge_device::ArrayProfile;

/// A sound card that plays; there is none in this program.
#[derive(Debug)]
pub struct AudioOutput {
    never: std::convert::Infallible,
}

impl AudioOutput {
    /// The sound cards.
    ///
    /// # Errors
    /// Always: there is no audio in this program.
    pub fn list() -> Result<Vec<AudioEntry>, AudioError> {
        Err(AudioError::Absent)
    }

    /// Opens none.
    ///
    /// # Errors
    /// Always: there is no audio in this program.
    pub fn open(
        _name: &str,
        _profile: &ArrayProfile,
        _channels: &CardChannels,
    ) -> Result<Self, AudioError> {
        Err(AudioError::Absent)
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        match self.never {}
    }

    /// Whether it wants another frame.
    pub fn wants_frame(&self) -> bool {
        match self.never {}
    }

    /// Plays a frame: amplitudes [A40, A320] of every contactor, µm.
    pub fn push(&mut self, _amplitudes_um: &[[f32; 2]]) {
        match self.never {}
    }

    /// A way to silence it.
    pub fn silencer(&self) -> Silencer {
        match self.never {}
    }

    /// How late what is felt was at most.
    pub fn latency(&self) -> AudioLatency {
        match self.never {}
    }

    /// Ticks that began without a new frame.
    pub fn n_missed(&self) -> u64 {
        match self.never {}
    }

    /// How often the card ran dry or gave an error and went on.
    pub fn n_hiccups(&self) -> u64 {
        match self.never {}
    }

    /// What broke it, if something did.
    pub fn failure(&self) -> Option<AudioError> {
        match self.never {}
    }
}
