//! Velocity from a series of places and times.
//!
//! The methods and their lags are told apart by [`VelocityMethod`]. A pointer that sends nothing
//! for [`REST`] is at rest: a mouse says nothing while it lies still. Places are taken as they come
//! and none is extrapolated, so at a tick the display is where the newest sample was.

mod filter;

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use super::{PointerSample, VelocityMethod};
use filter::Tracked;
use selvedge_foundation::geometry::{Displacement, Velocity};

/// A pointer that is silent for longer is at rest, and what it did before is forgotten.
pub(crate) const REST: Duration = Duration::from_millis(50);

/// Most samples that are remembered: 40 ms of a mouse with 8 kHz and some.
const CAPACITY: usize = 512;

/// Components are held within this, so that no estimate is infinite: far beyond what is felt, mm/s.
const FASTEST_MM_PER_S: f64 = 1e12;

/// A velocity and how old it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The velocity, mm/s.
    pub velocity: Velocity,
    /// How long before the newest sample the pointer had this velocity if its acceleration is
    /// constant, s; 0 at rest.
    pub lag_s: f64,
}

impl Estimate {
    /// At rest.
    pub(crate) const REST: Self = Self {
        velocity: Velocity::ZERO,
        lag_s: 0.0,
    };
}

/// Estimates velocity from samples whose stamps rise. Allocates when it is made, never after.
#[derive(Debug)]
pub struct VelocityEstimator {
    method: VelocityMethod,
    samples: VecDeque<PointerSample>,
    tracked: Tracked,
    tracked_before: Tracked,
}

impl VelocityEstimator {
    /// An estimator that has seen nothing.
    pub fn new(method: VelocityMethod) -> Self {
        Self {
            method,
            samples: VecDeque::with_capacity(CAPACITY),
            tracked: Tracked::default(),
            tracked_before: Tracked::default(),
        }
    }

    /// The method in use.
    pub fn method(&self) -> VelocityMethod {
        self.method
    }

    /// Chooses another method and forgets every sample.
    pub(crate) fn set_method(&mut self, method: VelocityMethod) {
        self.method = method;
        self.reset();
    }

    /// Forgets every sample.
    pub fn reset(&mut self) {
        self.samples.clear();
    }

    /// Takes the next sample. One that comes more than [`REST`] after the last begins a new series.
    pub fn push(&mut self, sample: PointerSample) {
        if self
            .newest()
            .is_some_and(|last| sample.stamp - last.stamp > REST)
        {
            self.reset();
        }
        if self.samples.len() == CAPACITY {
            self.samples.pop_front();
        }
        self.tracked_before = self.tracked;
        self.samples.push_back(sample);
        self.track();
    }

    /// Gives the newest sample another place.
    pub fn replace(&mut self, sample: PointerSample) {
        let Some(last) = self.samples.back_mut() else {
            return self.push(sample);
        };
        last.position = sample.position;
        self.tracked = self.tracked_before;
        self.track();
    }

    /// The velocity at `now`.
    pub fn estimate(&self, now: Instant) -> Estimate {
        let Some(newest) = self.newest() else {
            return Estimate::REST;
        };
        if self.samples.len() < 2 || now.saturating_duration_since(newest.stamp) > REST {
            return Estimate::REST;
        }
        let found = match self.method {
            VelocityMethod::FiniteDifference => self.finite_difference(),
            VelocityMethod::LineFit { window_s } => self.line_fit(window_s),
            VelocityMethod::AlphaBeta { alpha, beta } => Estimate {
                velocity: self.tracked.velocity,
                lag_s: (alpha / beta - 0.5) * self.last_step().1,
            },
            VelocityMethod::Kalman { .. } | VelocityMethod::OneEuro { .. } => Estimate {
                velocity: self.tracked.velocity,
                lag_s: self.tracked.lag_s,
            },
        };
        let Velocity {
            x_mm_per_s,
            y_mm_per_s,
        } = found.velocity;
        Estimate {
            velocity: Velocity::new(bounded(x_mm_per_s), bounded(y_mm_per_s)),
            ..found
        }
    }

