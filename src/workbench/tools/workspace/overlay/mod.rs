//! What can be drawn over the cloth: points 1 mm apart, what the contactors read, how they move,
//! and maps of what a textile would give. Each can be switched; none computes anything while off.

pub(crate) mod lattice;
pub(crate) mod map;
pub(crate) mod motion;

pub(crate) use crate::tools::workspace::overlay::map::paint_legend;
pub(crate) use crate::tools::workspace::overlay::map::words_at;
pub(crate) use crate::tools::workspace::overlay::motion::paint_readings;
pub(crate) use crate::tools::workspace::overlay::motion::paint_velocities;

use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, Painter, PopupCloseBehavior, Ui, vec2};

use crate::bench::command::ShowCommand;
use crate::bench::keys::hint;
use crate::bench::overlays::{Overlay, Overlays};
use crate::bench::view::Cloth;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::kit::widgets::text::{quiet, small, tick_box};
use crate::tools::workspace::stage::Stage;

/// Height of the buttons in the row of tabs, points.
pub(crate) const BUTTON: f32 = 18.0;

/// Draws what lies on a textile, below the contactors.
pub(crate) fn paint_on_cloth(
    painter: &Painter,
    view: &ViewTransform,
    stage: &Stage<'_>,
    (index, cloth): (usize, &Cloth),
) {
    let overlays = stage.state.overlays;
    if overlays.map.is_some()
        && let Some(picture) = stage.sight.layers.maps.picture(index)
    {
        map::paint(painter, view, cloth, picture);
    }
    if overlays.shows(Overlay::Points) {
        stage.sight.layers.lattice.paint(painter, view, cloth);
    }
}

/// The quiet menu in the row of tools.
pub(crate) fn show_menu(ui: &mut Ui, overlays: &mut Overlays, points_per_mm: f64) {
    let palette = Palette::in_ui(ui);
    let is_any = *overlays != Overlays::default();
    let ink = if is_any { palette.text } else { palette.dim };
    let text = small("Overlay", ink);
    let button = Button::selectable(is_any, text).min_size(vec2(56.0, BUTTON));
    let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let shown = *overlays;
    let (response, _) = MenuButton::from_button(button).config(stays).ui(ui, |ui| {
        ui.set_min_width(230.0);
        for (overlay, label) in Overlays::ALL {
            let key = hint(ui.ctx(), &ShowCommand::Overlay(overlay).into());
            if tick_box(ui, label, shown.shows(overlay), key) {
                *overlays = overlays.toggled(overlay);
            }
            if overlay == Overlay::Points && shown.shows(Overlay::Points) {
                show_hint(ui, points_per_mm);
            }
        }
        let words = "Maps are after gains, at the velocity chosen in the Response pane";
        ui.label(quiet(words));
    });
    response.on_hover_text("What is drawn over the cloth: points, readings, velocities, maps");
}

/// Says why the points are not to be seen.
fn show_hint(ui: &mut Ui, points_per_mm: f64) {
    if !lattice::has_room(points_per_mm) {
        ui.label(quiet("Come closer: there are less than 6 pixels to a mm"));
    }
}
