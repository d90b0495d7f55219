//! Estimators that carry a state from sample to sample: alpha–beta, Kalman, one-euro.
//!
//! All begin with the difference of the first two samples, so that a constant velocity is found at
//! once. The Kalman and the one-euro filter carry their lag along: it obeys the same recursion as
//! their error under an acceleration of 1 mm/s², whatever the distances between samples.

use std::f64::consts::TAU;

use crate::VelocityMethod;
use selvedge_foundation::geometry::{Displacement, Point, Velocity};

/// What a filter knows after a sample.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tracked {
    position: Point,
    /// The estimate, mm/s.
    pub(super) velocity: Velocity,
    /// True position less `position` for each mm/s² of a constant acceleration, s².
    position_lag_s2: f64,
    /// True velocity less the estimate for each mm/s² of a constant acceleration, s.
    pub(super) lag_s: f64,
    /// What the Kalman filter thinks of its own error, both axes alike.
    covariance: Covariance,
    /// Differences behind the one-euro filter's second low pass: its notion of speed.
    smoothed: Velocity,
}

/// Covariance of position and velocity along one axis.
#[derive(Debug, Clone, Copy, Default)]
struct Covariance {
    /// mm².
    position: f64,
    /// mm²/s.
    mixed: f64,
    /// mm²/s².
    velocity: f64,
}

/// The numbers of a constant-velocity Kalman filter.
#[derive(Debug, Clone, Copy)]
struct Noise {
    /// Power density of the acceleration, mm²/s³.
    acceleration: f64,
    /// Variance of a measured coordinate, mm².
    measurement: f64,
}

impl Tracked {
    /// At rest where the newest sample is.
    pub(super) fn at_rest(position: Point) -> Self {
        Self {
            position,
            ..Self::default()
        }
    }

    /// After the first two samples, the newest at `position`.
    pub(super) fn begun(
        method: VelocityMethod,
        position: Point,
        (by, duration_s): (Displacement, f64),
    ) -> Self {
        let velocity = by.per(duration_s);
        Self {
            position,
            velocity,
            position_lag_s2: 0.0,
            lag_s: 0.5 * duration_s,
            covariance: noise_of(method).map_or_else(Covariance::default, |noise| {
                Covariance::of_difference(noise, duration_s)
            }),
            smoothed: velocity,
        }
    }

    /// After the next sample, at `position`, `by` and `duration_s` > 0 from the one before. A state
    /// that is no number any more begins anew.
    #[must_use]
    pub(super) fn after(
        self,
        method: VelocityMethod,
        position: Point,
        (by, duration_s): (Displacement, f64),
    ) -> Self {
        let next = match method {
            VelocityMethod::AlphaBeta { alpha, beta } => {
                self.corrected(position, duration_s, [alpha, beta / duration_s])
            }
            VelocityMethod::Kalman { .. } => self.kalman(method, position, duration_s),
            VelocityMethod::OneEuro {
                min_cutoff_hz,
                beta_per_mm,
                derivative_cutoff_hz,
            } => {
                let cutoffs = [min_cutoff_hz, beta_per_mm, derivative_cutoff_hz];
                self.one_euro(position, (by, duration_s), cutoffs)
            }
            VelocityMethod::FiniteDifference | VelocityMethod::LineFit { .. } => self,
        };
        if next.is_finite() {
            next
        } else {
            Self::at_rest(position)
        }
    }

    /// `r = z − (x + T v)`, `x ← x + T v + g₀ r`, `v ← v + g₁ r`, and the same for the lags.
    fn corrected(self, measured: Point, duration_s: f64, gains: [f64; 2]) -> Self {
        let moved = Displacement::new(
            self.velocity.x_mm_per_s * duration_s,
            self.velocity.y_mm_per_s * duration_s,
        );
        let predicted = self.position + moved;
        let error = measured - predicted;
        let position_lag_s2 =
            self.position_lag_s2 + duration_s * self.lag_s + 0.5 * duration_s * duration_s;
        Self {
            position: predicted + Displacement::new(gains[0] * error.x_mm, gains[0] * error.y_mm),
            velocity: Velocity::new(
                self.velocity.x_mm_per_s + gains[1] * error.x_mm,
                self.velocity.y_mm_per_s + gains[1] * error.y_mm,
            ),
            position_lag_s2: (1.0 - gains[0]) * position_lag_s2,
            lag_s: self.lag_s + duration_s - gains[1] * position_lag_s2,
            ..self
        }
    }

