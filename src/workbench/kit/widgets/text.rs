//! Small pieces of text: titles of sections, rows of a name and a value, buttons.

use eframe::egui::{
    self, Align, Align2, AtomExt as _, Color32, InnerResponse, Layout, Painter, Pos2, Rect,
    Response, RichText, Sense, Ui, pos2, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use selvedge_foundation::quantity;

/// Letters of a side after a comma that are kept whole where a name is cut: “front”, “back”.
const SIDE: usize = 12;
/// Letters at the end of any other name that stay.
const END: usize = 4;

/// Small words.
pub(crate) fn small(words: impl Into<String>, ink: Color32) -> RichText {
    RichText::new(words).small().color(ink)
}

/// Small and dim words.
pub(crate) fn quiet(words: impl Into<String>) -> RichText {
    RichText::new(words).small().weak()
}

/// Words over as many lines as they need.
pub(crate) fn paragraph(ui: &mut Ui, words: RichText) -> Response {
    ui.add(egui::Label::new(words).wrap())
}

/// Paints small and dim words; says where they stand.
pub(crate) fn paint_quiet(
    painter: &Painter,
    at: Pos2,
    anchor: Align2,
    words: impl ToString,
) -> Rect {
    let palette = Palette::of(painter.ctx().theme());
    painter.text(at, anchor, words, theme::small(), palette.dim)
}

/// Has a widget read out as `label`.
pub(crate) fn named(response: &Response, label: impl Into<String>) {
    let ctx = &response.ctx;
    ctx.accesskit_node_builder(response.id, |node| node.set_label(label));
}

/// Widgets side by side, as wide as there is room.
pub(crate) fn line<R>(
    ui: &mut Ui,
    height: f32,
    content: impl FnOnce(&mut Ui) -> R,
) -> InnerResponse<R> {
    let size = vec2(ui.available_width(), height);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), content)
}

/// The quiet title of a section.
pub(crate) fn section(ui: &mut Ui, title: &str) {
    ui.add_space(STEP);
    ui.label(quiet(title));
}

/// A row with a name on the left and whatever `content` adds on the right, right-aligned.
pub(crate) fn row<R>(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui) -> R) -> Response {
    row_of(ui, (name, 20.0), content)
}

/// The same, as high as a field that one types in.
pub(crate) fn field_row<R>(
    ui: &mut Ui,
    name: &str,
    content: impl FnOnce(&mut Ui) -> R,
) -> Response {
    row_of(ui, (name, ROW), content)
}

fn row_of<R>(
    ui: &mut Ui,
    (name, height): (&str, f32),
    content: impl FnOnce(&mut Ui) -> R,
) -> Response {
    line(ui, height, |ui| {
        ui.label(name);
        ui.with_layout(Layout::right_to_left(Align::Center), content);
    })
    .response
}

/// A number in fixed digits with its unit after a small, dim name.
pub(crate) fn quiet_pair(ui: &mut Ui, name: &str, value: &str, unit: &str) -> Response {
    let name = quiet(name);
    line(ui, 20.0, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.label(name);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(quiet(unit));
            ui.label(RichText::new(value).font(theme::number()));
        });
    })
    .response
}

/// Such pairs side by side: name, number, unit, and what it says when the pointer rests on it.
pub(crate) fn quiet_pairs(ui: &mut Ui, pairs: [(&str, String, &str, &str); 2]) {
    ui.columns_const(|columns: &mut [Ui; 2]| {
        for (ui, (name, value, unit, tip)) in columns.iter_mut().zip(pairs) {
            quiet_pair(ui, name, &value, unit).on_hover_text(tip);
        }
    });
}

/// A filled circle as wide as a letter: a lamp. Read out as `label`.
pub(crate) fn mark(ui: &mut Ui, colour: Color32, label: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(10.0, ROW), Sense::hover());
    ui.painter().circle_filled(rect.center(), 4.0, colour);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, label));
    response
}

/// A line of a menu that is ticked or not, with its key; the menu stays open. Says whether it was
/// clicked.
pub(crate) fn tick_box(ui: &mut Ui, label: &str, is_ticked: bool, key: String) -> bool {
    let mut is_ticked = is_ticked;
    let line = ui.horizontal(|ui| {
        let response = ui.add(egui::Checkbox::new(&mut is_ticked, label));
        if !key.is_empty() {
            ui.weak(key);
        }
        response.clicked()
    });
    line.inner
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

/// A small square button that is on or off: mute, solo. Read out as `label`, which is its tip.
pub(crate) fn toggle(ui: &mut Ui, letter: &str, is_on: bool, label: &str) -> bool {
    let palette = Palette::in_ui(ui);
    let font = theme::small();
    let galley = ui
        .painter()
        .layout_no_wrap(letter.to_owned(), font.clone(), palette.text);
    let size = vec2((galley.size().x + 8.0).max(18.0), 18.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::CheckBox, ui.is_enabled(), is_on, label)
    });
    let (fill, ink) = match (is_on, response.hovered() || response.has_focus()) {
        (true, _) => (palette.selection, palette.panel),
        (false, true) => (palette.hovered, palette.text),
        (false, false) => (palette.raised, palette.dim),
    };
    ui.painter().rect_filled(rect, 3, fill);
    let at = rect.center();
    ui.painter()
        .text(at, Align2::CENTER_CENTER, letter, font, ink);
    response.on_hover_text(label).clicked()
}

