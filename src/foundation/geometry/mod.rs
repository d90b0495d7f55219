//! Points, displacements, velocities and frames of reference in the plane.
//!
//! Everything above speaks of places in millimetres and turns by [`Rotation`]; this floor knows
//! nothing of textiles, displays or time beyond "per second".
//!
//! # Invariants
//! - no allocation, no I/O, no clock
//! - a place ([`Point`]) and a difference of places ([`Displacement`]) are different types
//! - turning by a multiple of 90° is exact

mod frame;
mod rotation;

pub use frame::Frame;
pub use rotation::Rotation;

use serde::{Deserialize, Serialize};

/// A place in mm; x to the right, y up.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Point {
    /// To the right, mm.
    pub x_mm: f64,
    /// Up, mm.
    pub y_mm: f64,
}

/// A difference of two places in mm.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Displacement {
    /// To the right, mm.
    pub x_mm: f64,
    /// Up, mm.
    pub y_mm: f64,
}

/// A velocity in mm/s.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Velocity {
    /// To the right, mm/s.
    pub x_mm_per_s: f64,
    /// Up, mm/s.
    pub y_mm_per_s: f64,
}

impl Point {
    /// The place (x, y), mm.
    pub const fn new(x_mm: f64, y_mm: f64) -> Self {
        Self { x_mm, y_mm }
    }

    /// Whether both coordinates are finite.
    pub fn is_finite(self) -> bool {
        self.x_mm.is_finite() && self.y_mm.is_finite()
    }

    /// The place a share `s` of the way to `end`: `a + (b − a)·s`.
    #[must_use]
    pub fn toward(self, end: Self, s: f64) -> Self {
        Self::new(
            self.x_mm + (end.x_mm - self.x_mm) * s,
            self.y_mm + (end.y_mm - self.y_mm) * s,
        )
    }
}

impl Displacement {
    /// The difference (x, y), mm.
    pub const fn new(x_mm: f64, y_mm: f64) -> Self {
        Self { x_mm, y_mm }
    }

    /// Its length, mm.
    pub fn length_mm(self) -> f64 {
        self.x_mm.hypot(self.y_mm)
    }

    /// The velocity that covers this difference in `duration_s` seconds.
    pub fn per(self, duration_s: f64) -> Velocity {
        Velocity::new(self.x_mm / duration_s, self.y_mm / duration_s)
    }
}

impl Velocity {
    /// At rest.
    pub const ZERO: Self = Self::new(0.0, 0.0);

    /// The velocity (x, y), mm/s.
    pub const fn new(x_mm_per_s: f64, y_mm_per_s: f64) -> Self {
        Self {
            x_mm_per_s,
            y_mm_per_s,
        }
    }

    /// Its magnitude, mm/s.
    pub fn speed_mm_per_s(self) -> f64 {
        self.x_mm_per_s.hypot(self.y_mm_per_s)
    }

    /// Whether both components are finite.
    pub fn is_finite(self) -> bool {
        self.x_mm_per_s.is_finite() && self.y_mm_per_s.is_finite()
    }

    /// The velocity of a point at `offset` from the centre of a body that moves with `self` and
    /// turns at `angular_rad_per_s` (counter-clockwise): `v + ω × r`.
    #[must_use]
    pub fn at_offset(self, offset: Displacement, angular_rad_per_s: f64) -> Self {
        Self::new(
            self.x_mm_per_s - angular_rad_per_s * offset.y_mm,
            self.y_mm_per_s + angular_rad_per_s * offset.x_mm,
        )
    }
}

impl std::ops::Sub for Point {
    type Output = Displacement;
    fn sub(self, other: Self) -> Displacement {
        Displacement::new(self.x_mm - other.x_mm, self.y_mm - other.y_mm)
    }
}

impl std::ops::Add<Displacement> for Point {
    type Output = Self;
    fn add(self, by: Displacement) -> Self {
        Self::new(self.x_mm + by.x_mm, self.y_mm + by.y_mm)
    }
}

impl std::ops::Sub<Displacement> for Point {
    type Output = Self;
    fn sub(self, by: Displacement) -> Self {
        Self::new(self.x_mm - by.x_mm, self.y_mm - by.y_mm)
    }
}

impl From<[f64; 2]> for Point {
    fn from([x_mm, y_mm]: [f64; 2]) -> Self {
        Self { x_mm, y_mm }
    }
}

impl From<Point> for [f64; 2] {
    fn from(point: Point) -> Self {
        [point.x_mm, point.y_mm]
    }
}

impl From<[f64; 2]> for Displacement {
    fn from([x_mm, y_mm]: [f64; 2]) -> Self {
        Self { x_mm, y_mm }
    }
}

impl From<Displacement> for [f64; 2] {
    fn from(by: Displacement) -> Self {
        [by.x_mm, by.y_mm]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_body_moves_its_rim_across_the_radius() {
        let rim = Velocity::new(1.0, 0.0).at_offset(Displacement::new(0.0, 2.0), 3.0);
        assert_eq!(rim, Velocity::new(-5.0, 0.0));
    }
}
