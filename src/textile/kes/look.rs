//! A first look at a file: its first lines in cells, what its columns were taken for, and by what.
//! Nothing is refused here that a word of the user could mend.

use super::columns::columns_of;
use super::text::text_of;
use super::{ColumnRole, DecimalSign, KesFile, KesOptions};
use crate::error::TextileError;
use crate::number_table::{NoTable, RawTable, Separator, table_of};
use selvedge_foundation::files::FileError;
use selvedge_foundation::named;

/// Lines above the numbers that are shown: the last ones.
const MAX_ABOVE: usize = 5;
/// Lines of numbers that are shown.
const MAX_ROWS: usize = 6;
/// Characters of a line that are shown.
const MAX_LETTERS: usize = 400;

named! {
    /// By what something is known.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum KesKnown {
        /// The user said it.
        Said = "as said",
        /// The name above the column says it.
        Named = "by name",
        /// The number of columns, and how their numbers run, say it.
        Numbered = "by their number",
        /// Nothing says it.
        Unknown = "not known",
    }
    /// In a few words.
    pub fn label;
}

/// A column as it was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KesColumn {
    /// The name above it; empty if it has none.
    pub name: String,
    /// What it holds.
    pub role: ColumnRole,
    /// The unit that its name states; empty if it states none.
    pub unit: &'static str,
    /// By what its role is known.
    pub known: KesKnown,
}

/// A line in cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KesLine {
    /// Its number in the file, from 1.
    pub number: usize,
    /// Its cells; one if it is not of the table.
    pub cells: Vec<String>,
    /// Whether it is a row of the table.
    pub is_row: bool,
}

/// What a file looks like.
#[derive(Debug, Clone, PartialEq)]
pub struct KesLook {
    /// What stands between cells, in words.
    pub separator: &'static str,
    /// The decimal sign that the numbers were read with.
    pub decimal: DecimalSign,
    /// Whether the numbers show it: neither said nor a guess between two readings.
    pub(crate) is_decimal_shown: bool,
    /// Its columns.
    pub columns: Vec<KesColumn>,
    /// The last lines above the table and its first rows.
    pub lines: Vec<KesLine>,
    /// Rows of the table.
    pub n_rows: usize,
}

impl KesLook {
    /// Looks at a file. `is_friction`: it was given as a file of friction, whose columns nobody
    /// names.
    ///
    /// # Errors
    /// What is no text or no table, in one line.
    pub fn of(
        file: &KesFile<'_>,
        options: &KesOptions,
        is_friction: bool,
    ) -> Result<Self, TextileError> {
        let text = text_of(file.bytes, file.path)?;
        let table = match table_of(&text, options.decimal) {
            // It may be one or the other: shown as one, and asked for by the reader.
            Err(NoTable::Ambiguous { .. }) => table_of(&text, Some(DecimalSign::Point)),
            found => found,
        };
        let Ok(table) = table else {
            let mend = "give rows of numbers with tabs, commas, semicolons or blanks between";
            return Err(FileError::content(file.path, 1, "no whole table of numbers", mend).into());
        };
        let said = options.columns.as_deref().filter(|_| !is_friction);
        let mut lines: Vec<KesLine> = lines_above(&text, &table);
        lines.extend(first_rows(&text, &table));
        Ok(Self {
            separator: match table.dialect.separator {
                Separator::Tab => "tabs",
                Separator::Semicolon => "semicolons",
                Separator::Comma => "commas",
                Separator::Blanks => "blanks",
            },
            decimal: table.dialect.decimal,
            is_decimal_shown: options.decimal.is_none(),
            columns: columns(&table, said),
            lines,
            n_rows: table.lines.len(),
        })
    }
}

fn columns(table: &RawTable, said: Option<&[ColumnRole]>) -> Vec<KesColumn> {
    let names = table.headings(table.columns.len());
    let name = |index: usize| {
        let name = names.as_ref().and_then(|names| names.get(index));
        name.map_or_else(String::new, |name| name.trim().to_owned())
    };
    let found = columns_of(table, said).or_else(|_| columns_of(table, None));
    let is_said = said.is_some_and(|said| said.len() == table.columns.len());
    let n = table.columns.len();
    let Ok(found) = found else {
        let unknown = |index| KesColumn {
            name: name(index),
            role: ColumnRole::Skip,
            unit: "",
            known: KesKnown::Unknown,
        };
        return (0..n).map(unknown).collect();
    };
    let is_named = |index: usize, role| {
        ColumnRole::from_word(&name(index).to_lowercase()).is_some_and(|named| named == role)
            || (role == ColumnRole::Skip && !name(index).is_empty())
    };
    let column = |(index, column): (usize, super::columns::Column)| KesColumn {
        name: name(index),
        role: column.role,
        unit: column.unit.map_or("", crate::unit::Unit::label),
        known: if is_said {
            KesKnown::Said
        } else if is_named(index, column.role) {
            KesKnown::Named
        } else {
            KesKnown::Numbered
        },
    };
    found.into_iter().enumerate().map(column).collect()
}

