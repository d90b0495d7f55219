//! A session on disk: every trial is in its log before the next begins, and a session that was
//! interrupted goes on where its log ends.
//!
//! ```text
//! STUDY_EXPERIMENT_SUBJECT_1.csv      one row a trial, and one for every opening and the closing;
//!                                     append-only, each bound to the row before it
//! STUDY_EXPERIMENT_SUBJECT_1.json     design, schedule, columns, hashes; written once
//! STUDY_EXPERIMENT_SUBJECT_1-paths/   how each trial was explored: path files to be replayed, and
//!                                     what pointer or tablet reported, at its own rate
//! ```
//!
//! The path of a trial is written before its row: a row that is there has all that belongs to it.

mod chain;
mod files;
mod found;
mod origin;
mod sidecar;
mod verify;
mod whole;

use std::path::Path;
use std::time::SystemTime;

pub(crate) use files::make_folder;
pub use files::{log_path, path_file, samples_file};
pub use found::{Found, Unread};
pub use origin::Origin;
pub use sidecar::{Opening, Sidecar};
pub use verify::{Break, Verified};
pub(crate) use whole::{unwritten, write_whole};

use super::ExperimentError;
use super::course::{Course, Step};
use super::design::{Design, Subject};
use super::plan::FrozenPlan;
use super::presentation::{Presentation, Validity};
use super::record::{
    Apparatus, Mark, MarkKind, Outcome, Record, SCHEMA_VERSION, Timing, column_names, read_marks,
    read_records, trials,
};
use super::trial::Answer;
use chain::Chain;
use selvedge_engine::RecordedSample;
use selvedge_foundation::files::{FileError, Journal, Reopened, read_text, sha256_hex};
use selvedge_foundation::quantity::rfc3339;
use selvedge_render::scene::ExplorationPath;

/// A session that is being held.
#[derive(Debug)]
pub struct Session {
    design: Design,
    subject: Subject,
    course: Course,
    journal: Journal,
    chain: Chain,
    openings: Vec<Opening>,
    n_rows: usize,
    is_closed: bool,
    is_pilot: bool,
}

