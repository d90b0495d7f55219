//! The colour bar of the spectrum: its two handles are the floor and the top of what is told apart.

use eframe::egui::{
    self, Align2, CursorIcon, Mesh, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, pos2,
};

use crate::bench::settings::timeline::{LEVELS_DB, TimelineStyle};
use crate::kit::theme::{self, Palette};
use crate::kit::widgets::text::toggle;
use crate::tools::timeline::lanes::{LaneStyle, Layout, name_of};
use selvedge_foundation::quantity;

/// Width of the bar, points.
const BAR: f32 = 9.0;
/// How much finer a drag is with Shift.
const FINE: f64 = 0.2;

/// Shows the bar beside the spectrum, and on its left how frequencies are spread.
pub(crate) fn show(ui: &mut Ui, layout: &Layout, style: &mut LaneStyle) {
    let lane = layout.lanes[0];
    let left = lane.right() + 5.0;
    let bar = Rect::from_min_max(pos2(left, lane.top()), pos2(left + BAR, lane.bottom()));
    for end in 0..2 {
        let response = handle(ui, bar, end, style);
        drag(ui, &response, (bar, end), style);
    }
    paint(ui, bar, style);
    let name = name_of(lane);
    let corner = Rect::from_min_size(name.left_top(), egui::vec2(30.0, 18.0));
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(corner));
    let (word, tip) = if style.kept.is_linear {
        ("lin", "Frequencies are even; click for logarithmic ones")
    } else {
        ("log", "Frequencies are logarithmic; click for even ones")
    };
    if toggle(&mut child, word, false, tip) {
        style.kept.is_linear = !style.kept.is_linear;
        ui.ctx().request_repaint();
    }
}

/// Where a level stands on the bar.
fn y_of(bar: Rect, level_db: f64) -> f32 {
    let [least, most] = LEVELS_DB;
    #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
    let share = ((level_db - least) / (most - least)).clamp(0.0, 1.0) as f32;
    bar.bottom() - share * bar.height()
}

/// The lower handle takes what lies nearer to it, the upper one the rest.
fn handle(ui: &Ui, bar: Rect, end: usize, style: &LaneStyle) -> Response {
    let [low, high] = style.kept.levels_db().map(|level_db| y_of(bar, level_db));
    let middle = 0.5 * (low + high);
    let rows = if end == 0 {
        middle..=bar.bottom()
    } else {
        bar.top()..=middle
    };
    let part = Rect::from_x_y_ranges(bar.expand(4.0).x_range(), rows);
    let id = ui.scope_id().with(("timeline levels", end));
    let response = ui.interact(part, id, Sense::click_and_drag());
    response.widget_info(|| {
        let label = ["Floor of the spectrum, dB", "Top of the spectrum, dB"][end];
        WidgetInfo::slider(true, style.kept.levels_db()[end], label)
    });
    response.on_hover_cursor(CursorIcon::ResizeVertical)
}

fn drag(ui: &Ui, response: &Response, (bar, end): (Rect, usize), style: &mut LaneStyle) {
    let mut levels_db = style.kept.levels_db();
    let is_reset = response.double_clicked();
    if is_reset {
        levels_db = TimelineStyle::default().levels_db();
    } else if response.dragged() {
        let is_fine = ui.input(|input| input.modifiers.shift);
        let db_per_point = (LEVELS_DB[1] - LEVELS_DB[0]) / f64::from(bar.height());
        let by = -f64::from(response.drag_delta().y) * db_per_point;
        levels_db[end] += if is_fine { FINE * by } else { by };
    }
    if is_reset || response.dragged() {
        style.kept = style.kept.with_levels(levels_db, end == 0);
        ui.ctx().request_repaint();
    }
    let [floor, top] = levels_db.map(|level_db| quantity::fixed(level_db, 1));
    let words = format!(
        "Colours from {floor} to {top} dB re 1 µm: drag either end, finely with Shift; two clicks \
         put both back"
    );
    response.clone().on_hover_text(words);
}

fn paint(ui: &Ui, bar: Rect, style: &LaneStyle) {
    let (palette, painter) = (Palette::in_ui(ui), ui.painter());
    let mut mesh = Mesh::default();
    let [least, most] = LEVELS_DB;
    for step in 0..=24_u8 {
        let level_db = least + (most - least) * f64::from(step) / 24.0;
        let (y, colour) = (
            y_of(bar, level_db),
            style.map.colour(style.share_of(level_db)),
        );
        mesh.colored_vertex(pos2(bar.left(), y), colour);
        mesh.colored_vertex(pos2(bar.right(), y), colour);
        if step > 0 {
            let corner = 2 * u32::from(step) - 2;
            mesh.add_triangle(corner, corner + 1, corner + 2);
            mesh.add_triangle(corner + 1, corner + 2, corner + 3);
        }
    }
    painter.add(Shape::mesh(mesh));
    for (level_db, lift) in style.kept.levels_db().into_iter().zip([-1.0, 1.0]) {
        let y = painter.round_to_pixel_center(y_of(bar, level_db));
        let across = bar.left() - 2.0..=bar.right() + 2.0;
        painter.hline(across, y, Stroke::new(1.5, palette.selection));
        let words = quantity::fixed(level_db, 0);
        let y = (y + lift).clamp(bar.top() + 4.0, bar.bottom() - 4.0);
        let at = pos2(bar.right() + 4.0, y);
        painter.text(
            at,
            Align2::LEFT_CENTER,
            words,
            theme::small_number(),
            palette.dim,
        );
    }
}
