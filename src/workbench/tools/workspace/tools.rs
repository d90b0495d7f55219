//! Tools and magnification, for the row above the workspace; and the quiet strip beside the chosen
//! textile, with what can be done with it.

use eframe::egui::{
    Align, Button, Layout, Rect, RichText, Role, Sense, Stroke, StrokeKind, Ui, UiBuilder, Vec2,
    WidgetInfo, pos2, vec2,
};

use crate::bench::command::edit::Edit;
use crate::bench::command::{Command, Commands, Look, ShowCommand, Tool};
use crate::kit::theme;
use crate::kit::theme::{Palette, ROW, STEP};
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::camera::Camera;
use crate::tools::workspace::overlay::BUTTON;
use crate::tools::workspace::stage::Stage;
use crate::tools::workspace::state::{Place, WorkspaceView};
use crate::tools::workspace::{arrange, overlay};
use selvedge_foundation::quantity;

/// Space around what lies on a strip, points.
const PADDING: f32 = STEP;
/// Space between a strip and the edge of the ground, points.
const AWAY: f32 = 2.0 * STEP;
/// Width of the buttons Fit and 1:1, points.
const SMALL_BUTTON: f32 = 32.0;
/// Size of the strip beside the chosen textile, points.
const BESIDE: Vec2 = vec2(126.0, ROW + 2.0 * PADDING);

/// What a strip asks for when a button on it is pressed.
type Asked = Vec<Command>;

/// Shows tools and magnification in one row, from right to left. `pane` is where the workspace was
/// drawn last.
pub(crate) fn show(
    ui: &mut Ui,
    state: &mut WorkspaceView,
    (pane, size_mm): (Rect, [f64; 2]),
    displays: (usize, usize),
    commands: &mut Commands,
) {
    ui.spacing_mut().item_spacing.x = STEP;
    ui.spacing_mut().button_padding = vec2(2.0 * STEP, 0.0);
    let place = Place {
        pane,
        size_mm,
        pixels_per_point: ui.ctx().pixels_per_point(),
    };
    let view = state.camera.view(pane, size_mm);
    show_magnification(ui, state, &view, place);
    ui.add_space(2.0 * STEP);
    let size = vec2(60.0, BUTTON);
    for (tool, name, what) in [
        (
            Tool::Arrange,
            "Arrange",
            "The pointer moves, turns and resizes textiles",
        ),
        (Tool::Feel, "Feel", "The pointer feels the textiles"),
    ] {
        let command: Command = ShowCommand::Tool(tool).into();
        if offered(ui, size, (name, state.tool == tool), what, &command) {
            state.tool = tool;
        }
    }
    ui.add_space(2.0 * STEP);
    overlay::show_menu(ui, &mut state.overlays, view.points_per_mm);
    show_displays(ui, displays, commands);
}

/// Shows which of the scene's displays the panes look at, if it has more than one.
fn show_displays(ui: &mut Ui, (display, n_displays): (usize, usize), commands: &mut Commands) {
    if n_displays < 2 {
        return;
    }
    ui.add_space(2.0 * STEP);
    let name = format!("Display {} of {n_displays}", display + 1);
    let what = "The display that all panes look at; a second finger holds the second display";
    let command: Command = ShowCommand::NextDisplay.into();
    if offered(ui, vec2(104.0, BUTTON), (&name, false), what, &command) {
        commands.push(command);
    }
}

/// Shows the magnification, from right to left.
fn show_magnification(ui: &mut Ui, state: &mut WorkspaceView, view: &ViewTransform, place: Place) {
    let pixels_per_point = place.pixels_per_point;
    let is_true = state.is_true_size(view, pixels_per_point);
    let is_fit = state.camera == Camera::Fit;
    let true_size = match state.true_pixels_per_mm {
        Some(_) => "True size: a millimetre is a millimetre on the screen",
        None => "True size; asks you to measure the screen first",
    };
    let size = vec2(SMALL_BUTTON, BUTTON);
    for (look, name, is_chosen, what) in [
        (Look::TrueSize, "1:1", is_true, true_size),
        (Look::Fit, "Fit", is_fit, "Show all of the workspace"),
    ] {
        let command: Command = ShowCommand::Look(look).into();
        if offered(ui, size, (name, is_chosen), what, &command) {
            state.look(look, place);
        }
    }
    let pixels_per_mm = view.points_per_mm * f64::from(pixels_per_point);
    let palette = Palette::in_ui(ui);
    let text = RichText::new(magnification(pixels_per_mm, is_true));
    let label = ui.label(text.font(theme::small_number()).color(palette.dim));
    label.on_hover_text("Physical pixels of the screen per millimetre; the wheel zooms");
}

