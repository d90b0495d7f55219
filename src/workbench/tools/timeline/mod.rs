//! The bar at the bottom: what moves the display, recording and replay, and the exploration over
//! time.
//!
//! Left the controls, in the middle the timeline, right the numbers. It plays, records and seeks
//! nothing itself: it says what the user wants.

pub(crate) mod controls;
pub(crate) mod export;
pub(crate) mod felt;
pub(crate) mod icons;
pub(crate) mod live;
pub(crate) mod picture;
pub(crate) mod plot;
pub(crate) mod strip;
pub(crate) mod strips_view;
#[cfg(test)]
mod tests;
pub(crate) mod transport;

use std::fmt;

use eframe::egui::{self, Align2, FontId, Rect, Sense, Ui, UiBuilder, WidgetInfo, pos2, vec2};

use crate::bench::Bench;
use crate::bench::command::Commands;
use crate::bench::export::NOTHING_FELT;
use crate::bench::export::button::{place_in, show as show_export};
use crate::bench::export::{Exportable, Exported};
use crate::bench::tool::{Bar, PaneContext};
use crate::kit::theme;
use crate::kit::theme::{Palette, STEP};
use crate::tools::timeline::picture::Picture;
use crate::tools::timeline::transport::{TICK_MS, TransportView};
use selvedge_foundation::quantity;

/// Height of the bar without its margins, points.
pub(crate) const HEIGHT: f32 = 68.0;
/// Width of the controls, points.
const CONTROLS: f32 = 304.0;
/// Width of the numbers, points.
const NUMBERS: f32 = 116.0;

/// The bar at the bottom: what it remembers from frame to frame.
#[derive(Default)]
pub(crate) struct Timeline {
    picture: Option<Picture>,
    /// The tick that was asked for last in the drag that goes on.
    asked: Option<u64>,
}

impl Bar for Timeline {
    fn ui(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let view = TransportView::of(context.bench);
        show(ui, &view, self, context.commands);
    }

    fn export(&mut self, bench: &mut Bench) -> Result<Exported, &'static str> {
        let timeline = TransportView::of(bench).timeline();
        let mut ticks = timeline.ticks.iter();
        if !ticks.any(|tick| tick.felt.speed_mm_per_s > 0.0) {
            return Err(NOTHING_FELT);
        }
        Ok(export::strips(&timeline, bench.rendered_origin()))
    }
}

/// Shows the bar in the width that there is.
fn show(ui: &mut Ui, view: &TransportView<'_>, state: &mut Timeline, commands: &mut Commands) {
    let size = vec2(ui.available_width(), HEIGHT);
    let (bar, _) = ui.allocate_exact_size(size, Sense::hover());
    let (controls, rest) = bar.split_left_right_at_x(bar.left() + CONTROLS);
    let (middle, numbers) = rest.split_left_right_at_x(rest.right() - NUMBERS);
    ui.scope_builder(UiBuilder::new().max_rect(controls), |ui| {
        controls::show(ui, view, commands);
    });
    let timeline = Rect::from_min_max(
        pos2(middle.left() + 3.0 * STEP, middle.top()),
        pos2(middle.right() - 4.0 * STEP, middle.bottom()),
    );
    strips_view::show(ui, timeline, view, state, commands);
    // It stands a little above the bar's content, which must not grow by it.
    let export = UiBuilder::new().max_rect(place_in(timeline));
    show_export(&mut ui.new_child(export), Exportable::Timeline, commands);
    show_numbers(ui, numbers, view);
}

/// Time, tick and speed in digits that stand still.
fn show_numbers(ui: &Ui, rect: Rect, view: &TransportView<'_>) {
    let palette = Palette::in_ui(ui);
    let (tick, what) = view.counted();
    let time = quantity::clock(tick * TICK_MS);
    let response = ui.interact(
        rect,
        ui.scope_id().with("transport numbers"),
        Sense::hover(),
    );
    response.widget_info(|| {
        let speed = quantity::with_unit(view.speed_mm_per_s, 1, "mm/s");
        let words = format!("Time {time}, tick {tick}, speed {speed}");
        WidgetInfo::labeled(egui::Role::Label, true, words)
    });
    let painter = ui.painter();
    let large = FontId::monospace(theme::title().size);
    let at = pos2(rect.right(), rect.top() + 14.0);
    painter.text(at, Align2::RIGHT_CENTER, time, large, palette.text);
    let rows = [
        ("tick", tick.to_string(), ""),
        ("speed", quantity::fixed(view.speed_mm_per_s, 1), "mm/s"),
    ];
    for ((name, digits, unit), y) in rows.into_iter().zip([38.0, 56.0]) {
        let y = rect.top() + y;
        let dim = |x: f32, anchor: Align2, words: &str| {
            painter.text(pos2(x, y), anchor, words, theme::small(), palette.dim);
        };
        dim(rect.left(), Align2::LEFT_CENTER, name);
        dim(rect.right(), Align2::RIGHT_CENTER, unit);
        let right = pos2(rect.right() - if unit.is_empty() { 0.0 } else { 30.0 }, y);
        painter.text(
            right,
            Align2::RIGHT_CENTER,
            digits,
            theme::number(),
            palette.text,
        );
    }
    response.on_hover_text(format!("{what}\nSpeed of the middle of the display"));
}

impl fmt::Debug for Timeline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Timeline")
            .field("asked", &self.asked)
            .finish_non_exhaustive()
    }
}
