//! Charts as plain data, and their pictures and tables: SVG text, RGBA pixels, CSV.
//!
//! Knows nothing of textiles and writes no file: callers join it with `files`. A [`Chart`] is also
//! what the window paints (workbench/kit/plot), with the ticks of the same [`Ruler`].
//!
//! ```text
//! Chart ──▶ ticks (rulers), label, look ─▶ frame (grid, layers) ─▶ svg ─────┬▶ pixels
//! Figure ─▶ the same for every chart, raster (colours over a frame) ─▶ compose ┘
//! Columns ▶ CSV
//! ```
//!
//! A chart of its own has its legend beside it; a [`Figure`] is rows of charts with rasters,
//! colour bars and marked values under one title, as a paper prints them.
//!
//! # Invariants
//! - the same chart or figure gives the same bytes
//! - the one home of `resvg`: pixels show what the SVG says
//! - no I/O, no clock; values that are not finite are left out of the picture: counted below a
//!   chart of its own, gaps in a figure, where they mean a pause or silence
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod axis;
mod chart;
mod columns;
mod compose;
mod figure;
#[cfg(test)]
mod figure_tests;
mod frame;
mod label;
mod layer;
mod legend;
mod look;
mod marks;
mod pixels;
mod raster;
mod rules;
mod svg;
#[cfg(test)]
mod tests;
mod text;
mod ticks;

pub use axis::{Axis, Scale};
pub use chart::{Chart, Upright};
pub use columns::{Columns, Values};
pub use figure::{ColourBar, Figure, Row};
pub use layer::{At, Band, Bars, Extent, Ink, Raster, Rule, Series, Style, Tone, Weight, Words};
pub use look::Paper;
pub use pixels::{FigureError, Pixels};
pub use ticks::Ruler;
