//! The errors found: now, largest, 99th percentile, and how they are distributed, with the bound
//! that the method promises and the budget that it was given.

use eframe::egui::{
    self, Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::kit::spectrogram::paint_sentence;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_ticks};
use crate::tools::accuracy::checker::{ERRORS_DB, ErrorView, ROUNDING_DB, edges_db};
use crate::tools::accuracy::view::numbers::LINE;
use crate::tools::accuracy::view::{numbers, quiet_line};
use crate::tools::accuracy::{AccuracyView, Tally};
use selvedge_foundation::quantity;
use selvedge_render::array::Method;
use selvedge_textile::tactile::Band;

/// Between the names of two lines, points.
const NAME_GAP: f32 = 5.0;
/// How a distribution is filled.
const FILL: f32 = 0.28;

/// A level error that is drawn as a line.
struct Mark {
    db: f64,
    name: &'static str,
    ink: Color32,
    is_dashed: bool,
}

/// Shows errors and their distribution in the space that is left.
pub(crate) fn show(ui: &mut Ui, view: &AccuracyView<'_>) {
    let title = view.method.map_or("Level error", |method| match method {
        Method::Reference => "Level error of reference",
        Method::Banded => "Level error of banded",
        Method::Table => "Level error of table",
        Method::Auto => "Level error of auto",
    });
    quiet_line(ui, title, &tally_words(view.found, view.tally));
    let height = (ui.available_height() - 3.0 * LINE).max(40.0);
    let size = vec2(ui.available_width(), height);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| {
        WidgetInfo::labeled(egui::Role::Canvas, true, "Distribution of level errors")
    });
    let plot = Rect::from_min_max(rect.min + vec2(2.0, LINE), rect.max - vec2(2.0, LINE + 2.0));
    let axis = Axis::log(ERRORS_DB[0], ERRORS_DB[1]);
    let ticks = [1e-6, 1e-4, 1e-2, 1.0].map(|db| Tick::named(db, &decade(db)));
    paint_ticks(ui.painter(), plot, (&axis, Side::Bottom), &ticks);
    if view.found.n_ticks == 0 {
        let words = "Move the display over a textile: its ticks are checked against reference";
        paint_sentence(ui.painter(), plot, words);
    } else {
        let counts = &view.found.counts;
        let most = counts.iter().flatten().copied().max().unwrap_or(0);
        for band in Band::ALL {
            let counts = &counts[band.index()];
            paint_distribution(ui.painter(), plot, &axis, (counts, most), band);
        }
        paint_marks(ui, plot, &axis, view);
    }
    let pointer = response.hover_pos().filter(|at| plot.contains(*at));
    if let Some(at) = pointer {
        let words = words_at(view.found, axis.value_at_x(plot.x_range(), at.x));
        response.on_hover_text_at_pointer(words);
    }
    show_numbers(ui, view.found);
}

fn show_numbers(ui: &mut Ui, found: &ErrorView) {
    let palette = Palette::in_ui(ui);
    let is_known = found.n_ticks > 0;
    let of_bands = |value: &dyn Fn(usize) -> Option<f64>| -> Vec<(String, Color32)> {
        let of_band = |band: Band| {
            let db = value(band.index()).filter(|_| is_known);
            let text = db.map_or_else(|| "–".to_owned(), numbers::level);
            (text, palette.band(band))
        };
        Band::ALL.map(of_band).to_vec()
    };
    let heard = |b: usize| (found.bands[b].n_amplitudes > 0).then_some(found.bands[b]);
    numbers::line(ui, "now", &of_bands(&|b| found.now_db[b]), "dB");
    let p99 = of_bands(&|b| heard(b).map(|error| error.p99_db));
    numbers::line(ui, "99 %", &p99, "dB");
    let largest = of_bands(&|b| heard(b).map(|error| error.max_db));
    numbers::line(ui, "largest", &largest, "dB");
}

/// `1`, `0.01`, `10⁻⁶`.
fn decade(db: f64) -> String {
    if db >= 0.009 {
        return quantity::fixed(db, if db < 1.0 { 2 } else { 0 });
    }
    format!("1e{}", quantity::fixed(db.log10(), 0))
}

