//! Square tables of numbers as R, Python and this program write them: with or without names, whole
//! or a triangle, with columns of remarks behind.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};

use super::FileError;

/// More objects than these are no table of pairs.
const MOST_OBJECTS: usize = 1000;

/// A square table of numbers, with the same names down and across.
#[derive(Debug, Clone, PartialEq)]
pub struct SquareTable {
    /// What rows and columns are called; their numbers from 1 where the file has no names.
    pub names: Vec<String>,
    /// The cells, row by row; `None` where one is empty, `NA` or beyond a triangle.
    pub values: Vec<Option<f64>>,
}

/// A line of cells.
struct Line {
    number: usize,
    cells: Vec<String>,
}

/// Names and cells before they are put in their places.
struct Parts {
    columns: Option<Vec<String>>,
    rows: Option<Vec<String>>,
    lines: Vec<Line>,
}

impl SquareTable {
    /// Reads a table. Cells stand between commas, semicolons, tabs or blanks; lines that start with
    /// `#` are comments; a byte-order mark is accepted. A triangle may leave out the diagonal.
    /// Columns behind the last object are left out if they hold no number.
    ///
    /// # Errors
    /// More than 1000 objects, a row of another length, a name that is empty or comes twice, names
    /// that differ down and across, a cell that is no finite number.
    pub fn read(text: &str, path: &Path) -> Result<Self, FileError> {
        let lines = lines(text, path)?;
        let parts = Parts::of(lines);
        let (names, below) = parts.names(path)?;
        let n = names.len();
        let mut values = vec![None; n * n];
        for (at, line) in parts.lines.iter().enumerate() {
            let row = at + usize::from(below);
            for (column, cell) in line.cells.iter().enumerate() {
                let value = number(cell).map_err(|()| {
                    let name = |at: usize| names.get(at).map_or("?", String::as_str);
                    let what = format!("{}, {} is \"{cell}\"", name(row), name(column));
                    let mend =
                        "write a finite decimal number with a point, or nothing if it is missing";
                    FileError::content(path, line.number, what, mend)
                })?;
                if column < n && row < n {
                    values[row * n + column] = value;
                }
            }
        }
        Ok(Self { names, values })
    }
}

/// The lines with anything in them.
fn lines(text: &str, path: &Path) -> Result<Vec<Line>, FileError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let is_told = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
    // The first line of a triangle may hold one cell.
    let mut first = text.lines().filter(is_told).take(2);
    let begun = [first.next(), first.next()].map(Option::unwrap_or_default);
    let is_between = |c: &char| begun.iter().any(|line| line.contains(*c));
    let between = [',', ';', '\t'].into_iter().find(is_between);
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .comment(Some(b'#'))
        .delimiter(between.map_or(b' ', |c| u8::try_from(c).unwrap_or(b',')))
        .from_reader(text.as_bytes());
    let mut lines = Vec::new();
    let mut record = StringRecord::new();
    while reader.read_record(&mut record).map_err(|error| {
        let line = error.position().map_or(1, csv::Position::line);
        let line = usize::try_from(line).unwrap_or(1);
        let mend = "write comma-separated UTF-8 text";
        FileError::content(path, line, error.to_string(), mend)
    })? {
        let number = record.position().map_or(1, csv::Position::line);
        let number = usize::try_from(number).unwrap_or(1);
        // Blanks in a row are one.
        let is_cell = |cell: &&str| between.is_some() || !cell.is_empty();
        let cells: Vec<String> = record.iter().filter(is_cell).map(str::to_owned).collect();
        if lines.len() > MOST_OBJECTS || cells.len() > MOST_OBJECTS + 2 {
            let what = format!("more than {MOST_OBJECTS} rows or columns");
            return Err(FileError::content(path, number, what, "give fewer objects"));
        }
        lines.push(Line { number, cells });
    }
    Ok(lines)
}

/// A number, or none where nothing is told.
fn number(cell: &str) -> Result<Option<f64>, ()> {
    if cell.is_empty() || cell == "NA" {
        return Ok(None);
    }
    cell.parse()
        .ok()
        .filter(|x: &f64| x.is_finite())
        .map(Some)
        .ok_or(())
}

fn is_text(cell: &str) -> bool {
    number(cell).is_err()
}

impl Parts {
    /// Takes names from the first line and the first column, where they stand there.
    fn of(mut lines: Vec<Line>) -> Self {
        let is_header = lines.first().is_some_and(|first| is_header(first, &lines));
        let header = is_header.then(|| lines.remove(0).cells);
        let is_corner_empty = header.as_ref().is_some_and(|cells| cells[0].is_empty());
        let begins_with_text = |line: &Line| line.cells.first().is_some_and(|cell| is_text(cell));
        let has_row_names = is_corner_empty || lines.iter().any(begins_with_text);
        let longest = lines.iter().map(|line| line.cells.len()).max().unwrap_or(0);
        let rows = has_row_names.then(|| {
            let name = |line: &mut Line| line.cells.drain(..1.min(line.cells.len())).collect();
            lines.iter_mut().map(name).collect()
        });
        let columns = header.map(|mut cells| {
            // R leaves out the corner; a triangle leaves out cells.
            let has_corner = has_row_names && (is_corner_empty || cells.len() >= longest);
            cells.drain(..usize::from(has_corner));
            cells
        });
        let mut parts = Self {
            columns,
            rows,
            lines,
        };
        parts.drop_remarks();
        parts
    }

