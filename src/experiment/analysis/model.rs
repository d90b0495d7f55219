//! What an analysis found, as plain data: sections of notes, tables and figures.

use selvedge_chart::Figure;
use selvedge_statistics::{
    Computed, Freedom, Interval, Named, Outcome, Resampling, Sides, Summary, Undefined, bootstrap,
    mean, wilson,
};

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// What was analysed, one line.
    pub title: String,
    /// In the order of reading.
    pub sections: Vec<Section>,
}

/// Notes, tables and figures that belong together.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// What its files begin with: letters, digits and `-`; no two sections share one.
    pub key: String,
    /// Its heading.
    pub title: String,
    /// What a reader has to know, a sentence or two each.
    pub notes: Vec<String>,
    /// Its tables.
    pub tables: Vec<Table>,
    /// Its figures.
    pub figures: Vec<Drawn>,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// What its files end with; no two tables and figures of a section share one.
    pub key: String,
    /// Its caption.
    pub title: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// A cell for every column.
    pub rows: Vec<Vec<Cell>>,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Column {
    /// Its name in files: letters, digits and `_`, its unit at the end.
    pub name: String,
    /// What people read above it.
    pub heading: String,
}

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// A finite number.
    Number(f64),
    /// A text.
    Text(String),
    /// No number, and why.
    Undefined(String),
}

/// A figure, and the numbers that it is drawn from.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// What its files end with.
    pub key: String,
    /// Its picture.
    pub figure: Figure,
    /// What it shows, as numbers.
    pub points: Table,
}

impl Section {
    /// Without notes, tables and figures.
    pub fn new(key: impl Into<String>, title: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            title: title.into(),
            ..Self::default()
        }
    }

    /// Adds a note.
    pub fn note(&mut self, note: impl Into<String>) {
        self.notes.push(note.into());
    }
}

impl Table {
    /// An empty table with columns by name and heading.
    pub fn new(key: &str, title: &str, columns: &[(&str, &str)]) -> Self {
        let column = |(name, heading): &(&str, &str)| Column::new(name, heading);
        Self {
            key: key.to_owned(),
            title: title.to_owned(),
            columns: columns.iter().map(column).collect(),
            rows: Vec::new(),
        }
    }

    /// Further columns, for items that only the data know.
    pub(super) fn with_columns<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Self {
        let column = |name: &str| Column::new(&file_name(name, '_'), name);
        self.columns.extend(names.into_iter().map(column));
        self
    }

    /// Adds a row; cells that are missing are undefined.
    pub fn push(&mut self, row: impl IntoIterator<Item = Cell>) {
        let mut row: Vec<Cell> = row.into_iter().collect();
        let missing = || Cell::Undefined("no value".to_owned());
        row.resize_with(self.columns.len(), missing);
        self.rows.push(row);
    }

    /// The cell of a row in the column of this name.
    #[must_use]
    pub fn cell(&self, row: usize, column: &str) -> Option<&Cell> {
        let at = self.columns.iter().position(|c| c.name == column)?;
        self.rows.get(row)?.get(at)
    }
}

impl Column {
    fn new(name: &str, heading: &str) -> Self {
        Self {
            name: name.to_owned(),
            heading: heading.to_owned(),
        }
    }
}

/// A text as part of a file's name: lower case, what is neither letter nor digit replaced.
pub(super) fn file_name(text: &str, between: char) -> String {
    let mut name = String::new();
    for c in text.chars() {
        if c.is_ascii_alphanumeric() {
            name.push(c.to_ascii_lowercase());
        } else if !name.ends_with(between) && !name.is_empty() {
            name.push(between);
        }
    }
    name.trim_end_matches(between).to_owned()
}

impl Cell {
    /// A number, or why there is none.
    pub(super) fn of(computed: &Computed) -> Self {
        match computed {
            Ok(value) => Self::from(*value),
            Err(why) => Self::Undefined(why.reason.clone()),
        }
    }

    /// No number, for this reason.
    pub fn none(reason: &str) -> Self {
        Self::Undefined(reason.to_owned())
    }

    /// The number, if it is one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Text(_) | Self::Undefined(_) => None,
        }
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        if value.is_finite() {
            Self::Number(value)
        } else {
            Self::Undefined("not finite".to_owned())
        }
    }
}

impl From<usize> for Cell {
    fn from(value: usize) -> Self {
        Self::Number(value as f64)
    }
}

