//! Going about the workspace: the wheel zooms about the pointer, or turns the display with Alt;
//! the middle button drags the ground; two clicks on empty ground show all of it.

use eframe::egui::{CursorIcon, Event, MouseWheelUnit, PointerButton, Ui, Vec2};

use crate::bench::command::{Commands, Look, PlayCommand};
use crate::tools::workspace::arrange;
use crate::tools::workspace::stage::Stage;
use selvedge_foundation::geometry::Displacement;

/// Points of scrolling that magnify by the factor e.
const POINTS_PER_E: f32 = 240.0;
/// How far a notch of the wheel turns the display, degrees.
const NOTCH_DEG: f64 = 5.0;
/// Points of scrolling that count as a notch where there are none.
const POINTS_PER_NOTCH: f32 = 40.0;

/// Zooms, turns and pans. Says whether the ground is being dragged.
pub(crate) fn navigate(ui: &Ui, stage: &Stage<'_>, commands: &mut Commands) -> bool {
    if stage.response.contains_pointer() {
        take_wheel(ui, stage, commands);
    }
    if stage.response.double_clicked()
        && let Some(at) = stage.response.interact_pointer_pos()
        && arrange::topmost(&stage.sight.scene.cloths, stage.view.workspace(at)).is_none()
    {
        stage.look(Look::Fit);
    }
    let is_panning = stage.response.dragged_by(PointerButton::Middle);
    if is_panning {
        pan(ui, stage);
    }
    is_panning
}

/// Lets the ground follow the drag.
pub(crate) fn pan(ui: &Ui, stage: &Stage<'_>) {
    ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
    let by = stage.response.drag_delta();
    if by != Vec2::ZERO {
        let points_per_mm = stage.view.points_per_mm;
        let shift = Displacement::new(
            f64::from(by.x) / points_per_mm,
            -f64::from(by.y) / points_per_mm,
        );
        stage.look(Look::Centre(stage.view.centre - shift));
    }
}

fn take_wheel(ui: &Ui, stage: &Stage<'_>, commands: &mut Commands) {
    let (turned, scrolled, pinched, pointer) = ui.input(|input| {
        let is_turning = input.modifiers.alt;
        let notches = input.events.iter().filter_map(notches).sum::<f64>();
        let scrolled = input.smooth_scroll_delta().y;
        // Two fingers that feel hold two displays; they do not magnify.
        let feels = !stage.arranges() && input.multi_touch().is_some();
        (
            if is_turning { notches } else { 0.0 },
            if is_turning { 0.0 } else { scrolled },
            if feels { 1.0 } else { input.zoom_delta() },
            input.pointer.latest_pos(),
        )
    });
    if turned != 0.0 {
        commands.push(PlayCommand::Turn(NOTCH_DEG * turned).into());
    }
    let factor = f64::from(pinched * (scrolled / POINTS_PER_E).exp());
    if (factor - 1.0).abs() > 1e-6
        && let Some(at) = pointer
    {
        let place = stage.view.workspace(at);
        stage.look(Look::Zoom(factor, place));
    }
}

/// How far an event turns the wheel, in notches; up is positive.
fn notches(event: &Event) -> Option<f64> {
    let Event::MouseWheel { unit, delta, .. } = event else {
        return None;
    };
    // Some systems scroll sideways while Alt is held.
    let along = if delta.y == 0.0 { delta.x } else { delta.y };
    let points = match unit {
        MouseWheelUnit::Line => return Some(along.into()),
        MouseWheelUnit::Point => along,
        MouseWheelUnit::Page => return Some(f64::from(along.signum())),
    };
    Some(f64::from(points / POINTS_PER_NOTCH))
}
