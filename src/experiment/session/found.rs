//! Sessions in a folder, as analyses read them.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::Sidecar;
use super::verify::{Break, Evidence};
use crate::design::{Design, Subject};
use crate::record::{MarkKind, Record, column_names, read_marks, read_records};
use crate::{Course, ExperimentError, FrozenPlan, Participant, Participants};
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
    /// What shows that its files are not as they were written.
    pub breaks: Vec<Break>,
    /// Whether every trial was answered and the log was closed; of the first version, that every
    /// trial was answered.
    pub is_closed: bool,
    /// SHA-256 of the plan that it was held by, if it was by one.
    pub(crate) plan_sha256: Option<String>,
    /// What was told of who took part.
    pub(crate) participant: Option<Participant>,
    /// The plan that lies beside it.
    pub(crate) plan: Option<FrozenPlan>,
    /// What its trials were made from, as its sidecar says.
    pub(crate) library_sha256: Option<String>,
    /// A path whose folder the library of its design is relative to; `None` where it is gone.
    pub(crate) design_file: Option<PathBuf>,
}

/// A log that cannot be read.
#[derive(Debug)]
pub struct Unread {
    /// The log.
    pub log: PathBuf,
    /// What is wrong, where, and how to mend it.
    pub error: ExperimentError,
}

impl Found {
    /// Every session in a folder, by name, and the logs that cannot be read.
    ///
    /// What a later version wrote, or what was damaged, does not keep the others from being read.
    /// Tables without a sidecar are no sessions, unless they begin as logs do.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn in_folder(folder: &Path) -> Result<(Vec<Self>, Vec<Unread>), ExperimentError> {
        let (mut found, mut unread) = (Vec::new(), Vec::new());
        // A table that is damaged keeps no session from being read.
        let participants = Participants::read(folder).unwrap_or_default();
        for log in logs(folder)? {
            match Self::read(&log) {
                Ok(session) => found.push(Self {
                    participant: participants.find(&session.subject.pseudonym).cloned(),
                    ..session
                }),
                Err(error) => unread.push(Unread { log, error }),
            }
        }
        Ok((found, unread))
    }
}

fn logs(folder: &Path) -> Result<Vec<PathBuf>, ExperimentError> {
    let entries = fs::read_dir(folder).map_err(|source| FileError::Read {
        path: folder.to_owned(),
        source,
    })?;
    let is_log = |path: &PathBuf| {
        path.extension().is_some_and(|extension| extension == "csv")
            && (path.with_extension("json").is_file() || begins_as_log(path))
    };
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    let mut logs: Vec<PathBuf> = paths.filter(is_log).collect();
    logs.sort();
    Ok(logs)
}

/// Whether a table begins as logs do, whose sidecar may have been lost.
fn begins_as_log(path: &Path) -> bool {
    const BEGIN: &[u8] = b"schema_version,";
    let mut bytes = [0; BEGIN.len()];
    let read = fs::File::open(path).and_then(|mut file| file.read_exact(&mut bytes));
    read.is_ok() && bytes == BEGIN
}

impl Found {
    /// A whole session whose rows are known, as it would be found.
    pub(crate) fn of_records(
        log: PathBuf,
        (design, subject): (&Design, Subject),
        records: Vec<Record>,
    ) -> Self {
        Self {
            log,
            subject,
            design: design.clone(),
            records,
            has_torn_row: false,
            breaks: Vec::new(),
            is_closed: true,
            plan_sha256: None,
            plan: None,
            library_sha256: None,
            design_file: None,
            participant: None,
        }
    }

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
        let names = column_names(&design, sidecar.schema_version());
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let table = Table::read(&text[..complete], log, &names, &[])?;
        let records = read_records(&design, &table, log)?;
        let evidence = Evidence {
            log,
            text: &text,
            sidecar: &sidecar,
            design: &design,
            table: &table,
            records: &records,
        };
        let breaks = evidence.breaks()?;
        let is_old = sidecar.schema_version() == 1;
        let is_over = || {
            let course = Course::resume(&design, &subject, &records);
            course.is_ok_and(|course| course.is_over())
        };
        let marks = read_marks(&table, log)?;
        let is_closed = marks.iter().any(|mark| mark.kind == MarkKind::Closing);
        let is_closed = is_closed || is_old && is_over();
        let folder = log.parent().unwrap_or_else(|| Path::new(""));
        let plan = FrozenPlan::find(folder, &design)?;
        Ok(Self {
            log: log.to_owned(),
            subject,
            breaks,
            design,
            records,
            has_torn_row: complete < text.len(),
            is_closed,
            plan_sha256: sidecar.sha256_of("plan").map(str::to_owned),
            library_sha256: sidecar.sha256_of("library").map(str::to_owned),
            design_file: sidecar.design_file(log).ok(),
            participant: None,
            plan,
        })
    }
}
