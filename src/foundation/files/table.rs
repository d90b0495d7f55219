//! CSV tables: named columns in, rows out.
//!
//! Headers must be known to the caller: an unknown or a missing column is an error that names it.
//! Errors carry the line of the cell.

use std::io::Write;
use std::path::{Path, PathBuf};

use csv::{ReaderBuilder, StringRecord, Trim};

use super::{FileError, push_number};

/// A CSV table held as text cells, with the line of every row.
#[derive(Debug, Clone)]
pub struct Table {
    path: PathBuf,
    header: Vec<String>,
    rows: Vec<StringRecord>,
    lines: Vec<usize>,
}

impl Table {
    /// Reads a table whose header holds `required` columns, perhaps some of `optional`, no others.
    ///
    /// Lines that start with `#` are comments; a byte-order mark is accepted.
    pub fn read(
        text: &str,
        path: &Path,
        required: &[&str],
        optional: &[&str],
    ) -> Result<Self, FileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reader = ReaderBuilder::new()
            .trim(Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let wrong = |error: &csv::Error| {
            let line = error.position().map_or(1, csv::Position::line);
            let line = usize::try_from(line).unwrap_or(1);
            let columns = required.join(",");
            FileError::content(path, line, reason(error), format!("give rows of {columns}"))
        };
        let header: Vec<String> = reader
            .headers()
            .map_err(|e| wrong(&e))?
            .iter()
            .map(ToOwned::to_owned)
            .collect();
        check_header(&header, path, required, optional)?;
        let rows: Result<Vec<_>, _> = reader.records().collect();
        let rows: Vec<StringRecord> = rows.map_err(|e| wrong(&e))?;
        let lines = rows.iter().map(|row| line_of(row, text)).collect();
        Ok(Self {
            path: path.to_owned(),
            header,
            rows,
            lines,
        })
    }

    /// Number of rows below the header.
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// The line in the file of a row, from 1.
    pub fn line_of(&self, row: usize) -> usize {
        self.lines.get(row).copied().unwrap_or(1)
    }

    /// The cells of a column, if the table has it.
    pub fn text(&self, column: &str) -> Option<Vec<&str>> {
        let index = self.header.iter().position(|name| name == column)?;
        Some(
            self.rows
                .iter()
                .map(|row| row.get(index).unwrap_or_default())
                .collect(),
        )
    }

    /// The numbers of a column, every one finite; `None` if the table has no such column.
    pub fn numbers(&self, column: &str) -> Result<Option<Vec<f64>>, FileError> {
        let Some(cells) = self.text(column) else {
            return Ok(None);
        };
        let parse = |(row, cell): (usize, &str)| match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let (row, line) = (row + 1, self.line_of(row));
                let what = format!("{column} is \"{cell}\" (row {row} of {})", self.rows.len());
                let mend = "write a finite decimal number with a point";
                Err(FileError::content(&self.path, line, what, mend))
            }
        };
        cells
            .into_iter()
            .enumerate()
            .map(parse)
            .collect::<Result<_, _>>()
            .map(Some)
    }

    /// The numbers of a column that the header was checked to hold.
    pub fn required_numbers(&self, column: &str) -> Result<Vec<f64>, FileError> {
        let what = || format!("no column {column}");
        let missing = || FileError::content(&self.path, 1, what(), "add the column");
        self.numbers(column)?.ok_or_else(missing)
    }
}

/// The reader's position of a row is where it began to look for it: comments and blank lines that
/// it passed over are counted here.
fn line_of(row: &StringRecord, text: &str) -> usize {
    let Some(position) = row.position() else {
        return 1;
    };
    let start = usize::try_from(position.byte())
        .unwrap_or(0)
        .min(text.len());
    let is_passed_over = |line: &&str| line.trim().is_empty() || line.starts_with('#');
    let n_passed_over = text[start..].lines().take_while(is_passed_over).count();
    usize::try_from(position.line()).unwrap_or(1) + n_passed_over
}

fn reason(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => {
            format!("{len} cells where the header has {expected_len}")
        }
        csv::ErrorKind::Utf8 { .. } => "this is not UTF-8 text".to_owned(),
        _ => error.to_string(),
    }
}

/// No more columns are told of a header.
const MOST_TOLD: usize = 24;

fn check_header(
    header: &[String],
    path: &Path,
    required: &[&str],
    optional: &[&str],
) -> Result<(), FileError> {
    let expected = || {
        let optional = optional.iter().map(|name| format!("[{name}]"));
        let required = required.iter().map(|&name| name.to_owned());
        let all: Vec<String> = required.chain(optional).collect();
        match all.get(..MOST_TOLD) {
            Some(first) if all.len() > MOST_TOLD => {
                format!("{},… ({} columns)", first.join(","), all.len())
            }
            _ => all.join(","),
        }
    };
    let wrong =
        |what: String| FileError::content(path, 1, what, format!("the header is {}", expected()));
    for (index, name) in header.iter().enumerate() {
        if !required.contains(&name.as_str()) && !optional.contains(&name.as_str()) {
            return Err(wrong(format!("unknown column \"{name}\"")));
        }
        if header[..index].contains(name) {
            return Err(wrong(format!("column {name} twice")));
        }
    }
    let is_missing = |name: &&&str| !header.iter().any(|known| known == **name);
    let missing = required.iter().find(is_missing);
    missing.map_or(Ok(()), |name| Err(wrong(format!("no column {name}"))))
}