fn paint_distribution(
    painter: &Painter,
    plot: Rect,
    axis: &Axis,
    (counts, most): (&[u64], u64),
    band: Band,
) {
    if most == 0 {
        return;
    }
    let ink = Palette::of(painter.ctx().theme()).band(band);
    let is_any = |count: &u64| *count > 0;
    let first = counts.iter().position(is_any).unwrap_or(counts.len());
    let end = counts.iter().rposition(is_any).map_or(0, |last| last + 1);
    let edges = edges_db();
    let mut outline: Vec<Pos2> = Vec::new();
    for (edge_db, count) in edges.windows(2).zip(counts).take(end).skip(first) {
        #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
        let share = (*count as f64 / most as f64) as f32;
        let y = plot.bottom() - share * (plot.height() - 2.0);
        let [left, right] = [edge_db[0], edge_db[1]].map(|db| axis.x(plot.x_range(), db));
        if *count > 0 {
            let bar = Rect::from_min_max(pos2(left, y), pos2(right, plot.bottom()));
            painter.rect_filled(bar, 0, ink.gamma_multiply(FILL));
        }
        outline.extend([pos2(left, y), pos2(right, y)]);
    }
    painter.add(Shape::line(outline, Stroke::new(1.0, ink)));
}

fn paint_marks(ui: &Ui, plot: Rect, axis: &Axis, view: &AccuracyView<'_>) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let has_budget = matches!(view.rendering.method, Method::Auto | Method::Table);
    let mark = |db, name, ink, is_dashed| Mark {
        db,
        name,
        ink,
        is_dashed,
    };
    let mut marks = vec![mark(ROUNDING_DB, "rounding", palette.dim, true)];
    if view.bound_db > ROUNDING_DB {
        marks.push(mark(view.bound_db, "bound", palette.text, false));
    }
    if has_budget && view.rendering.budget_db > 0.0 {
        let budget_db = view.rendering.budget_db;
        marks.push(mark(budget_db, "budget", palette.selection, true));
    }
    marks.sort_by(|a, b| b.db.total_cmp(&a.db));
    // From the right on, names give way to those before them.
    let mut most_right = plot.right() + 2.0;
    for mark in marks {
        let x = painter.round_to_pixel_center(axis.x(plot.x_range(), mark.db));
        let ends = [pos2(x, plot.top()), pos2(x, plot.bottom())];
        let stroke = Stroke::new(1.0, mark.ink);
        if mark.is_dashed {
            painter.add(Shape::Vec(Shape::dashed_line(&ends, stroke, 3.0, 3.0)));
        } else {
            painter.line_segment(ends, stroke);
        }
        let name = painter.layout_no_wrap(mark.name.to_owned(), theme::small(), mark.ink);
        let left = (x - 0.5 * name.size().x).min(most_right - name.size().x);
        painter.galley(pos2(left, plot.top() - LINE), name, mark.ink);
        most_right = left - NAME_GAP;
    }
}

fn tally_words(found: &ErrorView, tally: Tally) -> String {
    format!(
        "Ticks of the engine rendered once more by reference (f64, every bin) with the same gains. \
         Level errors count where the reference reaches a thousandth of its band's largest \
         amplitude; below that the largest difference is {} (40 Hz) and {} (320 Hz) of it. \
         Amplitudes come in single precision, which alone is an error of up to {} dB.\n{} ticks \
         checked, {} left out because earlier ones still waited, {} because the scene or a gain \
         was on its way",
        numbers::level(found.bands[0].max_share_below),
        numbers::level(found.bands[1].max_share_below),
        numbers::level(ROUNDING_DB),
        found.n_ticks,
        tally.busy,
        tally.changed,
    )
}

/// What lies in the bin around an error.
fn words_at(found: &ErrorView, db: f64) -> String {
    let edges = edges_db();
    let bin = edges.partition_point(|edge| *edge < db);
    let bin = bin.clamp(1, edges.len().saturating_sub(1).max(1)) - 1;
    let ends = [edges.get(bin), edges.get(bin + 1)]
        .map(|edge| numbers::level(edge.copied().unwrap_or_default()));
    let share = |b: usize| {
        let total: u64 = found.counts[b].iter().sum();
        let here = found.counts[b].get(bin).copied().unwrap_or_default();
        let percent = 100.0 * here as f64 / (total as f64).max(1.0);
        quantity::with_unit(percent, 1, "%")
    };
    format!(
        "{} … {} dB\n40 Hz  {} of its amplitudes\n320 Hz  {}",
        ends[0],
        ends[1],
        share(0),
        share(1)
    )
}