    /// Leaves out the last columns while they hold no number and are named after no row.
    fn drop_remarks(&mut self) {
        let Some(rows) = &self.rows else { return };
        let Some(columns) = &mut self.columns else {
            return;
        };
        while columns.len() > rows.len() {
            let last = columns.len() - 1;
            let is_number = |line: &Line| {
                let cell = line.cells.get(last);
                cell.is_some_and(|cell| matches!(number(cell), Ok(Some(_))))
            };
            if rows.contains(&columns[last]) || self.lines.iter().any(is_number) {
                return;
            }
            columns.pop();
            for line in &mut self.lines {
                line.cells.truncate(last);
            }
        }
    }

    /// What the objects are called, and whether the first row is that of the second object.
    fn names(&self, path: &Path) -> Result<(Vec<String>, bool), FileError> {
        let wrong =
            |line: usize, what: String, mend: &str| Err(FileError::content(path, line, what, mend));
        let n_rows = self.lines.len();
        let (names, below) = match (&self.columns, &self.rows) {
            (Some(columns), Some(rows)) if columns == rows => (rows.clone(), false),
            (Some(columns), Some(rows)) if is_shifted(columns, rows) => {
                (columns[..1].iter().chain(rows).cloned().collect(), true)
            }
            (Some(columns), Some(rows)) if rows.len() == columns.len() => {
                let differing = rows.iter().zip(columns).find(|(r, c)| r != c);
                let (row, column) = differing.unwrap_or((&rows[0], &columns[0]));
                let what = format!("a row is called {row} where the column is called {column}");
                let mend = "give rows and columns the same names in the same order";
                return wrong(1, what, mend);
            }
            (Some(columns), None) => (columns.clone(), n_rows + 1 == columns.len()),
            (None, Some(rows)) => (rows.clone(), false),
            (None, None) => self.numbered(),
            (Some(columns), Some(rows)) => {
                let what = format!(
                    "{} rows and {} columns; a table of dissimilarities is square",
                    rows.len(),
                    columns.len()
                );
                return wrong(1, what, "give the same names down and across");
            }
        };
        let n = names.len();
        for (at, name) in names.iter().enumerate() {
            if name.is_empty() {
                return wrong(
                    1,
                    format!("name {} is empty", at + 1),
                    "name every row and column",
                );
            }
            if names[..at].contains(name) {
                return wrong(1, format!("{name} stands twice"), "give every name once");
            }
        }
        if n_rows + usize::from(below) != n {
            let what = format!("{n_rows} rows of {n} objects");
            return wrong(1, what, "give a square, or a triangle of it");
        }
        let is_triangle = self.is_triangle(below);
        let other = self
            .lines
            .iter()
            .find(|line| !is_triangle && line.cells.len() != n);
        if let Some(line) = other {
            let at = line.number;
            let n_cells = line.cells.len();
            let what = format!("{n_cells} cells where there are {n} objects");
            return wrong(at, what, "give every row as many cells");
        }
        Ok((names, below))
    }

    /// Whether no row goes beyond the diagonal.
    fn is_triangle(&self, below: bool) -> bool {
        let mut lines = self.lines.iter().enumerate();
        let is_below = |(at, line): (usize, &Line)| {
            let told = line.cells.iter().rposition(|cell| !cell.is_empty());
            told.is_none_or(|last| last <= at + usize::from(below))
        };
        lines.all(is_below)
    }

    /// Numbers from 1: of a triangle without its diagonal one more than there are rows.
    fn numbered(&self) -> (Vec<String>, bool) {
        let mut lasts = self
            .lines
            .iter()
            .enumerate()
            .map(|(at, line)| line.cells.get(at));
        let is_diagonal = |cell: Option<&String>| {
            cell.is_none_or(|cell| number(cell).is_ok_and(|x| x.is_none_or(|x| x.abs() <= 0.0)))
        };
        let below = self.is_triangle(false) && !lasts.all(is_diagonal);
        let n = self.lines.len() + usize::from(below);
        ((1..=n).map(|at| at.to_string()).collect(), below)
    }
}

/// Whether columns are the objects but the last, and rows those but the first.
fn is_shifted(columns: &[String], rows: &[String]) -> bool {
    let [first, rest @ ..] = columns else {
        return false;
    };
    let is_square = rest.len() + 1 == rows.len() && rest == &rows[..rest.len()];
    is_square && !rows.contains(first)
}

