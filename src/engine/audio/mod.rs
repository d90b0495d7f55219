//! Frames on a sound card with many channels, for labs that drive amplifiers from one.
//!
//! The card paces: whenever it begins a tick it takes the next frame, and whoever makes frames is
//! woken to make another. `wave` is what the card plays, without any card: limits, soft start and
//! the silence when frames stop. A card has no rule of silence of its own, so the rule stands here,
//! and a process that dies takes it along: for work at a bench, not for a finger that nobody
//! watches.
//!
//! The card itself needs the feature `audio`; without it everything here says so.

mod channels;
#[cfg(feature = "audio")]
mod device;
#[cfg(any(test, feature = "audio"))]
mod latency;
#[cfg(any(test, feature = "audio"))]
mod wave;
#[cfg(not(feature = "audio"))]
mod without;

pub use channels::CardChannels;
#[cfg(feature = "audio")]
pub use device::AudioOutput;
#[cfg(not(feature = "audio"))]
pub use without::AudioOutput;

use std::time::Duration;

/// Asks a card for silence, from any thread and any number of times; touches only atomics. `None`
/// while the sound falls, then how long the card still plays what it has taken.
pub type Silencer = Box<dyn Fn() -> Option<Duration> + Send + Sync>;

/// How late what is felt is at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AudioLatency {
    /// From the handing over of a frame to its first sample, in all.
    pub total: Duration,
    /// The part of the card: samples that it has taken and not played.
    pub card: Duration,
}

/// A sound card that could be played on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AudioEntry {
    /// What it is called.
    pub name: String,
    /// The most channels that it takes.
    pub n_channels: u16,
}

/// Why nothing is played.
#[derive(Debug, thiserror::Error)]
pub enum AudioError {
    /// The program was built without it.
    #[error("this program was built without audio; build it with --features audio")]
    Absent,
    /// There is none of that name, or more than one.
    #[error("{what} audio output is called \"{name}\"; \"selvedge bridge list\" names them")]
    Unknown {
        /// `no`, or `more than one`.
        what: &'static str,
        /// What was asked for.
        name: String,
    },
    /// Not one channel a contactor.
    #[error("{n_channels} channels are named for {n_contactors} contactors; give one for each")]
    Map {
        /// Channels that are named.
        n_channels: usize,
        /// Contactors that there are.
        n_contactors: usize,
    },
    /// It has too few channels, or plays nothing that we can.
    #[error("{name} does not take {n_channels} channels at 8 to 192 kHz; choose another")]
    Channels {
        /// What it is called.
        name: String,
        /// Channels that are needed.
        n_channels: usize,
    },
    /// The system refuses.
    #[error("{name}: {what}; is another program using it?")]
    System {
        /// What it is called.
        name: String,
        /// What the system said.
        what: String,
    },
}