    fn newest(&self) -> Option<&PointerSample> {
        self.samples.back()
    }

    /// The last displacement and its duration, s; none and 0 with fewer than two samples.
    fn last_step(&self) -> (Displacement, f64) {
        let mut newest_first = self.samples.iter().rev();
        match (newest_first.next(), newest_first.next()) {
            (Some(last), Some(previous)) => {
                let duration_s = (last.stamp - previous.stamp).as_secs_f64();
                (last.position - previous.position, duration_s)
            }
            _ => (Displacement::default(), 0.0),
        }
    }

    fn finite_difference(&self) -> Estimate {
        let (by, duration_s) = self.last_step();
        if duration_s <= 0.0 {
            return Estimate::REST;
        }
        Estimate {
            velocity: by.per(duration_s),
            lag_s: duration_s / 2.0,
        }
    }

    /// `v = Σ (τ − τ̄)(x − x̄) / Σ (τ − τ̄)²` over the samples of the window, τ counted from the
    /// newest. Two samples further apart than the window are a finite difference.
    fn line_fit(&self, window_s: f64) -> Estimate {
        let Some(newest) = self.newest() else {
            return Estimate::REST;
        };
        let seen = |sample: &PointerSample| {
            let tau_s = -(newest.stamp - sample.stamp).as_secs_f64();
            (tau_s, sample.position - newest.position)
        };
        let in_window = || {
            self.samples
                .iter()
                .rev()
                .map(seen)
                .take_while(|(tau_s, _)| *tau_s >= -window_s)
        };
        let mut n = 0.0;
        let (mut sum_tau, mut sum_x, mut sum_y) = (0.0, 0.0, 0.0);
        for (tau_s, by) in in_window() {
            n += 1.0;
            sum_tau += tau_s;
            sum_x += by.x_mm;
            sum_y += by.y_mm;
        }
        if n < 2.0 {
            return self.finite_difference();
        }
        let mean = (sum_tau / n, sum_x / n, sum_y / n);
        let (mut squares, mut slope_x, mut slope_y) = (0.0, 0.0, 0.0);
        for (tau_s, by) in in_window() {
            let off_s = tau_s - mean.0;
            squares += off_s * off_s;
            slope_x += off_s * (by.x_mm - mean.1);
            slope_y += off_s * (by.y_mm - mean.2);
        }
        if squares <= 0.0 {
            return Estimate::REST;
        }
        Estimate {
            velocity: Velocity::new(slope_x / squares, slope_y / squares),
            lag_s: -mean.0,
        }
    }

    /// Hands the newest sample to the filter, if the method is one; the first two samples give the
    /// first velocity. A sample of the same time as the last says nothing of velocity.
    fn track(&mut self) {
        let method = self.method;
        if matches!(
            method,
            VelocityMethod::FiniteDifference | VelocityMethod::LineFit { .. }
        ) {
            return;
        }
        let Some(position) = self.newest().map(|newest| newest.position) else {
            return;
        };
        let (by, duration_s) = self.last_step();
        self.tracked = if duration_s <= 0.0 {
            Tracked::at_rest(position)
        } else if self.samples.len() == 2 {
            Tracked::begun(method, position, (by, duration_s))
        } else {
            self.tracked.after(method, position, (by, duration_s))
        };
    }
}

fn bounded(mm_per_s: f64) -> f64 {
    // Places at opposite ends of the number range differ by infinity, and that by nothing: NaN.
    let mm_per_s = if mm_per_s.is_nan() {
        f64::INFINITY
    } else {
        mm_per_s
    };
    mm_per_s.clamp(-FASTEST_MM_PER_S, FASTEST_MM_PER_S)
}

#[cfg(test)]
mod tests;
