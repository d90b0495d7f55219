//! What ticks cost: how the measured times are distributed, with the time that a tick has.

use std::time::Duration;

use eframe::egui::{self, Align2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::kit::spectrogram::paint_sentence;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_ticks};
use crate::tools::accuracy::CostView;
use crate::tools::accuracy::view::numbers::LINE;
use crate::tools::accuracy::view::{numbers, quiet_line};
use selvedge_engine::{DurationBucket, TICK};
use selvedge_foundation::quantity;

/// The axis of costs, µs.
const COSTS_US: [f64; 2] = [0.5, 1e5];

/// Shows costs and their distribution in the space that is left.
pub(crate) fn show(ui: &mut Ui, cost: &CostView) {
    let tip = "Time from the beginning of a tick to the end of all that it does: pointer, \
               velocity, rendering, frame to the device, recording. What the system gave to \
               others meanwhile counts too\nLate: began more than 1 ms after it was due. Missed: \
               never was, because the engine came a whole tick too late";
    quiet_line(ui, "Time a tick", tip);
    let height = (ui.available_height() - 3.0 * LINE).max(40.0);
    let size = vec2(ui.available_width(), height);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| {
        WidgetInfo::labeled(
            egui::Role::Canvas,
            true,
            "Distribution of the time a tick takes",
        )
    });
    let plot = Rect::from_min_max(rect.min + vec2(2.0, LINE), rect.max - vec2(2.0, LINE + 2.0));
    let axis = Axis::log(COSTS_US[0], COSTS_US[1]);
    let ticks = [(1.0, "1 µs"), (100.0, "100 µs"), (1e4, "10 ms")];
    let ticks = ticks.map(|(us, name)| Tick::named(us, name));
    paint_ticks(ui.painter(), plot, (&axis, Side::Bottom), &ticks);
    if cost.costs.n() == 0 {
        paint_sentence(ui.painter(), plot, "Times show here once the engine runs");
    } else {
        paint_buckets(ui, plot, &axis, cost);
        paint_deadline(ui, plot, &axis);
    }
    let pointer = response.hover_pos().filter(|at| plot.contains(*at));
    if let Some(words) =
        pointer.and_then(|at| words_at(cost, axis.value_at_x(plot.x_range(), at.x)))
    {
        response.on_hover_text_at_pointer(words);
    }
    show_numbers(ui, cost);
}

fn microseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6
}

fn paint_buckets(ui: &Ui, plot: Rect, axis: &Axis, cost: &CostView) {
    let ink = Palette::in_ui(ui).dim;
    let most = cost.costs.buckets().map(|bucket| bucket.count).max();
    for DurationBucket { from, to, count } in cost.costs.buckets() {
        #[expect(clippy::cast_possible_truncation, reason = "a share, for the screen")]
        let share = (f64::from(count) / f64::from(most.unwrap_or(1))) as f32;
        let x = |time: Duration| {
            let x = axis.x(plot.x_range(), microseconds(time));
            x.clamp(plot.left(), plot.right())
        };
        // One tick among a million is still seen.
        let height = (share * (plot.height() - 2.0)).max(1.0);
        let right = x(to).max(x(from) + 1.0);
        let bar = Rect::from_min_max(
            pos2(x(from), plot.bottom() - height),
            pos2(right, plot.bottom()),
        );
        ui.painter().rect_filled(bar, 0, ink);
    }
}

fn paint_deadline(ui: &Ui, plot: Rect, axis: &Axis) {
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let x = painter.round_to_pixel_center(axis.x(plot.x_range(), microseconds(TICK)));
    let ends = [pos2(x, plot.top()), pos2(x, plot.bottom())];
    let stroke = Stroke::new(1.0, palette.text);
    painter.add(Shape::Vec(Shape::dashed_line(&ends, stroke, 3.0, 3.0)));
    let at = pos2(x + 6.0, plot.top() - 1.0);
    let words = "deadline 25 ms";
    painter.text(
        at,
        Align2::RIGHT_BOTTOM,
        words,
        theme::small(),
        palette.text,
    );
}

fn show_numbers(ui: &mut Ui, cost: &CostView) {
    let ink = Palette::in_ui(ui).text;
    let spread = cost.costs.spread();
    let us = |time: Duration| {
        let us = microseconds(time);
        let text = if cost.costs.n() == 0 {
            "–".to_owned()
        } else {
            quantity::fixed(us, usize::from(us < 999.95))
        };
        (text, ink)
    };
    numbers::line(ui, "median", &[us(spread.median)], "µs");
    numbers::line(ui, "99 %", &[us(spread.p99)], "µs");
    let missed = (cost.missed.to_string(), ink);
    let late = (cost.late.to_string(), ink);
    numbers::line(ui, "late, missed", &[late, missed], "");
}

/// How many ticks took about so long.
fn words_at(cost: &CostView, us: f64) -> Option<String> {
    let mut buckets = cost.costs.buckets();
    let bucket = buckets.find(|b| microseconds(b.from) < us && us <= microseconds(b.to))?;
    let [from, to] = [bucket.from, bucket.to].map(|time| quantity::time_span(time.as_secs_f64()));
    Some(format!(
        "{from} … {to}\n{} of {} ticks",
        bucket.count,
        cost.costs.n()
    ))
}
