//! The design at hand as its file would have it, and the steps that led to it.
//!
//! What is edited is text: every block of the builder changes keys of it, and whatever reads it is
//! the reader of files.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Deserializer, Serialize};

use crate::bench::history::{History, Moment, StepList};
use crate::bench::recovery::Unsaved;
use selvedge_experiment::ExperimentError;
use selvedge_experiment::design::Design;
use selvedge_foundation::files::{self, EditedKeys, FileError};

/// Which design is taken.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(into = "PathBuf")]
pub(crate) enum Chosen {
    /// One of the program.
    Shipped(&'static str),
    /// The one in a file.
    File(PathBuf),
    /// A new one, which has no file yet.
    New,
}

/// What a new design begins with: which of two textiles is the rougher?
const NEW: &str = "study = \"study\"
experiment = \"pairs\"
title = \"A new study\"
medium = \"array\"
seed = 1
textiles = [\"silk-crepe\", \"wool-twill\"]

[presentation]
kind = \"pair\"

[question]
text = \"choose the rougher one\"

[response]
kind = \"choice\"

[order]
repeats = 4
";

impl From<PathBuf> for Chosen {
    fn from(path: PathBuf) -> Self {
        if path.as_os_str().is_empty() {
            return Self::New;
        }
        let shipped = Design::shipped_names().find(|name| path == Path::new(name));
        shipped.map_or(Self::File(path), Self::Shipped)
    }
}

impl<'de> Deserialize<'de> for Chosen {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        PathBuf::deserialize(from).map(Self::from)
    }
}

impl From<Chosen> for PathBuf {
    fn from(chosen: Chosen) -> Self {
        chosen.path().to_owned()
    }
}

impl Chosen {
    /// What its library is relative to.
    pub(crate) fn path(&self) -> &Path {
        match self {
            Self::Shipped(name) => Path::new(name),
            Self::File(path) => path,
            Self::New => Path::new(""),
        }
    }

    /// What people call it.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::New => "a new design".to_owned(),
            chosen => chosen.path().display().to_string(),
        }
    }

    /// The same as a word that is kept for the next run, where it can be written as one.
    pub(crate) fn word(&self) -> Option<String> {
        match self {
            Self::Shipped(name) => Some((*name).to_owned()),
            Self::File(path) => std::path::absolute(path).ok()?.to_str().map(str::to_owned),
            Self::New => None,
        }
    }

    /// What such a word stands for: a design of the program, or a file that is still there.
    pub(crate) fn from_word(word: &str) -> Option<Self> {
        let chosen = Self::from(PathBuf::from(word));
        let is_there = |path: &Path| {
            matches!(chosen, Self::Shipped(_)) || path.is_absolute() && path.is_file()
        };
        is_there(chosen.path()).then_some(chosen)
    }

    /// What of its text a file holds.
    fn saved(&self, text: &str) -> String {
        if *self == Self::New {
            return String::new();
        }
        text.to_owned()
    }

    /// Its text.
    fn read(&self) -> Result<String, FileError> {
        match self {
            Self::New => Ok(NEW.to_owned()),
            Self::Shipped(name) => Ok(Design::shipped_text(name).unwrap_or_default().to_owned()),
            Self::File(path) => files::read_text(path),
        }
    }
}

/// What a step changes: changes of the same in one gesture are one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Target {
    /// A key: a hash of where it stands.
    Key(u64),
    /// The text, typed.
    Text,
    /// All of it.
    All,
}

/// A text, and where it came from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Written {
    chosen: Chosen,
    text: String,
}

/// What is written down of a design that no file holds.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Work {
    written: Written,
    saved: String,
    history: History<Written, Target>,
}

/// What is wrong with a design.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    /// In one line.
    pub(crate) line: String,
    /// The table that it is in; empty for none.
    pub(crate) table: String,
}

