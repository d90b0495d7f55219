//! A session on disk: every trial is in its log before the next begins, and a session that was
//! interrupted goes on where its log ends.
//!
//! ```text
//! STUDY_EXPERIMENT_SUBJECT_1.csv      one row a trial, append-only
//! STUDY_EXPERIMENT_SUBJECT_1.json     design, columns, every opening
//! STUDY_EXPERIMENT_SUBJECT_1-paths/   how each trial was explored: path files to be replayed, and
//!                                     what pointer or tablet reported, at its own rate
//! ```
//!
//! The path of a trial is written before its row: a row that is there has all that belongs to it.

mod files;
mod found;
mod origin;
mod sidecar;
mod whole;

use std::path::Path;
use std::time::SystemTime;

pub(crate) use files::make_folder;
pub use files::{log_path, path_file, samples_file};
pub use found::{Found, Unread, find_sessions};
pub use origin::Origin;
pub use sidecar::{Opening, Sidecar};
pub(crate) use whole::{unwritten, write_whole};

use super::ExperimentError;
use super::course::{Course, Step};
use super::design::{Design, Subject, is_name};
use super::record::{Apparatus, Outcome, Record, Timing, column_names, read_records};
use super::trial::Answer;
use selvedge_engine::RecordedSample;
use selvedge_foundation::files::{FileError, Journal, Reopened};
use selvedge_render::scene::ExplorationPath;

/// A session that is being held.
#[derive(Debug)]
pub struct Session {
    design: Design,
    subject: Subject,
    course: Course,
    journal: Journal,
    sidecar: Sidecar,
    n_rows: usize,
}

/// What is known of a trial besides its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Circumstances<'a> {
    /// When it began and was answered.
    pub timing: Timing,
    /// What presented it.
    pub apparatus: Apparatus,
    /// What the experimenter noted.
    pub note: &'a str,
    /// How it was explored, if that was recorded.
    pub path: Option<&'a ExplorationPath>,
    /// What pointer or tablet reported meanwhile, at its own rate.
    pub samples: &'a [RecordedSample],
}

