//! What is drawn on a chart, as plain data: lines and dots, areas, bars, marked values, words,
//! pictures.

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
    /// Violet: one of several lines that belong to no band.
    Violet,
    /// Rose: another of them.
    Rose,
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
    /// How much of its ink is missing: 0 is full, 1 is nothing.
    pub faintness: f32,
}

impl Series {
    /// A line or dots by name, in the ink of its place.
    pub fn of(
        name: impl Into<String>,
        style: Style,
        points: impl IntoIterator<Item = [f64; 2]>,
    ) -> Self {
        Self {
            name: name.into(),
            points: points.into_iter().collect(),
            style,
            ..Self::default()
        }
    }
}

/// An area between a lower and an upper line: a range, an interval.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Band {
    /// What it is the range of, in hovering words.
    pub name: String,
    /// `[x, low, high]` in order.
    pub points: Vec<[f64; 3]>,
    /// What it is filled with, faintly.
    pub ink: Ink,
}

/// Bars from zero up: how often values fall between two ends.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bars {
    /// What the legend calls them.
    pub name: String,
    /// `[from, to, height]` in order.
    pub bins: Vec<[f64; 3]>,
    /// What they are filled with.
    pub ink: Ink,
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

/// Colours in even cells over a whole frame.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Raster {
    /// Cells side by side.
    pub n_columns: usize,
    /// Red, green and blue of every cell, row by row from the top; `None` leaves the paper white.
    pub cells: Vec<Option<[u8; 3]>>,
}

impl Raster {
    /// Rows of cells.
    pub fn n_rows(&self) -> usize {
        self.cells.len().checked_div(self.n_columns).unwrap_or(0)
    }
}