/// A design while it is edited.
#[derive(Debug)]
pub(crate) struct StudyText {
    now: Written,
    /// What its file holds.
    saved: String,
    history: History<Written, Target>,
    keys: Result<EditedKeys, String>,
    design: Result<Box<Design>, Fault>,
}

impl Default for StudyText {
    fn default() -> Self {
        let first = Design::shipped_names().next().unwrap_or_default();
        let text = Design::shipped_text(first).unwrap_or_default().to_owned();
        let saved = text.clone();
        let chosen = Chosen::Shipped(first);
        Self::of(Written { chosen, text }, saved, History::default())
    }
}

impl StudyText {
    fn of(now: Written, saved: String, history: History<Written, Target>) -> Self {
        let (keys, design) = read(&now);
        Self {
            now,
            saved,
            history,
            keys,
            design,
        }
    }

    /// Which design it is.
    pub(crate) fn chosen(&self) -> &Chosen {
        &self.now.chosen
    }

    /// The text.
    pub(crate) fn text(&self) -> &str {
        &self.now.text
    }

    /// The text key by key, or why it is no such text.
    pub(crate) fn keys(&self) -> Result<&EditedKeys, &str> {
        self.keys.as_ref().map_err(String::as_str)
    }

    /// The design, or what is wrong with it.
    pub(crate) fn design(&self) -> Result<&Design, &Fault> {
        self.design.as_deref()
    }

    /// Whether its file holds something else, or there is none.
    pub(crate) fn is_changed(&self) -> bool {
        self.now.text != self.saved
    }

    /// The steps that led here.
    pub(crate) fn steps(&self) -> StepList {
        self.history.steps(&self.now)
    }

    /// Takes steps back or brings them again until so many are done.
    pub(crate) fn step_to(&mut self, n_done: usize) {
        let chosen = self.now.chosen.clone();
        self.history.step_to(n_done, &mut self.now);
        if self.now.chosen != chosen {
            self.saved = self
                .now
                .chosen
                .saved(&self.now.chosen.read().unwrap_or_default());
        }
        (self.keys, self.design) = read(&self.now);
    }

    /// Takes another design.
    ///
    /// # Errors
    /// Its file cannot be read.
    pub(crate) fn choose(&mut self, chosen: Chosen) -> Result<(), String> {
        let text = chosen.read().map_err(|error| error.to_string())?;
        self.saved = chosen.saved(&text);
        let name = format!("chose {}", chosen.name());
        self.change(
            Written { chosen, text },
            Target::All,
            &name,
            Moment::default(),
        );
        Ok(())
    }

    /// What led here is no step of this run.
    pub(crate) fn begin_here(&mut self) {
        self.history = History::default();
    }

    /// Changes the text to one that was typed, or in which keys were set.
    pub(crate) fn write(&mut self, text: String, (target, name): (Target, &str), now: Moment) {
        let chosen = self.now.chosen.clone();
        self.change(Written { chosen, text }, target, name, now);
    }

    fn change(&mut self, written: Written, target: Target, name: &str, now: Moment) {
        if written == self.now {
            return;
        }
        self.history.begin(&self.now, target, name, now);
        if target == Target::All {
            self.history.settle();
        }
        self.now = written;
        (self.keys, self.design) = read(&self.now);
    }

    /// Writes the file.
    ///
    /// # Errors
    /// It cannot be written, in one line; what is at hand stays.
    pub(crate) fn save(&mut self, path: &Path) -> Result<(), String> {
        files::write_atomic(path, self.now.text.as_bytes()).map_err(|error| error.to_string())?;
        self.saved.clone_from(&self.now.text);
        let before = self.now.chosen.clone();
        self.now.chosen = Chosen::File(path.to_owned());
        // What was a step to this text is one in its file from now on.
        let now = &self.now.chosen;
        self.history.change_all(|written| {
            if written.chosen == before {
                written.chosen.clone_from(now);
            }
        });
        (self.keys, self.design) = read(&self.now);
        Ok(())
    }

