//! Why the chosen contactor does what it does: the chain of numbers, and the energy by bin.

use eframe::egui::{
    self, Align, Align2, Layout, Painter, Rect, RichText, ScrollArea, Sense, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};

use crate::bench::perceptual_level::SOURCE;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_ticks};
use crate::kit::widgets::limit_mark::{LIMIT_MARK, limit_words, paint_limit_mark};
use crate::tools::why::explanation::Explanation;
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
/// Frequencies that the energy is drawn over, Hz.
const FREQUENCIES_HZ: [f64; 2] = [10.0, 1000.0];
/// Points of a filter's curve.
const CURVE: u8 = 96;

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
    let area = ScrollArea::vertical().id_salt("why").auto_shrink(false);
    area.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let cell = why.cell.map_or_else(String::new, |(row, column)| {
            format!("   row {row}, column {column}")
        });
        let head = format!("Contactor {}{cell}   tick {}", why.contactor, why.tick);
        ui.label(RichText::new(head).font(theme::small()).color(palette.text));
        ui.horizontal(|ui| {
            ui.add_space(NAMES);
            for band in Band::ALL {
                let name = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
                let name = RichText::new(name).font(theme::small());
                ui.label(name.color(palette.band(band)));
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
    let size = vec2(ui.available_width(), LINE);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        let ink = if name.starts_with(['+', '=']) {
            palette.dim
        } else {
            palette.text
        };
        let name = RichText::new(name).font(theme::small()).color(ink);
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

/// The energy that each band takes, bin by bin, with the filters over it.
fn show_energy(ui: &Ui, rect: Rect, why: &Explanation, filters: &Filters) {
    let id = ui.scope_id().with("energy by bin");
    let response = ui.interact(rect, id, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, "Energy by bin"));
    let plot = Rect::from_min_max(rect.min + vec2(30.0, 16.0), rect.max - vec2(8.0, 18.0));
    if plot.width() < 60.0 || plot.height() < 30.0 {
        return;
    }
    let painter = ui.painter_at(rect);
    let axis = Axis::log(FREQUENCIES_HZ[0], FREQUENCIES_HZ[1]);
    let ticks = [10.0, 40.0, 100.0, 320.0, 1000.0].map(Tick::number);
    paint_ticks(&painter, plot, (&axis, Side::Bottom), &ticks);
    let energies = why.energies();
    let largest = energies
        .iter()
        .flat_map(|(_, taken)| *taken)
        .fold(0.0, f64::max);
    let height = Axis::linear(0.0, if largest > 0.0 { largest } else { 1.0 });
    for (frequency_hz, taken) in &energies {
        let x = axis.x(plot.x_range(), *frequency_hz);
        paint_bars(
            &painter,
            plot,
            x,
            taken.map(|um2| height.y(plot.y_range(), um2)),
        );
    }
    paint_filters(&painter, plot, &axis, filters);
    let palette = Palette::in_ui(ui);
    let most = quantity::with_unit(largest, 3, "µm²");
    let corner = plot.left_top() - vec2(0.0, 8.0);
    let words = format!("energy by bin, up to {most}");
    painter.text(
        corner,
        Align2::LEFT_CENTER,
        words,
        theme::small(),
        palette.dim,
    );
    response.on_hover_text(
        "What each band takes of every bin that sounds below 1 kHz: its power times the filter's \
         power gain. The curves are the filters, from 0 to 1",
    );
}

fn paint_bars(painter: &Painter, plot: Rect, x: f32, tops: [f32; 2]) {
    let palette = Palette::of(painter.ctx().theme());
    for band in Band::ALL {
        let left = x - 2.0 + 2.0 * band.index() as f32;
        let bar = Rect::from_min_max(
            pos2(left, tops[band.index()].min(plot.bottom())),
            pos2(left + 2.0, plot.bottom()),
        );
        if bar.left() >= plot.left() && bar.right() <= plot.right() {
            painter.rect_filled(bar, 0, palette.band(band));
        }
    }
}

fn paint_filters(painter: &Painter, plot: Rect, axis: &Axis, filters: &Filters) {
    let palette = Palette::of(painter.ctx().theme());
    for band in Band::ALL {
        let point = |i: u8| {
            let frequency_hz = axis.value(f64::from(i) / f64::from(CURVE - 1));
            #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
            let gain = filters.gain(band, frequency_hz).clamp(0.0, 1.0) as f32;
            let y = plot.bottom() - gain * plot.height();
            pos2(axis.x(plot.x_range(), frequency_hz), y)
        };
        let ink = palette.band(band).gamma_multiply(0.6);
        let points: Vec<egui::Pos2> = (0..CURVE).map(point).collect();
        painter.add(egui::Shape::line(points, Stroke::new(1.0, ink)));
    }
}
