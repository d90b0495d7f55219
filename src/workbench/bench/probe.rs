//! The velocity at which textiles are asked what they would give: chosen in the plots, or that of
//! the display.

use selvedge_foundation::geometry::{Rotation, Velocity};

/// Least and largest speed that can be chosen, mm/s.
pub(crate) const SPEEDS_MM_PER_S: [f64; 2] = [1.0, 2000.0];
/// Directions are chosen and followed in steps of this, degrees.
pub(crate) const STEP_DEG: f64 = 5.0;

/// A velocity in the workspace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Probe {
    /// How fast, mm/s.
    pub speed_mm_per_s: f64,
    /// Where to, degrees counter-clockwise from the workspace's x, 0 to below 360.
    pub(crate) direction_deg: f64,
    /// Whether it is the display's own velocity, as far as that moves.
    pub follows: bool,
}

impl Default for Probe {
    /// The speed at which levels are stated, to the right.
    fn default() -> Self {
        Self {
            speed_mm_per_s: selvedge_textile::tactile::LEVEL_SPEED_MM_PER_S,
            direction_deg: 0.0,
            follows: false,
        }
    }
}

impl Probe {
    /// As a vector in the workspace; exact along its axes.
    pub(crate) fn velocity(self) -> Velocity {
        let along_x = Velocity::new(self.speed_mm_per_s, 0.0);
        Rotation::from_degrees(self.direction_deg).turn_velocity(along_x)
    }

    /// Another speed, chosen by hand; what is no number changes nothing.
    pub(crate) fn with_speed(self, speed_mm_per_s: f64) -> Self {
        if speed_mm_per_s.is_nan() {
            return self;
        }
        Self {
            speed_mm_per_s: within(speed_mm_per_s),
            follows: false,
            ..self
        }
    }

    /// Another direction, chosen by hand; what is not finite changes nothing.
    pub(crate) fn with_direction(self, direction_deg: f64) -> Self {
        if !direction_deg.is_finite() {
            return self;
        }
        Self {
            direction_deg: wrapped(direction_deg),
            follows: false,
            ..self
        }
    }

    /// The same, following the display or no longer.
    pub(crate) fn with_follow(self, follows: bool) -> Self {
        Self { follows, ..self }
    }

    /// What it is while the display moves like this: speed to two digits, direction to 5°, so that
    /// not every tremor counts as another velocity. A display at rest leaves it as it was.
    pub(crate) fn after(self, display: Velocity) -> Self {
        let speed_mm_per_s = display.speed_mm_per_s();
        if !self.follows || !display.is_finite() || speed_mm_per_s < SPEEDS_MM_PER_S[0] {
            return self;
        }
        let direction_deg = display.y_mm_per_s.atan2(display.x_mm_per_s).to_degrees();
        Self {
            speed_mm_per_s: within(two_digits(speed_mm_per_s)),
            direction_deg: wrapped((direction_deg / STEP_DEG).round() * STEP_DEG),
            ..self
        }
    }
}

fn within(speed_mm_per_s: f64) -> f64 {
    speed_mm_per_s.clamp(SPEEDS_MM_PER_S[0], SPEEDS_MM_PER_S[1])
}

fn wrapped(direction_deg: f64) -> f64 {
    let wrapped = direction_deg.rem_euclid(360.0);
    // A tiny negative angle rounds up to the whole turn.
    if wrapped < 360.0 { wrapped } else { 0.0 }
}

/// A positive number to two significant digits.
pub(crate) fn two_digits(value: f64) -> f64 {
    let decade = value.log10().floor();
    // Of the two powers of ten the whole one: numbers stay as they are typed.
    if decade >= 1.0 {
        let step = 10.0_f64.powf(decade - 1.0);
        (value / step).round() * step
    } else {
        let parts = 10.0_f64.powf(1.0 - decade);
        (value * parts).round() / parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chosen_velocity_stays_within_bounds_and_is_exact_along_the_axes() {
        let probe = Probe::default().with_speed(1e9).with_direction(-90.0);
        assert_eq!((probe.speed_mm_per_s, probe.direction_deg), (2000.0, 270.0));
        assert_eq!(probe.velocity(), Velocity::new(0.0, -2000.0));
        assert_eq!(probe.with_speed(f64::NAN), probe);
        assert_eq!(probe.with_direction(f64::INFINITY), probe);
        assert_eq!(probe.with_direction(-1e-20).direction_deg, 0.0);
        assert_eq!(probe.with_speed(0.0).speed_mm_per_s, 1.0);
    }

    #[test]
    fn numbers_are_rounded_to_two_digits() {
        let rounded = [0.123, 1.04, 8.749, 9.96, 12.5, 1234.0].map(two_digits);
        assert_eq!(rounded, [0.12, 1.0, 8.7, 10.0, 13.0, 1200.0]);
    }

    #[test]
    fn a_velocity_that_follows_keeps_the_last_movement_and_ends_by_hand() {
        let moving = Velocity::new(-60.4, 61.0);
        let held = Probe::default();
        assert_eq!(held.after(moving), held, "it does not follow");
        let probe = held.with_follow(true).after(moving);
        assert_eq!((probe.speed_mm_per_s, probe.direction_deg), (86.0, 135.0));
        assert_eq!(probe.after(Velocity::new(-60.1, 61.2)), probe, "a tremor");
        for still in [Velocity::ZERO, Velocity::new(f64::NAN, 1.0)] {
            assert_eq!(probe.after(still), probe, "{still:?}");
        }
        assert!(!probe.with_speed(50.0).follows && !probe.with_direction(3.0).follows);
    }
}