    fn kalman(self, method: VelocityMethod, measured: Point, duration_s: f64) -> Self {
        let Some(noise) = noise_of(method) else {
            return self;
        };
        let predicted = self.covariance.predicted(noise, duration_s);
        let gains = predicted.gains(noise);
        Self {
            covariance: predicted.corrected(gains),
            ..self.corrected(measured, duration_s, gains)
        }
    }

    /// Low passes over the differences `d` of neighbouring samples: `ŝ ← ŝ + a(f_d)(d − ŝ)`, then
    /// `v ← v + a(f_min + β|ŝ|)(d − v)` with `a(f) = T / (T + 1/2πf)`. Two samples that come almost
    /// at once weigh as little as their distance in time.
    fn one_euro(
        self,
        measured: Point,
        (by, duration_s): (Displacement, f64),
        [min_cutoff_hz, beta_per_mm, derivative_cutoff_hz]: [f64; 3],
    ) -> Self {
        let difference = by.per(duration_s);
        let share = |cutoff_hz: f64| duration_s / (duration_s + 1.0 / (TAU * cutoff_hz));
        let smoothed = mixed(self.smoothed, difference, share(derivative_cutoff_hz));
        let speed = smoothed.speed_mm_per_s();
        let share = share(min_cutoff_hz + beta_per_mm * speed);
        Self {
            position: measured,
            velocity: mixed(self.velocity, difference, share),
            lag_s: (1.0 - share) * (self.lag_s + duration_s) + share * 0.5 * duration_s,
            smoothed,
            ..self
        }
    }

    fn is_finite(&self) -> bool {
        self.position.is_finite()
            && self.velocity.is_finite()
            && self.smoothed.is_finite()
            && self.lag_s.is_finite()
            && self.covariance.velocity.is_finite()
    }
}

impl Covariance {
    /// Of a position measured once and a velocity from two measurements.
    fn of_difference(noise: Noise, duration_s: f64) -> Self {
        let variance = noise.measurement;
        Self {
            position: variance,
            mixed: variance / duration_s,
            velocity: 2.0 * variance / (duration_s * duration_s)
                + noise.acceleration * duration_s / 3.0,
        }
    }

    /// `F P Fᵀ + Q` with `F = [1 T; 0 1]` and `Q = q [T³/3 T²/2; T²/2 T]`.
    fn predicted(self, noise: Noise, duration_s: f64) -> Self {
        let t = duration_s;
        let q = noise.acceleration;
        Self {
            position: self.position
                + t * (2.0 * self.mixed + t * self.velocity)
                + q * t * t * t / 3.0,
            mixed: self.mixed + t * self.velocity + 0.5 * q * t * t,
            velocity: self.velocity + q * t,
        }
    }

    /// Shares of the position error that correct position and velocity.
    fn gains(self, noise: Noise) -> [f64; 2] {
        let spread = self.position + noise.measurement;
        [self.position / spread, self.mixed / spread]
    }

    fn corrected(self, gains: [f64; 2]) -> Self {
        Self {
            position: (1.0 - gains[0]) * self.position,
            mixed: (1.0 - gains[0]) * self.mixed,
            velocity: self.velocity - gains[1] * self.mixed,
        }
    }
}

fn noise_of(method: VelocityMethod) -> Option<Noise> {
    let VelocityMethod::Kalman {
        acceleration_mm2_per_s3,
        noise_mm,
    } = method
    else {
        return None;
    };
    Some(Noise {
        acceleration: acceleration_mm2_per_s3,
        measurement: noise_mm * noise_mm,
    })
}

/// A share of the way from one velocity to another.
fn mixed(from: Velocity, to: Velocity, share: f64) -> Velocity {
    Velocity::new(
        from.x_mm_per_s + share * (to.x_mm_per_s - from.x_mm_per_s),
        from.y_mm_per_s + share * (to.y_mm_per_s - from.y_mm_per_s),
    )
}
