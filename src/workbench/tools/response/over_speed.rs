//! Level against speed in the chosen direction.

use eframe::egui::{Margin, Painter, Rect, Stroke, Ui, WidgetInfo, pos2};

use crate::bench::command::{Commands, ShowCommand};
use crate::bench::probe::{Probe, SPEEDS_MM_PER_S, two_digits};
use crate::kit::plot;
use crate::kit::plot::{Drag, Setting, Shown};
use crate::kit::theme::Palette;
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::slider::{asked_value, declare, key_steps};
use crate::tools::response::chart;
use crate::tools::response::curves::speeds_mm_per_s;
use crate::tools::response::shown::{ResponseView, paint_handle, paint_moving, words_of};
use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::quantity;

/// A key changes the speed by this factor; with Shift by its fourth root.
const KEY_FACTOR: f64 = 1.25;
/// Speeds that assistive tools may ask for.
const SCALE: Scale = Scale::even(SPEEDS_MM_PER_S, 100.0, 1.0, (0, "mm/s"));

/// Shows the plot; a drag chooses the speed.
pub(crate) fn show(ui: &Ui, rect: Rect, view: &ResponseView<'_>, commands: &mut Commands) {
    let setting = Setting {
        name: "Speed of movement",
        margin: Margin {
            left: 34,
            right: 8,
            top: 6,
            bottom: 18,
        },
        drag: Drag::Chooses,
        link: Some("speed, mm/s"),
        hover: false,
        has_legend: false,
        ..Setting::default()
    };
    let Some(shown) = plot::show(ui, rect, &chart::over_speed(view), &setting) else {
        return;
    };
    let response = &shown.response;
    let speed_mm_per_s = view.probe.speed_mm_per_s;
    response.widget_info(|| WidgetInfo::slider(true, speed_mm_per_s, "Speed of movement"));
    declare(ui, response.id, &SCALE, None);
    let chosen = chosen(ui, &shown, view.probe);
    if let Some(probe) = chosen.filter(|probe| *probe != view.probe) {
        commands.push(ShowCommand::Probe(probe).into());
    }
    paint_marks(ui.painter(), &shown, view);
    describe(&shown, view);
}

/// The velocity with the speed that the pointer, the keys or an assistive tool choose.
fn chosen(ui: &Ui, shown: &Shown, probe: Probe) -> Option<Probe> {
    let response = &shown.response;
    let (is_fine, is_primary) = ui.input(|input| {
        let pointer = &input.pointer;
        (input.modifiers.shift, pointer.primary_down())
    });
    if response.is_pointer_button_down_on() && is_primary || response.clicked() {
        let at = response.interact_pointer_pos()?;
        let [speed_mm_per_s, _] = shown.values_at(at);
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

fn describe(shown: &Shown, view: &ResponseView<'_>) {
    let pointed = shown.pointer().filter(|_| !shown.response.dragged());
    let Some(at) = pointed else {
        return;
    };
    let [pointed_mm_per_s, _] = shown.values_at(at);
    let distance = |speed_mm_per_s: f64| (speed_mm_per_s / pointed_mm_per_s).ln().abs();
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
        words_of(view, spread, chart::chosen_deg(view))
    );
    shown.response.clone().on_hover_text_at_pointer(words);
}

/// The chosen speed, and how fast the contactor moves now.
fn paint_marks(painter: &Painter, shown: &Shown, view: &ResponseView<'_>) {
    let palette = Palette::of(painter.ctx().theme());
    let (area, foot_db) = (shown.area(), view.scale.level_ends_db()[0]);
    let x = |speed_mm_per_s: f64| {
        let x = shown.at([speed_mm_per_s, foot_db]).x;
        area.x_range().contains(x).then_some(x)
    };
    if let Some(x) = x(view.probe.speed_mm_per_s) {
        let line = Stroke::new(1.0, palette.selection.gamma_multiply(0.6));
        painter.vline(painter.round_to_pixel_center(x), area.y_range(), line);
        let is_held = shown.response.is_pointer_button_down_on();
        paint_handle(painter, pos2(x, area.top()), is_held);
    }
    let speed_mm_per_s = view.moving.map_or(0.0, Velocity::speed_mm_per_s);
    let [least, most] = SPEEDS_MM_PER_S;
    let moving = (least..=most).contains(&speed_mm_per_s);
    if let Some(x) = moving.then(|| x(speed_mm_per_s)).flatten() {
        let foot = area.bottom();
        let line = Stroke::new(1.0, palette.contactor);
        painter.vline(x, foot - 0.14 * area.height()..=foot, line);
        paint_moving(painter, pos2(x, foot));
    }
}
