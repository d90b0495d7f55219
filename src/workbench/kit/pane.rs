//! The space around what a pane shows.

use eframe::egui::{Frame, Margin, ScrollArea, Ui};

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
