//! The space around what a pane shows, its parts, and the frame around a whole window.

use eframe::egui::{
    AsIdSalt, Context, Frame, Id, LayerId, Margin, Order, Painter, Rect, ScrollArea, Stroke,
    StrokeKind, Ui, UiBuilder, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};

/// Width of the frame around the window of an armed device, points.
const ARMED_FRAME: f32 = 5.0;
/// The same while every view shows the past.
const PAST_FRAME: f32 = 3.0;
/// How far below the window's upper edge that is said, points.
const PAST_TOP: f32 = 47.0;

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

/// What scrolls up and down over all the room that there is.
pub(crate) fn scroll_area(salt: impl AsIdSalt) -> ScrollArea {
    ScrollArea::vertical().id_salt(salt).auto_shrink(false)
}

/// A pane that may be longer than it is high.
pub(crate) fn scrolled(ui: &mut Ui, pane: &str, content: impl FnOnce(&mut Ui)) {
    scroll_area(("pane", pane)).show(ui, |ui| framed(ui, 12, content));
}

/// A part of a pane.
pub(crate) fn inside(ui: &mut Ui, rect: Rect, content: impl FnOnce(&mut Ui)) {
    let mut child = ui.new_child(UiBuilder::new().max_rect(rect));
    child.set_clip_rect(rect.expand(4.0).intersect(ui.clip_rect()));
    content(&mut child);
}

/// A column of fields that may be longer than it is high.
pub(crate) fn scrolled_column(ui: &mut Ui, id: &str, content: impl FnOnce(&mut Ui)) {
    scroll_area(id).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = STEP;
        // Room for the edge of a field that is asked for.
        let margin = Margin::symmetric(4, 0);
        Frame::new().inner_margin(margin).show(ui, content);
    });
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

/// Frames the whole window and says that every view shows the past.
pub(crate) fn frame_as_past(ctx: &Context, words: &str) {
    let layer = LayerId::new(Order::Foreground, Id::unique("past frame"));
    let palette = Palette::of(ctx.theme());
    let painter = ctx.layer_painter(layer);
    let window = ctx.content_rect();
    let stroke = Stroke::new(PAST_FRAME, palette.selection);
    painter.rect_stroke(window, 0, stroke, StrokeKind::Inside);
    let galley = painter.layout_no_wrap(words.to_owned(), theme::body(), palette.panel);
    // Below the header, where a row of tabs has room.
    let at = window.center_top() + vec2(-0.5 * galley.size().x, PAST_TOP);
    let ground = Rect::from_min_size(at, galley.size()).expand2(vec2(10.0, 2.0));
    painter.rect_filled(ground, 3, palette.selection);
    painter.galley(at, galley, palette.panel);
}

/// Writes one dim sentence into the middle of an empty picture.
pub(crate) fn paint_sentence(painter: &Painter, area: Rect, sentence: &str) {
    let palette = Palette::of(painter.ctx().theme());
    let width = (area.width() - 16.0).max(40.0);
    let galley = painter.layout(sentence.to_owned(), theme::small(), palette.dim, width);
    let corner = area.center() - 0.5 * galley.size();
    painter.galley(corner, galley, palette.dim);
}
