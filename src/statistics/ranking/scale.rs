//! Values of items on a scale without a zero of its own, and how sure they are.

use nalgebra::DMatrix;

use crate::{Computed, Interval, normal_quantile, undefined};

/// A number with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard error.
    pub se: f64,
}

impl Estimate {
    /// Its interval by the normal distribution, value ± z·SE.
    ///
    /// # Errors
    /// A level outside (0, 1).
    pub fn interval(&self, level: f64) -> Computed<Interval> {
        let half = normal_quantile(0.5 + 0.5 * level)? * self.se;
        Ok(Interval::about(self.value, half, level))
    }
}

/// Values of items that sum to zero, one an item.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// The values.
    pub values: Vec<f64>,
    /// Their variances and covariances, a row an item, from the inverse of the observed
    /// information under the constraint that the values sum to zero: every row sums to zero too.
    pub covariance: Vec<Vec<f64>>,
}

impl Scale {
    /// Of the first items of a covariance that may have more rows.
    pub(super) fn of(values: &[f64], covariance: &DMatrix<f64>) -> Self {
        let items = 0..values.len();
        let row = |i| items.clone().map(|j| covariance[(i, j)]).collect();
        Self {
            values: values.to_vec(),
            covariance: items.clone().map(row).collect(),
        }
    }

    /// The values with their standard errors about the mean of all.
    pub fn centred(&self) -> Vec<Estimate> {
        let estimate = |(i, &value): (usize, &f64)| Estimate {
            value,
            se: self.covariance[i][i].max(0.0).sqrt(),
        };
        self.values.iter().enumerate().map(estimate).collect()
    }

    /// How far the first item lies above the second, with the standard error of that.
    ///
    /// # Errors
    /// No such items, or one item twice.
    pub fn difference(&self, upper: usize, lower: usize) -> Computed<Estimate> {
        let n = self.values.len();
        if upper >= n || lower >= n || upper == lower {
            let (upper, lower) = (upper + 1, lower + 1);
            let reason = format!("items {upper} and {lower} of {n} have no difference");
            return undefined(reason);
        }
        let c = &self.covariance;
        let variance = c[upper][upper] + c[lower][lower] - 2.0 * c[upper][lower];
        Ok(Estimate {
            value: self.values[upper] - self.values[lower],
            se: variance.max(0.0).sqrt(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_has_the_error_of_both() -> Computed<()> {
        let scale = Scale {
            values: vec![0.5, -0.5],
            covariance: vec![vec![0.25, -0.25], vec![-0.25, 0.25]],
        };
        assert_eq!(scale.centred()[1].se, 0.5);
        let found = scale.difference(1, 0)?;
        assert_eq!((found.value, found.se), (-1.0, 1.0));
        let interval = scale.difference(0, 1)?.interval(0.95)?;
        assert!((interval.low - (1.0 - 1.959_963_984_540_054)).abs() < 1e-12);
        assert!(scale.difference(2, 0).is_err(), "no such item");
        assert!(scale.difference(1, 1).is_err(), "itself");
        Ok(())
    }
}
