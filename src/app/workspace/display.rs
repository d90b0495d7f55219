//! The display: its contactors as green dots at their true places, and the trail behind it.
//!
//! A dot's size is A40 and its glow is A320, both on the scale of the heatmaps; outside every
//! textile a contactor is a ring.

use eframe::egui::{Color32, Mesh, Painter, Pos2, Shape, Stroke, pos2};

use super::ViewTransform;
use crate::app::amplitude::AmplitudeScale;
use crate::app::theme::Palette;
use crate::app::view::Dot;
use crate::geometry::Point;

/// How long the trail is, s.
pub(crate) const TRAIL_S: f64 = 0.8;

/// Corners of a glow.
const GLOW_CORNERS: u32 = 20;

/// How strongly an amplitude is drawn, 0…1.
#[expect(
    clippy::cast_possible_truncation,
    reason = "between 0 and 1, for the screen"
)]
fn strength(amplitude_um: f64) -> f32 {
    AmplitudeScale::default().share(amplitude_um) as f32
}

/// Draws every contactor.
pub(crate) fn paint(painter: &Painter, view: &ViewTransform, dots: &[Dot]) {
    let palette = Palette::of(painter.ctx().theme());
    // A pitch is 2 mm; a dot of full size nearly touches its neighbours.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the screen is drawn in single precision"
    )]
    let scale = view.points_per_mm() as f32;
    let glow = palette.lit;
    for dot in dots.iter().filter(|dot| dot.cloth.is_some()) {
        let strength = strength(dot.amplitude_um[1]);
        if strength > 0.0 {
            let radius = (1.0 + 1.3 * strength) * scale.max(2.4);
            painter.add(halo(
                view.screen(dot.position),
                radius,
                glow.gamma_multiply(0.55 * strength),
            ));
        }
    }
    for dot in dots {
        let at = view.screen(dot.position);
        if dot.cloth.is_some() {
            let radius = (0.26 + 0.62 * strength(dot.amplitude_um[0])) * scale.max(2.4);
            painter.circle_filled(at, radius + 0.75, palette.rim);
            painter.circle_filled(at, radius, palette.lit);
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
        let fading = freshness * freshness;
        let ink = palette.lit.gamma_multiply(0.85 * fading);
        let rim = palette.rim.gamma_multiply(0.5 * fading);
        let ends = [view.screen(pair[0].1), view.screen(pair[1].1)];
        painter.line_segment(ends, Stroke::new(2.5 + 2.0 * freshness, rim));
        painter.line_segment(ends, Stroke::new(1.0 + 2.0 * freshness, ink));
    }
}

/// A disc that fades from `colour` in the middle to nothing at its rim.
fn halo(centre: Pos2, radius: f32, colour: Color32) -> Shape {
    let mut mesh = Mesh::default();
    mesh.colored_vertex(centre, colour);
    for i in 0..GLOW_CORNERS {
        let (sin, cos) = (i as f32 / GLOW_CORNERS as f32 * std::f32::consts::TAU).sin_cos();
        mesh.colored_vertex(
            pos2(centre.x + radius * cos, centre.y + radius * sin),
            Color32::TRANSPARENT,
        );
        mesh.add_triangle(0, 1 + i, 1 + (i + 1) % GLOW_CORNERS);
    }
    Shape::mesh(mesh)
}
