//! New textiles from the window: kept in the scene's library, and felt if that is wanted.
//!
//! A library that is part of the program cannot take any. Then the user's own folder takes them: it
//! begins as a copy of that library, and the scene uses it from then on, with all it had.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::{Executor, Task, finished};
use crate::bench::command::edit::Edit;
use crate::bench::library_view::LibraryView;
use crate::bench::view::ShelfItem;
use selvedge_foundation::geometry::Point;
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

/// Textiles that were kept.
#[derive(Debug)]
pub(crate) struct Kept {
    /// The library that has them now.
    pub library: Arc<Library>,
    /// Its textiles.
    pub(crate) library_view: Vec<ShelfItem>,
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
    task: Option<Task<Kept>>,
    next: VecDeque<Keep>,
    /// The folder that holds the user's own libraries; a stepped window has none.
    pub(crate) own_folder: Option<PathBuf>,
}

impl Keeping {
    /// Begins to keep textiles in `library`, or queues the wish.
    ///
    /// # Errors
    /// There is no folder for them.
    fn ask(
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

impl Bench {
    /// Keeps textiles in the library.
    pub(crate) fn keep(&mut self, keep: Keep) {
        let library = Arc::clone(self.loaded.library());
        let keeping = &mut self.transient.keeping;
        match keeping.ask(keep, &library, &self.executor) {
            Ok(()) => self.poll_kept(),
            Err(line) => self.transient.notices.give(line),
        }
    }

    /// Takes textiles that were kept, and lets the next wish begin.
    pub(crate) fn poll_kept(&mut self) {
        let Some(outcome) = finished(&mut self.transient.keeping.task) else {
            return;
        };
        match outcome {
            Ok(kept) => self.take_kept(kept),
            Err(line) => self.transient.notices.give(line),
        }
        if let Some(next) = self.transient.keeping.next.pop_front() {
            self.keep(next);
        }
    }

    fn take_kept(&mut self, kept: Kept) {
        let words = format!("Kept {} in {}", kept.ids.join(", "), kept.folder.display());
        self.transient.notices.give(words);
        let root = self.loaded.library().root();
        if root != kept.before && root != kept.folder {
            // Another scene was opened meanwhile, over a library of its own.
            return;
        }
        let is_another = root != kept.folder;
        self.loaded.use_library(&kept.library);
        let nothing = LibraryView::new(Arc::clone(&kept.library), Vec::new());
        let library_view = std::mem::replace(&mut self.library_view, nothing);
        self.library_view = library_view.with_library(kept.library, kept.library_view);
        if is_another {
            self.document.use_library(&kept.folder);
        }
        self.scene_has_changed();
        if let (true, Some(first)) = (kept.is_to_feel, kept.ids.into_iter().next()) {
            let [width, height] = self.document.scene().size_mm;
            let middle = Point::new(0.5 * width, 0.5 * height);
            let place = self.transient.live.centre.unwrap_or(middle);
            self.commands.push(Edit::AddCloth(first, place).into());
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::vec2;

    use super::*;
    use crate::bench::command::Command;
    use crate::shell::headless::Headless;
    use selvedge_scratch::ScratchFolder;
    use selvedge_textile::{Manifest, build};

    /// A window whose own libraries lie in a folder of this test's.
    fn window(name: &str) -> (Headless, ScratchFolder) {
        let folder = ScratchFolder::new(name);
        let mut window = Headless::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
        window.workbench.bench.transient.keeping.own_folder = Some(folder.to_owned());
        window.pass(1);
        (window, folder)
    }

    fn new_textiles(n: usize) -> Arc<Vec<NewTextile>> {
        let make = |seed| {
            let text = format!(
                "name = \"Own\"\nconstruction = \"other\"\nfibre = \"\"\n\
                 [source]\nkind = \"brownian\"\nhurst = 0.5\nsmd_um = 3.0\nseed = {seed}\n"
            );
            let path = Path::new("own.toml");
            NewTextile {
                id: "own".to_owned(),
                name: "Own".to_owned(),
                files: build(&Manifest::from_toml(&text, path).unwrap(), path).unwrap(),
            }
        };
        Arc::new((1..=n).map(make).collect())
    }

    #[test]
    fn a_new_textile_is_felt_and_the_scene_takes_the_users_own_library() {
        let (mut window, folder) = window("feel");
        window.dispatch(Keep::Feel(new_textiles(1)));
        window.pass(1);
        let bench = &window.workbench.bench;
        let own = folder.join("textiles");
        assert_eq!(
            bench.document.scene().library.as_deref(),
            Some(own.as_path())
        );
        let ids: Vec<&str> = bench.loaded.textiles().iter().map(|t| t.id()).collect();
        assert_eq!(ids.len(), 5, "four alternatives and the new one");
        assert_eq!(ids[4], "own");
        assert!(bench.library_view.item("own").is_some() && bench.library_view.items().len() == 17);
        window.dispatch(Command::Undo);
        window.pass(1);
        let bench = &window.workbench.bench;
        assert_eq!(bench.loaded.textiles().len(), 4, "one step back");
        assert_eq!(
            bench.document.scene().library.as_deref(),
            Some(own.as_path()),
            "the library has all that there was"
        );
    }

    #[test]
    fn several_are_kept_with_numbers_and_the_next_go_into_the_same_folder() {
        let (mut window, _folder) = window("several");
        window.dispatch(Keep::Save(new_textiles(2)));
        window.dispatch(Keep::Save(new_textiles(1)));
        window.pass(1);
        let ids = window.workbench.bench.loaded.library().ids()[16..].to_vec();
        assert_eq!(ids, ["own", "own-2", "own-3"]);
        assert_eq!(
            window.workbench.bench.loaded.textiles().len(),
            4,
            "none was placed"
        );
    }

    #[test]
    fn without_a_folder_nothing_is_kept_and_a_sentence_says_so() {
        let (mut window, folder) = window("nowhere");
        window.workbench.bench.transient.keeping.own_folder = None;
        window.dispatch(Keep::Feel(new_textiles(1)));
        window.pass(1);
        let shown = window.workbench.bench.transient.notices.shown();
        assert_eq!(shown.len(), 1);
        assert!(shown[0].text.contains("no folder"), "{}", shown[0].text);
        assert_eq!(window.workbench.bench.loaded.library().ids().len(), 16);
        assert!(!folder.exists());
    }
}
