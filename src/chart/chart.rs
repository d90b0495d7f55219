//! A chart as plain data: two axes, what is drawn over them, and the numbers as a table.

use super::ticks::Ruler;
use super::{Axis, Band, Bars, Columns, Ink, Raster, Rule, Series, Words};

/// What a plot shows, the same on the screen, on paper and as a table.
///
/// What is drawn lies in layers, the lowest first: the raster, bands, bars, rules, series, words.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    /// What it shows, one line; may be empty.
    pub title: String,
    /// What the title is written in.
    pub ink: Ink,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// How the vertical axis is drawn.
    pub upright: Upright,
    /// Colours over the whole frame.
    pub raster: Option<Raster>,
    /// Areas between two lines.
    pub bands: Vec<Band>,
    /// Histograms.
    pub bars: Vec<Bars>,
    /// Values that are marked on an axis.
    pub rules: Vec<Rule>,
    /// Lines and dots, the first below the others; those with a name are in the legend.
    pub series: Vec<Series>,
    /// Words at places of the frame.
    pub words: Vec<Words>,
    /// A small line below: where it comes from. Charts of a figure have its notes instead.
    pub footnote: String,
    /// Its numbers.
    pub columns: Columns,
    /// Its width as a share of a figure's row; 0 counts as 1.
    pub width: f64,
    /// Whether the horizontal axis has no labels: it is that of the chart below.
    pub is_x_shared: bool,
}

/// How a vertical axis is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Upright {
    /// Upward, with its labels.
    #[default]
    Upward,
    /// Downward, with its labels: rows of a table.
    Downward,
    /// Upward, without labels: it is that of the chart on its left.
    Shared,
}

impl Chart {
    /// Both axes with the ends that they have at rest: those given, or those of the values.
    pub fn rulers(&self) -> [Ruler; 2] {
        let points = |axis: usize| {
            let points = self.series.iter().flat_map(|series| &series.points);
            points.map(move |point| point[axis])
        };
        let of_bands = |at: &'static [usize]| {
            let points = self.bands.iter().flat_map(|band| &band.points);
            points.flat_map(move |point| at.iter().map(|at| point[*at]))
        };
        let of_bars = |at: &'static [usize]| {
            let bins = self.bars.iter().flat_map(|bars| &bars.bins);
            bins.flat_map(move |bin| at.iter().map(|at| bin[*at]))
        };
        let x = points(0).chain(of_bands(&[0])).chain(of_bars(&[0, 1]));
        let y = points(1).chain(of_bands(&[1, 2])).chain(of_bars(&[2]));
        [Ruler::of(&self.x, x), Ruler::of(&self.y, y)]
    }
}
