//! The part of the picture that is looked at, dragged on it: a rectangle, or four corners.

use eframe::egui::{CursorIcon, Pos2, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::kit::theme::Palette;
use crate::tools::picture::draft::Part;
use crate::tools::picture::region::{turned_corners, turned_place};
use selvedge_foundation::numerics::{to_index, to_single};

/// Half the width of a handle, points.
const GRIP: f32 = 7.0;
/// The smallest region, px.
const LEAST_PX: f64 = 16.0;
/// Which edges of a region (left, top, right, bottom as 0 … 3) meet at its corners.
const EDGES: [[usize; 2]; 4] = [[0, 1], [2, 1], [2, 3], [0, 3]];

/// Shows the part over a picture of this many pixels that is drawn in `rect`; lets it be dragged.
pub(crate) fn show(ui: &Ui, rect: Rect, size_px: [usize; 2], (part, turn_deg): (&mut Part, f64)) {
    let size = size_px.map(|n| n as f64);
    match part {
        Part::Whole => {}
        Part::Corners(corners) => {
            let places = corners.map(|place| on_screen(rect, size, place));
            outline(ui, &places);
            for (nth, corner) in corners.iter_mut().enumerate() {
                *corner = handle(ui, (rect, size), &corner_name(nth), *corner);
            }
        }
        Part::Region(region) => {
            let [x, y, w, h] = region.map(|n| n as f64);
            let mut ends = [x, y, x + w, y + h];
            let corners = turned_corners(*region, turn_deg, size_px);
            outline(ui, &corners.map(|place| on_screen(rect, size, place)));
            for (nth, before) in corners.into_iter().enumerate() {
                let after = handle(ui, (rect, size), &corner_name(nth), before);
                let moved = turned_place([0, 1].map(|i| after[i] - before[i]), -turn_deg);
                let [side, end] = EDGES[nth];
                (ends[side], ends[end]) = (ends[side] + moved[0], ends[end] + moved[1]);
            }
            // The corner opposite stays where it is though the region turns about its middle.
            let middle = [0, 1].map(|i| 0.5 * (ends[i] + ends[i + 2]));
            let off = [middle[0] - x - 0.5 * w, middle[1] - y - 0.5 * h];
            let turned = turned_place(off, turn_deg);
            for (i, end) in ends.iter_mut().enumerate() {
                *end += turned[i % 2] - off[i % 2];
            }
            *region = region_of(ends, size);
        }
    }
}

/// Shows a ruler over the picture, its ends to be dragged.
pub(crate) fn show_ruler(ui: &Ui, rect: Rect, size: [usize; 2], ends: &mut [[f64; 2]; 2]) {
    let size = size.map(|n| n as f64);
    line(ui, ends.map(|end| on_screen(rect, size, end)));
    for (end, name) in ends.iter_mut().zip(["First", "Second"]) {
        *end = handle(ui, (rect, size), &format!("{name} end of the ruler"), *end);
    }
}

/// Shows the vectors of a lattice from the middle of a picture so many pixels wide, their ends to
/// be dragged. While one is, where they point to, and whether it was let go.
pub(crate) fn show_vectors(
    ui: &Ui,
    (rect, width_px): (Rect, f64),
    vectors: [[f64; 2]; 2],
) -> Option<([[f64; 2]; 2], bool)> {
    let scale = width_px / f64::from(rect.width());
    let size = [rect.width(), rect.height()].map(|side| f64::from(side) * scale);
    let middle = size.map(|side| 0.5 * side);
    let (mut is_held, mut is_let_go) = (false, false);
    let ends = [(0, "First"), (1, "Second")].map(|(nth, name)| {
        let [x, y]: [f64; 2] = vectors[nth];
        let end = [middle[0] + x, middle[1] + y];
        line(ui, [middle, end].map(|place| on_screen(rect, size, place)));
        let label = format!("{name} vector of the lattice");
        let [x, y] = handle(ui, (rect, size), &label, end);
        let grip = ui.ctx().read_response(ui.scope_id().with(label.as_str()));
        is_held |= grip.as_ref().is_some_and(eframe::egui::Response::dragged);
        is_let_go |= grip.is_some_and(|grip| grip.drag_stopped());
        [x - middle[0], y - middle[1]]
    });
    (is_held || is_let_go).then_some((ends, is_let_go))
}

/// A region of whole pixels that is not too small and lies inside.
fn region_of(ends: [f64; 4], size: [f64; 2]) -> [usize; 4] {
    let side = |axis: usize| {
        let least = LEAST_PX.min(size[axis]);
        let low = ends[axis]
            .min(ends[axis + 2])
            .clamp(0.0, size[axis] - least);
        let high = ends[axis]
            .max(ends[axis + 2])
            .clamp(low + least, size[axis]);
        [low.round(), high.round() - low.round()]
    };
    let ([x, w], [y, h]) = (side(0), side(1));
    [x, y, w, h].map(to_index)
}

fn on_screen(rect: Rect, size: [f64; 2], [x, y]: [f64; 2]) -> Pos2 {
    let share = vec2(to_single(x / size[0]), to_single(y / size[1]));
    rect.min + share * rect.size()
}

fn outline(ui: &Ui, places: &[Pos2; 4]) {
    for (nth, from) in places.iter().enumerate() {
        line(ui, [*from, places[(nth + 1) % 4]]);
    }
}

/// A line that shows on every cloth: dark below light.
pub(super) fn line(ui: &Ui, ends: [Pos2; 2]) {
    let dark = Stroke::new(3.0, Palette::in_ui(ui).rim);
    ui.painter().line_segment(ends, dark);
    let white = Stroke::new(1.0, eframe::egui::Color32::WHITE);
    ui.painter().line_segment(ends, white);
}

fn corner_name(nth: usize) -> String {
    let name = ["Upper left", "Upper right", "Lower right", "Lower left"][nth];
    format!("{name} corner of the part")
}

/// A place that can be dragged; says where it is, px.
fn handle(ui: &Ui, (rect, size): (Rect, [f64; 2]), label: &str, place: [f64; 2]) -> [f64; 2] {
    let at = on_screen(rect, size, place);
    let grip = Rect::from_center_size(at, vec2(2.0 * GRIP, 2.0 * GRIP));
    let response = ui.interact(grip, ui.scope_id().with(label), Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Slider, true, label));
    let response = response.on_hover_cursor(CursorIcon::Crosshair);
    let palette = Palette::in_ui(ui);
    let knob = Rect::from_center_size(at, vec2(7.0, 7.0));
    ui.painter().rect_filled(knob.expand(1.0), 1, palette.rim);
    ui.painter()
        .rect_filled(knob, 1, eframe::egui::Color32::WHITE);
    if !response.dragged() {
        return place;
    }
    let to = pos2(at.x, at.y) + response.drag_delta();
    let share = (to - rect.min) / rect.size();
    [
        (f64::from(share.x) * size[0]).clamp(0.0, size[0]),
        (f64::from(share.y) * size[1]).clamp(0.0, size[1]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_stays_inside_and_is_never_too_small() {
        let size = [100.0, 80.0];
        assert_eq!(region_of([10.0, 20.0, 60.0, 70.0], size), [10, 20, 50, 50]);
        assert_eq!(region_of([60.0, 70.0, 10.0, 20.0], size), [10, 20, 50, 50]);
        assert_eq!(region_of([99.0, 79.0, 100.0, 80.0], size), [84, 64, 16, 16]);
        let [x, y, w, h] = region_of([-5.0, -5.0, 400.0, 400.0], size);
        assert_eq!([x, y, w, h], [0, 0, 100, 80]);
    }
}
