//! How a text of numbers is laid out: where its data begin, what parts cells, what the lines above
//! say.

use std::path::Path;

use super::reading::{About, Stated};
use super::{LengthUnit, n_points};
use selvedge_foundation::files::{FileError, latin1};

/// Lines of numbers in a row that make data: shorter runs stand in headers.
const RUN: usize = 3;

/// The lines of a text and how they are read.
pub(super) struct Layout<'a> {
    /// Lines above the data.
    pub(super) header: Vec<&'a str>,
    /// What parts cells.
    parting: Parting,
    /// Lines of data with their numbers in the file, from 1.
    lines: Vec<(usize, &'a str)>,
}

/// What parts the cells of a line, and whether a comma is a decimal point.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Parting {
    /// `None`: blanks.
    by: Option<char>,
    has_decimal_comma: bool,
}

const PARTINGS: [Parting; 6] = [
    Parting {
        by: Some('\t'),
        has_decimal_comma: false,
    },
    Parting {
        by: Some(';'),
        has_decimal_comma: false,
    },
    Parting {
        by: Some(','),
        has_decimal_comma: false,
    },
    Parting {
        by: Some('\t'),
        has_decimal_comma: true,
    },
    Parting {
        by: Some(';'),
        has_decimal_comma: true,
    },
    Parting {
        by: None,
        has_decimal_comma: false,
    },
];

impl Parting {
    fn cells(self, line: &str) -> Vec<&str> {
        match self.by {
            Some(by) => line.split(by).map(str::trim).collect(),
            None => line.split_whitespace().collect(),
        }
    }

    /// The number of a cell; NaN where it says that there is none.
    fn number(self, cell: &str) -> Option<f64> {
        let is_missing = cell.is_empty()
            || ["nan", "bad", "---", "null"]
                .iter()
                .any(|word| cell.eq_ignore_ascii_case(word));
        if is_missing {
            return Some(f64::NAN);
        }
        if self.has_decimal_comma {
            return cell.replace(',', ".").parse().ok();
        }
        cell.parse().ok()
    }

    /// The numbers of a line; `None` if one of its cells is none, or all of them are missing.
    fn numbers(self, line: &str) -> Option<Vec<f64>> {
        let cells = self.cells(line);
        let numbers: Option<Vec<f64>> = cells.into_iter().map(|cell| self.number(cell)).collect();
        numbers.filter(|numbers| numbers.iter().any(|number| !number.is_nan()))
    }
}

/// Bytes as text: UTF-8, or Latin-1 where they are not.
pub(super) fn decoded(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    String::from_utf8(bytes.to_vec()).unwrap_or_else(|_| latin1(bytes))
}

impl<'a> Layout<'a> {
    /// The layout of a text: of all ways to part its cells the one in which most cells of the last
    /// lines are numbers.
    pub(super) fn of(text: &'a str, path: &Path) -> Result<Self, FileError> {
        let is_filled = |(_, line): &(usize, &str)| !line.trim().is_empty();
        let numbered = (1..).zip(text.lines());
        let lines: Vec<(usize, &str)> = numbered.filter(is_filled).collect();
        let last = &lines[lines.len().saturating_sub(RUN)..];
        let n_cells = |parting: &Parting| -> usize {
            let numbers = last.iter().filter_map(|(_, line)| parting.numbers(line));
            numbers.map(|numbers| numbers.len()).sum()
        };
        let best = PARTINGS.iter().rev().max_by_key(|parting| n_cells(parting));
        let no_numbers = || {
            let mend = "give lines of numbers, parted by tab, semicolon, comma or blanks";
            let line = lines.last().map_or(1, |(line, _)| *line);
            FileError::content(path, line, "no numbers at the end of the text", mend)
        };
        let parting = *best
            .filter(|best| n_cells(best) > 0)
            .ok_or_else(no_numbers)?;
        let is_data = |i: usize| {
            let run = &lines[i..lines.len().min(i + RUN)];
            let widths = run
                .iter()
                .map(|(_, line)| parting.numbers(line).map(|numbers| numbers.len()));
            let widths: Vec<Option<usize>> = widths.collect();
            widths[0].is_some() && widths.iter().all(|width| *width == widths[0])
        };
        let first = (0..lines.len())
            .find(|&i| is_data(i))
            .ok_or_else(no_numbers)?;
        Ok(Self {
            header: lines[..first].iter().map(|(_, line)| *line).collect(),
            parting,
            lines: lines[first..].to_vec(),
        })
    }

