//! What everything else stands on: places and turns, quantities and their printing, enumerations
//! with words ([`named!`]), progress and cancelling, numerical methods, and the formats of files.
//!
//! Knows no word of textiles. To read: [`geometry`], [`quantity`], [`progress`] and [`numerics`]
//! in any order, then [`files`].
//!
//! # Invariants
//! - no textiles, no devices, no windows
//! - the one home of the FFT crate, of the random-number crates and of every file format's crate
//! - same input, same seed, same bytes
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

pub mod files;
pub mod geometry;
mod names;
pub mod numerics;
pub mod panics;
pub mod progress;
pub mod quantity;
pub mod signals;

/// The program and its version, as the files that it writes name it.
pub const PROGRAM: &str = concat!("selvedge ", env!("CARGO_PKG_VERSION"));
