//! Work that no file holds yet, kept in the user's state folder against crashes, and offered when
//! the program is started again.
//!
//! ```text
//! <state>/unsaved/PROCESS/work.json   what there is to lose, written as a whole or not at all
//!                        /lock        held as long as the process lives
//! ```
//!
//! Every process has a folder of its own, so that several windows write over nothing. What a
//! process left that lives no longer is offered once. Knows neither scenes nor tools: work is text
//! that its owner understands.

use std::fs::{self, File, OpenOptions};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

mod unsaved;

pub(crate) use unsaved::Unsaved;

use crate::bench::background::{Executor, Task, finished};
use selvedge_foundation::files::{self, FileError};
use selvedge_foundation::quantity;

const WORK: &str = "work.json";
const LOCK: &str = "lock";
/// From a change until it is written, s: a drag or a word is one change.
const SETTLE_S: f64 = 2.0;
/// From one write to the next, s.
const PAUSE_S: f64 = 5.0;

/// Work and whose it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Part {
    /// The scene, or the title of a tool's pane.
    pub(crate) owner: String,
    /// The work.
    pub(crate) unsaved: Unsaved,
}

/// What a process has to lose.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Work {
    /// When it was written, RFC 3339.
    at: String,
    parts: Vec<Part>,
}

/// What an earlier process left.
#[derive(Debug)]
pub(crate) struct Offer {
    folder: PathBuf,
    /// No other window offers it meanwhile.
    _lock: File,
    work: Work,
}

impl Offer {
    /// When it was written, as people read it.
    pub(crate) fn at(&self) -> String {
        let text = self.work.at.replace('T', " ");
        text.get(..16).unwrap_or_default().to_owned()
    }

    /// What it is.
    pub(crate) fn parts(&self) -> &[Part] {
        &self.work.parts
    }
}

/// The folder of this process and those that others left.
#[derive(Debug, Default)]
pub(crate) struct Recovery {
    /// Where the folders lie; `None` on a system without such a place.
    root: Option<PathBuf>,
    /// This process's folder, and its lock.
    own: Option<(PathBuf, File)>,
    written: Vec<Part>,
    writing: Option<Task<()>>,
    /// Since when something has changed, s.
    dirty_since_s: Option<f64>,
    written_s: f64,
    /// What earlier processes left, newest last.
    offers: Vec<Offer>,
    /// What was taken up: it goes once it is written anew.
    restored: Vec<Offer>,
    /// Why something that was left cannot be offered.
    unreadable: Vec<String>,
    /// Whether work stays for the next start when the window closes.
    pub(crate) keeps: bool,
}

impl Recovery {
    /// Keeps work in a folder, which need not be there yet.
    pub(crate) fn in_folder(root: PathBuf) -> Self {
        let found = fs::read_dir(&root).into_iter().flatten().flatten();
        let (mut offers, mut unreadable) = (Vec::new(), Vec::new());
        for left in found.filter_map(|found| offer_in(found.path())) {
            match left {
                Ok(offer) => offers.push(offer),
                Err(error) => unreadable.push(format!("Unsaved work is left, but {error}")),
            }
        }
        offers.sort_by(|a: &Offer, b| a.work.at.cmp(&b.work.at));
        Self {
            root: Some(root),
            offers,
            unreadable,
            written_s: f64::NEG_INFINITY,
            ..Self::default()
        }
    }

    /// What is offered: the newest first.
    pub(crate) fn offer(&self) -> Option<&Offer> {
        self.offers.last()
    }

    /// Takes the offer to be restored; it stays on disk until it is written anew.
    pub(crate) fn restore(&mut self) -> Vec<Part> {
        let Some(offer) = self.offers.pop() else {
            return Vec::new();
        };
        let parts = offer.work.parts.clone();
        self.restored.push(offer);
        parts
    }

    /// Deletes what is offered.
    pub(crate) fn discard(&mut self) -> Result<(), FileError> {
        self.offers
            .pop()
            .map_or(Ok(()), |offer| remove(&offer.folder))
    }

    /// Leaves all offers to the next start, and what could not be taken up.
    pub(crate) fn put_off(&mut self) {
        self.offers.clear();
        self.restored.clear();
    }

    /// Something may have changed.
    pub(crate) fn touch(&mut self, now_s: f64) {
        self.dirty_since_s.get_or_insert(now_s);
    }

    /// Whether work is to be written now, or in how many seconds; `None` when nothing has changed.
    pub(crate) fn due_in_s(&self, now_s: f64) -> Option<f64> {
        let since_s = self.dirty_since_s.filter(|_| self.root.is_some())?;
        let due_s = (since_s + SETTLE_S).max(self.written_s + PAUSE_S);
        Some((due_s - now_s).max(0.0))
    }

