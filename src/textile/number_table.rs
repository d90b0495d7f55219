//! Tables of numbers in texts: how they are spelt, where they begin, what stands above.
//!
//! Every spelling is tried; the one that reads the longest table wins. Where two read as much, they
//! read the same, but for one case, which has rules of its own: see [`settled`].
//!
//! Of strokes every cell must be a number. Other tables may have gaps: cells that are empty or say
//! that they hold nothing, and the spelling that reads most numbers wins.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

/// The decimal sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum DecimalSign {
    /// `0.5`
    Point,
    /// `0,5`
    Comma,
}

/// What stands between cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    Tab,
    Semicolon,
    Comma,
    Blanks,
}

/// A spelling.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dialect {
    pub(crate) separator: Separator,
    pub(crate) decimal: DecimalSign,
    /// Whether cells may hold nothing: NaN.
    has_gaps: bool,
}

/// A table of numbers and the text above it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RawTable {
    pub(crate) dialect: Dialect,
    /// Column by column.
    pub(crate) columns: Vec<Vec<f64>>,
    /// The unit of the last digit of each column: 0.001 for `0.125`.
    pub(crate) quanta: Vec<f64>,
    /// The line of every row, from 1.
    pub(crate) lines: Vec<usize>,
    /// The lines above that are not blank.
    pub(crate) header: Vec<String>,
}

/// Why there is no table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum NoTable {
    /// Not two rows of numbers; the last line that is not blank.
    NoNumbers { line: usize },
    /// A line (from 1) among the numbers that is none of the table's, which has so many columns.
    Broken {
        line: usize,
        n_columns: usize,
        text: String,
    },
    /// Two columns of whole numbers, or one with a decimal comma.
    Ambiguous { line: usize },
    /// More lines than [`MAX_LINES`].
    TooLong,
}

impl NoTable {
    /// A table that is too long, for people: what, and how to mend it.
    pub(crate) const TOO_LONG: [&str; 2] = [
        "this text has more than four million lines",
        "give the part of it that you need",
    ];
}

/// The spellings, of those that read the same the plainest first.
const DIALECTS: [(Separator, DecimalSign); 7] = [
    (Separator::Tab, DecimalSign::Point),
    (Separator::Semicolon, DecimalSign::Point),
    (Separator::Comma, DecimalSign::Point),
    (Separator::Blanks, DecimalSign::Point),
    (Separator::Tab, DecimalSign::Comma),
    (Separator::Semicolon, DecimalSign::Comma),
    (Separator::Blanks, DecimalSign::Comma),
];
/// Most lines of a text: short ones would take many times the memory of their bytes.
const MAX_LINES: usize = 4_000_000;
/// What cells say that hold nothing and are not empty, whatever their sign.
const NOTHING: [&str; 6] = ["nan", "inf", "infinity", "bad", "---", "null"];

impl Dialect {
    /// The cells of a line; empty ones at its end are dropped unless there may be gaps.
    pub(crate) fn cells(self, line: &str) -> Vec<&str> {
        let mut cells: Vec<&str> = match self.separator {
            Separator::Tab => line.split('\t').collect(),
            Separator::Semicolon => line.split(';').collect(),
            Separator::Comma => line.split(',').collect(),
            Separator::Blanks => line.split_whitespace().collect(),
        };
        for cell in &mut cells {
            *cell = cell.trim().trim_matches('"');
        }
        while !self.has_gaps && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        cells
    }

    /// The number of a cell and the power of ten of its last digit: `0.125` is (0.125, −3).
    fn number(self, cell: &str) -> Option<(f64, i32)> {
        let plain = cell.trim_start_matches(['+', '-']);
        let says = |word: &&str| {
            [plain, cell]
                .iter()
                .any(|cell| cell.eq_ignore_ascii_case(word))
        };
        if self.has_gaps && (cell.is_empty() || NOTHING.iter().any(says)) {
            return Some((f64::NAN, 0));
        }
        // Some programs write places with a point and heights with a comma.
        let is_mixed = self.has_gaps && self.decimal == DecimalSign::Comma && cell.contains('.');
        let decimal = if is_mixed {
            DecimalSign::Point
        } else {
            self.decimal
        };
        number(cell, decimal)
    }

