//! A against B on the same path: what is compared, where and when they differ, and in all.
//!
//! Draws what `compare` found.

pub(crate) mod controls;
pub(crate) mod maps;
pub(crate) mod over_time;

use eframe::egui::{Align, Align2, Label, Layout, Rect, RichText, Ui, UiBuilder, vec2};

use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::text::small;
use crate::tools::compare::comparison::{Compare, Standing};
use crate::tools::compare::words::{band_name, summary};
use selvedge_textile::tactile::Band;

/// Height of a line of the summary, points.
const LINE: f32 = 14.0;
/// A pane this wide has room for the maps beside the curve, points.
const WIDE: f32 = 300.0;

/// Shows the pane.
pub(crate) fn show(ui: &mut Ui, compare: &mut Compare, context: &mut PaneContext<'_>) {
    let standing = compare.follow(context.bench);
    let route = compare.route_now(context.bench);
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
    let words = small(words, palette.text);
    let mut child = ui.new_child(
        UiBuilder::new()
            .max_rect(words_at)
            .layout(Layout::left_to_right(Align::Center)),
    );
    child.add(Label::new(words).truncate());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_fit_side_by_side_or_one_above_the_other() {
        use eframe::egui::pos2;
        for size in [vec2(345.0, 130.0), vec2(700.0, 300.0), vec2(240.0, 500.0)] {
            let body = Rect::from_min_size(pos2(3.0, 4.0), size);
            let (maps, curve) = split(body, Some((6, 4)));
            assert!(body.contains_rect(maps) && body.contains_rect(curve));
            assert!(!maps.intersect(curve).is_positive(), "{size:?}");
        }
    }
}
