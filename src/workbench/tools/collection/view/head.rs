//! What stands over the views: which one, what is searched, which axes, which speed.

use eframe::egui::{self, TextEdit, Ui};

use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::list;
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::slider_row;
use crate::kit::widgets::text::{line, named, quiet, toggle, toggles};
use crate::tools::collection::listing::{Only, Sort, SortBy};
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::{Choice, CollectionView, Mode, SPEEDS_MM_PER_S};
use crate::tools::collection::view::hand::Hand;
use selvedge_textile::tactile::{Band, LEVEL_SPEED_MM_PER_S};

/// Widths of the field and of the lists, points.
const SEARCH: f32 = 150.0;
const KINDS: f32 = 148.0;
const AXIS: f32 = 124.0;
/// Orders that are offered.
const ORDERS: [(SortBy, &str); 7] = [
    (SortBy::Library, "the library’s order"),
    (SortBy::Name, "name"),
    (SortBy::Kind, "kind"),
    (SortBy::Amplitude(Band::Low), "A40"),
    (SortBy::Amplitude(Band::High), "A320"),
    (SortBy::Level, "level"),
    (SortBy::Roughness, "SMD"),
];

/// Shows both rows.
pub(crate) fn show(ui: &mut Ui, view: &CollectionView<'_>, hand: &mut Hand<'_>) {
    let choice = &mut hand.choice;
    head_line(ui, |ui| {
        show_modes(ui, choice);
        show_search(ui, &mut hand.search);
        show_kinds(ui, choice, view);
        if choice.mode == Mode::Cloths {
            show_orders(ui, choice);
        }
    });
    if choice.mode == Mode::Plot {
        head_line(ui, |ui| show_axes(ui, choice, view));
    }
}

fn head_line(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    line(ui, ROW + STEP, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        ui.spacing_mut().interact_size.y = 20.0;
        content(ui);
    });
}

fn show_modes(ui: &mut Ui, choice: &mut Choice) {
    let modes = [
        (Mode::Plot, "plot", "The library as points of a plot"),
        (Mode::Cloths, "cloths", "The library as pieces of cloth"),
    ];
    toggles(ui, &mut choice.mode, &modes);
    ui.add_space(STEP);
}

fn show_search(ui: &mut Ui, search: &mut String) {
    let field = TextEdit::singleline(search)
        .desired_width(SEARCH.min(0.3 * ui.available_width()))
        .font(theme::small())
        .margin(egui::Margin::symmetric(6, 3))
        .hint_text("Search");
    let response = ui.add(field);
    named(&response, "Search the collection");
}

fn show_kinds(ui: &mut Ui, choice: &mut Choice, view: &CollectionView<'_>) {
    let width = KINDS.min(ui.available_width());
    let named = ("kinds", "Kinds that are shown");
    list(ui, named, width, choice.only.name(), |ui| {
        for only in Only::all(view.items) {
            ui.selectable_value(&mut choice.only, only, only.name());
        }
    });
}

fn show_orders(ui: &mut Ui, choice: &mut Choice) {
    let name = |by| {
        let mut orders = ORDERS.into_iter();
        orders
            .find(|(order, _)| *order == by)
            .map_or("", |one| one.1)
    };
    let width = KINDS.min(ui.available_width());
    let text = format!("by {}", name(choice.sort.by));
    list(ui, ("orders", "Order of the cloths"), width, &text, |ui| {
        for (by, name) in ORDERS {
            let is_chosen = choice.sort.by == by;
            if ui.selectable_label(is_chosen, name).clicked() {
                choice.sort = Sort {
                    by,
                    is_falling: false,
                };
            }
        }
    });
}

fn show_axes(ui: &mut Ui, choice: &mut Choice, view: &CollectionView<'_>) {
    let measures = view.measures();
    let palette = Palette::in_ui(ui);
    for (index, name) in [(1, "y"), (0, "x")] {
        ui.label(quiet(name));
        let axis = &mut choice.axes[index];
        let text = axis.label(view.items);
        let label = ["Horizontal axis", "Vertical axis"][index];
        list(ui, (("axis", index), label), AXIS, &text, |ui| {
            for measure in &measures {
                let text = measure.label(view.items);
                ui.selectable_value(axis, Measure::clone(measure), text);
            }
        });
    }
    let tip = "As the present gains and the compression make them; off: as the textiles are, \
               through the filters alone";
    if toggle(ui, "as tuned", choice.is_tuned, tip) {
        choice.is_tuned = !choice.is_tuned;
    }
    ui.add_space(STEP);
    let ink = palette.text;
    let (speed, response) = slider_row(ui, "Speed", ink, speed_scale(), choice.speed_mm_per_s);
    if let Some(speed_mm_per_s) = speed {
        choice.speed_mm_per_s = speed_mm_per_s;
    }
    response.on_hover_text(
        "Along one axis at a time; figures are means over all points and the four directions",
    );
}

fn speed_scale() -> Scale {
    let [least, most] = SPEEDS_MM_PER_S;
    Scale {
        curve: Curve::Decades((most / least).log10()),
        ..Scale::even(SPEEDS_MM_PER_S, LEVEL_SPEED_MM_PER_S, 1.0, (0, "mm/s"))
    }
}