    /// The numbers of a line; `None` if one of its cells is none, or all hold nothing (`nan`s do).
    fn numbers(self, line: &str) -> Option<Vec<(f64, i32)>> {
        let cells = self.cells(line);
        let numbers: Option<Vec<_>> = cells.iter().map(|cell| self.number(cell)).collect();
        let says_nan = |cell: &&str| cell.eq_ignore_ascii_case("nan");
        let is_row = !cells.is_empty() && cells.iter().all(says_nan);
        numbers.filter(|all| is_row || all.iter().any(|(number, _)| !number.is_nan()))
    }
}

/// A finite number and the power of ten of its last digit.
fn number(cell: &str, decimal: DecimalSign) -> Option<(f64, i32)> {
    let is_plain =
        |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | '+' | '-' | 'e' | 'E' | '\u{2212}');
    let foreign = match decimal {
        DecimalSign::Point => ',',
        DecimalSign::Comma => '.',
    };
    if !cell.chars().all(|c| is_plain(c) && c != foreign) {
        return None;
    }
    let plain = if cell.contains([',', '\u{2212}']) {
        Cow::Owned(cell.replace('\u{2212}', "-").replace(',', "."))
    } else {
        Cow::Borrowed(cell)
    };
    let value: f64 = plain.parse().ok().filter(|value: &f64| value.is_finite())?;
    let (digits, exponent) = match plain.split_once(['e', 'E']) {
        Some((digits, exponent)) => (digits, exponent.parse().unwrap_or(0)),
        None => (&*plain, 0),
    };
    let n_decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    Some((value, exponent - i32::try_from(n_decimals).unwrap_or(0)))
}

/// Rows of numbers that follow one another with the same number of cells.
#[derive(Debug, Clone, Copy)]
struct Run {
    first: usize,
    last: usize,
    n_rows: usize,
    n_columns: usize,
}

/// The table of a text, every cell a number.
pub(crate) fn table_of(text: &str, decimal: Option<DecimalSign>) -> Result<RawTable, NoTable> {
    found(text, decimal, false)
}

/// The table of a text in which cells may hold nothing.
pub(crate) fn table_with_gaps(text: &str) -> Result<RawTable, NoTable> {
    found(text, None, true)
}

fn found(text: &str, decimal: Option<DecimalSign>, has_gaps: bool) -> Result<RawTable, NoTable> {
    if text.lines().nth(MAX_LINES).is_some() {
        return Err(NoTable::TooLong);
    }
    let lines: Vec<&str> = text.lines().collect();
    let size = |run: &Run| run.n_rows * if has_gaps { run.n_columns } else { 1 };
    let mut best: Option<(Dialect, Vec<Run>, Run)> = None;
    for (separator, sign) in DIALECTS {
        if decimal.is_some_and(|decimal| decimal != sign) {
            continue;
        }
        let dialect = Dialect {
            separator,
            decimal: sign,
            has_gaps,
        };
        let runs = runs(&lines, dialect);
        let Some(longest) = runs.iter().copied().max_by_key(size) else {
            continue;
        };
        if best
            .as_ref()
            .is_none_or(|(_, _, run)| size(&longest) > size(run))
        {
            best = Some((dialect, runs, longest));
        }
    }
    let min_rows = if has_gaps { 1 } else { 2 };
    let Some((mut dialect, runs, run)) = best.filter(|(.., run)| run.n_rows >= min_rows) else {
        let last = lines.iter().rposition(|line| !line.trim().is_empty());
        let line = last.map_or(1, |last| last + 1);
        return Err(NoTable::NoNumbers { line });
    };
    check_whole(&lines, dialect, &runs, run)?;
    let is_pair = dialect.separator == Separator::Comma && run.n_columns == 2;
    if is_pair && decimal.is_none() && !has_gaps {
        dialect = settled(&lines[run.first..=run.last], dialect).ok_or(NoTable::Ambiguous {
            line: run.first + 1,
        })?;
    }
    Ok(table(&lines, dialect, run))
}

