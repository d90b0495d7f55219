//! Strokes whose place and velocity are known at every time: what a hand does, in closed form.

use std::f64::consts::TAU;

use selvedge_foundation::geometry::{Point, Velocity};

/// Place and velocity at a time in s.
pub(super) type Motion<'a> = &'a dyn Fn(f64) -> (Point, Velocity);

/// A stroke of the study.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stroke {
    /// Its name for tables.
    pub(super) label: &'static str,
    /// Whether its velocity changes, so that a delay can be told.
    pub(super) is_varied: bool,
    /// Place and velocity at a time in s.
    pub(super) at: fn(f64) -> (Point, Velocity),
}

/// The steady stroke that jitter is judged by.
pub(super) const STEADY: Stroke = Stroke {
    label: "constant 100 mm/s",
    is_varied: false,
    at: |t_s| along(100.0 * t_s, 100.0),
};

const fn varied(label: &'static str, at: fn(f64) -> (Point, Velocity)) -> Stroke {
    Stroke {
        label,
        is_varied: true,
        at,
    }
}

/// What the study draws in full.
pub(super) const STROKES: [Stroke; 9] = [
    Stroke {
        label: "constant 10 mm/s",
        is_varied: false,
        at: |t_s| along(10.0 * t_s, 10.0),
    },
    STEADY,
    varied("back and forth ±30 mm at 0.5 Hz", |t_s| {
        back_and_forth(30.0, 0.5, t_s)
    }),
    varied("back and forth ±20 mm at 1.5 Hz", |t_s| {
        back_and_forth(20.0, 1.5, t_s)
    }),
    varied("back and forth ±10 mm at 3 Hz", |t_s| {
        back_and_forth(10.0, 3.0, t_s)
    }),
    varied("circle of 15 mm at 1 Hz", |t_s| circle(15.0, 1.0, t_s)),
    varied("point to point, 60 mm in 0.6 s", |t_s| {
        point_to_point(60.0, 0.6, 0.0, t_s)
    }),
    varied("stop and go, 30 mm in 0.4 s", |t_s| {
        point_to_point(30.0, 0.4, 0.4, t_s)
    }),
    Stroke {
        label: "rest",
        is_varied: false,
        at: |_| (Point::new(3.017, 8.023), Velocity::ZERO),
    },
];

/// What it draws when there is little time: one that is steady, two that are not, and rest.
pub(super) const QUICK_STROKES: [Stroke; 4] = [STEADY, STROKES[3], STROKES[7], STROKES[8]];

/// The direction of straight strokes: no multiple of the tablet's steps lies along it.
const ALONG: [f64; 2] = [0.956, 0.293_374_163_3];

/// A sine along a slanted line.
fn back_and_forth(reach_mm: f64, rounds_per_s: f64, t_s: f64) -> (Point, Velocity) {
    let turn = TAU * rounds_per_s;
    let (sin, cos) = (turn * t_s).sin_cos();
    along(reach_mm * sin, reach_mm * turn * cos)
}

fn circle(radius_mm: f64, rounds_per_s: f64, t_s: f64) -> (Point, Velocity) {
    let turn = TAU * rounds_per_s;
    let (sin, cos) = (turn * t_s).sin_cos();
    (
        Point::new(radius_mm * cos, radius_mm * sin),
        Velocity::new(-radius_mm * turn * sin, radius_mm * turn * cos),
    )
}

/// From one place to another and back with the least jerk (Flash and Hogan 1985), each way
/// followed by a stay: `10 s³ − 15 s⁴ + 6 s⁵` of the way.
fn point_to_point(way_mm: f64, duration_s: f64, stay_s: f64, t_s: f64) -> (Point, Velocity) {
    let round_s = 2.0 * (duration_s + stay_s);
    let in_round_s = t_s.rem_euclid(round_s);
    let is_back = in_round_s >= 0.5 * round_s;
    let since_s = in_round_s - if is_back { 0.5 * round_s } else { 0.0 };
    let s = (since_s / duration_s).min(1.0);
    let done = s * s * s * (10.0 + s * (6.0 * s - 15.0));
    let rate = 30.0 * s * s * (1.0 - s) * (1.0 - s);
    let (sign, place) = if is_back {
        (-1.0, 1.0 - done)
    } else {
        (1.0, done)
    };
    along(way_mm * place, sign * way_mm * rate / duration_s)
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
                let ((before, _), (after, _)) =
                    ((stroke.at)(t_s - step_s), (stroke.at)(t_s + step_s));
                let slope = (after - before).per(2.0 * step_s);
                let (_, velocity) = (stroke.at)(t_s);
                let off = (slope.x_mm_per_s - velocity.x_mm_per_s)
                    .hypot(slope.y_mm_per_s - velocity.y_mm_per_s);
                assert!(off < 1e-3, "{} at {t_s} s: {off}", stroke.label);
            }
        }
    }
}
