//! The file beside a log, which is written once: the design as it was, what was to be asked, by
//! which program, on what, and what the columns hold.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::chain::Chain;
use super::origin::{DesignFolder, Origin};
use crate::design::{Design, Subject};
use crate::record::{Mark, MarkKind, SCHEMA_VERSION, describe_trial, dictionary};
use crate::{ExperimentError, Procedure};
use selvedge_foundation::files::{self, FileError};
use selvedge_foundation::numerics::Random;
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
    /// Whether nobody was to feel anything.
    #[serde(skip_serializing_if = "std::ops::Not::not", default)]
    is_pilot: bool,
    /// The generator of all chance.
    #[serde(default)]
    generator: String,
    /// What was to be asked, a line a trial; what follows from the answers is not known before.
    #[serde(default)]
    schedule: Vec<String>,
    /// SHA-256 by what was hashed: program, plan, library, scene, profile, certificate.
    #[serde(default)]
    sha256: BTreeMap<String, String>,
    /// How far levels of textiles may be off that were not measured, in words by id.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    uncertain: BTreeMap<String, String>,
    columns: BTreeMap<String, String>,
}

/// One time that the session was opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Opening {
    /// When, UTC as RFC 3339.
    pub utc: String,
    /// The device.
    pub device: String,
    /// Trials that were there.
    pub rows: usize,
    /// Where a row that was not complete was put.
    pub set_aside: Option<String>,
}

impl Opening {
    /// An opening of a log with so many rows.
    pub fn at(when: SystemTime, device: &str, rows: usize) -> Self {
        Self {
            utc: rfc3339(when),
            device: device.to_owned(),
            rows,
            set_aside: None,
        }
    }

    /// Its row.
    pub(super) fn mark(&self) -> Mark {
        let aside = self.set_aside.as_ref();
        let note = aside.map_or_else(String::new, |path| format!("{ASIDE}{path}"));
        Mark {
            kind: MarkKind::Opening,
            utc: self.utc.clone(),
            device: self.device.clone(),
            note,
            rows: self.rows,
        }
    }

    /// What such a row says.
    pub(super) fn of(mark: &Mark) -> Self {
        Self {
            utc: mark.utc.clone(),
            device: mark.device.clone(),
            rows: mark.rows,
            set_aside: mark.note.strip_prefix(ASIDE).map(str::to_owned),
        }
    }
}

/// What a note on a row that was cut off begins with.
const ASIDE: &str = "a row was cut off and put into ";

impl Sidecar {
    pub(crate) fn of(design: &Design, subject: &Subject, procedure: &Procedure) -> Self {
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
            n_trials_at_most: procedure.n_trials(),
            design_sha256: design.hash.clone(),
            design: design.text.clone(),
            design_folder: None,
            is_pilot: false,
            generator: Random::NAME.to_owned(),
            schedule: schedule(design, procedure),
            sha256: BTreeMap::new(),
            uncertain: BTreeMap::new(),
            columns: dictionary(design),
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

    /// Whether nobody was to feel anything.
    pub(super) fn is_pilot(&self) -> bool {
        self.is_pilot
    }

    /// The version of the log's columns.
    pub(crate) fn schema_version(&self) -> u32 {
        self.schema_version
    }

    /// What was to be asked, a line a trial; empty in the first version.
    pub(crate) fn schedule(&self) -> &[String] {
        &self.schedule
    }

    /// SHA-256 of what goes by this name: `library`, `plan`, …
    pub(crate) fn sha256_of(&self, name: &str) -> Option<&str> {
        self.sha256.get(name).map(String::as_str)
    }

    /// Keeps where a library of the user's own is found again, and what the session was begun with.
    pub(super) fn come_from(&mut self, origin: &Origin<'_>, design: &Design, log: &Path) {
        let file = origin.design_file.filter(|_| own_library(design).is_some());
        self.design_folder = file.and_then(|file| DesignFolder::of(file, log));
        self.is_pilot = origin.is_pilot;
        self.uncertain = origin.uncertain.iter().cloned().collect();
        let hashes = origin.sha256.iter();
        self.sha256 = hashes
            .map(|(name, sha256)| ((*name).to_owned(), sha256.clone()))
            .collect();
    }

    /// Writes it beside its log, and begins the chain of the log's rows.
    pub(super) fn write(&self, log: &Path) -> Result<Chain, FileError> {
        let path = log.with_extension("json");
        let text = files::to_json_string(self, &path)?;
        files::write_atomic(&path, text.as_bytes())?;
        Ok(Chain::of_sidecar(text.as_bytes()))
    }
}

/// What is to be asked, a line a trial: `block=1; trial=2; …` in the words of the columns.
pub(crate) fn schedule(design: &Design, procedure: &Procedure) -> Vec<String> {
    let trials = procedure.listed().iter();
    trials.map(|trial| describe_trial(design, trial)).collect()
}

/// The library that a design names, unless it is part of the program.
fn own_library(design: &Design) -> Option<PathBuf> {
    let library = design.library.as_ref();
    library.filter(|named| !is_of_the_program(named)).cloned()
}
