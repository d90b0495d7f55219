//! A folder for the time of a test, gone with the value that stands for it.
//!
//! # Invariants
//! - for tests only: no product crate depends on it, except for tests
#![expect(
    clippy::unwrap_used,
    clippy::missing_panics_doc,
    dead_code,
    reason = "a test that cannot write its files panics; the folder is held to be dropped"
)]

use std::fs;
use std::ops::Deref;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// A folder among the system's temporary files.
#[derive(Debug)]
pub struct ScratchFolder(
    /// Within the other, so that it need not be there.
    pub PathBuf,
    TempDir,
);

impl ScratchFolder {
    /// Not there yet, named so that it can be told whose it is.
    pub fn new(name: &str) -> Self {
        let parent = tempfile::Builder::new()
            .prefix("selvedge-")
            .tempdir()
            .unwrap();
        Self(parent.path().join(name), parent)
    }

    /// The same, there and empty.
    pub fn made(name: &str) -> Self {
        let folder = Self::new(name);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// Writes a file of it and gives its place.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.join(name);
        fs::write(&path, content).unwrap();
        path
    }

    /// The text of a file of it.
    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.join(name)).unwrap()
    }
}

impl Deref for ScratchFolder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl AsRef<Path> for ScratchFolder {
    fn as_ref(&self) -> &Path {
        self
    }
}
