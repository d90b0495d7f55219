//! Plots as plain data, and their pictures: SVG text and RGBA pixels.
//!
//! Knows nothing of textiles and writes no file: callers join it with `files`.
//!
//! ```text
//! Plot ─▶ ticks (rulers), label, look ─▶ svg (frame, series, legend, footnote) ─▶ pixels
//! ```
//!
//! # Invariants
//! - the same plot gives the same bytes
//! - the one home of `resvg`: pixels show what the SVG says
//! - no I/O, no clock; values that are not finite are left out of the picture and counted

mod label;
mod legend;
mod look;
mod pixels;
mod plot;
mod svg;
#[cfg(test)]
mod tests;
mod text;
mod ticks;

pub use pixels::{FigureError, Pixels};
pub use plot::{Axis, Plot, Scale, Series, Style};
