//! A part of a pane, what is dropped on a pane, and what an empty one says.

use std::path::PathBuf;

use eframe::egui::{
    Align, Frame, Label, Layout, Margin, Rect, RichText, ScrollArea, Stroke, StrokeKind, Ui,
    UiBuilder, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::button;

/// Shows something in a part of the pane.
pub(crate) fn inside(ui: &mut Ui, rect: Rect, content: impl FnOnce(&mut Ui)) {
    let mut child = ui.new_child(UiBuilder::new().max_rect(rect));
    child.set_clip_rect(rect.expand(4.0).intersect(ui.clip_rect()));
    content(&mut child);
}

/// A part that may be longer than it is high.
pub(crate) fn scrolled(ui: &mut Ui, id: &str, content: impl FnOnce(&mut Ui)) {
    ScrollArea::vertical()
        .id_salt(id)
        .auto_shrink(false)
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = STEP;
            // Room for the edge of a field that is asked for.
            let margin = Margin::symmetric(4, 0);
            Frame::new().inner_margin(margin).show(ui, content);
        });
}

/// Files that are dropped on the window now; while some hang over it, the pane has a bright edge.
pub(crate) fn dropped(ui: &Ui) -> Vec<PathBuf> {
    let (dropped, is_hovered) = ui.input(|input| {
        let paths = input
            .raw
            .dropped_files
            .iter()
            .map(|file| file.path().to_owned());
        (
            paths.collect::<Vec<_>>(),
            !input.raw.hovered_files.is_empty(),
        )
    });
    if is_hovered {
        let edge = Stroke::new(1.5, Palette::in_ui(ui).selection);
        ui.painter()
            .rect_stroke(ui.max_rect(), 4, edge, StrokeKind::Inside);
    }
    dropped
}

/// What to do when there is nothing yet, at most so high: a title, a line, a button, and small
/// words. Whether the button was pressed.
pub(crate) fn nothing_yet(
    ui: &mut Ui,
    most_height: f32,
    [title, line, ask]: [&str; 3],
    notes: [&str; 3],
) -> bool {
    let palette = Palette::in_ui(ui);
    let whole = ui.available_rect_before_wrap();
    let size = vec2(whole.width().min(520.0), whole.height().min(most_height));
    let room = Rect::from_center_size(whole.center(), size);
    let layout = Layout::top_down(Align::Min);
    let mut child = ui.new_child(UiBuilder::new().max_rect(room).layout(layout));
    let ui = &mut child;
    ui.spacing_mut().item_spacing.y = 2.0 * STEP;
    ui.label(RichText::new(title).font(theme::title()));
    ui.label(RichText::new(line).color(palette.text));
    let is_pressed = button(ui, ask, "", None);
    for words in notes {
        let words = RichText::new(words).font(theme::small()).color(palette.dim);
        ui.add(Label::new(words).wrap());
    }
    is_pressed
}
