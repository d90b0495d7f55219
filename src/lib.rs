//! Selvedge: virtual textiles felt through a fingertip array of 24 vibrating contactors.
//!
//! A display is moved over cloth; for each contactor the renderer works out the amplitudes of a
//! 40 Hz and a 320 Hz vibration, forty times a second, and a serial bridge drives the array.
//!
//! ```text
//!  textile    recipe or profiles ─▶ surface   heights and local spectra in four directions
//!                                      │
//!  scene      placed textiles, display, path ─▶ render   A40 and A320 of every contactor
//!                                      │
//!  engine     forty ticks a second ─▶ bridge  drive codes, frames, a device or its emulator
//!                                      │
//!  app, cli   the workbench, and the same work without a window
//! ```
//!
//! Three ways in:
//! - [`textile::Library`] finds cloth, [`scene::Scene`] places it,
//!   [`render::array::ArrayRenderer`] feels it: a path becomes amplitudes without a clock or a
//!   device.
//! - [`engine::Engine`] does the same in real time and drives a [`bridge::Bridge`].
//! - [`app::run`] opens the window, [`cli::main`] is the command line.
//!
//! The modules below are floors, lowest first: each uses only those above it in this list.
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

pub mod geometry;
pub mod quantity;

pub mod progress;

pub mod numerics;

pub mod figure;
pub mod files;

pub mod statistics;

pub mod surface;

pub mod tactile;

pub mod textile;

pub mod scene;

pub mod render;

pub mod bridge;

pub mod engine;

pub mod experiment;

pub mod report;

pub mod app;

pub mod cli;
