//! Saying where in a manifest a wrong value stands.

use std::ops::RangeInclusive;
use std::path::Path;

use crate::TextileError;
use selvedge_foundation::files::{FileError, line_of_key};

/// The text of a manifest, to find lines in.
#[derive(Debug, Clone, Copy)]
pub struct Checker<'a> {
    pub text: &'a str,
    pub path: &'a Path,
    /// Which of several tables of a name is meant, from 0.
    pub nth: usize,
}

impl Checker<'_> {
    /// Refuses a value outside a range, and NaN.
    pub fn within(
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
    pub fn wrong(
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
}
