//! Keeping: new textiles go into the library, and the scene follows.

use std::mem;
use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::edit::Edit;
use crate::bench::keep::{Keep, Kept};
use crate::bench::library_view::LibraryView;
use crate::shell::error::AppError;
use selvedge_foundation::geometry::Point;

impl Bench {
    pub(crate) fn keep(&mut self, ctx: &egui::Context, keep: Keep) {
        let library = Arc::clone(self.loaded.library());
        let keeping = &mut self.transient.keeping;
        if let Some(outcome) = keeping.ask(keep, &library, ctx, self.is_stepped) {
            self.take_kept(ctx, outcome);
        }
    }

    /// Takes textiles that a thread has kept, and lets the next wish begin.
    pub(crate) fn poll_kept(&mut self, ctx: &egui::Context) {
        let Some((outcome, next)) = self.transient.keeping.poll() else {
            return;
        };
        self.take_kept(ctx, outcome);
        if let Some(next) = next {
            self.keep(ctx, next);
        }
    }

    fn take_kept(&mut self, ctx: &egui::Context, outcome: Result<Kept, AppError>) {
        let kept = match outcome {
            Ok(kept) => kept,
            Err(error) => return self.transient.notices.give(error.to_string()),
        };
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
        let library_view = mem::replace(&mut self.library_view, nothing);
        self.library_view = library_view.with_library(kept.library, kept.library_view);
        if is_another {
            self.document.use_library(&kept.folder);
        }
        self.scene_has_changed();
        if let (true, Some(first)) = (kept.is_to_feel, kept.ids.into_iter().next()) {
            let [width, height] = self.document.scene().size_mm;
            let middle = Point::new(0.5 * width, 0.5 * height);
            let place = self.transient.live.centre.unwrap_or(middle);
            self.dispatch(ctx, Edit::AddCloth(first, place).into());
        }
    }
}
