//! A session that was held without waiting: all its rows are known, and its files are written at
//! once.

use std::fs;
use std::path::{Path, PathBuf};

use super::{Opening, Sidecar, check_pseudonym, log_path, make_folder};
use crate::ExperimentError;
use crate::course::Course;
use crate::design::{Design, Subject};
use crate::record::{Mark, MarkKind, Record, SCHEMA_VERSION, column_names};
use selvedge_foundation::files::{FileError, Journal, write_atomic};

/// Writes the files of a session, as they would be had it been held trial by trial: its log.
///
/// # Errors
/// The pseudonym is no name, the log is there already, or it cannot be written.
pub(crate) fn write_whole(
    folder: &Path,
    (design, subject): (&Design, &Subject),
    opening: &Opening,
    records: &[Record],
) -> Result<PathBuf, ExperimentError> {
    let log = unwritten(folder, design, subject)?;
    make_folder(folder)?;
    let sidecar = Sidecar::of(design, subject, Course::begin(design, subject)?.procedure());
    let mut chain = sidecar.write(&log)?;
    let names = column_names(design, SCHEMA_VERSION);
    let mut rows = Journal::row_line(&names, &log)?;
    let mut add = |cells: Vec<String>| -> Result<(), FileError> {
        let line = chain.bound(cells, &log)?;
        chain.follow(line.strip_suffix(b"\n").unwrap_or(&line));
        rows.extend(line);
        Ok(())
    };
    add(opening.mark().cells(design, subject))?;
    for record in records {
        add(record.cells(design, subject))?;
    }
    let closing = Mark {
        kind: MarkKind::Closing,
        rows: records.len(),
        utc: records.last().map_or_else(
            || opening.utc.clone(),
            |last| last.timing.response_utc.clone(),
        ),
        ..opening.mark()
    };
    add(closing.cells(design, subject))?;
    write_atomic(&log, &rows)?;
    Ok(log)
}

/// The log of a session that was not begun.
///
/// # Errors
/// The pseudonym is no name, or the log is there already.
pub(crate) fn unwritten(
    folder: &Path,
    design: &Design,
    subject: &Subject,
) -> Result<PathBuf, ExperimentError> {
    check_pseudonym(&subject.pseudonym)?;
    let path = log_path(folder, design, subject);
    if fs::symlink_metadata(&path).is_ok() {
        return Err(FileError::Exists { path }.into());
    }
    Ok(path)
}
