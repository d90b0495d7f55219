//! New textiles go into the library, and the scene follows.

use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::background::finished;
use crate::bench::command::edit::Edit;
use crate::bench::keep::{Keep, Kept};
use crate::bench::library_view::LibraryView;
use selvedge_foundation::geometry::Point;

impl Bench {
    /// Keeps textiles in the library.
    pub(crate) fn keep(&mut self, keep: Keep) {
        let library = Arc::clone(self.engine_scene.loaded.library());
        let keeping = &mut self.library.keeping;
        match keeping.ask(keep, &library, &self.executor) {
            Ok(()) => self.poll_kept(),
            Err(line) => self.notices.give(line),
        }
    }

    /// Takes textiles that were kept, and lets the next wish begin.
    pub(crate) fn poll_kept(&mut self) {
        let Some(outcome) = finished(&mut self.library.keeping.task) else {
            return;
        };
        match outcome {
            Ok(kept) => self.take_kept(kept),
            Err(line) => self.notices.give(line),
        }
        if let Some(next) = self.library.keeping.next.pop_front() {
            self.keep(next);
        }
    }

    fn take_kept(&mut self, kept: Kept) {
        let words = format!("Kept {} in {}", kept.ids.join(", "), kept.folder.display());
        self.notices.give(words);
        let root = self.engine_scene.loaded.library().root();
        if root != kept.before && root != kept.folder {
            // Another scene was opened meanwhile, over a library of its own.
            return;
        }
        let is_another = root != kept.folder;
        self.engine_scene.loaded.use_library(&kept.library);
        let nothing = LibraryView::new(Arc::clone(&kept.library), Vec::new());
        let library_view = std::mem::replace(&mut self.library.view, nothing);
        self.library.view = library_view.with_library(kept.library, kept.library_view);
        if is_another {
            self.document.use_library(&kept.folder);
        }
        self.scene_has_changed();
        if let (true, Some(first)) = (kept.is_to_feel, kept.ids.into_iter().next()) {
            let [width, height] = self.document.scene().size_mm;
            let middle = Point::new(0.5 * width, 0.5 * height);
            let place = self.live.centre.unwrap_or(middle);
            self.commands.push(Edit::AddCloth(first, place).into());
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use eframe::egui::vec2;

    use super::*;
    use crate::bench::command::Command;
    use crate::bench::keep::NewTextile;
    use crate::shell::headless::Headless;
    use selvedge_scratch::ScratchFolder;
    use selvedge_textile::{Manifest, build};

    /// A window whose own libraries lie in a folder of this test's.
    fn window(name: &str) -> (Headless, ScratchFolder) {
        let folder = ScratchFolder::new(name);
        let mut window = Headless::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
        window.workbench.bench.library.keeping.own_folder = Some(folder.to_owned());
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
        let ids: Vec<&str> = bench
            .engine_scene
            .loaded
            .textiles()
            .iter()
            .map(|t| t.id())
            .collect();
        assert_eq!(ids.len(), 5, "four alternatives and the new one");
        assert_eq!(ids[4], "own");
        assert!(bench.library.view.item("own").is_some() && bench.library.view.items().len() == 17);
        window.dispatch(Command::Undo);
        window.pass(1);
        let bench = &window.workbench.bench;
        assert_eq!(
            bench.engine_scene.loaded.textiles().len(),
            4,
            "one step back"
        );
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
        let ids = window.workbench.bench.engine_scene.loaded.library().ids()[16..].to_vec();
        assert_eq!(ids, ["own", "own-2", "own-3"]);
        assert_eq!(
            window.workbench.bench.engine_scene.loaded.textiles().len(),
            4,
            "none was placed"
        );
    }

    #[test]
    fn without_a_folder_nothing_is_kept_and_a_sentence_says_so() {
        let (mut window, folder) = window("nowhere");
        window.workbench.bench.library.keeping.own_folder = None;
        window.dispatch(Keep::Feel(new_textiles(1)));
        window.pass(1);
        let shown = window.workbench.bench.notices.shown();
        assert_eq!(shown.len(), 1);
        assert!(shown[0].text.contains("no folder"), "{}", shown[0].text);
        assert_eq!(
            window
                .workbench
                .bench
                .engine_scene
                .loaded
                .library()
                .ids()
                .len(),
            16
        );
        assert!(!folder.exists());
    }
}
