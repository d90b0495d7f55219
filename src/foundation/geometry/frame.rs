//! A frame of reference: an origin and a turn, seen from its parent.
//!
//! Names say which way a frame is read: `workspace_from_textile.point(p)` takes textile
//! coordinates to workspace coordinates, `…into_point(p)` the other way.

use super::{Point, Rotation};

/// A frame whose origin and axes are given in its parent's coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame {
    /// Where the frame's origin lies in the parent, mm.
    pub origin: Point,
    /// How the frame's axes are turned against the parent's.
    pub rotation: Rotation,
}

impl Frame {
    /// The parent's coordinates of a point given in this frame.
    pub fn point(&self, local: Point) -> Point {
        self.origin + self.rotation.turn(local - Point::default())
    }

    /// This frame's coordinates of a point given in the parent.
    pub fn into_point(&self, parent: Point) -> Point {
        Point::default() + self.rotation.inverse().turn(parent - self.origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn into_and_back_is_the_same_place() {
        let frame = Frame {
            origin: Point::new(20.0, -3.0),
            rotation: Rotation::from_degrees(30.0),
        };
        let there = Point::new(7.0, 11.0);
        let back = frame.point(frame.into_point(there));
        assert!((back - there).length_mm() < 1e-13, "{back:?}");
    }
}
