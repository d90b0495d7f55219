//! A folder of textiles that changes: new ones are put in, others are renamed, replaced or taken
//! away. Whatever stood there before stays as a version that can be had back.
//!
//! ```text
//! FOLDER/ID/textile.toml …                 what is there
//! FOLDER/.versions/ID/VERSION/…            what was there before, whole
//! ```
//!
//! A version is named by a hash of its files, so that the same content is kept once. The library's
//! reference level stays as it is, so that nobody's gain moves.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::Library;
use super::build::{entry_of, hash_of};
use super::id::id_of;
use super::index::{INDEX, Index};
use crate::build::{BuiltFile, write};
use crate::error::TextileError;
use crate::manifest::{MANIFEST, Manifest};
use selvedge_foundation::files::{FileError, read, read_text, sha256_hex, write_atomic};

/// Textiles that may share a name but for a number.
const MAX_ALIKE: u32 = 9999;
/// Where versions lie.
const VERSIONS: &str = ".versions";
/// Letters of a version's name.
const LETTERS: usize = 16;

/// A folder of textiles that may be changed.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct LibraryFolder {
    path: PathBuf,
}

/// A change of one textile: what stood under its id before and after, `None` for nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// The textile's id.
    pub id: String,
    /// The version before.
    pub before: Option<String>,
    /// The version after.
    pub after: Option<String>,
}

/// What stood under an id at some time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Version {
    /// Its name among the versions of the textile.
    pub version: String,
    /// What the textile was called then.
    pub name: String,
    /// When it was written.
    pub at: SystemTime,
}

impl LibraryFolder {
    /// The folder at this path, which need not be there yet.
    pub fn at(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
        }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts a textile in, under the id that it is wished to have or the first of `ID-2`, `ID-3`, …
    /// that is free; with `replaces` in the place of the textile with that very id.
    ///
    /// # Errors
    /// Files that are no textile, before anything is written; a folder that cannot be written.
    pub fn put(
        &self,
        wished: &str,
        files: &[BuiltFile],
        replaces: bool,
    ) -> Result<Change, TextileError> {
        let id = if replaces {
            self.files_in(&self.path.join(wished))?;
            wished.to_owned()
        } else {
            self.free_id(wished)?
        };
        Library::of_files(&id, files.to_vec()).load(&id)?;
        self.change(&id, Some(files))
    }

    /// Calls a textile otherwise; its id stays, so that scenes find it.
    ///
    /// # Errors
    /// A manifest that cannot be read; a folder that cannot be written.
    pub fn rename(&self, id: &str, name: &str) -> Result<Change, TextileError> {
        let files = called(&self.files_in(&self.path.join(id))?, name)?;
        self.change(id, Some(&files))
    }

    /// Puts a version in the place of what stands under its id; `None` takes that away.
    ///
    /// # Errors
    /// There is no such version; a folder that cannot be written.
    pub fn restore(&self, id: &str, version: Option<&str>) -> Result<Change, TextileError> {
        let files = version.map(|version| self.files_in(&self.versions_of(id).join(version)));
        self.change(id, files.transpose()?.as_deref())
    }

    /// The versions of a textile that were put aside, the newest first.
    pub fn versions(&self, id: &str) -> Vec<Version> {
        let version = |entry: fs::DirEntry| {
            let manifest = entry.path().join(MANIFEST);
            let name = Manifest::from_toml(&read_text(&manifest).ok()?, &manifest);
            Some(Version {
                version: entry.file_name().into_string().ok()?,
                name: name.ok()?.name,
                at: manifest.metadata().and_then(|data| data.modified()).ok()?,
            })
        };
        let mut all: Vec<Version> = entries(&self.versions_of(id)).filter_map(version).collect();
        all.sort_by(|a, b| (b.at, &b.version).cmp(&(a.at, &a.version)));
        all
    }

    /// The ids of textiles that are there no more, of which versions are left.
    pub fn removed(&self) -> Vec<String> {
        let all = entries(&self.path.join(VERSIONS));
        let ids = all.filter_map(|entry| entry.file_name().into_string().ok());
        let is_gone = |id: &String| {
            !id.starts_with('.') && !self.path.join(id).exists() && !self.versions(id).is_empty()
        };
        let mut gone: Vec<String> = ids.filter(is_gone).collect();
        gone.sort();
        gone
    }

