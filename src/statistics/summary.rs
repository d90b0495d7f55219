//! Mean, spread and standard error of a sample, by sums about the mean in two passes.

use super::distribution::t_quantile_upper;
use super::{Computed, Interval, Undefined, undefined};

/// Rounding of a difference, as a multiple of the larger number.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Size, mean and spread of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// How many values, at least 2.
    pub n: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation with n − 1; exactly 0 when nothing but rounding is left.
    pub sd: f64,
    /// Standard error of the mean, sd/√n.
    pub se: f64,
}

impl Summary {
    /// Of at least two finite values.
    ///
    /// # Errors
    /// Fewer values, or one that is not finite.
    pub fn of(values: &[f64]) -> Computed<Self> {
        Self::at_scale(values, largest(values))
    }

    /// Of the differences `a − b` of pairs, whose rounding is that of the larger of the two.
    ///
    /// # Errors
    /// Different lengths, fewer than two pairs, values that are not finite.
    pub(crate) fn of_differences(a: &[f64], b: &[f64]) -> Computed<Self> {
        Self::at_scale(&differences(a, b)?, largest(a).max(largest(b)))
    }

    /// From printed numbers.
    ///
    /// # Errors
    /// `n` < 2, or a spread that is negative or not finite.
    pub fn of_mean_and_se(n: usize, mean: f64, se: f64) -> Computed<Self> {
        if n < 2 || !mean.is_finite() || !se.is_finite() || se < 0.0 {
            return undefined(format!("n = {n}, mean {mean}, SE {se} describe no sample"));
        }
        let sd = se * (n as f64).sqrt();
        Ok(Self { n, mean, sd, se })
    }

    fn at_scale(values: &[f64], scale: f64) -> Computed<Self> {
        at_least(values, 2)?;
        let (mean, deviations) = centred(values);
        let sum = sum_of_squares(&deviations);
        let n = values.len() as f64;
        let sd = if is_rounding(sum, values.len(), scale) {
            0.0
        } else {
            (sum / (n - 1.0)).sqrt()
        };
        let se = sd / n.sqrt();
        let n = values.len();
        Ok(Self { n, mean, sd, se })
    }

    /// The interval of the mean by Student's t: mean ± t·SE.
    ///
    /// # Errors
    /// A level outside (0, 1), or no spread at all.
    pub fn interval(&self, level: f64) -> Computed<Interval> {
        if self.sd <= 0.0 {
            return Err(self.without_spread());
        }
        let half = t_quantile_upper(0.5 * (1.0 - level), self.n as f64 - 1.0)? * self.se;
        Ok(Interval::about(self.mean, half, level))
    }

    pub(super) fn without_spread(&self) -> Undefined {
        Undefined::because(format!(
            "all {} values equal {}: no spread to judge by",
            self.n, self.mean
        ))
    }
}

/// The mean of finite values.
///
/// # Errors
/// No value, or one that is not finite.
pub fn mean(values: &[f64]) -> Computed {
    at_least(values, 1)?;
    Ok(centred(values).0)
}

/// Refuses fewer than `n` values and values that are not finite, with their place.
pub(super) fn at_least(values: &[f64], n: usize) -> Computed<()> {
    if let Some(place) = values.iter().position(|v| !v.is_finite()) {
        let reason = format!("value {} of {} is not finite", place + 1, values.len());
        return undefined(reason);
    }
    match values.len() {
        found if found >= n => Ok(()),
        0 => undefined("no values"),
        1 => undefined("one value alone"),
        found => undefined(format!("{found} values, {n} needed")),
    }
}

/// The differences `a − b` of as many values of each.
pub(super) fn differences(a: &[f64], b: &[f64]) -> Computed<Vec<f64>> {
    if a.len() != b.len() {
        return undefined(format!("{} values against {}: not pairs", a.len(), b.len()));
    }
    Ok(a.iter().zip(b).map(|(a, b)| a - b).collect())
}

/// Mean and deviations from it. Counts from the first value, so that a large offset that all
/// values share costs no digits.
pub(super) fn centred(values: &[f64]) -> (f64, Vec<f64>) {
    let Some(&origin) = values.first() else {
        return (0.0, Vec::new());
    };
    let n = values.len() as f64;
    let shift = values.iter().map(|v| v - origin).sum::<f64>() / n;
    let deviations = values.iter().map(|v| (v - origin) - shift).collect();
    (origin + shift, deviations)
}

pub(super) fn sum_of_squares(deviations: &[f64]) -> f64 {
    deviations.iter().map(|d| d * d).sum()
}

/// Standard deviation over n − 1.
pub(super) fn deviation(values: &[f64]) -> f64 {
    let (_, deviations) = centred(values);
    (sum_of_squares(&deviations) / (values.len() as f64 - 1.0)).sqrt()
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(p, q)| p * q).sum()
}

pub(super) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| v.abs().max(most))
}

/// Rounding of a difference of numbers as large as `scale`.
pub(super) fn rounding(scale: f64) -> f64 {
    ROUNDING * scale
}

/// Whether a sum of `n` squares is no more than rounding of numbers as large as `scale`.
pub(super) fn is_rounding(sum: f64, n: usize, scale: f64) -> bool {
    sum <= n as f64 * rounding(scale).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_of_few_values_is_that_by_hand() -> Computed<()> {
        let summary = Summary::of(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0])?;
        assert_eq!(summary.mean, 5.0);
        assert!(
            (summary.sd - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15,
            "n − 1"
        );
        assert!(
            (summary.se - summary.sd / 8.0_f64.sqrt()).abs() < 1e-15,
            "/√n"
        );
        let interval = summary.interval(0.95)?;
        let half = 2.364_624_251_592_785 * summary.se;
        assert!((interval.high - 5.0 - half).abs() < 1e-12, "{interval:?}");
        assert!(interval.holds(5.0) && !interval.holds(7.0), "{interval:?}");
        Ok(())
    }

    #[test]
    fn an_offset_of_a_million_million_costs_no_digits() -> Computed<()> {
        let plain = [1.0, 2.0, 4.0, 8.0];
        let far: Vec<f64> = plain.iter().map(|v| v + 1e12).collect();
        assert_eq!(Summary::of(&far)?.sd, Summary::of(&plain)?.sd);
        Ok(())
    }

    #[test]
    fn equal_values_have_no_spread_even_after_rounding() -> Computed<()> {
        assert_eq!(Summary::of(&[0.1; 7])?.sd, 0.0);
        let rounded = Summary::of_differences(&[0.3, 0.4, 1.1], &[0.2, 0.3, 1.0])?;
        assert_eq!(rounded.sd, 0.0);
        let refused = rounded.interval(0.95).map_err(|e| e.reason);
        assert!(
            refused.is_err_and(|r| r.contains("all 3 values equal")),
            "said"
        );
        Ok(())
    }

    #[test]
    fn what_is_no_sample_is_refused_with_its_place() {
        let reason = |values: &[f64]| Summary::of(values).map_err(|e| e.reason);
        assert_eq!(reason(&[]), Err("no values".to_owned()));
        assert_eq!(reason(&[1.0]), Err("one value alone".to_owned()));
        let broken = reason(&[1.0, f64::NAN, 2.0]);
        assert_eq!(broken, Err("value 2 of 3 is not finite".to_owned()));
        assert!(
            Summary::of_differences(&[1.0], &[1.0, 2.0]).is_err(),
            "pairs"
        );
        assert!(Summary::of_mean_and_se(8, 41.3, -1.0).is_err(), "negative");
    }
}
