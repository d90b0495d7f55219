//! Friction of a textile from its picture: what can be learnt of it, and how far that gets.
//!
//! ```text
//! cloth (recipe, relief, photo, finger) ─▶ example (windows, splits) ─▶ network ─┐
//! picture (strip, its spectra) ───────────▶ baseline ────────────────────────────┴─▶ score
//! signal (level, trend, spectra; and back)
//! ```
//!
//! # Invariants
//! - no rendering, no clocks; files only of runs
//! - the one home of the library of networks, in `network`
//! - same recipe, same seed, same bytes, whatever the number of threads
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

pub mod baseline;
pub mod cloth;
mod error;
pub mod example;
pub mod network;
pub mod picture;
pub mod runs;
pub mod score;
pub mod signal;

pub use error::FrictionError;
