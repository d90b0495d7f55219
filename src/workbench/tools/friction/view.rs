//! The pane: what is chosen on the left; friction along the strip, and what is felt of it, on the
//! right; where there is little room, one below the other.

use eframe::egui::{Color32, ColorImage, Margin, Rect, Sense, TextureOptions, Ui, pos2, vec2};

use crate::bench::tool::PaneContext;
use crate::kit::pane::{inside, paint_sentence, scroll_area};
use crate::kit::plot::{self, Setting};
use crate::kit::texture::{Same, WHOLE, paint};
use crate::kit::theme::STEP;
use crate::kit::widgets::text::{paint_line, quiet};
use crate::tools::friction::chart;
use crate::tools::friction::source::Trace;
use crate::tools::friction::{EMPTY, Friction, controls};
use selvedge_chart::{Chart, Raster};
use std::sync::Arc;

/// A pane at least this wide has its controls beside its charts, points.
const WIDE: f32 = 760.0;
/// Width of the controls there, points.
const CONTROLS: f32 = 290.0;
/// Least height of a chart, points.
const LEAST: f32 = 100.0;
/// Height of the picture's strip, points.
const STRIP: f32 = 44.0;
/// Space between charts, points.
const GAP: f32 = 2.0 * STEP;
/// Room around a chart, points.
const MARGIN: Margin = Margin {
    left: 40,
    right: 8,
    top: 18,
    bottom: 18,
};
/// The axis along the strip.
const PLACE: &str = "place on the strip";
/// Names of what is felt, for assistive tools.
const NAMES: [&str; 4] = [
    "Voltage of the last moments",
    "Spectrum of the voltage",
    "Friction on the simulated screen",
    "Spectrum of the friction on the screen",
];
/// What there is to do before anything is felt.
const UNMOVED: &str = "Move over the workspace: x of the display is the place on the strip";

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, friction: &mut Friction, context: &mut PaneContext<'_>) {
    let whole = ui.available_rect_before_wrap();
    if whole.width() >= WIDE {
        let (left, right) = whole.split_left_right_at_x(whole.left() + CONTROLS);
        inside(ui, left, |ui| {
            scroll_area("friction controls").show(ui, |ui| controls::show(ui, friction, context));
        });
        inside(ui, right.with_min_x(right.left() + 3.0 * STEP), |ui| {
            let height = ui.available_height().max(4.0 * (LEAST + GAP));
            scroll_area("friction charts").show(ui, |ui| {
                let (rect, _) = ui
                    .allocate_exact_size(vec2(ui.available_width(), height - GAP), Sense::hover());
                let middle = rect.left() + (0.5 * rect.width()).round();
                let (left, right) = rect.split_left_right_at_x(middle);
                show_strip(ui, left.with_max_x(middle - GAP), friction, context);
                show_felt(ui, right, friction, context);
            });
        });
        ui.advance_cursor_after_rect(whole);
        return;
    }
    scroll_area("friction").show(ui, |ui| {
        let width = ui.available_width();
        let (strip, _) = ui.allocate_exact_size(vec2(width, STRIP + 2.4 * LEAST), Sense::hover());
        show_strip(ui, strip, friction, context);
        ui.add_space(GAP);
        controls::show(ui, friction, context);
        ui.add_space(GAP);
        let (felt, _) = ui.allocate_exact_size(vec2(width, 4.0 * LEAST), Sense::hover());
        show_felt(ui, felt, friction, context);
    });
}

fn setting(name: &str) -> Setting<'_> {
    Setting {
        name,
        margin: MARGIN,
        wheel: false,
        ..Setting::default()
    }
}

/// Writes what a chart shows above its frame.
fn titled(ui: &Ui, rect: Rect, shown: &Chart) {
    let left = pos2(rect.left() + f32::from(MARGIN.left), rect.top() + 8.0);
    paint_line(ui, left, 0.7 * rect.width(), quiet(shown.title.clone()));
}

