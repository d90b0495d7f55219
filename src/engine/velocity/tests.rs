//! Closed forms of the velocity estimators: constant velocity, a ramp, rest.

use super::*;
use selvedge_foundation::geometry::Point;

const METHODS: [VelocityMethod; 2] = [
    VelocityMethod::FiniteDifference,
    VelocityMethod::Kalman {
        acceleration_mm2_per_s3: 1e3,
        noise_mm: 0.03,
    },
];

/// Feeds `n` samples of `place(t)` every `step_ms` and returns the estimate at the last of them.
fn fed(method: VelocityMethod, n: u32, step_ms: u64, place: impl Fn(f64) -> Point) -> Estimate {
    let mut estimator = VelocityEstimator::new(method);
    let start = Instant::now();
    let mut now = start;
    for k in 0..n {
        now = start + Duration::from_millis(step_ms) * k;
        let position = place((now - start).as_secs_f64());
        estimator.push(PointerSample {
            stamp: now,
            position,
        });
    }
    estimator.estimate(now)
}

#[test]
fn constant_velocity_is_found_whatever_the_method_and_rate() {
    for method in METHODS {
        for step_ms in [1, 2, 8, 10, 33] {
            let found = fed(method, 60, step_ms, |t| {
                Point::new(3.0 + 120.0 * t, -75.0 * t)
            });
            let off = (found.velocity.x_mm_per_s - 120.0).hypot(found.velocity.y_mm_per_s + 75.0);
            assert!(off < 1e-9, "{method:?} at {step_ms} ms: {found:?}");
        }
    }
}

#[test]
fn the_stated_lag_is_the_lag_on_a_ramp() {
    let acceleration = 400.0;
    for method in METHODS {
        for (n, step_ms) in [(400, 1), (60, 8), (60, 10), (200, 20)] {
            let found = fed(method, n, step_ms, |t| {
                Point::new(0.5 * acceleration * t * t, 0.0)
            });
            let newest_s = f64::from(n - 1) * step_ms as f64 * 1e-3;
            let true_velocity = acceleration * newest_s;
            let lag_s = (true_velocity - found.velocity.x_mm_per_s) / acceleration;
            assert!(
                (lag_s - found.lag_s).abs() < 1e-6,
                "{method:?} {step_ms} ms: {lag_s} {found:?}"
            );
        }
    }
}

#[test]
fn a_pointer_that_says_nothing_is_at_rest_after_50_ms() {
    for method in METHODS {
        let mut estimator = VelocityEstimator::new(method);
        let start = Instant::now();
        for k in 0..10_u32 {
            let stamp = start + Duration::from_millis(8) * k;
            estimator.push(PointerSample {
                stamp,
                position: Point::new(f64::from(k), 0.0),
            });
        }
        let last = start + Duration::from_millis(72);
        assert!(
            estimator.estimate(last + REST).velocity.x_mm_per_s > 100.0,
            "{method:?}"
        );
        assert_eq!(
            estimator.estimate(last + REST + Duration::from_nanos(1)),
            Estimate::REST
        );
        // The first sample after a rest knows of no movement yet.
        let stamp = last + Duration::from_secs(2);
        estimator.push(PointerSample {
            stamp,
            position: Point::new(50.0, 0.0),
        });
        assert_eq!(estimator.estimate(stamp), Estimate::REST);
    }
}

#[test]
fn a_replaced_sample_counts_as_if_it_had_come_so() {
    for method in METHODS {
        let start = Instant::now();
        let at = |k: u32, x_mm: f64| PointerSample {
            stamp: start + Duration::from_millis(8) * k,
            position: Point::new(x_mm, 0.0),
        };
        let mut corrected = VelocityEstimator::new(method);
        let mut direct = VelocityEstimator::new(method);
        for k in 0..6 {
            corrected.push(at(k, 99.0));
            corrected.replace(at(k, f64::from(k * k)));
            direct.push(at(k, f64::from(k * k)));
        }
        assert_eq!(
            corrected.estimate(at(5, 0.0).stamp),
            direct.estimate(at(5, 0.0).stamp)
        );
    }
}

