//! Rows that are bound to each other: each holds the SHA-256 of the row before it, the first one of
//! the sidecar. What is cut out, edited or moved later breaks the chain where it happened.

use std::path::Path;

use selvedge_foundation::files::{FileError, Journal, read, read_text, sha256_hex};

/// The last row of a log, as the next one names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Chain {
    before_sha256: String,
}

impl Chain {
    /// Before the first row: bound to the bytes of the sidecar.
    pub(crate) fn of_sidecar(bytes: &[u8]) -> Self {
        Self {
            before_sha256: sha256_hex([bytes]),
        }
    }

    /// Behind the last row of a log.
    ///
    /// # Errors
    /// The log or its sidecar cannot be read.
    pub(super) fn of_log(log: &Path) -> Result<Self, FileError> {
        let mut chain = Self::of_sidecar(&read(&log.with_extension("json"))?);
        if let Some(last) = lines(&read_text(log)?).last() {
            chain.follow(last.as_bytes());
        }
        Ok(chain)
    }

    /// The hash that the next row holds.
    pub(crate) fn before_sha256(&self) -> &str {
        &self.before_sha256
    }

    /// A row is there now; without its line break.
    pub(crate) fn follow(&mut self, line: &[u8]) {
        self.before_sha256 = sha256_hex([line]);
    }

    /// The line of the next row, with its line break, whose last cell is the hash; the log at
    /// `path` is to hold it.
    ///
    /// # Errors
    /// None that a text in memory could have.
    pub(crate) fn bound(&self, mut cells: Vec<String>, path: &Path) -> Result<Vec<u8>, FileError> {
        if let Some(last) = cells.last_mut() {
            last.clone_from(&self.before_sha256);
        }
        Journal::row_line(&cells, path)
    }
}

/// The rows of a log below its header, without line breaks; a piece that is no whole row is left
/// out.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = &str> {
    let complete = text.rfind('\n').map_or(0, |end| end + 1);
    text[..complete].split_terminator('\n').skip(1)
}