    /// Columns of the data; cells that are empty in every line do not count.
    pub(super) fn columns(&self, path: &Path) -> Result<Columns, FileError> {
        let n_cells = |line: &str| self.parting.cells(line).len();
        let n_columns = self.lines.first().map_or(0, |(_, line)| n_cells(line));
        n_points(n_columns, self.lines.len(), path)?;
        let mut columns = vec![Vec::with_capacity(self.lines.len()); n_columns];
        for (number, line) in &self.lines {
            let numbers = self.parting.numbers(line);
            let numbers = numbers.filter(|numbers| numbers.len() == n_columns);
            let numbers = numbers.ok_or_else(|| {
                let what = format!("not {n_columns} numbers as in the lines before");
                FileError::content(path, *number, what, "correct or remove the line")
            })?;
            for (column, number) in columns.iter_mut().zip(numbers) {
                column.push(number);
            }
        }
        // Separators at the end of lines make columns that hold nothing and have no heading.
        let last = columns
            .iter()
            .rposition(|column| column.iter().any(|number| !number.is_nan()));
        let n_headed = self.header.last().map_or(0, |line| {
            let cells = self.parting.cells(line);
            cells
                .iter()
                .rposition(|cell| !cell.is_empty())
                .map_or(0, |at| at + 1)
        });
        columns.truncate(n_headed.max(last.map_or(0, |last| last + 1)));
        Ok(Columns {
            headings: self.headings(columns.len()),
            numbers: columns,
            decimals: self.decimals(),
            first_line: self.lines.first().map_or(1, |(number, _)| *number),
        })
    }

    /// The headings of columns: the cells of the lines above the data that part alike.
    fn headings(&self, n_columns: usize) -> Vec<String> {
        let mut headings = vec![String::new(); n_columns];
        for line in self.header.iter().rev().take(2).rev() {
            let mut cells = self.parting.cells(line);
            while cells.len() > n_columns && cells.last().is_some_and(|cell| cell.is_empty()) {
                cells.pop();
            }
            if cells.len() != n_columns || n_columns < 2 {
                continue;
            }
            for (heading, cell) in headings.iter_mut().zip(cells) {
                if !heading.is_empty() {
                    heading.push(' ');
                }
                heading.push_str(cell.trim_matches(['"', '#', ' ']));
            }
        }
        headings
    }

    /// Most digits behind the point of the first column, in the first lines.
    fn decimals(&self) -> i32 {
        let decimals = |(_, line): &(usize, &str)| {
            let cells = self.parting.cells(line);
            let cell = (*cells.first()?).replace(',', ".");
            let plain = !cell.contains(['e', 'E']);
            plain.then(|| cell.split_once('.').map_or(0, |(_, digits)| digits.len()))
        };
        let all = self.lines.iter().take(1000).map(decimals);
        let max = all.collect::<Option<Vec<usize>>>();
        let max = max.and_then(|all| all.into_iter().max());
        max.and_then(|max| i32::try_from(max).ok()).unwrap_or(15)
    }
}

/// The columns of a table.
pub(super) struct Columns {
    pub(super) headings: Vec<String>,
    pub(super) numbers: Vec<Vec<f64>>,
    /// Digits behind the point of the first column.
    pub(super) decimals: i32,
    /// The line of the first row.
    pub(super) first_line: usize,
}

/// What the comment lines of a text matrix say, as Gwyddion writes them.
#[derive(Debug, Default)]
pub(super) struct MatrixKeys {
    /// Extents with their units.
    pub(super) extents: [Option<(f64, LengthUnit)>; 2],
    pub(super) height_unit: Stated,
    pub(super) about: About,
}

impl MatrixKeys {
    /// The keys among the lines above the data.
    pub(super) fn of(header: &[&str]) -> Self {
        let mut keys = Self::default();
        for line in header {
            let line = line.trim_start_matches(['#', ' ']);
            let Some((key, value)) = line.split_once(':') else {
                continue;
            };
            let value = value.trim();
            match key.trim() {
                "Width" => keys.extents[0] = extent(value),
                "Height" => keys.extents[1] = extent(value),
                "Value units" => keys.height_unit = Stated::of(value),
                "Channel" => value.clone_into(&mut keys.about.title),
                _ => {}
            }
        }
        keys
    }
}

/// A length such as `10.00 µm`.
fn extent(text: &str) -> Option<(f64, LengthUnit)> {
    let (number, unit) = text.split_once(char::is_whitespace)?;
    let number: f64 = number.parse().ok()?;
    Some((number, LengthUnit::of(unit)?)).filter(|(number, _)| *number > 0.0)
}
