//! The workspace with its overlays, and the Response pane: what they ask of the scene is computed
//! when they are drawn, and only what is switched on.

use eframe::egui::{self, Ui};

use crate::bench::Bench;
use crate::shell::desk::Desk;
use crate::tools::response::{ResponseView, curves};
use crate::tools::workspace;
use crate::tools::workspace::maps;
use crate::tools::workspace::overlay::{Layers, Overlay};
use selvedge_foundation::geometry::Velocity;

/// What the Response pane shows curves of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Asked {
    /// The textile's place in the scene's list.
    pub textile: usize,
    /// The amplitude factors of its gains, by band.
    pub factors: [f64; 2],
    /// The chosen contactor and the points that it reads; `None` while it is not on the textile.
    pub place: Option<(usize, [usize; 4])>,
    /// The chosen contactor's own velocity in the workspace.
    pub moving: Option<Velocity>,
}

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

    pub(crate) fn show_response(&mut self, ui: &Ui) {
        let asked = self.context.bench.ask_response(ui.ctx());
        let bench = &*self.context.bench;
        let cloth =
            asked.and_then(|asked| Some((asked, self.context.scene.cloths.get(asked.textile)?)));
        let name = cloth.map(|(_, cloth)| format!("{} {}", cloth.label, cloth.name));
        let name = name.as_deref().map_or("", str::trim);
        let view =
            cloth.map(|(asked, cloth)| bench.response_view(&asked, (name, cloth.rotation_deg)));
        crate::tools::response::show(ui, view.as_ref(), self.context.commands);
    }
}

impl Bench {
    /// What the Response pane draws of a textile with this name and turn, degrees.
    pub(crate) fn response_view<'a>(
        &'a self,
        asked: &Asked,
        (textile, rotation_deg): (&'a str, f64),
    ) -> ResponseView<'a> {
        ResponseView {
            textile,
            rotation_deg,
            factors: asked.factors,
            place: asked.place,
            curves: &self.transient.curves,
            probe: self.workspace.probe,
            moving: asked.moving,
            scale: self.workspace.scale,
        }
    }

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

    /// Has the curves of the textile that is chosen, or else of the one under the chosen contactor,
    /// or which was there last; `None` without any.
    pub(crate) fn ask_response(&mut self, ctx: &egui::Context) -> Option<Asked> {
        let mut readings = std::mem::take(&mut self.transient.readings);
        let live = &self.transient.live;
        readings.clear();
        if live.centre.is_some() {
            self.inspection
                .inspector
                .readings_into(0, &live.pose, &mut readings);
        }
        let contactor = self.workspace.contactor;
        let read = contactor.and_then(|index| Some((index, *readings.get(index)?)));
        self.transient.readings = readings;
        let under = read.and_then(|(_, moving)| moving.reading);
        let textile = self
            .workspace
            .cloth
            .or_else(|| under.map(|reading| reading.textile))
            .or(self.transient.asked_textile)?;
        self.transient.asked_textile = Some(textile);
        let response = self.inspection.inspector.response(textile)?;
        let on_it = under.filter(|reading| reading.textile == textile);
        let place = contactor.zip(on_it.map(|reading| reading.points));
        let asked = Asked {
            textile,
            factors: response.factors(),
            place,
            moving: read.map(|(_, moving)| moving.velocity),
        };
        let wanted = curves::Wanted {
            response,
            points: place.map(|(_, points)| points),
            probe: self.workspace.probe,
        };
        self.transient.curves.catch_up(ctx, wanted, self.is_stepped);
        Some(asked)
    }
}
