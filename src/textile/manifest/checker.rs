//! Saying where in a manifest a wrong value stands.

use std::ops::RangeInclusive;
use std::path::Path;

use crate::files::FileError;
use crate::textile::TextileError;

/// The text of a manifest, to find lines in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Checker<'a> {
    pub(crate) text: &'a str,
    pub(crate) path: &'a Path,
}

impl Checker<'_> {
    /// Refuses a value outside a range, and NaN.
    pub(crate) fn within(
        &self,
        table: &str,
        key: &str,
        value: f64,
        range: RangeInclusive<f64>,
    ) -> Result<(), TextileError> {
        if range.contains(&value) {
            return Ok(());
        }
        let mend = format!("give a number from {} to {}", range.start(), range.end());
        Err(self.wrong(table, key, format!("{key} is {value}"), mend))
    }

    /// What is wrong with a key of a table (`""`: the top of the file).
    pub(crate) fn wrong(
        &self,
        table: &str,
        key: &str,
        what: impl Into<String>,
        mend: impl Into<String>,
    ) -> TextileError {
        FileError::content(self.path, line_of(self.text, table, key), what, mend).into()
    }
}

/// The line of a key of a table; of the table's header where the key is not there.
fn line_of(text: &str, table: &str, key: &str) -> usize {
    let mut at_table = usize::from(table.is_empty());
    let mut current = "";
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(header) = line.strip_prefix('[') {
            current = header.split(']').next().unwrap_or_default().trim();
            if current == table {
                at_table = index + 1;
            }
        } else if current == table
            && let Some((name, _)) = line.split_once('=')
            && name.trim() == key
        {
            return index + 1;
        }
    }
    at_table.max(1)
}
