//! The files of a session: where each is, and what pointer or tablet reported during a trial.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::Trial;
use crate::design::{Design, Subject};
use selvedge_engine::RecordedSample;
use selvedge_foundation::files::{FileError, Journal, push_number, write_atomic};
use selvedge_foundation::quantity::rfc3339;

/// Columns: s after the path's first row, and the place, mm.
const HEADER: &str = "t_s,x_mm,y_mm\n";

/// Writes what pointer or tablet reported (time and place of every report, at its own rate, beside
/// the path at 40 Hz that is replayed) into a file whose folder may be missing.
pub(super) fn write_samples(samples: &[RecordedSample], file: &Path) -> Result<(), FileError> {
    if let Some(folder) = file.parent() {
        make_folder(folder)?;
    }
    let mut text = HEADER.to_owned();
    for sample in samples {
        let RecordedSample { t_s, position } = sample;
        // A microsecond is finer than any clock that stamps reports.
        push_number(&mut text, (t_s * 1e6).round() / 1e6);
        text.push(',');
        push_number(&mut text, position.x_mm);
        text.push(',');
        push_number(&mut text, position.y_mm);
        text.push('\n');
    }
    write_atomic(file, text.as_bytes())
}

/// Makes a folder where it is missing.
pub(crate) fn make_folder(folder: &Path) -> Result<(), FileError> {
    std::fs::create_dir_all(folder).map_err(|source| FileError::Write {
        path: folder.to_owned(),
        source,
    })
}

/// The table of sessions that were begun by mistake.
const UNDONE: &str = "undone-sessions.csv";
/// Its columns.
const UNDONE_COLUMNS: [&str; 4] = ["utc", "experiment", "subject", "session"];

/// Notes that a session was begun and that this was taken back.
pub(super) fn note_undone(
    log: &Path,
    (design, subject): (&Design, &Subject),
) -> Result<(), FileError> {
    let path = log.with_file_name(UNDONE);
    let mut journal = match Journal::create(&path, &UNDONE_COLUMNS) {
        Err(FileError::Exists { .. }) => Journal::reopen(&path, &UNDONE_COLUMNS)?.journal,
        journal => journal?,
    };
    journal.append(&[
        &rfc3339(SystemTime::now()),
        &design.experiment,
        &subject.pseudonym,
        &subject.session.to_string(),
    ])
}

/// Removes a log and its sidecar.
pub(super) fn remove(log: &Path) -> Result<(), FileError> {
    for file in [log.to_owned(), log.with_extension("json")] {
        std::fs::remove_file(&file).map_err(|source| FileError::Write { path: file, source })?;
    }
    Ok(())
}

/// Removes what a kill left of a sidecar that was being written: `NAME.json.N.part`.
pub(super) fn remove_pieces(log: &Path) {
    let sidecar = log.with_extension("json");
    let begins = sidecar.file_name().map(|name| name.to_string_lossy());
    let (Some(begins), Some(folder)) = (begins, log.parent()) else {
        return;
    };
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let rest = name.to_str().and_then(|name| name.strip_prefix(&*begins));
        if rest.is_some_and(|rest| rest.starts_with('.') && rest.strip_suffix(".part").is_some()) {
            // One that cannot be removed is in nobody's way.
            drop(std::fs::remove_file(entry.path()));
        }
    }
}

/// The file of how a trial was explored.
pub fn path_file(log: &Path, trial: &Trial, attempt: u32) -> PathBuf {
    let stem = log.file_stem().unwrap_or_default().to_string_lossy();
    let practice = if trial.is_practice {
        "practice"
    } else {
        "trial"
    };
    let again = if attempt > 1 {
        format!("-{attempt}")
    } else {
        String::new()
    };
    let name = format!("{practice}-{:03}{again}.csv", trial.number + 1);
    log.with_file_name(format!("{stem}-paths")).join(name)
}

/// The file of what pointer or tablet reported in a trial.
pub fn samples_file(log: &Path, trial: &Trial, attempt: u32) -> PathBuf {
    let path = path_file(log, trial, attempt);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-samples.csv"))
}

/// The log of a subject's session in a folder.
pub fn log_path(folder: &Path, design: &Design, subject: &Subject) -> PathBuf {
    folder.join(format!(
        "{}_{}_{}_{}.csv",
        design.study, design.experiment, subject.pseudonym, subject.session
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::tests::Folder;
    use selvedge_foundation::files::{Table, read_text};
    use selvedge_foundation::geometry::Point;

    #[test]
    fn every_report_stands_in_the_file_with_its_time_and_place() {
        let folder = Folder::new("samples");
        let file = folder.0.join("paths/trial-001-samples.csv");
        let sample = |n: u32| RecordedSample {
            t_s: -0.01 + 0.0075 * f64::from(n),
            position: Point::new(0.1 * f64::from(n), 12.5),
        };
        let samples: Vec<RecordedSample> = (0..200).map(sample).collect();
        write_samples(&samples, &file).unwrap();
        let text = read_text(&file).unwrap();
        assert!(
            text.starts_with("t_s,x_mm,y_mm\n-0.01,0,12.5\n-0.0025,0.1,12.5\n"),
            "{text}"
        );
        let table = Table::read(&text, &file, &["t_s", "x_mm", "y_mm"], &[]).unwrap();
        assert_eq!(table.n_rows(), 200);
    }
}
