//! Edits: the document changes at once, the engine follows with what it needs.

use std::sync::Arc;

use crate::bench::applied_gains::AppliedGains;
use crate::bench::command::edit::Edit;
use crate::bench::gain_set::GainSet;
use crate::bench::keep::Listening;
use crate::bench::preparing::Ready;
use crate::bench::{Bench, editing, preparing};

use selvedge_render::scene::Scene;

impl Bench {
    pub(crate) fn edit(&mut self, edit: &Edit) {
        let before = self.document.scene().clone();
        self.library.acts.is_last = false;
        if let Err(error) = self.document.edit(edit, self.pointer.moment) {
            self.notices.give(error.to_string());
        }
        if matches!(edit, Edit::AddCloth(..) | Edit::AddCloths(_))
            && self.document.scene() != &before
        {
            let n_cloths = self.document.scene().textiles.len();
            self.selection.cloth = n_cloths.checked_sub(1);
        }
        self.follow(&before);
    }

    /// Takes steps of the scene back or brings them again until so many are done.
    pub(crate) fn step_to(&mut self, n_done: usize) {
        let before = self.document.scene().clone();
        self.document.step_to(n_done);
        self.follow(&before);
    }

    /// Lets everything follow that depends on the document, which was `before`.
    fn follow(&mut self, before: &Scene) {
        let after = self.document.scene().clone();
        self.selection.mute_solo.follow(before, &after);
        let selected = self.selection.cloth;
        let is_new = before.textiles.len() < after.textiles.len();
        self.selection.cloth = selected.and_then(|index| {
            let moved = editing::place_after(before, &after, index);
            moved.or_else(|| (is_new && index + 1 == after.textiles.len()).then_some(index))
        });
        if preparing::differs(self.engine_scene.loaded.scene(), &self.heard(&after))
            || self.engine_scene.preparing.is_busy()
        {
            self.prepare(&after);
        } else {
            self.send_gains();
        }
    }

    fn prepare(&mut self, scene: &Scene) {
        let scene = self.gains_now(scene).in_scene(&self.heard(scene));
        let what = (scene, self.settings.preferences.rendering);
        let mut loaded = self.engine_scene.loaded.clone();
        let listening = self.library.acts.listening.as_ref();
        if let Some(new) = listening.and_then(Listening::felt_new) {
            loaded.lend(Arc::clone(new));
        }
        let preparing = &mut self.engine_scene.preparing;
        let asked = preparing.ask(&loaded, what, &self.executor);
        match asked {
            Some(outcome) => self.take_prepared(outcome),
            None => self.poll_prepared(),
        }
    }

    /// Feels textiles anew that stand otherwise in their library now, if they lie in the scene.
    pub(crate) fn render_anew(&mut self, ids: &[String]) {
        let scene = self.document.scene();
        if !scene.textiles.iter().any(|cloth| ids.contains(&cloth.id)) {
            return;
        }
        self.engine_scene.loaded.forget(ids);
        self.feel_document();
    }

    /// Lets the document's scene be felt again after something else was.
    pub(crate) fn feel_document(&mut self) {
        let scene = self.document.scene().clone();
        self.prepare(&scene);
    }

    /// Lets the engine render as the user chose, if it does not yet.
    pub(crate) fn render_as_chosen(&mut self) {
        if self.engine_scene.rendering != self.settings.preferences.rendering
            || self.engine_scene.preparing.is_busy()
        {
            let scene = self.document.scene().clone();
            self.prepare(&scene);
        }
    }

    /// Takes what a thread prepared, if it is done.
    pub(crate) fn poll_prepared(&mut self) {
        let Some((outcome, next)) = self.engine_scene.preparing.poll() else {
            return;
        };
        self.take_prepared(outcome);
        if next.is_some() {
            let scene = self.document.scene().clone();
            self.prepare(&scene);
        }
    }

    fn take_prepared(&mut self, outcome: Result<Ready, String>) {
        match outcome {
            Ok(mut ready) => {
                // The library may have changed meanwhile.
                ready.loaded.use_library(self.engine_scene.loaded.library());
                self.engine_scene.serial = ready.prepared.serial();
                self.send(selvedge_engine::Command::UpdateScene(ready.prepared));
                self.engine_scene.loaded = ready.loaded;
                self.engine_scene.rendering = ready.rendering;
                self.engine_scene.applied_gains = self
                    .engine_scene
                    .applied_gains
                    .after_scene(self.engine_scene.loaded.scene());
                self.scene_has_changed();
                // Gains may have moved on while a thread was at work.
                self.send_gains();
            }
            Err(line) => {
                // The last good scene stays, in the engine and in the document.
                self.notices.give(line);
                let before = self.document.scene().clone();
                let tried = std::mem::replace(
                    &mut self.settings.preferences.rendering,
                    self.engine_scene.rendering,
                );
                if tried != self.engine_scene.rendering {
                    // It was not the scene: what is left of the edit is tried as before.
                    if preparing::differs(self.engine_scene.loaded.scene(), &self.heard(&before)) {
                        self.prepare(&before);
                    }
                    return;
                }
                self.document.take_back();
                if preparing::differs(&before, self.document.scene()) {
                    self.follow(&before);
                }
            }
        }
    }

    /// The gains of the document.
    pub(crate) fn gain_set(&self) -> GainSet {
        GainSet::of(self.document.scene(), self.document.default_tuning())
    }

    /// What is to be felt of a scene now.
    fn gains_now(&self, scene: &Scene) -> AppliedGains {
        let held = self.selection.held_gains.as_ref();
        let held = held.filter(|held| held.gains_db.len() == scene.textiles.len());
        let own = || GainSet::of(scene, self.document.default_tuning());
        let gains = held.cloned().unwrap_or_else(own);
        AppliedGains::of(&gains, &self.selection.mute_solo, self.n_contactors())
    }

    /// Tells the engine which gains changed, if any.
    pub(crate) fn send_gains(&mut self) {
        let new = self.gains_now(self.document.scene());
        let changes = self.engine_scene.applied_gains.changes(&new);
        if !changes.is_empty() {
            new.put_into(&mut self.inspection.scene);
            self.inspection.inspector.set_gains(&self.inspection.scene);
        }
        for command in changes {
            self.send(command);
        }
        self.engine_scene.applied_gains = new;
    }
}
