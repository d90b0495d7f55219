//! The keys of a block as fields of a form: what is typed or chosen is set in the text at once.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use eframe::egui::{TextEdit, Ui};

use crate::kit::widgets::fields::{Need, choose, row_of, text};
use crate::kit::widgets::text::{button, toggle};
use crate::tools::experiment::builder::blocks::{Field, Holds, Rows};
use crate::tools::experiment::builder::settle::settle;
use crate::tools::experiment::builder::study_text::Target;
use selvedge_experiment::design::Design;
use selvedge_foundation::files::{EditedKeys, KeyPlace, KeyValue};

/// Width of a field's name, points.
pub(super) const NAME: f32 = 104.0;
/// Width of a field, points.
pub(super) const FIELD: f32 = 216.0;
/// What stands where a name is left out.
const LEFT_OUT: &str = "as usual";

/// The keys of a design while they are shown, and what was changed.
pub(crate) struct Editing {
    pub(crate) keys: EditedKeys,
    /// The stimuli that may be referred to.
    pub(crate) stimuli: Vec<String>,
    /// What was changed, and what that is called.
    pub(crate) change: Option<(Target, &'static str)>,
}

impl Editing {
    /// Sets a key; `name` is what the step is called.
    pub(crate) fn set(
        &mut self,
        place: KeyPlace<'_>,
        value: Option<&KeyValue>,
        name: &'static str,
    ) {
        let mut hasher = DefaultHasher::new();
        place.hash(&mut hasher);
        self.keys.set(place, value);
        self.change = Some((Target::Key(hasher.finish()), name));
    }

