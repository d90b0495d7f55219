//! The photograph on the left of a line that is dragged, what is felt of it on the right, lit by
//! the same lamp.

use eframe::egui::{CursorIcon, Rect, Sense, Ui, WidgetInfo, pos2};

use crate::kit::widgets::slider::key_steps;
use crate::tools::picture::images::Image;
use crate::tools::picture::textures::{N_CARDS, Textures};
use crate::tools::picture::view::frame::line;

/// How far a key moves the line, share of the width.
const KEY_SHARE: f32 = 0.05;
/// What the line is called.
const NAME: &str = "Line between photograph and relief";

/// Shows both as large as fits.
pub(crate) fn show(
    ui: &Ui,
    room: Rect,
    [before, after]: &[Image; 2],
    (textures, card): (&mut Textures, usize),
) {
    let rect = textures.paint(ui.painter(), room, card, before);
    let response = ui.interact(rect, ui.scope_id().with("before"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Slider, ui.is_enabled(), NAME));
    let pointer = response
        .interact_pointer_pos()
        .filter(|_| response.dragged());
    if let Some(pointer) = pointer {
        textures.divided_at = (pointer.x - rect.left()) / rect.width();
    }
    let steps = key_steps(ui, &response);
    textures.divided_at += KEY_SHARE * steps as f32;
    textures.divided_at = textures.divided_at.clamp(0.0, 1.0);
    let x = rect.left() + textures.divided_at * rect.width();
    let right = ui
        .painter()
        .with_clip_rect(rect.with_min_x(x).intersect(ui.clip_rect()));
    textures.paint(&right, room, N_CARDS - 1, after);
    line(ui, [pos2(x, rect.top()), pos2(x, rect.bottom())]);
    let tip = "Left the photograph, right its relief under the same lamp: drag the line";
    response
        .on_hover_cursor(CursorIcon::ResizeHorizontal)
        .on_hover_text(tip);
}
