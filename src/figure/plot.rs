//! A plot as plain data: axes, series of points, titles.

/// How values are laid on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithm; values that are not above zero have no place.
    Log,
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// What it measures, with the unit: `time a tick, s`.
    pub label: String,
    /// How values are laid on it.
    pub scale: Scale,
    /// Its ends; `None` takes those of the values, rounded.
    pub range: Option<[f64; 2]>,
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Dots.
    #[default]
    Dots,
    /// A line through the points in their order.
    Line,
    /// Both.
    LineAndDots,
    /// A dashed line: what was promised, or expected.
    Dashed,
}

/// Points that belong together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// What the legend calls it.
    pub name: String,
    /// `[x, y]` in order.
    pub points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub style: Style,
    /// Points that stand out, by their places in `points`: what nothing else beats.
    pub marked: Vec<usize>,
}

/// A plot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plot {
    /// What it shows, one line.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn.
    pub series: Vec<Series>,
    /// A small line below: where it comes from.
    pub footnote: String,
}