/// The picture's strip, friction along it, its spectrogram: one above the other on one axis.
fn show_strip(ui: &Ui, rect: Rect, friction: &mut Friction, context: &PaneContext<'_>) {
    let Some(shown) = friction.shown(context.bench) else {
        // What is wrong stands beside its cause.
        let words = friction.trace().map_or(EMPTY, |_| "");
        paint_sentence(ui.painter(), rect, words);
        return;
    };
    let trace = Arc::clone(&shown.of.0.0);
    let half = 0.5 * (rect.height() - STRIP);
    let (strip, below) = rect.split_top_bottom_at_y(rect.top() + STRIP);
    let (above, below) = below.split_top_bottom_at_y(below.top() + half);
    let along = &shown.charts[0];
    titled(ui, above, along);
    let placed = Setting {
        link: Some(PLACE),
        ..setting("Friction along the strip")
    };
    let Some(plot) = plot::show(ui, above, along, &placed) else {
        return;
    };
    let ends = [0.0, trace.length_mm()].map(|mm| plot.at([mm, 0.0]).x);
    let area = plot.area();
    let picture = Rect::from_x_y_ranges(ends[0]..=ends[1], strip.top() + 4.0..=strip.bottom());
    let within = picture.with_min_x(area.left()).with_max_x(area.right());
    let image = Same(Arc::clone(&trace.strip));
    let grey = (friction.strip).of(
        ui.ctx(),
        ("friction strip", TextureOptions::LINEAR),
        image,
        || Arc::clone(&trace.strip),
    );
    paint(&ui.painter().with_clip_rect(within), picture, WHOLE, grey);
    show_spectrogram(ui, below, friction, (&trace, context));
}

fn show_spectrogram(
    ui: &Ui,
    rect: Rect,
    friction: &mut Friction,
    (trace, context): (&Arc<Trace>, &PaneContext<'_>),
) {
    let map = context.bench.settings.preferences.colour_map;
    let chart = chart::spectrogram_frame(trace);
    titled(ui, rect, &chart);
    let placed = Setting {
        link: Some(PLACE),
        hover: false,
        ..setting("Spectrogram of the friction")
    };
    let Some(plot) = plot::show(ui, rect, &chart, &placed) else {
        return;
    };
    let [_, high] = chart.y.range.unwrap_or_default();
    let corners = [[0.0, high], [trace.length_mm(), 0.0]].map(|corner| plot.at(corner));
    let key = (Same(Arc::clone(trace)), map);
    let picture = friction.spectrogram.of(
        ui.ctx(),
        ("friction spectrogram", TextureOptions::NEAREST),
        key,
        || image(&chart::spectrogram_cells(trace, map).0),
    );
    let painter = ui.painter().with_clip_rect(plot.area());
    paint(
        &painter,
        Rect::from_min_max(corners[0], corners[1]),
        WHOLE,
        picture,
    );
}

/// Cells as pixels.
fn image(raster: &Raster) -> ColorImage {
    let cells = raster.cells.iter().map(|cell| cell.unwrap_or_default());
    let pixels = cells.map(|[r, g, b]| Color32::from_rgb(r, g, b));
    ColorImage::new([raster.n_columns, raster.n_rows()], pixels.collect())
}

/// Voltage and friction over the last moments, with their spectra.
fn show_felt(ui: &Ui, rect: Rect, friction: &mut Friction, context: &PaneContext<'_>) {
    let Some(shown) = friction.shown(context.bench) else {
        return;
    };
    if shown.stroke.is_empty() {
        paint_sentence(ui.painter(), rect, UNMOVED);
        return;
    }
    let height = 0.25 * (rect.height() + GAP);
    for (nth, (chart, name)) in shown.charts[1..].iter().zip(NAMES).enumerate() {
        let top = rect.top() + nth as f32 * height;
        let own = rect.with_min_y(top).with_max_y(top + height - GAP);
        titled(ui, own, chart);
        plot::show(ui, own, chart, &setting(name));
    }
}
