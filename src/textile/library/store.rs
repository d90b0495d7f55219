//! Where the files of textiles lie, and how they are read.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use crate::build::BuiltFile;
use crate::shipped;
use selvedge_foundation::files::{FileError, read, read_text};

/// Where a library's files lie.
#[derive(Debug, Clone)]
pub(crate) enum Store {
    /// A folder with a folder for every textile.
    Folder(PathBuf),
    /// Part of the program.
    Shipped,
    /// The files of one textile that was built, and the library that it belongs to.
    Built(Arc<Vec<BuiltFile>>, PathBuf),
}

impl Store {
    /// The text of a file of a textile.
    pub(crate) fn text(&self, id: &str, name: &str) -> Result<String, FileError> {
        match self {
            Self::Folder(_) => read_text(&self.path(id, name)),
            Self::Shipped | Self::Built(..) => self
                .read(id, name)
                .map(|bytes| String::from_utf8_lossy(&bytes).into_owned()),
        }
    }

    /// What the library is called in messages.
    pub(crate) fn root(&self) -> PathBuf {
        match self {
            Self::Folder(folder) => folder.clone(),
            Self::Shipped => PathBuf::from("the shipped library"),
            Self::Built(_, library) => library.clone(),
        }
    }

    /// How a file of a textile is called in messages.
    pub(crate) fn path(&self, id: &str, name: &str) -> PathBuf {
        self.root().join(id).join(name)
    }

    /// The bytes of a file of a textile.
    pub(crate) fn read(&self, id: &str, name: &str) -> Result<Cow<'static, [u8]>, FileError> {
        let path = self.path(id, name);
        let found = match self {
            Self::Folder(_) => return read(&path).map(Cow::Owned),
            Self::Shipped => shipped::file(id, name).map(Cow::Borrowed),
            Self::Built(files, _) => {
                let file = files.iter().find(|file| file.name == name);
                file.map(|file| Cow::Owned(file.bytes.clone()))
            }
        };
        found.ok_or_else(|| {
            let source = std::io::Error::from(std::io::ErrorKind::NotFound);
            FileError::Read { path, source }
        })
    }
}
