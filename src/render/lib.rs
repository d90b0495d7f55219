//! From a scene and a moving finger to the amplitudes of every contactor, 40 times a second.
//!
//! `array` renders a display's contactors (reference, banded, table), writes the drive waveform
//! and explains single contactors; `plan` decides what a tick has to evaluate; `replay` runs a
//! whole path and measures cost and error; `difference` says by how much two runs differ. Knows
//! nothing of files, devices, threads or screens.
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
mod difference;
mod gains;
mod input;
mod plan;
mod replay;
mod running_error;
pub mod scene;
mod stats;

pub use difference::{DifferenceMeter, Largest, LevelDifference, Spread, Tally};
pub use gains::GainTerms;
pub use input::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
pub use plan::{Counters, Rule, Rules};
pub use replay::{Replay, replay, replay_pair};
pub use running_error::RunningError;
pub use stats::{ErrorMeter, Histogram, LevelError, RunStats};

use selvedge_textile::tactile::TuningError;

/// Why something cannot be rendered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// A gain, or compression, makes no sense.
    #[error(transparent)]
    Tuning(#[from] TuningError),
    /// A place, size or angle is NaN or infinite.
    #[error("the place, size or angle of {what} {index} is not finite; give finite numbers")]
    NotFinite {
        /// Textile or display.
        what: &'static str,
        /// Which one, from 0.
        index: usize,
    },
    /// More textiles than an index can name.
    #[error("{n_textiles} textiles in one scene; place at most {at_most}")]
    TooManyTextiles {
        /// How many there are.
        n_textiles: usize,
        /// How many there may be.
        at_most: usize,
    },
    /// A textile that the scene does not place.
    #[error("there is no textile {index}; the scene places {n_textiles}, counted from 0")]
    NoTextile {
        /// Which one was meant, from 0.
        index: usize,
        /// How many there are.
        n_textiles: usize,
    },
    /// Levels do not match the textiles placed.
    #[error("{given} levels for {wanted} textiles; give one for each")]
    WrongNumberOfLevels {
        /// How many were given.
        given: usize,
        /// How many textiles there are.
        wanted: usize,
    },
    /// The tables of these textiles would not fit.
    #[error("the tables would take {megabytes} MB; use method banded, or shorter profiles")]
    TableTooLarge {
        /// How much they would take, 10⁶ bytes.
        megabytes: usize,
    },
    /// An error budget or a filter floor that is no number or negative.
    #[error("{key} is {value}; give a finite number, 0 or above")]
    Accuracy {
        /// Which one.
        key: &'static str,
        /// What it was.
        value: f64,
    },
    /// A sample rate or a scale that no waveform can have.
    #[error("{key} is {value}; {mend}")]
    Drive {
        /// Which one.
        key: &'static str,
        /// What it was.
        value: f64,
        /// How to mend it.
        mend: &'static str,
    },
}

/// A number as the stream holds it. Beyond the range of f32 it saturates to infinity.
#[expect(
    clippy::cast_possible_truncation,
    reason = "design in f64, stream in f32"
)]
pub fn single(x: f64) -> f32 {
    x as f32
}
