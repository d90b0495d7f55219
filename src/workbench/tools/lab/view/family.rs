//! Several recipes that differ in one parameter: planned, tried, kept.

use eframe::egui::{ComboBox, RichText, Ui};

use crate::bench::Bench;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::named;
use crate::kit::widgets::text::{quiet, row};
use crate::tools::lab::family::FamilyFields;
use crate::tools::lab::fields::KeepFields;
use crate::tools::lab::state::Lab;
use crate::tools::lab::steps::Steps;
use crate::tools::lab::view::keep::{refusal, show_fields};
use crate::tools::lab::view::parts::{complaint, wide_button};
use crate::tools::lab::view::rows;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;
use selvedge_textile::{Parameter, ParameterKind, groups};

/// Shows the page.
pub(crate) fn show(ui: &mut Ui, lab: &mut Lab, bench: &mut Bench) {
    let Some(steps) = &lab.steps else {
        return;
    };
    let plan = &mut lab.plan;
    let words = "Several textiles that differ in one parameter, evenly apart";
    ui.label(quiet(words));
    ui.add_space(STEP);
    let unit = show_parameters(ui, steps, plan);
    rows::short_field(ui, ("First value", unit), &mut plan.ends[0]);
    rows::short_field(ui, ("Last value", unit), &mut plan.ends[1]);
    rows::short_field(ui, ("Textiles", ""), &mut plan.n);
    ui.add_space(STEP);
    let asked = plan.plan();
    let busy = refusal(lab);
    let no = busy.as_deref().or_else(|| asked.err());
    if wide_button(
        ui,
        "Try",
        "Make each and draw its curves over the others",
        no,
    ) && let Ok(plan) = asked
    {
        lab.try_family(bench, plan);
    }
    if let Some(words) = no {
        complaint(ui, words);
    }
    let Ok(keep) = lab.recipe().map(|recipe| recipe.fields.clone()) else {
        return;
    };
    let Some(family) = &lab.family else {
        return;
    };
    ui.add_space(STEP);
    show_members(ui, family);
    ui.add_space(STEP);
    let n = family.members.len();
    show_fields(ui, lab, &keep, bench);
    ui.add_space(STEP);
    let last = format!("{}-1 … {}-{n}", keep.id.trim(), keep.id.trim());
    ui.label(quiet(&last));
    let numbered = KeepFields {
        id: format!("{}-1", keep.id.trim()),
        ..keep
    };
    let wrong = numbered.refusal();
    if let Some(words) = &wrong {
        complaint(ui, words);
    }
    let no = busy.or(wrong);
    let tip = "Feel the first, then keep every textile of the family in the same library";
    if wide_button(ui, &format!("Keep all {n}…"), tip, no.as_deref()) {
        lab.keep_family(bench);
    }
}

/// The parameter that varies; says its unit.
fn show_parameters(ui: &mut Ui, steps: &Steps, plan: &mut FamilyFields) -> &'static str {
    let draft = &steps.recipe.draft;
    let groups = groups(draft.kind());
    let numbers: Vec<(String, Parameter)> = groups
        .iter()
        .flat_map(|group| {
            let name = |one: &Parameter| format!("{}: {}", group.title, one.name);
            let all = group.parameters.iter();
            all.map(move |one| (name(one), *one))
        })
        .filter(|(_, parameter)| is_number(parameter) && draft.value(parameter.place).is_some())
        .collect();
    let place = plan.place;
    let chosen = numbers.iter().find(|(_, one)| Some(one.place) == place);
    let text = chosen.map_or("choose", |(name, _)| name.as_str());
    row(ui, "Varies", |ui| {
        let combo = ComboBox::from_id_salt("lab family").width(200.0).truncate();
        let list = combo
            .selected_text(RichText::new(text).font(theme::small()))
            .show_ui(ui, |ui| {
                for (name, parameter) in &numbers {
                    let is_chosen = plan.place == Some(parameter.place);
                    if ui.selectable_label(is_chosen, name).clicked() {
                        plan.vary(parameter, draft.number(parameter.place));
                    }
                }
            });
        named(&list.response, "Parameter that varies");
    });
    match chosen.map(|(_, parameter)| parameter.kind) {
        Some(ParameterKind::Number { unit, .. } | ParameterKind::Optional { unit, .. }) => unit,
        _ => "",
    }
}

fn is_number(parameter: &Parameter) -> bool {
    matches!(
        parameter.kind,
        ParameterKind::Number { .. } | ParameterKind::Optional { .. } | ParameterKind::Seed
    )
}

/// The members with their mean levels.
fn show_members(ui: &mut Ui, family: &crate::tools::lab::family::Family) {
    let palette = Palette::in_ui(ui);
    for (nth, member) in (1..).zip(&family.members) {
        let db = Band::ALL.map(|band| {
            let level = quantity::level_db(member.felt.levels.mean_um[band.index()]);
            (band, format!("{:>6}", quantity::fixed(level, 1)))
        });
        let name = format!("{nth}  {}", member.label);
        row(ui, &name, |ui| {
            ui.label(quiet("dB"));
            for (band, words) in db.iter().rev() {
                let text = RichText::new(words).font(theme::number());
                ui.label(text.color(palette.band(*band)));
            }
        })
        .on_hover_text("Mean A40 and A320 at 100 mm/s, re 1 µm");
    }
}
