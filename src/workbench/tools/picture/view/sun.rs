//! The sun over the photograph: where light comes from, dragged, or moved with the arrow keys.

use eframe::egui::{Color32, CursorIcon, Pos2, Rect, Sense, Stroke, Ui, Vec2, WidgetInfo, vec2};

use crate::kit::theme::Palette;
use crate::kit::widgets::slider::key_steps;
use crate::tools::picture::view::frame::line;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;
use selvedge_textile::picture::shading::Light;

/// Half of its disc, with its rays, points.
const DISC: f32 = 5.0;
const RAYS: f32 = 10.0;
const N_RAYS: u8 = 8;
/// The flattest light that can be dragged to, degrees from above.
const MOST_SLANT_DEG: f64 = 80.0;
/// How far a key moves the tilt, degrees.
const KEY_DEG: f64 = 5.0;

/// Shows the light over a picture that is drawn in `rect`, as on a hemisphere seen from above: as
/// far from the middle as the sine of its slant. Says where it was dragged to.
pub(crate) fn show(ui: &Ui, rect: Rect, light: Light) -> Option<Light> {
    let radius = 0.5 * rect.size().min_elem() - RAYS;
    let [slant, tilt] = [light.slant_deg, light.tilt_deg].map(|deg| to_single(deg.to_radians()));
    let at = rect.center() + radius * slant.sin() * vec2(tilt.cos(), -tilt.sin());
    let grip = Rect::from_center_size(at, Vec2::splat(2.0 * RAYS));
    let response = ui.interact(grip, ui.scope_id().with("sun"), Sense::click_and_drag());
    let name = format!(
        "Light from {}° clockwise of the top, {}° from above",
        quantity::fixed(90.0 - light.tilt_deg, 0),
        quantity::fixed(light.slant_deg, 0)
    );
    response
        .widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Slider, ui.is_enabled(), &name));
    line(ui, [rect.center(), at]);
    paint(ui, at, response.has_focus());
    let steps = key_steps(ui, &response);
    let response = response
        .on_hover_cursor(CursorIcon::Grab)
        .on_hover_text(name);
    if steps != 0 {
        return Some(light.turned(KEY_DEG * f64::from(steps)));
    }
    let pointer = response
        .interact_pointer_pos()
        .filter(|_| response.dragged())?;
    let off = (pointer - rect.center()) / radius;
    let slant_deg = f64::from(off.length().min(1.0)).asin().to_degrees();
    Some(Light {
        slant_deg: slant_deg.min(MOST_SLANT_DEG).round(),
        tilt_deg: f64::from(-off.y)
            .atan2(f64::from(off.x))
            .to_degrees()
            .round(),
    })
}

/// A disc with rays that shows on every cloth: dark around light.
fn paint(ui: &Ui, at: Pos2, has_focus: bool) {
    let palette = Palette::in_ui(ui);
    for ray in 0..N_RAYS {
        let way = Vec2::angled(std::f32::consts::TAU * f32::from(ray) / f32::from(N_RAYS));
        line(ui, [at + 0.75 * RAYS * way, at + RAYS * way]);
    }
    let ink = if has_focus {
        palette.selection
    } else {
        palette.rim
    };
    ui.painter().circle_filled(at, DISC, Color32::WHITE);
    ui.painter()
        .circle_stroke(at, DISC + 1.0, Stroke::new(1.0, ink));
}
