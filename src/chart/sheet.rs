//! A figure of several panels as plain data: what a page of measurement shows, and where it comes
//! from.

use super::{Axis, Ink, Series};

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
    /// The panels.
    pub panels: Vec<Panel>,
    /// The height of their frames, px; the whole figure is 860 px wide.
    pub height_px: f64,
    /// Which colour stands for how much, where colours stand for numbers.
    pub bar: Option<ColourBar>,
}

/// One frame with two axes and what is drawn in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// What it shows, above it; may be empty.
    pub title: String,
    /// What the title is written in.
    pub ink: Ink,
    /// Its width as a share of the row; 0 counts as 1.
    pub width: f64,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// How the vertical axis is drawn.
    pub upright: Upright,
    /// Whether the horizontal axis has no labels: it is that of the panel below.
    pub is_x_shared: bool,
    /// Colours over the whole frame, below everything else.
    pub raster: Option<Raster>,
    /// Lines and dots, the first below the others; those with a name are in the legend.
    pub series: Vec<Series>,
    /// Values that are marked on an axis.
    pub rules: Vec<Rule>,
    /// Words at places of the frame.
    pub words: Vec<Words>,
}

/// How a vertical axis is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Upright {
    /// Upward, with its labels.
    #[default]
    Upward,
    /// Downward, with its labels: rows of a table.
    Downward,
    /// Upward, without labels: it is that of the panel on its left.
    Shared,
}

/// Colours in even cells over a whole frame.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Raster {
    /// Cells side by side.
    pub n_columns: usize,
    /// Red, green and blue of every cell, row by row from the top; `None` leaves the paper white.
    pub cells: Vec<Option<[u8; 3]>>,
}

/// Which colour stands for how much.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColourBar {
    /// The numbers and their unit; its ends must be given.
    pub axis: Axis,
    /// Evenly spaced colours from the lower end of the axis to the upper one.
    pub colours: Vec<[u8; 3]>,
}

/// A value that is marked on an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rule {
    /// Which value of which axis.
    pub at: At,
    /// What is written at its end; may be empty.
    pub label: String,
    /// What it is drawn with.
    pub ink: Ink,
    /// How it is drawn.
    pub extent: Extent,
}

/// A value of one of the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum At {
    /// Of the horizontal axis.
    X(f64),
    /// Of the vertical axis.
    Y(f64),
}

impl Default for At {
    fn default() -> Self {
        Self::X(0.0)
    }
}

/// How far a rule reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Extent {
    /// All across the frame.
    #[default]
    Across,
    /// The same, dashed.
    Dashed,
    /// A short mark outside: above the frame, or right of it.
    Edge,
}

/// Words at a place of a frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Words {
    /// The place of their middle, as values of the axes.
    pub at: [f64; 2],
    /// The words.
    pub text: String,
    /// How they stand out from what is under them.
    pub tone: Tone,
}

/// How words stand out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tone {
    /// Dark, on paper and bright colours.
    #[default]
    Dark,
    /// White, on dark colours.
    Light,
    /// Grey, right of their place and below it: the name of a dot.
    Aside,
}

impl Raster {
    /// Rows of cells.
    pub fn n_rows(&self) -> usize {
        self.cells.len().checked_div(self.n_columns).unwrap_or(0)
    }
}
