//! What lies before the participant: cloths that look alike, with the numbers of their places.

use eframe::egui::{
    self, Align2, CornerRadius, CursorIcon, Painter, Pos2, Rect, Sense, Stroke, Ui, WidgetInfo,
    pos2, vec2,
};

use crate::kit::swatch::paint_plain;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::view_transform::{Pointed, PointerGround, ViewTransform};
use crate::tools::experiment::guide::{HALF_MM, RADIUS_MM};
use crate::tools::experiment::in_turn::Intervals;
use crate::tools::experiment::view::Ground;
use selvedge_experiment::layout::Place;
use selvedge_foundation::geometry::Point;

/// Side of the tag with a number, points.
const TAG: f32 = 44.0;

/// Shows the ground in `rect`, and where the finger is.
pub(crate) fn show(ui: &Ui, rect: Rect, ground: &Ground) -> PointerGround {
    let n = ground.slots.iter().filter(|slot| !slot.is_target).count();
    let shown = show_unseen(ui, rect, (ground, &format!("Ground with {n} fabrics")));
    let view = shown.view;
    let painter = ui.painter_at(rect);
    for slot in &ground.slots {
        let place = (slot.origin_mm, Place::SIZE_MM);
        paint_plain(&painter, &view, place, ground.picture);
        match (slot.number, slot.is_target) {
            (Some(number), _) => paint_tag(&painter, &view, slot.origin_mm, &number.to_string()),
            (None, true) => paint_tag(&painter, &view, slot.origin_mm, "target"),
            (None, false) => {}
        }
    }
    if let Some(finger) = ground.finger {
        paint_finger(&painter, view.screen(finger));
    }
    shown
}

/// The same with nothing to be seen: what lies there is felt all the same.
pub(crate) fn show_unseen(ui: &Ui, rect: Rect, (ground, name): (&Ground, &str)) -> PointerGround {
    let response = ui.interact(rect, ui.scope_id().with("ground"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, name));
    if ground.feels && response.hovered() {
        ui.ctx().set_cursor_icon(CursorIcon::None);
    }
    PointerGround {
        window: Pointed::Workbench,
        view: ViewTransform::fitted(rect, ground.size_mm),
        rect,
        size_mm: ground.size_mm,
        pixels_per_point: ui.pixels_per_point(),
        feels: ground.feels,
    }
}

/// The tag at the upper left corner of a cloth.
fn paint_tag(painter: &Painter, view: &ViewTransform, origin_mm: Point, words: &str) {
    let palette = Palette::of(painter.ctx().theme());
    let [_, height_mm] = Place::SIZE_MM;
    let corner = view.screen(Point::new(origin_mm.x_mm, origin_mm.y_mm + height_mm));
    let font = if words.len() > 1 {
        theme::large()
    } else {
        theme::huge()
    };
    let galley = painter.layout_no_wrap(words.to_owned(), font, palette.text);
    let width = (galley.size().x + 4.0 * STEP).max(TAG);
    let tag = Rect::from_min_size(corner, vec2(width, TAG));
    let rounding = CornerRadius {
        se: 8,
        ..CornerRadius::ZERO
    };
    painter.rect_filled(tag, rounding, palette.tag);
    let at = tag.center() - 0.5 * galley.size();
    painter.galley(at, galley, palette.text);
}

/// A ring where the finger is: as large whatever is felt.
fn paint_finger(painter: &Painter, at: Pos2) {
    let palette = Palette::of(painter.ctx().theme());
    painter.circle_stroke(at, 13.0, Stroke::new(5.0, palette.rim));
    painter.circle_stroke(at, 13.0, Stroke::new(2.5, palette.lit));
}

/// The course of a movement, and the dot to follow.
pub(crate) fn paint_guide(
    ui: &Ui,
    view: &ViewTransform,
    ground: &Ground,
    (is_circle, guide): (bool, Point),
) {
    let palette = Palette::in_ui(ui);
    let [width_mm, height_mm] = ground.size_mm;
    let middle = Point::new(width_mm / 2.0, height_mm / 2.0);
    let painter = ui.painter();
    // A rim on both sides: the line is seen on bright and on dark cloth.
    let lines = [
        Stroke::new(5.0, palette.rim),
        Stroke::new(2.0, palette.faint),
    ];
    for line in lines {
        if is_circle {
            painter.circle_stroke(view.screen(middle), view.length(RADIUS_MM), line);
            continue;
        }
        let ends = [-HALF_MM, HALF_MM]
            .map(|off_mm| view.screen(Point::new(middle.x_mm + off_mm, middle.y_mm)));
        painter.line_segment(ends, line);
    }
    let at = view.screen(guide);
    painter.circle_filled(at, 18.0, palette.rim);
    painter.circle_filled(at, 15.0, palette.selection);
}

/// The intervals of a trial; the one that is felt now is lit.
pub(crate) fn paint_intervals(ui: &Ui, rect: Rect, intervals: Intervals) {
    let n = intervals.n;
    let palette = Palette::in_ui(ui);
    let painter = ui.painter_at(rect);
    let step = (rect.width() / count(n)).min(180.0);
    let radius = (0.32 * step).min(0.4 * rect.height());
    let left = rect.center().x - 0.5 * step * count(n - n.min(1));
    for interval in 0..n {
        let at = pos2(left + step * count(interval), rect.center().y);
        let is_on = intervals.played == Some(interval);
        let (fill, ink) = if is_on {
            (palette.selection, palette.panel)
        } else {
            (palette.raised, palette.text)
        };
        painter.circle(at, radius, fill, Stroke::new(1.0, palette.line));
        if let Some(number) = intervals.number(interval) {
            let number = number.to_string();
            painter.text(at, Align2::CENTER_CENTER, number, theme::huge(), ink);
        }
    }
}

/// A small count as the screen takes it.
pub(crate) fn count(n: usize) -> f32 {
    u16::try_from(n).map_or(f32::MAX, f32::from)
}
