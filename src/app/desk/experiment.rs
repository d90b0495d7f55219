//! The two views of a session; and what nobody may look at while one is held.

use eframe::egui::Ui;

use super::Desk;
use crate::app::arrangement::Pane;
use crate::app::experiment::Link;
use crate::app::panes::{self, ExperimenterHands};
use crate::app::window::Workbench;

impl Desk<'_> {
    pub(super) fn show_participant(&mut self, ui: &mut Ui) {
        let now_s = ui.input(|input| input.time);
        let bench = &*self.bench;
        let view = bench
            .transient
            .experiment
            .participant(&bench.transient.live, now_s);
        let shown = panes::show_participant(ui, &view, self.wishes);
        if shown.is_some() {
            self.shown = shown;
        }
    }

    pub(super) fn show_experimenter(&mut self, ui: &mut Ui) {
        let now_s = ui.input(|input| input.time);
        let transient = &mut self.bench.transient;
        let live = &transient.live;
        let link = Link::of(
            (live.bridge.as_ref(), transient.target.as_deref()),
            live.is_stopped,
            self.bench.engine.profile().limit_um,
        );
        let experiment = &mut transient.experiment;
        let view = experiment.experimenter(link, now_s);
        let mut hands = ExperimenterHands {
            note: experiment.held.as_mut().map(|held| &mut held.note),
            form: &mut experiment.form,
        };
        panes::show_experimenter(ui, &view, &mut hands, self.wishes);
    }
}

impl Workbench {
    /// Whether a pane would tell what a session must not.
    pub(super) fn is_veiled(&self, pane: Pane) -> bool {
        // The analysis has a cover of its own.
        let is_open = matches!(
            pane,
            Pane::Participant | Pane::Experimenter | Pane::Bridge | Pane::Analysis
        );
        self.transient.experiment.is_held() && !is_open
    }
}