    /// Writes what there is to lose, on a thread; takes the folder away when there is nothing.
    pub(crate) fn write(&mut self, parts: Vec<Part>, now_s: f64, executor: &Executor) {
        if self.writing.is_some() {
            return;
        }
        self.dirty_since_s = None;
        self.written_s = now_s;
        if parts == self.written && self.restored.is_empty() {
            return;
        }
        self.written.clone_from(&parts);
        let restored = std::mem::take(&mut self.restored);
        match self.own_folder() {
            Ok(Some(folder)) => {
                self.writing = Some(executor.start("selvedge-autosave", move |_| {
                    write(&folder, parts)?;
                    // What was taken up is in this process's folder now.
                    restored
                        .iter()
                        .try_for_each(|offer| remove(&offer.folder))
                        .map_err(told)
                }));
            }
            Ok(None) => {}
            Err(error) => {
                self.written.clear();
                self.writing =
                    Some(executor.start("selvedge-autosave", move |_| Err(error.to_string())));
            }
        }
    }

    /// Why what was left cannot be read, or the last write failed: each once.
    pub(crate) fn failure(&mut self) -> Option<String> {
        if let Some(line) = self.unreadable.pop() {
            return Some(line);
        }
        let line = finished(&mut self.writing)?.err()?;
        self.written.clear();
        Some(format!(
            "{line}; unsaved work is not kept against a crash: save the scene"
        ))
    }

    /// At the end of the run: leaves `parts` for the next start if they are to be kept.
    pub(crate) fn end(&mut self, parts: Vec<Part>) -> Result<(), String> {
        if self.keeps && !parts.is_empty() {
            if let Some(folder) = self.own_folder().map_err(told)? {
                write(&folder, parts)?;
            }
        } else if let Some((folder, _lock)) = self.own.take() {
            remove(&folder).map_err(told)?;
        }
        // What was taken up and not written anew stays where it was, unless it was let go.
        if !self.keeps {
            for offer in self.restored.drain(..) {
                remove(&offer.folder).map_err(told)?;
            }
        }
        Ok(())
    }

    /// The folder of this process, made on first use.
    fn own_folder(&mut self) -> Result<Option<PathBuf>, FileError> {
        let Some(root) = &self.root else {
            return Ok(None);
        };
        if let Some((folder, _)) = &self.own {
            return Ok(Some(folder.clone()));
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        let now_ms = now.map_or(0, |since| since.as_millis());
        fs::create_dir_all(root).map_err(FileError::write(root))?;
        let name = |n: u128| root.join(format!("{}-{}", now_ms + n, std::process::id()));
        let mut names = (0..).map(name);
        // Another window of this process may have begun in this millisecond.
        let made = names.find_map(|folder| match fs::create_dir(&folder) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => None,
            made => Some((folder, made)),
        });
        let Some((folder, made)) = made else {
            return Ok(None);
        };
        made.map_err(FileError::write(&folder))?;
        let lock = lock(&folder).ok_or_else(|| FileError::Busy {
            path: folder.clone(),
        })?;
        self.own = Some((folder.clone(), lock));
        Ok(Some(folder))
    }
}

/// Writes a process's work, or takes it away when there is none.
fn write(folder: &Path, parts: Vec<Part>) -> Result<(), String> {
    let path = folder.join(WORK);
    if parts.is_empty() {
        return match fs::remove_file(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(told(FileError::write(&path)(error)))
            }
            _ => Ok(()),
        };
    }
    let at = quantity::rfc3339(SystemTime::now());
    let work = Work { at, parts };
    let text = files::to_json_string(&work, &path).map_err(told)?;
    files::write_atomic(&path, text.as_bytes()).map_err(told)?;
    let mut parts = work.parts.iter();
    let fault = parts.find_map(|part| part.unsaved.fault());
    fault.map_or_else(
        || read(&path).map(|_| ()).map_err(told),
        |line| Err(line.to_owned()),
    )
}

fn lock(folder: &Path) -> Option<File> {
    let path = folder.join(LOCK);
    let mut options = OpenOptions::new();
    let file = options.create(true).truncate(false).write(true).open(path);
    file.ok().filter(|file| file.try_lock().is_ok())
}

/// What a process left that lives no longer.
fn offer_in(folder: PathBuf) -> Option<Result<Offer, FileError>> {
    let path = folder.join(WORK);
    if !path.is_file() {
        return None;
    }
    let lock = lock(&folder)?;
    Some(read(&path).map(|work| Offer {
        folder,
        _lock: lock,
        work,
    }))
}

/// Long work is one long line.
fn read(path: &Path) -> Result<Work, FileError> {
    let text = String::from_utf8(files::read(path)?);
    let text = text.map_err(|error| FileError::whole(path, error.to_string(), "remove it"))?;
    files::from_json_str(&text, path)
}

#[expect(clippy::needless_pass_by_value, reason = "for `map_err`")]
fn told(error: FileError) -> String {
    error.to_string()
}

