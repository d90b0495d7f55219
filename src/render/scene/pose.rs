//! Where a display is at a tick, and how it moves.

use selvedge_foundation::geometry::{Point, Velocity};

/// Ticks a second: amplitudes change every 25 ms.
pub const TICKS_PER_S: f64 = 40.0;

/// A display's place and motion at one tick. The turn is the path's own: a display adds its own
/// `rotation_deg`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// When, s.
    pub t_s: f64,
    /// The display's centre in the workspace, mm.
    pub position: Point,
    /// Turn counter-clockwise, degrees; not wrapped.
    pub angle_deg: f64,
    /// How the centre moves, mm/s.
    pub velocity: Velocity,
    /// How fast it turns counter-clockwise, rad/s.
    pub angular_rad_per_s: f64,
}

impl Pose {
    /// The same place, without motion.
    #[must_use]
    pub fn at_rest(self) -> Self {
        Self {
            velocity: Velocity::ZERO,
            angular_rad_per_s: 0.0,
            ..self
        }
    }

    /// How fast a display turns that stood at `before_deg` one tick before it stands at `now_deg`.
    pub fn turning_rad_per_s(before_deg: f64, now_deg: f64) -> f64 {
        (now_deg - before_deg).to_radians() * TICKS_PER_S
    }

    /// How a centre moves that lay at `before` one tick before it lies at `now`.
    pub fn moving_mm_per_s(before: Point, now: Point) -> Velocity {
        let moved = now - before;
        Velocity::new(moved.x_mm * TICKS_PER_S, moved.y_mm * TICKS_PER_S)
    }
}
