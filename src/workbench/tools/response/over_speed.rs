//! Level against speed in the chosen direction.

use eframe::egui::{
    Align2, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{ShowCommand, Wishes};
use crate::bench::probe::{Probe, SPEEDS_MM_PER_S, two_digits};
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_ticks, paint_unit};
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::{asked_value, declare, key_steps};
use crate::tools::response::curves::speeds_mm_per_s;
use crate::tools::response::{
    ResponseView, ends_db, fill_between, levels_db, paint_handle, paint_moving, words_of,
};
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Speeds that are named, mm/s.
const NAMED_MM_PER_S: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];
/// A key changes the speed by this factor; with Shift by its fourth root.
const KEY_FACTOR: f64 = 1.25;
/// Speeds that assistive tools may ask for.
const SCALE: Scale = Scale {
    least: SPEEDS_MM_PER_S[0],
    most: SPEEDS_MM_PER_S[1],
    resting: 100.0,
    step: 1.0,
    decimals: 0,
    unit: "mm/s",
    factor: 1.0,
    noticed: None,
    curve: Curve::Even,
};

/// Shows the plot; a drag chooses the speed.
pub(crate) fn show(ui: &Ui, rect: Rect, view: &ResponseView<'_>, wishes: &mut Wishes) {
    let id = ui.scope_id().with("speed of movement");
    let response = ui.interact(rect, id, Sense::click_and_drag());
    let speed_mm_per_s = view.probe.speed_mm_per_s;
    response.widget_info(|| WidgetInfo::slider(true, speed_mm_per_s, "Speed of movement"));
    declare(ui, id, &SCALE, None);
    let plot = Plot::new(rect, view);
    if plot.area.width() < 40.0 || plot.area.height() < 24.0 {
        return;
    }
    let chosen = chosen(ui, &response, &plot, view.probe);
    if let Some(probe) = chosen.filter(|probe| *probe != view.probe) {
        wishes.push(ShowCommand::Probe(probe).into());
    }
    let painter = ui.painter();
    plot.paint_axes(painter);
    for band in Band::ALL {
        plot.paint_curves(painter, view, band);
    }
    plot.paint_marks(painter, view, response.is_pointer_button_down_on());
    super::paint_focus(ui, &response, plot.area);
    tell(response, &plot, view);
}

/// The velocity with the speed that the pointer, the keys or an assistive tool choose.
fn chosen(ui: &Ui, response: &Response, plot: &Plot, probe: Probe) -> Option<Probe> {
    let is_fine = ui.input(|input| input.modifiers.shift);
    if response.is_pointer_button_down_on() || response.clicked() {
        let at = response.interact_pointer_pos()?;
        let speed_mm_per_s = plot.speed_mm_per_s(at.x);
        let rounded = if is_fine {
            speed_mm_per_s
        } else {
            two_digits(speed_mm_per_s)
        };
        return Some(probe.with_speed(rounded));
    }
    let steps = key_steps(ui, response);
    if steps != 0 {
        let exponent = f64::from(steps) * if is_fine { 0.25 } else { 1.0 };
        let speed_mm_per_s = probe.speed_mm_per_s * KEY_FACTOR.powf(exponent);
        return Some(probe.with_speed(speed_mm_per_s));
    }
    asked_value(ui, response.id).map(|speed_mm_per_s| probe.with_speed(speed_mm_per_s))
}

fn tell(response: Response, plot: &Plot, view: &ResponseView<'_>) {
    let pointed = response.hover_pos().filter(|at| plot.area.contains(*at));
    let Some(at) = pointed.filter(|_| !response.dragged()) else {
        return;
    };
    let distance = |speed_mm_per_s: f64| (plot.x(speed_mm_per_s) - at.x).abs();
    let curve = speeds_mm_per_s().zip(view.curves.over_speed());
    let nearest = curve.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
    let Some((speed_mm_per_s, spread)) = nearest else {
        return;
    };
    let decimals = usize::from(speed_mm_per_s < 9.95);
    let words = format!(
        "{} towards {}°\n{}\nDrag to choose a speed, with Shift finely",
        quantity::with_unit(speed_mm_per_s, decimals, "mm/s"),
        quantity::fixed(view.probe.direction_deg, 0),
        words_of(view, spread)
    );
    response.on_hover_text_at_pointer(words);
}

