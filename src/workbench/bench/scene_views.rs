//! The scene as panes draw it, and where its numbers come from when they are exported.

use std::sync::Arc;

use crate::bench::export::origin::Origin;
use crate::bench::pane::Pane;
use crate::bench::view::{Marks, SceneView};
use crate::bench::{Bench, query};

impl Bench {
    /// Where numbers of the scene come from.
    pub(crate) fn origin(&self) -> Origin {
        let reference_db = self.live.reference_db;
        let scene = self.document.scene();
        let origin = Origin::of(scene, &self.document.tuning(), reference_db);
        if self.selection.held_gains.is_some() {
            let words = "a slot of tunings is held";
            origin.and("audition", words, words)
        } else if self.library.acts.listening.is_some() {
            let words = "a textile that is not kept is compared";
            origin.and("audition", words, words)
        } else if self.selection.mute_solo.is_any() {
            let words = "parts are muted or felt alone";
            origin.and("audition", words, words)
        } else {
            origin
        }
    }

    /// The same for amplitudes that the engine rendered.
    pub(crate) fn rendered_origin(&self) -> Origin {
        let status = &self.live.status;
        let origin = self.origin().by_method(status.method, status.bound_db);
        match self.device.cloth.as_ref().or(self.device.stylus.as_ref()) {
            Some(words) => origin.and("felt_in_place_of_array", words, words),
            None => origin,
        }
    }

    /// The scene as panes draw it, without a look at pictures.
    pub(crate) fn plain_scene_view(&self) -> SceneView {
        query::scene_view(
            &self.document,
            &self.library.view,
            &self.library.levels,
            &self.selection,
            self.live.reference_db,
        )
    }

    /// Has the levels of the whole library measured under the present filters, as long as it is
    /// asked for them.
    pub(crate) fn follow_library_levels(&mut self) {
        let (loaded, library) = (&self.engine_scene.loaded, &mut self.library);
        let with = (&self.ctx, &self.executor);
        let wants_loudest = self.in_sight.contains(&Pane::Levels);
        library
            .levels
            .follow(with, loaded, &library.view, wants_loudest);
    }

    /// The scene as panes draw it; textiles in it want their pictures.
    pub(crate) fn scene_view(&mut self) -> SceneView {
        if self.shows(Pane::Tuning) || self.shows(Pane::Levels) {
            self.follow_library_levels();
        }
        let placed = &self.document.scene().textiles;
        for cloth in placed {
            self.library.view.want(&cloth.id);
        }
        for flaw in self.library.view.work(&self.ctx, &self.executor) {
            self.notices.give(flaw);
        }
        let mut view = self.plain_scene_view();
        view.picked = Arc::clone(&self.library.selection.0);
        view.marks = Marks {
            cloth: self.selection.cloth,
            hovered: self.selection.hovered,
        };
        view
    }
}
