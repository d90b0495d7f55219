//! A friction trace: the coefficient of friction at a uniform step along one stroke.
//!
//! Figures as the Kawabata surface tester defines them, over the length X of the trace:
//! `MIU = (1/X) ∫ µ dx` and `MMD = (1/X) ∫ |µ − MIU| dx`, both without a unit.

use super::SurfaceError;
use super::band::without_long_waves;

/// The coefficient of friction at a uniform step in mm, in the order of travel.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionTrace {
    step_mm: f64,
    mu: Vec<f64>,
}

impl FrictionTrace {
    /// A trace of coefficients, `step_mm` apart.
    ///
    /// # Errors
    /// A step outside 0.0005–0.5 mm; fewer than two samples; a coefficient that is not finite or
    /// beyond ±10.
    pub(crate) fn new(step_mm: f64, mu: Vec<f64>) -> Result<Self, SurfaceError> {
        if !(0.0005..=0.5).contains(&step_mm) {
            return Err(SurfaceError::Step { step_mm });
        }
        let n_rows = mu.len();
        if n_rows < 2 {
            return Err(SurfaceError::TooFew { n_rows });
        }
        match mu.iter().position(|mu| !(-10.0..=10.0).contains(mu)) {
            Some(index) => Err(SurfaceError::NoFriction {
                row: index + 1,
                n_rows,
                mu: mu[index],
            }),
            None => Ok(Self { step_mm, mu }),
        }
    }

    /// A trace at places in mm that rise evenly (each step within 1 % of the mean step).
    ///
    /// # Errors
    /// As [`FrictionTrace::new`]; uneven places.
    pub(crate) fn from_positions(x_mm: &[f64], mu: Vec<f64>) -> Result<Self, SurfaceError> {
        let n_rows = x_mm.len().min(mu.len());
        let step_mm =
            super::profile::even_step_mm(x_mm, n_rows)?.ok_or(SurfaceError::TooFew { n_rows })?;
        Self::new(step_mm, mu)
    }

    /// The distance between neighbouring samples, mm.
    pub fn step_mm(&self) -> f64 {
        self.step_mm
    }

    /// The coefficients, in the order of travel.
    pub fn mu(&self) -> &[f64] {
        &self.mu
    }

    /// The mean coefficient of friction, MIU.
    pub fn miu(&self) -> f64 {
        self.mu.iter().sum::<f64>() / self.mu.len() as f64
    }

    /// The mean deviation of friction, MMD.
    pub fn mmd(&self) -> f64 {
        mean_deviation(&self.mu)
    }

    /// MMD without what varies over more than 1 mm: see [`without_long_waves`].
    pub fn mmd_official(&self) -> f64 {
        mean_deviation(&without_long_waves(self.step_mm, &self.mu))
    }
}

/// The mean absolute deviation of values from their mean: `(1/n) Σ |v_i − v̄|`. NaN of none.
pub(crate) fn mean_deviation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|value| (value - mean).abs()).sum::<f64>() / n
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    #[test]
    fn a_sine_about_a_mean_has_its_miu_and_mmd() {
        let wave = |i: i32| 0.2 + 0.03 * (TAU * f64::from(i) / 100.0).sin();
        let trace = FrictionTrace::new(0.005, (0..4000).map(wave).collect()).unwrap();
        assert!((trace.miu() - 0.2).abs() < 1e-12, "{}", trace.miu());
        let expected = 0.03 * 2.0 / PI;
        assert!((trace.mmd() - expected).abs() < 1e-5, "{}", trace.mmd());
    }

    #[test]
    fn the_official_band_leaves_out_slow_changes_of_friction() {
        let mu = |i: i32| {
            let x_mm = f64::from(i) * 0.01;
            0.2 + 0.02 * (TAU * x_mm / 0.25).sin() + 0.02 * (TAU * x_mm / 10.0).sin()
        };
        let trace = FrictionTrace::new(0.01, (0..2000).map(mu).collect()).unwrap();
        let quick = 0.02 * 2.0 / PI;
        let found = trace.mmd_official();
        assert!(
            (found / quick - 1.0).abs() < 0.02,
            "{found} against {quick}"
        );
        assert!(trace.mmd() > 1.2 * quick, "{}", trace.mmd());
    }

    #[test]
    fn what_is_no_friction_is_refused() {
        for (mu, expected) in [
            (vec![0.2, f64::NAN], "row 2 of 2: the friction is NaN"),
            (vec![0.2, 50.0], "row 2 of 2: the friction is 50"),
            (vec![0.2], "1 sample"),
        ] {
            let error = FrictionTrace::new(0.01, mu).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
        let uneven = FrictionTrace::from_positions(&[0.0, 0.1, 0.3], vec![0.2; 3]);
        assert!(
            matches!(uneven, Err(SurfaceError::Uneven { .. })),
            "{uneven:?}"
        );
    }
}
