//! The evaluated section on a curve: its ends and its middle are dragged, moved with the arrow
//! keys, or typed.

use eframe::egui::{CursorIcon, DragValue, Rect, Response, Sense, Stroke, Ui, WidgetInfo, pos2};

use crate::kit::plot::Shown;
use crate::kit::theme::Palette;
use crate::kit::widgets::slider::key_steps;
use crate::kit::widgets::text::{named, toggle};
use selvedge_textile::KesSection;
use selvedge_textile::surface::WINDOW_LENGTH_MM;

/// The shortest section, mm: a window and a little more.
const LEAST_MM: f64 = WINDOW_LENGTH_MM + 0.01;
/// One step of the arrow keys, mm.
const KEY_MM: f64 = 0.1;
/// How near an end the pointer takes it, points.
const GRIP: f32 = 6.0;

/// A section with the range that it may lie in, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ends {
    pub(crate) at_mm: [f64; 2],
    pub(crate) covered_mm: [f64; 2],
}

impl Ends {
    /// The section with one end elsewhere: no farther than there are samples, and not too short.
    pub(crate) fn with_end(self, end: usize, mm: f64) -> [f64; 2] {
        let [from, to] = self.at_mm;
        let [low, high] = self.covered_mm;
        let moved = if end == 0 {
            [mm.min(to - LEAST_MM).max(low), to]
        } else {
            [from, mm.max(from + LEAST_MM).min(high)]
        };
        moved.map(rounded)
    }

    /// The section moved as a whole.
    pub(crate) fn moved(self, by_mm: f64) -> [f64; 2] {
        let [from, to] = self.at_mm;
        let [low, high] = self.covered_mm;
        let by_mm = by_mm.min(high - to).max(low - from);
        [from + by_mm, to + by_mm].map(rounded)
    }
}

/// Which section is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Wish {
    /// The one that the rule suggests.
    Suggested,
    /// This one, mm.
    Section([f64; 2]),
}

/// Thousandths of a mm: no tester places finer.
fn rounded(mm: f64) -> f64 {
    (mm * 1e3).round() / 1e3 + 0.0
}

/// Lets a section be dragged on a chart; says where it is then.
pub(crate) fn drag(ui: &Ui, shown: &Shown, name: &str, ends: Ends) -> Option<[f64; 2]> {
    let plot = shown.area();
    let x = ends
        .at_mm
        .map(|mm| shown.at([mm, shown.values_at(plot.center())[1]]).x);
    let [left, right] = [plot.left_top(), plot.right_top()].map(|at| shown.values_at(at)[0]);
    let mm_a_point = (right - left) / f64::from(plot.width());
    let body = Rect::from_x_y_ranges(x[0] + GRIP..=(x[1] - GRIP).max(x[0] + GRIP), plot.y_range());
    let body = body.intersect(plot);
    let body = ui.interact(body, ui.scope_id().with((name, "body")), Sense::drag());
    let mut moved = None;
    if let Some(by_mm) = wanted_mm(ui, &body, mm_a_point, &format!("{name} section")) {
        moved = Some(ends.moved(by_mm));
    }
    let palette = Palette::in_ui(ui);
    for (end, word) in ["start", "end"].into_iter().enumerate() {
        if !plot.expand(1.0).x_range().contains(x[end]) {
            continue;
        }
        let grip = Rect::from_x_y_ranges(x[end] - GRIP..=x[end] + GRIP, plot.y_range());
        let grip = ui.interact(grip, ui.scope_id().with((name, end)), Sense::drag());
        let label = format!("{name} section {word}");
        if let Some(by_mm) = wanted_mm(ui, &grip, mm_a_point, &label) {
            moved = Some(ends.with_end(end, ends.at_mm[end] + by_mm));
        }
        let is_held = grip.hovered() || grip.dragged() || grip.has_focus();
        let width = if is_held { 2.0 } else { 1.0 };
        let line = Stroke::new(width, palette.selection);
        ui.painter().vline(x[end], plot.y_range(), line);
        let foot = Rect::from_center_size(pos2(x[end], plot.bottom() - 5.0), [5.0, 10.0].into());
        ui.painter().rect_filled(foot, 1, palette.selection);
    }
    moved
}

/// How far a handle is to go.
fn wanted_mm(ui: &Ui, handle: &Response, mm_a_point: f64, label: &str) -> Option<f64> {
    handle.widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Slider, true, label));
    let handle = handle.clone().on_hover_cursor(CursorIcon::ResizeHorizontal);
    if handle.dragged() {
        let by_mm = f64::from(handle.drag_delta().x) * mm_a_point;
        return (by_mm.abs() > 0.0).then_some(by_mm);
    }
    let steps = key_steps(ui, &handle);
    (steps != 0).then(|| f64::from(steps) * KEY_MM)
}

/// The section in numbers that can be typed; `section` is the one in force. Says another.
pub(crate) fn numbers(
    ui: &mut Ui,
    name: &str,
    ends: Ends,
    section: Option<&KesSection>,
) -> Option<Wish> {
    let mut wanted = None;
    for (end, word) in ["start", "end"].into_iter().enumerate() {
        let mut mm = ends.at_mm[end];
        let value = DragValue::new(&mut mm).speed(0.02).fixed_decimals(2);
        let response = ui.add(value.range(ends.covered_mm[0]..=ends.covered_mm[1]));
        let label = format!("{name} section {word} in mm");
        named(&response, label);
        if response.changed() {
            wanted = Some(Wish::Section(ends.with_end(end, mm)));
        }
        if end == 0 {
            ui.label("–");
        }
    }
    let is_suggested = section.is_some_and(|section| section.is_suggested);
    let tip = format!("Take the most stationary 20 mm along the {name}");
    if toggle(ui, "auto", is_suggested, &tip) {
        wanted = Some(Wish::Suggested);
    }
    wanted
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENDS: Ends = Ends {
        at_mm: [5.0, 25.0],
        covered_mm: [0.0, 30.0],
    };

    #[test]
    fn a_section_stays_on_the_stroke_and_is_never_too_short() {
        assert_eq!(ENDS.moved(3.0), [8.0, 28.0]);
        assert_eq!(ENDS.moved(30.0), [10.0, 30.0]);
        assert_eq!(ENDS.moved(-30.0), [0.0, 20.0]);
        assert_eq!(ENDS.with_end(0, -3.0), [0.0, 25.0]);
        assert_eq!(ENDS.with_end(1, 31.0), [5.0, 30.0]);
        let [from, to] = ENDS.with_end(0, 24.9);
        assert!(to - from >= WINDOW_LENGTH_MM, "{from} {to}");
        let [from, to] = ENDS.with_end(1, 1.0);
        assert!(to - from >= WINDOW_LENGTH_MM, "{from} {to}");
    }
}
