//! The errors found: now, largest, 99th percentile, and how they are distributed, with the bound
//! that the method promises and the budget that it was given.

use eframe::egui::{Color32, Sense, Ui, vec2};

use crate::bench::rendering::Rendering;
use crate::kit::pane::paint_sentence;
use crate::kit::plot;
use crate::kit::plot::Setting;
use crate::kit::theme::Palette;
use crate::tools::accuracy::checker::{ErrorView, ROUNDING_DB, edges_db};
use crate::tools::accuracy::sampling::{Accuracy, Tally};
use crate::tools::accuracy::view::numbers::{HISTOGRAM, LINE, quiet_line};
use crate::tools::accuracy::view::{chart, numbers};
use selvedge_foundation::quantity;
use selvedge_render::array::Method;
use selvedge_textile::tactile::Band;

/// Shows errors and their distribution in the space that is left.
pub(crate) fn show(ui: &mut Ui, accuracy: &Accuracy, rendering: Rendering) {
    let found = accuracy.found();
    let title = accuracy
        .method()
        .map_or("Level error", |method| match method {
            Method::Reference => "Level error of reference",
            Method::Banded => "Level error of banded",
            Method::Table => "Level error of table",
            Method::Auto => "Level error of auto",
        });
    quiet_line(ui, title, &tally_words(found, accuracy.tally));
    let height = (ui.available_height() - 3.0 * LINE).max(40.0);
    let size = vec2(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let setting = Setting {
        name: "Distribution of level errors",
        ..HISTOGRAM
    };
    let shown = plot::show(ui, rect, &chart::error_chart(accuracy, rendering), &setting);
    if found.n_ticks == 0 {
        let words = "Move the display over a textile: its ticks are checked against reference";
        paint_sentence(ui.painter(), rect - setting.margin, words);
    }
    let pointed = shown.and_then(|shown| Some((shown.pointer()?, shown)));
    if let Some((at, shown)) = pointed {
        let words = words_at(found, shown.values_at(at)[0]);
        shown.response.on_hover_text_at_pointer(words);
    }
    show_numbers(ui, found);
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
