//! A session that was held without waiting: all its rows are known, and its files are written at
//! once.

use std::fs;
use std::path::{Path, PathBuf};

use super::{Opening, Sidecar, check_pseudonym, log_path, make_folder};
use crate::ExperimentError;
use crate::course::Course;
use crate::design::{Design, Subject};
use crate::record::{Record, column_names};
use selvedge_foundation::files::{FileError, TableWriter, write_atomic};

/// Writes the files of a session, as they would be had it been held trial by trial: its log.
///
/// # Errors
/// The pseudonym is no name, the log is there already, or it cannot be written.
pub(crate) fn write_whole(
    folder: &Path,
    (design, subject): (&Design, &Subject),
    opening: Opening,
    records: &[Record],
) -> Result<PathBuf, ExperimentError> {
    let log = unwritten(folder, design, subject)?;
    make_folder(folder)?;
    let names = column_names(design);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let mut table = TableWriter::new(Vec::new(), &log, &names)?;
    for record in records {
        for cell in record.cells(design, subject) {
            table.text(&cell.replace(['\n', '\r'], " "));
        }
        table.end_row()?;
    }
    let rows = table.finish()?;
    let mut sidecar = Sidecar::of(
        design,
        subject,
        Course::begin(design, subject)?.progress().1,
    );
    sidecar.open(opening);
    sidecar.write(&log)?;
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
