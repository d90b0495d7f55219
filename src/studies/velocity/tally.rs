//! How far estimates are from the truth: now, at a level, and once their delay is taken off.

use selvedge_foundation::geometry::Velocity;
use selvedge_foundation::numerics::quantile;

use super::strokes::Motion;
use crate::readable::{mean, rms};

/// Levels are compared where the finger is at least this fast, mm/s.
const LEAST_SPEED_MM_PER_S: f64 = 10.0;
/// A level error counts as at most this, dB: an estimate of 0 has no level.
const MOST_DB: f64 = 40.0;
/// Delays that are tried, s, and their distance.
const DELAYS_S: [f64; 2] = [-0.010, 0.150];
const DELAY_STEP_S: f64 = 0.001;

/// An estimate at a tick: when, the velocity, and its stated lag, s.
pub(super) type Estimated = (f64, Velocity, f64);

/// Errors of one method, from one stroke or from many.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    /// |estimate − truth| at every tick, mm/s.
    errors: Vec<f64>,
    /// |20 log₁₀(estimate/truth)| of the speeds where the truth is fast enough, dB.
    levels_db: Vec<f64>,
    /// How far the estimates of a stroke that varies are behind, s, a stroke each.
    delays_s: Vec<f64>,
    /// Mean squares of what is left of the error once the delay is taken off, (mm/s)².
    jitters: Vec<f64>,
    /// Lags that the method states, s.
    lags_s: Vec<f64>,
}

impl Tally {
    /// The tally of the estimates of one stroke.
    pub(super) fn of(estimates: &[Estimated], motion: Motion<'_>, is_varied: bool) -> Self {
        let mut tally = Self::default();
        for &(t_s, estimate, lag_s) in estimates {
            let truth = motion(t_s).1;
            tally.errors.push(squared_distance(estimate, truth).sqrt());
            if truth.speed_mm_per_s() >= LEAST_SPEED_MM_PER_S {
                let ratio = estimate.speed_mm_per_s() / truth.speed_mm_per_s();
                tally
                    .levels_db
                    .push((20.0 * ratio.log10()).abs().min(MOST_DB));
            }
            tally.lags_s.push(lag_s);
        }
        if is_varied {
            let (delay_s, jitter) = delay_of(estimates, motion);
            tally.delays_s.push(delay_s);
            tally.jitters.push(jitter);
        } else if !estimates.is_empty() {
            tally.jitters.push(tally.rms_mm_per_s().powi(2));
        }
        tally
    }

    /// Adds another stroke's.
    pub(super) fn add(&mut self, other: &Self) {
        self.errors.extend(&other.errors);
        self.levels_db.extend(&other.levels_db);
        self.delays_s.extend(&other.delays_s);
        self.jitters.extend(&other.jitters);
        self.lags_s.extend(&other.lags_s);
    }

    /// Root mean square error, mm/s.
    pub(super) fn rms_mm_per_s(&self) -> f64 {
        rms(&self.errors)
    }

    /// 99th percentile of the errors, mm/s.
    pub(super) fn p99_mm_per_s(&self) -> f64 {
        quantile(&mut self.errors.clone(), 0.99)
    }

    /// Root mean square level error, dB; NaN where nothing is fast enough.
    pub(super) fn rms_db(&self) -> f64 {
        rms(&self.levels_db)
    }

    /// 99th percentile of the level errors, dB; NaN where nothing is fast enough.
    pub(super) fn p99_db(&self) -> f64 {
        quantile(&mut self.levels_db.clone(), 0.99)
    }

    /// Mean delay over the strokes that vary, s; NaN without one.
    pub(super) fn delay_s(&self) -> f64 {
        mean(&self.delays_s)
    }

    /// Root mean square error once each stroke's delay is taken off, mm/s.
    pub(super) fn jitter_mm_per_s(&self) -> f64 {
        mean(&self.jitters).sqrt()
    }

    /// Mean lag that the method states, s.
    pub(super) fn lag_s(&self) -> f64 {
        mean(&self.lags_s)
    }
}

/// The delay d that brings the truth at t − d closest to the estimates, s, and the mean square
/// distance that is left.
fn delay_of(estimates: &[Estimated], motion: Motion<'_>) -> (f64, f64) {
    let left_at = |delay_s: f64| {
        let squares = estimates
            .iter()
            .map(|&(t_s, estimate, _)| squared_distance(estimate, motion(t_s - delay_s).1));
        squares.sum::<f64>() / estimates.len() as f64
    };
    let mut best = (DELAYS_S[0], f64::INFINITY);
    let mut delay_s = DELAYS_S[0];
    while delay_s <= DELAYS_S[1] {
        let left = left_at(delay_s);
        if left < best.1 {
            best = (delay_s, left);
        }
        delay_s += DELAY_STEP_S;
    }
    // The vertex of the parabola through the best delay and its neighbours.
    let [before, after] = [-DELAY_STEP_S, DELAY_STEP_S].map(|by| left_at(best.0 + by));
    let bend = before - 2.0 * best.1 + after;
    let shift = if bend > 0.0 {
        (0.5 * (before - after) / bend).clamp(-1.0, 1.0)
    } else {
        0.0
    };
    (best.0 + shift * DELAY_STEP_S, best.1)
}

fn squared_distance(a: Velocity, b: Velocity) -> f64 {
    (a.x_mm_per_s - b.x_mm_per_s).powi(2) + (a.y_mm_per_s - b.y_mm_per_s).powi(2)
}

#[cfg(test)]
mod tests {
    use super::super::strokes::STROKES;
    use super::*;

    #[test]
    fn a_delay_put_in_is_the_delay_found() {
        for stroke in STROKES.into_iter().filter(|stroke| stroke.is_varied) {
            let motion = |t_s: f64| (stroke.at)(t_s);
            for delay_s in [0.0, 0.0123, 0.0407] {
                let late = |n: i32| {
                    let t_s = 0.2 + 0.025 * f64::from(n);
                    (t_s, motion(t_s - delay_s).1, 0.0)
                };
                let estimates: Vec<Estimated> = (0..200).map(late).collect();
                let tally = Tally::of(&estimates, &motion, true);
                let off_s = (tally.delay_s() - delay_s).abs();
                assert!(off_s < 1e-4, "{}: off by {off_s} s", stroke.label);
                assert!(tally.jitter_mm_per_s() < 0.02 * (1.0 + tally.rms_mm_per_s()) + 1.0);
            }
        }
    }

    #[test]
    fn an_estimate_of_twice_the_speed_is_six_decibels_off() {
        let motion = |t_s: f64| (STROKES[1].at)(t_s);
        let double = |n: i32| (f64::from(n), Velocity::new(191.2, 58.674_832_66), 0.0);
        let tally = Tally::of(&(0..10).map(double).collect::<Vec<_>>(), &motion, false);
        assert!((tally.rms_db() - 6.0206).abs() < 1e-3, "{}", tally.rms_db());
        assert!(
            (tally.p99_mm_per_s() - 100.0).abs() < 1e-3,
            "{}",
            tally.p99_mm_per_s()
        );
        assert!(
            tally.delay_s().is_nan(),
            "a constant velocity tells no delay"
        );
    }
}
