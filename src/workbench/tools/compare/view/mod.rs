//! A against B on the same path: what is compared, where and when they differ, and in all.
//!
//! Draws what `compare` found.

pub(crate) mod controls;
pub(crate) mod maps;
pub(crate) mod over_time;
#[cfg(test)]
mod tests;

use eframe::egui::{Align, Align2, Label, Layout, Rect, RichText, Ui, UiBuilder, vec2};

use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::axis::round_step;
use crate::tools::compare::choice::Route;
use crate::tools::compare::{Compare, Standing};
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_render::{LevelDifference, Tally};
use selvedge_textile::tactile::Band;

/// Height of a line of the summary, points.
const LINE: f32 = 14.0;
/// A pane this wide has room for the maps beside the curve, points.
const WIDE: f32 = 300.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, compare: &mut Compare, context: &mut PaneContext<'_>) {
    let standing = compare.follow(context.bench);
    let route = Route::at_hand(context.bench);
    ui.spacing_mut().item_spacing.y = STEP;
    controls::show(ui, compare, (&standing, &route), context);
    let palette = Palette::in_ui(ui);
    let rect = ui.available_rect_before_wrap();
    let Some(found) = compare.found().filter(|_| is_worth_showing(&standing)) else {
        ui.label(RichText::new(empty_words(&standing)).color(palette.dim));
        return;
    };
    let summary = Band::ALL.map(|band| summary(&found.in_all[band.index()]));
    let height = (rect.height() - 2.0 * LINE - STEP).max(0.0);
    let body = Rect::from_min_size(rect.min, vec2(rect.width(), height));
    let (maps, curve) = split(body, context.scene.grid);
    let mut dimmed = ui.new_child(UiBuilder::new().max_rect(body));
    if standing != Standing::Fresh {
        dimmed.set_opacity(0.45);
    }
    maps::show(&dimmed, maps, found, context);
    over_time::show(&dimmed, curve, compare, &route, context);
    let top = body.bottom() + STEP;
    for (band, words) in Band::ALL.into_iter().zip(summary) {
        let top = top + LINE * band.index() as f32;
        let line = Rect::from_x_y_ranges(rect.x_range(), top..=top + LINE);
        show_line(ui, line, band, &words);
    }
    ui.advance_cursor_after_rect(rect);
}

/// Whether what was found may be shown beside how it stands.
fn is_worth_showing(standing: &Standing) -> bool {
    !matches!(standing, Standing::Impossible(_) | Standing::Cancelled)
}

fn empty_words(standing: &Standing) -> String {
    match standing {
        Standing::Impossible(words) => words.clone(),
        Standing::Cancelled => "Stopped. Press “compare” to compare".to_owned(),
        Standing::Running(_) => "Comparing…".to_owned(),
        Standing::None | Standing::Stale | Standing::Fresh => {
            "The recording is long: press “compare”".to_owned()
        }
    }
}

/// The places of the maps and of the curve: side by side where there is room for both.
fn split(body: Rect, grid: Option<(usize, usize)>) -> (Rect, Rect) {
    if body.width() >= WIDE && body.width() > body.height() {
        let maps = maps_width(body, grid);
        let (maps, curve) = body.split_left_right_at_x(body.left() + maps);
        (maps, curve.with_min_x(curve.left() + 2.0 * STEP))
    } else {
        let (maps, curve) = body.split_top_bottom_at_fraction(0.5);
        (maps, curve.with_min_y(curve.top() + 2.0 * STEP))
    }
}

/// As wide as maps of this height need to be with square cells.
fn maps_width(body: Rect, grid: Option<(usize, usize)>) -> f32 {
    let (n_rows, n_columns) = grid.unwrap_or((1, 1));
    let cell = (body.height() - 20.0) / n_rows.max(1) as f32;
    let maps = 2.0 * n_columns as f32 * cell + 64.0;
    maps.clamp(0.3 * body.width(), 0.56 * body.width())
}

