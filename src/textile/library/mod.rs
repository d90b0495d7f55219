//! Libraries of textiles: a folder, a file of recipes, or one that is part of the program.
//!
//! A library knows its ids; everything else is read when it is asked for.

mod build;
mod cache;
mod folder;
mod id;
mod index;
mod parallel;
mod recipe_file;
mod representatives;
mod store;
mod textile;

#[cfg(test)]
pub(crate) use build::index_of;
pub use cache::BuildCache;
pub use folder::{Change, LibraryFolder, Version, called};
pub use id::{elsewhere, id_in, id_of, nth_id};
#[cfg(test)]
pub(crate) use recipe_file::SEVENTY_FOUR;
pub use recipe_file::is_of_the_program;
pub use representatives::kind_of;
pub use selvedge_foundation::numerics::n_threads;
pub use textile::{Appearance, Textile};

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use crate::build::BuiltFile;
use crate::error::TextileError;
use crate::manifest::{MANIFEST, Manifest};
use crate::shipped;
use crate::tactile::Tuning;
use id::SIXTEEN;
use index::INDEX;
pub use index::{Index, IndexEntry};
use parallel::for_each;
use recipe_file::Recipes;
use selvedge_foundation::files::{FileError, read_text};
use selvedge_foundation::progress::Progress;
pub(crate) use store::Store;
use textile::{read_appearance, read_manifest};

/// Where a library comes from.
#[derive(Debug, Clone)]
enum Place {
    /// Files.
    Files(Store),
    /// Recipes; what follows from them is built when it is asked for.
    Recipes(Arc<Recipes>),
}

/// A library of textiles.
#[derive(Debug, Clone)]
pub struct Library {
    place: Place,
    ids: Vec<String>,
    index: Option<Index>,
    /// Where textiles of libraries of recipes are kept that this one is asked for.
    cache: Option<BuildCache>,
}

impl Library {
    /// The library that is part of the program.
    pub fn shipped() -> Result<Self, TextileError> {
        let path = Store::Shipped.root().join(INDEX);
        let index = Index::from_toml(shipped::INDEX, &path)?;
        Ok(Self::with_index(Store::Shipped, index))
    }

    /// The library that a scene or a person names: `sixteen`, `seventy-four` and `wall-harwin` are
    /// those of the program, others a file of recipes or a folder of textiles.
    ///
    /// What is built from recipes is kept in `cache`; without one it is built anew
    /// every time. A folder or file that is called like a library of the program is named
    /// `./seventy-four`.
    pub fn named(name: &Path, cache: Option<&BuildCache>) -> Result<Self, TextileError> {
        let library = if is_of_the_program(name) {
            Self::of_recipes(Recipes::of_the_program(name, cache.cloned())?)
        } else if name == Path::new(SIXTEEN) {
            Self::shipped()?
        } else if name.is_file() {
            Self::of_recipes(Recipes::read(name, cache.cloned())?)
        } else {
            Self::open(name)?
        };
        Ok(library.with_cache(cache))
    }

    /// The same; the shipped one where none is named.
    ///
    /// # Errors
    /// As [`Self::named`].
    pub fn named_or_shipped(
        name: Option<&Path>,
        cache: Option<&BuildCache>,
    ) -> Result<Self, TextileError> {
        name.map_or_else(Self::shipped, |name| Self::named(name, cache))
    }

    /// What a file in `folder` calls `name`, as seen from where the program runs: a library of the
    /// program keeps its name.
    pub fn place(name: &Path, folder: &Path) -> PathBuf {
        if is_of_the_program(name) {
            name.to_owned()
        } else {
            folder.join(name)
        }
    }

    /// The same, with a place for what is built of other libraries.
    #[must_use]
    pub fn with_cache(self, cache: Option<&BuildCache>) -> Self {
        Self {
            cache: cache.cloned(),
            ..self
        }
    }

    fn new(place: Place, ids: Vec<String>, index: Option<Index>) -> Self {
        Self {
            place,
            ids,
            index,
            cache: None,
        }
    }

    fn of_recipes(recipes: Recipes) -> Self {
        let (ids, index) = (recipes.ids(), recipes.index().cloned());
        Self::new(Place::Recipes(Arc::new(recipes)), ids, index)
    }

    /// A folder with textiles. Without a `library.toml` its textiles are the sub-folders that hold
    /// a manifest, in the order of their names.
    pub fn open(folder: &Path) -> Result<Self, TextileError> {
        let failed = FileError::read(folder);
        let entries = fs::read_dir(folder).map_err(&failed)?;
        let path = folder.join(INDEX);
        if path.exists() {
            let index = Index::from_toml(&read_text(&path)?, &path)?;
            return Ok(Self::with_index(Store::Folder(folder.to_owned()), index));
        }
        let mut ids = Vec::new();
        for entry in entries {
            let entry = entry.map_err(&failed)?;
            if let (Ok(id), true) = (
                entry.file_name().into_string(),
                entry.path().join(MANIFEST).is_file(),
            ) {
                ids.push(id);
            }
        }
        ids.sort();
        Ok(Self::of_folder(folder, &ids))
    }