impl From<u64> for Cell {
    fn from(value: u64) -> Self {
        Self::Number(value as f64)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// The ends of an interval as two cells.
pub(super) fn ends(interval: &Computed<Interval>) -> [Cell; 2] {
    match interval {
        Ok(interval) => [interval.low.into(), interval.high.into()],
        Err(why) => [(); 2].map(|()| Cell::Undefined(why.reason.clone())),
    }
}

/// So many cells without a number, and why.
pub(super) fn undefined(why: &Undefined, n: usize) -> Vec<Cell> {
    (0..n)
        .map(|_| Cell::Undefined(why.reason.clone()))
        .collect()
}

/// Wilson's interval of a share, %.
pub(super) fn percent_interval(hits: u64, n: u64) -> Computed<Interval> {
    wilson(hits, n, 0.95).map(|mut interval| {
        interval.low *= 100.0;
        interval.high *= 100.0;
        interval
    })
}

/// Columns of [`tests`].
const TESTS: [(&str, &str); 17] = [
    ("what", "of what"),
    ("test", "test"),
    ("n", "n"),
    ("statistic", "statistic"),
    ("value", "value"),
    ("df", "df"),
    ("df_error", "df error"),
    ("p", "p"),
    ("sides", "sides"),
    ("effect", "effect size"),
    ("effect_value", "value"),
    ("estimate", "estimate"),
    ("estimate_value", "value"),
    ("ci_low", "CI from"),
    ("ci_high", "to"),
    ("ci_level", "level"),
    ("remarks", "remarks"),
];

/// A table of tests, one a row: what was tested, and what came of it.
pub(super) fn tests(key: &str, title: &str, all: &[(String, Computed<Outcome>)]) -> Table {
    let mut table = Table::new(key, title, &TESTS);
    for (what, outcome) in all {
        let mut row = vec![Cell::from(what.as_str())];
        match outcome {
            Ok(outcome) => row.extend(cells_of(outcome)),
            Err(why) => {
                let blank = || Cell::Undefined(why.reason.clone());
                row.extend((1..TESTS.len()).map(|_| blank()));
            }
        }
        table.push(row);
    }
    table
}

fn cells_of(outcome: &Outcome) -> Vec<Cell> {
    let n: Vec<String> = outcome.n.iter().map(ToString::to_string).collect();
    let [df, df_error] = match outcome.df {
        Freedom::None => [(); 2].map(|()| Cell::none("the test has none")),
        Freedom::One(df) => [df.into(), Cell::none("the test has one number alone")],
        Freedom::Two(df, error) => [df.into(), error.into()],
    };
    let sides = match outcome.sides {
        Sides::Two => "two",
        Sides::Greater => "greater",
        Sides::Less => "less",
    };
    let mut cells = vec![
        outcome.test.into(),
        n.join(" + ").into(),
        outcome.statistic.symbol.into(),
        outcome.statistic.value.into(),
        df,
        df_error,
        outcome.p.into(),
        sides.into(),
    ];
    cells.extend(named(&outcome.effect));
    cells.extend(named(&outcome.estimate));
    cells.extend(ends(&outcome.interval));
    cells.push(match &outcome.interval {
        Ok(interval) => interval.level.into(),
        Err(why) => Cell::Undefined(why.reason.clone()),
    });
    cells.push(outcome.notes.join("; ").into());
    cells
}

fn named(value: &Computed<Named>) -> [Cell; 2] {
    match value {
        Ok(named) => [named.symbol.into(), named.value.into()],
        Err(why) => [(); 2].map(|()| Cell::Undefined(why.reason.clone())),
    }
}

/// Columns of [`summary_cells`].
pub(super) const SUMMARY: [(&str, &str); 6] = [
    ("n", "n"),
    ("mean", "mean"),
    ("sd", "sd"),
    ("se", "SE"),
    ("ci_low", "95 % CI from"),
    ("ci_high", "to"),
];

/// n, mean, sd, SE and the interval of the mean by Student's t.
pub(super) fn summary_cells(values: &[f64]) -> Vec<Cell> {
    let mut cells = vec![Cell::from(values.len())];
    match Summary::of(values) {
        Ok(summary) => {
            cells.extend([summary.mean, summary.sd, summary.se].map(Cell::from));
            cells.extend(ends(&summary.interval(0.95)));
        }
        Err(why) => {
            cells.push(Cell::of(&mean(values)));
            cells.extend((0..4).map(|_| Cell::Undefined(why.reason.clone())));
        }
    }
    cells
}

/// A table of means, one quantity a row.
pub(super) fn summaries(key: &str, title: &str, all: &[(String, Vec<f64>)]) -> Table {
    let mut table = Table::new(key, title, &[("what", "of what")]);
    let column = |(name, heading): &(&str, &str)| Column::new(name, heading);
    table.columns.extend(SUMMARY.iter().map(column));
    for (what, values) in all {
        let mut row = vec![Cell::from(what.as_str())];
        row.extend(summary_cells(values));
        table.push(row);
    }
    table
}

/// Intervals of means by drawing subjects again, one quantity a row.
pub(super) fn resampled(all: &[(String, Vec<f64>)], how: Resampling) -> Table {
    let columns = [
        ("what", "of what"),
        ("n", "n"),
        ("mean", "mean"),
        ("se", "SE"),
        ("percentile_low", "95 % percentiles from"),
        ("percentile_high", "to"),
        ("bca_low", "bias-corrected and accelerated from"),
        ("bca_high", "to"),
        ("resamples", "resamples"),
    ];
    let title = "Means, their intervals by drawing subjects again";
    let mut table = Table::new("bootstrap", title, &columns);
    for (what, values) in all {
        let of = |drawn: &[usize]| mean(&drawn.iter().map(|i| values[*i]).collect::<Vec<f64>>());
        let mut row = vec![Cell::from(what.as_str()), values.len().into()];
        match bootstrap(values.len(), of, how) {
            Ok(found) => {
                row.extend([found.estimate, found.se].map(Cell::from));
                row.extend(ends(&Ok(found.percentile)));
                row.extend(ends(&found.bca));
                row.push(found.n_used.into());
            }
            Err(why) => row.extend((2..columns.len()).map(|_| Cell::none(&why.reason))),
        }
        table.push(row);
    }
    table
}

/// A square table with names down and across.
pub(super) fn matrix(key: &str, title: &str, names: &[String], cells: Vec<Cell>) -> Table {
    let mut table =
        Table::new(key, title, &[("item", "")]).with_columns(names.iter().map(String::as_str));
    let mut cells = cells.into_iter();
    for name in names {
        let mut row = vec![Cell::from(name.as_str())];
        row.extend(cells.by_ref().take(names.len()));
        table.push(row);
    }
    table
}
