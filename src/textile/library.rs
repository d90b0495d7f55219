//! Libraries of textiles: a folder, a file of recipes, or one that is part of the program.
//!
//! A library knows its ids; everything else is read when it is asked for.

use std::borrow::Cow;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use super::build::BuiltFile;
use super::cache::BuildCache;
use super::index::Index;
use super::loaded::{Appearance, MANIFEST, Textile, read_appearance, read_manifest};
use super::manifest::Manifest;
use super::recipes::{Recipes, SEVENTY_FOUR};
use super::{TextileError, shipped, workers};
use crate::tactile::Tuning;
use selvedge_foundation::files::{FileError, read, read_text};
use selvedge_foundation::progress::Progress;

/// The name of the index in a library's folder.
pub(crate) const INDEX: &str = "library.toml";

/// Textiles that are named when one is not found; more would hide what is wrong.
const NAMED: usize = 20;

/// Where a library's files lie.
#[derive(Debug, Clone)]
pub(crate) enum Store {
    /// A folder with a folder for every textile.
    Folder(PathBuf),
    /// Part of the program.
    Shipped,
    /// Recipes; what follows from them is built when it is asked for.
    Recipes(Arc<Recipes>),
    /// The files of one textile that was built, and the library that it belongs to.
    Built(Arc<Vec<BuiltFile>>, PathBuf),
}

/// A library of textiles.
#[derive(Debug, Clone)]
pub struct Library {
    store: Store,
    ids: Vec<String>,
    index: Option<Index>,
}

impl Library {
    /// The library that is part of the program.
    pub fn shipped() -> Result<Self, TextileError> {
        let path = Store::Shipped.root().join(INDEX);
        let index = Index::from_toml(shipped::INDEX, &path)?;
        Ok(Self::with_index(Store::Shipped, index))
    }

    /// The library that a scene or a person names: `seventy-four`, a file of recipes, or a folder
    /// of textiles. What is built from recipes is kept in `cache`; without one it is built anew
    /// every time. A folder or file that is called like a library of the program is named
    /// `./seventy-four`.
    pub fn named(name: &Path, cache: Option<&BuildCache>) -> Result<Self, TextileError> {
        if is_of_the_program(name) {
            return Ok(Self::of_recipes(Recipes::seventy_four(cache.cloned())?));
        }
        if name.is_file() {
            return Ok(Self::of_recipes(Recipes::read(name, cache.cloned())?));
        }
        Self::open(name)
    }

    fn of_recipes(recipes: Recipes) -> Self {
        Self {
            ids: recipes.ids(),
            index: recipes.index().cloned(),
            store: Store::Recipes(Arc::new(recipes)),
        }
    }

    /// A folder with textiles. Without a `library.toml` its textiles are the sub-folders that hold
    /// a manifest, in the order of their names.
    pub fn open(folder: &Path) -> Result<Self, TextileError> {
        let failed = |source| FileError::Read {
            path: folder.to_owned(),
            source,
        };
        let entries = fs::read_dir(folder).map_err(failed)?;
        let store = Store::Folder(folder.to_owned());
        let path = folder.join(INDEX);
        if path.exists() {
            return Ok(Self::with_index(
                store,
                Index::from_toml(&read_text(&path)?, &path)?,
            ));
        }
        let mut ids = Vec::new();
        for entry in entries {
            let entry = entry.map_err(failed)?;
            if let (Ok(id), true) = (
                entry.file_name().into_string(),
                entry.path().join(MANIFEST).is_file(),
            ) {
                ids.push(id);
            }
        }
        ids.sort();
        Ok(Self {
            store,
            ids,
            index: None,
        })
    }

    /// One textile whose files are at hand and lie in no folder yet.
    pub(crate) fn of_files(id: &str, files: Vec<BuiltFile>) -> Self {
        Self {
            store: Store::Built(Arc::new(files), PathBuf::from("the new textile")),
            ids: vec![id.to_owned()],
            index: None,
        }
    }

    /// The textiles with these ids of a folder, whatever index it has.
    pub fn of_folder(folder: &Path, ids: &[String]) -> Self {
        Self {
            store: Store::Folder(folder.to_owned()),
            ids: ids.to_vec(),
            index: None,
        }
    }

    fn with_index(store: Store, index: Index) -> Self {
        let ids = index
            .textiles
            .iter()
            .map(|entry| entry.id.clone())
            .collect();
        Self {
            store,
            ids,
            index: Some(index),
        }
    }

    /// The ids of the textiles, in order.
    pub fn ids(&self) -> &[String] {
        &self.ids
    }

