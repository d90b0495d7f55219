//! How accurate the running method is and what it costs: method and error budget, errors found,
//! cost of the ticks, and every method measured on this scene.

pub(crate) mod chart;
pub(crate) mod costs;
pub(crate) mod errors;
pub(crate) mod numbers;
pub(crate) mod pareto;

use eframe::egui::{self, ComboBox, Layout, Rect, Ui, UiBuilder, vec2};

use crate::bench::command::Command;
use crate::bench::rendering::{MOST_BUDGET_DB, Rendering};
use crate::bench::tool::PaneContext;
use crate::kit::pane::scroll_area;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::{slider_row, tell};
use crate::kit::widgets::text::toggle;
use crate::tools::accuracy::sampling::Accuracy;
use selvedge_render::array::Method;

/// A pane at least this wide shows all three plots side by side, points.
const ROOM_FOR_THREE: f32 = 640.0;
/// A pane at least this high shows the histograms above the methods, points.
const ROOM_FOR_BOTH: f32 = 400.0;
/// Least height of plots; a lower pane scrolls, points.
const LEAST: f32 = 132.0;
/// Space between two plots, points.
const GAP: f32 = 3.0 * STEP;
/// Decades of the budget's slider: down to 0.0001 dB, then 0.
const DECADES: f64 = 4.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, accuracy: &mut Accuracy, context: &mut PaneContext<'_>) {
    let size = ui.available_size();
    if size.x >= ROOM_FOR_THREE {
        show_controls(ui, accuracy, context);
        let rect = ui.available_rect_before_wrap();
        let [errors, costs, methods] = thirds(rect);
        show_histograms(ui, [errors, costs], accuracy, context);
        within(ui, methods, |ui| pareto::show(ui, accuracy, context.bench));
        ui.advance_cursor_after_rect(rect);
        return;
    }
    scroll_area("accuracy").show(ui, |ui| {
        show_controls(ui, accuracy, context);
        let left_over = (size.y - ROW - 3.0 * STEP).max(LEAST);
        let size = vec2(ui.available_width(), left_over);
        let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        if size.y >= ROOM_FOR_BOTH {
            let (above, below) = rect.split_top_bottom_at_fraction(0.45);
            show_histograms(ui, halves(above), accuracy, context);
            let below = below.with_min_y(below.top() + GAP);
            within(ui, below, |ui| pareto::show(ui, accuracy, context.bench));
        } else if accuracy.shows_methods {
            within(ui, rect, |ui| pareto::show(ui, accuracy, context.bench));
        } else {
            show_histograms(ui, halves(rect), accuracy, context);
        }
    });
}

/// Errors and costs side by side.
fn show_histograms(
    ui: &mut Ui,
    [errors, costs]: [Rect; 2],
    accuracy: &Accuracy,
    context: &PaneContext<'_>,
) {
    let rendering = context.bench.settings.preferences.rendering;
    within(ui, errors, |ui| errors::show(ui, accuracy, rendering));
    within(ui, costs, |ui| costs::show(ui, &accuracy.cost()));
}

fn halves(rect: Rect) -> [Rect; 2] {
    let (left, right) = rect.split_left_right_at_x(rect.center().x);
    [
        left.with_max_x(left.right() - 0.5 * GAP),
        right.with_min_x(right.left() + 0.5 * GAP),
    ]
}

/// What stands beside the title: begin anew, and which plots there are where there is no room for
/// all.
pub(crate) fn show_corner(ui: &mut Ui, accuracy: &mut Accuracy) {
    let tip = "Begin the statistics of errors and costs anew";
    let begins_anew = toggle(ui, "reset", false, tip);
    if begins_anew {
        accuracy.reset();
    }
    let tip = "Every method on this scene";
    let switches = toggle(ui, "methods", accuracy.shows_methods, tip);
    accuracy.shows_methods ^= switches;
    if begins_anew || switches {
        ui.ctx().request_repaint();
    }
}

fn thirds(rect: Rect) -> [Rect; 3] {
    let width = (rect.width() - 2.0 * GAP) / 3.0;
    [0.0, 1.0, 2.0].map(|nth: f32| {
        let left = rect.left() + nth * (width + GAP);
        Rect::from_x_y_ranges(left..=left + width, rect.y_range())
    })
}

fn within(ui: &mut Ui, rect: Rect, content: impl FnOnce(&mut Ui)) {
    let layout = Layout::top_down(egui::Align::Min);
    ui.scope_builder(UiBuilder::new().max_rect(rect).layout(layout), |ui| {
        ui.spacing_mut().item_spacing = vec2(STEP, 0.0);
        content(ui);
    });
}

/// The method, and the error that it may make.
fn show_controls(ui: &mut Ui, accuracy: &Accuracy, context: &mut PaneContext<'_>) {
    let rendering = context.bench.settings.preferences.rendering;
    let mut wanted = rendering;
    let row = ui.horizontal(|ui| {
        show_method(ui, &mut wanted.method);
        ui.add_space(STEP);
        let resting = Rendering::default().budget_db;
        let scale = Scale {
            curve: Curve::Decades(DECADES),
            ..Scale::even([0.0, MOST_BUDGET_DB], resting, 0.01, (4, "dB"))
        };
        let slider = ui.add_enabled_ui(rendering.has_budget(), |ui| {
            let ink = Palette::in_ui(ui).text;
            let (new, response) = slider_row(ui, "Error budget", ink, scale, rendering.budget_db);
            wanted.budget_db = new.unwrap_or(wanted.budget_db);
            response
        });
        slider.inner
    });
    if wanted != rendering {
        context.commands.push(Command::Render(wanted));
    }
    if rendering.has_budget() {
        // Beside the whole pane: what the slider does to the plots stays in sight.
        let is_preparing = context.bench.engine_scene.preparing.is_busy();
        tell(&row.inner, budget_words(accuracy, is_preparing));
    } else {
        let words = "Only auto and table keep to a budget; this method has its own error";
        row.inner.on_disabled_hover_text(words);
    }
}

fn budget_words(accuracy: &Accuracy, is_preparing: bool) -> String {
    let runs = accuracy.method().map_or_else(String::new, |method| {
        let bound = numbers::level(accuracy.bound_db);
        format!(
            "\nNow {} runs, whose error is at most {bound} dB",
            method.name()
        )
    });
    let preparing = if is_preparing {
        "\nTables are being prepared"
    } else {
        ""
    };
    format!(
        "The level error that rendering may make. auto takes the cheapest method that is proved \
         to keep to it, tables the fewest nodes; 0 is exact. A double click goes back to 0.05 \
         dB{runs}{preparing}"
    )
}

fn show_method(ui: &mut Ui, chosen: &mut Method) {
    let combo = ComboBox::from_id_salt("rendering method")
        .selected_text(chosen.name())
        .width(78.0);
    let response = combo.show_ui(ui, |ui| {
        for method in Method::ALL.into_iter().rev() {
            ui.selectable_value(chosen, method, method.name());
        }
    });
    ui.ctx()
        .accesskit_node_builder(response.response.id, |node| {
            node.set_label("Rendering method");
        });
    response.response.on_hover_text(
        "How amplitudes are computed: reference (every bin, f64), banded (the bins that can be \
         heard), table (looked up), or auto: the cheapest within the error budget",
    );
}
