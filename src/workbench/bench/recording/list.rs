//! All recordings: those in the user's own folder, those that the scene refers to, and path files
//! that were opened. What can be done with them stands in `recordings.rs`.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::background::{Executor, Task, finished};
use crate::bench::recording::file::{count, is_written};
use crate::bench::recording::running::Running;
use crate::bench::recording::{About, Recording, name_of};
use selvedge_render::scene::Scene;

/// Where a recording of the list is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Place {
    /// In this folder.
    Folder(PathBuf),
    /// In this folder, and some window records it now.
    Busy(PathBuf),
    /// In this path file, which has no amplitudes.
    PathFile(PathBuf),
    /// Nowhere: the scene refers to what is not there.
    Missing(PathBuf),
    /// In memory alone, the so manieth of them: it could not be written.
    Memory(usize),
}

/// A recording of the list.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    /// What it is.
    pub(crate) about: About,
    /// Where it is.
    pub(crate) place: Place,
}

/// All recordings.
#[derive(Debug, Default)]
pub(crate) struct Recordings {
    /// The folder that they lie in; `None` on a system without such a place.
    pub(crate) root: Option<PathBuf>,
    /// Newest first.
    pub(crate) entries: Vec<Entry>,
    /// The one that is being made.
    pub(crate) running: Option<Running>,
    /// Path files that were opened.
    pub(crate) opened: Vec<PathBuf>,
    pub(crate) in_memory: Vec<Recording>,
    /// Names of deleted ones, where they were and where they are.
    pub(crate) deleted: Vec<(String, [PathBuf; 2])>,
    listing: Option<Task<Vec<Entry>>>,
    /// What was listed last: the references and opened files.
    listed: Option<Vec<PathBuf>>,
    pub(crate) loading: Option<(Task<Recording>, Then)>,
    /// A part on its way to being one.
    pub(crate) cutting: Option<Task<String>>,
    pub(crate) comparing: Option<Task<[Recording; 2]>>,
    /// The two that are set against each other.
    pub(crate) compared: Option<[Recording; 2]>,
}

/// What is to be done with a recording once it is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Then {
    Replay,
    Export,
}

impl Recordings {
    /// Those in a folder, which need not be there yet.
    pub(crate) fn in_folder(root: PathBuf) -> Self {
        Self {
            root: Some(root),
            ..Self::default()
        }
    }

    /// Newest first.
    pub(crate) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The name of the one that was deleted last and can be had back.
    pub(crate) fn last_deleted(&self) -> Option<&str> {
        self.deleted.last().map(|(name, _)| name.as_str())
    }

    /// The entry that is this recording.
    pub(crate) fn entry_of(&self, recording: &Recording) -> Option<&Entry> {
        let is_it = |entry: &&Entry| match &entry.place {
            Place::Folder(folder) => recording.folder.as_ref() == Some(folder),
            Place::PathFile(file) => recording.file() == Some(file),
            Place::Memory(nth) => {
                let kept = self.in_memory.get(*nth);
                kept.is_some_and(|kept| Arc::ptr_eq(kept.path(), recording.path()))
            }
            Place::Busy(_) | Place::Missing(_) => false,
        };
        self.entries.iter().find(is_it)
    }

    /// A name that none has: the next number.
    pub(crate) fn next_name(&self) -> String {
        let running = self.running.iter().map(|running| &running.about);
        let abouts = self.entries.iter().map(|entry| &entry.about).chain(running);
        let number = |about: &About| about.name.strip_prefix("Recording ")?.parse::<u32>().ok();
        let last = abouts.filter_map(number).max().unwrap_or(0);
        format!("Recording {}", last.saturating_add(1))
    }

    /// Has the list made anew.
    pub(crate) fn relist(&mut self) {
        self.listed = None;
    }

    /// Lists what is there when something has changed. Once a frame.
    pub(crate) fn follow(&mut self, scene: &Scene, scene_file: Option<&Path>, executor: &Executor) {
        if let Some(Ok(entries)) = finished(&mut self.listing) {
            self.entries = entries;
            let kept = self.in_memory.iter().enumerate();
            let kept = kept.map(|(nth, recording)| Entry {
                about: recording.about().clone(),
                place: Place::Memory(nth),
            });
            self.entries.splice(0..0, kept.rev());
        }
        let referred = scene.recordings.iter();
        let referred = referred.map(|reference| reference.place(scene_file));
        let beside: Vec<PathBuf> = referred.chain(self.opened.iter().cloned()).collect();
        if self.listing.is_some() || self.listed.as_ref() == Some(&beside) {
            return;
        }
        self.listed = Some(beside.clone());
        let root = self.root.clone();
        let task = executor.start("selvedge-recordings", move |_| {
            Ok(list(root.as_deref(), &beside))
        });
        self.listing = Some(task);
        if matches!(executor, Executor::InLine) {
            self.follow(scene, scene_file, executor);
        }
    }
}

/// What lies in a folder, newest first, and then what lies beside it.
pub(crate) fn list(root: Option<&Path>, beside: &[PathBuf]) -> Vec<Entry> {
    let folders = root.and_then(|root| fs::read_dir(root).ok());
    let folders = folders.into_iter().flatten().flatten();
    let mut entries: Vec<Entry> = folders.filter_map(|found| entry_in(found.path())).collect();
    entries.sort_by(|a, b| b.about.began.cmp(&a.about.began));
    for path in beside {
        let is_there = |entry: &Entry| match &entry.place {
            Place::Folder(known)
            | Place::Busy(known)
            | Place::PathFile(known)
            | Place::Missing(known) => known == path,
            Place::Memory(_) => false,
        };
        if entries.iter().any(is_there) {
            continue;
        }
        let nameless = || About {
            name: name_of(path),
            ..About::default()
        };
        entries.push(entry_in(path.clone()).unwrap_or_else(|| Entry {
            about: nameless(),
            place: if path.is_file() {
                Place::PathFile(path.clone())
            } else {
                Place::Missing(path.clone())
            },
        }));
    }
    entries
}

/// The recording in a folder; `None` when there is none. One that was broken off is counted, once.
fn entry_in(folder: PathBuf) -> Option<Entry> {
    let mut about = About::read(&folder).ok()?;
    if about.ticks.is_none() {
        if is_written(&folder) {
            let place = Place::Busy(folder);
            return Some(Entry { about, place });
        }
        let (ticks, outline) = count(&folder).ok()?;
        about.ticks = Some(ticks);
        about.outline = outline;
        // Where that cannot be written it is counted again the next time.
        drop(about.write(&folder));
    }
    let place = Place::Folder(folder);
    Some(Entry { about, place })
}

impl Place {
    /// Its folder or file.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Folder(path) | Self::Busy(path) | Self::PathFile(path) | Self::Missing(path) => {
                Some(path)
            }
            Self::Memory(_) => None,
        }
    }
}
