//! The form that a session begins with, and the sessions of its folder.

use std::path::{Path, PathBuf};

use crate::app::task::Task;
use crate::experiment::Course;
use crate::experiment::design::{Design, Subject, is_name};
use crate::experiment::session::{Found, find, log_path};

/// Which design is taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Chosen {
    /// One of the program.
    Shipped(&'static str),
    /// The one in a file.
    File(PathBuf),
}

impl Chosen {
    /// What its library is relative to.
    pub(crate) fn path(&self) -> &Path {
        match self {
            Self::Shipped(name) => Path::new(name),
            Self::File(path) => path,
        }
    }

    fn read(&self) -> Result<Design, String> {
        match self {
            Self::Shipped(name) => {
                let text = Design::shipped_text(name).unwrap_or_default();
                Design::from_toml(text, Path::new(name))
            }
            Self::File(path) => Design::read(path),
        }
        .map_err(|error| error.to_string())
    }
}

/// What the next session is to be.
#[derive(Debug)]
pub(crate) struct Form {
    /// The design that was chosen.
    pub(crate) chosen: Chosen,
    /// The same as it was read.
    pub(crate) design: Result<Box<Design>, String>,
    /// Pseudonym of the participant.
    pub(crate) pseudonym: String,
    /// Which session of this participant, from 1.
    pub(crate) session: String,
    /// Where sessions lie.
    pub(crate) folder: String,
    /// Why the last attempt to begin failed.
    pub(crate) failure: Option<String>,
    /// The sessions of the folder, as far as they were listed.
    pub(crate) found: Vec<Row>,
    /// They are being listed.
    pub(crate) listing: Option<Task<Vec<Row>>>,
}

/// A session that was begun.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Row {
    /// Its log.
    pub(crate) log: PathBuf,
    /// The design's title.
    pub(crate) title: String,
    /// Who took part.
    pub(crate) subject: Subject,
    /// Trials answered and trials there are at most.
    pub(crate) progress: (usize, usize),
}

impl Default for Form {
    fn default() -> Self {
        let first = Design::shipped_names().next().unwrap_or_default();
        let chosen = Chosen::Shipped(first);
        Self {
            design: chosen.read().map(Box::new),
            chosen,
            pseudonym: String::new(),
            session: "1".to_owned(),
            folder: String::new(),
            failure: None,
            found: Vec::new(),
            listing: None,
        }
    }
}

impl Form {
    /// Takes another design.
    pub(crate) fn choose(&mut self, chosen: Chosen) {
        self.design = chosen.read().map(Box::new);
        self.chosen = chosen;
        self.failure = None;
    }

    /// Why no session can begin yet, if so.
    pub(crate) fn refusal(&self) -> Option<String> {
        if let Err(line) = &self.design {
            return Some(line.clone());
        }
        if !is_name(self.pseudonym.trim()) {
            let mend = "Give a pseudonym of letters, digits, - and _, and no real name";
            return Some(mend.to_owned());
        }
        if self.session_number().is_none() {
            return Some("Number the sessions of a participant from 1".to_owned());
        }
        if self.folder.trim().is_empty() {
            return Some("Say in which folder the session is kept".to_owned());
        }
        None
    }

    /// What begins: the design, who takes part but for the number in the study, and where.
    pub(crate) fn told(&self) -> Option<(Design, Subject, PathBuf)> {
        if self.refusal().is_some() {
            return None;
        }
        let design = self.design.as_deref().ok()?.clone();
        let subject = Subject {
            pseudonym: self.pseudonym.trim().to_owned(),
            nth: 0,
            session: self.session_number()?,
        };
        Some((design, subject, self.folder()))
    }

    /// Where sessions lie.
    pub(crate) fn folder(&self) -> PathBuf {
        PathBuf::from(self.folder.trim())
    }

    fn session_number(&self) -> Option<u32> {
        let number = self.session.trim().parse().ok();
        number.filter(|number| *number >= 1)
    }
}

/// The sessions of a folder.
pub(crate) fn list(folder: &Path) -> Result<Vec<Row>, String> {
    if !folder.exists() {
        let folder = folder.display();
        return Err(format!("there is no folder {folder}; check the path"));
    }
    Ok(found_in(folder)?.into_iter().map(row).collect())
}

fn found_in(folder: &Path) -> Result<Vec<Found>, String> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    find(folder).map_err(|error| error.to_string())
}

fn row(found: Found) -> Row {
    let course = Course::resume(&found.design, &found.subject, &found.records);
    let progress = course.map_or((found.records.len(), 0), |course| course.progress());
    Row {
        title: title_of(&found.design),
        log: found.log,
        subject: found.subject,
        progress,
    }
}

/// What people call a design.
pub(crate) fn title_of(design: &Design) -> String {
    if design.title.is_empty() {
        design.experiment.clone()
    } else {
        design.title.clone()
    }
}

/// Which subject of the study this is, from 0: as before, or after all others of the folder.
pub(crate) fn numbered(
    folder: &Path,
    design: &Design,
    mut subject: Subject,
) -> Result<Subject, String> {
    if log_path(folder, design, &subject).exists() {
        let mend = "resume it below, or number another session";
        let (who, nth) = (&subject.pseudonym, subject.session);
        return Err(format!("session {nth} of {who} was begun before; {mend}"));
    }
    let of_study = |found: &Found| {
        found.design.study == design.study && found.design.experiment == design.experiment
    };
    let found: Vec<Subject> = (found_in(folder)?.into_iter())
        .filter(of_study)
        .map(|found| found.subject)
        .collect();
    let known = found
        .iter()
        .find(|other| other.pseudonym == subject.pseudonym);
    let after_all = || found.iter().map(|other| other.nth + 1).max().unwrap_or(0);
    subject.nth = known.map_or_else(after_all, |known| known.nth);
    Ok(subject)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_form_says_what_is_missing_until_a_session_can_begin() {
        let mut form = Form::default();
        assert!(form.refusal().unwrap().contains("pseudonym"));
        form.pseudonym = "Ada Lovelace".to_owned();
        assert!(form.refusal().unwrap().contains("no real name"));
        form.pseudonym = " p07 ".to_owned();
        assert!(form.refusal().unwrap().contains("folder"));
        form.folder = "/tmp/sessions".to_owned();
        form.session = "0".to_owned();
        assert!(form.refusal().unwrap().contains("from 1"));
        form.session = "2".to_owned();
        let (_, subject, _) = form.told().unwrap();
        assert_eq!((subject.pseudonym.as_str(), subject.session), ("p07", 2));
        form.choose(Chosen::File("/nowhere/design.toml".into()));
        assert!(form.told().is_none() && form.refusal().unwrap().contains("nowhere"));
    }
}
