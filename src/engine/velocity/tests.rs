//! Closed forms of the velocity estimators: constant velocity, a ramp, rest.

use super::*;

const METHODS: [VelocityMethod; 3] = [
    VelocityMethod::FiniteDifference,
    VelocityMethod::LineFit { window_s: 0.040 },
    VelocityMethod::AlphaBeta {
        alpha: 0.5,
        beta: 0.2,
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
fn the_default_lags_by_half_its_window() {
    let found = fed(VelocityMethod::default(), 100, 1, |t| Point::new(t, 0.0));
    assert!((found.lag_s - 0.020).abs() < 1e-12, "{found:?}");
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
