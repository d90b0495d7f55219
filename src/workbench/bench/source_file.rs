//! A file that a tool makes textiles of.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use selvedge_textile::read_measurement;
use serde::{Deserialize, Serialize};

/// A file that was chosen, read once; saved as where it lies. Equal are only clones of one another:
/// the same file read anew may hold something else.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "PathBuf", into = "PathBuf")]
pub(crate) struct SourceFile {
    path: PathBuf,
    bytes: Arc<OnceLock<Result<Vec<u8>, String>>>,
}

impl PartialEq for SourceFile {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.bytes, &other.bytes)
    }
}

impl From<PathBuf> for SourceFile {
    fn from(path: PathBuf) -> Self {
        let bytes = Arc::default();
        Self { path, bytes }
    }
}

impl From<SourceFile> for PathBuf {
    fn from(file: SourceFile) -> Self {
        file.path
    }
}

impl SourceFile {
    /// Where it lies.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Its name without folders.
    pub(crate) fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// The same as a path: where it lies is nobody's business in errors.
    pub(crate) fn file_name(&self) -> &Path {
        self.path.file_name().map_or(&*self.path, Path::new)
    }

    /// Its content, read on the first call; why it cannot be read, in one line.
    pub(crate) fn bytes(&self) -> Result<&[u8], &str> {
        let read = || read_measurement(&self.path).map_err(|error| error.to_string());
        let bytes = self.bytes.get_or_init(read);
        bytes.as_deref().map_err(String::as_str)
    }

    /// How many bytes it has, if it was read.
    pub(crate) fn n_bytes(&self) -> Option<usize> {
        self.bytes.get()?.as_ref().ok().map(Vec::len)
    }
}