impl RawTable {
    /// The headings of the first `n` columns: the cells of the last two lines above that have as
    /// many, from the top. `None` where no line has.
    pub(crate) fn headings(&self, n: usize) -> Option<Vec<String>> {
        let mut headings = vec![String::new(); n];
        let mut is_headed = false;
        for line in &self.header[self.header.len().saturating_sub(2)..] {
            let mut cells = self.dialect.cells(line);
            while cells.len() > n && cells.last().is_some_and(|cell| cell.is_empty()) {
                cells.pop();
            }
            // A unit in a line of its own may leave no cell empty but the first.
            if cells.len() == n {
                is_headed = true;
                for (heading, cell) in headings.iter_mut().zip(cells) {
                    heading.push(' ');
                    heading.push_str(cell);
                }
            }
        }
        is_headed.then_some(headings)
    }
}

fn runs(lines: &[&str], dialect: Dialect) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut is_open = false;
    for (index, line) in lines.iter().enumerate() {
        if line.trim().is_empty() {
            continue;
        }
        let n_columns = dialect.numbers(line).map_or(0, |numbers| numbers.len());
        match runs.last_mut() {
            Some(run) if is_open && run.n_columns == n_columns => {
                run.last = index;
                run.n_rows += 1;
            }
            _ if n_columns > 0 => runs.push(Run {
                first: index,
                last: index,
                n_rows: 1,
                n_columns,
            }),
            _ => {}
        }
        is_open = n_columns > 0;
    }
    runs
}

/// Refuses a table that is broken off: other rows like it stand before or after.
fn check_whole(lines: &[&str], dialect: Dialect, runs: &[Run], table: Run) -> Result<(), NoTable> {
    let broken = |from: usize| {
        let rest = lines.iter().enumerate().skip(from);
        let found = rest.clone().find(|(_, line)| !line.trim().is_empty());
        found.map_or(Ok(()), |(index, line)| {
            Err(NoTable::Broken {
                line: index + 1,
                n_columns: table.n_columns,
                text: shortened(line),
            })
        })
    };
    // Numbers in a header come singly; rows like those of the table are part of it.
    let is_part = |run: &&Run| {
        let is_like = run.n_columns == table.n_columns && run.first < table.first;
        is_like && ((run.n_columns > 1 && !dialect.has_gaps) || run.n_rows > 2)
    };
    if let Some(run) = runs.iter().find(is_part) {
        return broken(run.last + 1);
    }
    let above = lines[..table.first]
        .iter()
        .rposition(|line| !line.trim().is_empty());
    if let Some(index) = above.filter(|index| is_half_a_row(lines[*index], dialect, table)) {
        return broken(index);
    }
    broken(table.last + 1)
}

/// Whether the line above a table begins like one of its rows.
fn is_half_a_row(line: &str, dialect: Dialect, table: Run) -> bool {
    let cells = dialect.cells(line);
    let is_number = |cell: &&str| number(cell, dialect.decimal).is_some();
    let is_like = table.n_columns > 1 && cells.len() == table.n_columns;
    is_like && !dialect.has_gaps && cells.first().is_some_and(is_number)
}

fn shortened(line: &str) -> String {
    const LONGEST: usize = 24;
    let clean: String = line
        .trim()
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if clean.chars().count() <= LONGEST {
        return clean;
    }
    clean.chars().take(LONGEST - 1).collect::<String>() + "…"
}

/// Rows such as `1,5` of whole numbers: two columns, or one with a decimal comma. A zero before
/// further digits (`1,05`) is a decimal; a sign (`1,-5`) or places that rise or fall throughout
/// are a column. `None` where nothing tells.
fn settled(lines: &[&str], two_columns: Dialect) -> Option<Dialect> {
    let pairs: Vec<(&str, &str)> = lines
        .iter()
        .filter_map(|line| line.trim().split_once(','))
        .map(|(one, other)| (one.trim(), other.trim()))
        .collect();
    let is_digits = |cell: &str| !cell.is_empty() && cell.bytes().all(|b| b.is_ascii_digit());
    let is_whole = |&(one, other): &(&str, &str)| {
        is_digits(one.trim_start_matches(['-', '+'])) && is_digits(other)
    };
    if !pairs.iter().all(is_whole) {
        return Some(two_columns);
    }
    let is_decimal =
        |&(one, other): &(&str, &str)| (other.len() > 1 && other.starts_with('0')) || one == "-0";
    if pairs.iter().any(is_decimal) {
        return Some(Dialect {
            separator: Separator::Blanks,
            decimal: DecimalSign::Comma,
            ..two_columns
        });
    }
    let places: Vec<f64> = pairs
        .iter()
        .filter_map(|(one, _)| one.parse().ok())
        .collect();
    let is_ordered = |sign: f64| {
        places
            .windows(2)
            .all(|pair| sign * (pair[1] - pair[0]) > 0.0)
    };
    (is_ordered(1.0) || is_ordered(-1.0)).then_some(two_columns)
}

