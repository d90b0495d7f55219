//! A Kalman filter for a constant velocity, carried from sample to sample.
//!
//! It begins with the difference of the first two samples, so that a constant velocity is found at
//! once. Its lag is carried along: it obeys the same recursion as the error under an acceleration
//! of 1 mm/s², whatever the distances between samples.

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
    /// What the filter thinks of its own error, both axes alike.
    covariance: Covariance,
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
pub(super) struct Noise {
    /// Power density of the acceleration, mm²/s³.
    pub(super) acceleration: f64,
    /// Variance of a measured coordinate, mm².
    pub(super) measurement: f64,
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
        noise: Noise,
        position: Point,
        (by, duration_s): (Displacement, f64),
    ) -> Self {
        Self {
            position,
            velocity: by.per(duration_s),
            position_lag_s2: 0.0,
            lag_s: 0.5 * duration_s,
            covariance: Covariance::of_difference(noise, duration_s),
        }
    }

    /// After the next sample, at `position` and `duration_s` > 0 after the one before. A state that
    /// is no number any more begins anew.
    #[must_use]
    pub(super) fn after(self, noise: Noise, position: Point, duration_s: f64) -> Self {
        let predicted = self.covariance.predicted(noise, duration_s);
        let gains = predicted.gains(noise);
        let next = Self {
            covariance: predicted.corrected(gains),
            ..self.corrected(position, duration_s, gains)
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

    fn is_finite(&self) -> bool {
        self.position.is_finite()
            && self.velocity.is_finite()
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
