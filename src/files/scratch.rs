//! A folder for a while, gone with the value that stands for it.

use std::fs;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

static N_MADE: AtomicU32 = AtomicU32::new(0);

/// A folder among the system's temporary files.
#[derive(Debug)]
pub(crate) struct ScratchFolder(pub(crate) PathBuf);

impl ScratchFolder {
    /// Not there yet; named so that it can be told whose it is, and no other has that name.
    pub(crate) fn new(name: &str) -> Self {
        let nth = N_MADE.fetch_add(1, Ordering::Relaxed);
        let name = format!("selvedge-{name}-{}-{nth}", std::process::id());
        let path = std::env::temp_dir().join(name);
        drop(fs::remove_dir_all(&path));
        Self(path)
    }

    /// The same, there and empty.
    #[cfg(test)]
    pub(crate) fn made(name: &str) -> Self {
        let folder = Self::new(name);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// Writes a file of it and gives its place.
    #[cfg(test)]
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.join(name);
        fs::write(&path, content).unwrap();
        path
    }

    /// The text of a file of it.
    #[cfg(test)]
    pub(crate) fn read(&self, name: &str) -> String {
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

impl Drop for ScratchFolder {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(self));
    }
}
