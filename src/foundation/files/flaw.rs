//! A value of a TOML file that is well spelt but wrong: where it stands and how to mend it.

use std::path::Path;

use super::{FileError, line_of_key};

/// Where a value stands: the table that holds it (empty for the file itself), which of the tables
/// of that name, from 0, and its key.
pub type Place = (&'static str, usize, &'static str);

/// A wrong value, where it stands and how to mend it. Rules that hold for files hold for values
/// that arrive otherwise, which is why this is known before there is a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Flaw {
    /// Where it stands.
    pub place: Place,
    /// What is wrong.
    pub what: String,
    /// What to do about it.
    pub mend: String,
}

impl Flaw {
    /// A flaw at a place.
    pub fn new(place: Place, what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self {
            place,
            what: what.into(),
            mend: mend.into(),
        }
    }

    /// A flaw whose error reads `what; mend`; `mend` stands in where it says no more.
    pub fn described(place: Place, error: &str, mend: &str) -> Self {
        let (what, mend) = error.split_once("; ").unwrap_or((error, mend));
        Self::new(place, what, mend)
    }

    /// As an error that names file and line; `path` only names it.
    pub fn in_file(self, text: &str, path: &Path) -> FileError {
        let (table, nth, key) = self.place;
        let line = line_of_key(text, table, nth, key);
        FileError::content(path, line, self.what, self.mend)
    }
}
