//! Intervals by drawing subjects again, with replacement: percentile, and bias-corrected and
//! accelerated (Efron 1987; Efron & Tibshirani 1993, chapter 14).

use selvedge_foundation::numerics::{Random, quantile};

use super::distribution::{normal_lower, normal_quantile};
use super::summary::{centred, deviation, sum_of_squares};
use super::{Computed, Interval, Undefined, undefined};

/// How to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resampling {
    /// How often, at least 100.
    pub n_resamples: usize,
    /// Where the random numbers begin.
    pub seed: u64,
    /// Confidence of the intervals.
    pub level: f64,
}

/// What came of drawing subjects again.
#[derive(Debug, Clone, PartialEq)]
pub struct Bootstrap {
    /// The statistic of the subjects as they are.
    pub estimate: f64,
    /// Its standard deviation over resamples.
    pub se: f64,
    /// Quantiles of the resamples.
    pub percentile: Interval,
    /// Quantiles shifted by bias and acceleration.
    pub bca: Computed<Interval>,
    /// Resamples that entered.
    pub n_used: usize,
    /// Resamples for which the statistic could not be computed.
    pub n_undefined: usize,
}

impl Bootstrap {
    /// Bootstraps a statistic of subjects, which gets their numbers 0…n−1, repeats included.
    ///
    /// # Errors
    /// Fewer than 2 subjects or 100 resamples, a level outside (0, 1), a statistic that cannot be
    /// computed of the subjects as they are or of more than half of the resamples.
    pub fn of(
        n_subjects: usize,
        statistic: impl Fn(&[usize]) -> Computed,
        how: Resampling,
    ) -> Computed<Self> {
        if n_subjects < 2 || how.n_resamples < 100 || !(how.level > 0.0 && how.level < 1.0) {
            return undefined(format!(
                "{n_subjects} subjects and {} resamples at level {} give no bootstrap interval",
                how.n_resamples, how.level
            ));
        }
        let everyone: Vec<usize> = (0..n_subjects).collect();
        let estimate = statistic(&everyone)?;
        let mut random = Random::new(how.seed).branch("bootstrap over subjects");
        let mut drawn = vec![0; n_subjects];
        let mut values = Vec::with_capacity(how.n_resamples);
        for _ in 0..how.n_resamples {
            drawn.fill_with(|| random.index(n_subjects));
            values.extend(statistic(&drawn).ok().filter(|v| v.is_finite()));
        }
        let n_undefined = how.n_resamples - values.len();
        if 2 * values.len() < how.n_resamples {
            let reason = format!(
                "undefined in {n_undefined} of {} resamples",
                how.n_resamples
            );
            return undefined(reason);
        }
        let se = deviation(&values);
        let tails = [0.5 * (1.0 - how.level), 0.5 * (1.0 + how.level)];
        let bca = acceleration(&everyone, &statistic)
            .and_then(|a| shifted(&values, estimate, a, tails))
            .map(|shares| between(&mut values, shares, how.level));
        Ok(Self {
            estimate,
            se,
            percentile: between(&mut values, tails, how.level),
            bca,
            n_used: values.len(),
            n_undefined,
        })
    }

    /// Standard errors of several numbers of subjects at once: their standard deviations over draws
    /// of subjects with replacement. The statistic gets the numbers of subjects 0…n−1, repeats
    /// included.
    ///
    /// # Errors
    /// Fewer than 2 subjects or 20 draws, or more than half of the draws without the numbers; the
    /// reason of the last one without is told.
    pub fn errors(
        n_subjects: usize,
        statistic: impl Fn(&[usize]) -> Computed<Vec<f64>>,
        (n_draws, seed): (usize, u64),
    ) -> Computed<Vec<f64>> {
        if n_subjects < 2 || n_draws < 20 {
            let reason = format!(
                "an error over subjects needs two of them and 20 draws, not {n_subjects} and \
                 {n_draws}"
            );
            return undefined(reason);
        }
        let mut random = Random::new(seed).branch("errors over subjects");
        let mut drawn = vec![0; n_subjects];
        let mut draws: Vec<Vec<f64>> = Vec::with_capacity(n_draws);
        let mut why = String::new();
        for _ in 0..n_draws {
            drawn.fill_with(|| random.index(n_subjects));
            match statistic(&drawn) {
                Ok(values) => draws.push(values),
                Err(error) => why = error.reason,
            }
        }
        if 2 * draws.len() < n_draws {
            let n_undefined = n_draws - draws.len();
            let reason =
                format!("undefined in {n_undefined} of {n_draws} draws of subjects: {why}");
            return undefined(reason);
        }
        let error = |at: usize| {
            let values: Vec<f64> = draws.iter().map(|draw| draw[at]).collect();
            deviation(&values)
        };
        let n_values = draws.iter().map(Vec::len).min().unwrap_or(0);
        Ok((0..n_values).map(error).collect())
    }

