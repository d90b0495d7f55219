//! One parameter in a row: a slider, words to choose from, numbers to type.

use eframe::egui::{
    self, Align, Color32, ComboBox, Layout, Response, Sense, TextEdit, Ui, WidgetInfo, vec2,
};

use crate::kit::theme;
use crate::kit::theme::{Palette, ROW};
use crate::kit::widgets::fields::typed_field;
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::{RowShape, slider_row_as};
use crate::kit::widgets::text::{button, line, named, quiet, row, toggle};
use crate::tools::lab::family::key_value;
use crate::tools::lab::steps::Steps;
use selvedge_foundation::files::{KeyValue, Keys};
use selvedge_textile::{Draft, FourierTemplate, Parameter, Place};

/// Width of a parameter's name, points.
const NAME: f32 = 134.0;
/// Numbers that reach so far have a rail over decades.
const FAR: f64 = 400.0;

/// What a number may be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    /// Its ends.
    pub(crate) ends: [f64; 2],
    /// Its unit.
    pub(crate) unit: &'static str,
    /// Whether it is whole.
    pub(crate) is_whole: bool,
}

/// What stands where a table is left out: once, in the place of its first parameter.
pub(crate) fn missing(parameter: &Parameter) -> Option<&'static str> {
    match (parameter.place.table, parameter.place.key) {
        ("source.weft", "smd_um") => Some("The weft is restored like the warp"),
        _ => None,
    }
}

/// A number with a rail; any number may be typed, and what is wrong with it is said by the reader.
pub(crate) fn number(
    ui: &mut Ui,
    steps: &Steps,
    parameter: &Parameter,
    range: Range,
) -> Option<KeyValue> {
    let value = steps.recipe.draft.number(parameter.place)?;
    let first = steps.recipe.first.number(parameter.place).unwrap_or(value);
    let scale = scale(range, first, value);
    let palette = Palette::in_ui(ui);
    let is_changed = (value - first).abs() > 1e-12;
    let ink = if is_changed {
        palette.text
    } else {
        palette.line
    };
    let shape = RowShape {
        name: NAME,
        takes_any: true,
    };
    let (new, response) = slider_row_as(ui, (parameter.name, ink), (shape, scale), value);
    describe(&response, parameter, Some((first, scale)));
    new.map(|value| key_value(value, range.is_whole))
}

/// How a number lies along its rail: evenly, or over decades where it reaches far.
fn scale(range: Range, first: f64, value: f64) -> Scale {
    let [least, most] = range.ends;
    let is_far = least >= 0.0 && most > FAR;
    let step = if range.is_whole {
        1.0
    } else {
        crate::kit::widgets::axis::round_step((most - least) / 100.0).min(1.0)
    };
    let curve = if is_far {
        Curve::Decades(if least > 0.0 {
            (most / least).log10()
        } else {
            4.0
        })
    } else {
        Curve::Even
    };
    let of_step = if range.is_whole { 0 } else { decimals(step) };
    Scale {
        least,
        most,
        resting: first,
        step,
        decimals: decimals(value).max(if is_far { 0 } else { of_step }),
        unit: range.unit,
        factor: 1.0,
        noticed: None,
        curve,
    }
}

/// Decimals that a number needs, at most four.
fn decimals(value: f64) -> usize {
    let is_enough = |decimals: &usize| {
        let scale = 10_f64.powi(i32::try_from(*decimals).unwrap_or(4));
        ((value * scale).round() / scale - value).abs() < 1e-7
    };
    (0..4).find(is_enough).unwrap_or(4)
}

fn describe(response: &Response, parameter: &Parameter, first: Option<(f64, Scale)>) {
    let begins = first.map_or_else(String::new, |(first, scale)| {
        let value = selvedge_foundation::quantity::with_unit(first, decimals(first), scale.unit);
        let ends = [scale.least, scale.most]
            .map(|end| selvedge_foundation::quantity::fixed(end, decimals(end)));
        format!(
            "\n{} to {}; began with {value}: double click to go back",
            ends[0], ends[1]
        )
    });
    let words = format!("{}{begins}\n{}", parameter.what, parameter.place.key);
    response.clone().on_hover_text(words);
}