    /// One textile whose files are at hand and lie in no folder yet.
    pub fn of_files(id: &str, files: Vec<BuiltFile>) -> Self {
        let store = Store::Built(Arc::new(files), PathBuf::from("the new textile"));
        Self::new(Place::Files(store), vec![id.to_owned()], None)
    }

    /// The textiles with these ids of a folder, whatever index it has.
    pub(crate) fn of_folder(folder: &Path, ids: &[String]) -> Self {
        let store = Store::Folder(folder.to_owned());
        Self::new(Place::Files(store), ids.to_vec(), None)
    }

    fn with_index(store: Store, index: Index) -> Self {
        let ids = index.textiles.iter().map(|entry| entry.id.clone());
        Self::new(Place::Files(store), ids.collect(), Some(index))
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
        match &self.place {
            Place::Files(store) => store.root(),
            Place::Recipes(recipes) => recipes.path().to_owned(),
        }
    }

    /// Whether this is the library that is part of the program.
    pub fn is_shipped(&self) -> bool {
        matches!(self.place, Place::Files(Store::Shipped))
    }

    /// The manifest of a textile: no profile is read, and nothing is built. Here as elsewhere the
    /// id may be that of a textile of another library ([`elsewhere`]).
    pub fn manifest(&self, id: &str) -> Result<Manifest, TextileError> {
        if let Some((library, id)) = self.other_of(id)? {
            return library.manifest(id);
        }
        self.check_id(id)?;
        match &self.place {
            Place::Recipes(recipes) => (recipes.manifest(id).cloned())
                .ok_or_else(|| TextileError::unknown(id, recipes.path(), &self.ids)),
            Place::Files(store) => read_manifest(store, id),
        }
    }

    /// What a textile looks like, without its surface; `None` if it has no picture.
    pub fn appearance(&self, id: &str) -> Result<Option<Appearance>, TextileError> {
        if let Some((library, id)) = self.other_of(id)? {
            return library.appearance(id);
        }
        let store = self.store_of(id)?;
        let manifest = read_manifest(&store, id)?;
        read_appearance(&store, id, &manifest)
    }

    /// A textile with its surface. Only its own files are read; a recipe is built.
    ///
    /// # Errors
    /// An unknown id, a file that is missing, wrong or has vanished since the library was opened.
    pub fn load(&self, id: &str) -> Result<Arc<Textile>, TextileError> {
        let textile = match self.other_of(id)? {
            Some((library, plain)) => Textile::load(&library.store_of(plain)?, plain)?.known_as(id),
            None => Textile::load(&self.store_of(id)?, id)?,
        };
        Ok(Arc::new(textile))
    }

    /// A textile of whose files the manifest alone is read, for places where nothing is felt of it:
    /// its surface is flat, and nothing is built.
    ///
    /// # Errors
    /// An unknown id, a manifest that is missing or wrong.
    pub fn unread(&self, id: &str) -> Result<Arc<Textile>, TextileError> {
        Ok(Arc::new(Textile::unread(id, self.manifest(id)?)))
    }

    /// Several textiles, in the order of their ids: on as many threads as the machine has, which
    /// changes nothing but the time that it takes.
    pub fn load_all(
        &self,
        ids: &[String],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Arc<Textile>>, TextileError> {
        for_each(ids, n_threads(), progress, |id| self.load(id))
    }

    /// The other library that an id names, and the id there; `None` for a textile of this one.
    fn other_of<'a>(&self, id: &'a str) -> Result<Option<(Self, &'a str)>, TextileError> {
        match elsewhere(id).filter(|_| !self.ids.iter().any(|own| own == id)) {
            Some((name, id)) => Ok(Some((Self::named(name, self.cache.as_ref())?, id))),
            None => Ok(None),
        }
    }

    /// Where the files of a textile are: built, if they were not there.
    pub(crate) fn store_of(&self, id: &str) -> Result<Store, TextileError> {
        self.check_id(id)?;
        match &self.place {
            Place::Recipes(recipes) => {
                let files = recipes.built(id)?;
                Ok(Store::Built(Arc::new(files), recipes.path().to_owned()))
            }
            Place::Files(store) => Ok(store.clone()),
        }
    }

    /// Ids come from the index; a folder without one may have gained textiles meanwhile.
    fn check_id(&self, id: &str) -> Result<(), TextileError> {
        let mut parts = Path::new(id).components();
        let is_name = matches!(
            (parts.next(), parts.next()),
            (Some(Component::Normal(_)), None)
        );
        let is_there = match &self.place {
            Place::Files(Store::Folder(folder)) => {
                is_name && folder.join(id).join(MANIFEST).is_file()
            }
            Place::Files(Store::Shipped | Store::Built(..)) | Place::Recipes(_) => false,
        };
        if is_there || self.ids.iter().any(|known| known == id) {
            return Ok(());
        }
        Err(TextileError::unknown(id, &self.root(), &self.ids))
    }
}