    /// Standard errors of several numbers of subjects at once by leaving each subject out in turn
    /// (Tukey 1958): √((n − 1)/n Σ(value without one − their mean)²). Costs one fit a subject.
    ///
    /// # Errors
    /// Fewer than 2 subjects, or numbers that cannot be computed without one of them.
    pub fn jackknife_errors(
        n_subjects: usize,
        statistic: impl Fn(&[usize]) -> Computed<Vec<f64>>,
    ) -> Computed<Vec<f64>> {
        if n_subjects < 2 {
            let reason = format!("an error over subjects needs two of them, not {n_subjects}");
            return undefined(reason);
        }
        let without = |left_out: usize| {
            let rest: Vec<usize> = (0..n_subjects).filter(|at| *at != left_out).collect();
            statistic(&rest).map_err(|why| {
                let number = left_out + 1;
                Undefined::because(format!("without subject {number}: {}", why.reason))
            })
        };
        let all: Vec<Vec<f64>> = (0..n_subjects).map(without).collect::<Computed<_>>()?;
        let n = n_subjects as f64;
        let error = |at: usize| {
            let values: Vec<f64> = all.iter().map(|values| values[at]).collect();
            let (_, deviations) = centred(&values);
            (sum_of_squares(&deviations) * (n - 1.0) / n).sqrt()
        };
        let n_values = all.iter().map(Vec::len).min().unwrap_or(0);
        Ok((0..n_values).map(error).collect())
    }
}

fn between(values: &mut [f64], [low, high]: [f64; 2], level: f64) -> Interval {
    Interval::new([quantile(values, low), quantile(values, high)], level)
}

/// a = Σd³/(6 (Σd²)^1.5) with d the mean of the values that leave one out, less each of them.
fn acceleration(everyone: &[usize], statistic: &impl Fn(&[usize]) -> Computed) -> Computed {
    let without = |left_out: &usize| {
        let rest: Vec<usize> = everyone.iter().copied().filter(|s| s != left_out).collect();
        statistic(&rest)
    };
    let values: Vec<f64> = everyone.iter().map(without).collect::<Computed<_>>()?;
    let (_, deviations) = centred(&values);
    let squares = sum_of_squares(&deviations);
    if squares <= 0.0 {
        return undefined("leaving out any one changes nothing");
    }
    let cubes: f64 = deviations.iter().map(|d| -d.powi(3)).sum();
    Ok(cubes / (6.0 * squares.powf(1.5)))
}

