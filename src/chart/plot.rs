//! A plot as plain data: axes, series of points, titles.

/// How values are laid on an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithm; values that are not above zero have no place.
    Log,
    /// Evenly, with a label at whole numbers alone: rows, columns, counts.
    Whole,
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

impl Axis {
    /// One on which values are laid evenly, from the least to the largest.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..Self::default()
        }
    }

    /// One on which they are laid by their logarithm.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// One with labels at whole numbers alone.
    pub fn whole(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Whole,
            ..Self::linear(label)
        }
    }

    /// The same from here to there, whatever the values.
    #[must_use]
    pub fn within(self, ends: [f64; 2]) -> Self {
        Self {
            range: Some(ends),
            ..self
        }
    }
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
    /// A line upright from the axis to every point.
    Stems,
}

/// What a series is drawn with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ink {
    /// A colour of its own; what is called 40 Hz is amber and what is called 320 Hz cyan.
    #[default]
    Own,
    /// Amber: 40 Hz.
    Amber,
    /// Cyan: 320 Hz.
    Cyan,
    /// Nearly black.
    Black,
    /// Grey.
    Grey,
}

/// How heavy a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weight {
    /// As lines usually are.
    #[default]
    Normal,
    /// Thin: what stands behind.
    Thin,
    /// Bold: what stands out.
    Bold,
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
    /// What it is drawn with.
    pub ink: Ink,
    /// How heavy its line is.
    pub weight: Weight,
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