    /// Says that tables came or went.
    pub(crate) fn restructured(&mut self, name: &'static str) {
        self.change = Some((Target::All, name));
    }
}

/// A field of the `nth` table.
pub(crate) fn field(ui: &mut Ui, editing: &mut Editing, (field, nth): (&Field, usize)) {
    let place = (field.table, nth, field.key);
    let value = editing.keys.value(place);
    if field.holds == Holds::Paragraph {
        return paragraph(ui, editing, (field, place));
    }
    row_of(ui, NAME, (field.name, ""), |ui, label| match field.holds {
        Holds::Name(may_be_left_out) => {
            let names = Design::names_of(field.table, field.key);
            let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
            let left_out = may_be_left_out.then_some(LEFT_OUT);
            one_of(ui, editing, (field, place), (&names, left_out));
        }
        Holds::Stimulus => {
            let names = editing.stimuli.clone();
            one_of(ui, editing, (field, place), (&names, Some(field.hint)));
        }
        Holds::Flag => {
            let is_on = value
                .as_ref()
                .and_then(KeyValue::as_bool)
                .unwrap_or_default();
            if toggle(ui, if is_on { "yes" } else { "no" }, is_on, field.name) {
                let value = (!is_on).then_some(&KeyValue::Boolean(true));
                editing.set(place, value, field.name);
            }
        }
        holds => {
            let id = ui.scope_id().with(place);
            let kept: Option<String> = ui.data(|data| data.get_temp(id));
            let mut typed = kept.unwrap_or_else(|| words_of(value.as_ref()));
            let response = text(ui, label, &mut typed, (field.hint, FIELD, Need::Optional));
            if response.changed() {
                if let Ok(value) = value_of(holds, &typed) {
                    editing.set(place, value.as_ref(), field.name);
                }
                // What is no number yet is typed on; it counts once it is one.
                ui.data_mut(|data| data.insert_temp(id, typed));
            } else if !response.has_focus() {
                ui.data_mut(|data| data.remove::<String>(id));
            }
        }
    });
}

/// Tables of one name, a row of fields each, with buttons that add one and take one away.
pub(crate) fn rows(ui: &mut Ui, editing: &mut Editing, rows: &Rows) {
    let n = editing.keys.n_tables(rows.table);
    for nth in 0..n {
        ui.push_id((rows.table, nth), |ui| {
            let mut is_gone = false;
            row_of(
                ui,
                NAME,
                (&format!("{} {}", rows.one, nth + 1), ""),
                |ui, _| {
                    let label = format!("Take {} {} away", rows.one, nth + 1);
                    is_gone = toggle(ui, "×", false, &label);
                },
            );
            if is_gone {
                editing.keys.remove(rows.table, nth);
                editing.restructured(rows.one);
                return;
            }
            for one in rows.fields {
                field(ui, editing, (one, nth));
            }
        });
    }
    if button(ui, &format!("Add a {}", rows.one), "", None) {
        editing.keys.push(rows.table, &rows.firsts());
        editing.restructured(rows.one);
    }
}

fn one_of(
    ui: &mut Ui,
    editing: &mut Editing,
    (field, place): (&Field, KeyPlace<'_>),
    (names, left_out): (&[String], Option<&str>),
) {
    let value = editing.keys.value(place);
    let now = value
        .as_ref()
        .and_then(KeyValue::as_str)
        .or(left_out)
        .unwrap_or_default();
    let mut chosen = None;
    choose(ui, field.name, (now, FIELD, Need::Optional), |ui| {
        if let Some(words) = left_out
            && ui.selectable_label(value.is_none(), words).clicked()
        {
            chosen = Some(None);
        }
        for name in names {
            if ui.selectable_label(now == name, name.as_str()).clicked() {
                chosen = Some(Some(name.as_str().into()));
            }
        }
    });
    if let Some(value) = chosen {
        editing.set(place, value.as_ref(), field.name);
        settle(&mut editing.keys);
        ui.ctx().request_repaint();
    }
}

fn paragraph(ui: &mut Ui, editing: &mut Editing, (field, place): (&Field, KeyPlace<'_>)) {
    let mut typed = words_of(editing.keys.value(place).as_ref());
    let label = ui.label(eframe::egui::RichText::new(field.name).small());
    let area = TextEdit::multiline(&mut typed)
        .desired_rows(3)
        .desired_width(NAME + FIELD)
        .hint_text(field.hint);
    if ui.add(area).labelled_by(label.id).changed() {
        let value = (!typed.trim().is_empty()).then(|| typed.as_str().into());
        editing.set(place, value.as_ref(), field.name);
    }
}

/// A value as it is typed.
fn words_of(value: Option<&KeyValue>) -> String {
    match value {
        None => String::new(),
        Some(KeyValue::String(words)) => words.clone(),
        Some(KeyValue::Array(all)) => {
            let all = all.iter().map(|one| words_of(Some(one)));
            all.collect::<Vec<_>>().join(", ")
        }
        Some(other) => other.to_string(),
    }
}

/// What is typed is no value of its kind, or not yet.
#[derive(Debug, PartialEq, Eq)]
struct Unfinished;

/// What was typed, nothing where that is empty.
fn value_of(holds: Holds, typed: &str) -> Result<Option<KeyValue>, Unfinished> {
    let words = typed.trim();
    if words.is_empty() {
        return Ok(None);
    }
    let number = |words: &str| {
        let number = words
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite());
        let whole = words.parse::<i64>().ok().map(KeyValue::Integer);
        whole.or_else(|| number.map(KeyValue::Float))
    };
    let value = match holds {
        Holds::Number => number(words).ok_or(Unfinished)?,
        Holds::Count => words.parse().map(KeyValue::Integer).or(Err(Unfinished))?,
        Holds::List => {
            let parts: Vec<&str> = words.split(',').map(str::trim).collect();
            let numbers: Option<Vec<KeyValue>> = parts.iter().map(|part| number(part)).collect();
            // A list of numbers is of one kind.
            let floats = |all: Vec<KeyValue>| {
                let is_whole = all.iter().all(|one| one.as_integer().is_some());
                let float = |one: KeyValue| match one {
                    KeyValue::Integer(_) if !is_whole => {
                        one.to_string().parse().map_or(one, KeyValue::Float)
                    }
                    other => other,
                };
                all.into_iter().map(float).collect()
            };
            let texts = || parts.iter().map(|part| KeyValue::from(*part)).collect();
            KeyValue::Array(numbers.map_or_else(texts, floats))
        }
        _ => typed.into(),
    };
    Ok(Some(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_typed_is_a_value_of_its_kind_or_none() {
        let value = |holds, typed| value_of(holds, typed).map(|v| v.map(|v| v.to_string()));
        let some = |text: &str| Ok(Some(text.to_owned()));
        assert_eq!(value(Holds::Count, " 4 "), some("4"));
        assert_eq!(value(Holds::Count, "4.5"), Err(Unfinished));
        assert_eq!(value(Holds::Number, "-6"), some("-6"));
        assert_eq!(value(Holds::Number, "2.5"), some("2.5"));
        assert_eq!(value(Holds::Number, "inf"), Err(Unfinished));
        assert_eq!(value(Holds::Number, ""), Ok(None));
        assert_eq!(value(Holds::List, "4, 2.5"), some("[4.0, 2.5]"));
        assert_eq!(
            value(Holds::List, "easy, hard"),
            some("[\"easy\", \"hard\"]")
        );
        let list = KeyValue::Array(vec![4.5.into(), KeyValue::Integer(2)]);
        assert_eq!(words_of(Some(&list)), "4.5, 2");
    }
}