/// Whether the first line holds names: texts behind its first cell, or, where names are numbers,
/// an empty corner of a table whose diagonal is not empty.
fn is_header(first: &Line, lines: &[Line]) -> bool {
    if first.cells.iter().skip(1).any(|cell| is_text(cell)) {
        return true;
    }
    let column = || {
        lines
            .iter()
            .map(|line| line.cells.first().map_or("", String::as_str))
    };
    let is_same = column().eq(first.cells.iter().map(String::as_str));
    let has_diagonal = lines
        .get(1)
        .is_some_and(|second| second.cells.get(1).is_some_and(|cell| !cell.is_empty()));
    first.cells.first().is_some_and(String::is_empty) && is_same && has_diagonal
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<SquareTable, String> {
        SquareTable::read(text, Path::new("d.csv")).map_err(|e| e.to_string())
    }

    /// The pairs that are told, larger number first.
    fn pairs(table: &SquareTable) -> Vec<f64> {
        let n = table.names.len();
        let both = |i: usize, j: usize| table.values[i * n + j].or(table.values[j * n + i]);
        (0..n)
            .flat_map(|i| (0..i).filter_map(move |j| both(i, j)))
            .collect()
    }

    #[test]
    fn what_r_python_and_this_program_write_is_read() {
        let named = ["Aa", "b", "c"];
        for (kind, text, names) in [
            (
                "both names",
                "\u{feff}# d\n,Aa,b,c\nAa,,1,2\nb,1,,3\nc,2,3,\n",
                named,
            ),
            (
                "R, write.csv",
                "\"\",\"Aa\",\"b\",\"c\"\n\"Aa\",0,1,2\n\"b\",1,0,3\n\"c\",2,3,0\n",
                named,
            ),
            (
                "R, write.table",
                "\"Aa\" \"b\" \"c\"\n\"Aa\" 0 1 2\n\"b\" 1 0 3\n\"c\" 2 3 0\n",
                named,
            ),
            ("R, a printed dist", "  Aa b\nb 1   \nc 2  3\n", named),
            ("columns alone", "Aa;b;c\n0;1;2\n1;0;3\n2;3;0\n", named),
            (
                "rows alone",
                "Aa\t0\t1\t2\nb\t1\t0\t3\nc\t2\t3\tNA\n",
                named,
            ),
            ("rows of a triangle", "Aa\nb,1\nc,2,3\n", named),
            (
                "this program",
                "item,Aa,b,c,not_computable\nAa,,1,2,Aa: itself\nb,1,,3,\nc,2,3,,x\n",
                named,
            ),
            (
                "numpy",
                "0.0 1.0 2.0\n1.0 0.0 3.0\n2.0 3.0 0.0\n",
                ["1", "2", "3"],
            ),
            ("empty diagonal", ",1,2\n1,,3\n2,3,\n", ["1", "2", "3"]),
            (
                "pandas",
                ",7,8,9\n7,0,1,2\n8,1,0,3\n9,2,3,0\n",
                ["7", "8", "9"],
            ),
            ("triangle", "0\n1,0\n2,3,0\n", ["1", "2", "3"]),
            ("triangle without diagonal", "1\n2,3\n", ["1", "2", "3"]),
            (
                "triangle of a square",
                "0,,\n1,0,\n2,3,0\n",
                ["1", "2", "3"],
            ),
        ] {
            let found = read(text)
                .map_err(|said| format!("{kind}: {said}"))
                .unwrap();
            assert_eq!(found.names, names, "{kind}");
            assert_eq!(pairs(&found), [1.0, 2.0, 3.0], "{kind}");
        }
    }

    #[test]
    fn what_is_no_square_of_numbers_is_named() {
        for (text, said) in [
            (",a,b\nr,1,2\n", "1 rows and 2 columns"),
            (
                ",a,b,c\na,,1,2\nx,1,,3\nc,2,3,\n",
                "a row is called x where the column is called b",
            ),
            (
                ",a,b,c\na,,1,NaN\nb,1,,3\nc,2,3,\n",
                "d.csv:2: a, c is \"NaN\"",
            ),
            (",a,a\na,1,2\na,2,1\n", "a stands twice"),
            (",a,\na,,1\n,1,\n", "name 2 is empty"),
            (
                "0,1,2\n1,0\n2,3,0\n",
                "d.csv:2: 2 cells where there are 3 objects",
            ),
        ] {
            let found = read(text).unwrap_err();
            assert!(found.contains(said), "{text}: {found}");
        }
        let long = "1\n".repeat(2000);
        assert!(read(&long).unwrap_err().contains("more than 1000"), "rows");
        let wide = "1,".repeat(2000);
        assert!(
            read(&wide).unwrap_err().contains("more than 1000"),
            "columns"
        );
    }
}