    /// Puts files in the place of what stands under an id, which becomes a version.
    fn change(&self, id: &str, files: Option<&[BuiltFile]>) -> Result<Change, TextileError> {
        let there = self.path.join(id);
        let before = if there.join(MANIFEST).is_file() {
            let old = self.files_in(&there)?;
            Some(version_of(&old))
        } else {
            None
        };
        // What is new stands aside whole before it takes the place of what was there.
        let staged = self.path.join(VERSIONS).join(format!(".new-{id}"));
        clear(&staged)?;
        if let Some(files) = files {
            write(files, &staged)?;
        }
        if let Some(version) = &before {
            let versions = self.versions_of(id);
            let kept = versions.join(version);
            fs::create_dir_all(&versions).map_err(FileError::write(&versions))?;
            clear(&kept)?;
            fs::rename(&there, &kept).map_err(FileError::write(&kept))?;
        }
        if files.is_some() {
            fs::rename(&staged, &there).map_err(FileError::write(&there))?;
        }
        self.note(id)?;
        Ok(Change {
            id: id.to_owned(),
            before,
            after: files.map(version_of),
        })
    }

    /// Lets the index say what stands under an id now. A folder without one stays without one.
    fn note(&self, id: &str) -> Result<(), TextileError> {
        let path = self.path.join(INDEX);
        if !path.is_file() {
            return Ok(());
        }
        let mut index = Index::from_toml(&read_text(&path)?, &path)?;
        let place = index.textiles.iter().position(|entry| entry.id == id);
        if self.path.join(id).join(MANIFEST).is_file() {
            let own = Library::of_folder(&self.path, &[id.to_owned()]);
            let entry = entry_of(id, own.load(id)?.surface());
            match place {
                Some(place) => index.textiles[place] = entry,
                None => index.textiles.push(entry),
            }
        } else if let Some(place) = place {
            index.textiles.remove(place);
        }
        let entries = index.textiles.iter();
        let ids: Vec<String> = entries.map(|entry| entry.id.clone()).collect();
        index.content_hash = hash_of(&Library::of_folder(&self.path, &ids))?;
        Ok(write_atomic(&path, index.to_toml(&path)?.as_bytes())?)
    }

    fn versions_of(&self, id: &str) -> PathBuf {
        self.path.join(VERSIONS).join(id)
    }

    /// The files of a folder, the manifest last.
    fn files_in(&self, folder: &Path) -> Result<Vec<BuiltFile>, TextileError> {
        let mut paths: Vec<PathBuf> = entries(folder).map(|entry| entry.path()).collect();
        paths.retain(|path| path.is_file());
        paths.sort_by_key(|path| (path.ends_with(MANIFEST), path.clone()));
        let file = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default();
            Ok(BuiltFile::new(name.to_string_lossy(), read(path)?))
        };
        let files: Vec<BuiltFile> = paths.iter().map(file).collect::<Result<_, FileError>>()?;
        if files.last().is_none_or(|file| file.name != MANIFEST) {
            let known: Vec<String> = Library::open(&self.path)?.ids().to_vec();
            let id = folder.file_name().unwrap_or_default().to_string_lossy();
            return Err(TextileError::unknown(&id, &self.path, &known));
        }
        Ok(files)
    }

    /// The id that a name makes or the first of `ID-2`, `ID-3`, … that is not taken.
    fn free_id(&self, wished: &str) -> Result<String, TextileError> {
        let id = id_of(wished);
        if id.is_empty() {
            let words =
                format!("\"{wished}\" makes no id; give a name with letters a to z or digits");
            return Err(TextileError::Model(words));
        }
        let with_number = |n: u32| format!("{id}-{n}");
        std::iter::once(id.clone())
            .chain((2..=MAX_ALIKE).map(with_number))
            .find(|id| !self.path.join(id).exists())
            .ok_or_else(|| {
                let words =
                    format!("there are {MAX_ALIKE} textiles called {id}; give another name");
                TextileError::Model(words)
            })
    }
}

/// The files of a textile with another name in its manifest.
///
/// # Errors
/// Files without a manifest that can be read.
pub fn called(files: &[BuiltFile], name: &str) -> Result<Vec<BuiltFile>, TextileError> {
    let path = Path::new(MANIFEST);
    let mut files = files.to_vec();
    for file in files.iter_mut().filter(|file| file.name == MANIFEST) {
        let text = String::from_utf8_lossy(&file.bytes);
        let manifest = Manifest {
            name: name.to_owned(),
            ..Manifest::from_toml(&text, path)?
        };
        file.bytes = manifest.to_toml(path)?.into_bytes();
    }
    Ok(files)
}

/// The name of a version with these files.
fn version_of(files: &[BuiltFile]) -> String {
    let mut files: Vec<&BuiltFile> = files.iter().collect();
    files.sort_by_key(|file| &file.name);
    let parts = files
        .iter()
        .flat_map(|file| [file.name.as_bytes(), file.bytes.as_slice()]);
    sha256_hex(parts).chars().take(LETTERS).collect()
}

/// Takes a folder away, if it is there.
fn clear(folder: &Path) -> Result<(), FileError> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(FileError::write(folder))?;
    }
    Ok(())
}

/// What lies in a folder that can be read; nothing if it cannot.
fn entries(folder: &Path) -> impl Iterator<Item = fs::DirEntry> + use<> {
    fs::read_dir(folder).into_iter().flatten().flatten()
}
