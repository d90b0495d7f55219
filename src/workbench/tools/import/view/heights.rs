//! The second step for measured heights: what the file says of them, and what it does not.

use eframe::egui::Ui;

use crate::kit::theme::STEP;
use crate::kit::widgets::fields::{LINE, Need, Tone, choose, choose_of, note, row, text};
use crate::kit::widgets::text::{line, toggles};
use crate::tools::import::Import;
use crate::tools::import::draft::HeightsDraft;
use crate::tools::import::failure::Failure;
use crate::tools::import::work::{Found, Heights};
use selvedge_foundation::quantity::fixed;
use selvedge_textile::LengthUnit;
use selvedge_textile::surface::{Levelling, Representation};

/// Width of a field for a number, points.
const NUMBER: f32 = 104.0;
/// Units that are offered.
const UNITS: [(LengthUnit, &str); 5] = [
    (LengthUnit::Metre, "m"),
    (LengthUnit::Centimetre, "cm"),
    (LengthUnit::Millimetre, "mm"),
    (LengthUnit::Micrometre, "µm"),
    (LengthUnit::Nanometre, "nm"),
];

/// Shows the step.
pub(crate) fn show(
    ui: &mut Ui,
    importing: &mut Import,
    found: Option<&Found>,
    failure: Option<&Failure>,
) {
    let heights = found.and_then(Found::heights);
    match heights {
        Some(heights) => {
            ui.scope(|ui| show_about(ui, heights));
        }
        None => ui.skip_ahead_auto_ids(1),
    }
    // A reader of heights names the option that mends it.
    let asks =
        |option: &str| Need::of(failure.is_some_and(|failure| failure.line.contains(option)));
    let typed = &mut importing.draft.described.heights;
    row(ui, "unit of heights", "", |ui, _| {
        let need = asks("--height-unit");
        let name = "Unit of heights";
        choose_of(
            ui,
            name,
            &mut typed.height_unit,
            (&UNITS, "as the file states", need),
        );
    });
    row(ui, "unit of places", "", |ui, _| {
        let need = asks("--length-unit");
        let name = "Unit of places";
        choose_of(
            ui,
            name,
            &mut typed.length_unit,
            (&UNITS, "as the file states", need),
        );
    });
    show_numbers(ui, typed, heights, asks);
    show_preparation(ui, typed, asks);
    show_layer(ui, typed, heights);
    show_ways(ui, typed);
}

/// Step, range and column.
fn show_numbers(
    ui: &mut Ui,
    typed: &mut HeightsDraft,
    heights: Option<&Heights>,
    asks: impl Fn(&str) -> Need + Copy,
) {
    let step = heights.map_or_else(
        || "mm".to_owned(),
        |heights| {
            let [u, w] = heights.import.measured().step_mm.map(|mm| fixed(mm, 5));
            if u == w {
                format!("mm found {u}")
            } else {
                format!("mm found {u} × {w}")
            }
        },
    );
    row(ui, "step", &step, |ui, label| {
        text(
            ui,
            label,
            &mut typed.step_mm,
            ("as stated", NUMBER, asks("--step-mm")),
        );
    });
    row(ui, "white − black", "µm, of a picture", |ui, label| {
        text(
            ui,
            label,
            &mut typed.range_um,
            ("as stated", NUMBER, asks("--range-um")),
        );
    });
    row(ui, "column", "name or number", |ui, label| {
        text(
            ui,
            label,
            &mut typed.column,
            ("only one", NUMBER, asks("--column")),
        );
    });
}

/// What is done to the heights before the tester is drawn over them.
fn show_preparation(ui: &mut Ui, typed: &mut HeightsDraft, asks: impl Fn(&str) -> Need) {
    row(ui, "part", "mm: u w to u w", |ui, label| {
        let part = ("all of it", 1.2 * NUMBER, asks("--crop"));
        text(ui, label, &mut typed.crop, part);
    });
    row(ui, "spikes from", "spreads on are missing", |ui, label| {
        let spreads = ("none go", NUMBER, asks("--despike"));
        text(ui, label, &mut typed.despike, spreads);
    });
    row(ui, "taken off", "", |ui, _| {
        let usual = if typed.is_periodic {
            "usual: nothing of a repeat"
        } else {
            "usual: the best plane"
        };
        let ways = [
            (Levelling::None, "nothing"),
            (Levelling::Plane, "the best plane"),
            (Levelling::Quadratic, "polynomial of 2nd order"),
            (Levelling::Rows, "plane, then rows' medians"),
        ];
        choose_of(
            ui,
            "Taken off",
            &mut typed.level,
            (&ways, usual, Need::Optional),
        );
    });
}

/// What is in the file.
fn show_about(ui: &mut Ui, heights: &Heights) {
    let measured = heights.import.measured();
    let grid = &measured.heights_um;
    let (width, height) = (grid.width(), grid.height());
    let [u, w] = heights.import.map().size_mm().map(|mm| fixed(mm, 2));
    let about = &measured.about;
    let words = if measured.is_profile() {
        format!("{}: a profile of {width} points, {u} mm", about.format)
    } else {
        format!("{}: {width} × {height} points, {u} × {w} mm", about.format)
    };
    note(ui, &words, Tone::Quiet);
    let named = [&about.title, &about.instrument, &about.date, &about.comment];
    let named: Vec<&str> = named.into_iter().map(|one| one.trim()).collect();
    let named: Vec<&str> = named.into_iter().filter(|one| !one.is_empty()).collect();
    if !named.is_empty() {
        note(ui, &named.join(" · "), Tone::Quiet);
    }
    if measured.n_missing() == 0 {
        note(ui, "no point is missing", Tone::Quiet);
    }
    for words in heights.import.notes() {
        note(ui, words, Tone::Quiet);
    }
}

/// Which of several fields.
fn show_layer(ui: &mut Ui, typed: &mut HeightsDraft, heights: Option<&Heights>) {
    let none = Vec::new();
    let layers = heights.map_or(&none, |heights| &heights.import.measured().layers);
    if layers.is_empty() && typed.layer.is_none() {
        return;
    }
    let title = |nth: usize| {
        let title = layers.get(nth - 1).filter(|title| !title.is_empty());
        title.map_or_else(|| format!("field {nth}"), |title| format!("{nth} {title}"))
    };
    let text = typed.layer.map_or_else(|| "the first".to_owned(), title);
    row(ui, "field", "", |ui, _| {
        choose(
            ui,
            "Field of heights",
            (&text, 180.0, Need::Optional),
            |ui| {
                ui.selectable_value(&mut typed.layer, None, "the first");
                for nth in 1..=layers.len() {
                    ui.selectable_value(&mut typed.layer, Some(nth), title(nth));
                }
            },
        );
    });
}

/// Repeats, and how it is felt.
fn show_ways(ui: &mut Ui, typed: &mut HeightsDraft) {
    row(ui, "felt", "", |ui, _| {
        let choices = [
            (
                Representation::Economical,
                "along strokes",
                "Four strokes of the virtual tester, repeated across: what the tester measures",
            ),
            (
                Representation::Areal,
                "at every point",
                "Spectra at every point of the map, which becomes a part of the textile",
            ),
        ];
        toggles(ui, &mut typed.representation, &choices);
    });
    line(ui, LINE, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.checkbox(&mut typed.is_periodic, "one repeat of the cloth")
            .on_hover_text("Strokes go on at the other side of the map");
        ui.checkbox(&mut typed.is_resampled, "even steps")
            .on_hover_text("Uneven points are brought to even steps, along straight lines");
    });
}
