//! What every contactor reads, and how it moves: lines to the points, arrows along the velocities.
//!
//! Everything comes from the inspector's readings, which are those of the renderer. Warp is bright
//! and weft dim, forward solid and reverse dashed, as in the spatial spectra.

use eframe::egui::{Color32, Painter, Pos2, Shape, Stroke, Vec2, vec2};

use super::super::{Stage, ViewTransform};
use crate::app::command::Overlay;
use crate::app::theme::Palette;
use crate::geometry::{Point, Rotation, Velocity};
use crate::render::array::{ContactorReading, Reading};

/// Points nearer to their contactors than this on the screen are left out, points a millimetre.
const LEAST_FOR_POINTS: f32 = 6.0;
/// An arrow is as long as the way of one tick: where its tip is, the contactor is next.
const TICK_S: f64 = 0.025;
/// Arrows shorter than this are left out, points.
const LEAST_ARROW: f32 = 3.0;

/// Draws what is switched on, over the contactors.
pub(crate) fn paint(painter: &Painter, view: &ViewTransform, stage: &Stage<'_>) {
    let overlays = stage.state.overlays;
    let palette = Palette::of(painter.ctx().theme());
    let sight = painter.clip_rect().expand(view.length(3.0));
    let has_points = view.length(1.0) >= LEAST_FOR_POINTS;
    for (contactor, moving) in stage.layers.readings.iter().enumerate() {
        let at = view.screen(moving.position);
        if !sight.contains(at) {
            continue;
        }
        let brush = Brush {
            painter,
            palette,
            view,
            is_chosen: stage.state.contactor == Some(contactor),
        };
        let axes = moving.reading.and_then(|reading| {
            let cloth = stage.scene.cloths.get(reading.textile)?;
            Some((reading, cloth.workspace_from_textile.rotation))
        });
        if let Some((reading, turn)) = axes.filter(|_| has_points)
            && overlays.shows(Overlay::ChosenPoints)
        {
            brush.points(moving, reading, turn);
        }
        if overlays.shows(Overlay::Motion) {
            if let Some((reading, turn)) = axes {
                brush.components(at, reading, turn);
            }
            brush.velocity(at, moving.velocity);
        }
    }
}

/// What one contactor is drawn with.
struct Brush<'a> {
    painter: &'a Painter,
    palette: &'static Palette,
    view: &'a ViewTransform,
    is_chosen: bool,
}

impl Brush<'_> {
    /// The points that it reads: along warp and weft a line to each that is felt, and where both
    /// meet a ring.
    fn points(&self, moving: &ContactorReading, reading: Reading, turn: Rotation) {
        let at = self.view.screen(moving.position);
        let off = [0, 1].map(|axis| reading.nearest_mm[axis] - reading.place_mm[axis]);
        let ink = if self.is_chosen {
            self.palette.selection
        } else {
            self.palette.lit
        };
        let turned = |u_mm: f64, w_mm: f64| {
            let by = turn.turn(crate::geometry::Displacement::new(u_mm, w_mm));
            self.view.screen(moving.position + by)
        };
        let ends = [turned(off[0], 0.0), turned(0.0, off[1])];
        for (end, direction) in ends.into_iter().zip(reading.directions) {
            if direction.is_some() {
                self.line([at, end], 1.0, ink);
            }
        }
        let middle = turned(off[0], off[1]);
        let radius = if self.is_chosen { 3.5 } else { 2.0 };
        let rim = Stroke::new(2.5, self.palette.rim);
        self.painter.circle_stroke(middle, radius, rim);
        let width = if self.is_chosen { 1.5 } else { 1.0 };
        self.painter
            .circle_stroke(middle, radius, Stroke::new(width, ink));
    }

    /// What of the velocity is felt along warp and weft: the directions that are in use.
    fn components(&self, at: Pos2, reading: Reading, turn: Rotation) {
        let [along_warp, along_weft] = reading.velocity_mm_per_s;
        let parts = [
            (Velocity::new(along_warp, 0.0), self.palette.text),
            (Velocity::new(0.0, along_weft), self.palette.dim),
        ];
        for ((velocity, ink), direction) in parts.into_iter().zip(reading.directions) {
            let Some(direction) = direction else {
                continue;
            };
            let along = self.way(turn.turn_velocity(velocity));
            if along.length() < LEAST_ARROW {
                continue;
            }
            let ends = [at, at + along];
            if direction.is_reverse() {
                let rim = Stroke::new(2.5, self.palette.rim);
                self.painter.line_segment(ends, rim);
                let stroke = Stroke::new(1.0, ink);
                self.painter
                    .extend(Shape::dashed_line(&ends, stroke, 3.0, 2.0));
            } else {
                self.line(ends, 1.0, ink);
            }
            self.head(ends[1], along, ink);
        }
    }

    fn velocity(&self, at: Pos2, velocity: Velocity) {
        let along = self.way(velocity);
        if along.length() < LEAST_ARROW {
            return;
        }
        let ink = if self.is_chosen {
            self.palette.selection
        } else {
            self.palette.lit
        };
        self.line([at, at + along], 1.5, ink);
        self.head(at + along, along, ink);
    }

    /// The way of one tick on the screen, points.
    fn way(&self, velocity: Velocity) -> Vec2 {
        let way_mm = TICK_S * velocity.speed_mm_per_s();
        on_screen(velocity).normalized() * self.view.length(way_mm)
    }

    /// A line with a rim that tells it from any cloth.
    fn line(&self, ends: [Pos2; 2], width: f32, ink: Color32) {
        let rim = Stroke::new(width + 1.5, self.palette.rim);
        self.painter.line_segment(ends, rim);
        self.painter.line_segment(ends, Stroke::new(width, ink));
    }

    /// The tip of an arrow.
    fn head(&self, tip: Pos2, along: Vec2, ink: Color32) {
        let size = (0.4 * along.length()).clamp(2.5, 5.0);
        let back = along.normalized() * size;
        let across = 0.5 * back.rot90();
        let corners = vec![
            tip + 0.4 * back,
            tip - 0.6 * back + across,
            tip - 0.6 * back - across,
        ];
        let shape = Shape::convex_polygon(corners, ink, Stroke::NONE);
        self.painter.add(shape);
    }
}

/// A velocity's direction on the screen, where y points down; its length means nothing.
pub(super) fn on_screen(velocity: Velocity) -> Vec2 {
    let tip = Point::new(velocity.x_mm_per_s, velocity.y_mm_per_s);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the screen is drawn in single precision"
    )]
    let [x, y] = [tip.x_mm as f32, -tip.y_mm as f32];
    vec2(x, y)
}
