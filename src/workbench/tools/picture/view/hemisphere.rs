//! Where light comes from, on a small hemisphere seen from above: dragged, or moved with the
//! arrow keys.

use eframe::egui::{Color32, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::kit::theme::Palette;
use crate::kit::widgets::slider::key_steps;
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;
use selvedge_textile::picture::shading::Light;

/// Its width, points.
pub(crate) const SIZE: f32 = 64.0;
/// The flattest light that can be dragged to, degrees from above.
const MOST_SLANT_DEG: f64 = 80.0;
/// Rings for every so many degrees of slant.
const RINGS_DEG: [f32; 2] = [30.0, 60.0];

/// Shows the hemisphere; says where the light was dragged to.
pub(crate) fn show(ui: &mut Ui, light: Light) -> Option<Light> {
    let (rect, response) = ui.allocate_exact_size(vec2(SIZE, SIZE), Sense::click_and_drag());
    let name = format!(
        "Light from {}° clockwise of the top, {}° from above",
        quantity::fixed(90.0 - light.tilt_deg, 0),
        quantity::fixed(light.slant_deg, 0)
    );
    response
        .widget_info(|| WidgetInfo::labeled(eframe::egui::Role::Slider, ui.is_enabled(), &name));
    let palette = Palette::in_ui(ui);
    let painter = ui.painter();
    let (centre, radius) = (rect.center(), 0.5 * SIZE - 4.0);
    // Seen from above, a direction stands as far out as the sine of its slant.
    for ring in 0..12_u8 {
        let share = 1.0 - f32::from(ring) / 12.0;
        painter.circle_filled(centre, radius * share, shade(palette, ring));
    }
    for slant_deg in RINGS_DEG {
        let ring = radius * slant_deg.to_radians().sin();
        painter.circle_stroke(centre, ring, Stroke::new(1.0, palette.hairline));
    }
    painter.circle_stroke(centre, radius, Stroke::new(1.0, palette.line));
    let [slant, tilt] = [light.slant_deg, light.tilt_deg].map(|deg| to_single(deg.to_radians()));
    let out = radius * slant.sin();
    let at = pos2(centre.x + out * tilt.cos(), centre.y - out * tilt.sin());
    painter.line_segment([centre, at], Stroke::new(1.0, palette.line));
    let ink = if response.has_focus() {
        palette.selection
    } else {
        palette.rim
    };
    painter.circle_filled(at, 5.0, palette.text);
    painter.circle_stroke(at, 6.0, Stroke::new(1.0, ink));
    let steps = key_steps(ui, &response);
    if steps != 0 {
        let tilt_deg = light.tilt_deg + 5.0 * f64::from(steps);
        return Some(Light {
            tilt_deg: (tilt_deg + 180.0).rem_euclid(360.0) - 180.0,
            ..light
        });
    }
    let pointer = response
        .interact_pointer_pos()
        .filter(|_| response.is_pointer_button_down_on())?;
    let off = (pointer - centre) / radius;
    let slant_deg = f64::from(off.length().min(1.0)).asin().to_degrees();
    Some(Light {
        slant_deg: slant_deg.min(MOST_SLANT_DEG).round(),
        tilt_deg: f64::from(-off.y)
            .atan2(f64::from(off.x))
            .to_degrees()
            .round(),
    })
}

fn shade(palette: &Palette, ring: u8) -> Color32 {
    palette
        .raised
        .lerp_to_gamma(palette.hovered, f32::from(ring) / 12.0)
}
