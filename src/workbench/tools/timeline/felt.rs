//! The timeline without a take: the last seconds of what was felt.

use eframe::egui::{self, Align2, Pos2, Rect, Response, Sense, Shape, Ui, WidgetInfo, pos2};

use crate::bench::recording::strips::Felt;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::tools::timeline::live::{N_TICKS, Placed};
use crate::tools::timeline::picture::speed_shapes;
use crate::tools::timeline::plot::Plot;
use crate::tools::timeline::strips_view::{describe, described, paint_title};
use crate::tools::timeline::transport::{TICK_MS, TransportView};
use crate::tools::timeline::{live, plot};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Shows it in `rect`.
pub(crate) fn show(ui: &Ui, rect: Rect, view: &TransportView<'_>) {
    let palette = Palette::in_ui(ui);
    let placed = live::placed(view.live);
    let plot = Plot::new(rect, live::speeds(&placed).most);
    let id = ui.scope_id().with("timeline");
    let response = ui.interact(rect, id, Sense::hover());
    response.widget_info(|| {
        WidgetInfo::labeled(egui::Role::Canvas, true, "Timeline of what was felt last")
    });
    if !plot.has_room() {
        return;
    }
    let title = view.recorded_ticks.map_or_else(
        || "Felt last".to_owned(),
        |n_ticks| format!("Recording   {}", quantity::clock(n_ticks * TICK_MS)),
    );
    paint_title(ui, &plot, &title, true);
    plot.paint_axes(ui.painter(), true);
    let marks = [
        (0.0, "12 s before"),
        (1.0, "newest"),
        (0.5, "6 s"),
        (0.25, "9 s"),
        (0.75, "3 s"),
    ];
    plot.paint_times(
        ui.painter(),
        &marks.map(|(share, words)| (share, words.to_owned())),
    );
    if placed.is_empty() {
        let words = "Move over a textile, or let the display explore by itself";
        let middle = plot.area.center();
        let anchor = Align2::CENTER_CENTER;
        ui.painter()
            .text(middle, anchor, words, theme::small(), palette.dim);
    }
    let clipped = ui.painter().with_clip_rect(plot.area.expand(1.0));
    clipped.extend(live_shapes(&plot, &placed, palette));
    describe_live(ui, &response, &plot, &placed);
}

fn live_x(plot: &Plot, placed: &Placed) -> f32 {
    plot.x_at(1.0 - placed.ago as f64 / N_TICKS as f64)
}

/// The strokes of the last seconds, new to old.
fn live_shapes(plot: &Plot, placed: &[Placed], palette: &Palette) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for stroke in placed.split_inclusive(|one| !one.goes_on) {
        let felt: Vec<(f32, Felt)> = stroke
            .iter()
            .map(|one| (live_x(plot, one), one.felt()))
            .collect();
        let top = |(x, felt): &(f32, Felt)| pos2(*x, plot.y_of_speed(felt.speed_mm_per_s));
        let speeds: Vec<Pos2> = felt.iter().map(top).collect();
        shapes.extend(speed_shapes(plot, &speeds, palette));
        for band in Band::ALL {
            let point = |(x, felt): &(f32, Felt)| {
                let um = felt.mean_um?[band.index()];
                (um > 0.0).then(|| pos2(*x, plot.y_of_level(quantity::level_db(um))))
            };
            let points: Vec<_> = felt.iter().map(point).collect();
            shapes.extend(plot::lines(&points, palette.band(band)));
        }
    }
    shapes
}

fn describe_live(ui: &Ui, response: &Response, plot: &Plot, placed: &[Placed]) {
    let Some(pointer) = response.hover_pos() else {
        return;
    };
    let ago = (1.0 - plot.share_at(pointer.x)) * N_TICKS as f64;
    let Some(one) = live::nearest(placed, ago) else {
        return;
    };
    let newest = placed.first().map_or(0, |newest| newest.tick_sample.tick);
    let before_ms = newest.saturating_sub(one.tick_sample.tick) * TICK_MS;
    let seconds = quantity::with_unit(before_ms as f64 / 1000.0, 3, "s");
    let head = format!(
        "{seconds} before the newest   tick {}",
        one.tick_sample.tick
    );
    describe(
        ui,
        response,
        plot,
        live_x(plot, one),
        &described(&head, one.felt(), "of the contactors on a textile"),
    );
}
