//! Sessions in a folder, as analyses read them.

use std::fs;
use std::path::{Path, PathBuf};

use super::Sidecar;
use crate::ExperimentError;
use crate::design::{Design, Subject};
use crate::record::{Record, column_names, read_records};
use selvedge_foundation::files::{self, FileError, Journal, Table};

/// A session that was held.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Its log.
    pub log: PathBuf,
    /// Who took part.
    pub subject: Subject,
    /// The design that it was held by.
    pub design: Design,
    /// Its rows in order, practice and aborted trials too.
    pub records: Vec<Record>,
    /// Whether the log ends in the middle of a row, which is left out.
    pub(crate) has_torn_row: bool,
}

/// A log that cannot be read.
#[derive(Debug)]
pub struct Unread {
    /// The log.
    pub log: PathBuf,
    /// What is wrong, where, and how to mend it.
    pub error: ExperimentError,
}

/// Every session in a folder, by name, and the logs that cannot be read.
///
/// What a later version wrote, or what was damaged, does not keep the others from being read.
/// Tables without a sidecar are no sessions.
///
/// # Errors
/// The folder cannot be read.
pub fn find_sessions(folder: &Path) -> Result<(Vec<Found>, Vec<Unread>), ExperimentError> {
    let (mut found, mut unread) = (Vec::new(), Vec::new());
    for log in logs(folder)? {
        match Found::read(&log) {
            Ok(session) => found.push(session),
            Err(error) => unread.push(Unread { log, error }),
        }
    }
    Ok((found, unread))
}

fn logs(folder: &Path) -> Result<Vec<PathBuf>, ExperimentError> {
    let entries = fs::read_dir(folder).map_err(|source| FileError::Read {
        path: folder.to_owned(),
        source,
    })?;
    let is_log = |path: &PathBuf| {
        path.extension().is_some_and(|extension| extension == "csv")
            && path.with_extension("json").is_file()
    };
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    let mut logs: Vec<PathBuf> = paths.filter(is_log).collect();
    logs.sort();
    Ok(logs)
}

impl Found {
    /// Whether the session is being held now, by this program or another.
    pub fn is_held(&self) -> bool {
        Journal::is_written(&self.log)
    }

    /// The session of a log, which another process may be writing.
    ///
    /// # Errors
    /// The log or the file beside it cannot be read.
    pub fn read(log: &Path) -> Result<Self, ExperimentError> {
        let sidecar = Sidecar::read(log)?;
        let (design, subject) = (sidecar.design(log)?, sidecar.subject());
        let text = files::read_text(log)?;
        // A session that is being held may be in the middle of a row.
        let complete = text.rfind('\n').map_or(0, |end| end + 1);
        let names = column_names(&design);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let table = Table::read(&text[..complete], log, &names, &[])?;
        let records = read_records(&design, &table, log)?;
        Ok(Self {
            log: log.to_owned(),
            subject,
            design,
            records,
            has_torn_row: complete < text.len(),
        })
    }
}