/// How the magnification is written: `2.1 px/mm`, or `1:1` at true size.
fn magnification(pixels_per_mm: f64, is_true: bool) -> String {
    if is_true {
        return "1:1".to_owned();
    }
    let decimals = usize::from(pixels_per_mm < 99.95);
    quantity::with_unit(pixels_per_mm, decimals, "px/mm")
}

/// Shows what can be done with the chosen textile, beside it.
pub(crate) fn show_beside_selection(ui: &mut Ui, stage: &Stage<'_>, commands: &mut Commands) {
    let Some((index, cloth)) = stage.selected() else {
        return;
    };
    let bounds = arrange::screen_bounds(&stage.view, cloth);
    let room = stage.ground.shrink(AWAY);
    if !room.intersects(bounds) || room.width() < BESIDE.x || room.height() < 4.0 * BESIDE.y {
        return;
    }
    let corner = pos2(bounds.right() - BESIDE.x, bounds.bottom() + AWAY);
    let corner = corner.clamp(room.min, room.max - BESIDE);
    let top = stage.sight.scene.cloths.len().saturating_sub(1);
    let rect = Rect::from_min_size(corner, BESIDE);
    show_strip(ui, rect, "Chosen textile", |ui| {
        ui.horizontal(|ui| {
            let size = vec2(0.5 * (ui.available_width() - STEP), ROW);
            let raise: Command = Edit::RaiseCloth(index).into();
            let is_on_top = index == top;
            ui.add_enabled_ui(!is_on_top, |ui| {
                let what = "Lay it on top of the others";
                if offered(ui, size, ("Raise", false), what, &raise) {
                    commands.extend(raising(index, top));
                }
            });
            let remove: Command = Edit::RemoveCloth(index).into();
            let what = "Take it out of the scene";
            if offered(ui, size, ("Remove", false), what, &remove) {
                commands.extend(removing(index));
            }
        });
    });
}

/// Lays a textile on top; it stays chosen, at its new place in the list.
pub(crate) fn raising(index: usize, top: usize) -> Asked {
    vec![
        Edit::RaiseCloth(index).into(),
        ShowCommand::SelectCloth(Some(top)).into(),
    ]
}

/// Takes a textile away; none is chosen then.
pub(crate) fn removing(index: usize) -> Asked {
    vec![
        Edit::RemoveCloth(index).into(),
        ShowCommand::SelectCloth(None).into(),
    ]
}

/// What a button does, with its key.
pub(crate) fn tip(ui: &Ui, what: &str, command: &Command) -> String {
    match crate::bench::keys::hint(ui.ctx(), command) {
        key if key.is_empty() => what.to_owned(),
        key => format!("{what} ({key})"),
    }
}

/// A flat button that offers a command; bright when it is chosen.
fn offered(
    ui: &mut Ui,
    size: Vec2,
    (name, is_chosen): (&str, bool),
    what: &str,
    command: &Command,
) -> bool {
    let palette = Palette::in_ui(ui);
    let ink = if is_chosen { palette.text } else { palette.dim };
    let font = if size.y < ROW {
        theme::small()
    } else {
        theme::body()
    };
    let button =
        Button::selectable(is_chosen, RichText::new(name).font(font).color(ink)).min_size(size);
    let response = ui.add(button);
    let refusal = "It lies on top already";
    let tip = tip(ui, what, command);
    response
        .on_hover_text(tip)
        .on_disabled_hover_text(refusal)
        .clicked()
}

/// A strip that lies on the ground and keeps the pointer from it. Says whether the pointer is on
/// it.
fn show_strip(ui: &mut Ui, rect: Rect, name: &str, content: impl FnOnce(&mut Ui)) -> bool {
    let palette = Palette::in_ui(ui);
    let response = ui.interact(rect, ui.scope_id().with(name), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Toolbar, true, name));
    ui.painter().rect_filled(rect, 6, palette.panel);
    let edge = Stroke::new(1.0, palette.hairline);
    ui.painter().rect_stroke(rect, 6, edge, StrokeKind::Inside);
    let inside = UiBuilder::new()
        .id_salt(name)
        .max_rect(rect.shrink(PADDING))
        .layout(Layout::top_down(Align::Min));
    let mut ui = ui.new_child(inside);
    ui.spacing_mut().item_spacing = vec2(STEP, STEP);
    ui.spacing_mut().button_padding = vec2(STEP, 0.0);
    content(&mut ui);
    response.contains_pointer()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_magnification_is_short() {
        assert_eq!(magnification(2.184, false), "2.2 px/mm");
        assert_eq!(magnification(399.7, false), "400 px/mm");
        assert_eq!(magnification(3.78, true), "1:1");
    }
}
