//! The workspace with its overlays: what they ask of the scene is computed when they are drawn, and
//! only what is switched on.

use eframe::egui::{self, Ui};

use crate::bench::Bench;
use crate::shell::desk::Desk;
use crate::tools::workspace;
use crate::tools::workspace::maps;
use crate::tools::workspace::overlay::{Layers, Overlay};

impl Desk<'_> {
    pub(crate) fn show_workspace(&mut self, ui: &mut Ui) {
        self.context.bench.prepare_overlays(ui.ctx());
        let bench = &*self.context.bench;
        let transient = &bench.transient;
        let layers = Layers {
            readings: &transient.readings,
            maps: &transient.maps,
            lattice: &transient.lattice,
            colours: bench.settings.preferences.colour_map,
        };
        let (live, state) = (&transient.live, &bench.workspace);
        let over = (&transient.trail, layers);
        let shown = workspace::show(
            ui,
            self.context.scene,
            live,
            over,
            state,
            self.context.commands,
        );
        *self.context.ground = Some(shown);
    }
}

impl Bench {
    /// Has what the workspace's overlays show.
    pub(crate) fn prepare_overlays(&mut self, ctx: &egui::Context) {
        let overlays = self.workspace.overlays;
        let transient = &mut self.transient;
        if overlays.shows(Overlay::Points) {
            transient.lattice.prepare(ctx);
        }
        transient.readings.clear();
        if overlays.need_readings() && transient.live.centre.is_some() {
            let pose = &transient.live.pose;
            let readings = &mut transient.readings;
            self.inspection.inspector.readings_into(0, pose, readings);
        }
        let Some(band) = overlays.map() else {
            transient.maps.clear();
            return;
        };
        let wanted = maps::Wanted {
            velocity: self.workspace.probe.velocity(),
            band,
            scale: self.workspace.scale,
            colours: self.settings.preferences.colour_map,
        };
        let inspector = &self.inspection.inspector;
        transient
            .maps
            .catch_up(ctx, inspector, wanted, self.is_stepped);
    }
}
