//! The steps from the autocorrelation to the tile: what repeats, and how sure that is.

use eframe::egui::{Sense, Stroke, StrokeKind, Ui, vec2};

use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::fields::{Tone, note, step_title};
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::text::{button, toggle};
use crate::tools::picture::draft::Draft;
use crate::tools::picture::found::Cloth;
use crate::tools::picture::textures::{N_CARDS, Textures};
use crate::tools::picture::view::controls::slider;
use selvedge_foundation::quantity::{self, with_unit};
use selvedge_textile::picture::Lattice;

/// The side of a piece of cloth that is offered, points.
const FOLDED: f32 = 60.0;

/// Lattice and tile.
pub(super) fn show(
    ui: &mut Ui,
    (draft, textures): (&mut Draft, &mut Textures),
    cloth: Option<&Cloth>,
) {
    ui.add_space(STEP);
    match cloth.map(|cloth| (cloth, &cloth.found)) {
        Some((cloth, Ok(tiled))) => {
            show_lattice(ui, draft, &tiled.lattice);
            offered(ui, draft, cloth, textures);
            let share = tiled
                .flat_part
                .map_or(tiled.explained_variance, |(_, share)| share);
            let share = with_unit(100.0 * share, 0, "%");
            step_title(ui, 3, "Tile", &format!("explains {share} of the variance"));
            if let Some(unwarped) = &tiled.unwarped {
                let words = format!("Laid straight: {}.", unwarped.words());
                note(ui, &words, Tone::Quiet);
            }
            if tiled.flat_part.is_some() {
                note(
                    ui,
                    "Repeats drift: the tile is of the part that lies flattest.",
                    Tone::Quiet,
                );
            }
            if tiled.colour.is_printed() {
                let words = "Colour changes with the period: the pattern may be printed, and \
                             brightness then says nothing about relief.";
                note(ui, words, Tone::Wrong);
            }
        }
        Some((cloth, Err(reason))) => {
            step_title(ui, 2, "Lattice", "none");
            note(ui, &format!("No lattice: {reason}."), Tone::Wrong);
            let words = "Felt as scanned or synthesized all the same.";
            note(ui, words, Tone::Quiet);
            offered(ui, draft, cloth, textures);
        }
        None => step_title(ui, 2, "Lattice", ""),
    }
}

/// What a lattice explains where it was not looked at.
fn held_out_words(name: &str, lattice: &Lattice) -> String {
    let share = lattice
        .held_out
        .map(|share| with_unit(100.0 * share, 0, "%"));
    format!("{name} {}", share.unwrap_or_else(|| "–".to_owned()))
}

/// The vectors, and what weavers call them.
fn show_lattice(ui: &mut Ui, draft: &Draft, lattice: &Lattice) {
    let judged = if draft.lattice.is_some() {
        held_out_words("chosen, explains", lattice)
    } else {
        format!(
            "confidence {}, by chance {}",
            with_unit(100.0 * lattice.confidence, 0, "%"),
            with_unit(100.0 * lattice.false_alarm_rate, 1, "%")
        )
    };
    step_title(ui, 2, "Lattice", &judged);
    for (name, vector) in [("p1", lattice.p1_px), ("p2", lattice.p2_px)] {
        note(
            ui,
            &vector_words(name, vector, draft.px_per_mm(Some(lattice))),
            Tone::Quiet,
        );
    }
    let words = match (lattice.weave_name(), lattice.thread_grid) {
        (Some(name), _) => name,
        (None, Some(_)) => "threads cross in a repeat without a name".to_owned(),
        (None, None) => "no finer grid of threads is seen".to_owned(),
    };
    note(ui, &words, Tone::Quiet);
}

/// Lattices to choose from, the one that is found first: it takes back what was drawn. Each shows
/// the cloth that the picture becomes by it.
fn offered(ui: &mut Ui, draft: &mut Draft, cloth: &Cloth, textures: &mut Textures) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(STEP, STEP);
        for (nth, (lattice, folded)) in cloth.offered.iter().enumerate() {
            let is_found = nth == 0 && cloth.found_by_itself.is_some();
            let vectors = [lattice.p1_px, lattice.p2_px];
            let chosen = (!is_found).then_some(vectors);
            let name = if is_found {
                "found".to_owned()
            } else {
                let [a, b] = vectors.map(|[x, y]| {
                    let [x, y] = [x, y].map(|px| quantity::fixed(px, 1));
                    format!("({x}, {y})")
                });
                format!("{a} {b} px")
            };
            let words = held_out_words(&name, lattice);
            let tip = format!("Lattice {words}: what its cells explain of those beside them");
            let share = held_out_words("", lattice);
            let side = vec2(FOLDED, FOLDED);
            ui.allocate_ui(side + vec2(0.0, ROW), |ui| {
                ui.vertical(|ui| {
                    let (rect, response) = ui.allocate_exact_size(side, Sense::CLICK);
                    textures.paint(ui.painter(), rect, N_CARDS + nth, folded);
                    let is_chosen = draft.lattice == chosen;
                    if is_chosen {
                        let ring = Stroke::new(2.0, Palette::in_ui(ui).selection);
                        ui.painter().rect_stroke(rect, 0, ring, StrokeKind::Inside);
                    }
                    if toggle(ui, share.trim(), is_chosen, &tip) || response.clicked() {
                        draft.lattice = chosen;
                    }
                });
            });
        }
    });
}

/// What the directions are measured by.
pub(super) fn show_directions(ui: &mut Ui, draft: &mut Draft, cloth: Option<&Cloth>) {
    let n = cloth.map_or(0, |cloth| cloth.maxima.len());
    note(
        ui,
        &format!("{n} maxima of the autocorrelation count"),
        Tone::Quiet,
    );
    let Some(directions) = cloth.and_then(|cloth| cloth.directions.as_ref()) else {
        return;
    };
    let resting = directions.lambda_per_px;
    let scale = Scale {
        curve: Curve::Decades(2.4),
        ..Scale::even([0.02, 5.0], resting, 0.01, (2, "1/px"))
    };
    let now = draft.lambda.unwrap_or(directions.lambda_per_px);
    if let Some(lambda) = slider(ui, "λ", scale, now) {
        draft.lambda = Some(lambda.max(0.02));
    }
    if draft.lambda.is_some() && button(ui, "λ by the maxima", "", None) {
        draft.lambda = None;
    }
}

fn vector_words(name: &str, [x, y]: [f64; 2], px_per_mm: Option<f64>) -> String {
    let length = x.hypot(y);
    let [dx, dy, px] = [x, y, length].map(|value| quantity::fixed(value, 2));
    let mm = px_per_mm.map(|scale| format!(" = {}", with_unit(length / scale, 3, "mm")));
    format!(
        "{name} ({dx}, {dy}) px, length {px} px{}",
        mm.unwrap_or_default()
    )
}
