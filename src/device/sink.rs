//! What can go wrong when something is written for other programs.

use std::io;
use std::path::{Path, PathBuf};

use super::BridgeError;
use selvedge_foundation::files::FileError;
use selvedge_foundation::progress::Cancelled;

/// Why a file was not written. Nothing of it is left.
#[derive(Debug, thiserror::Error)]
pub enum SinkError {
    /// Its place is wrong.
    #[error("cannot write {}: {source}; check the folder", path.display())]
    Place {
        /// Where.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// It cannot be written on: the disk is full, for one.
    #[error(transparent)]
    File(#[from] FileError),
    /// What is to be written makes no such file.
    #[error(transparent)]
    Bridge(#[from] BridgeError),
    /// It was stopped before it was done.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl SinkError {
    /// Wraps what creating the file at `path` said.
    pub(super) fn place(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Place { path, source }
    }

    /// Wraps what writing the file at `path` said.
    pub(super) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File(FileError::Write { path, source })
    }
}
