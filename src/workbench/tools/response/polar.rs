//! Level against direction of movement: directions as in the workspace, levels outwards.

use eframe::egui::{
    Align2, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{Commands, ShowCommand};
use crate::bench::probe::{Probe, STEP_DEG};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::slider::{asked_value, declare, key_steps};
use crate::kit::widgets::text::paint_quiet;
use crate::tools::response::shown::{
    MEAN, ResponseView, fill_between, levels_db, paint_focus, paint_handle, paint_moving, words_of,
};
use selvedge_foundation::numerics::{to_index, to_single};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Space above and below the outermost ring, points.
const MARGIN: f32 = 16.0;
/// Space on either side of it, points.
const BESIDE: f32 = 31.0;
/// From one ring to the next, dB.
const RING_DB: f64 = 20.0;
/// Angles that assistive tools may ask for, degrees.
const SCALE: Scale = Scale::even([0.0, 360.0], 0.0, STEP_DEG, (0, "°"));

/// Shows the plot; a drag chooses the direction.
pub(crate) fn show(ui: &Ui, rect: Rect, view: &ResponseView<'_>, commands: &mut Commands) {
    let id = ui.scope_id().with("direction of movement");
    let response = ui.interact(rect, id, Sense::click_and_drag());
    let direction_deg = view.probe.direction_deg;
    response.widget_info(|| WidgetInfo::slider(true, direction_deg, "Direction of movement"));
    declare(ui, id, &SCALE, None);
    let plot = Plot::new(rect, view);
    if plot.radius < 20.0 {
        return;
    }
    let chosen = chosen(ui, &response, &plot, view.probe);
    if let Some(probe) = chosen.filter(|probe| *probe != view.probe) {
        commands.push(ShowCommand::Probe(probe).into());
    }
    let painter = ui.painter_at(rect);
    plot.paint_ground(&painter, view);
    for band in Band::ALL {
        plot.paint_curves(&painter, view, band);
    }
    plot.name_rings(&painter);
    plot.paint_marks(&painter, view, response.is_pointer_button_down_on());
    paint_focus(ui, &response, rect.shrink(4.0));
    describe(response, &plot, view);
}

/// The velocity with the direction that the pointer, the keys or an assistive tool choose.
fn chosen(ui: &Ui, response: &Response, plot: &Plot, probe: Probe) -> Option<Probe> {
    let is_fine = ui.input(|input| input.modifiers.shift);
    let step_deg = if is_fine { 1.0 } else { STEP_DEG };
    if response.is_pointer_button_down_on() || response.clicked() {
        let direction_deg = plot.direction_deg(response.interact_pointer_pos()?)?;
        let rounded = (direction_deg / step_deg).round() * step_deg;
        return Some(probe.with_direction(rounded));
    }
    let steps = key_steps(ui, response);
    if steps != 0 {
        // To the right is clockwise, as on a dial.
        let direction_deg = probe.direction_deg - f64::from(steps) * step_deg;
        return Some(probe.with_direction(direction_deg));
    }
    asked_value(ui, response.id).map(|direction_deg| probe.with_direction(direction_deg))
}

fn describe(response: Response, plot: &Plot, view: &ResponseView<'_>) {
    let pointed = response.hover_pos().and_then(|at| plot.direction_deg(at));
    let Some(direction_deg) = pointed.filter(|_| !response.dragged()) else {
        return;
    };
    let around = view.curves.around();
    let step_deg = 360.0 / around.len() as f64;
    let turned = (direction_deg - view.rotation_deg).rem_euclid(360.0);
    let place = to_index((turned / step_deg).round()) % around.len();
    let Some(spread) = around.get(place) else {
        return;
    };
    let along = (view.rotation_deg + step_deg * place as f64).rem_euclid(360.0);
    let own = quantity::fixed(step_deg * place as f64, 0);
    let words = format!(
        "Towards {}° of the workspace, {own}° from the warp, at {}\n{}\nDrag to choose a \
         direction, with Shift finely",
        quantity::fixed(along, 0),
        quantity::with_unit(view.probe.speed_mm_per_s, 0, "mm/s"),
        words_of(view, spread, step_deg * place as f64)
    );
    response.on_hover_text_at_pointer(words);
}

pub(crate) struct Plot {
    centre: Pos2,
    left: f32,
    radius: f32,
    rotation_deg: f64,
    ends_db: [f64; 2],
}

impl Plot {
    pub(crate) fn new(rect: Rect, view: &ResponseView<'_>) -> Self {
        Self {
            centre: rect.center(),
            left: rect.left(),
            radius: (0.5 * rect.width() - BESIDE).min(0.5 * rect.height() - MARGIN),
            rotation_deg: view.rotation_deg,
            ends_db: view.scale.level_ends_db(),
        }
    }

    /// The direction in the workspace of a place on the screen, degrees counter-clockwise; `None`
    /// in the very middle.
    pub(crate) fn direction_deg(&self, at: Pos2) -> Option<f64> {
        let off = at - self.centre;
        (off.length() > 2.0).then(|| f64::from(-off.y).atan2(f64::from(off.x)).to_degrees())
    }

    /// The place of a level in a direction of the workspace; below the levels, the middle.
    pub(crate) fn at(&self, direction_deg: f64, level_db: f64) -> Pos2 {
        self.on_ring(direction_deg, self.distance(level_db))
    }

    fn distance(&self, level_db: f64) -> f32 {
        let [least_db, most_db] = self.ends_db;
        let share = (level_db - least_db) / (most_db - least_db);
        let share = to_single(share.clamp(0.0, 1.0).max(0.0));
        share * self.radius
    }

    fn on_ring(&self, direction_deg: f64, distance: f32) -> Pos2 {
        let angle = to_single(direction_deg.to_radians());
        self.centre + distance * vec2(angle.cos(), -angle.sin())
    }

    /// Rings of levels, and the axes of warp and weft as the textile lies.
    fn paint_ground(&self, painter: &Painter, view: &ResponseView<'_>) {
        let palette = Palette::of(painter.ctx().theme());
        let hairline = Stroke::new(1.0, palette.hairline);
        painter.circle_stroke(self.centre, self.radius, hairline);
        for (axis, name) in [(0.0, "warp"), (90.0, "weft")] {
            let direction_deg = view.rotation_deg + axis;
            let ends = [direction_deg, direction_deg + 180.0].map(|d| self.on_ring(d, self.radius));
            painter.line_segment(ends, hairline);
            self.name_axis(painter, direction_deg, name);
        }
        for level_db in self.rings_db() {
            painter.circle_stroke(self.centre, self.distance(level_db), hairline);
        }
        let corner = pos2(self.left, self.centre.y - self.radius - 4.0);
        let unit = "dB re 1 µm";
        paint_quiet(painter, corner, Align2::LEFT_CENTER, unit);
    }

    /// Writes an axis's name behind its end, beyond the handles on the ring.
    fn name_axis(&self, painter: &Painter, direction_deg: f64, name: &str) {
        let palette = Palette::of(painter.ctx().theme());
        let font = theme::small();
        let text = painter.layout_no_wrap(name.to_owned(), font, palette.dim);
        let end = self.on_ring(direction_deg, self.radius + 7.0);
        let out = (end - self.centre).normalized();
        let middle = end + 0.5 * out * text.size();
        painter.galley(middle - 0.5 * text.size(), text, palette.dim);
    }

    /// The levels of the rings between the middle and the outermost, dB.
    fn rings_db(&self) -> impl Iterator<Item = f64> {
        let [least_db, most_db] = self.ends_db;
        let first = (least_db / RING_DB).floor() + 1.0;
        let levels = (0..4_u8).map(move |i| (first + f64::from(i)) * RING_DB);
        levels.take_while(move |level_db| *level_db < most_db - 2.0)
    }

    /// Writes the levels of the rings, over the curves.
    fn name_rings(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        for level_db in self.rings_db() {
            let digits = quantity::fixed(level_db, 0);
            let text = painter.layout_no_wrap(digits, theme::small_number(), palette.dim);
            let at = self.at(self.rotation_deg + 45.0, level_db) - 0.5 * text.size();
            let ground = Rect::from_min_size(at, text.size()).expand2(vec2(2.0, -1.0));
            painter.rect_filled(ground, 2, palette.panel.gamma_multiply(0.8));
            painter.galley(at, text, palette.dim);
        }
    }

    fn paint_curves(&self, painter: &Painter, view: &ResponseView<'_>, band: Band) {
        let ink = Palette::of(painter.ctx().theme()).band(band);
        let around = view.curves.around();
        let levels: Vec<[f64; 4]> = around
            .iter()
            .map(|spread| levels_db(spread, view.factors, band))
            .collect();
        let step_deg = 360.0 / levels.len().max(1) as f64;
        let places = |pick: usize| -> Vec<Pos2> {
            let direction_deg = |k: usize| self.rotation_deg + step_deg * k as f64;
            let row = levels.iter().enumerate();
            row.map(|(k, levels)| self.at(direction_deg(k), levels[pick]))
                .collect()
        };
        let [place, mean, least, most] = [0, 1, 2, 3].map(places);
        let closed = |mut row: Vec<Pos2>| {
            row.extend(row.first().copied());
            row
        };
        fill_between(painter, &closed(least), &closed(most), ink);
        if let Some(known) = &view.uncertainty {
            let end = |end: usize| -> Vec<Pos2> {
                let off = |k: usize| known.level_db(band, step_deg * k as f64)[end];
                let row = levels.iter().enumerate();
                row.map(|(k, [_, mean, ..])| {
                    self.at(self.rotation_deg + step_deg * k as f64, mean + off(k))
                })
                .collect()
            };
            fill_between(painter, &closed(end(0)), &closed(end(1)), ink);
        }
        let thin = Stroke::new(1.0, ink.gamma_multiply(MEAN));
        painter.add(Shape::closed_line(mean, thin));
        if view.place.is_some() {
            painter.add(Shape::closed_line(place, Stroke::new(1.75, ink)));
        }
    }

    /// The chosen direction, and where the contactor moves now.
    fn paint_marks(&self, painter: &Painter, view: &ResponseView<'_>, is_held: bool) {
        let palette = Palette::of(painter.ctx().theme());
        let rim = self.on_ring(view.probe.direction_deg, self.radius);
        let line = Stroke::new(1.0, palette.selection.gamma_multiply(0.6));
        painter.line_segment([self.centre, rim], line);
        let moving = view
            .moving
            .filter(|v| v.is_finite() && v.speed_mm_per_s() >= 0.01);
        if let Some(velocity) = moving {
            let direction_deg = velocity.y_mm_per_s.atan2(velocity.x_mm_per_s).to_degrees();
            let at = self.on_ring(direction_deg, self.radius);
            let line = Stroke::new(1.0, palette.contactor);
            painter.line_segment([self.on_ring(direction_deg, 0.86 * self.radius), at], line);
            paint_moving(painter, at);
        }
        paint_handle(painter, rim, is_held);
        painter.circle_filled(self.centre, 1.5, palette.line);
    }
}
