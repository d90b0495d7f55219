//! From where the cloth is looked at: parallel projection, turned about its middle.

use eframe::egui::{Pos2, Rect, Vec2, pos2};

use selvedge_foundation::numerics::to_single;

/// Room around the cloth, mm.
const ROOM_MM: [f32; 2] = [56.0, 52.0];
/// Degrees that a point of dragging turns.
const DRAG_DEG: f32 = 0.4;

/// From where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Camera {
    /// To the right about the upright, degrees.
    yaw_deg: f32,
    /// From above, degrees.
    pitch_deg: f32,
    zoom: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            yaw_deg: -24.0,
            pitch_deg: 12.0,
            zoom: 1.0,
        }
    }
}

impl Camera {
    /// Turned by so many points of dragging.
    pub(crate) fn turned(self, by: Vec2) -> Self {
        Self {
            yaw_deg: (self.yaw_deg + DRAG_DEG * by.x).clamp(-180.0, 180.0),
            pitch_deg: (self.pitch_deg + DRAG_DEG * by.y).clamp(-80.0, 80.0),
            ..self
        }
    }

    /// Nearer by a factor.
    pub(crate) fn nearer(self, factor: f32) -> Self {
        Self {
            zoom: (self.zoom * factor).clamp(0.4, 10.0),
            ..self
        }
    }

    /// How a cloth of this size lies in a rectangle.
    pub(crate) fn sight(self, rect: Rect, size_mm: [f64; 2]) -> Sight {
        let [width, height] = size_mm.map(to_single);
        let across = rect.width() / (width + ROOM_MM[0]);
        let up = rect.height() / (height + ROOM_MM[1]);
        let (yaw, pitch) = (self.yaw_deg.to_radians(), self.pitch_deg.to_radians());
        Sight {
            centre: rect.center(),
            middle_mm: [0.5 * width, 0.5 * height],
            scale: across.min(up).max(0.05) * self.zoom,
            yaw: [yaw.cos(), yaw.sin()],
            pitch: [pitch.cos(), pitch.sin()],
        }
    }
}

/// A projection onto the screen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sight {
    centre: Pos2,
    middle_mm: [f32; 2],
    /// Points a mm.
    pub(crate) scale: f32,
    yaw: [f32; 2],
    pitch: [f32; 2],
}

impl Sight {
    /// A direction as the viewer has it: right, up, nearer.
    pub(crate) fn turned(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        let ([cos, sin], [level, rise]) = (self.yaw, self.pitch);
        let (right, near) = (x * cos + z * sin, z * cos - x * sin);
        [right, y * level - near * rise, near * level + y * rise]
    }

    /// Where a place in mm lies on the screen, and how near it is.
    pub(crate) fn at(&self, [x, y, z]: [f32; 3]) -> (Pos2, f32) {
        let [right, up, near] = self.turned([x - self.middle_mm[0], y - self.middle_mm[1], z]);
        let at = pos2(
            self.centre.x + self.scale * right,
            self.centre.y - self.scale * up,
        );
        (at, near)
    }

    /// The place of the rest plane below a place of the screen, mm; `None` where the plane is seen
    /// from its edge.
    pub(crate) fn on_plane(&self, at: Pos2) -> Option<[f64; 2]> {
        let off = (at - self.centre) / self.scale;
        let ([cos, sin], [level, rise]) = (self.yaw, self.pitch);
        if cos.abs() < 0.1 || level < 0.1 {
            return None;
        }
        let x = off.x / cos;
        // up = y level + x sin rise
        let y = (-off.y - x * sin * rise) / level;
        Some([x + self.middle_mm[0], y + self.middle_mm[1]].map(f64::from))
    }

    /// Whether the face is seen, rather than the back.
    pub(crate) fn sees_face(&self) -> bool {
        self.yaw[0] >= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_of_the_rest_plane_is_found_where_it_is_drawn() {
        let rect = Rect::from_min_max(pos2(10.0, 20.0), pos2(410.0, 320.0));
        for by in [Vec2::ZERO, Vec2::new(120.0, -60.0), Vec2::new(-260.0, 90.0)] {
            let sight = Camera::default()
                .turned(by)
                .nearer(1.7)
                .sight(rect, [200.0, 150.0]);
            for place in [[100.0, 75.0], [12.0, 140.0], [180.0, 3.0]] {
                let (at, _) = sight.at([place[0], place[1], 0.0].map(to_single));
                let found = sight.on_plane(at).unwrap();
                let off = [0, 1].map(|axis| (found[axis] - place[axis]).abs());
                assert!(off[0] < 1e-2 && off[1] < 1e-2, "{place:?} {found:?}");
            }
        }
        let edge_on = Camera::default().turned(Vec2::new(285.0, 0.0));
        assert!(
            edge_on
                .sight(rect, [200.0; 2])
                .on_plane(rect.center())
                .is_none()
        );
    }
}
