//! How the textile is called that is kept.

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::keep::KEEP_TIP;
use crate::kit::theme::STEP;
use crate::kit::widgets::text::quiet;
use crate::tools::lab::fields::KeepFields;
use crate::tools::lab::state::Lab;
use crate::tools::lab::view::parts::{complaint, wide_button};
use crate::tools::lab::view::rows;

/// Shows the fields and the buttons.
pub(crate) fn show(ui: &mut Ui, lab: &mut Lab, bench: &mut Bench) {
    let Ok(recipe) = lab.recipe().cloned() else {
        return;
    };
    show_fields(ui, lab, &recipe.fields, bench);
    ui.add_space(STEP);
    let from = recipe.parent.as_ref().map_or_else(
        || "Made from nothing but its recipe".to_owned(),
        |parent| {
            let hash = &parent.hash[..8.min(parent.hash.len())];
            format!("Made from {} ({hash}…)", parent.id)
        },
    );
    let tip = "The manifest names the textile that this one was made from, and the program";
    ui.label(quiet(&from)).on_hover_text(tip);
    ui.add_space(2.0 * STEP);
    let wrong = recipe.fields.refusal();
    if let Some(words) = &wrong {
        complaint(ui, words);
    }
    let refusal = refusal(lab).or(wrong);
    let refusal = refusal.as_deref();
    if wide_button(ui, "Keep…", KEEP_TIP, refusal) {
        lab.keep(bench);
    }
}

/// Name, id and notes.
pub(crate) fn show_fields(ui: &mut Ui, lab: &mut Lab, fields: &KeepFields, bench: &Bench) {
    let mut typed = fields.clone();
    if rows::named_field(ui, "Name", &mut typed.name).changed() {
        typed.follow_name();
    }
    if rows::named_field(ui, "Id", &mut typed.id).changed() {
        typed.has_own_id = true;
    }
    rows::named_field(ui, "Notes", &mut typed.notes);
    if typed != *fields {
        lab.call(typed, bench.pointer.moment);
    }
}

/// Why nothing can be kept now.
pub(crate) fn refusal(lab: &Lab) -> Option<String> {
    if lab.share().is_some() {
        return Some("Wait until it is computed, or stop that".to_owned());
    }
    lab.fault().map(|fault| fault.message.clone())
}