fn remove(folder: &Path) -> Result<(), FileError> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(FileError::write(folder)(error)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    fn part(work: &str) -> Part {
        Part {
            owner: "scene".to_owned(),
            unsaved: Unsaved::new(
                "Scene “Sampler”".to_owned(),
                "1 step",
                &[("work", work)]
                    .into_iter()
                    .collect::<std::collections::BTreeMap<_, _>>(),
            ),
        }
    }

    fn written(root: &Path, work: &str) -> Recovery {
        let mut recovery = Recovery::in_folder(root.to_owned());
        recovery.write(vec![part(work)], 0.0, &Executor::InLine);
        assert_eq!(recovery.failure(), None);
        recovery
    }

    #[test]
    fn what_a_living_process_has_is_offered_to_nobody_and_what_a_dead_one_left_once() {
        let root = ScratchFolder::made("recovery");
        let alive = written(&root, "one");
        assert!(Recovery::in_folder(root.to_path_buf()).offer().is_none());
        // A process that is killed cleans nothing up.
        drop(alive);
        let mut next = Recovery::in_folder(root.to_path_buf());
        assert_eq!(next.offer().unwrap().parts(), [part("one")]);
        let third = Recovery::in_folder(root.to_path_buf());
        assert!(third.offer().is_none(), "one window offers it");
        assert_eq!(next.restore(), [part("one")]);
        drop(next);
        let mut again = Recovery::in_folder(root.to_path_buf());
        assert!(
            again.offer().is_some(),
            "it crashed before it wrote it anew"
        );
        again.discard().unwrap();
        assert!(Recovery::in_folder(root.to_path_buf()).offer().is_none());
    }

    #[test]
    fn what_was_restored_goes_once_it_is_written_anew() {
        let root = ScratchFolder::made("anew");
        drop(written(&root, "one"));
        let mut next = Recovery::in_folder(root.to_path_buf());
        let parts = next.restore();
        next.write(parts, 1.0, &Executor::InLine);
        assert_eq!(next.failure(), None);
        assert_eq!(fs::read_dir(&*root).unwrap().count(), 1, "only its own");
    }

    #[test]
    fn a_clean_end_leaves_nothing_and_one_that_keeps_leaves_it_all() {
        let root = ScratchFolder::made("end");
        written(&root, "one").end(vec![part("one")]).unwrap();
        assert!(Recovery::in_folder(root.to_path_buf()).offer().is_none());
        let mut keeping = written(&root, "one");
        keeping.keeps = true;
        keeping.end(vec![part("two")]).unwrap();
        drop(keeping);
        let next = Recovery::in_folder(root.to_path_buf());
        assert_eq!(next.offer().unwrap().parts(), [part("two")]);
    }

    #[test]
    fn saved_work_is_no_longer_offered() {
        let root = ScratchFolder::made("saved");
        let mut recovery = written(&root, "one");
        recovery.write(Vec::new(), 9.0, &Executor::InLine);
        assert_eq!(recovery.failure(), None);
        drop(recovery);
        assert!(Recovery::in_folder(root.to_path_buf()).offer().is_none());
    }

    #[test]
    fn a_change_waits_for_two_seconds_and_a_drag_for_no_more_than_five() {
        let mut recovery = Recovery::in_folder(PathBuf::from("/nowhere"));
        assert_eq!(recovery.due_in_s(0.0), None);
        recovery.touch(10.0);
        recovery.touch(11.0);
        assert_eq!(recovery.due_in_s(11.0), Some(1.0));
        assert_eq!(recovery.due_in_s(13.0), Some(0.0));
        recovery.written_s = 12.5;
        assert_eq!(
            recovery.due_in_s(13.0),
            Some(4.5),
            "it was written just now"
        );
    }

    #[test]
    fn work_that_cannot_be_read_is_told_once_and_stays() {
        let root = ScratchFolder::made("broken");
        drop(written(&root, "one"));
        let folder = fs::read_dir(&*root).unwrap().next().unwrap().unwrap();
        fs::write(folder.path().join(WORK), "half of it").unwrap();
        let mut next = Recovery::in_folder(root.to_path_buf());
        assert!(next.offer().is_none());
        let line = next.failure().unwrap();
        assert!(line.contains(WORK) && !line.contains('\n'), "{line}");
        assert_eq!(next.failure(), None);
        assert!(folder.path().join(WORK).exists());
    }

    #[test]
    fn a_folder_that_cannot_be_written_says_so() {
        let root = ScratchFolder::made("file");
        let file = root.join("file");
        fs::write(&file, "").unwrap();
        let mut recovery = Recovery::in_folder(file);
        recovery.write(vec![part("one")], 0.0, &Executor::InLine);
        let line = recovery.failure().unwrap();
        assert!(
            line.contains("save the scene") && !line.contains('\n'),
            "{line}"
        );
    }
}
