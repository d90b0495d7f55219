//! Plots as plain data, and their pictures: SVG text and RGBA pixels.
//!
//! Knows nothing of textiles and writes no file: callers join it with `files`.
//!
//! # Invariants
//! - the same plot gives the same bytes
//! - no I/O, no clock; values that are not finite are left out of the picture and counted

mod plot;

pub use plot::{Axis, Plot, Scale, Series, Style};
