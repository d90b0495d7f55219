//! The card on which the window asks something: above the workspace, one look for all.

use eframe::egui::{self, Area, Frame, Id, Margin, Order, Rect, RichText, Stroke, Ui, vec2};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};

/// Where a card hangs below the upper edge of what it covers, points.
pub(crate) const DROP: f32 = 32.0;
/// The room between a card's edge and what is on it, points.
pub(crate) const MARGIN: f32 = 16.0;

/// Shows a card with a title at the upper edge of `over`, at most `width` wide, points.
///
/// `content` is given the title, to name its controls by.
pub(crate) fn card(
    ui: &Ui,
    over: Rect,
    width: f32,
    title: &str,
    content: impl FnOnce(&mut Ui, &egui::Response),
) {
    let palette = Palette::in_ui(ui);
    Area::new(Id::unique(("card", title)))
        .order(Order::Foreground)
        .pivot(egui::Align2::CENTER_TOP)
        .fixed_pos(over.center_top() + vec2(0.0, DROP))
        .show(ui.ctx(), |ui| {
            let card = Frame::new()
                .fill(palette.panel)
                .stroke(Stroke::new(1.0, palette.line))
                .corner_radius(6)
                .inner_margin(Margin::same(16));
            card.show(ui, |ui| {
                ui.set_width((over.width() - 96.0).max(240.0).min(width));
                let title = RichText::new(title).font(theme::title());
                let title = ui.add(egui::Label::new(title).truncate());
                ui.add_space(STEP);
                content(ui, &title);
            });
        });
}
