//! Equivalence and power: what a test that finds nothing does say.

use super::distribution::{ln_gamma, normal_lower, normal_upper, t_quantile_upper, t_upper};
use super::{Computed, Interval, Summary, undefined};

/// Steps of the integral over the spread that a sample happens to have.
const STEPS: u32 = 2000;

/// Two one-sided tests (Schuirmann 1987): whether a mean lies between two bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Equivalence {
    /// Values or differences that entered.
    pub n: usize,
    /// Their mean.
    pub mean: f64,
    /// The bounds, low and high.
    pub bounds: [f64; 2],
    /// t against the low and the high bound, n − 1 degrees of freedom each.
    pub t: [f64; 2],
    /// Degrees of freedom.
    pub df: f64,
    /// One-sided p against the low and the high bound.
    pub(crate) p_each: [f64; 2],
    /// The larger of the two: that of the claim.
    pub p: f64,
    /// The interval of level 1 − 2α, which lies inside the bounds exactly when p < α.
    pub interval: Interval,
    /// The probability to find equivalence at α if the true mean lies midway between the bounds
    /// and the true spread is that of the sample.
    pub power: Computed,
}

impl Equivalence {
    /// Whether the mean of a sample lies between `low` and `high`, at `alpha` (0.05).
    ///
    /// # Errors
    /// Bounds in disorder, α outside (0, 0.5), a sample without spread.
    pub fn of(sample: &Summary, [low, high]: [f64; 2], alpha: f64) -> Computed<Self> {
        let is_ordered = low < high && low.is_finite() && high.is_finite();
        if !(is_ordered && alpha > 0.0 && alpha < 0.5) {
            let reason = format!("bounds {low} and {high} at α = {alpha} leave nothing to test");
            return undefined(reason);
        }
        let interval = sample.interval(1.0 - 2.0 * alpha)?;
        let df = sample.n as f64 - 1.0;
        let t = [
            (sample.mean - low) / sample.se,
            (sample.mean - high) / sample.se,
        ];
        let p_each = [t_upper(t[0], df)?, t_upper(-t[1], df)?];
        let half_width = 0.5 * (high - low) / sample.se;
        Ok(Self {
            n: sample.n,
            mean: sample.mean,
            bounds: [low, high],
            t,
            df,
            p_each,
            p: p_each[0].max(p_each[1]),
            interval,
            power: power_of_tost([-half_width, half_width], df, alpha),
        })
    }
}

/// The probability that both one-sided tests reject. `bounds` are the distances of low and high
/// bound from the true mean, in true standard errors.
///
/// Exact: the integral over the sample's spread s of
/// Φ(high − t·s) − Φ(low + t·s) where that is positive (Phillips 1990).
///
/// # Errors
/// No degrees of freedom, α outside (0, 0.5).
pub(crate) fn power_of_tost([low, high]: [f64; 2], df: f64, alpha: f64) -> Computed {
    let t = t_quantile_upper(alpha, df)?;
    Ok(over_spread(df, |s| {
        (normal_lower(high - t * s) - normal_lower(low + t * s)).max(0.0)
    }))
}

/// The probability that a two-sided t test rejects at `alpha`.
///
/// `noncentrality` is how many true standard errors the true mean lies from the one tested: d·√n
/// for one sample or pairs with n − 1 degrees of freedom, d·√(n/2) for two samples of n with
/// 2n − 2.
///
/// # Errors
/// No degrees of freedom, α outside (0, 1).
pub fn power_of_t(noncentrality: f64, df: f64, alpha: f64) -> Computed {
    let t = t_quantile_upper(0.5 * alpha, df)?;
    Ok(over_spread(df, |s| {
        normal_upper(t * s - noncentrality) + normal_upper(t * s + noncentrality)
    }))
}

/// The mean of a function of s/σ over its distribution, χ/√df, by Simpson's rule.
fn over_spread(df: f64, function: impl Fn(f64) -> f64) -> f64 {
    // Ten standard deviations to either side; s/σ spreads by about 1/√(2 df).
    let reach = 10.0 / (2.0 * df).sqrt();
    let from = (1.0 - reach).max(0.0);
    let step = (1.0 + reach - from) / f64::from(STEPS);
    let ln_scale = std::f64::consts::LN_2 + 0.5 * df * (0.5 * df).ln() - ln_gamma(0.5 * df);
    let density = |u: f64| {
        let power = if df > 1.0 { (df - 1.0) * u.ln() } else { 0.0 };
        (ln_scale + power - 0.5 * df * u * u).exp()
    };
    let sum: f64 = (0..=STEPS)
        .map(|i| {
            let weight = match i {
                0 | STEPS => 1.0,
                i if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let u = from + f64::from(i) * step;
            weight * density(u) * function(u)
        })
        .sum();
    sum * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn the_spread_is_distributed_as_a_whole() {
        for df in [1.0, 2.0, 7.0, 11.0, 300.0] {
            let whole = over_spread(df, |_| 1.0);
            assert!((whole - 1.0).abs() < 1e-9, "{df}: {whole}");
            let variance = over_spread(df, |s| s * s);
            assert!((variance - 1.0).abs() < 1e-9, "{df}: {variance}");
        }
    }

    #[test]
    fn without_an_effect_the_power_of_t_is_alpha() -> Computed<()> {
        for df in [1.0, 7.0, 14.0] {
            let power = power_of_t(0.0, df, 0.05)?;
            assert!((power - 0.05).abs() < 1e-8, "{df}: {power}");
        }
        Ok(())
    }

    #[test]
    fn power_is_that_of_the_manual_of_r() -> Computed<()> {
        // power.t.test(n = 20, delta = 1, sd = 1): 0.8689528.
        let power = power_of_t(10.0_f64.sqrt(), 38.0, 0.05)?;
        assert!((power - 0.868_952_8).abs() < 1e-6, "{power}");
        Ok(())
    }

    #[test]
    fn the_power_of_equivalence_is_its_share_of_simulated_studies() -> Computed<()> {
        // Twelve subjects, mean 0.1, spread 1, bounds ±0.8.
        let root = 12.0_f64.sqrt();
        let power = power_of_tost([-0.9 * root, 0.7 * root], 11.0, 0.05)?;
        let mut random = Random::new(21);
        let mut n_found = 0;
        for _ in 0..20_000 {
            let sample: Vec<f64> = (0..12).map(|_| random.normal() + 0.1).collect();
            let interval = Summary::of(&sample)?.interval(0.9)?;
            n_found += i32::from(interval.low > -0.8 && interval.high < 0.8);
        }
        let share = f64::from(n_found) / 20_000.0;
        assert!((share - power).abs() < 0.011, "{share} and {power}");
        Ok(())
    }

    #[test]
    fn equivalence_and_the_interval_say_the_same() -> Computed<()> {
        let sample = Summary::of_mean_and_se(12, 0.02, 0.01)?;
        for bounds in [[-0.05, 0.05], [-0.05, 0.035], [0.0, 0.1], [-0.002, 0.1]] {
            let found = Equivalence::of(&sample, bounds, 0.05)?;
            let is_inside = found.interval.low > bounds[0] && found.interval.high < bounds[1];
            assert_eq!(is_inside, found.p < 0.05, "{found:?}");
        }
        assert!(
            Equivalence::of(&sample, [0.1, -0.1], 0.05).is_err(),
            "disorder"
        );
        assert!(
            Equivalence::of(&Summary::of(&[0.5; 4])?, [-1.0, 1.0], 0.05).is_err(),
            "no spread"
        );
        Ok(())
    }
}
