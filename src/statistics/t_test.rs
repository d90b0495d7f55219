//! Student's and Welch's t tests, from samples or from printed means and standard errors.
//!
//! t = (mean − μ₀)/SE with n − 1 degrees of freedom (Student 1908); for two samples the pooled
//! variance with n₁ + n₂ − 2, or each sample's own with the degrees of Welch (1947) and
//! Satterthwaite (1946). Effects are Cohen's d (1988): of one sample by its own standard
//! deviation (`d_z` of pairs), of two by the pooled one, for Welch by the root of the mean
//! variance.

use super::distribution::{t_quantile_upper, t_two_sided};
use super::{Computed, Freedom, Interval, Named, Outcome, Sides, Summary, undefined};

const LEVEL: f64 = 0.95;

/// Both tests of two samples: which one to believe depends on the spreads, so both stand.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoSamples {
    /// Without the assumption of equal variances; the default.
    pub welch: Outcome,
    /// With pooled variance.
    pub student: Outcome,
}

/// Whether the mean of a sample differs from `expected`, two-sided.
///
/// # Errors
/// A sample without spread.
pub fn one_sample_t(sample: &Summary, expected: f64) -> Computed<Outcome> {
    let effect = Named::of("d", (sample.mean - expected) / sample.sd);
    let difference = Difference {
        mean: sample.mean - expected,
        se: sample.se,
        df: sample.n as f64 - 1.0,
    };
    if sample.sd <= 0.0 {
        return Err(sample.without_spread());
    }
    let mut outcome = difference.outcome("Student t, one sample", vec![sample.n], effect)?;
    outcome.estimate = Ok(Named::of("mean", sample.mean));
    outcome.interval = sample.interval(LEVEL);
    Ok(outcome)
}

/// Whether the mean of `a − b` over pairs differs from 0, two-sided.
///
/// # Errors
/// No pairs, fewer than two, values that are not finite, differences without spread.
pub fn paired_t(a: &[f64], b: &[f64]) -> Computed<Outcome> {
    let mut outcome = one_sample_t(&Summary::of_differences(a, b)?, 0.0)?;
    outcome.test = "Student t, paired";
    if let Ok(effect) = &mut outcome.effect {
        effect.symbol = "d_z";
    }
    if let Ok(estimate) = &mut outcome.estimate {
        estimate.symbol = "mean difference";
    }
    Ok(outcome)
}

impl TwoSamples {
    /// Whether the means of two samples differ (a − b), two-sided.
    ///
    /// # Errors
    /// Both samples without spread.
    pub fn of(a: &Summary, b: &Summary) -> Computed<Self> {
        if a.sd <= 0.0 && b.sd <= 0.0 {
            return undefined("neither sample has any spread");
        }
        let n = vec![a.n, b.n];
        let (n_a, n_b) = (a.n as f64, b.n as f64);
        let mean = a.mean - b.mean;
        let (of_a, of_b) = (a.se * a.se, b.se * b.se);
        let sum = of_a + of_b;
        let unequal = Difference {
            mean,
            se: sum.sqrt(),
            df: sum * sum / (of_a * of_a / (n_a - 1.0) + of_b * of_b / (n_b - 1.0)),
        };
        let df = n_a + n_b - 2.0;
        let pooled = ((n_a - 1.0) * a.sd * a.sd + (n_b - 1.0) * b.sd * b.sd) / df;
        let equal = Difference {
            mean,
            se: (pooled * (1.0 / n_a + 1.0 / n_b)).sqrt(),
            df,
        };
        let d = |variance: f64| Named::of("d", mean / variance.sqrt());
        let halved = 0.5 * (a.sd * a.sd + b.sd * b.sd);
        Ok(Self {
            welch: unequal.outcome("Welch t, two samples", n.clone(), d(halved))?,
            student: equal.outcome("Student t, two samples", n, d(pooled))?,
        })
    }
}

/// A difference, its standard error and the degrees of freedom of that error.
struct Difference {
    mean: f64,
    se: f64,
    df: f64,
}

