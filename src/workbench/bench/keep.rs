//! New textiles from the window: kept in the scene's library, and felt if that is wanted.
//!
//! A library that is part of the program cannot take any. Then the user's own folder takes them: it
//! begins as a copy of that library, and the scene uses it from then on, with all it had.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::background::{Executor, Task};
use crate::bench::view::LibraryEntry;
use selvedge_foundation::progress::Progress;
use selvedge_textile::{BuiltFile, Library, TextileError, n_threads};

/// A textile that was made in the window and lies in no folder yet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NewTextile {
    /// The id that it is wished to have; the next free one is taken when there is such a textile.
    pub id: String,
    /// Its name.
    pub name: String,
    /// Its files, the manifest among them.
    pub files: Vec<BuiltFile>,
}

/// What can be done with new textiles.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Keep {
    /// Keep them in the library.
    Save(Arc<Vec<NewTextile>>),
    /// Keep them, and lay the first under the display.
    Feel(Arc<Vec<NewTextile>>),
}

impl Keep {
    /// Of textiles that are to be felt, or not.
    pub(crate) fn of(textiles: Arc<Vec<NewTextile>>, is_felt: bool) -> Self {
        if is_felt {
            Self::Feel(textiles)
        } else {
            Self::Save(textiles)
        }
    }
}

/// Textiles that were kept.
#[derive(Debug)]
pub(crate) struct Kept {
    /// The library that has them now.
    pub library: Arc<Library>,
    /// Its textiles.
    pub(crate) library_view: Vec<LibraryEntry>,
    /// Its folder.
    pub folder: PathBuf,
    /// The library that the window had when this was asked for.
    pub before: PathBuf,
    /// The ids that the new ones got.
    pub ids: Vec<String>,
    /// Whether the first is to be felt.
    pub(crate) is_to_feel: bool,
}

/// Keeps textiles, one wish at a time.
#[derive(Debug, Default)]
pub(crate) struct Keeping {
    pub(crate) task: Option<Task<Kept>>,
    pub(crate) next: VecDeque<Keep>,
    /// The folder that holds the user's own libraries; a stepped window has none.
    pub(crate) own_folder: Option<PathBuf>,
}

impl Keeping {
    /// Begins to keep textiles in `library`, or queues the wish.
    ///
    /// # Errors
    /// There is no folder for them.
    pub(crate) fn ask(
        &mut self,
        keep: Keep,
        library: &Arc<Library>,
        executor: &Executor,
    ) -> Result<(), String> {
        if self.task.is_some() {
            self.next.push_back(keep);
            return Ok(());
        }
        let folder = self.folder_for(library)?;
        let library = Arc::clone(library);
        self.task = Some(executor.start("selvedge-keep", move |progress| {
            let kept = keep_in(&library, folder, &keep, progress);
            kept.map_err(|error| error.to_string())
        }));
        Ok(())
    }

    /// Where this library keeps new textiles: in its own folder, if it is one.
    fn folder_for(&self, library: &Library) -> Result<PathBuf, String> {
        let root = library.root();
        if root.is_dir() {
            return Ok(root);
        }
        let Some(own) = &self.own_folder else {
            let words = "This system has no folder for a user's files; save the scene with a \
                         library folder of its own, then keep the textile";
            return Err(words.to_owned());
        };
        let name = match root.file_stem() {
            Some(stem) if !library.is_shipped() => Path::new(stem).to_owned(),
            _ => PathBuf::from("textiles"),
        };
        Ok(own.join(name))
    }
}

fn keep_in(
    library: &Library,
    folder: PathBuf,
    keep: &Keep,
    progress: &mut Progress<'_>,
) -> Result<Kept, TextileError> {
    let (new, is_to_feel) = match keep {
        Keep::Save(new) => (new, false),
        Keep::Feel(new) => (new, true),
    };
    let textiles: Vec<(String, Vec<BuiltFile>)> = new
        .iter()
        .map(|new| (new.id.clone(), new.files.clone()))
        .collect();
    let before = library.root();
    let (library, ids) = library.add(&textiles, &folder, n_threads(), progress)?;
    Ok(Kept {
        library_view: crate::bench::library_view::items_of(&library),
        library: Arc::new(library),
        folder,
        before,
        ids,
        is_to_feel,
    })
}