/// Writes rows of cells as CSV, numbers with their shortest round-trip digits.
#[derive(Debug)]
pub struct TableWriter<W: Write> {
    out: W,
    path: PathBuf,
    line: String,
    n_cells: usize,
}

impl<W: Write> TableWriter<W> {
    /// A table with this header. `path` only names it in errors.
    pub fn new(out: W, path: &Path, header: &[&str]) -> Result<Self, FileError> {
        let mut writer = Self::continued(out, path);
        for name in header {
            writer.text(name);
        }
        writer.end_row()?;
        Ok(writer)
    }

    /// Rows of a table that has its header.
    pub fn continued(out: W, path: &Path) -> Self {
        Self {
            out,
            path: path.to_owned(),
            line: String::new(),
            n_cells: 0,
        }
    }

    /// Adds a cell with a number.
    pub fn number(&mut self, value: impl std::fmt::Display) -> &mut Self {
        self.separate();
        push_number(&mut self.line, value);
        self
    }

    /// Adds a number, or an empty cell where there is none.
    pub fn optional(&mut self, value: Option<impl std::fmt::Display>) -> &mut Self {
        match value {
            Some(value) => self.number(value),
            None => self.text(""),
        }
    }

    /// Adds a cell with text, quoted if it must be.
    pub fn text(&mut self, text: &str) -> &mut Self {
        self.separate();
        if text.contains([',', '"', '\n', '\r']) {
            self.line.push('"');
            self.line.push_str(&text.replace('"', "\"\""));
            self.line.push('"');
        } else {
            self.line.push_str(text);
        }
        self
    }

    /// Ends the row.
    pub fn end_row(&mut self) -> Result<(), FileError> {
        self.line.push('\n');
        let written = self.out.write_all(self.line.as_bytes());
        self.line.clear();
        self.n_cells = 0;
        written.map_err(FileError::write(&self.path))
    }

    /// Writes what is still buffered and returns the stream.
    pub fn finish(mut self) -> Result<W, FileError> {
        self.out.flush().map_err(FileError::write(&self.path))?;
        Ok(self.out)
    }

    fn separate(&mut self) {
        if self.n_cells > 0 {
            self.line.push(',');
        }
        self.n_cells += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATH: &str = "a.csv";

    fn read(text: &str) -> Result<Table, FileError> {
        Table::read(text, Path::new(PATH), &["x_mm", "height_um"], &["note"])
    }

    #[test]
    fn numbers_come_back_by_column() {
        let table = read("\u{feff}height_um,x_mm\n1.5, 0\n# aside\n2.5,0.1\n").unwrap();
        assert_eq!(table.required_numbers("height_um").unwrap(), [1.5, 2.5]);
        assert_eq!(table.numbers("note").unwrap(), None);
        assert_eq!(table.line_of(1), 4);
    }

    #[test]
    fn wrong_tables_name_the_line_and_the_mend() {
        for (text, expected) in [
            ("", "a.csv:1: no column x_mm"),
            ("x_mm,height\n", "a.csv:1: unknown column \"height\""),
            ("x_mm,height_um,x_mm\n", "a.csv:1: column x_mm twice"),
            (
                "x_mm,height_um\n1\n",
                "a.csv:2: 1 cells where the header has 2",
            ),
            (
                "x_mm,height_um\n1,2\n1,NaN\n",
                "a.csv:3: height_um is \"NaN\" (row 2 of 2)",
            ),
            (
                "x_mm,height_um\n1,\"2,5\"\n",
                "a.csv:2: height_um is \"2,5\"",
            ),
        ] {
            let failed = read(text).and_then(|table| table.required_numbers("height_um"));
            let error = failed.unwrap_err().to_string();
            assert!(
                error.starts_with(expected) && error.contains("; "),
                "{error}"
            );
        }
    }

    #[test]
    fn written_rows_read_back() {
        let mut writer = TableWriter::new(Vec::new(), Path::new(PATH), &["id", "x_mm"]).unwrap();
        writer.text("").number(0.1).end_row().unwrap();
        writer.text("silk, \"raw\"").number(-2).end_row().unwrap();
        let bytes = writer.finish().unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text, "id,x_mm\n,0.1\n\"silk, \"\"raw\"\"\",-2\n");
        let table = Table::read(&text, Path::new(PATH), &["id", "x_mm"], &[]).unwrap();
        assert_eq!(table.text("id").unwrap(), ["", "silk, \"raw\""]);
    }
}
