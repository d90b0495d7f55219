//! A textile's amplitudes over the direction and the speed of movement: at the points that the
//! chosen contactor reads, and over all its points.
//!
//! Both plots are also controls: a drag chooses the direction or the speed at which the other plot,
//! and the maps over the cloth, are asked.

pub(crate) mod chart;
pub(crate) mod curves;
pub(crate) mod over_speed;
pub(crate) mod polar;
pub(crate) mod shown;
#[cfg(test)]
mod tests;

use eframe::egui::{Align2, Rect, Ui, pos2};

use crate::bench::Bench;
use crate::bench::command::{Commands, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::pane::Pane;
use crate::bench::probe::Probe;
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::SceneView;
use crate::kit::pane::framed;
use crate::kit::pane::paint_sentence;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::{quiet, toggle};
use crate::tools::response::curves::{Curves, Wanted};
use crate::tools::response::shown::ResponseView;
use selvedge_foundation::quantity;
use selvedge_render::array::ContactorReading;
use selvedge_textile::tactile::Band;

/// Height of the line above the plots, points.
const LINE: f32 = 18.0;
/// A textile's amplitudes over direction and speed.
#[derive(Debug, Default)]
pub(crate) struct Response {
    /// The curves as they were computed last.
    pub(crate) curves: Curves,
    /// The textile whose curves were shown last.
    pub(crate) textile: Option<usize>,
    /// What the contactors read and how they move.
    readings: Vec<ContactorReading>,
}

impl Response {
    /// Has the curves of the textile that is chosen, or else of the one under the chosen contactor,
    /// or which was there last; `None` without any.
    fn view(&mut self, bench: &mut Bench, scene: &SceneView) -> Option<ResponseView<'_>> {
        let display = bench.display();
        let (live, inspector) = (&bench.live, &mut bench.inspection.inspector);
        self.readings.clear();
        if live.centre.is_some() {
            inspector.readings_into(display, &live.pose, &mut self.readings);
        }
        let contactor = bench.selection.contactor;
        let read = contactor.and_then(|index| self.readings.get(index));
        let under = read.and_then(|moving| moving.reading);
        let chosen = bench.selection.cloth;
        let textile = chosen.or_else(|| under.map(|reading| reading.textile));
        let textile = textile.or(self.textile)?;
        self.textile = Some(textile);
        let response = inspector.response(textile)?;
        let factors = response.factors();
        let on_it = under.filter(|reading| reading.textile == textile);
        let place = contactor.zip(on_it.map(|reading| reading.points));
        let moving = read.map(|moving| moving.velocity);
        let probe = bench.selection.probe;
        let wanted = Wanted {
            response,
            points: place.map(|(_, points)| points),
            probe,
        };
        (self.curves).follow(&bench.ctx, &bench.executor, wanted);
        let cloth = scene.cloths.get(textile)?;
        Some(ResponseView {
            textile: cloth.title(),
            rotation_deg: cloth.rotation_deg,
            factors,
            uncertainty: bench.engine_scene.uncertainty(textile).cloned(),
            place,
            curves: &self.curves,
            probe,
            moving,
            scale: bench.selection.scale,
        })
    }
}

impl Tool for Response {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Response]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let view = self.view(context.bench, context.scene);
        framed(ui, 10, |ui| show(ui, view.as_ref(), context.commands));
    }

    /// Whether the plots follow the display.
    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let probe = context.bench.selection.probe;
        let tip = "Ask at the display's own velocity, to two digits and 5°";
        if toggle(ui, "follow", probe.follows, tip) {
            let probe = probe.with_follow(!probe.follows);
            context.commands.push(ShowCommand::Probe(probe).into());
        }
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let scene = bench.plain_scene_view();
        let view = self.view(bench, &scene);
        let view = view.ok_or(
            "There is nothing to export: choose a textile in the workspace, or move the chosen \
             contactor over one",
        )?;
        if view.curves.around().is_empty() {
            return Err("There is nothing to export yet: the curves are being computed");
        }
        Ok(chart::exported(&view, bench.origin()))
    }

    fn leave_scene(&mut self, _bench: &mut Bench) {
        self.textile = None;
    }
}

/// Shows both plots; without a textile, what to do.
fn show(ui: &Ui, view: Option<&ResponseView<'_>>, commands: &mut Commands) {
    let whole = ui.max_rect();
    let Some(view) = view else {
        let words = "Choose a textile in the workspace, or move the chosen contactor over one";
        paint_sentence(ui.painter(), whole, words);
        return;
    };
    paint_heading(ui, whole, view);
    let below = whole.with_min_y(whole.top() + LINE);
    if view.curves.around().is_empty() {
        paint_sentence(ui.painter(), below, "Its curves are being computed");
        return;
    }
    let is_wide = below.width() > 1.2 * below.height();
    let (left, right) = if is_wide {
        let side = (below.height() + 30.0).min(0.55 * below.width());
        below.split_left_right_at_x(below.left() + side)
    } else {
        let side = below.width().min(0.5 * below.height());
        below.split_top_bottom_at_y(below.top() + side)
    };
    polar::show(ui, left, view, commands);
    over_speed::show(ui, right, view, commands);
}

/// The textile, the velocity, and what it gives there.
fn paint_heading(ui: &Ui, whole: Rect, view: &ResponseView<'_>) {
    let palette = Palette::in_ui(ui);
    let middle = whole.top() + 0.5 * LINE - 2.0;
    let painter = ui.painter();
    let mut right = whole.right();
    let here = view.curves.here().map(|here| here.scaled(view.factors));
    for band in [Band::High, Band::Low] {
        let Some(here) = here else { continue };
        let um = here.at_place_um.unwrap_or(here.rms_um)[band.index()];
        let words = format!("{:>6} dB", quantity::fixed(quantity::level_db(um), 1));
        let at = pos2(right, middle);
        let font = theme::number();
        let text = painter.text(at, Align2::RIGHT_CENTER, words, font, palette.band(band));
        right = text.left() - 10.0;
    }
    let words = velocity_words(view.probe);
    let font = theme::number();
    let text = painter.text(
        pos2(right, middle),
        Align2::RIGHT_CENTER,
        words,
        font,
        palette.text,
    );
    let room = text.left() - whole.left() - 10.0;
    let place = view.place.map_or_else(String::new, |(contactor, _)| {
        format!("  ·  at contactor {contactor}")
    });
    let name = quiet(format!("{}{place}", view.textile));
    crate::kit::widgets::text::paint_line(ui, pos2(whole.left(), middle), room, name);
}

/// A speed and a direction in fixed digits.
fn velocity_words(probe: Probe) -> String {
    format!(
        "{:>4} mm/s {:>3}°",
        quantity::fixed(probe.speed_mm_per_s, 0),
        quantity::fixed(probe.direction_deg, 0)
    )
}