#[test]
fn nothing_seen_and_one_sample_are_at_rest() {
    for method in METHODS {
        assert_eq!(fed(method, 0, 8, |_| Point::default()), Estimate::REST);
        assert_eq!(fed(method, 1, 8, |_| Point::default()), Estimate::REST);
    }
}

#[test]
fn places_at_the_ends_of_the_number_range_give_a_finite_velocity() {
    for method in METHODS {
        let ends = |t: f64| Point::new(if t < 0.030 { -1e308 } else { 1e308 }, 0.0);
        for n in 2..8 {
            assert!(
                fed(method, n, 8, ends).velocity.is_finite(),
                "{method:?} {n}"
            );
        }
    }
}

#[test]
fn constant_velocity_is_found_between_uneven_samples() {
    // Gaps of 0.05, 1, 8 and 33 ms in turn, as when a queue is emptied in bursts.
    let gaps_us = [50_u64, 1_000, 8_000, 33_000];
    for method in METHODS {
        let mut estimator = VelocityEstimator::new(method);
        let start = Instant::now();
        let mut now = start;
        for k in 0..80 {
            now += Duration::from_micros(gaps_us[k % 4]);
            let t = (now - start).as_secs_f64();
            estimator.push(PointerSample {
                stamp: now,
                position: Point::new(200.0 * t, 5.0 - 40.0 * t),
            });
        }
        let Velocity {
            x_mm_per_s,
            y_mm_per_s,
        } = estimator.estimate(now).velocity;
        let off = (x_mm_per_s - 200.0).hypot(y_mm_per_s + 40.0);
        assert!(off < 1e-7, "{method:?}: off by {off} mm/s");
    }
}

#[test]
fn the_lag_carried_along_is_exact_between_uneven_samples() {
    let acceleration = 900.0;
    for method in METHODS {
        let mut estimator = VelocityEstimator::new(method);
        let start = Instant::now();
        let mut now = start;
        for k in 0..90_u64 {
            now += Duration::from_micros(300 + 7_000 * (k % 3));
            let t = (now - start).as_secs_f64();
            estimator.push(PointerSample {
                stamp: now,
                position: Point::new(0.0, 0.5 * acceleration * t * t),
            });
        }
        let found = estimator.estimate(now);
        let true_velocity = acceleration * (now - start).as_secs_f64();
        let lag_s = (true_velocity - found.velocity.y_mm_per_s) / acceleration;
        assert!((lag_s - found.lag_s).abs() < 1e-9, "{lag_s} s, {found:?}");
    }
}

#[test]
fn a_kalman_filters_lag_settles_where_its_closed_form_says() {
    let method = VelocityMethod::Kalman {
        acceleration_mm2_per_s3: 1e3,
        noise_mm: 0.1,
    };
    let found = fed(method, 2000, 1, |t| Point::new(t, 0.0));
    let expected = 2.0_f64.sqrt() * (0.1_f64.powi(2) * 1e-3 / 1e3).powf(0.25);
    // Dense samples: 14 ms against steps of 1 ms.
    assert!(
        (found.lag_s / expected - 1.0).abs() < 0.06,
        "{found:?} for {expected} s"
    );
}

#[test]
fn a_pointer_that_trembles_in_its_place_moves_less_behind_every_filter() {
    let tremble = |t: f64| {
        Point::new(
            if (t * 125.0).round() % 2.0 > 0.5 {
                0.1
            } else {
                0.0
            },
            0.0,
        )
    };
    let raw = fed(METHODS[0], 101, 8, tremble).velocity.speed_mm_per_s();
    for method in &METHODS[1..] {
        let found = fed(*method, 101, 8, tremble).velocity.speed_mm_per_s();
        assert!(found < 0.6 * raw, "{method:?}: {found} of {raw} mm/s");
    }
}

#[test]
fn samples_of_the_same_time_leave_the_filters_finite() {
    for method in METHODS {
        let found = fed(method, 20, 0, |_| Point::new(3.0, 4.0));
        assert!(
            found.velocity.is_finite() && found.lag_s.is_finite(),
            "{method:?}"
        );
    }
}
