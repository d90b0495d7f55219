//! A folder of a test, gone with it.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

static N_MADE: AtomicU32 = AtomicU32::new(0);

/// A folder that is not there yet, among the system's temporary files.
pub(crate) struct ScratchFolder(pub(crate) PathBuf);

impl ScratchFolder {
    /// Named so that it can be told whose it is, and no other has that name.
    pub(crate) fn new(name: &str) -> Self {
        let nth = N_MADE.fetch_add(1, Ordering::Relaxed);
        let name = format!("selvedge-{name}-{}-{nth}", std::process::id());
        let path = std::env::temp_dir().join(name);
        drop(fs::remove_dir_all(&path));
        Self(path)
    }
}

impl Drop for ScratchFolder {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}
