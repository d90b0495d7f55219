//! The Response pane: what it asks of the scene is computed when it is drawn.

use eframe::egui::{self, Ui};

use crate::bench::Bench;
use crate::shell::desk::Desk;
use crate::tools::response::{ResponseView, curves};
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