pub(crate) struct Plot {
    pub(crate) area: Rect,
    speeds: Axis,
    levels_db: Axis,
}

impl Plot {
    pub(crate) fn new(rect: Rect, view: &ResponseView<'_>) -> Self {
        let [least_db, most_db] = ends_db(view.scale);
        Self {
            area: Rect::from_min_max(
                pos2(rect.left() + 34.0, rect.top() + 6.0),
                pos2(rect.right() - 8.0, rect.bottom() - 18.0),
            ),
            speeds: Axis::log(SPEEDS_MM_PER_S[0], SPEEDS_MM_PER_S[1]),
            levels_db: Axis::linear(least_db, most_db),
        }
    }

    pub(crate) fn x(&self, speed_mm_per_s: f64) -> f32 {
        self.speeds.x(self.area.x_range(), speed_mm_per_s)
    }

    pub(crate) fn speed_mm_per_s(&self, x: f32) -> f64 {
        self.speeds.value_at_x(self.area.x_range(), x)
    }

    /// The place of a level at a speed; beyond the levels, just outside the plot.
    fn at(&self, speed_mm_per_s: f64, level_db: f64) -> Pos2 {
        let y = self.levels_db.y(self.area.y_range(), level_db);
        let y = y.clamp(self.area.top() - 2.0, self.area.bottom() + 2.0);
        pos2(self.x(speed_mm_per_s), y)
    }

    fn paint_axes(&self, painter: &Painter) {
        let levels = self.levels_db.ticks(self.area.height(), 22.0);
        paint_ticks(painter, self.area, (&self.levels_db, Side::Left), &levels);
        let speeds = NAMED_MM_PER_S.map(Tick::number);
        paint_ticks(painter, self.area, (&self.speeds, Side::Bottom), &speeds);
        let unit_at = self.area.right_bottom() + vec2(-2.0, -1.0);
        paint_unit(painter, unit_at, Align2::RIGHT_BOTTOM, "mm/s");
    }

    fn paint_curves(&self, painter: &Painter, view: &ResponseView<'_>, band: Band) {
        let ink = Palette::of(painter.ctx().theme()).band(band);
        let painter = painter.with_clip_rect(self.area);
        let curve = speeds_mm_per_s().zip(view.curves.over_speed());
        let levels: Vec<(f64, [f64; 4])> = curve
            .map(|(speed, spread)| (speed, levels_db(spread, view.factors, band)))
            .collect();
        let row = |pick: usize| -> Vec<Pos2> {
            let place = |(speed, levels): &(f64, [f64; 4])| self.at(*speed, levels[pick]);
            levels.iter().map(place).collect()
        };
        fill_between(&painter, &row(2), &row(3), ink);
        let thin = Stroke::new(1.0, ink.gamma_multiply(super::MEAN));
        painter.add(Shape::line(row(1), thin));
        if view.place.is_some() {
            painter.add(Shape::line(row(0), Stroke::new(1.75, ink)));
        }
    }

    /// The chosen speed, and how fast the contactor moves now.
    fn paint_marks(&self, painter: &Painter, view: &ResponseView<'_>, is_held: bool) {
        let palette = Palette::of(painter.ctx().theme());
        let x = self.x(view.probe.speed_mm_per_s);
        let line = Stroke::new(1.0, palette.selection.gamma_multiply(0.6));
        painter.vline(painter.round_to_pixel_center(x), self.area.y_range(), line);
        let speed_mm_per_s = view.moving.map_or(0.0, Velocity::speed_mm_per_s);
        let [least, most] = SPEEDS_MM_PER_S;
        if (least..=most).contains(&speed_mm_per_s) {
            let x = self.x(speed_mm_per_s);
            let foot = self.area.bottom();
            let line = Stroke::new(1.0, palette.contactor);
            painter.vline(x, foot - 0.14 * self.area.height()..=foot, line);
            paint_moving(painter, pos2(x, foot));
        }
        paint_handle(painter, pos2(x, self.area.top()), is_held);
    }
}
