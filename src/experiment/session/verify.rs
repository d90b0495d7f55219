//! Whether the files of a session are as they were written: the chain of its rows, what each row
//! says of itself, its paths, its schedule.

use std::fmt;
use std::path::{Path, PathBuf};

use super::chain::{Chain, lines};
use super::sidecar::{Sidecar, schedule};
use super::{Course, Found, path_file};
use crate::design::Design;
use crate::record::{MarkKind, Record, column_names, read_marks, trials as rows_of_trials};
use crate::stimulus_hash::StimulusHashes;
use crate::{ExperimentError, Procedure};
use selvedge_foundation::files::{self, Table, sha256_hex};
use selvedge_foundation::progress::Progress;

/// Columns that are compared with nothing: what another version writes otherwise, and what other
/// checks look at.
const NOT_COMPARED: [&str; 5] = [
    "schema_version",
    "software",
    "path_sha256",
    "rows",
    "before_sha256",
];

/// Something that is not as it was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Break {
    /// The log.
    pub log: PathBuf,
    /// The line of the log; `None` where it is about all of it.
    pub line: Option<usize>,
    /// What is wrong.
    pub what: String,
}

impl fmt::Display for Break {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.log.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.what)
    }
}

impl Verified {
    /// What is wrong in a folder of sessions, log by log.
    ///
    /// # Errors
    /// The folder cannot be read, or it was cancelled.
    pub fn of_folder(folder: &Path, progress: &mut Progress<'_>) -> Result<Self, ExperimentError> {
        let (mut found, unread) = Found::in_folder(folder)?;
        Found::verify_stimuli(&mut found, progress)?;
        let n_logs = found.len() + unread.len();
        let n_open = found.iter().filter(|one| !one.is_closed).count();
        let n_broken = found.iter().filter(|one| !one.breaks.is_empty()).count() + unread.len();
        let mut breaks: Vec<Break> = found.into_iter().flat_map(|one| one.breaks).collect();
        breaks.extend(unread.into_iter().map(|one| Break {
            log: one.log,
            line: None,
            what: one.error.to_string(),
        }));
        breaks.sort_by(|a, b| (&a.log, a.line).cmp(&(&b.log, b.line)));
        Ok(Self {
            breaks,
            n_logs,
            n_broken,
            n_open,
        })
    }
}

/// What a look at a folder found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verified {
    /// Everything that is not as it was written, log by log.
    pub breaks: Vec<Break>,
    /// Logs in the folder.
    pub n_logs: usize,
    /// Those of them with a break.
    pub n_broken: usize,
    /// Those that were not closed.
    pub n_open: usize,
}

impl Found {
    /// Looks whether sessions were held with the textiles that are at hand now: of logs that name
    /// what their trials were made from, where the library of their design can be opened.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn verify_stimuli(
        found: &mut [Self],
        progress: &mut Progress<'_>,
    ) -> Result<(), ExperimentError> {
        let mut known: Vec<(Design, Option<PathBuf>, Option<StimulusHashes>)> = Vec::new();
        for session in found.iter_mut().filter(|one| one.library_sha256.is_some()) {
            let file = session.design_file.clone();
            let folder = file.as_deref().and_then(Path::parent).map(Path::to_owned);
            let is_same = |(design, place, _): &(Design, Option<PathBuf>, _)| {
                design.hash == session.design.hash && *place == folder
            };
            if !known.iter().any(is_same) {
                let hashes = folder.as_deref().map_or(Ok(None), |folder| {
                    at_hand(&session.design, folder, progress)
                })?;
                known.push((session.design.clone(), folder.clone(), hashes));
            }
            let is_same = |(design, place, _): &&(Design, Option<PathBuf>, _)| {
                design.hash == session.design.hash && *place == folder
            };
            if let Some((.., Some(hashes))) = known.iter().find(is_same) {
                session.compare_stimuli(hashes);
            }
        }
        Ok(())
    }
}

/// The textiles of a design that are at hand; `None` where its library cannot be opened, or has
/// them no more: nothing can be said then.
fn at_hand(
    design: &Design,
    folder: &Path,
    progress: &mut Progress<'_>,
) -> Result<Option<StimulusHashes>, ExperimentError> {
    let Ok(library) = design.open_library(folder, None) else {
        return Ok(None);
    };
    match StimulusHashes::of_library(design, &library, progress) {
        Err(ExperimentError::Cancelled(stop)) => Err(stop.into()),
        hashes => Ok(hashes.ok()),
    }
}

impl Found {
    fn compare_stimuli(&mut self, hashes: &StimulusHashes) {
        let mut found = |what: String| {
            self.breaks.push(Break {
                log: self.log.clone(),
                line: None,
                what,
            });
        };
        if self.library_sha256.as_ref() != Some(&hashes.all()) {
            return found("its textiles are not those that the library holds now".to_owned());
        }
        let differs = |record: &&Record| {
            let held = &record.apparatus.stimulus_hash;
            !held.is_empty() && *held != hashes.of_task(&self.design, &record.trial.task)
        };
        if let Some(record) = self.records.iter().find(differs) {
            let number = record.trial.number + 1;
            found(format!(
                "trial {number} presented something else than it names"
            ));
        }
    }
}

