//! Square and rectangular tables of numbers with names on both sides, in CSV.

use std::collections::BTreeSet;
use std::path::Path;

use csv::{ReaderBuilder, Trim};

use super::FileError;

/// Numbers by row and column, both named; a cell may be empty.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedMatrix {
    /// What the columns are called.
    pub columns: Vec<String>,
    /// What the rows are called.
    pub rows: Vec<String>,
    /// The cells, row by row; `None` where empty.
    pub values: Vec<Option<f64>>,
}

impl NamedMatrix {
    /// Reads a table whose header row and first column hold names; the first cell of all is
    /// ignored.
    ///
    /// Lines that start with `#` are comments; a byte-order mark is accepted.
    ///
    /// # Errors
    /// A row of another length, a name that is empty or comes twice, a cell that is no finite
    /// number.
    pub fn read(text: &str, path: &Path) -> Result<Self, FileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let mut matrix = Self {
            columns: Vec::new(),
            rows: Vec::new(),
            values: Vec::new(),
        };
        let mut is_header = true;
        for record in reader.records() {
            let record = record.map_err(|error| {
                let line = error.position().map_or(1, csv::Position::line);
                let line = usize::try_from(line).unwrap_or(1);
                let mend = "write comma-separated UTF-8 text";
                FileError::content(path, line, error.to_string(), mend)
            })?;
            let end = reader_line(&record);
            let mut cells = record.iter();
            let name = cells.next().unwrap_or_default();
            if is_header {
                matrix.columns = cells.map(ToOwned::to_owned).collect();
                let mut known = BTreeSet::new();
                for (index, name) in matrix.columns.iter().enumerate() {
                    check_name(name, index, !known.insert(name), (path, end))?;
                }
                is_header = false;
            } else {
                matrix.add(name, &cells.collect::<Vec<_>>(), (path, end))?;
            }
        }
        Ok(matrix)
    }

    fn add(
        &mut self,
        name: &str,
        cells: &[&str],
        (path, line): (&Path, usize),
    ) -> Result<(), FileError> {
        let (n, n_columns) = (cells.len(), self.columns.len());
        if n != n_columns {
            let what = format!("{name} has {n} cells where the header has {n_columns}");
            return Err(FileError::content(
                path,
                line,
                what,
                "give every row as many cells",
            ));
        }
        let is_known = self.rows.iter().any(|row| row == name);
        check_name(name, self.rows.len(), is_known, (path, line))?;
        self.rows.push(name.to_owned());
        for (cell, column) in cells.iter().zip(&self.columns) {
            let number = cell.parse::<f64>().ok().filter(|x| x.is_finite());
            if number.is_none() && !cell.is_empty() {
                let what = format!("{name}, {column} is \"{cell}\"");
                let mend =
                    "write a finite decimal number with a point, or nothing if it is missing";
                return Err(FileError::content(path, line, what, mend));
            }
            self.values.push(number);
        }
        Ok(())
    }
}

fn reader_line(record: &csv::StringRecord) -> usize {
    let line = record.position().map_or(1, csv::Position::line);
    usize::try_from(line).unwrap_or(1)
}

/// The last of the names must not stand before; in a header none may be empty.
/// Refuses a name of a row or column (from 0) that is empty or was there before.
fn check_name(
    name: &str,
    index: usize,
    is_known: bool,
    (path, line): (&Path, usize),
) -> Result<(), FileError> {
    if name.is_empty() {
        let what = format!("name {} is empty", index + 1);
        let mend = "name every row and column";
        return Err(FileError::content(path, line, what, mend));
    }
    if is_known {
        let what = format!("{name} stands twice");
        return Err(FileError::content(path, line, what, "give every name once"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<NamedMatrix, String> {
        NamedMatrix::read(text, Path::new("d.csv")).map_err(|e| e.to_string())
    }

    #[test]
    fn names_on_both_sides_and_empty_cells() {
        let found = read("\u{feff}# ranks\n,a,b\nr, 1 ,\ns,2.5,-3\n").unwrap();
        assert_eq!(found.columns, ["a", "b"]);
        assert_eq!(found.rows, ["r", "s"]);
        assert_eq!(found.values, [Some(1.0), None, Some(2.5), Some(-3.0)]);
        assert!(read("").unwrap().rows.is_empty());
    }

    #[test]
    fn wrong_cells_are_named() {
        for (text, said) in [
            (
                ",a,b\nr,1\n",
                "d.csv:2: r has 1 cells where the header has 2",
            ),
            (",a,b\nr,1,x\n", "r, b is \"x\""),
            (",a,b\nr,1,NaN\n", "finite"),
            (",a,a\n", "a stands twice"),
            (",a,b\nr,1,2\nr,1,2\n", "r stands twice"),
            (",a,\n", "name 2 is empty"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(said), "{error}");
        }
    }
}