fn show_line(ui: &mut Ui, line: Rect, band: Band, words: &str) {
    let palette = Palette::in_ui(ui);
    let (name, words_at) = line.split_left_right_at_x(line.left() + 44.0);
    let (at, ink) = (name.left_center(), palette.band(band));
    let font = theme::small();
    ui.painter()
        .text(at, Align2::LEFT_CENTER, band_name(band), font, ink);
    let words = RichText::new(words)
        .font(theme::small())
        .color(palette.text);
    let mut child = ui.new_child(
        UiBuilder::new()
            .max_rect(words_at)
            .layout(Layout::left_to_right(Align::Center)),
    );
    child.add(Label::new(words).truncate());
}

/// A band's name.
fn band_name(band: Band) -> String {
    with_unit(band.carrier_hz(), 0, "Hz")
}

/// What was found of a band, in a line.
fn summary(tally: &Tally) -> String {
    let (Some(mean_db), Some(largest)) = (tally.mean_db(), tally.largest) else {
        return alone_words(tally).to_owned();
    };
    let n_apart = tally.n_only[0] + tally.n_only[1];
    if largest.difference_db.abs() < 1e-9 && n_apart == 0 {
        return "no difference at any tick, 0.00 dB".to_owned();
    }
    let decimals = decimals_of(largest.difference_db);
    let [mean, most] = [mean_db, largest.difference_db].map(|db| with_unit(db, decimals, "dB"));
    let (tick, contactor) = (largest.tick, largest.contactor);
    let n_all = tally.n_both + n_apart;
    let alone = ["A", "B"].into_iter().zip(tally.n_only);
    let alone = alone
        .filter(|(_, n_only)| *n_only > 0)
        .map(|(name, n_only)| {
            let share = fixed(100.0 * n_only as f64 / n_all as f64, 1);
            format!(", {name} only in {share} %")
        });
    let alone: String = alone.collect();
    format!("mean {mean}, largest {most} at tick {tick}, contactor {contactor}{alone}")
}

/// What is said where no difference can be.
fn alone_words(tally: &Tally) -> &'static str {
    match tally.n_only {
        [0, 0] => "silent in both",
        [_, 0] => "A only: B is silent",
        [0, _] => "B only: A is silent",
        _ => "never both at once: A only or B only",
    }
}

/// Half the range of a scale of differences: the least of 1, 2, 5 · 10ⁿ that holds the largest;
/// 1 dB where there are none.
pub(crate) fn scale_db(differences_db: impl Iterator<Item = f64>) -> f64 {
    let largest = differences_db.map(f64::abs).fold(0.0, f64::max);
    if largest > 1e-6 {
        round_step(largest.max(1e-4))
    } else {
        1.0
    }
}

/// The unit of a scale of differences and how many of it are a dB: methods differ by so little that
/// thousandths are needed.
fn unit_of(most_db: f64) -> (&'static str, f64) {
    if most_db < 0.1 {
        ("mdB", 1000.0)
    } else {
        ("dB", 1.0)
    }
}

/// Decimals that a difference is written with: methods differ by very little.
fn decimals_of(difference_db: f64) -> usize {
    let magnitude = difference_db.abs();
    if magnitude > 1e-6 && magnitude < 0.1 {
        4
    } else {
        2
    }
}

/// Sounding contactors by band, for those who do not see the maps.
fn describe(found: &LevelDifference) -> String {
    let of_band = |band: Band| {
        let cells = || found.by_contactor.iter().map(|cell| &cell[band.index()]);
        let n_both = cells().filter(|tally| tally.n_both > 0).count();
        let n_only = [0, 1].map(|side| {
            let is_only = |t: &&Tally| t.n_both == 0 && t.n_only[side] > 0;
            cells().filter(is_only).count()
        });
        let [n_a, n_b] = n_only;
        format!(
            "{}: {n_both} in both, {n_a} A only, {n_b} B only",
            band_name(band)
        )
    };
    Band::ALL.map(of_band).join("; ")
}