    /// What `library.toml` says, if there is one.
    pub fn index(&self) -> Option<&Index> {
        self.index.as_ref()
    }

    /// The tuning of a new scene; no gain and no compression without a `library.toml`.
    pub fn default_tuning(&self) -> Tuning {
        self.index
            .as_ref()
            .map_or_else(Tuning::default, Index::default_tuning)
    }

    /// The folder, or what stands for it in messages.
    pub fn root(&self) -> PathBuf {
        self.store.root()
    }

    /// Whether this is the library that is part of the program.
    pub fn is_shipped(&self) -> bool {
        matches!(self.store, Store::Shipped)
    }

    /// The manifest of a textile: no profile is read, and nothing is built.
    pub fn manifest(&self, id: &str) -> Result<Manifest, TextileError> {
        self.check_id(id)?;
        match &self.store {
            Store::Recipes(recipes) => (recipes.manifest(id).cloned())
                .ok_or_else(|| unknown(id, recipes.path(), &self.ids)),
            store => read_manifest(store, id),
        }
    }

    /// What a textile looks like, without its surface; `None` if it has no picture.
    pub fn appearance(&self, id: &str) -> Result<Option<Appearance>, TextileError> {
        let store = self.files_of(id)?;
        let manifest = read_manifest(&store, id)?;
        read_appearance(&store, id, &manifest)
    }

    /// A textile with its surface. Only its own files are read; a recipe is built.
    ///
    /// # Errors
    /// An unknown id, a file that is missing, wrong or has vanished since the library was opened.
    pub fn load(&self, id: &str) -> Result<Arc<Textile>, TextileError> {
        Textile::load(&self.files_of(id)?, id).map(Arc::new)
    }

    /// Several textiles, in the order of their ids: on as many threads as the machine has, which
    /// changes nothing but the time that it takes.
    pub fn load_all(
        &self,
        ids: &[String],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Arc<Textile>>, TextileError> {
        workers::for_each(ids, workers::n_threads(), progress, |id| self.load(id))
    }

    /// Where the files of a textile are: built, if they were not there.
    pub(crate) fn files_of(&self, id: &str) -> Result<Store, TextileError> {
        self.check_id(id)?;
        match &self.store {
            Store::Recipes(recipes) => {
                let files = recipes.built(id)?;
                Ok(Store::Built(Arc::new(files), recipes.path().to_owned()))
            }
            store => Ok(store.clone()),
        }
    }

    /// Ids come from the index; a folder without one may have gained textiles meanwhile.
    fn check_id(&self, id: &str) -> Result<(), TextileError> {
        let mut parts = Path::new(id).components();
        let is_name = matches!(
            (parts.next(), parts.next()),
            (Some(Component::Normal(_)), None)
        );
        let is_there = match &self.store {
            Store::Folder(folder) => is_name && folder.join(id).join(MANIFEST).is_file(),
            Store::Shipped | Store::Recipes(_) | Store::Built(..) => false,
        };
        if is_there || self.ids.iter().any(|known| known == id) {
            return Ok(());
        }
        Err(unknown(id, &self.root(), &self.ids))
    }
}

/// Whether a library of this name is part of the program.
pub fn is_of_the_program(name: &Path) -> bool {
    name == Path::new(SEVENTY_FOUR)
}

/// There is no textile of that id.
pub(crate) fn unknown(id: &str, library: &Path, ids: &[String]) -> TextileError {
    let known = match ids.split_at_checked(NAMED) {
        _ if ids.is_empty() => "no textiles".to_owned(),
        Some((named, rest)) if !rest.is_empty() => {
            format!("{} and {} more", named.join(", "), rest.len())
        }
        _ => ids.join(", "),
    };
    TextileError::Unknown {
        id: id.to_owned(),
        library: library.display().to_string(),
        known,
    }
}

impl Store {
    /// The text of a file of a textile.
    pub(crate) fn text(&self, id: &str, name: &str) -> Result<String, FileError> {
        match self {
            Self::Folder(_) => read_text(&self.path(id, name)),
            Self::Shipped | Self::Recipes(_) | Self::Built(..) => self
                .read(id, name)
                .map(|bytes| String::from_utf8_lossy(&bytes).into_owned()),
        }
    }

    fn root(&self) -> PathBuf {
        match self {
            Self::Folder(folder) => folder.clone(),
            Self::Shipped => PathBuf::from("the shipped library"),
            Self::Recipes(recipes) => recipes.path().to_owned(),
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
            // Recipes have no files; what was built from one is a store of its own.
            Self::Recipes(_) => None,
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
