//! Friction of a textile from its picture: what can be learnt of it, and how far that gets.
//!
//! ```text
//! cloth (recipe, relief, photo, finger) ─▶ split, example (windows) ─▶ network ─┐
//! picture (strip, its spectra) ───────────▶ baseline ───────────────────────────┼─▶ score, runs
//! signal (level, trend, spectra; and back)                     predict ◀────────┘
//! ```
//!
//! After Cai et al. (2021), with what their numbers could not tell kept apart: the mean level, what
//! is slow, and the spectra of the rest.
//!
//! # Invariants
//! - no rendering, no clocks; files only of runs
//! - the one home of the library of networks, in `network`
//! - same recipe, same seed, same bytes, whatever the number of threads
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod baseline;
mod cloth;
mod error;
mod example;
mod fabric;
mod kept;
mod network;
mod picture;
mod predict;
mod runs;
mod score;
mod scores;
mod signal;
mod split;

pub use baseline::Baseline;
pub use error::FrictionError;
pub use fabric::{Fabric, LeftOut};
pub use kept::KeptRun;
pub use network::{AdversarialLoss, Lesson, Method};
pub use predict::{PredictedFriction, Predictor};
pub use runs::{Contestant, Run, Taken};
pub use score::{Measure, Measures};
pub use scores::Scores;
pub use split::Split;
