//! Generated strokes: a line or a circle, drawn for ever at a set speed.
//!
//! Pure functions of time; who draws them keeps the clock. Lines go there and back,
//! so that the velocity turns at the ends and nothing ever jumps.

use super::{Pose, SceneError};
use selvedge_foundation::geometry::{Displacement, Point, Velocity};

/// The fastest stroke, mm/s: well above what is felt.
const MAX_SPEED_MM_PER_S: f64 = 1e5;
/// The farthest place or the longest stroke, mm.
const MAX_LENGTH_MM: f64 = 1e9;

/// A stroke that is drawn for ever.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stroke {
    /// From one place to another and back.
    Line {
        /// Where it starts.
        start: Point,
        /// Where it turns.
        end: Point,
        /// How fast, mm/s.
        speed_mm_per_s: f64,
    },
    /// Counter-clockwise, from the rightmost place.
    Circle {
        /// Its centre.
        centre: Point,
        /// Its radius, mm.
        radius_mm: f64,
        /// How fast along the circle, mm/s.
        speed_mm_per_s: f64,
    },
}

impl Stroke {
    /// Refuses numbers that draw nothing: not finite, a negative speed, no extent.
    pub fn check(&self) -> Result<(), SceneError> {
        let (place, extent_mm) = match *self {
            Self::Line { start, end, .. } => ([start, end], (end - start).length_mm()),
            Self::Circle {
                centre, radius_mm, ..
            } => ([centre; 2], radius_mm),
        };
        let speed = self.speed_mm_per_s();
        let wrong = |what: String, mend: &str| SceneError::Value {
            what,
            mend: mend.to_owned(),
        };
        if !(0.0..=MAX_SPEED_MM_PER_S).contains(&speed) {
            let mend = "give a speed from 0 to 100000 mm/s";
            return Err(wrong(format!("the stroke's speed is {speed} mm/s"), mend));
        }
        let is_place = |p: Point| p.x_mm.abs() <= MAX_LENGTH_MM && p.y_mm.abs() <= MAX_LENGTH_MM;
        if !place.into_iter().all(is_place) {
            return Err(wrong(
                "the stroke lies nowhere".to_owned(),
                "give finite places in mm",
            ));
        }
        if !(extent_mm > 0.0 && extent_mm <= MAX_LENGTH_MM) {
            return Err(wrong(
                format!("the stroke is {extent_mm} mm long"),
                "give more than 0 mm",
            ));
        }
        Ok(())
    }

    /// How long it takes until the stroke begins again, s; infinite for one that stands still.
    pub fn period_s(&self) -> f64 {
        let round_mm = match *self {
            Self::Line { start, end, .. } => 2.0 * (end - start).length_mm(),
            Self::Circle { radius_mm, .. } => std::f64::consts::TAU * radius_mm,
        };
        round_mm / self.speed_mm_per_s()
    }

    fn speed_mm_per_s(&self) -> f64 {
        let (Self::Line { speed_mm_per_s, .. } | Self::Circle { speed_mm_per_s, .. }) = *self;
        speed_mm_per_s
    }

    /// Place and velocity at `t_s` seconds after the start.
    pub fn at(&self, t_s: f64) -> (Point, Velocity) {
        match *self {
            Self::Line {
                start,
                end,
                speed_mm_per_s,
            } => {
                let along = end - start;
                let length_mm = along.length_mm();
                let (done_mm, sign) = there_and_back(speed_mm_per_s * t_s, length_mm);
                let velocity = along.per(length_mm / (sign * speed_mm_per_s));
                (
                    start.toward(end, done_mm / length_mm),
                    still_if_slow(velocity, speed_mm_per_s),
                )
            }
            Self::Circle {
                centre,
                radius_mm,
                speed_mm_per_s,
            } => {
                let (sin, cos) = (speed_mm_per_s * t_s / radius_mm).sin_cos();
                let velocity = Velocity::new(-speed_mm_per_s * sin, speed_mm_per_s * cos);
                (
                    centre + Displacement::new(radius_mm * cos, radius_mm * sin),
                    velocity,
                )
            }
        }
    }

