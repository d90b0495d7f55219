//! How the textile is called that is kept.

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::kit::theme::{Palette, STEP};
use crate::tools::lab::fields::KeepFields;
use crate::tools::lab::state::Lab;
use crate::tools::lab::view::parts;
use crate::tools::lab::view::parts::{complaint, wide_button};
use crate::tools::lab::view::rows;

/// Shows the fields and the buttons.
pub(crate) fn show(ui: &mut Ui, lab: &mut Lab, bench: &mut Bench) {
    show_fields(ui, &mut lab.fields);
    ui.add_space(STEP);
    let palette = Palette::in_ui(ui);
    let from = lab.parent.as_ref().map_or_else(
        || "Made from nothing but its recipe".to_owned(),
        |parent| {
            format!(
                "Made from {} ({}…)",
                parent.id,
                &parent.hash[..8.min(parent.hash.len())]
            )
        },
    );
    let tip = "The manifest names the textile that this one was made from, and the program";
    ui.label(parts::small(&from, palette.dim))
        .on_hover_text(tip);
    ui.add_space(2.0 * STEP);
    let wrong = lab
        .fields
        .refusal(bench.engine_scene.loaded.library().ids());
    if let Some(words) = &wrong {
        complaint(ui, words);
    }
    let refusal = refusal(lab).or(wrong);
    let refusal = refusal.as_deref();
    let tip = "Keep it in the library of the scene: its profiles, its picture and its recipe";
    if wide_button(ui, "Keep", tip, refusal) {
        lab.keep(bench, false);
    }
    let tip = "Keep it and lay it under the display";
    if wide_button(ui, "Keep and feel", tip, refusal) {
        lab.keep(bench, true);
    }
}

/// Name, id and notes.
pub(crate) fn show_fields(ui: &mut Ui, fields: &mut KeepFields) {
    if rows::named_field(ui, "Name", &mut fields.name).changed() {
        fields.follow_name();
    }
    if rows::named_field(ui, "Id", &mut fields.id).changed() {
        fields.has_own_id = true;
    }
    rows::named_field(ui, "Notes", &mut fields.notes);
}

/// Why nothing can be kept now.
pub(crate) fn refusal(lab: &Lab) -> Option<String> {
    if lab.share().is_some() {
        return Some("Wait until it is computed, or stop that".to_owned());
    }
    lab.fault().map(|fault| fault.message.clone())
}
