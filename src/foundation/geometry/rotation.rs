//! Turning in the plane, exact for multiples of 90°.
//!
//! Files give angles in degrees, code turns by sine and cosine; this is where one becomes the
//! other. It does not wrap angles: 361° and 1° are the same turn but not the same number.

use super::{Displacement, Velocity};

/// A turn about the origin, counter-clockwise, kept as its cosine and sine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    cos: f64,
    sin: f64,
}

impl Rotation {
    /// No turn.
    pub const NONE: Self = Self { cos: 1.0, sin: 0.0 };

    /// The turn by `angle_deg` degrees. Multiples of 90° have exact sines and cosines.
    pub fn from_degrees(angle_deg: f64) -> Self {
        let wrapped = angle_deg.rem_euclid(360.0);
        let quarter = |cos, sin| Self { cos, sin };
        match wrapped / 90.0 {
            0.0 | 4.0 => quarter(1.0, 0.0),
            1.0 => quarter(0.0, 1.0),
            2.0 => quarter(-1.0, 0.0),
            3.0 => quarter(0.0, -1.0),
            _ => {
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                Self { cos, sin }
            }
        }
    }

    /// The turn by `self` after the turn by `first`.
    #[must_use]
    pub fn after(self, first: Self) -> Self {
        Self {
            cos: self.cos * first.cos - self.sin * first.sin,
            sin: self.sin * first.cos + self.cos * first.sin,
        }
    }

    /// The turn that undoes this one.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self {
            cos: self.cos,
            sin: -self.sin,
        }
    }

    /// Cosine and sine of the angle.
    pub fn cos_sin(self) -> (f64, f64) {
        (self.cos, self.sin)
    }

    /// A displacement, turned.
    pub fn turn(self, by: Displacement) -> Displacement {
        let (x_mm, y_mm) = self.turn_pair(by.x_mm, by.y_mm);
        Displacement { x_mm, y_mm }
    }

    /// A velocity, turned.
    pub fn turn_velocity(self, velocity: Velocity) -> Velocity {
        let (x, y) = self.turn_pair(velocity.x_mm_per_s, velocity.y_mm_per_s);
        Velocity::new(x, y)
    }

    fn turn_pair(self, x: f64, y: f64) -> (f64, f64) {
        (self.cos * x - self.sin * y, self.sin * x + self.cos * y)
    }
}

impl Default for Rotation {
    fn default() -> Self {
        Self::NONE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact_however_often_wrapped() {
        let east = Displacement::new(3.0, 0.5);
        for turns in [-720.0, 0.0, 3600.0] {
            assert_eq!(
                Rotation::from_degrees(turns + 90.0).turn(east),
                Displacement::new(-0.5, 3.0)
            );
            assert_eq!(Rotation::from_degrees(turns).turn(east), east);
        }
    }

    #[test]
    fn a_turn_and_its_inverse_cancel() {
        let turn = Rotation::from_degrees(33.0);
        let (cos, sin) = turn.after(turn.inverse()).cos_sin();
        assert!(
            (cos - 1.0).abs() < 1e-15 && sin.abs() < 1e-15,
            "cos {cos}, sin {sin}"
        );
    }
}