/// A toggle for each of some values, of which one is chosen: the value, its name and its tip.
pub(crate) fn toggles<T: Copy + PartialEq>(
    ui: &mut Ui,
    chosen: &mut T,
    values: &[(T, &str, &str)],
) {
    for (value, name, tip) in values {
        if toggle(ui, name, *chosen == *value, tip) {
            *chosen = *value;
        }
    }
}

/// One of a list to choose from, as wide as the list: its name, and dimmer as much of `detail` as
/// there is room for. Says whether it was chosen.
pub(crate) fn choice(ui: &mut Ui, name: RichText, detail: &str, tip: &str) -> bool {
    let palette = Palette::in_ui(ui);
    let detail = quiet(detail);
    let name = name.color(palette.text).atom_shrink(false);
    let line = egui::Button::new((name, detail.atom_shrink(true)))
        .gap(2.0 * STEP)
        .frame_when_inactive(false)
        .truncate()
        .min_size(vec2(ui.available_width(), ROW));
    ui.add(line).on_hover_text(tip).clicked()
}

/// Paints as much of a line as there is room for, and … where it breaks off; its left end is at
/// `left`, halfway up.
pub(crate) fn paint_line(ui: &Ui, left: Pos2, width: f32, text: RichText) {
    let job = egui::WidgetText::from(text).into_galley(
        ui,
        Some(egui::TextWrapMode::Truncate),
        width.max(1.0),
        egui::TextStyle::Body,
    );
    let corner = left - vec2(0.0, 0.5 * job.size().y);
    ui.painter().galley(corner, job, Palette::in_ui(ui).text);
}

/// Paints a name; where there is no room for all of it, its end stays, which tells front from back
/// and one of several from the others.
pub(crate) fn paint_name(ui: &Ui, left: Pos2, width: f32, (name, ink): (&str, Color32)) {
    let galley_of = |part: &str, width: f32| {
        let font = theme::body();
        let mut job = egui::text::LayoutJob::simple_singleline(part.to_owned(), font, ink);
        job.wrap = egui::text::TextWrapping::truncate_at_width(width);
        ui.painter().layout_job(job)
    };
    let mut at = left;
    let mut paint = |galley: std::sync::Arc<egui::Galley>| {
        let size = galley.size();
        let corner = at - vec2(0.0, 0.5 * size.y);
        ui.painter().galley(corner, galley, ink);
        at.x += size.x;
    };
    let whole = galley_of(name, f32::INFINITY);
    if whole.size().x <= width {
        return paint(whole);
    }
    let (head, tail) = name_parts(name);
    let end = galley_of(&tail, f32::INFINITY);
    paint(galley_of(head, (width - end.size().x).max(1.0)));
    paint(end);
}

/// What of a name may be cut, and the end that stays.
fn name_parts(name: &str) -> (&str, String) {
    if let Some((head, side)) = name
        .rsplit_once(", ")
        .filter(|(_, side)| side.len() <= SIDE)
    {
        return (head, format!(" · {side}"));
    }
    let mut letters = name.char_indices().rev();
    let from = letters.nth(END - 1).map_or(0, |(from, _)| from);
    (&name[..from], name[from..].to_owned())
}

/// A line around what has the keyboard.
pub(crate) fn paint_focus(ui: &Ui, response: &Response) {
    if response.has_focus() {
        let edge = egui::Stroke::new(1.0, Palette::in_ui(ui).selection);
        let inside = egui::StrokeKind::Inside;
        ui.painter().rect_stroke(response.rect, 4, edge, inside);
    }
}

/// Paints a number, right-aligned in `rect`, its unit dimmer behind it.
pub(crate) fn paint_number(ui: &Ui, rect: Rect, value: f64, decimals: usize, unit: &str) {
    let palette = Palette::in_ui(ui);
    let right = pos2(rect.right(), rect.center().y);
    let painter = ui.painter();
    let unit_at = paint_quiet(painter, right, Align2::RIGHT_CENTER, unit);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_tells_front_from_back_is_never_cut() {
        let parts = |name| name_parts(name);
        assert_eq!(
            parts("Wool worsted twill, back"),
            ("Wool worsted twill", " · back".to_owned())
        );
        assert_eq!(parts("Jersey 12"), ("Jerse", "y 12".to_owned()));
        assert_eq!(parts("É"), ("", "É".to_owned()));
        let long = "Twill, changed in many ways";
        assert_eq!(parts(long), ("Twill, changed in many ", "ways".to_owned()));
    }
}