/// A number that may be left out; the outer `None` is no change.
#[expect(clippy::option_option, reason = "no change, left out, or set")]
pub(crate) fn optional(
    ui: &mut Ui,
    steps: &Steps,
    parameter: &Parameter,
    (range, instead_of): (Range, &'static str),
) -> Option<Option<KeyValue>> {
    if steps.recipe.draft.value(parameter.place).is_some() {
        let new = number(ui, steps, parameter, range);
        if new.is_some() || !instead_of.is_empty() {
            return new.map(Some);
        }
        let tip = format!("Leave “{}” out", parameter.name);
        return button(ui, "leave out", &tip, None).then_some(None);
    }
    let mut is_wanted = false;
    let response = row(ui, parameter.name, |ui| {
        let words = if instead_of.is_empty() { "add" } else { "use" };
        let label = format!("{words} {}", parameter.name);
        is_wanted = toggle(ui, words, false, &label);
    });
    describe(&response, parameter, None);
    let other = Place {
        key: instead_of,
        ..parameter.place
    };
    let [least, most] = range.ends;
    let begin = steps
        .recipe
        .draft
        .number(other)
        .unwrap_or(1.0)
        .clamp(least, most);
    is_wanted.then(|| Some(key_value(begin, range.is_whole)))
}

/// One of several words.
pub(crate) fn choice(
    ui: &mut Ui,
    draft: &Draft,
    parameter: &Parameter,
    words: &[&'static str],
) -> Option<KeyValue> {
    let now = draft.value(parameter.place).and_then(KeyValue::as_str);
    let now = now.or_else(|| words.first().copied()).unwrap_or_default();
    combo(ui, parameter, now, words).map(KeyValue::from)
}

/// A list of words under a name; says which one was chosen, if it is another.
pub(crate) fn combo<'a>(
    ui: &mut Ui,
    parameter: &Parameter,
    now: &str,
    words: &[&'a str],
) -> Option<&'a str> {
    let mut chosen = None;
    let response = row(ui, parameter.name, |ui| {
        let combo = ComboBox::from_id_salt((parameter.place.table, parameter.place.key));
        let list = combo.width(140.0).selected_text(now).show_ui(ui, |ui| {
            for word in words {
                if ui.selectable_label(*word == now, *word).clicked() && *word != now {
                    chosen = Some(*word);
                }
            }
        });
        let label = parameter.name;
        named(&list.response, label);
    });
    describe(&response, parameter, None);
    chosen
}

/// Yes or no.
pub(crate) fn flag(ui: &mut Ui, draft: &Draft, parameter: &Parameter) -> Option<KeyValue> {
    let is_on = draft.value(parameter.place).and_then(KeyValue::as_bool);
    let is_on = is_on.unwrap_or(false);
    let mut is_pressed = false;
    let response = row(ui, parameter.name, |ui| {
        let words = if is_on { "yes" } else { "no" };
        is_pressed = toggle(ui, words, is_on, parameter.name);
    });
    describe(&response, parameter, None);
    is_pressed.then_some((!is_on).into())
}

/// The seed: typed, or another one.
pub(crate) fn seed(ui: &mut Ui, draft: &Draft, parameter: &Parameter) -> Option<KeyValue> {
    let now = draft
        .value(parameter.place)
        .and_then(KeyValue::as_integer)?;
    let mut chosen = None;
    let response = row(ui, parameter.name, |ui| {
        if button(ui, "New seed", "Another piece of the same cloth", None) {
            chosen = Some(now % 9973 + 1);
        }
        let typed = field(ui, parameter, (&now.to_string(), 72.0));
        chosen = chosen.or_else(|| typed?.trim().parse().ok());
    });
    describe(&response, parameter, None);
    chosen
        .filter(|chosen| *chosen != now)
        .map(KeyValue::Integer)
}

/// Several numbers in a field.
pub(crate) fn list(
    ui: &mut Ui,
    draft: &Draft,
    parameter: &Parameter,
    (unit, is_whole): (&str, bool),
) -> Option<KeyValue> {
    let values = draft.value(parameter.place)?.as_array()?;
    let texts: Vec<String> = values.iter().map(ToString::to_string).collect();
    let text = texts.join("  ");
    let head = format!("{} ({} values)", parameter.name, values.len());
    let response = row(ui, &head, |ui| {
        ui.label(quiet(unit));
    });
    describe(&response, parameter, None);
    let typed = field(ui, parameter, (&text, f32::INFINITY))?;
    let read = |word: &str| -> Option<KeyValue> {
        if is_whole {
            word.parse().ok().map(KeyValue::Integer)
        } else {
            let value: f64 = word.replace('−', "-").parse().ok()?;
            value.is_finite().then_some(KeyValue::Float(value))
        }
    };
    let words = typed.split(|c: char| c.is_whitespace() || c == ',' || c == ';');
    let words = words.filter(|word| !word.is_empty());
    let read: Option<Vec<KeyValue>> = words.map(read).collect();
    let read = KeyValue::Array(read?);
    (Some(&read) != draft.value(parameter.place)).then_some(read)
}

/// A colour: its digits beside a piece of it.
pub(crate) fn colour(ui: &mut Ui, draft: &Draft, parameter: &Parameter) -> Option<KeyValue> {
    let now = draft.value(parameter.place)?.as_str()?.to_owned();
    let mut typed = None;
    let response = row(ui, parameter.name, |ui| {
        typed = field(ui, parameter, (&now, 84.0));
        let (rect, _) = ui.allocate_exact_size(vec2(16.0, 16.0), Sense::hover());
        if let Ok(ink) = Color32::from_hex(&now) {
            ui.painter().rect_filled(rect, 3, ink);
        }
    });
    describe(&response, parameter, None);
    let typed = typed?.trim().to_owned();
    (typed != now).then(|| typed.into())
}

/// A template: one of the examples, or the recipe's own.
#[expect(clippy::option_option, reason = "no change, left out, or set")]
pub(crate) fn template(
    ui: &mut Ui,
    draft: &Draft,
    parameter: &Parameter,
    is_optional: bool,
) -> Option<Option<KeyValue>> {
    const LIKE_WARP: &str = "like the warp";
    let own = draft.value(parameter.place);
    let name = own.and_then(|own| own.as_table()?.get("name")?.as_str());
    let templates = FourierTemplate::examples().ok()?;
    let mut names: Vec<&str> = templates.iter().map(|one| one.name.as_str()).collect();
    if is_optional {
        names.insert(0, LIKE_WARP);
    }
    let chosen = combo(ui, parameter, name.unwrap_or(LIKE_WARP), &names)?;
    if chosen == LIKE_WARP {
        return Some(None);
    }
    let template = templates.iter().find(|one| one.name == chosen)?;
    let path = std::path::Path::new(chosen);
    let text = selvedge_foundation::files::keys_to_string(template, path).ok()?;
    let keys: Keys = selvedge_foundation::files::keys_from_str(&text, path).ok()?;
    Some(Some(KeyValue::Table(keys)))
}

/// A field that is read when it is left; Esc leaves it as it was.
pub(crate) fn field(
    ui: &mut Ui,
    parameter: &Parameter,
    (now, width): (&str, f32),
) -> Option<String> {
    let id = ui.scope_id().with(("field", parameter.place));
    typed_field(ui, id, (parameter.name, now), |edit| {
        edit.desired_width(width)
            .margin(egui::Margin::symmetric(6, 3))
    })
}

/// A name before a field of words, below each other.
pub(crate) fn named_field(ui: &mut Ui, name: &str, text: &mut String) -> Response {
    ui.label(quiet(name));
    let edit = TextEdit::singleline(text)
        .desired_width(f32::INFINITY)
        .margin(egui::Margin::symmetric(6, 4));
    let response = ui.add(edit);
    named(&response, name);
    response
}

/// A short field with a name before it, in a row.
pub(crate) fn short_field(ui: &mut Ui, (name, unit): (&str, &str), text: &mut String) {
    line(ui, ROW, |ui| {
        ui.label(name);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(quiet(unit));
            let edit = TextEdit::singleline(text)
                .font(theme::number())
                .desired_width(84.0)
                .margin(egui::Margin::symmetric(6, 3));
            let response = ui.add(edit);
            response.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, name));
            named(&response, name);
        });
    });
}
