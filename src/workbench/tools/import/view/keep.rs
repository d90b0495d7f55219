//! The fourth step: what the textile is called, what was measured on it, and keeping it.

use eframe::egui::{Response, Ui, vec2};

use crate::bench::Bench;
use crate::bench::keep::KEEP_TIP;
use crate::kit::theme::STEP;
use crate::kit::widgets::fields::{LINE, Need, Tone, choose, note, row_of, step_title, text};
use crate::kit::widgets::text::{button, line, quiet, toggle};
use crate::tools::import::Import;
use crate::tools::import::draft::WordsDraft;
use crate::tools::import::work::Found;
use selvedge_textile::{Construction, KnownFigure, Measurement, nth_id};

/// Width that a column of fields needs, points.
const LEAST: f32 = 180.0;
/// Width of a figure with its unit, points.
const FIGURE: f32 = 210.0;
/// Width of the button, points.
const BUTTONS: f32 = 80.0;
/// Ways to make a cloth.
const MADE: [(Construction, &str); 4] = [
    (Construction::Woven, "woven"),
    (Construction::Knitted, "knitted"),
    (Construction::Nonwoven, "nonwoven"),
    (Construction::Other, "other"),
];

/// Shows the step.
pub(crate) fn show(ui: &mut Ui, importing: &mut Import, bench: &mut Bench) {
    let found = importing.found().cloned();
    let refusal = importing.refusal();
    line(ui, LINE + 2.0, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        let width = (ui.available_width() - BUTTONS).max(80.0);
        ui.allocate_ui_with_layout(vec2(width, LINE), *ui.layout(), |ui| {
            ui.set_min_width(width);
            step_title(
                ui,
                4,
                "Name and keep",
                &ids_words(importing, found.as_deref()),
            );
        });
        if button(ui, "Keep…", KEEP_TIP, refusal.as_deref()) {
            importing.keep(bench);
        }
    });
    show_outcome(ui, importing, refusal.as_deref());
    let suggested = found.as_deref().map(Found::own_name).unwrap_or_default();
    let usual = match found.as_deref().map(|found| found.kind) {
        Some(Measurement::Strokes) => Construction::Woven,
        _ => Construction::Other,
    };
    let words = &mut importing.draft.words;
    columns(ui, |ui, nth| match nth {
        0 => show_name(ui, words, &suggested, usual),
        _ => show_about(ui, words),
    });
    show_figures(ui, words);
}

/// Two columns where there is room, else one after the other.
fn columns(ui: &mut Ui, mut content: impl FnMut(&mut Ui, usize)) {
    let width = 0.5 * (ui.available_width() - 4.0 * STEP);
    if width < LEAST {
        (0..2).for_each(|nth| content(ui, nth));
        return;
    }
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0 * STEP;
        for nth in 0..2 {
            ui.vertical(|ui| {
                ui.set_width(width);
                content(ui, nth);
            });
        }
    });
}

/// The ids that the textiles will have.
fn ids_words(importing: &Import, found: Option<&Found>) -> String {
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
fn show_outcome(ui: &mut Ui, importing: &Import, refusal: Option<&str>) {
    match (importing.kept(), refusal) {
        (Some(Err(failure)), _) => note(ui, &failure.line, Tone::Wrong),
        (Some(Ok(names)), _) => note(ui, &format!("handed to the library: {names}"), Tone::Quiet),
        (None, Some(words)) => note(ui, words, Tone::Quiet),
        (None, None) => {}
    }
}

fn show_name(ui: &mut Ui, words: &mut WordsDraft, suggested: &str, usual: Construction) {
    let field = |hint| (hint, f32::INFINITY, Need::Optional);
    named_row(ui, "name", |ui, label| {
        text(ui, label, &mut words.name, field(suggested));
    });
    let id = words.id(suggested);
    named_row(ui, "id", |ui, label| {
        text(ui, label, &mut words.id, field(&id));
    });
    named_row(ui, "made", |ui, _| {
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
}

fn show_about(ui: &mut Ui, words: &mut WordsDraft) {
    let field = |hint| (hint, f32::INFINITY, Need::Optional);
    for (name, typed, hint) in [
        ("fibre", &mut words.fibre, "cotton, wool …"),
        ("licence", &mut words.licence, "of the files"),
        ("notes", &mut words.notes, "one line"),
    ] {
        named_row(ui, name, |ui, label| {
            text(ui, label, typed, field(hint));
        });
    }
}

/// A row with a short name.
fn named_row(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui, &Response)) {
    row_of(ui, 44.0, (name, ""), content);
}

/// Figures that were measured elsewhere.
fn show_figures(ui: &mut Ui, words: &mut WordsDraft) {
    let mut gone = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(STEP, STEP);
        ui.spacing_mut().interact_size.y = LINE - 2.0;
        ui.label(quiet("figures measured elsewhere"));
        choose(ui, "Add a figure", ("add …", 84.0, Need::Optional), |ui| {
            for figure in KnownFigure::all() {
                let is_there = words.figures.iter().any(|(key, _)| *key == figure.key);
                let name = format!("{}  {}", figure.name, figure.what);
                if !is_there && ui.selectable_label(false, name).clicked() {
                    words.figures.push((figure.key, String::new()));
                }
            }
        });
        for (nth, (key, typed)) in words.figures.iter_mut().enumerate() {
            let known = KnownFigure::all().find(|figure| figure.key == *key);
            let (name, unit) =
                known.map_or_else(|| (key.clone(), ""), |known| (known.name, known.unit));
            if ui.available_size_before_wrap().x < FIGURE {
                ui.end_row();
            }
            ui.add_space(2.0 * STEP);
            let label = ui.label(quiet(&name));
            text(ui, &label, typed, ("", 64.0, Need::Optional));
            ui.label(quiet(unit));
            if toggle(ui, "×", false, &format!("Leave out {name}")) {
                gone = Some(nth);
            }
        }
    });
    if let Some(nth) = gone {
        words.figures.remove(nth);
    }
}
