//! Figures of a surface, beside them those of what it is compared with.

use eframe::egui::{Align, Layout, RichText, Ui, vec2};

use crate::kit::pane::scroll_area;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::{line, named, quiet};
use crate::tools::lab::preview::{Preview, Shown};
use crate::tools::lab::state::Lab;
use selvedge_foundation::quantity;

/// Height of a row, points.
const ROW: f32 = 15.0;
/// Width of the column of units, points.
const UNIT: f32 = 26.0;
/// Width of a column of numbers, points.
const NUMBER: f32 = 62.0;

/// Shows the figures.
pub(crate) fn show(ui: &mut Ui, lab: &Lab, preview: &Preview) {
    let compared = lab.compared.as_ref();
    let others = compared.map(|compared| compared.felt.figures());
    let head = compared.map_or_else(
        || "figures".to_owned(),
        |compared| format!("figures · grey: {}", compared.name),
    );
    ui.add(eframe::egui::Label::new(quiet(&head)).truncate());
    ui.spacing_mut().item_spacing.y = 0.0;
    scroll_area("lab figures").show(ui, |ui| {
        ui.set_max_width(ui.available_width().min(380.0));
        for shown in preview.figures() {
            let others = others.unwrap_or_default();
            let other = others.iter().find(|other| other.name == shown.name);
            let other = compared.map(|_| other.map(|other| other.value));
            // Of a Brownian surface: the exponent that was asked for.
            let asked = preview.hurst.filter(|_| shown.name == "Hurst exponent");
            let note = asked.map(|[asked, _, error]| {
                let [asked, error] = [asked, error].map(|value| quantity::fixed(value, 2));
                format!("asked {asked} · ± {error}")
            });
            row(ui, shown, (other, note));
        }
        ui.add_space(STEP);
    });
}

/// `other` is the column of what is compared, if there is one, and its number.
#[expect(
    clippy::option_option,
    reason = "no column, an empty cell, or a number"
)]
fn row(ui: &mut Ui, shown: &Shown, (other, note): (Option<Option<f64>>, Option<String>)) {
    let palette = Palette::in_ui(ui);
    let response = line(ui, ROW, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.label(quiet(shown.name));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            cell(ui, UNIT, Align::Min, quiet(shown.unit));
            let number = |value: f64| {
                let digits = quantity::fixed(value, shown.decimals);
                RichText::new(digits).font(theme::number())
            };
            if let Some(other) = other {
                let text = other.map_or_else(|| RichText::new(""), number);
                cell(ui, NUMBER, Align::Max, text.color(palette.line));
            }
            let value = number(shown.value).color(palette.text);
            cell(ui, NUMBER, Align::Max, value);
            if let Some(note) = note {
                ui.label(quiet(&note));
            }
        });
    });
    let name = format!(
        "{} {}",
        shown.name,
        quantity::with_unit(shown.value, shown.decimals, shown.unit)
    );
    let response = response.response;
    named(&response, name);
    response.on_hover_text(shown.what);
}

fn cell(ui: &mut Ui, width: f32, align: Align, text: RichText) {
    let layout = match align {
        Align::Max => Layout::right_to_left(Align::Center),
        _ => Layout::left_to_right(Align::Center),
    };
    ui.allocate_ui_with_layout(vec2(width, ROW), layout, |ui| {
        ui.set_min_width(width);
        ui.label(text);
    });
}
