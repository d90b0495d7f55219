//! Fields of a form: a name on the left, what is typed or chosen on the right; notes below them.

use eframe::egui::{self, InnerResponse, Label, Margin, RichText, Stroke, TextEdit, Ui, vec2};

use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::list::list_within;
use crate::kit::widgets::text::{line, named, quiet, small};

/// Height of a row, points.
pub(crate) const LINE: f32 = 22.0;
/// Width of a row's name, points.
const NAME: f32 = 96.0;

/// Whether a field is what the reader asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Need {
    /// It may be left as it is.
    Optional,
    /// The reader needs it.
    Asked,
}

impl Need {
    /// Asked for if so.
    pub(crate) fn of(is_asked: bool) -> Self {
        if is_asked {
            Self::Asked
        } else {
            Self::Optional
        }
    }
}

/// The title of a step, and how far it is in a few words.
pub(crate) fn step_title(ui: &mut Ui, nth: u8, title: &str, state: &str) {
    let palette = Palette::in_ui(ui);
    line(ui, LINE, |ui| {
        let nth = RichText::new(nth.to_string())
            .font(theme::number())
            .color(palette.dim);
        ui.label(nth);
        ui.label(
            RichText::new(title)
                .font(theme::body())
                .strong()
                .color(palette.text),
        );
        let state = quiet(state);
        ui.add(Label::new(state).truncate());
    });
}

/// How much a line matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    /// What was found or done.
    Quiet,
    /// What must be mended.
    Wrong,
}

/// A line of small words, broken where the column ends.
pub(crate) fn note(ui: &mut Ui, words: &str, tone: Tone) {
    let palette = Palette::in_ui(ui);
    let ink = match tone {
        Tone::Quiet => palette.dim,
        Tone::Wrong => palette.text,
    };
    let text = small(words, ink);
    let label = ui.add(Label::new(text).wrap());
    if tone == Tone::Wrong {
        let bar = label
            .rect
            .translate(vec2(-6.0, 0.0))
            .with_max_x(label.rect.left() - 4.0);
        ui.painter().rect_filled(bar, 0, palette.selection);
    }
}

/// The same where there is something to say; what follows keeps its identity, and so the focus,
/// whether there is or not.
pub(crate) fn note_if(ui: &mut Ui, words: Option<&str>, tone: Tone) {
    match words {
        Some(words) => note(ui, words, tone),
        None => ui.skip_ahead_auto_ids(1),
    }
}

/// A line of a form: its parts a step apart, from left to right.
pub(crate) fn form_line<R>(ui: &mut Ui, content: impl FnOnce(&mut Ui) -> R) -> InnerResponse<R> {
    line(ui, LINE, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.spacing_mut().interact_size.y = LINE - 2.0;
        content(ui)
    })
}

/// A row: a name, `content` with the name's response to be labelled by, and behind it in small
/// words how it is known.
pub(crate) fn row(
    ui: &mut Ui,
    name: &str,
    known: &str,
    content: impl FnOnce(&mut Ui, &egui::Response),
) {
    row_of(ui, NAME, (name, known), content);
}

/// The same with this much room for the name, points.
pub(crate) fn row_of(
    ui: &mut Ui,
    room: f32,
    (name, known): (&str, &str),
    content: impl FnOnce(&mut Ui, &egui::Response),
) {
    form_line(ui, |ui| {
        let text = quiet(name);
        let width = room.min(0.4 * ui.available_width());
        let label = ui.allocate_ui_with_layout(vec2(width, LINE), *ui.layout(), |ui| {
            ui.set_min_width(width);
            ui.add(Label::new(text).truncate())
        });
        content(ui, &label.inner);
        if !known.is_empty() {
            let known = quiet(known);
            ui.add(Label::new(known).truncate());
        }
    });
}

/// A field of text, named by `label`; it is as wide as it may be, or `width` points.
pub(crate) fn text(
    ui: &mut Ui,
    label: &egui::Response,
    typed: &mut String,
    (hint, width, need): (&str, f32, Need),
) -> egui::Response {
    let palette = Palette::in_ui(ui);
    let width = width.min(ui.available_width());
    let hint = RichText::new(hint).font(theme::number()).color(palette.dim);
    let field = TextEdit::singleline(typed)
        .desired_width(width - 12.0)
        .font(theme::number())
        .margin(Margin::symmetric(6, 2))
        .hint_text(hint);
    let response = ui.add(field).labelled_by(label.id);
    mark_asked(ui, &response, need);
    response
}

/// A field that is read when it is left, where something else was typed than stood there; Esc
/// leaves it as it was. `dressed` says how it looks.
pub(crate) fn typed_field(
    ui: &mut Ui,
    id: egui::Id,
    (label, now): (&str, &str),
    dressed: impl FnOnce(TextEdit<'_>) -> TextEdit<'_>,
) -> Option<String> {
    let editing: Option<String> = ui.data(|data| data.get_temp(id));
    let mut text = editing.unwrap_or_else(|| now.to_owned());
    let edit = TextEdit::singleline(&mut text).id(id).font(theme::number());
    let response = ui.add(dressed(edit));
    named(&response, label);
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        let is_cancelled = ui.input(|input| input.key_pressed(egui::Key::Escape));
        return (!is_cancelled && text != now).then_some(text);
    }
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
    }
    None
}

/// A list to choose from, named.
pub(crate) fn choose(
    ui: &mut Ui,
    name: &str,
    (text, width, need): (&str, f32, Need),
    content: impl FnOnce(&mut Ui),
) {
    let width = width.min(ui.available_width());
    let name_of = (("import", name), name);
    let response = list_within(ui, name_of, [width, width - 8.0], text, content);
    mark_asked(ui, &response, need);
}

/// What is asked for has an edge in the colour of what is chosen.
fn mark_asked(ui: &Ui, response: &egui::Response, need: Need) {
    if need == Need::Asked {
        let edge = Stroke::new(1.5, Palette::in_ui(ui).selection);
        let kind = egui::StrokeKind::Outside;
        ui.painter().rect_stroke(response.rect, 4, edge, kind);
    }
}

/// A list over the values of something that may be left to the file.
pub(crate) fn choose_of<T: Copy + PartialEq>(
    ui: &mut Ui,
    name: &str,
    chosen: &mut Option<T>,
    (values, by_file, need): (&[(T, &str)], &str, Need),
) {
    let now = values.iter().find(|(value, _)| Some(*value) == *chosen);
    let text = now.map_or(by_file, |(_, word)| *word);
    choose(ui, name, (text, 172.0, need), |ui| {
        ui.selectable_value(chosen, None, by_file);
        for (value, word) in values {
            ui.selectable_value(chosen, Some(*value), *word);
        }
    });
}
