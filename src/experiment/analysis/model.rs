//! What an analysis found, as plain data: sections of notes, tables and figures.

use std::borrow::Borrow;

use serde::Serialize;

use selvedge_chart::Figure;
use selvedge_statistics::{Computed, Interval, Undefined};

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
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Column {
    /// Its name in files: letters, digits and `_`, its unit at the end; an item's own.
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

    /// Adds a table.
    pub(crate) fn table(&mut self, table: Table) {
        self.tables.push(table);
    }

    /// Adds a figure.
    pub(crate) fn figure(&mut self, figure: Drawn) {
        self.figures.push(figure);
    }

    /// Adds a note.
    pub fn note(&mut self, note: impl Into<String>) {
        self.notes.push(note.into());
    }
}

impl Table {
    /// An empty table. Columns stand between `; `, each by its name, and its heading where that is
    /// another: `n; ci_low: 95 % CI from`.
    pub fn new(key: &str, title: &str, columns: &str) -> Self {
        let column = |one: &str| {
            let (name, heading) = one.split_once(": ").unwrap_or((one, one));
            Column::new(name, heading)
        };
        Self {
            key: key.to_owned(),
            title: title.to_owned(),
            columns: columns.split("; ").map(column).collect(),
            rows: Vec::new(),
        }
    }

    /// Further columns, for items that only the data know, as these are called.
    pub(super) fn with_columns<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Self {
        let columns = names.into_iter().map(|name| Column::new(name, name));
        self.columns.extend(columns);
        self
    }

    /// Adds a row; cells that are missing are undefined, and no probability is smaller than it can
    /// be told.
    pub fn push(&mut self, row: impl IntoIterator<Item = Cell>) {
        let mut row: Vec<Cell> = row.into_iter().collect();
        let missing = || Cell::Undefined("no value".to_owned());
        row.resize_with(self.columns.len(), missing);
        for (cell, column) in row.iter_mut().zip(&self.columns) {
            if column.is_probability() && cell.number().is_some_and(|p| p < 1e-12) {
                *cell = Cell::none(LEAST_PROBABILITY);
            }
        }
        self.rows.push(row);
    }

    /// Puts a further column behind the one of this name; it has a cell for every row.
    pub(super) fn column_after(
        &mut self,
        name: &str,
        (own, heading): (&str, &str),
        cells: impl Iterator<Item = Cell>,
    ) {
        let before = self.columns.iter().position(|column| column.name == name);
        let at = before.map_or(self.columns.len(), |at| at + 1);
        self.columns.insert(at, Column::new(own, heading));
        for (row, cell) in self.rows.iter_mut().zip(cells) {
            row.insert(at, cell);
        }
    }

    /// The cell of a row in the column of this name.
    #[must_use]
    pub fn cell(&self, row: usize, column: &str) -> Option<&Cell> {
        let at = self.columns.iter().position(|c| c.name == column)?;
        self.rows.get(row)?.get(at)
    }
}

/// What stands for a probability that is smaller than anybody can tell.
pub(super) const LEAST_PROBABILITY: &str = "< 1e-12";

impl Column {
    /// Whether its numbers are p values.
    pub(super) fn is_probability(&self) -> bool {
        self.name == "p" || self.name.starts_with("p_") || self.name.ends_with("_p")
    }

    pub(super) fn new(name: &str, heading: &str) -> Self {
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

/// What fills one cell of a row, or several.
pub(crate) trait Cells {
    /// Adds the cells.
    fn add_to(self, row: &mut Vec<Cell>);
}

/// A row of cells, from what fills one or several of them.
macro_rules! cells {
    ($($filling:expr),* $(,)?) => {{
        let mut row: Vec<$crate::analysis::Cell> = Vec::new();
        $($crate::analysis::Cells::add_to($filling, &mut row);)*
        row
    }};
}
pub(crate) use cells;

macro_rules! one_cell {
    ($($kind:ty),+) => {$(
        impl Cells for $kind {
            fn add_to(self, row: &mut Vec<Cell>) {
                row.push(self.into());
            }
        }
    )+};
}
one_cell!(
    Cell, f64, usize, u64, u32, bool, &str, String, &String, &Computed
);

impl<T: Cells, const N: usize> Cells for [T; N] {
    fn add_to(self, row: &mut Vec<Cell>) {
        for one in self {
            one.add_to(row);
        }
    }
}

impl Cells for Vec<Cell> {
    fn add_to(self, row: &mut Vec<Cell>) {
        row.extend(self);
    }
}

impl<E: Borrow<Undefined>> Cells for Result<f64, E> {
    fn add_to(self, row: &mut Vec<Cell>) {
        row.push(match self {
            Ok(value) => value.into(),
            Err(why) => Cell::none(&why.borrow().reason),
        });
    }
}

impl Cells for &Computed<Interval> {
    fn add_to(self, row: &mut Vec<Cell>) {
        row.extend(ends(self));
    }
}

impl Cells for Computed<Interval> {
    fn add_to(self, row: &mut Vec<Cell>) {
        row.extend(ends(&self));
    }
}

/// Cells, or as many without a number and why.
pub(crate) fn or_undefined<E: Borrow<Undefined>>(
    found: Result<Vec<Cell>, E>,
    n: usize,
) -> Vec<Cell> {
    found.unwrap_or_else(|why| vec![Cell::none(&why.borrow().reason); n])
}

/// A share, %; none of none.
pub(crate) fn percent_of(hits: u64, n: u64, why_none: &str) -> Cell {
    if n > 0 {
        (100.0 * hits as f64 / n as f64).into()
    } else {
        Cell::none(why_none)
    }
}

/// A value that is known, or why it is not.
pub(crate) fn known(value: Option<f64>, why_none: &str) -> Cell {
    value.map_or_else(|| Cell::none(why_none), Cell::from)
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        if value.is_finite() {
            // Never −0.
            Self::Number(value + 0.0)
        } else {
            Self::Undefined("not finite".to_owned())
        }
    }
}

macro_rules! whole_number {
    ($($kind:ty),+) => {$(
        impl From<$kind> for Cell {
            fn from(value: $kind) -> Self {
                Self::Number(value as f64)
            }
        }
    )+};
}
whole_number!(usize, u64);

impl From<u32> for Cell {
    fn from(value: u32) -> Self {
        Self::Number(value.into())
    }
}

impl From<bool> for Cell {
    fn from(is_so: bool) -> Self {
        if is_so { "yes" } else { "no" }.into()
    }
}

impl From<&Computed> for Cell {
    fn from(computed: &Computed) -> Self {
        match computed {
            Ok(value) => Self::from(*value),
            Err(why) => Self::none(&why.reason),
        }
    }
}

impl From<&String> for Cell {
    fn from(text: &String) -> Self {
        Self::Text(text.clone())
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
        Err(why) => [(); 2].map(|()| Cell::none(&why.reason)),
    }
}

/// Wilson's interval of a share, %.
pub(super) fn percent_interval(hits: u64, n: u64) -> Computed<Interval> {
    Interval::wilson(hits, n, 0.95).map(|interval| interval.map(|share| share * 100.0))
}
