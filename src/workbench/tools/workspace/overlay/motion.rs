//! What every contactor reads, and how it moves: lines to the points, arrows along the velocities.
//!
//! Everything comes from the inspector's readings, which are those of the renderer. Warp is bright
//! and weft dim, forward solid and reverse dashed.

use eframe::egui::{Color32, Painter, Pos2, Shape, Stroke, Vec2, vec2};
use selvedge_foundation::numerics::to_single;

use crate::bench::overlays::Overlay;
use crate::kit::theme::Palette;
use crate::kit::view_transform::ViewTransform;
use crate::tools::workspace::stage::Stage;
use selvedge_foundation::geometry::{Displacement, Rotation, Velocity};
use selvedge_render::array::{ContactorReading, Reading};
use selvedge_textile::surface::Direction;

/// Points nearer to their contactors than this on the screen are left out, points a millimetre.
const LEAST_FOR_POINTS: f32 = 6.0;
/// An arrow is as long as the way of one tick: where its tip is, the contactor is next.
const TICK_S: f64 = 0.025;
/// From a contactor to the marks of its directions, mm.
const MARK_MM: f64 = 0.9;
/// Arrows shorter than this are left out, points.
const LEAST_ARROW: f32 = 3.0;

/// Draws how the contactors move, below them.
pub(crate) fn paint_velocities(painter: &Painter, view: &ViewTransform, stage: &Stage<'_>) {
    if !stage.state.overlays.shows(Overlay::Motion) {
        return;
    }
    for_each_in_sight((painter, view), stage, |brush, moving, _| {
        brush.velocity(view.screen(moving.position), moving.velocity);
    });
}

/// Draws what the contactors read, over them: the directions in use, and, where there is room, the
/// points.
pub(crate) fn paint_readings(painter: &Painter, view: &ViewTransform, stage: &Stage<'_>) {
    let overlays = stage.state.overlays;
    let has_room = view.length(1.0) >= LEAST_FOR_POINTS;
    let has_points = has_room && overlays.shows(Overlay::ChosenPoints);
    let has_directions = overlays.shows(Overlay::Motion);
    if !(has_points || has_directions) {
        return;
    }
    for_each_in_sight((painter, view), stage, |brush, moving, axes| {
        let Some((reading, turn)) = axes else {
            return;
        };
        if has_directions {
            brush.components(view.screen(moving.position), reading, turn);
        }
        if has_points {
            brush.points(moving, reading, turn);
        }
    });
}

/// Does something for every contactor in sight, with what it reads and how that textile is turned.
fn for_each_in_sight(
    (painter, view): (&Painter, &ViewTransform),
    stage: &Stage<'_>,
    act: impl Fn(&Brush<'_>, &ContactorReading, Option<(Reading, Rotation)>),
) {
    let sight = painter.clip_rect().expand(view.length(3.0));
    for (contactor, moving) in stage.sight.layers.readings.iter().enumerate() {
        if !sight.contains(view.screen(moving.position)) {
            continue;
        }
        let brush = Brush {
            painter,
            palette: Palette::of(painter.ctx().theme()),
            view,
            is_chosen: stage.sight.selection.contactor == Some(contactor),
        };
        let axes = moving.reading.and_then(|reading| {
            let cloth = stage.sight.scene.cloths.get(reading.textile)?;
            Some((reading, cloth.workspace_from_textile.rotation))
        });
        act(&brush, moving, axes);
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
    /// The contactors' green; white for the chosen one.
    fn ink(&self) -> Color32 {
        if self.is_chosen {
            self.palette.selection
        } else {
            self.palette.lit
        }
    }

    /// The points that it reads: along warp and weft a line to each that is felt, and where both
    /// meet a ring; told apart from cloth of any brightness, as the ring of the chosen one is.
    fn points(&self, moving: &ContactorReading, reading: Reading, turn: Rotation) {
        let at = self.view.screen(moving.position);
        let off = [0, 1].map(|axis| reading.nearest_mm[axis] - reading.place_mm[axis]);
        let turned = |u_mm: f64, w_mm: f64| {
            let by = turn.turn(Displacement::new(u_mm, w_mm));
            self.view.screen(moving.position + by)
        };
        let (radius, width) = if self.is_chosen {
            (3.5, 1.5)
        } else {
            (2.0, 1.0)
        };
        let strokes = [
            Stroke::new(width + 1.5, self.palette.tag),
            Stroke::new(width, self.palette.selection),
        ];
        let ends = [turned(off[0], 0.0), turned(0.0, off[1])];
        let middle = turned(off[0], off[1]);
        for stroke in strokes {
            for (end, direction) in ends.into_iter().zip(reading.directions) {
                if direction.is_some() {
                    self.painter.line_segment([at, end], stroke);
                }
            }
            self.painter.circle_stroke(middle, radius, stroke);
        }
    }

    /// The directions along warp and weft that are in use: small triangles beside the contactor;
    /// for the chosen one, what of the velocity is felt along each.
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
            if !self.is_chosen {
                self.mark(at, along, ink);
            } else if along.length() >= LEAST_ARROW {
                self.component(at, along, (direction, ink));
            }
        }
    }

    fn mark(&self, at: Pos2, along: Vec2, ink: Color32) {
        let distance = self.view.length(MARK_MM);
        if distance >= LEAST_ARROW {
            let out = along.normalized();
            self.head(at + distance * out, 7.0 * out, self.palette.rim);
            self.head(at + distance * out, 5.0 * out, ink);
        }
    }

    fn component(&self, at: Pos2, along: Vec2, (direction, ink): (Direction, Color32)) {
        let ends = [at, at + along];
        if direction.is_reverse() {
            let rim = Stroke::new(2.5, self.palette.rim);
            self.painter.line_segment(ends, rim);
            let dashes = Shape::dashed_line(&ends, Stroke::new(1.0, ink), 3.0, 2.0);
            self.painter.extend(dashes);
        } else {
            self.line(ends, 1.0, ink);
        }
        self.head(ends[1], along, ink);
    }

    fn velocity(&self, at: Pos2, velocity: Velocity) {
        let along = self.way(velocity);
        if along.length() < LEAST_ARROW {
            return;
        }
        let ink = self.ink();
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
        let size = (0.8 * along.length()).clamp(2.5, 6.0);
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
pub(crate) fn on_screen(velocity: Velocity) -> Vec2 {
    let [x, y] = [velocity.x_mm_per_s, -velocity.y_mm_per_s].map(to_single);
    vec2(x, y)
}
