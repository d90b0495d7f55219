//! A figure of several panels as plain data: what a page of measurement shows, and where it comes
//! from.

use super::{Axis, Chart};

/// Panels under one title, with their provenance below.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure {
    /// What it shows, one line.
    pub title: String,
    /// The panels, row by row.
    pub rows: Vec<Row>,
    /// Small lines below: what was drawn how, and where it comes from.
    pub notes: Vec<String>,
    /// All that is known of where it comes from, by name: in the SVG, not in the picture.
    pub about: Vec<(String, String)>,
}

/// Panels side by side, with one colour bar at their right end.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row {
    /// The charts, from left to right.
    pub panels: Vec<Chart>,
    /// The height of their frames, px; the whole figure is 860 px wide.
    pub height_px: f64,
    /// Which colour stands for how much, where colours stand for numbers.
    pub bar: Option<ColourBar>,
}

/// Which colour stands for how much.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColourBar {
    /// The numbers and their unit; its ends must be given.
    pub axis: Axis,
    /// Evenly spaced colours from the lower end of the axis to the upper one.
    pub colours: Vec<[u8; 3]>,
}
