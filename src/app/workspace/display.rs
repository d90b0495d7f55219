//! The display: its contactors as green dots at their true places, and the trail behind it.
//!
//! A dot's size is A40 and its glow is A320, both on the dB scale of [`strength`]; outside every
//! textile a contactor is a ring.

use eframe::egui::{Color32, Mesh, Painter, Pos2, Shape, Stroke, pos2};

use super::ViewTransform;
use crate::app::theme::Palette;
use crate::app::view::Dot;
use crate::geometry::Point;

/// How long the trail is, s.
pub(crate) const TRAIL_S: f64 = 0.8;

/// Amplitude that is drawn with full size or glow, µm.
const FULL_UM: f64 = 50.0;
/// Range below it that can be told apart, dB.
const RANGE_DB: f64 = 48.0;
/// Corners of a glow.
const GLOW_CORNERS: u32 = 20;

/// How strongly an amplitude is drawn, 0…1: linear in dB, 0 at 48 dB below 50 µm.
fn strength(amplitude_um: f64) -> f32 {
    let share = 1.0 + 20.0 * (amplitude_um / FULL_UM).log10() / RANGE_DB;
    #[expect(clippy::cast_possible_truncation, reason = "between 0 and 1")]
    let share = share.clamp(0.0, 1.0).max(0.0) as f32;
    share
}

/// Draws every contactor.
pub(crate) fn paint(painter: &Painter, view: &ViewTransform, dots: &[Dot]) {
    let palette = Palette::of(painter.ctx().theme());
    // A pitch is 2 mm; a dot of full size nearly touches its neighbours.
    #[expect(clippy::cast_possible_truncation, reason = "the screen is drawn in single precision")]
    let scale = view.points_per_mm() as f32;
    let glow = palette.contactor;
    for dot in dots.iter().filter(|dot| dot.cloth.is_some()) {
        let strength = strength(dot.amplitude_um[1]);
        if strength > 0.0 {
            let radius = (1.0 + 1.3 * strength) * scale.max(2.4);
            painter.add(halo(view.screen(dot.position), radius, glow.gamma_multiply(0.55 * strength)));
        }
    }
    for dot in dots {
        let at = view.screen(dot.position);
        if dot.cloth.is_some() {
            let radius = (0.32 + 0.5 * strength(dot.amplitude_um[0])) * scale.max(2.4);
            painter.circle_filled(at, radius + 0.75, Color32::BLACK.gamma_multiply(0.55));
            painter.circle_filled(at, radius, palette.contactor);
        } else {
            let ring = Stroke::new(1.0, palette.contactor);
            painter.circle_stroke(at, 0.34 * scale.max(2.4), ring);
        }
    }
}

/// Draws where the display was: `(age in s, place)` from old to new.
pub(crate) fn paint_trail(painter: &Painter, view: &ViewTransform, trail: &[(f64, Point)]) {
    let palette = Palette::of(painter.ctx().theme());
    for pair in trail.windows(2) {
        #[expect(clippy::cast_possible_truncation, reason = "between 0 and 1")]
        let freshness = (1.0 - pair[0].0 / TRAIL_S).clamp(0.0, 1.0) as f32;
        let ink = palette.contactor.gamma_multiply(0.75 * freshness * freshness);
        let ends = [view.screen(pair[0].1), view.screen(pair[1].1)];
        painter.line_segment(ends, Stroke::new(1.0 + 2.0 * freshness, ink));
    }
}

/// A disc that fades from `colour` in the middle to nothing at its rim.
fn halo(centre: Pos2, radius: f32, colour: Color32) -> Shape {
    let mut mesh = Mesh::default();
    mesh.colored_vertex(centre, colour);
    for i in 0..GLOW_CORNERS {
        let (sin, cos) = (i as f32 / GLOW_CORNERS as f32 * std::f32::consts::TAU).sin_cos();
        mesh.colored_vertex(pos2(centre.x + radius * cos, centre.y + radius * sin), Color32::TRANSPARENT);
        mesh.add_triangle(0, 1 + i, 1 + (i + 1) % GLOW_CORNERS);
    }
    Shape::mesh(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn silence_is_not_drawn_and_full_scale_is_drawn_in_full() {
        assert_eq!(strength(0.0), 0.0);
        assert_eq!(strength(f64::NAN), 0.0);
        assert_eq!(strength(50.0), 1.0);
        assert!((strength(50.0 / 10.0_f64.powf(1.2)) - 0.5).abs() < 1e-6, "24 dB down");
    }
}
