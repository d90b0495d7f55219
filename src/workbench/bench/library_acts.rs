//! What was done with libraries: on a thread, one act after the other, each a step that can be
//! taken back.
//!
//! A state of the libraries says which version stands under each id that was touched since the
//! window began; versions lie beside the textiles, so that going back is putting one in its place.

use std::collections::{BTreeMap, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;

use crate::bench::background::Task;
use crate::bench::history::{History, Moment, StepList};
use crate::bench::keep::{Keep, Listening, NewTextiles, Taken};
use crate::bench::pane::Pane;
use selvedge_textile::{BuiltFile, Change, Library, LibraryFolder, TextileError, called};

/// Which version stands under an id of a folder; `None`: nothing.
pub(crate) type Arrangement = BTreeMap<(LibraryFolder, String), Option<String>>;

/// An act that is wanted of a library; textiles are named by the id by which the scene finds them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum LibraryCommand {
    /// Listen to new textiles of a pane, and then keep them or not.
    Listen(NewTextiles, Pane),
    /// Feel the new textile (0) or what it is compared with (1, 2).
    Feel(usize),
    /// Compare a new textile with another in the first or the second place.
    CompareWith(usize, String),
    /// Keep new textiles.
    Keep(Keep),
    /// Let go of textiles that wait for an answer.
    ForgetKeep,
    /// Call a textile otherwise.
    Rename(String, String),
    /// Copy a textile: in its library, or into the user's own if that is part of the program.
    Duplicate(String),
    /// Take a textile away.
    Remove(String),
    /// Put a version in the place of a textile.
    Restore(LibraryFolder, String, String),
    /// Look at the textiles of this folder too, from now on.
    AddFolder(PathBuf),
    /// No longer.
    ForgetFolder(PathBuf),
}

/// A change of a folder.
#[derive(Debug, Clone)]
pub(crate) enum Deed {
    /// A textile is put in, in the place of the one with that id or beside it.
    Put(String, Vec<BuiltFile>, bool),
    /// A textile of a library is put in under this name, beside what is there.
    Copy(Arc<Library>, String, String),
    /// A textile is called otherwise.
    Rename(String, String),
    /// A version, or nothing, stands under an id.
    Set(String, Option<String>),
}

/// Changes that belong together.
#[derive(Debug, Clone)]
pub(crate) struct Work {
    /// In order.
    pub(crate) deeds: Vec<(LibraryFolder, Deed)>,
    /// What is said of it.
    pub(crate) aim: Aim,
}

/// What changes are for.
#[derive(Debug, Clone)]
pub(crate) enum Aim {
    /// A new step of this name; whether new textiles were kept, and whether the first is felt.
    Step {
        name: String,
        is_kept: bool,
        is_felt: bool,
    },
    /// So many steps are done afterwards.
    StepTo(usize),
}

/// What came of it.
#[derive(Debug)]
pub(crate) struct Worked {
    /// What was changed.
    pub(crate) changes: Vec<(LibraryFolder, Change)>,
    /// The folders as they are now.
    pub(crate) libraries: Vec<Arc<Library>>,
    /// What it was for.
    pub(crate) aim: Aim,
}

/// The acts of a window.
#[derive(Debug, Default)]
pub(crate) struct LibraryActs {
    /// The folder that holds the user's own libraries; a stepped window has none.
    pub(crate) own_folder: Option<PathBuf>,
    /// New textiles that wait for an answer.
    pub(crate) taken: Option<Taken>,
    /// New textiles that are listened to.
    pub(crate) listening: Option<Listening>,
    /// Whether the last thing that was done was done with a library.
    pub(crate) is_last: bool,
    pub(crate) task: Option<Task<Worked>>,
    /// Acts that wait.
    pub(crate) next: VecDeque<LibraryCommand>,
    arrangement: Arrangement,
    history: History<Arrangement, ()>,
}

impl LibraryActs {
    /// Where the user's own textiles lie.
    pub(crate) fn own(&self) -> Option<PathBuf> {
        Some(self.own_folder.as_ref()?.join("textiles"))
    }

    /// The steps that were done.
    pub(crate) fn steps(&self) -> StepList {
        self.history.steps(&self.arrangement)
    }

    /// What leads to the state after so many steps.
    pub(crate) fn work_to(&self, n_done: usize) -> Option<Work> {
        let there = self.history.state_after(n_done, &self.arrangement)?;
        let is_other = |(key, version): &(&(LibraryFolder, String), &Option<String>)| {
            self.arrangement.get(*key) != Some(*version)
        };
        let differing = there.iter().filter(is_other);
        let deed = |((folder, id), version): (&(LibraryFolder, String), &Option<String>)| {
            (folder.clone(), Deed::Set(id.clone(), version.clone()))
        };
        Some(Work {
            deeds: differing.map(deed).collect(),
            aim: Aim::StepTo(n_done),
        })
    }

    /// Notes what was done.
    pub(crate) fn note(&mut self, worked: &Worked) {
        self.is_last = true;
        match &worked.aim {
            Aim::StepTo(n_done) => self.history.step_to(*n_done, &mut self.arrangement),
            Aim::Step { name, .. } => {
                for (folder, change) in &worked.changes {
                    let key = (folder.clone(), change.id.clone());
                    let first = |all: &mut Arrangement| {
                        let before = change.before.clone();
                        all.entry(key.clone()).or_insert(before);
                    };
                    first(&mut self.arrangement);
                    self.history.change_all(first);
                }
                let now = Moment::default();
                self.history.begin(&self.arrangement, (), name, now);
                self.history.settle();
                for (folder, change) in &worked.changes {
                    let key = (folder.clone(), change.id.clone());
                    self.arrangement.insert(key, change.after.clone());
                }
            }
        }
    }
}

impl Work {
    /// Does it.
    ///
    /// # Errors
    /// What could not be done, in a line; what was done before that is taken back.
    pub(crate) fn done(self) -> Result<Worked, String> {
        let mut changes: Vec<(LibraryFolder, Change)> = Vec::with_capacity(self.deeds.len());
        for (folder, deed) in self.deeds {
            match deed.done(&folder) {
                Ok(change) => changes.push((folder, change)),
                Err(error) => {
                    for (folder, change) in changes.iter().rev() {
                        // What cannot be taken back either is still there as a version.
                        drop(folder.restore(&change.id, change.before.as_deref()));
                    }
                    return Err(error.to_string());
                }
            }
        }
        let mut libraries: Vec<Arc<Library>> = Vec::new();
        for (folder, _) in &changes {
            if libraries.iter().all(|known| known.root() != folder.path()) {
                let library = Library::open(folder.path()).map_err(|error| error.to_string())?;
                libraries.push(Arc::new(library));
            }
        }
        Ok(Worked {
            changes,
            libraries,
            aim: self.aim,
        })
    }
}

impl Deed {
    fn done(self, folder: &LibraryFolder) -> Result<Change, TextileError> {
        match self {
            Self::Put(id, files, replaces) => folder.put(&id, &files, replaces),
            Self::Copy(library, id, name) => {
                let files = called(&library.files_of(&id)?, &name)?;
                folder.put(&format!("{id}-copy"), &files, false)
            }
            Self::Rename(id, name) => folder.rename(&id, &name),
            Self::Set(id, version) => folder.restore(&id, version.as_deref()),
        }
    }
}