/// What is known of a trial besides its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Circumstances<'a> {
    /// When it began and was answered.
    pub timing: Timing,
    /// What presented it.
    pub apparatus: Apparatus,
    /// Whether it was felt.
    pub presentation: Presentation,
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
    /// The pseudonym is no name, this session was begun before, the plan in the folder is for
    /// another text of the design, or it cannot be written.
    pub fn create<'a>(
        folder: &Path,
        design: Design,
        subject: Subject,
        origin: impl Into<Origin<'a>>,
    ) -> Result<Self, ExperimentError> {
        let mut origin = origin.into();
        check_pseudonym(&subject.pseudonym)?;
        make_folder(folder)?;
        let course = Course::begin(&design, &subject)?;
        let plan = FrozenPlan::to_begin(folder, &design)?;
        let path = log_path(folder, &design, &subject);
        let names = column_names(&design, SCHEMA_VERSION);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let journal = match Journal::create(&path, &names) {
            Err(FileError::Exists { .. }) => never_begun(&path, &names)?,
            journal => journal?,
        };
        files::remove_pieces(&path);
        let mut sidecar = Sidecar::of(&design, &subject, course.procedure());
        origin = origin.with("plan", plan.map(|frozen| frozen.sha256));
        sidecar.come_from(&origin, &design, &path);
        let chain = sidecar.write(&path)?;
        let mut session = Self {
            design,
            subject,
            course,
            journal,
            chain,
            openings: Vec::new(),
            n_rows: 0,
            is_closed: false,
            is_pilot: origin.is_pilot,
        };
        session.open(Opening::at(SystemTime::now(), origin.device, 0))?;
        Ok(session)
    }

    /// Opens a session again by its log: what was answered is answered, the next trial waits.
    ///
    /// # Errors
    /// It cannot be read or written, another process writes it, a row is not of its design, or an
    /// earlier version of the program began it.
    pub fn resume(log: &Path, device: &str) -> Result<Self, ExperimentError> {
        let sidecar = Sidecar::read(log)?;
        let (design, subject) = (sidecar.design(log)?, sidecar.subject());
        if sidecar.schema_version() < SCHEMA_VERSION {
            let what = "an earlier version of the program began this session";
            let mend = "end it with that version, or begin another session";
            return Err(FileError::whole(log, what, mend).into());
        }
        let names = column_names(&design, SCHEMA_VERSION);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let Reopened {
            journal,
            table,
            set_aside,
        } = Journal::reopen(log, &names)?;
        files::remove_pieces(log);
        let records = read_records(&design, &table, log)?;
        let marks = read_marks(&table, log)?;
        let course = Course::resume(&design, &subject, &records)?;
        let mut opening = Opening::at(SystemTime::now(), device, records.len());
        opening.set_aside = set_aside.map(|path| path.display().to_string());
        let openings = marks.iter().filter(|mark| mark.kind == MarkKind::Opening);
        let mut session = Self {
            design,
            subject,
            course,
            journal,
            chain: Chain::of_log(log)?,
            openings: openings.map(|mark| Opening::of(&mark.mark)).collect(),
            n_rows: records.len(),
            is_closed: marks.iter().any(|mark| mark.kind == MarkKind::Closing),
            is_pilot: sidecar.is_pilot(),
        };
        if !session.is_closed {
            session.open(opening)?;
            session.close_if_over()?;
        }
        Ok(session)
    }

    fn open(&mut self, opening: Opening) -> Result<(), ExperimentError> {
        self.append(opening.mark().cells(&self.design, &self.subject))?;
        self.openings.push(opening);
        Ok(())
    }

    /// Closes the log once every trial is answered.
    fn close_if_over(&mut self) -> Result<(), ExperimentError> {
        if self.is_closed || !self.course.is_over() {
            return Ok(());
        }
        let last = self.openings.last();
        let closing = Mark {
            kind: MarkKind::Closing,
            utc: rfc3339(SystemTime::now()),
            device: last.map_or_else(String::new, |opening| opening.device.clone()),
            note: String::new(),
            rows: self.n_rows,
        };
        self.append(closing.cells(&self.design, &self.subject))?;
        self.is_closed = true;
        Ok(())
    }

    /// Adds a row that is bound to the one before it.
    fn append(&mut self, cells: Vec<String>) -> Result<(), ExperimentError> {
        let line = self.chain.bound(cells, self.journal.path())?;
        self.journal.append_lines(&line)?;
        self.chain.follow(line.strip_suffix(b"\n").unwrap_or(&line));
        Ok(())
    }

    /// The design.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Who takes part.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Whether nobody is to feel anything.
    pub fn is_pilot(&self) -> bool {
        self.is_pilot
    }

    /// Takes back that it was begun, as long as it has no trial: nothing of it stays but a line in
    /// the folder's table of such.
    ///
    /// # Errors
    /// A trial is there, or its files cannot be removed.
    pub fn undo(self) -> Result<(), ExperimentError> {
        if self.n_rows > 0 {
            let mend = "end it instead; its rows stay";
            return Err(ExperimentError::value("a trial is on disk already", mend));
        }
        let log = self.journal.path().to_owned();
        let (design, subject) = (self.design, self.subject);
        files::note_undone(&log, (&design, &subject))?;
        drop(self.journal);
        Ok(files::remove(&log)?)
    }

    /// What the session was opened with, this time last.
    pub fn openings(&self) -> &[Opening] {
        &self.openings
    }

    /// The file of rows.
    pub fn log(&self) -> &Path {
        self.journal.path()
    }

    /// Trials that are on disk, given up or not.
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
    /// It is no answer to the trial, what it answers was not presented as it should be, or it
    /// cannot be written.
    pub fn answer(
        &mut self,
        answer: &Answer,
        circumstances: &Circumstances<'_>,
    ) -> Result<Option<bool>, ExperimentError> {
        let presentation = &circumstances.presentation;
        if presentation.validity() != Validity::Valid {
            let what = format!(
                "what this answers does not count: {}",
                presentation.why_void()
            );
            return Err(ExperimentError::value(what, "present it again"));
        }
        let mut next = self.course.clone();
        let is_correct = next.answer(answer)?;
        let outcome = Outcome::Answered(answer.clone());
        self.write(outcome, is_correct, circumstances)?;
        self.course = next;
        self.close_if_over()?;
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
        let mut record = Record {
            trial: trial.clone(),
            attempt: self.course.attempt(),
            outcome,
            is_correct,
            timing: circumstances.timing.clone(),
            apparatus: circumstances.apparatus.clone(),
            presentation: circumstances.presentation.clone(),
            note: circumstances.note.to_owned(),
        };
        if let Some(path) = circumstances.path {
            record.presentation.path_sha256 = self.write_path(path, &record)?;
        }
        if !circumstances.samples.is_empty() {
            let file = samples_file(self.log(), &record.trial, record.attempt);
            files::write_samples(circumstances.samples, &file)?;
        }
        self.append(record.cells(&self.design, &self.subject))?;
        self.n_rows += 1;
        Ok(())
    }

    /// Writes how a trial was explored; the hash of the file.
    fn write_path(
        &self,
        path: &ExplorationPath,
        record: &Record,
    ) -> Result<String, ExperimentError> {
        let file = path_file(self.log(), &record.trial, record.attempt);
        let folder = file.parent().unwrap_or_else(|| Path::new("."));
        make_folder(folder)?;
        path.write(&file)
            .map_err(|error| ExperimentError::value(error.to_string(), "answer again"))?;
        Ok(sha256_hex([read_text(&file)?.as_bytes()]))
    }
}

/// Begins a log again in which no trial stands, since the program ended before its sidecar or its
/// first row was written.
fn never_begun(path: &Path, names: &[&str]) -> Result<Journal, FileError> {
    // Not even its header may have been written to its end.
    if std::fs::read(path).is_ok_and(|bytes| bytes.contains(&b'\n')) {
        let table = Journal::reopen(path, names)?.table;
        let is_whole = path.with_extension("json").exists() && table.n_rows() > 0;
        if is_whole || trials(&table).next().is_some() {
            return Err(FileError::Exists {
                path: path.to_owned(),
            });
        }
    }
    std::fs::remove_file(path).map_err(|source| FileError::Write {
        path: path.to_owned(),
        source,
    })?;
    Journal::create(path, names)
}

fn check_pseudonym(pseudonym: &str) -> Result<(), ExperimentError> {
    if Design::is_name(pseudonym) {
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
#[cfg(test)]
mod verify_tests;
