//! Saying where in a manifest a wrong value stands.

use std::ops::RangeInclusive;
use std::path::Component::Normal;
use std::path::Path;

use crate::error::TextileError;
use selvedge_foundation::files::{FileError, line_of_key};

/// The text of a manifest, to find lines in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Checker<'a> {
    /// The text.
    pub(crate) text: &'a str,
    /// What errors call the file.
    pub(crate) path: &'a Path,
    /// Which of several tables of a name is meant, from 0.
    pub(crate) nth: usize,
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
        FileError::content(
            self.path,
            line_of_key(self.text, table, self.nth, key),
            what,
            mend,
        )
        .into()
    }

    /// Refuses the name of a file that leads out of the textile's folder.
    pub(crate) fn file_name(
        &self,
        table: &str,
        key: &str,
        name: Option<&str>,
    ) -> Result<(), TextileError> {
        let Some(name) = name else { return Ok(()) };
        let mut parts = Path::new(name).components();
        if matches!((parts.next(), parts.next()), (Some(Normal(_)), None)) {
            return Ok(());
        }
        let mend = "name a file in the textile's own folder";
        Err(self.wrong(table, key, format!("{key} is \"{name}\""), mend))
    }
}