impl Session {
    /// Begins a session in a folder, which is made where it is missing. A library that the design
    /// names is found again from where the design came from.
    ///
    /// # Errors
    /// The pseudonym is no name, this session was begun before, or it cannot be written.
    pub fn create<'a>(
        folder: &Path,
        design: Design,
        subject: Subject,
        origin: impl Into<Origin<'a>>,
    ) -> Result<Self, ExperimentError> {
        let origin = origin.into();
        check_pseudonym(&subject.pseudonym)?;
        make_folder(folder)?;
        let course = Course::begin(&design, &subject)?;
        let path = log_path(folder, &design, &subject);
        let names = column_names(&design);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let journal = match Journal::create(&path, &names) {
            Err(FileError::Exists { .. }) if !path.with_extension("json").exists() => {
                never_begun(&path, &names)?
            }
            journal => journal?,
        };
        let mut sidecar = Sidecar::of(&design, &subject, course.progress().1);
        sidecar.come_from(&origin, &design, &path);
        sidecar.open(Opening::at(SystemTime::now(), origin.device, 0));
        sidecar.write(&path)?;
        Ok(Self {
            design,
            subject,
            course,
            journal,
            sidecar,
            n_rows: 0,
        })
    }

    /// Opens a session again by its log: what was answered is answered, the next trial waits.
    ///
    /// # Errors
    /// It cannot be read or written, another process writes it, or a row is not of its design.
    pub fn resume(log: &Path, device: &str) -> Result<Self, ExperimentError> {
        let mut sidecar = Sidecar::read(log)?;
        let (design, subject) = (sidecar.design(log)?, sidecar.subject());
        let names = column_names(&design);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let Reopened {
            journal,
            table,
            set_aside,
        } = Journal::reopen(log, &names)?;
        let records = read_records(&design, &table, log)?;
        let course = Course::resume(&design, &subject, &records)?;
        let mut opening = Opening::at(SystemTime::now(), device, records.len());
        opening.after_utc = records.last().map(|last| last.timing.response_utc.clone());
        opening.set_aside = set_aside.map(|path| path.display().to_string());
        sidecar.open(opening);
        sidecar.write(log)?;
        Ok(Self {
            design,
            subject,
            course,
            journal,
            sidecar,
            n_rows: records.len(),
        })
    }

    /// The design.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Who takes part.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// What the session was opened with, this time last.
    pub fn openings(&self) -> &[Opening] {
        self.sidecar.openings()
    }

    /// The file of rows.
    pub fn log(&self) -> &Path {
        self.journal.path()
    }

    /// Rows that are on disk.
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// What happens now.
    pub fn step(&self) -> Step<'_> {
        self.course.step()
    }

    /// Trials answered and trials there will be at most, practice included.
    pub fn progress(&self) -> (usize, usize) {
        self.course.progress()
    }

    /// Which attempt at the trial that waits this is, from 1.
    pub fn attempt(&self) -> u32 {
        self.course.attempt()
    }

    /// Goes on from instructions, a movement or a break.
    pub fn pass(&mut self) {
        self.course.pass();
    }

    /// Answers the trial that waits. It is on disk when this returns, and the trial waits on if it
    /// could not be written: answer again once the disk has room.
    ///
    /// # Errors
    /// It is no answer to the trial, or it cannot be written.
    pub fn answer(
        &mut self,
        answer: &Answer,
        circumstances: &Circumstances<'_>,
    ) -> Result<Option<bool>, ExperimentError> {
        let mut next = self.course.clone();
        let is_correct = next.answer(answer)?;
        let outcome = Outcome::Answered(answer.clone());
        self.write(outcome, is_correct, circumstances)?;
        self.course = next;
        Ok(is_correct)
    }

    /// Gives the trial that waits up, on disk too; it comes again as another attempt.
    ///
    /// # Errors
    /// No trial waits, or it cannot be written.
    pub fn abort(&mut self, circumstances: &Circumstances<'_>) -> Result<(), ExperimentError> {
        self.write(Outcome::Aborted, None, circumstances)?;
        self.course.abort();
        Ok(())
    }

    fn write(
        &mut self,
        outcome: Outcome,
        is_correct: Option<bool>,
        circumstances: &Circumstances<'_>,
    ) -> Result<(), ExperimentError> {
        let Step::Trial(trial) = self.course.step() else {
            let mend = "go on to the trial first";
            return Err(ExperimentError::value("no trial waits", mend));
        };
        let record = Record {
            trial: trial.clone(),
            attempt: self.course.attempt(),
            outcome,
            is_correct,
            timing: circumstances.timing.clone(),
            apparatus: circumstances.apparatus.clone(),
            note: circumstances.note.to_owned(),
        };
        if let Some(path) = circumstances.path {
            self.write_path(path, &record)?;
        }
        if !circumstances.samples.is_empty() {
            let file = samples_file(self.log(), &record.trial, record.attempt);
            files::write_samples(circumstances.samples, &file)?;
        }
        let cells = record.cells(&self.design, &self.subject);
        let cells: Vec<&str> = cells.iter().map(String::as_str).collect();
        self.journal.append(&cells)?;
        self.n_rows += 1;
        Ok(())
    }

    fn write_path(&self, path: &ExplorationPath, record: &Record) -> Result<(), ExperimentError> {
        let file = path_file(self.log(), &record.trial, record.attempt);
        let folder = file.parent().unwrap_or_else(|| Path::new("."));
        make_folder(folder)?;
        path.write(&file)
            .map_err(|error| ExperimentError::value(error.to_string(), "answer again"))
    }
}

/// A log whose sidecar was never written, since the program ended between the two: it has no row.
fn never_begun(path: &Path, names: &[&str]) -> Result<Journal, FileError> {
    let reopened = Journal::reopen(path, names)?;
    if reopened.table.n_rows() == 0 {
        return Ok(reopened.journal);
    }
    Err(FileError::Exists {
        path: path.to_owned(),
    })
}

fn check_pseudonym(pseudonym: &str) -> Result<(), ExperimentError> {
    if is_name(pseudonym) {
        return Ok(());
    }
    let mend = "give 1 to 64 letters, digits, - and _: files are named by it, and no real name";
    Err(ExperimentError::value(
        format!("the subject is {pseudonym:?}"),
        mend,
    ))
}

#[cfg(test)]
mod crash_tests;
#[cfg(test)]
pub(super) mod tests;
