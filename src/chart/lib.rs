//! Plots as plain data, and their pictures: SVG text and RGBA pixels.
//!
//! Knows nothing of textiles and writes no file: callers join it with `files`.
//!
//! ```text
//! Plot ───▶ ticks (rulers), label, look ─▶ frame (grid, series) ─▶ svg ──────┬▶ pixels
//! Figure ─▶ the same for every panel, raster (colours over a frame) ─▶ compose ┘
//! ```
//!
//! A [`Plot`] is one frame with a legend beside it; a [`Figure`] is rows of panels with rasters,
//! colour bars and marked values under one title, as a paper prints them.
//!
//! # Invariants
//! - the same plot or figure gives the same bytes
//! - the one home of `resvg`: pixels show what the SVG says
//! - no I/O, no clock; values that are not finite are left out of the picture: counted below a
//!   plot, gaps in a figure, where they mean a pause or silence
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod compose;
mod frame;
mod label;
mod legend;
mod look;
mod marks;
mod pixels;
mod plot;
mod raster;
mod sheet;
#[cfg(test)]
mod sheet_tests;
mod svg;
#[cfg(test)]
mod tests;
mod text;
mod ticks;

pub use look::Paper;
pub use pixels::{FigureError, Pixels};
pub use plot::{Axis, Ink, Plot, Scale, Series, Style, Weight};
pub use sheet::{At, ColourBar, Extent, Figure, Panel, Raster, Row, Rule, Tone, Upright, Words};
