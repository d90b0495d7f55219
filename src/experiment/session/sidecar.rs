//! The file beside a log: the design as it was, what the columns hold, when it was opened.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::origin::{DesignFolder, Origin};
use crate::ExperimentError;
use crate::design::{Design, Subject};
use crate::record::{SCHEMA_VERSION, dictionary};
use selvedge_foundation::files::{self, FileError};
use selvedge_foundation::quantity::rfc3339;
use selvedge_textile::is_of_the_program;

/// What the file of a design is called where its own name is not known.
const NAME: &str = "design.toml";

/// What stands beside a log.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sidecar {
    schema_version: u32,
    software: String,
    study: String,
    experiment: String,
    title: String,
    subject: String,
    nth_subject: usize,
    session: u32,
    seed: u64,
    n_trials_at_most: usize,
    design_sha256: String,
    /// The design's file as it was, by which the log is resumed and analysed.
    design: String,
    /// Where the design names a library of the user's own.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    design_folder: Option<DesignFolder>,
    columns: BTreeMap<String, String>,
    openings: Vec<Opening>,
}

/// One time that the session was opened.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Opening {
    /// When, UTC as RFC 3339.
    pub utc: String,
    /// The device.
    pub device: String,
    /// Rows that were there.
    pub rows: usize,
    /// When the last of them was answered, UTC: how long the gap was.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub(crate) after_utc: Option<String>,
    /// Where a row that was not complete was put.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub set_aside: Option<String>,
}

impl Opening {
    /// An opening of a log with so many rows.
    pub fn at(when: SystemTime, device: &str, rows: usize) -> Self {
        Self {
            utc: rfc3339(when),
            device: device.to_owned(),
            rows,
            after_utc: None,
            set_aside: None,
        }
    }
}

impl Sidecar {
    pub(super) fn of(design: &Design, subject: &Subject, n_trials_at_most: usize) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            software: selvedge_foundation::PROGRAM.to_owned(),
            study: design.study.clone(),
            experiment: design.experiment.clone(),
            title: design.title.clone(),
            subject: subject.pseudonym.clone(),
            nth_subject: subject.nth,
            session: subject.session,
            seed: design.seed,
            n_trials_at_most,
            design_sha256: design.hash.clone(),
            design: design.text.clone(),
            design_folder: None,
            columns: dictionary(design),
            openings: Vec::new(),
        }
    }

    /// The sidecar of a log.
    ///
    /// # Errors
    /// It is missing, cannot be read, or was written by a later version.
    pub fn read(log: &Path) -> Result<Self, ExperimentError> {
        let path = log.with_extension("json");
        if !path.exists() {
            let what = "the file beside the log, which holds its design, is missing";
            let mend = "restore it from a copy, or begin another session";
            return Err(FileError::whole(&path, what, mend).into());
        }
        let text = files::read_text(&path)?;
        let sidecar: Self = files::from_json_str(&text, &path)?;
        if sidecar.schema_version > SCHEMA_VERSION {
            let what = format!("the log has version {}", sidecar.schema_version);
            let mend = format!("this program knows up to {SCHEMA_VERSION}: use a later one");
            return Err(FileError::whole(&path, what, mend).into());
        }
        Ok(sidecar)
    }

    /// The design as it was when the session was begun.
    ///
    /// # Errors
    /// It cannot be read, or was changed since.
    pub fn design(&self, log: &Path) -> Result<Design, ExperimentError> {
        let path = log.with_extension("json");
        let design = Design::from_toml(&self.design, &path)?;
        if design.hash == self.design_sha256 {
            return Ok(design);
        }
        let mend = "restore the file: a log is read by the design that it was made with";
        Err(FileError::whole(&path, "its design was changed", mend).into())
    }

    /// A path that the design may be taken to have: its folder is the one that a library is
    /// relative to.
    ///
    /// # Errors
    /// The design cannot be read, or the library that it names is gone.
    pub fn design_file(&self, log: &Path) -> Result<PathBuf, ExperimentError> {
        let named = own_library(&self.design(log)?);
        let folder = self.design_folder.as_ref();
        let mut places = folder.map_or_else(Vec::new, |folder| folder.places(log));
        places.push(log.parent().unwrap_or_else(|| Path::new("")).to_owned());
        let Some(named) = named else {
            return Ok(places[0].join(NAME));
        };
        if let Some(place) = places.iter().find(|place| place.join(&named).exists()) {
            return Ok(place.join(NAME));
        }
        let mut sought: Vec<String> = Vec::new();
        for place in &places {
            let path = place.join(&named).display().to_string();
            if !sought.contains(&path) {
                sought.push(path);
            }
        }
        let what = format!(
            "the library of its design is gone: sought {}",
            sought.join(", ")
        );
        let mend = "put it back there, then resume";
        Err(FileError::whole(log, what, mend).into())
    }

    /// Who took part.
    pub fn subject(&self) -> Subject {
        Subject {
            pseudonym: self.subject.clone(),
            nth: self.nth_subject,
            session: self.session,
        }
    }

    /// Every time that the session was opened, the last one last.
    pub fn openings(&self) -> &[Opening] {
        &self.openings
    }

    /// Keeps where a library of the user's own is found again.
    pub(super) fn come_from(&mut self, origin: &Origin<'_>, design: &Design, log: &Path) {
        let file = origin.design_file.filter(|_| own_library(design).is_some());
        self.design_folder = file.and_then(|file| DesignFolder::of(file, log));
    }

    pub(super) fn open(&mut self, opening: Opening) {
        self.openings.push(opening);
    }

    pub(super) fn write(&self, log: &Path) -> Result<(), FileError> {
        let path = log.with_extension("json");
        let text = files::to_json_string(self, &path)?;
        files::write_atomic(&path, text.as_bytes())
    }
}

/// The library that a design names, unless it is part of the program.
fn own_library(design: &Design) -> Option<PathBuf> {
    let library = design.library.as_ref();
    library.filter(|named| !is_of_the_program(named)).cloned()
}
