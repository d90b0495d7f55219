//! What the window would find of the user's files: asked without opening it; nothing is changed.

use std::io;
use std::path::PathBuf;

use crate::bench::settings::{
    NAME, Preferences, own_documents, own_folders, own_recordings, preferences_in,
};
use selvedge_foundation::files::FileError;

/// Where a user's files are, and what is wrong with the settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnFiles {
    /// The file of the settings, which need not be there yet.
    pub settings: PathBuf,
    /// Why settings would be as at first although there is a file of them.
    pub flaw: Option<String>,
    /// The folder of sessions of experiments: the last one that was used, or the documents.
    pub sessions: PathBuf,
    /// The folder of recordings.
    pub recordings: PathBuf,
}

/// The files of this user. `None` on a system without a place for them.
pub fn own_files() -> Option<OwnFiles> {
    let folders = own_folders()?;
    let settings = folders.config_dir().join(NAME);
    let (preferences, flaw) = match preferences_in(&settings) {
        Ok(found) => found,
        Err(FileError::Read { source, .. }) if source.kind() == io::ErrorKind::NotFound => {
            (Preferences::default(), None)
        }
        Err(error) => (Preferences::default(), Some(error.to_string())),
    };
    let sessions = preferences.folders.sessions.map(PathBuf::from);
    Some(OwnFiles {
        settings,
        flaw,
        sessions: sessions.unwrap_or_else(own_documents),
        recordings: own_recordings()?,
    })
}
