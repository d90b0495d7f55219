//! The last step, always in sight: what it is called, and to the fingertip.

use eframe::egui::Ui;

use crate::bench::command::Commands;
use crate::bench::keep::KEEP_TIP;
use crate::bench::latest::Standing;
use crate::kit::theme::STEP;
use crate::kit::widgets::fields::{Need, Tone, note, row_of, step_title, text};
use crate::kit::widgets::text::{button, toggles};
use crate::tools::picture::draft::{Draft, Known};
use crate::tools::picture::found::Step;
use crate::tools::picture::state::Picture;
use selvedge_foundation::quantity::with_unit;
use selvedge_textile::surface::Representation;

/// Shows the step.
pub(crate) fn show(ui: &mut Ui, picture: &mut Picture, commands: &mut Commands) {
    ui.spacing_mut().item_spacing.y = STEP;
    let made = picture.found().and_then(|found| found.made.clone());
    let known = made.as_ref().map(|made| made.known.clone());
    let figures = made.map_or_else(String::new, |made| {
        let relief = with_unit(made.relief_um, 0, "µm");
        format!("relief {relief}, SMD {}", with_unit(made.smd_um, 2, "µm"))
    });
    step_title(ui, 5, "To the fingertip", &figures);
    show_height(ui, &mut picture.draft);
    let own = picture.draft.own_name();
    row_of(ui, 44.0, ("name", ""), |ui, label| {
        let width = ui.available_width() - 96.0;
        text(
            ui,
            label,
            &mut picture.draft.name,
            (&own, width, Need::Optional),
        );
        let choices = [
            (
                Representation::Economical,
                "strokes",
                "Felt along four strokes, as the tester does",
            ),
            (
                Representation::Areal,
                "area",
                "Felt at every point of the relief",
            ),
        ];
        toggles(ui, &mut picture.draft.representation, &choices);
    });
    let refusal = picture.refusal();
    ui.horizontal(|ui| {
        if button(ui, "Keep…", KEEP_TIP, refusal.as_deref()) {
            picture.keep(commands);
        }
    });
    let is_working = matches!(picture.standing(), Standing::Working(_));
    let known = known.filter(|_| !is_working);
    for line in known.into_iter().flatten().flatten() {
        note(ui, &line, Tone::Quiet);
    }
    show_outcome(ui, picture, refusal);
}

/// What was kept, or why nothing can be.
fn show_outcome(ui: &mut Ui, picture: &mut Picture, refusal: Option<String>) {
    let failure = picture.found().and_then(|found| found.failure.clone());
    if let Some((Step::Felt, line)) = failure {
        return note(ui, &line, Tone::Wrong);
    }
    if let Standing::Working(share) = picture.standing() {
        ui.horizontal(|ui| {
            if button(ui, "Stop", "Stop working it out", None) {
                picture.cancel();
            }
            let words = format!("being worked out: {:.0} %", 100.0 * share);
            note(ui, &words, Tone::Quiet);
        });
        return;
    }
    match (refusal, picture.kept()) {
        (Some(line), _) => note(ui, &line, Tone::Quiet),
        (None, Some(id)) => note(ui, &format!("handed to the library: {id}"), Tone::Quiet),
        (None, None) => {}
    }
}

fn show_height(ui: &mut Ui, draft: &mut Draft) {
    row_of(ui, 44.0, ("height", "µm"), |ui, label| {
        let need = Need::of(draft.height_scale().is_none());
        text(ui, label, &mut draft.height, ("80", 72.0, need));
        let choices = [
            (
                Known::Relief,
                "relief",
                "From the lowest to the highest point",
            ),
            (
                Known::Smd,
                "SMD",
                "The roughness that the surface tester reads",
            ),
        ];
        toggles(ui, &mut draft.known, &choices);
    });
}
