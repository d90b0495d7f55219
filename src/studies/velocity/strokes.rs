//! Strokes whose place and velocity are known at every time: what a hand does, in closed form.

use std::f64::consts::TAU;

use selvedge_foundation::geometry::{Point, Velocity};

/// Place and velocity at a time in s.
pub(super) type Motion<'a> = &'a dyn Fn(f64) -> (Point, Velocity);

/// A stroke of the study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stroke {
    /// Straight on.
    Constant {
        /// How fast, mm/s.
        speed_mm_per_s: f64,
    },
    /// Back and forth along a slanted line, as a sine.
    BackAndForth {
        /// From the middle to an end, mm.
        reach_mm: f64,
        /// Rounds a second.
        rounds_per_s: f64,
    },
    /// Round and round.
    Circle {
        /// Its radius, mm.
        radius_mm: f64,
        /// Rounds a second.
        rounds_per_s: f64,
    },
    /// From one place to another and back with the least jerk (Flash and Hogan 1985), each way
    /// followed by a stay.
    PointToPoint {
        /// The way, mm.
        way_mm: f64,
        /// The time it takes, s.
        duration_s: f64,
        /// The stay at either end, s.
        stay_s: f64,
    },
    /// No movement.
    Rest,
}

/// The steady stroke that jitter is judged by.
pub(super) const STEADY: Stroke = Stroke::Constant {
    speed_mm_per_s: 100.0,
};

/// What the study draws in full.
pub(super) const STROKES: [Stroke; 9] = [
    Stroke::Constant {
        speed_mm_per_s: 10.0,
    },
    STEADY,
    Stroke::BackAndForth {
        reach_mm: 30.0,
        rounds_per_s: 0.5,
    },
    Stroke::BackAndForth {
        reach_mm: 20.0,
        rounds_per_s: 1.5,
    },
    Stroke::BackAndForth {
        reach_mm: 10.0,
        rounds_per_s: 3.0,
    },
    Stroke::Circle {
        radius_mm: 15.0,
        rounds_per_s: 1.0,
    },
    Stroke::PointToPoint {
        way_mm: 60.0,
        duration_s: 0.6,
        stay_s: 0.0,
    },
    Stroke::PointToPoint {
        way_mm: 30.0,
        duration_s: 0.4,
        stay_s: 0.4,
    },
    Stroke::Rest,
];

/// What it draws when there is little time: one that is steady, two that are not, and rest.
pub(super) const QUICK_STROKES: [Stroke; 4] = [STEADY, STROKES[3], STROKES[7], STROKES[8]];

/// The direction of straight strokes: no multiple of the tablet's steps lies along it.
const ALONG: [f64; 2] = [0.956, 0.293_374_163_3];

impl Stroke {
    /// Its name for tables.
    pub(super) fn label(self) -> String {
        match self {
            Self::Constant { speed_mm_per_s } => format!("constant {speed_mm_per_s} mm/s"),
            Self::BackAndForth {
                reach_mm,
                rounds_per_s,
            } => format!("back and forth ±{reach_mm} mm at {rounds_per_s} Hz"),
            Self::Circle {
                radius_mm,
                rounds_per_s,
            } => format!("circle of {radius_mm} mm at {rounds_per_s} Hz"),
            Self::PointToPoint {
                way_mm,
                duration_s,
                stay_s,
            } if stay_s > 0.0 => format!("stop and go, {way_mm} mm in {duration_s} s"),
            Self::PointToPoint {
                way_mm, duration_s, ..
            } => format!("point to point, {way_mm} mm in {duration_s} s"),
            Self::Rest => "rest".to_owned(),
        }
    }

    /// Whether its velocity changes, so that a delay can be told.
    pub(super) fn is_varied(self) -> bool {
        !matches!(self, Self::Constant { .. } | Self::Rest)
    }

    /// Place and velocity at a time.
    pub(super) fn at(self, t_s: f64) -> (Point, Velocity) {
        match self {
            Self::Constant { speed_mm_per_s } => along(speed_mm_per_s * t_s, speed_mm_per_s),
            Self::BackAndForth {
                reach_mm,
                rounds_per_s,
            } => {
                let turn = TAU * rounds_per_s;
                let (sin, cos) = (turn * t_s).sin_cos();
                along(reach_mm * sin, reach_mm * turn * cos)
            }
            Self::Circle {
                radius_mm,
                rounds_per_s,
            } => {
                let turn = TAU * rounds_per_s;
                let (sin, cos) = (turn * t_s).sin_cos();
                (
                    Point::new(radius_mm * cos, radius_mm * sin),
                    Velocity::new(-radius_mm * turn * sin, radius_mm * turn * cos),
                )
            }
            Self::PointToPoint {
                way_mm,
                duration_s,
                stay_s,
            } => {
                let round_s = 2.0 * (duration_s + stay_s);
                let in_round_s = t_s.rem_euclid(round_s);
                let is_back = in_round_s >= 0.5 * round_s;
                let since_s = in_round_s - if is_back { 0.5 * round_s } else { 0.0 };
                let (done, rate) = least_jerk((since_s / duration_s).min(1.0));
                let sign = if is_back { -1.0 } else { 1.0 };
                let place = if is_back { 1.0 - done } else { done };
                along(way_mm * place, sign * way_mm * rate / duration_s)
            }
            Self::Rest => (Point::new(3.017, 8.023), Velocity::ZERO),
        }
    }
}

/// `10 s³ − 15 s⁴ + 6 s⁵` and its derivative.
fn least_jerk(s: f64) -> (f64, f64) {
    let place = s * s * s * (10.0 + s * (6.0 * s - 15.0));
    (place, 30.0 * s * s * (1.0 - s) * (1.0 - s))
}

fn along(way_mm: f64, speed_mm_per_s: f64) -> (Point, Velocity) {
    (
        Point::new(ALONG[0] * way_mm, ALONG[1] * way_mm),
        Velocity::new(ALONG[0] * speed_mm_per_s, ALONG[1] * speed_mm_per_s),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_strokes_velocity_is_the_slope_of_its_place() {
        let step_s = 1e-6;
        for stroke in STROKES {
            for n in 0..500 {
                let t_s = 0.003_1 + f64::from(n) * 0.007;
                let ((before, _), (after, _)) = (stroke.at(t_s - step_s), stroke.at(t_s + step_s));
                let slope = (after - before).per(2.0 * step_s);
                let (_, velocity) = stroke.at(t_s);
                let off = (slope.x_mm_per_s - velocity.x_mm_per_s)
                    .hypot(slope.y_mm_per_s - velocity.y_mm_per_s);
                assert!(off < 1e-3, "{} at {t_s} s: {off}", stroke.label());
            }
        }
    }
}
