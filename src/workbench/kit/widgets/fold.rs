//! A part of a pane that folds away: a hairline, its name, and what matters of it while it is
//! closed.

use eframe::egui::{
    self, Align2, Rect, Response, RichText, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::text::paint_line;

/// Width of the triangle, points.
const TRIANGLE: f32 = 16.0;

/// Shows a part called `title`, open at first if `is_open_first`, with a few dim words on its right
/// end; `content` is drawn only while it is open. Which parts are open lasts as long as the window.
pub(crate) fn fold(
    ui: &mut Ui,
    (title, is_open_first): (&'static str, bool),
    summary: &str,
    content: impl FnOnce(&mut Ui),
) {
    let id = ui.scope_id().with(("fold", title));
    let is_open = ui.data(|data| data.get_temp(id)).unwrap_or(is_open_first);
    if described_fold(ui, (title, is_open), summary, content).clicked() {
        ui.data_mut(|data| data.insert_temp(id, !is_open));
    }
}

/// The same where somebody else knows whether it is open, and takes a click on its name.
pub(crate) fn described_fold(
    ui: &mut Ui,
    (title, is_open): (&'static str, bool),
    summary: &str,
    content: impl FnOnce(&mut Ui),
) -> Response {
    let response = head(ui, title, is_open, summary);
    if is_open != response.clicked() {
        content(ui);
        ui.add_space(STEP);
    }
    response
}

fn head(ui: &mut Ui, title: &str, is_open: bool, summary: &str) -> Response {
    let palette = Palette::in_ui(ui);
    let size = vec2(ui.available_width(), ROW + STEP);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response
        .widget_info(|| WidgetInfo::selected(egui::Role::Button, ui.is_enabled(), is_open, title));
    let painter = ui.painter();
    let hairline = Stroke::new(1.0, palette.hairline);
    painter.hline(rect.x_range(), rect.top(), hairline);
    let is_pointed = response.hovered() || response.has_focus();
    let ink = if is_pointed {
        palette.text
    } else {
        palette.dim
    };
    let middle = pos2(rect.left() + 5.0, rect.center().y + 1.0);
    painter.add(Shape::convex_polygon(
        triangle(middle, is_open),
        ink,
        Stroke::NONE,
    ));
    let left = pos2(rect.left() + TRIANGLE, middle.y);
    let name = painter.text(
        left,
        Align2::LEFT_CENTER,
        title,
        theme::body(),
        palette.text,
    );
    let right = Rect::from_min_max(
        pos2(name.right() + 3.0 * STEP, rect.top()),
        rect.right_bottom(),
    );
    paint_summary(ui, right, middle.y, summary);
    response
}

/// Dim words at the right end of `rect`, as many as there is room for.
fn paint_summary(ui: &Ui, rect: Rect, y: f32, summary: &str) {
    let palette = Palette::in_ui(ui);
    let font = theme::small();
    let text = summary.to_owned();
    let galley = ui.painter().layout_no_wrap(text, font.clone(), palette.dim);
    let left = pos2((rect.right() - galley.size().x).max(rect.left()), y);
    let text = RichText::new(summary).font(font).color(palette.dim);
    paint_line(ui, left, rect.right() - left.x + 0.5, text);
}

fn triangle(middle: egui::Pos2, is_open: bool) -> Vec<egui::Pos2> {
    let corners = if is_open {
        [vec2(-4.0, -2.0), vec2(4.0, -2.0), vec2(0.0, 3.0)]
    } else {
        [vec2(-2.0, -4.0), vec2(3.0, 0.0), vec2(-2.0, 4.0)]
    };
    corners.map(|by| middle + by).to_vec()
}