/// The last lines above the table, whole but for their cells where they have as many.
fn lines_above(text: &str, table: &RawTable) -> Vec<KesLine> {
    let first = table.lines.first().copied().unwrap_or(1);
    let above: Vec<(usize, &str)> = (1..).zip(text.lines()).take(first - 1).collect();
    let filled = above
        .into_iter()
        .filter(|(_, line)| !line.trim().is_empty());
    let all: Vec<(usize, &str)> = filled.collect();
    let last = all.len().saturating_sub(MAX_ABOVE);
    let line = |&(number, line): &(usize, &str)| {
        let cells = table.dialect.cells(line);
        let is_whole = cells.len() == table.columns.len();
        KesLine {
            number,
            cells: if is_whole {
                cells.into_iter().map(shortened).collect()
            } else {
                vec![shortened(line.trim())]
            },
            is_row: false,
        }
    };
    all[last..].iter().map(line).collect()
}

fn first_rows<'a>(text: &'a str, table: &'a RawTable) -> impl Iterator<Item = KesLine> + 'a {
    let first = table.lines.first().copied().unwrap_or(1);
    let rows = (first..).zip(text.lines().skip(first - 1));
    let rows = rows.filter(|(number, _)| table.lines.binary_search(number).is_ok());
    rows.take(MAX_ROWS).map(|(number, line)| KesLine {
        number,
        cells: table
            .dialect
            .cells(line)
            .into_iter()
            .map(shortened)
            .collect(),
        is_row: true,
    })
}

fn shortened(cell: &str) -> String {
    let plain = cell.chars().map(|c| if c.is_control() { ' ' } else { c });
    plain.take(MAX_LETTERS).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn look(text: &str, options: &KesOptions) -> Result<KesLook, String> {
        let (path, bytes) = (Path::new("a.txt"), text.as_bytes());
        KesLook::of(&KesFile { path, bytes }, options, false).map_err(|error| error.to_string())
    }

    #[test]
    fn it_is_told_by_what_each_column_is_known() {
        let text = "KES-FB4\nNo;Weg mm;forward um\n1;0,5;7\n2;1,0;8\n3;1,5;9\n";
        let found = look(text, &KesOptions::default()).unwrap();
        assert_eq!(
            (found.separator, found.decimal),
            ("semicolons", DecimalSign::Comma)
        );
        let known: Vec<KesKnown> = found.columns.iter().map(|column| column.known).collect();
        assert_eq!(known, [KesKnown::Named; 3]);
        assert_eq!(
            (found.columns[1].unit, found.columns[2].role.label()),
            ("mm", "forward")
        );
        let numbers: Vec<usize> = found.lines.iter().map(|line| line.number).collect();
        assert_eq!(numbers, [1, 2, 3, 4, 5]);
        assert_eq!(found.lines[0].cells, ["KES-FB4"]);
        let bare = look("0 5\n1 7\n2 6\n", &KesOptions::default()).unwrap();
        assert_eq!(bare.columns[1].known, KesKnown::Numbered);
        let said = KesOptions {
            columns: Some(vec![ColumnRole::Distance, ColumnRole::Friction(None)]),
            ..KesOptions::default()
        };
        let said = look("0 5\n1 7\n2 6\n", &said).unwrap();
        assert_eq!(said.columns[1].known, KesKnown::Said);
        assert_eq!(said.columns[1].role.label(), "friction");
    }

    #[test]
    fn what_a_word_could_mend_is_shown_and_the_rest_is_refused_in_a_line() {
        let six = look("0 1 2 3 4 5\n1 4 3 2 1 5\n", &KesOptions::default()).unwrap();
        assert!(
            six.columns
                .iter()
                .all(|column| column.known == KesKnown::Unknown)
        );
        assert_eq!(
            look("1,5\n1,4\n2,7\n", &KesOptions::default())
                .unwrap()
                .columns
                .len(),
            2
        );
        for text in ["", "nothing\nhere\n"] {
            let error = look(text, &KesOptions::default()).unwrap_err();
            assert!(
                error.starts_with("a.txt:1: ") && error.contains("; "),
                "{error}"
            );
        }
    }
}
