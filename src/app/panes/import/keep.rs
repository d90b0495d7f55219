//! The fourth step: what the textile is called, what was measured on it, and keeping it.

use eframe::egui::{Align, Layout, RichText, Ui, vec2};

use super::ImportView;
use super::fields::{LINE, Need, Tone, choose, note, row, step_title, text};
use crate::app::importing::{Found, ImportCommand, Importing, WordsDraft};
use crate::app::panes::Wishes;
use crate::app::theme::{self, Palette, STEP};
use crate::app::widgets::{button, toggle};
use crate::textile::{Construction, Measurement, known_figures, nth_id};

/// Width of a column of fields, points.
const COLUMN: f32 = 264.0;
/// Ways to make a cloth.
const MADE: [(Construction, &str); 4] = [
    (Construction::Woven, "woven"),
    (Construction::Knitted, "knitted"),
    (Construction::Nonwoven, "nonwoven"),
    (Construction::Other, "other"),
];

/// Shows the step.
pub(super) fn show(
    ui: &mut Ui,
    importing: &mut Importing,
    view: &ImportView<'_>,
    wishes: &mut Wishes,
) {
    let found = importing.found().cloned();
    let is_known = |id: &str| view.shelf.iter().any(|item| item.id == id);
    let refusal = importing.refusal(is_known);
    let line = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(vec2(ui.available_width(), LINE + 2.0), line, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        let width = (ui.available_width() - 250.0).max(80.0);
        ui.allocate_ui_with_layout(vec2(width, LINE), line, |ui| {
            step_title(
                ui,
                4,
                "Name and keep",
                &ids_words(importing, found.as_deref()),
            );
        });
        let (save, feel) = ("Save to the library", "Save and feel");
        if button(ui, save, "Write it into the library", refusal.as_deref()) {
            wishes.push(ImportCommand::Keep { is_felt: false }.into());
        }
        let tip = "Write it into the library and place it under the display";
        if button(ui, feel, tip, refusal.as_deref()) {
            wishes.push(ImportCommand::Keep { is_felt: true }.into());
        }
    });
    show_outcome(ui, importing, refusal.as_deref());
    let suggested = found.as_deref().map(Found::own_name).unwrap_or_default();
    let usual = match found.as_deref().map(|found| found.kind) {
        Some(Measurement::Strokes) => Construction::Woven,
        _ => Construction::Other,
    };
    let words = &mut importing.draft.words;
    let has_two = ui.available_width() >= 2.0 * COLUMN + 2.0 * STEP;
    if has_two {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0 * STEP;
            for nth in 0..2 {
                ui.vertical(|ui| {
                    ui.set_width(COLUMN);
                    if nth == 0 {
                        show_words(ui, words, &suggested, usual);
                    } else {
                        show_figures(ui, words);
                    }
                });
            }
        });
    } else {
        show_words(ui, words, &suggested, usual);
        show_figures(ui, words);
    }
}

/// The ids that the textiles will have.
fn ids_words(importing: &Importing, found: Option<&Found>) -> String {
    let Some(found) = found else {
        return String::new();
    };
    let id = importing.draft.words.id(&found.own_name());
    let n = found.heights().map_or(1, |heights| heights.places.len());
    if n > 1 {
        format!(
            "{n} textiles: {} … {}",
            nth_id(&id, 0, n),
            nth_id(&id, n - 1, n)
        )
    } else {
        id
    }
}

/// What was kept, or why nothing can be.
fn show_outcome(ui: &mut Ui, importing: &Importing, refusal: Option<&str>) {
    match importing.kept() {
        Some(Ok(names)) => note(ui, &format!("given to the library: {names}"), Tone::Quiet),
        Some(Err(failure)) => note(ui, &failure.line, Tone::Wrong),
        None => {
            if let Some(words) = refusal.filter(|_| importing.found().is_some()) {
                note(ui, words, Tone::Quiet);
            }
        }
    }
}

fn show_words(ui: &mut Ui, words: &mut WordsDraft, suggested: &str, usual: Construction) {
    let wide = f32::INFINITY;
    row(ui, "name", "", |ui, label| {
        text(
            ui,
            label,
            &mut words.name,
            (suggested, wide, Need::Optional),
        );
    });
    let id = words.id(suggested);
    row(ui, "id", "", |ui, label| {
        text(ui, label, &mut words.id, (&id, wide, Need::Optional));
    });
    row(ui, "made", "", |ui, _| {
        let now = words.construction.unwrap_or(usual);
        choose(
            ui,
            "How it is made",
            (now.word(), 120.0, Need::Optional),
            |ui| {
                for (made, word) in MADE {
                    ui.selectable_value(&mut words.construction, Some(made), word);
                }
            },
        );
    });
    row(ui, "fibre", "", |ui, label| {
        text(
            ui,
            label,
            &mut words.fibre,
            ("cotton, wool …", wide, Need::Optional),
        );
    });
    row(ui, "licence", "", |ui, label| {
        text(
            ui,
            label,
            &mut words.licence,
            ("of the files", wide, Need::Optional),
        );
    });
    row(ui, "notes", "", |ui, label| {
        text(
            ui,
            label,
            &mut words.notes,
            ("one line", wide, Need::Optional),
        );
    });
}

/// Figures that were measured elsewhere.
fn show_figures(ui: &mut Ui, words: &mut WordsDraft) {
    let palette = Palette::in_ui(ui);
    let title = RichText::new("figures measured elsewhere")
        .font(theme::small())
        .color(palette.dim);
    ui.label(title);
    let mut gone = None;
    for (nth, (key, typed)) in words.figures.iter_mut().enumerate() {
        let known = known_figures().find(|figure| figure.key == *key);
        let (name, unit) = known.map_or((key.clone(), ""), |known| (known.name, known.unit));
        row(ui, &name, "", |ui, label| {
            text(ui, label, typed, ("", 72.0, Need::Optional));
            let unit = RichText::new(unit).font(theme::small()).color(palette.dim);
            ui.label(unit);
            if toggle(ui, "×", false, &format!("Leave out {name}")) {
                gone = Some(nth);
            }
        });
    }
    if let Some(nth) = gone {
        words.figures.remove(nth);
    }
    choose(
        ui,
        "Add a figure",
        ("add …", 120.0, Need::Optional),
        |ui| {
            for figure in known_figures() {
                let is_there = words.figures.iter().any(|(key, _)| *key == figure.key);
                let name = format!("{}  {}", figure.name, figure.what);
                if !is_there && ui.selectable_label(false, name).clicked() {
                    words.figures.push((figure.key, String::new()));
                }
            }
        },
    );
}
