//! Small pieces of text: titles of sections, rows of a name and a value, buttons.

use eframe::egui::{
    self, Align, Align2, Color32, Layout, Rect, Response, RichText, Sense, Ui, pos2, vec2,
};

use crate::app::theme::{self, Palette, ROW, STEP};
use crate::quantity;

/// The quiet title of a section.
pub(crate) fn section(ui: &mut Ui, title: &str) {
    let palette = Palette::in_ui(ui);
    ui.add_space(STEP);
    ui.label(RichText::new(title).font(theme::small()).color(palette.dim));
}

/// A row with a name on the left and whatever `content` adds on the right, right-aligned.
pub(crate) fn row<R>(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui) -> R) -> Response {
    let size = vec2(ui.available_width(), 20.0);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.label(name);
        ui.with_layout(Layout::right_to_left(Align::Center), content);
    })
    .response
}

/// A row with a name and a number in fixed digits with its unit.
pub(crate) fn pair(ui: &mut Ui, name: &str, value: &str, unit: &str) -> Response {
    row(ui, name, |ui| {
        let palette = Palette::in_ui(ui);
        if !unit.is_empty() {
            ui.label(RichText::new(unit).font(theme::small()).color(palette.dim));
        }
        ui.label(RichText::new(value).font(theme::number()));
    })
}

/// A filled circle as wide as a letter: a lamp. Read out as `label`.
pub(crate) fn mark(ui: &mut Ui, colour: Color32, label: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(10.0, ROW), Sense::hover());
    ui.painter().circle_filled(rect.center(), 4.0, colour);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label));
    response
}

/// A button that is grey, with the reason as its tip, when `refusal` says why it does nothing.
pub(crate) fn button(ui: &mut Ui, text: &str, tip: &str, refusal: Option<&str>) -> bool {
    let button = egui::Button::new(text).min_size(vec2(0.0, ROW));
    let response = ui.add_enabled(refusal.is_none(), button);
    match refusal {
        Some(why) => response.on_disabled_hover_text(why).clicked(),
        None if tip.is_empty() => response.clicked(),
        None => response.on_hover_text(tip).clicked(),
    }
}

/// Paints a number, right-aligned in `rect`, its unit dimmer behind it.
pub(crate) fn paint_number(ui: &Ui, rect: Rect, value: f64, decimals: usize, unit: &str) {
    let palette = Palette::in_ui(ui);
    let right = pos2(rect.right(), rect.center().y);
    let painter = ui.painter();
    let unit_at = painter.text(
        right,
        Align2::RIGHT_CENTER,
        unit,
        theme::small(),
        palette.dim,
    );
    // Units are two letters wide at most: the number keeps its place whatever the unit.
    let number_right = pos2(right.x - unit_at.width().max(14.0) - 4.0, right.y);
    let digits = quantity::fixed(value, decimals);
    painter.text(
        number_right,
        Align2::RIGHT_CENTER,
        digits,
        theme::number(),
        palette.text,
    );
}
