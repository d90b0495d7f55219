//! What ticks cost: how the measured times are distributed, with the time that a tick has.

use std::time::Duration;

use eframe::egui::{Sense, Ui, vec2};

use crate::kit::pane::paint_sentence;
use crate::kit::plot;
use crate::kit::plot::Setting;
use crate::kit::theme::Palette;
use crate::tools::accuracy::sampling::CostView;
use crate::tools::accuracy::view::numbers::{HISTOGRAM, LINE, quiet_line};
use crate::tools::accuracy::view::{chart, numbers};
use selvedge_foundation::quantity;

/// Shows costs and their distribution in the space that is left.
pub(crate) fn show(ui: &mut Ui, cost: &CostView) {
    let tip = "Time from the beginning of a tick to the end of all that it does: pointer, \
               velocity, rendering, frame to the device, recording. What the system gave to \
               others meanwhile counts too\nLate: began more than 1 ms after it was due. Missed: \
               never was, because the engine came a whole tick too late";
    quiet_line(ui, "Time a tick", tip);
    let height = (ui.available_height() - 3.0 * LINE).max(40.0);
    let size = vec2(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let setting = Setting {
        name: "Distribution of the time a tick takes",
        ..HISTOGRAM
    };
    let shown = plot::show(ui, rect, &chart::cost_chart(cost), &setting);
    if cost.costs.n() == 0 {
        let words = "Times show here once the engine runs";
        paint_sentence(ui.painter(), rect - setting.margin, words);
    }
    let pointed = shown.and_then(|shown| Some((shown.pointer()?, shown)));
    if let Some((at, shown)) = pointed
        && let Some(words) = words_at(cost, shown.values_at(at)[0] * 1e6)
    {
        shown.response.on_hover_text_at_pointer(words);
    }
    show_numbers(ui, cost);
}

fn microseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6
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
