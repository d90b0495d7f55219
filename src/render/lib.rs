//! From a scene and a moving finger to the amplitudes of every contactor, 40 times a second.
//!
//! `array` renders a display's contactors (reference, banded, table), writes the drive waveform
//! and explains single contactors; `plan` decides what a tick has to evaluate; `replay` runs a
//! whole path and measures cost and error; `difference` says by how much two runs differ.
//! `contact` is what a stylus feels instead of an array. Knows nothing of files, serial links,
//! threads or screens.
//!
//! # Invariants
//! - `tick` neither allocates, locks, logs, reads a clock nor fails; preparing allocates
//! - the same scene, method and poses give the same bytes: nothing depends on a clock or a thread
//! - amplitudes are peak, µm, after gains and before the limits of an output; always finite
//! - gains are applied after the spectra: changing them recomputes nothing
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

pub mod array;
pub mod contact;
mod difference;
pub mod electrovibration;
mod error;
mod error_meter;
mod gains;
mod input;
mod needed;
mod plan;
mod replay;
pub mod scene;
mod stats;
pub mod stylus;

pub use array::single;
pub use difference::{DifferenceMeter, Largest, LevelDifference, Spread, Tally};
pub use error::RenderError;
pub use error_meter::ErrorMeter;
pub use gains::GainTerms;
pub use input::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
pub use plan::{Counters, MaterialContact, Rule};
pub use replay::{Replay, replay, replay_pair};
pub use stats::{Histogram, LevelError, RunStats};
