//! The space around what a pane shows, and the frame around a whole window.

use eframe::egui::{
    Context, Frame, Id, LayerId, Margin, Order, ScrollArea, Stroke, StrokeKind, Ui,
};

use crate::kit::theme::Palette;

/// Width of the frame around the window of an armed device, points.
const ARMED_FRAME: f32 = 5.0;

/// A pane with space around it.
pub(crate) fn framed(ui: &mut Ui, across: i8, content: impl FnOnce(&mut Ui)) {
    let margin = Margin {
        left: across,
        right: across,
        top: 4,
        bottom: 8,
    };
    Frame::new().inner_margin(margin).show(ui, content);
}

/// A pane that may be longer than it is high.
pub(crate) fn scrolled(ui: &mut Ui, pane: &str, content: impl FnOnce(&mut Ui)) {
    let area = ScrollArea::vertical()
        .id_salt(("pane", pane))
        .auto_shrink(false);
    area.show(ui, |ui| framed(ui, 12, content));
}

/// Frames the whole window in red while high voltage is on: to be seen from across the room,
/// whatever pane is in front.
pub(crate) fn frame_as_armed(ctx: &Context) {
    let layer = LayerId::new(Order::Foreground, Id::unique("armed frame"));
    let palette = Palette::of(ctx.theme());
    let stroke = Stroke::new(ARMED_FRAME, palette.danger);
    let painter = ctx.layer_painter(layer);
    painter.rect_stroke(ctx.content_rect(), 0, stroke, StrokeKind::Inside);
}