/// The shares of the resamples that stand in for the tails. Resamples equal to the estimate count
/// half as below it.
fn shifted(values: &[f64], estimate: f64, a: f64, tails: [f64; 2]) -> Computed<[f64; 2]> {
    let below = values.iter().filter(|&&v| v < estimate).count() as f64;
    let above = values.iter().filter(|&&v| v > estimate).count() as f64;
    let n = values.len() as f64;
    let bias = normal_quantile((0.5 * (n - below - above) + below) / n)?;
    let share = |tail: f64| -> Computed {
        let z = bias + normal_quantile(tail)?;
        let stretch = 1.0 - a * z;
        if stretch <= 0.0 {
            return undefined("the acceleration is too strong");
        }
        Ok(normal_lower(bias + z / stretch))
    };
    Ok([share(tails[0])?, share(tails[1])?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Summary, mean};

    const HOW: Resampling = Resampling {
        n_resamples: 4000,
        seed: 3,
        level: 0.95,
    };

    fn mean_of(values: &[f64]) -> impl Fn(&[usize]) -> Computed {
        move |drawn| mean(&drawn.iter().map(|&i| values[i]).collect::<Vec<_>>())
    }

    #[test]
    fn a_mean_of_many_has_the_interval_of_the_normal() -> Computed<()> {
        let mut random = Random::new(5);
        let values: Vec<f64> = (0..200).map(|_| random.normal()).collect();
        let summary = Summary::of(&values)?;
        let found = Bootstrap::of(200, mean_of(&values), HOW)?;
        let expected = summary.interval(0.95)?;
        for interval in [found.percentile, found.bca.clone()?] {
            assert!(
                (interval.low - expected.low).abs() < 0.2 * summary.se,
                "{found:?}"
            );
            assert!(
                (interval.high - expected.high).abs() < 0.2 * summary.se,
                "{found:?}"
            );
        }
        assert!((found.se / summary.se - 1.0).abs() < 0.05, "{}", found.se);
        assert_eq!(
            found,
            Bootstrap::of(200, mean_of(&values), HOW)?,
            "the seed decides"
        );
        Ok(())
    }

    #[test]
    fn errors_of_several_numbers_are_those_of_each() -> Computed<()> {
        let mut random = Random::new(8);
        let values: Vec<f64> = (0..60).map(|_| random.normal()).collect();
        let both = |drawn: &[usize]| {
            let mean = mean_of(&values)(drawn)?;
            Ok(vec![mean, 10.0 * mean])
        };
        let found = Bootstrap::errors(60, both, (2000, 4))?;
        let se = Summary::of(&values)?.se;
        assert!((found[0] / se - 1.0).abs() < 0.06, "{found:?} and {se}");
        assert!((found[1] / found[0] - 10.0).abs() < 1e-9, "{found:?}");
        assert!(Bootstrap::errors(1, both, (200, 4)).is_err(), "one alone");
        let never = |_: &[usize]| Err(Undefined::because("apart"));
        let described = Bootstrap::errors(5, never, (50, 4)).unwrap_err().reason;
        assert!(
            described.contains("50 of 50") && described.contains("apart"),
            "{described}"
        );
        Ok(())
    }

    #[test]
    fn leaving_each_out_gives_the_error_of_a_mean_exactly() -> Computed<()> {
        let values = [1.0, 4.0, 2.0, 9.0, 3.5];
        let found =
            Bootstrap::jackknife_errors(5, |drawn| Ok(vec![mean_of(&values)(drawn)?, 0.0]))?;
        let se = Summary::of(&values)?.se;
        assert!((found[0] / se - 1.0).abs() < 1e-12, "{found:?} and {se}");
        assert_eq!(found[1], 0.0);
        assert!(
            Bootstrap::jackknife_errors(1, |_| Ok(vec![1.0])).is_err(),
            "one alone"
        );
        let why = Bootstrap::jackknife_errors(3, |_| Err(Undefined::because("apart"))).unwrap_err();
        assert_eq!(why.reason, "without subject 1: apart");
        Ok(())
    }

    #[test]
    fn a_skewed_sample_shifts_the_accelerated_interval_to_its_tail() -> Computed<()> {
        let values: Vec<f64> = (1..=20).map(|i| f64::from(i).powi(3)).collect();
        let found = Bootstrap::of(20, mean_of(&values), HOW)?;
        let bca = found.bca?;
        assert!(bca.low > found.percentile.low, "{bca:?}");
        assert!(bca.high > found.percentile.high, "{bca:?}");
        Ok(())
    }

    #[test]
    fn acceleration_of_a_mean_is_a_sixth_of_its_skewness() -> Computed<()> {
        let values = [0.0, 1.0, 5.0, 2.0, 9.0];
        let (_, d) = centred(&values);
        let skewness = d.iter().map(|d| d.powi(3)).sum::<f64>() / sum_of_squares(&d).powf(1.5);
        let a = acceleration(&[0, 1, 2, 3, 4], &mean_of(&values))?;
        assert!((a - skewness / 6.0).abs() < 1e-12, "{a}");
        Ok(())
    }

    #[test]
    fn one_subject_and_answers_all_equal_have_no_accelerated_interval() -> Computed<()> {
        assert!(Bootstrap::of(1, mean_of(&[2.0]), HOW).is_err(), "one alone");
        let same = Bootstrap::of(8, mean_of(&[2.0; 8]), HOW)?;
        assert_eq!((same.percentile.low, same.percentile.high), (2.0, 2.0));
        assert!(same.bca.is_err(), "nothing to accelerate");
        Ok(())
    }
}
