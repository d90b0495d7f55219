//! The bar at the bottom: what moves the display, recording and replay, and the exploration over
//! time.
//!
//! Left the controls, in the middle the line of time, right the numbers. It plays, records and
//! seeks nothing itself: it says what the user wants.

pub(crate) mod axes;
pub(crate) mod code;
pub(crate) mod columns;
pub(crate) mod controls;
pub(crate) mod export;
pub(crate) mod figure;
mod figure_map;
mod figure_moment;
pub(crate) mod icons;
pub(crate) mod job;
pub(crate) mod lanes;
pub(crate) mod layer;
pub(crate) mod live;
pub(crate) mod marks;
pub(crate) mod numbers;
pub(crate) mod picture;
pub(crate) mod scope;
pub(crate) mod selection;
pub(crate) mod sight;
pub(crate) mod span;
pub(crate) mod state;
#[cfg(test)]
mod tests;
pub(crate) mod transport;
pub(crate) mod view;
pub(crate) mod words;

use eframe::egui::{CursorIcon, Rect, Sense, Ui, UiBuilder, pos2, vec2};

use crate::bench::Bench;
use crate::bench::command::Commands;
use crate::bench::export::button::{place_in, show as show_export};
use crate::bench::export::{Exportable, Exported};
use crate::bench::settings::preferences::TIMELINE_HEIGHT;
use crate::bench::tool::{Bar, PaneContext};
use crate::kit::pane::frame_as_past;
use crate::kit::theme::STEP;
use crate::tools::timeline::lanes::LaneStyle;
use crate::tools::timeline::scope::extent;
use crate::tools::timeline::span::Span;
use crate::tools::timeline::state::{Drag, Timeline};
use crate::tools::timeline::transport::TransportView;
use selvedge_foundation::quantity;

/// Width of the controls, points.
const CONTROLS: f32 = 304.0;
/// Width of the numbers, points.
const NUMBERS: f32 = 116.0;
/// The most of the window's height that the bar takes.
const MOST_OF_WINDOW: f32 = 0.4;

impl Bar for Timeline {
    fn ui(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.follow(context.bench);
        let kept = &context.bench.settings.preferences;
        let mut style = LaneStyle {
            map: kept.colour_map,
            scale: context.bench.selection.scale,
            spectrum: context.bench.selection.spectrum,
        };
        let view = TransportView::of(context.bench);
        let mut height = kept.scales.timeline_height;
        show(ui, &view, (&mut style, &mut height), self, context.commands);
        context.bench.device.sound.is_scrubbed = self.drag == Some(Drag::Scrub);
        if let Some(back) = &context.bench.past.look_back {
            let ago = quantity::with_unit(back.ago_s, 2, "s");
            frame_as_past(
                ui.ctx(),
                &format!("Past: {ago} before the newest, in felt time"),
            );
        }
        context.bench.settings.preferences.scales.timeline_height = height;
        context.bench.selection.spectrum = style.spectrum;
        let is_of_recording = self.sight.of != 0;
        context.bench.exploration.selected = self.selected.clone().filter(|_| is_of_recording);
    }

    fn export(&mut self, bench: &mut Bench) -> Result<Exported, &'static str> {
        let view = TransportView::of(bench);
        let span = self.selected.as_ref().map(Span::of);
        let span = span.unwrap_or_else(|| self.sight.span(extent(&view)));
        let display = (bench.document.scene(), bench.display());
        export::timeline(&view, span, (display, bench.rendered_origin()))
    }
}

/// Shows the bar in the width that there is.
fn show(
    ui: &mut Ui,
    view: &TransportView<'_>,
    (style, height): (&mut LaneStyle, &mut f32),
    state: &mut Timeline,
    commands: &mut Commands,
) {
    let most = (MOST_OF_WINDOW * ui.ctx().content_rect().height()).max(TIMELINE_HEIGHT[0]);
    let size = vec2(ui.available_width(), height.min(most));
    let (bar, _) = ui.allocate_exact_size(size, Sense::hover());
    *height = resized(ui, bar, *height, most);
    let (controls, rest) = bar.split_left_right_at_x(bar.left() + CONTROLS);
    let (middle, numbers) = rest.split_left_right_at_x(rest.right() - NUMBERS);
    ui.scope_builder(UiBuilder::new().max_rect(controls), |ui| {
        controls::show(ui, view, commands);
    });
    let timeline = Rect::from_min_max(
        pos2(middle.left() + 3.0 * STEP, middle.top()),
        pos2(middle.right() - 4.0 * STEP, middle.bottom()),
    );
    view::show(ui, timeline, (view, style), state, commands);
    // It stands a little above the bar's content, which must not grow by it.
    let export = UiBuilder::new().max_rect(place_in(timeline));
    show_export(&mut ui.new_child(export), Exportable::Timeline, commands);
    numbers::show(ui, numbers, view);
}

/// The height after a drag of the bar's upper edge.
fn resized(ui: &Ui, bar: Rect, height: f32, most: f32) -> f32 {
    let edge = Rect::from_x_y_ranges(bar.x_range(), bar.top() - 7.0..=bar.top() - 2.0);
    let id = ui.scope_id().with("timeline edge");
    let response = ui.interact(edge, id, Sense::drag());
    let response = response.on_hover_cursor(CursorIcon::ResizeVertical);
    if !response.dragged() || response.drag_delta().y == 0.0 {
        return height;
    }
    ui.ctx().request_repaint();
    (height.min(most) - response.drag_delta().y)
        .clamp(TIMELINE_HEIGHT[0], most.min(TIMELINE_HEIGHT[1]))
}
