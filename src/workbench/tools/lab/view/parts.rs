//! Small pieces that the views of the lab share.

use eframe::egui::{self, Align, Layout, Rect, Ui, UiBuilder, vec2};

use crate::kit::theme::{Palette, ROW};
use crate::kit::widgets::text::{button, quiet, small};

/// Shows something in a part of the pane.
pub(crate) fn within<R>(ui: &mut Ui, rect: Rect, content: impl FnOnce(&mut Ui) -> R) -> R {
    let builder = UiBuilder::new()
        .max_rect(rect)
        .layout(Layout::top_down(Align::Min));
    ui.scope_builder(builder, |ui| {
        ui.set_clip_rect(ui.clip_rect().intersect(rect.expand(2.0)));
        content(ui)
    })
    .inner
}

/// The quiet title over a plot; says where the plot begins.
pub(crate) fn title(ui: &Ui, rect: Rect, words: &str) -> Rect {
    let at = rect.left_top() + vec2(0.0, 0.5 * ROW - 5.0);
    let text = quiet(words);
    crate::kit::widgets::text::paint_line(ui, at, rect.width(), text);
    rect.with_min_y(rect.top() + 18.0)
}

/// A sentence that says what is wrong, marked by a bar before it.
pub(crate) fn complaint(ui: &mut Ui, words: &str) {
    let palette = Palette::in_ui(ui);
    let text = small(words, palette.text);
    let margin = egui::Margin {
        left: 8,
        ..egui::Margin::default()
    };
    let response = egui::Frame::new()
        .inner_margin(margin)
        .show(ui, |ui| ui.add(egui::Label::new(text).wrap()))
        .response;
    let x = response.rect.left() + 2.0;
    let bar = egui::Stroke::new(2.0, palette.selection);
    ui.painter().vline(x, response.rect.y_range(), bar);
}

/// A button as wide as the controls.
pub(crate) fn wide_button(ui: &mut Ui, text: &str, tip: &str, refusal: Option<&str>) -> bool {
    ui.vertical_centered_justified(|ui| button(ui, text, tip, refusal))
        .inner
}
