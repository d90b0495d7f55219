//! Why the chosen contactor does what it does: the chain of numbers, and the energy by bin.

use eframe::egui::{self, Align, Layout, Margin, Rect, RichText, Sense, Ui, WidgetInfo, vec2};

use crate::bench::perceptual_level::SOURCE;
use crate::kit::pane::scroll_area;
use crate::kit::plot;
use crate::kit::plot::Setting;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::limit_mark::{LIMIT_MARK, limit_words, paint_limit_mark};
use crate::kit::widgets::text::{line, small};
use crate::tools::why::explanation::Explanation;
use crate::tools::why::export::charts;
use crate::tools::why::text::{LIMITS, lines};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{Band, Filters};

/// Height of a line of the chain, points.
const LINE: f32 = 15.0;
/// Width of the names in the chain, points.
const NAMES: f32 = 88.0;
/// Width of the chain where the energy stands beside it, points.
const CHAIN: f32 = 300.0;
/// A pane narrower than this has no room for the energy, points.
const ROOM_FOR_ENERGY: f32 = 520.0;
/// How much of the height the energy takes; the filters have the rest.
const ENERGY: f32 = 0.62;

/// Shows the pane; without a contactor, what to do.
pub(crate) fn show(ui: &mut Ui, why: Option<&Explanation>, filters: &Filters) {
    let palette = Palette::in_ui(ui);
    let Some(why) = why else {
        let words = "Choose a contactor: click a cell of the heatmaps";
        ui.label(RichText::new(words).color(palette.dim));
        return;
    };
    let whole = ui.max_rect();
    if whole.width() < ROOM_FOR_ENERGY {
        show_chain(ui, why);
        return;
    }
    let (chain, energy) = whole.split_left_right_at_x(whole.left() + CHAIN);
    ui.scope_builder(egui::UiBuilder::new().max_rect(chain), |ui| {
        show_chain(ui, why);
    });
    show_energy(
        ui,
        energy.with_min_x(energy.left() + 4.0 * STEP),
        why,
        filters,
    );
}

fn show_chain(ui: &mut Ui, why: &Explanation) {
    let palette = Palette::in_ui(ui);
    let lines = lines(why);
    scroll_area("why").show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let cell = why.cell.map_or_else(String::new, |(row, column)| {
            format!("   row {row}, column {column}")
        });
        let head = format!("Contactor {}{cell}   tick {}", why.contactor, why.tick);
        ui.label(small(head, palette.text));
        ui.horizontal(|ui| {
            ui.add_space(NAMES);
            for band in Band::ALL {
                let name = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
                ui.label(small(name, palette.band(band)));
            }
        });
        for (name, value) in lines {
            let limiter = why.output.limiter;
            let limiters = (name == LIMITS).then(|| limit_words(limiter)).flatten();
            show_line(ui, &name, &value, limiters);
        }
    });
}

fn show_line(ui: &mut Ui, name: &str, value: &str, limiters: Option<String>) {
    let palette = Palette::in_ui(ui);
    line(ui, LINE, |ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        let ink = if name.starts_with(['+', '=']) {
            palette.dim
        } else {
            palette.text
        };
        let name = small(name, ink);
        let place = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(vec2(NAMES, LINE), place, |ui| {
            ui.set_min_width(NAMES);
            ui.label(name);
        });
        if let Some(words) = limiters {
            let size = vec2(LIMIT_MARK + 6.0, LINE);
            let (rect, mark) = ui.allocate_exact_size(size, Sense::hover());
            paint_limit_mark(ui.painter(), rect.center() - vec2(3.0, 0.0));
            mark.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, &words));
            mark.on_hover_text(words);
        }
        let value = RichText::new(value).font(theme::small_number());
        let is_model = value.text().ends_with("(model)");
        let label = egui::Label::new(value.color(palette.text)).truncate();
        let response = ui.add(label.selectable(true));
        if is_model {
            response.on_hover_text(SOURCE);
        }
    });
}

/// The energy that each band takes, bin by bin, and the filters below it.
fn show_energy(ui: &Ui, rect: Rect, why: &Explanation, filters: &Filters) {
    let [energy, gains] = charts(why, filters);
    let (above, below) = rect.split_top_bottom_at_fraction(ENERGY);
    let setting = Setting {
        name: "Energy by bin",
        margin: Margin {
            bottom: 4,
            ..Setting::default().margin
        },
        link: Some("frequency of bins"),
        note: "What each band takes of every bin that sounds below 1 kHz: its power times the \
               filter's power gain",
        ..Setting::default()
    };
    plot::show(ui, above, &energy, &setting);
    let setting = Setting {
        name: "Gains of the filters",
        margin: Margin {
            top: 4,
            ..Setting::default().margin
        },
        link: setting.link,
        has_legend: false,
        ..Setting::default()
    };
    plot::show(ui, below, &gains, &setting);
}
