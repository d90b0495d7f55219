//! Settings per user: read once at the start, written when they changed, on a thread of their own.
//!
//! A file that is missing or broken never stops the program: it starts as at first, and a broken
//! file is set aside under another name, so that nothing is lost. Knows where the file is and when
//! it is written; what is in it is in `preferences.rs`.

pub(crate) mod hand;
mod own_files;
pub(crate) mod preferences;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};
use std::{fs, io};

use directories::{ProjectDirs, UserDirs};
use selvedge_foundation::files::{FileError, read_text, write_atomic};
use selvedge_textile::BuildCache;

/// The name of the file.
const NAME: &str = "settings.toml";
/// The least time between two writes, s.
const PAUSE_S: f64 = 1.0;

/// The settings of this run, and the file that keeps them.
#[derive(Debug, Default)]
pub(crate) struct Settings {
    /// The values. Whoever changes them need do nothing else.
    pub preferences: Preferences,
    /// Whether this user starts the program for the first time: there was no file.
    pub(crate) are_first: bool,
    file: Option<Keeper>,
}

/// A file and what is known of it.
#[derive(Debug)]
struct Keeper {
    path: PathBuf,
    /// What it holds, or will once the write under way is done; `None`: something else.
    held: Option<Preferences>,
    writing: Option<JoinHandle<Result<(), FileError>>>,
    /// Whether the last write that was asked about failed.
    has_failed: bool,
    /// When it was written last, s.
    written_s: f64,
}

/// Where textiles that were built from recipes are kept for this user: a folder that may be
/// deleted at any time. `None` on a system without such a place.
pub fn build_cache() -> Option<BuildCache> {
    let folder = own_folders()?.cache_dir().join("textiles");
    Some(BuildCache::in_folder(&folder))
}

/// Where the user's own libraries lie. `None` on a system without such a place.
pub(crate) fn own_libraries() -> Option<PathBuf> {
    Some(own_folders()?.data_dir().to_owned())
}

/// The folders of this user. `None` on a system without such places.
fn own_folders() -> Option<ProjectDirs> {
    ProjectDirs::from("", "", "selvedge")
}

/// Where work that no file holds is kept for this user: the state folder, or where there is none
/// the data folder. `None` on a system without such a place.
pub(crate) fn own_work() -> Option<PathBuf> {
    let folders = own_folders()?;
    let state = folders
        .state_dir()
        .unwrap_or_else(|| folders.data_local_dir());
    Some(state.join("unsaved"))
}

/// Where recordings of this user lie. `None` on a system without such a place.
pub(crate) fn own_recordings() -> Option<PathBuf> {
    Some(own_folders()?.data_dir().join("recordings"))
}

/// Where the log of a public stage lies. `None` on a system without such a place.
pub(crate) fn own_stage() -> Option<PathBuf> {
    Some(own_folders()?.data_dir().join("stage"))
}

/// The file of whoever operates a public stage. `None` on a system without such a place.
pub fn stage_file() -> Option<PathBuf> {
    Some(own_folders()?.config_dir().join("stage.toml"))
}

/// Where the user keeps documents, or the home folder, or the present one.
pub(crate) fn own_documents() -> PathBuf {
    let folders = UserDirs::new();
    let own = folders.as_ref().map(|folders| {
        let documents = folders.document_dir().filter(|folder| folder.is_dir());
        documents.unwrap_or_else(|| folders.home_dir()).to_owned()
    });
    own.unwrap_or_default()
}

/// Where links to devices are logged for this user. `None` on a system without such a place.
pub(crate) fn session_log() -> Option<PathBuf> {
    Some(own_folders()?.data_dir().join("logs").join("bridge.csv"))
}

/// The folder of the certificates of devices that were tried for this user. `None` on a system
/// without such a place.
pub fn own_certificates() -> Option<PathBuf> {
    Some(own_folders()?.data_dir().join("certificates"))
}

/// The folder of the user's array profiles. `None` on a system without such a place.
pub fn own_arrays() -> Option<PathBuf> {
    Some(own_folders()?.data_dir().join("arrays"))
}

impl Settings {
    /// Settings that are neither read nor written: for tests and pictures.
    pub(crate) fn in_memory() -> Self {
        Self::default()
    }

    /// The same, not written any more.
    pub(crate) fn unwritten(self) -> Self {
        Self { file: None, ..self }
    }

    /// The settings of the user, and a sentence when they could not be read.
    pub(crate) fn of_user() -> (Self, Option<String>) {
        match own_folders() {
            Some(folders) => Self::in_folder(folders.config_dir()),
            None => (Self::in_memory(), None),
        }
    }

