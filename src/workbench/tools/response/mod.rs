//! A textile's amplitudes over the direction and the speed of movement: at the points that the
//! chosen contactor reads, and over all its points.
//!
//! Both plots are also controls: a drag chooses the direction or the speed at which the other plot,
//! and the maps over the cloth, are asked.

pub(crate) mod chart;
pub(crate) mod curves;
pub(crate) mod over_speed;
pub(crate) mod polar;
#[cfg(test)]
mod tests;

use eframe::egui::{self, Align2, Color32, Painter, Rect, RichText, Ui, pos2, vec2};

use crate::bench::Bench;
use crate::bench::amplitude::AmplitudeScale;
use crate::bench::command::{Commands, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::pane::Pane;
use crate::bench::probe::Probe;
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::SceneView;
use crate::kit::pane::framed;
use crate::kit::spectrogram::paint_sentence;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::toggle;
use crate::tools::response::curves::{Curves, Wanted};
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::quantity;
use selvedge_render::array::{ContactorReading, PointSpread};
use selvedge_textile::tactile::Band;

/// Height of the line above the plots, points.
const LINE: f32 = 18.0;
/// How opaque the range over all points is drawn.
const RANGE: f32 = 0.16;
/// How opaque the mean over all points is drawn.
const MEAN: f32 = 0.6;

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

/// What both plots are drawn from.
#[derive(Debug, Clone)]
pub(crate) struct ResponseView<'a> {
    /// What the scene calls the textile: label and name.
    pub textile: String,
    /// How it is turned, degrees counter-clockwise.
    pub rotation_deg: f64,
    /// The amplitude factors of its gains, by band.
    pub factors: [f64; 2],
    /// The chosen contactor and the points that it reads, one for each direction; `None` while it
    /// is not on the textile.
    pub place: Option<(usize, [usize; 4])>,
    /// Amplitudes over direction and speed, before gains.
    pub curves: &'a Curves,
    /// The chosen velocity.
    pub probe: Probe,
    /// The chosen contactor's own velocity, in the workspace.
    pub moving: Option<Velocity>,
    /// The scale of amplitudes.
    pub scale: AmplitudeScale,
}

impl Response {
    /// Has the curves of the textile that is chosen, or else of the one under the chosen contactor,
    /// or which was there last; `None` without any.
    fn view(&mut self, bench: &mut Bench, scene: &SceneView) -> Option<ResponseView<'_>> {
        let (live, inspector) = (&bench.transient.live, &mut bench.inspection.inspector);
        self.readings.clear();
        if live.centre.is_some() {
            inspector.readings_into(0, &live.pose, &mut self.readings);
        }
        let contactor = bench.workspace.contactor;
        let read = contactor.and_then(|index| self.readings.get(index));
        let under = read.and_then(|moving| moving.reading);
        let chosen = bench.workspace.cloth;
        let textile = chosen.or_else(|| under.map(|reading| reading.textile));
        let textile = textile.or(self.textile)?;
        self.textile = Some(textile);
        let response = inspector.response(textile)?;
        let factors = response.factors();
        let on_it = under.filter(|reading| reading.textile == textile);
        let place = contactor.zip(on_it.map(|reading| reading.points));
        let moving = read.map(|moving| moving.velocity);
        let probe = bench.workspace.probe;
        let wanted = Wanted {
            response,
            points: place.map(|(_, points)| points),
            probe,
        };
        (self.curves).catch_up(&bench.ctx, wanted, bench.is_stepped);
        let cloth = scene.cloths.get(textile)?;
        Some(ResponseView {
            textile: format!("{} {}", cloth.label, cloth.name).trim().to_owned(),
            rotation_deg: cloth.rotation_deg,
            factors,
            place,
            curves: &self.curves,
            probe,
            moving,
            scale: bench.workspace.scale,
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
        let probe = context.bench.workspace.probe;
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
    let name = RichText::new(format!("{}{place}", view.textile));
    let name = name.font(theme::small()).color(palette.dim);
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

/// What a plot draws of a spread, after gains, by band: at the place, mean, least, most.
fn levels_db(spread: &PointSpread, factors: [f64; 2], band: Band) -> [f64; 4] {
    let spread = spread.scaled(factors);
    let level = |um: [f64; 2]| quantity::level_db(um[band.index()]);
    [
        spread.at_place_um.map_or(f64::NAN, level),
        level(spread.rms_um),
        level(spread.min_um),
        level(spread.max_um),
    ]
}

/// What a spread says, in words.
fn words_of(view: &ResponseView<'_>, spread: &PointSpread) -> String {
    let band_words = Band::ALL.map(|band| {
        let levels = levels_db(spread, view.factors, band);
        let [place, mean, least, most] = levels.map(|db| quantity::fixed(db, 1));
        let here = if view.place.is_some() {
            format!("{place} dB at the contactor, ")
        } else {
            String::new()
        };
        format!(
            "{} Hz  {here}mean {mean} dB, {least} to {most} dB",
            quantity::fixed(band.carrier_hz(), 0)
        )
    });
    let points = view.place.map_or_else(String::new, |(_, points)| {
        let [warp, warp_back, weft, weft_back] = points;
        format!(
            "\nPoints: warp {warp} forward, {warp_back} reverse; weft {weft} forward, {weft_back} \
             reverse"
        )
    });
    format!(
        "{}\nLevel re 1 µm peak, after gains, before output limits; the mean is the root mean \
         square over all pairs of points{points}",
        band_words.join("\n")
    )
}

/// Fills between two rows of places: the range over all points.
fn fill_between(painter: &Painter, lower: &[egui::Pos2], upper: &[egui::Pos2], ink: Color32) {
    fill_range(painter, (lower, upper), ink.gamma_multiply(RANGE));
}

/// Fills between two rows of places with an ink.
fn fill_range(painter: &Painter, (lower, upper): (&[egui::Pos2], &[egui::Pos2]), ink: Color32) {
    let mut mesh = egui::Mesh::default();
    for (low, high) in lower.iter().zip(upper) {
        mesh.colored_vertex(*low, ink);
        mesh.colored_vertex(*high, ink);
    }
    let n_pairs = u32::try_from(lower.len().min(upper.len())).unwrap_or(0);
    for pair in 1..n_pairs {
        let [a, b, c, d] = [2 * pair - 2, 2 * pair - 1, 2 * pair, 2 * pair + 1];
        mesh.add_triangle(a, b, c);
        mesh.add_triangle(b, c, d);
    }
    painter.add(egui::Shape::mesh(mesh));
}

/// A small handle that can be dragged.
fn paint_handle(painter: &Painter, at: egui::Pos2, is_held: bool) {
    let palette = Palette::of(painter.ctx().theme());
    let radius = if is_held { 5.0 } else { 4.0 };
    let edge = egui::Stroke::new(1.5, palette.panel);
    painter.circle(at, radius, palette.selection, edge);
}

/// The dot of the contactor's own velocity.
fn paint_moving(painter: &Painter, at: egui::Pos2) {
    let palette = Palette::of(painter.ctx().theme());
    let edge = egui::Stroke::new(1.5, palette.panel);
    painter.circle(at, 4.0, palette.contactor, edge);
}

/// A line around what has the keyboard.
fn paint_focus(ui: &Ui, response: &egui::Response, area: Rect) {
    if response.has_focus() {
        let edge = egui::Stroke::new(1.0, Palette::in_ui(ui).selection);
        let inside = egui::StrokeKind::Inside;
        ui.painter()
            .rect_stroke(area.expand2(vec2(4.0, 4.0)), 4, edge, inside);
    }
}