    /// The pose of a display that draws the stroke without turning.
    pub fn pose_at(&self, t_s: f64) -> Pose {
        let (position, velocity) = self.at(t_s);
        Pose {
            t_s,
            position,
            velocity,
            ..Pose::default()
        }
    }
}

/// Where a walk of `walked_mm` stands on a stretch that it walks there and back, and its sign.
fn there_and_back(walked_mm: f64, length_mm: f64) -> (f64, f64) {
    let round_mm = walked_mm.rem_euclid(2.0 * length_mm);
    if round_mm < length_mm {
        (round_mm, 1.0)
    } else {
        (2.0 * length_mm - round_mm, -1.0)
    }
}

fn still_if_slow(velocity: Velocity, speed_mm_per_s: f64) -> Velocity {
    if speed_mm_per_s > 0.0 {
        velocity
    } else {
        Velocity::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CIRCLE: Stroke = Stroke::Circle {
        centre: Point::new(5.0, 5.0),
        radius_mm: 3.0,
        speed_mm_per_s: 40.0,
    };
    const LINE: Stroke = Stroke::Line {
        start: Point::new(0.0, 0.0),
        end: Point::new(30.0, 40.0),
        speed_mm_per_s: 100.0,
    };

    #[test]
    fn after_a_period_a_stroke_begins_again() {
        let line = Stroke::Line {
            start: Point::new(0.0, 0.0),
            end: Point::new(30.0, 40.0),
            speed_mm_per_s: 50.0,
        };
        assert_eq!(line.period_s(), 2.0);
        for stroke in [line, CIRCLE] {
            let period_s = stroke.period_s();
            for t_s in [0.0, 0.1, 0.37] {
                let ((at, _), (again, _)) = (stroke.at(t_s), stroke.at(t_s + period_s));
                assert!((again - at).length_mm() < 1e-9, "{stroke:?}");
                let (halfway, _) = stroke.at(t_s + 0.3 * period_s);
                assert!((halfway - at).length_mm() > 0.1, "not before: {stroke:?}");
            }
        }
    }

    #[test]
    fn a_line_turns_at_its_end_and_comes_back() {
        assert_eq!(
            LINE.at(0.25),
            (Point::new(15.0, 20.0), Velocity::new(60.0, 80.0))
        );
        assert_eq!(
            LINE.at(0.75),
            (Point::new(15.0, 20.0), Velocity::new(-60.0, -80.0))
        );
    }

    #[test]
    fn every_stroke_keeps_its_speed_and_never_jumps() {
        for (stroke, speed) in [(CIRCLE, 40.0), (LINE, 100.0)] {
            assert!(stroke.check().is_ok(), "{stroke:?}");
            let dt_s = 1e-4;
            for n in 0..40_000 {
                let t_s = f64::from(n) * dt_s;
                let ((here, velocity), (next, _)) = (stroke.at(t_s), stroke.at(t_s + dt_s));
                let moved_mm = (next - here).length_mm();
                assert!(moved_mm <= speed * dt_s + 1e-9, "{stroke:?} at {t_s} s");
                assert!(
                    (velocity.speed_mm_per_s() - speed).abs() < 1e-9,
                    "{stroke:?} at {t_s} s"
                );
            }
        }
    }

    #[test]
    fn a_stroke_without_speed_stays_and_one_without_extent_is_refused() {
        let still = Stroke::Line {
            start: Point::new(1.0, 1.0),
            end: Point::new(2.0, 1.0),
            speed_mm_per_s: 0.0,
        };
        assert_eq!(still.at(9.0), (Point::new(1.0, 1.0), Velocity::ZERO));
        for (radius_mm, speed_mm_per_s) in [
            (0.0, 1.0),
            (f64::NAN, 1.0),
            (1.0, -1.0),
            (1.0, f64::INFINITY),
        ] {
            let circle = Stroke::Circle {
                centre: Point::default(),
                radius_mm,
                speed_mm_per_s,
            };
            assert!(circle.check().is_err(), "{circle:?}");
        }
    }
}