/// A log that is looked at.
pub(super) struct Evidence<'a> {
    pub(super) log: &'a Path,
    pub(super) text: &'a str,
    pub(super) sidecar: &'a Sidecar,
    pub(super) design: &'a Design,
    pub(super) table: &'a Table,
    pub(super) records: &'a [Record],
}

impl Evidence<'_> {
    /// Everything that is not as it was written.
    ///
    /// # Errors
    /// The sidecar cannot be read, or a mark is none.
    pub(super) fn breaks(&self) -> Result<Vec<Break>, ExperimentError> {
        let mut breaks = Vec::new();
        if self.sidecar.schema_version() > 1 {
            self.check_chain(&mut breaks)?;
            self.check_marks(&mut breaks)?;
            self.check_schedule(&mut breaks)?;
        }
        self.check_cells(&mut breaks);
        self.check_paths(&mut breaks);
        self.check_course(&mut breaks);
        breaks.sort_by_key(|one| one.line);
        Ok(breaks)
    }

    fn found(&self, line: Option<usize>, what: impl Into<String>) -> Break {
        Break {
            log: self.log.to_owned(),
            line,
            what: what.into(),
        }
    }

    /// Each row holds the hash of the one before it.
    fn check_chain(&self, breaks: &mut Vec<Break>) -> Result<(), ExperimentError> {
        let mut chain = Chain::of_sidecar(&files::read(&self.log.with_extension("json"))?);
        for (nth, line) in lines(self.text).enumerate() {
            let held = line.rsplit(',').next().unwrap_or_default();
            if held != chain.before_sha256() {
                let what = if nth == 0 {
                    "the first row is not bound to the file beside the log: that file was changed, \
                     or the row"
                } else {
                    "this row is not bound to the one before it: one was edited, moved, added or \
                     cut out"
                };
                breaks.push(self.found(Some(nth + 2), what));
            }
            chain.follow(line.as_bytes());
        }
        Ok(())
    }

    /// Openings and the closing count the trials before them, and nothing follows the closing.
    fn check_marks(&self, breaks: &mut Vec<Break>) -> Result<(), ExperimentError> {
        let marks = read_marks(self.table, self.log)?;
        if marks
            .first()
            .is_none_or(|mark| mark.kind != MarkKind::Opening)
        {
            breaks.push(self.found(None, "the row of its first opening is missing"));
        }
        for mark in &marks {
            let n_before = mark.n_trials_before;
            if mark.rows != n_before {
                let name = mark.kind.name();
                let what = format!(
                    "the {name} counts {} trials, {n_before} are there",
                    mark.rows
                );
                breaks.push(self.found(Some(mark.line), what));
            }
        }
        let closing = marks.iter().find(|mark| mark.kind == MarkKind::Closing);
        let last = self
            .table
            .n_rows()
            .checked_sub(1)
            .map(|row| self.table.line_of(row));
        if closing.is_some_and(|mark| Some(mark.line) != last) {
            breaks.push(self.found(last, "rows follow the closing of the log"));
        }
        Ok(())
    }

    /// What was to be asked follows from design and subject.
    fn check_schedule(&self, breaks: &mut Vec<Break>) -> Result<(), ExperimentError> {
        let procedure = Procedure::of(self.design, &self.sidecar.subject())?;
        if self.sidecar.schedule() != schedule(self.design, &procedure) {
            let what = "its schedule is not the one that follows from its design and subject";
            breaks.push(self.found(None, what));
        }
        Ok(())
    }

    /// What can be worked out from a row is what stands in it.
    fn check_cells(&self, breaks: &mut Vec<Break>) {
        let subject = self.sidecar.subject();
        let names = column_names(self.design, self.sidecar.schema_version());
        let all = column_names(self.design, crate::record::SCHEMA_VERSION);
        for (row, record) in rows_of_trials(self.table).zip(self.records) {
            let cells = record.cells(self.design, &subject);
            for name in names
                .iter()
                .filter(|name| !NOT_COMPARED.contains(&name.as_str()))
            {
                let at = all.iter().position(|known| known == name);
                let expected = at.and_then(|at| cells.get(at)).map_or("", String::as_str);
                let held = self.table.text(name).map_or("", |cells| cells[row]);
                if held != expected.replace(['\n', '\r'], " ") {
                    let what = format!("{name} is {held:?}; the rest of the row says {expected:?}");
                    breaks.push(self.found(Some(self.table.line_of(row)), what));
                }
            }
        }
    }

    /// How trials were explored is what their rows name.
    fn check_paths(&self, breaks: &mut Vec<Break>) {
        for (row, record) in rows_of_trials(self.table).zip(self.records) {
            let named = &record.presentation.path_sha256;
            if named.is_empty() {
                continue;
            }
            let file = path_file(self.log, &record.trial, record.attempt);
            let what = match files::read(&file) {
                Ok(bytes) if sha256_hex([&bytes[..]]) == *named => continue,
                Ok(_) => format!("{} is not the path that the row names", file.display()),
                Err(error) => error.to_string(),
            };
            breaks.push(self.found(Some(self.table.line_of(row)), what));
        }
    }

    /// Trials follow each other as the design asks.
    fn check_course(&self, breaks: &mut Vec<Break>) {
        if let Err(error) = Course::resume(self.design, &self.sidecar.subject(), self.records) {
            breaks.push(self.found(None, error.to_string()));
        }
    }
}
