//! A part of a recording, or of what was felt last, that is selected: it loops, becomes a recording
//! of its own, or is exported.

use std::ops::Range;

use eframe::egui::{Align, Layout as Arrangement, Rect, Ui, UiBuilder, pos2, vec2};

use crate::bench::command::{Commands, FileCommand, PlayCommand, Purpose, RecordingCommand};
use crate::bench::export::Exportable;
use crate::kit::theme::Palette;
use crate::kit::widgets::text::toggle;
use crate::tools::timeline::scope::Scope;

/// Width of the buttons, points.
const BUTTONS: f32 = 236.0;

/// The ticks from one to another, both included, whichever is first.
pub(crate) fn between(one: u64, other: u64) -> Range<u64> {
    one.min(other)..one.max(other) + 1
}

/// Paints the selection, and what can be done with it. Whether it is given up.
pub(crate) fn show(
    ui: &mut Ui,
    scope: &Scope<'_>,
    selected: &Range<u64>,
    commands: &mut Commands,
) -> bool {
    let palette = Palette::in_ui(ui);
    let edge = |tick: u64| {
        let share = (tick as f64 - scope.span.start) / scope.span.length();
        scope.layout.x_at(share)
    };
    let body = scope.layout.body();
    let columns = edge(selected.start)..=edge(selected.end);
    let place = Rect::from_x_y_ranges(columns, body.y_range()).intersect(body);
    if !place.is_positive() {
        return false;
    }
    let ground = palette.selection.gamma_multiply(0.16);
    ui.painter().rect_filled(place, 0, ground);
    let left = place.left().min(body.right() - BUTTONS).max(body.left());
    let row = Rect::from_min_size(pos2(left, body.top() + 1.0), vec2(BUTTONS, 18.0));
    let layout = Arrangement::left_to_right(Align::Center);
    let mut child = ui.new_child(UiBuilder::new().max_rect(row).layout(layout));
    child.spacing_mut().item_spacing.x = 2.0;
    show_buttons(&mut child, scope, selected, commands)
}

fn show_buttons(
    ui: &mut Ui,
    scope: &Scope<'_>,
    selected: &Range<u64>,
    commands: &mut Commands,
) -> bool {
    if let Some(take) = scope.view.shown_take() {
        let looped = scope.view.loop_within == Some(selected);
        if toggle(ui, "loop", looped, "Replay this part again and again") {
            let within = (!looped).then(|| selected.clone());
            commands.push(PlayCommand::LoopWithin(within).into());
        }
        let is_on_disk = take.folder.is_some();
        let tip = "Make this part a recording of its own";
        if is_on_disk && toggle(ui, "excerpt", false, tip) {
            commands.push(RecordingCommand::Excerpt(selected.clone()).into());
        }
        if toggle(ui, "path…", false, "Export the path of this part") {
            commands.push(FileCommand::Ask(Purpose::SaveRecording).into());
        }
    }
    if scope.view.shown_take().is_none() {
        let tip = "Make this part of what was felt last a recording";
        if toggle(ui, "keep", false, tip) {
            commands.push(RecordingCommand::Keep(selected.clone()).into());
        }
    }
    let tip = "Export speed and levels of this part as a table or a figure";
    if toggle(ui, "table…", false, tip) {
        let what = Purpose::Export(Exportable::Timeline);
        commands.push(FileCommand::Ask(what).into());
    }
    toggle(ui, "×", false, "Select nothing")
}
