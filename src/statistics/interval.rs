//! Intervals of shares and of correlations.

use super::distribution::{finite, normal_quantile};
use super::{Computed, Interval, undefined};

impl Interval {
    /// The interval of a share of `hits` in `trials` by Wilson (1927): the shares that a score test
    /// does not reject, never outside 0…1 and of use with few trials.
    ///
    /// # Errors
    /// No trials, more hits than trials, a level outside (0, 1).
    pub fn wilson(hits: u64, trials: u64, level: f64) -> Computed<Self> {
        if trials == 0 || hits > trials {
            return undefined(format!("{hits} of {trials} trials is no share"));
        }
        let z = normal_quantile(0.5 + 0.5 * level)?;
        let n = trials as f64;
        let (share, z2) = (hits as f64 / n, z * z);
        let middle = (share + 0.5 * z2 / n) / (1.0 + z2 / n);
        let half = z / (1.0 + z2 / n) * (share * (1.0 - share) / n + 0.25 * z2 / (n * n)).sqrt();
        Ok(Self::new(
            [
                if hits == 0 { 0.0 } else { middle - half },
                if hits == trials { 1.0 } else { middle + half },
            ],
            level,
        ))
    }

    /// The interval of a correlation by Fisher's z (1915): tanh(atanh r ± z·se), with the standard
    /// error 1/√(n − 3) of Pearson's r.
    ///
    /// # Errors
    /// n < 4, |r| = 1.
    pub fn fisher_z(r: f64, n: usize, level: f64) -> Computed<Self> {
        fisher_z_with(r, n, 1.0, level)
    }
}

/// Likewise with the variance of z as `inflation`/(n − 3).
pub(super) fn fisher_z_with(r: f64, n: usize, inflation: f64, level: f64) -> Computed<Interval> {
    if n < 4 {
        let reason = format!("{n} pairs give no interval of a correlation, 4 are needed");
        return undefined(reason);
    }
    let middle = finite(r.atanh(), "Fisher z of a correlation of one")?;
    let half = normal_quantile(0.5 + 0.5 * level)? * (inflation / (n as f64 - 3.0)).sqrt();
    Ok(Interval::new(
        [(middle - half).tanh(), (middle + half).tanh()],
        level,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::binomial_mass;

    #[test]
    fn the_ends_of_wilson_are_where_the_score_test_turns() -> Computed<()> {
        for (hits, trials) in [(1, 10), (20, 40), (39, 40), (27, 80)] {
            let interval = Interval::wilson(hits, trials, 0.95)?;
            for end in [interval.low, interval.high] {
                let n = trials as f64;
                let score = (hits as f64 / n - end) / (end * (1.0 - end) / n).sqrt();
                assert!(
                    (score.abs() - 1.959_963_984_540_054).abs() < 1e-10,
                    "{score}"
                );
            }
        }
        Ok(())
    }

    #[test]
    fn wilson_stays_inside_and_holds_the_truth_as_often_as_it_says() -> Computed<()> {
        assert_eq!(Interval::wilson(0, 5, 0.95)?.low, 0.0);
        assert_eq!(Interval::wilson(5, 5, 0.95)?.high, 1.0);
        assert!(Interval::wilson(0, 0, 0.95).is_err(), "no trials");
        let mut coverage = 0.0;
        for hits in 0..=40 {
            if Interval::wilson(hits, 40, 0.95)?.holds(0.413) {
                coverage += binomial_mass(hits, 40, 0.413);
            }
        }
        assert!((0.93..0.98).contains(&coverage), "{coverage}");
        Ok(())
    }

    #[test]
    fn a_correlation_of_sixteen_textiles_has_the_interval_by_hand() -> Computed<()> {
        let interval = Interval::fisher_z(0.55, 16, 0.95)?;
        // atanh 0.55 = ½ ln(1.55/0.45); se = 1/√13.
        let middle = 0.5 * (1.55_f64 / 0.45).ln();
        let half = 1.959_963_984_540_054 / 13.0_f64.sqrt();
        assert!(
            (interval.low - (middle - half).tanh()).abs() < 1e-14,
            "{interval:?}"
        );
        assert!(
            (interval.high - (middle + half).tanh()).abs() < 1e-14,
            "{interval:?}"
        );
        assert!(Interval::fisher_z(1.0, 16, 0.95).is_err(), "infinite z");
        assert!(Interval::fisher_z(0.5, 3, 0.95).is_err(), "no error");
        Ok(())
    }
}