fn table(lines: &[&str], dialect: Dialect, run: Run) -> RawTable {
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut powers: Vec<i32> = Vec::new();
    let mut at = Vec::new();
    for (index, line) in lines.iter().enumerate().take(run.last + 1).skip(run.first) {
        let Some(numbers) = dialect.numbers(line) else {
            continue;
        };
        columns.resize(numbers.len().max(columns.len()), Vec::new());
        powers.resize(columns.len(), 0);
        for (column, (value, power)) in numbers.into_iter().enumerate() {
            columns[column].push(value);
            powers[column] = powers[column].min(power);
        }
        at.push(index + 1);
    }
    let is_filled = |line: &&&str| !line.trim().is_empty();
    RawTable {
        dialect,
        columns,
        quanta: powers
            .into_iter()
            .map(|power| 10.0_f64.powi(power))
            .collect(),
        lines: at,
        header: lines[..run.first]
            .iter()
            .filter(is_filled)
            .map(|line| (*line).to_owned())
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Dialect, Vec<Vec<f64>>) {
        let table = table_of(text, None).unwrap();
        (table.dialect, table.columns)
    }

    #[test]
    fn every_spelling_reads_the_same_numbers() {
        let expected = vec![vec![0.0, 0.5, 1.0], vec![-1.25, 2.0, 30.0]];
        for text in [
            "0\t-1.25\n0.5\t2\n1.0\t3e1\n",
            "0;-1,25\n0,5;2,0\n1,0;30\n",
            "x,z\r\n0,-1.25\r\n0.5,2\r\n1.0,30\r\n",
            "Sample 7\n\n  0 -1.25\n 0.5   2\n 1.0 +30\n\n",
            "0,0 -1,25\n0,5 2,0\n1,0 30\n",
            "\"0\";\"\u{2212}1,25\";\n\"0,5\";\"2\";\n\"1\";\"30\";\n",
        ] {
            assert_eq!(read(text).1, expected, "{text}");
        }
    }

    #[test]
    fn whole_numbers_with_a_comma_are_settled_or_asked_for() {
        assert_eq!(read("1,05\n1,50\n2,25\n").1, [vec![1.05, 1.5, 2.25]]);
        assert_eq!(read("0,5\n1,4\n2,7\n").1.len(), 2);
        assert_eq!(read("3,-5\n1,4\n2,7\n").1.len(), 2);
        let asked = table_of("1,5\n1,4\n2,7\n", None);
        assert_eq!(asked, Err(NoTable::Ambiguous { line: 1 }));
        let said = table_of("1,5\n1,4\n2,7\n", Some(DecimalSign::Comma)).unwrap();
        assert_eq!(said.columns, [vec![1.5, 1.4, 2.7]]);
    }

    #[test]
    fn a_row_that_is_broken_is_named_wherever_it_stands() {
        let row = |i: i32| format!("{i};{i},5\n");
        for at in [0, 1, 4, 10, 16] {
            let text: String = (0..20)
                .map(|i| {
                    if i == at {
                        "7;NaN\n".to_owned()
                    } else {
                        row(i)
                    }
                })
                .collect();
            let line = usize::try_from(at).unwrap() + 1;
            let text_of_line = "7;NaN".to_owned();
            let expected = NoTable::Broken {
                line,
                n_columns: 2,
                text: text_of_line,
            };
            assert_eq!(table_of(&text, None), Err(expected));
        }
        assert_eq!(
            table_of("a\nb 5\n", None),
            Err(NoTable::NoNumbers { line: 2 })
        );
    }

    #[test]
    fn the_last_digit_says_how_finely_places_are_printed() {
        let table = table_of("0.004\t1\n0.009\t2e-1\n", None).unwrap();
        assert!((table.quanta[0] - 1e-3).abs() < 1e-15, "{:?}", table.quanta);
        assert!((table.quanta[1] - 0.1).abs() < 1e-15, "{:?}", table.quanta);
    }
}