    /// What no file holds, with every step.
    pub(crate) fn unsaved(&self) -> Option<Unsaved> {
        if !self.is_changed() {
            return None;
        }
        let steps = self.steps();
        let name = format!("Study design ({})", self.now.chosen.name());
        let last = steps.undo().unwrap_or("none");
        let what = format!("{} steps, the last: {last}", steps.n_done);
        let whole = |history| Work {
            written: self.now.clone(),
            saved: self.saved.clone(),
            history,
        };
        Some(Unsaved::with_steps(name, &what, &self.history, whole))
    }

    /// The text of such work.
    pub(crate) fn restored(work: Work) -> Self {
        Self::of(work.written, work.saved, work.history)
    }
}

type Read = (Result<EditedKeys, String>, Result<Box<Design>, Fault>);

fn read(written: &Written) -> Read {
    let path = written.chosen.path();
    let keys = EditedKeys::parse(&written.text, path).map_err(|error| error.to_string());
    let design = Design::from_toml(&written.text, path).map(Box::new);
    let fault = |error: ExperimentError| Fault {
        table: match &error {
            ExperimentError::File(FileError::Content { line, .. }) => {
                table_of_line(&written.text, *line)
            }
            _ => String::new(),
        },
        line: error.to_string(),
    };
    (keys, design.map_err(fault))
}

/// The table that a line of a text stands in, by the last heading up to it.
fn table_of_line(text: &str, line: usize) -> String {
    let headings = text.lines().take(line).filter_map(|line| {
        let name = line.trim().strip_prefix('[')?.trim_start_matches('[');
        name.split_once(']').map(|(name, _)| name.trim().to_owned())
    });
    headings.last().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    fn changed(from: &str, to: &str) -> StudyText {
        let mut study = StudyText::default();
        let text = study.text().replace(from, to);
        study.write(text, (Target::Text, "text"), Moment::default());
        study
    }

    #[test]
    fn a_fault_is_placed_in_its_table_and_goes_with_the_step() {
        let mut study = changed("kind = \"rank\"", "kind = \"rang\"");
        let fault = study.design().unwrap_err();
        assert_eq!(fault.table, "response", "{fault:?}");
        assert!(study.keys().is_ok() && study.is_changed());
        study.step_to(0);
        assert!(study.design().is_ok() && !study.is_changed());
        let study = changed("[response]", "[response");
        assert!(study.keys().is_err() && study.design().is_err());
    }

    #[test]
    fn choosing_another_design_loses_no_change() {
        let mut study = changed("seed = ", "seed = 1");
        let text = study.text().to_owned();
        study.choose(Chosen::Shipped("rating")).unwrap();
        assert!(!study.is_changed());
        study.step_to(1);
        assert_eq!((study.text(), study.is_changed()), (text.as_str(), true));
        assert!(study.choose(Chosen::File("/nowhere.toml".into())).is_err());
        assert_eq!(study.text(), text, "what cannot be read changes nothing");
        study.choose(Chosen::New).unwrap();
        assert!(
            study.design().is_ok() && study.is_changed(),
            "no file holds it"
        );
    }

    #[test]
    fn what_is_unsaved_comes_back_with_its_steps_and_is_saved_as_a_file() {
        let folder = ScratchFolder::made("study-text");
        let study = changed("seed = ", "seed = 1");
        let unsaved = study.unsaved().unwrap();
        let mut again = StudyText::restored(unsaved.read().unwrap());
        assert_eq!((again.text(), again.steps()), (study.text(), study.steps()));
        let path = folder.join("own.toml");
        again.save(&path).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), study.text());
        assert!(again.unsaved().is_none() && *again.chosen() == Chosen::File(path.clone()));
        again.step_to(0);
        assert_eq!(again.chosen(), &Chosen::File(path), "it is the same file's");
        assert!(again.is_changed());
    }
}
