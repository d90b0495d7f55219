//! The controls that the toolkit does not have: a slider for gains, and small pieces of text.
//!
//! They draw and report; they change nothing themselves.

mod slider;
mod text;

pub(crate) use slider::{Scale, slider_row};
pub(crate) use text::{button, mark, pair, row, section};