    /// The settings in a folder, which need not be there yet.
    fn in_folder(folder: &Path) -> (Self, Option<String>) {
        let path = folder.join(NAME);
        match preferences_in(&path) {
            Err(FileError::Read { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
                let first = Self {
                    are_first: true,
                    ..Self::preferences_at(path, Preferences::default(), true)
                };
                (first, None)
            }
            // Whatever is there, it is not to be written over.
            Err(FileError::Read { source, .. }) => {
                let words = format!(
                    "cannot read {}: {source}; settings are as at first and will not be kept",
                    path.display()
                );
                (Self::in_memory(), Some(words))
            }
            Ok((preferences, None)) => (Self::preferences_at(path, preferences, true), None),
            Ok((preferences, Some(flaw))) => Self::set_aside(path, preferences, &flaw),
            Err(error) => Self::set_aside(path, Preferences::default(), &error.to_string()),
        }
    }

    /// Settings whose file is as `kept` when `is_held`, and otherwise to be written anew.
    fn preferences_at(path: PathBuf, preferences: Preferences, is_held: bool) -> Self {
        let file = Keeper {
            path,
            held: is_held.then(|| preferences.clone()),
            writing: None,
            has_failed: false,
            written_s: f64::NEG_INFINITY,
        };
        Self {
            preferences,
            are_first: false,
            file: Some(file),
        }
    }

    /// Sets a broken file aside and goes on with `kept`, what could be read of it.
    fn set_aside(path: PathBuf, preferences: Preferences, what: &str) -> (Self, Option<String>) {
        let aside = free_name(&path);
        match fs::rename(&path, &aside) {
            Ok(()) => {
                let words = format!(
                    "{what}; settings that could not be read are as at first, and the file was \
                     kept as {}",
                    aside.display()
                );
                (Self::preferences_at(path, preferences, false), Some(words))
            }
            Err(error) => {
                let words = format!(
                    "{what}; the file could not be set aside ({error}), so settings will not be \
                     kept this time"
                );
                (
                    Self {
                        preferences,
                        ..Self::default()
                    },
                    Some(words),
                )
            }
        }
    }

    /// Writes the settings when they changed, on another thread, at most once a second.
    ///
    /// To be called every frame. Says after how many seconds to call again, when there is
    /// something left to write; a write that failed is told to [`Self::take_failure`].
    pub(crate) fn save_if_changed(&mut self, now_s: f64) -> Option<f64> {
        let file = self.file.as_mut()?;
        if file.held.as_ref() == Some(&self.preferences) {
            return None;
        }
        let is_writing = file.writing.as_ref().is_some_and(|job| !job.is_finished());
        let left_s = PAUSE_S - (now_s - file.written_s);
        if is_writing || left_s > 0.0 {
            return Some(left_s.clamp(0.05, PAUSE_S));
        }
        // A write that failed and was not asked about is forgotten: this one will say it again.
        let preferences = self.preferences.clone();
        let path = file.path.clone();
        let job = thread::Builder::new().name("selvedge-settings".to_owned());
        file.writing = job.spawn(move || write(&preferences, &path)).ok();
        file.held = Some(self.preferences.clone());
        file.written_s = now_s;
        None
    }

    /// Why the last write failed, once.
    pub(crate) fn take_failure(&mut self) -> Option<String> {
        let file = self.file.as_mut()?;
        if !file.writing.as_ref()?.is_finished() {
            return None;
        }
        let outcome = file.writing.take()?.join();
        let failure = outcome.ok()?.err().map(|error| error.to_string());
        file.has_failed = failure.is_some();
        failure
    }

    /// Writes the settings on this thread when they changed: at the end of the run.
    pub(crate) fn save_now(&mut self) -> Result<(), FileError> {
        let Some(file) = &mut self.file else {
            return Ok(());
        };
        let is_written = file.writing.take().is_none_or(|job| {
            // A thread that broke off wrote nothing.
            job.join().is_ok_and(|outcome| outcome.is_ok())
        });
        if is_written && !file.has_failed && file.held.as_ref() == Some(&self.preferences) {
            return Ok(());
        }
        write(&self.preferences, &file.path)?;
        file.held = Some(self.preferences.clone());
        Ok(())
    }
}

/// What a file holds, and where a value is not known.
fn preferences_in(path: &Path) -> Result<(Preferences, Option<String>), FileError> {
    let (preferences, line) = Preferences::from_text(&read_text(path)?, path)?;
    let flaw = line.map(|line| format!("{}:{line}: this value is not known", path.display()));
    Ok((preferences, flaw))
}

/// Writes the file and, when need be, its folder.
fn write(preferences: &Preferences, path: &Path) -> Result<(), FileError> {
    let text = preferences.to_text(path)?;
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|source| FileError::Write {
            path: path.to_owned(),
            source,
        })?;
    }
    write_atomic(path, text.as_bytes())
}

/// A name beside `path` for a broken file, such that no earlier one is lost.
fn free_name(path: &Path) -> PathBuf {
    let name = |ending: &str| path.with_file_name(format!("{NAME}.broken{ending}"));
    let numbered = (2..100).map(|n| name(&format!("-{n}")));
    let mut names = std::iter::once(name("")).chain(numbered);
    names
        .find(|name| !name.exists())
        .unwrap_or_else(|| name(""))
}

pub use crate::bench::settings::own_files::{OwnFiles, own_files};
pub(crate) use crate::bench::settings::preferences::Preferences;
