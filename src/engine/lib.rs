//! The real-time thread: pointer in, amplitudes out, forty times a second.
//!
//! At every tick of 25 ms the engine takes what the pointer did, estimates its velocity (or takes
//! it from a path), renders, hands the amplitudes to the bridge and publishes a [`Snapshot`].
//! [`EngineCore`] is that work without thread, clock or device; [`Engine`] is the handle on a named
//! thread that adds all three.
//!
//! ```text
//! Command ─▶ Engine::send ─ring─▶ thread ─▶ EngineCore::tick ─▶ amplitudes ─▶ bridge
//! PointerSender ─ring─▶ PointerInput ┘             └─▶ Snapshot ─triple buffer─▶ Engine::snapshot
//! ```
//!
//! # Invariants
//! - a tick neither allocates, locks, logs nor fails; what a command needs is made before it is
//!   sent, and what it replaces rides back to be dropped by whoever owns the [`Engine`]
//! - nothing here waits for the window; a full ring loses something that is counted
//! - STOP overtakes every queue ([`StopSwitch`]) and a thread that panics stops the device
//! - no GUI, no files in the thread: recordings are handed over as data, and `clip` writes what
//!   others render of them
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod audio;
mod clip;
mod cloth;
mod command;
mod engine_core;
mod error;
mod fingers;
mod handle;
mod input;
mod link;
mod meters;
mod prepared;
mod programs;
mod ready;
mod recording;
mod runner;
mod sample;
mod sequence;
mod snapshot;
mod snapshot_summary;
mod sound;
mod stop;
mod tap;
mod tick_sample;
mod track;
mod velocity;

pub use audio::{AudioEntry, AudioError, AudioLatency, AudioOutput, CardChannels, Silencer};
pub use clip::{ApplyTicks, ClipKind, ClipWriter, Written, side_by_side, write_clip};
pub use cloth::{ClothDrive, ClothFeed, ClothTick};
pub use command::{Command, Notice};
pub use engine_core::EngineCore;
pub use error::EngineError;
pub use handle::{Engine, EngineConfig};
pub use input::{
    Area, AxisRange, Control, InputDevice, InputError, InputLosses, InputRate, InputSource,
    Playback, PointerInput, PointerSender, Reading, SourceKind,
};
pub use meters::{DurationBucket, DurationHistogram};
pub use prepared::{PreparedScene, array_of};
pub use programs::{ProgramCounts, ProgramLink, loopback};
pub use recording::{LinkTally, RecordedSample, RecordedTick, Recording};
pub use sample::{PointerSample, SampleCounters};
pub use sequence::{Played, SequenceStep};
pub use snapshot::{
    ClockView, ContactorView, DisplayView, EngineCounters, LinkView, PointerView, RecordingView,
    RenderingView, Snapshot,
};
pub use sound::{
    SOUND_RATE_HZ, Sonifier, SoundControl, SoundFeed, SoundOutput, SoundSource, SoundState,
    StereoLevels, sonification, stereo_levels,
};
pub use stop::StopSwitch;
pub use tap::Tap;
pub use tick_sample::TickSample;
pub use velocity::{Estimate, VelocityEstimator, VelocityMethod};

use std::time::Duration;

/// The time between two ticks: 25 ms.
pub const TICK: Duration = Duration::from_millis(25);

/// Displays of a scene that fingers can hold; in a larger scene the others go with the first.
pub(crate) const MAX_FINGERS: usize = 10;

/// Ticks per second.
pub use selvedge_render::scene::TICKS_PER_S;

#[cfg(test)]
mod tests;