impl Difference {
    fn outcome(&self, test: &'static str, n: Vec<usize>, effect: Named) -> Computed<Outcome> {
        let t = self.mean / self.se;
        let half = t_quantile_upper(0.5 * (1.0 - LEVEL), self.df)? * self.se;
        Ok(Outcome {
            test,
            n,
            statistic: Named::of("t", t),
            df: Freedom::One(self.df),
            p: t_two_sided(t, self.df)?,
            sides: Sides::Two,
            effect: Ok(effect),
            estimate: Ok(Named::of("difference", self.mean)),
            interval: Ok(Interval::about(self.mean, half, LEVEL)),
            notes: Vec::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    fn assert_about(found: f64, printed: f64, half_digit: f64) {
        assert!(
            (found - printed).abs() <= half_digit,
            "{found} for {printed}"
        );
    }

    #[test]
    fn the_printed_scores_of_the_identification_experiments_follow_from_mean_and_error()
    -> Computed<()> {
        let first = Summary::of_mean_and_se(8, 41.3, 1.6)?;
        let second = Summary::of_mean_and_se(8, 64.1, 5.5)?;
        let chance = one_sample_t(&first, 25.0)?;
        assert_about(chance.statistic.value, 10.2, 0.05);
        assert_eq!(chance.df, Freedom::One(7.0));
        assert_about(chance.p, 1.9e-5, 5e-7);
        let chance = one_sample_t(&second, 25.0)?;
        assert_about(chance.statistic.value, 7.11, 5e-3);
        assert_about(chance.p, 1.9e-4, 5e-6);
        let both = TwoSamples::of(&second, &first)?;
        assert_about(both.student.statistic.value, 3.98, 5e-3);
        assert_eq!(both.student.df, Freedom::One(14.0));
        assert_about(both.student.p, 0.0014, 5e-5);
        assert_about(both.welch.p, 0.0039, 5e-5);
        assert!(
            matches!(both.welch.df, Freedom::One(df) if (df - 8.2).abs() < 0.05),
            "{:?}",
            both.welch.df
        );
        Ok(())
    }

    #[test]
    fn a_paired_test_is_one_of_differences() -> Computed<()> {
        let (a, b) = ([5.0, 7.0, 9.0, 4.0], [4.0, 4.0, 7.0, 4.0]);
        // Differences 1, 3, 2, 0: mean 1.5, sd √(5/3), t = 1.5/√(5/12).
        let outcome = paired_t(&a, &b)?;
        assert_about(
            outcome.statistic.value,
            1.5 / (5.0_f64 / 12.0).sqrt(),
            1e-13,
        );
        let effect = outcome.effect.map(|e| e.value)?;
        assert_about(effect, 1.5 / (5.0_f64 / 3.0).sqrt(), 1e-13);
        assert!(
            outcome.interval?.holds(0.0) == (outcome.p >= 0.05),
            "they agree"
        );
        Ok(())
    }

    #[test]
    fn samples_of_equal_size_and_spread_make_both_tests_the_same() -> Computed<()> {
        let (a, b) = (
            Summary::of(&[1.0, 2.0, 3.0])?,
            Summary::of(&[4.0, 5.0, 6.0])?,
        );
        let both = TwoSamples::of(&a, &b)?;
        assert_about(both.welch.p, both.student.p, 1e-14);
        assert_about(
            both.student.statistic.value,
            -3.0 / (2.0_f64 / 3.0).sqrt(),
            1e-13,
        );
        Ok(())
    }

    #[test]
    fn without_a_difference_one_study_of_twenty_finds_one() -> Computed<()> {
        let mut random = Random::new(17);
        let mut sample = |spread: f64| {
            let values: Vec<f64> = (0..8).map(|_| spread * random.normal()).collect();
            Summary::of(&values)
        };
        let (mut one, mut welch, mut holds) = (0, 0, 0);
        for _ in 0..4000 {
            let (a, b) = (sample(1.0)?, sample(3.0)?);
            one += i32::from(one_sample_t(&a, 0.0)?.p < 0.05);
            welch += i32::from(TwoSamples::of(&a, &b)?.welch.p < 0.05);
            holds += i32::from(a.interval(0.95)?.holds(0.0));
        }
        for found in [one, welch, 4000 - holds] {
            let share = f64::from(found) / 4000.0;
            assert!((0.035..0.065).contains(&share), "{share}");
        }
        Ok(())
    }

    #[test]
    fn answers_that_are_all_equal_are_not_computable() -> Computed<()> {
        let same = Summary::of(&[25.0; 8])?;
        assert!(one_sample_t(&same, 25.0).is_err(), "0/0");
        assert!(one_sample_t(&same, 20.0).is_err(), "5/0");
        assert!(TwoSamples::of(&same, &same).is_err(), "0/0");
        assert!(
            paired_t(&[0.3, 0.4], &[0.2, 0.3]).is_err(),
            "rounding alone"
        );
        Ok(())
    }
}
