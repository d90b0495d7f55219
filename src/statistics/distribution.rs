//! Tails and quantiles of the distributions that tests refer to, each tail computed as itself and
//! never as one minus the other, so that small p values keep their digits.
//!
//! Student's t, Fisher's F and the binomial are regularised incomplete beta functions,
//! chi-squared is an incomplete gamma function (Abramowitz & Stegun 26.5.24, 26.6.2, 26.7.1,
//! 26.4.19). F goes to that function directly, as the argument of statrs' `sf` is itself a one
//! minus; the normal goes to libm, as statrs' `erfc` has ten digits.

use statrs::distribution::{ContinuousCDF as _, StudentsT};
use statrs::function::{beta, erf, gamma};

use super::{Computed, Undefined, undefined};

/// Tails below this are far out.
const FAR: f64 = 1e-3;
/// No t is larger: its square has to be a number.
const LARGEST_T: f64 = 1e150;
/// Most steps towards a quantile.
const MOST_STEPS: usize = 100;
/// The longest step up, of the logarithm of t.
const UP: f64 = 0.35;

/// P(Z > z) of the standard normal.
pub(crate) fn normal_upper(z: f64) -> f64 {
    0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2)
}

/// P(Z ≤ z) of the standard normal.
pub fn normal_lower(z: f64) -> f64 {
    normal_upper(-z)
}

/// The density of the standard normal at `z`.
pub(crate) fn normal_density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt()
}

/// The z that a share `p` of the standard normal does not exceed.
///
/// # Errors
/// `p` outside (0, 1): z would be infinite.
pub fn normal_quantile(p: f64) -> Computed {
    if !(p > 0.0 && p < 1.0) {
        return undefined(format!("the z of a share of {p}"));
    }
    // By the nearer tail, then one Newton step on that tail.
    let tail = p.min(1.0 - p);
    let z = std::f64::consts::SQRT_2 * erf::erfc_inv(2.0 * tail);
    let z = z + (normal_upper(z) - tail) / normal_density(z);
    Ok(if p < 0.5 { -z } else { z })
}

/// P(T > t) of Student's t with `df` > 0 degrees of freedom.
pub(crate) fn t_upper(t: f64, df: f64) -> Computed {
    Ok(student(t, df)?.sf(t))
}

/// P(|T| > |t|).
pub(crate) fn t_two_sided(t: f64, df: f64) -> Computed {
    Ok((2.0 * t_upper(t.abs(), df)?).min(1.0))
}

/// The t that T exceeds with probability `tail` < 0.5: 0.025 for a two-sided 95 %.
pub fn t_quantile_upper(tail: f64, df: f64) -> Computed {
    if !(tail > 0.0 && tail < 0.5) {
        return undefined(format!("the t of a tail of {tail}"));
    }
    let distribution = student(0.0, df)?;
    let ln_scale = gamma::ln_gamma(0.5 * (df + 1.0))
        - gamma::ln_gamma(0.5 * df)
        - 0.5 * (df * std::f64::consts::PI).ln();
    let ln_density = |t: f64| ln_scale - 0.5 * (df + 1.0) * (t * t / df).ln_1p();
    if tail >= FAR {
        let mut t = -distribution.inverse_cdf(tail);
        for _ in 0..2 {
            t += (distribution.sf(t) - tail) / ln_density(t).exp();
        }
        return finite(t, "t quantile");
    }
    // Over that of t the logarithm of the tail is concave and below the straight line that it ends
    // in: from where that line has the tail, Newton's method comes down to where the curve has it.
    let ln_line = ln_scale + 0.5 * (df - 1.0) * df.ln() - tail.ln();
    let mut t = (ln_line / df).exp().min(LARGEST_T);
    for _ in 0..MOST_STEPS {
        let here = distribution.sf(t);
        let slope = (t.ln() + ln_density(t) - here.ln()).exp();
        let step = ((here.ln() - tail.ln()) / slope).min(UP);
        // Where there is no number for the tail, t is far too large.
        t *= if here > 0.0 { step.exp() } else { 0.5 };
        if here > 0.0 && step.abs() < 1e-14 {
            return finite(t, "t quantile");
        }
    }
    undefined(format!("the t of a tail of {tail} with df = {df}"))
}

fn student(t: f64, df: f64) -> Computed<StudentsT> {
    let distribution = StudentsT::new(0.0, 1.0, df).ok().filter(|_| t.is_finite());
    distribution.ok_or_else(|| Undefined::because(format!("t = {t} with df = {df}")))
}

/// P(F > f) of Fisher's F.
pub fn f_upper(f: f64, df_effect: f64, df_error: f64) -> Computed {
    if !(f >= 0.0 && f.is_finite() && df_effect > 0.0 && df_error > 0.0) {
        return undefined(format!("F = {f} with df = {df_effect}, {df_error}"));
    }
    let share = df_error / (df_error + df_effect * f);
    Ok(beta::beta_reg(0.5 * df_error, 0.5 * df_effect, share))
}

/// P(X > x) of chi-squared.
pub(crate) fn chi_squared_upper(x: f64, df: f64) -> Computed {
    if !(x >= 0.0 && x.is_finite() && df > 0.0) {
        return undefined(format!("χ² = {x} with df = {df}"));
    }
    let half = 0.5 * x;
    Ok(if half > 0.0 {
        gamma::gamma_ur(0.5 * df, half)
    } else {
        1.0
    })
}

/// P(X ≥ k) of `n` trials that succeed with probability `p` in (0, 1).
pub(crate) fn binomial_at_least(k: u64, n: u64, p: f64) -> f64 {
    match k {
        0 => 1.0,
        k if k > n => 0.0,
        k => beta::beta_reg(k as f64, (n - k) as f64 + 1.0, p),
    }
}

/// P(X ≤ k) of `n` trials that succeed with probability `p` in (0, 1).
pub(crate) fn binomial_at_most(k: u64, n: u64, p: f64) -> f64 {
    if k >= n {
        return 1.0;
    }
    binomial_at_least(n - k, n, 1.0 - p)
}

/// P(X = k).
pub(crate) fn binomial_mass(k: u64, n: u64, p: f64) -> f64 {
    if k > n {
        return 0.0;
    }
    let (hits, misses) = (k as f64, (n - k) as f64);
    let ln_ways = gamma::ln_gamma(n as f64 + 1.0)
        - gamma::ln_gamma(hits + 1.0)
        - gamma::ln_gamma(misses + 1.0);
    (ln_ways + hits * p.ln() + misses * (-p).ln_1p()).exp()
}

/// ln Γ(x) for x > 0.
pub(super) fn ln_gamma(x: f64) -> f64 {
    gamma::ln_gamma(x)
}

/// The value, or what it was to be if it is not finite.
pub(super) fn finite(value: f64, what: &str) -> Computed {
    let is_number = value.is_finite();
    is_number
        .then_some(value)
        .ok_or_else(|| Undefined::because(format!("the {what} is not finite")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn assert_close(found: f64, expected: f64, relative: f64) {
        let error = (found / expected - 1.0).abs();
        assert!(error <= relative, "{found:e} for {expected:e}: {error:e}");
    }

    #[test]
    fn t_of_one_and_two_degrees_agrees_with_its_closed_forms() -> Computed<()> {
        for t in [1e-3, 0.1, 1.0, 3.0, 50.0, 1e4, 1e8] {
            assert_close(t_upper(t, 1.0)?, (1.0 / t).atan() / PI, 1e-11);
            let root = (2.0 + t * t).sqrt();
            let two = 1.0 / (root * root * (1.0 + t / root));
            assert_close(t_upper(t, 2.0)?, two, 1e-11);
            assert_close(t_upper(-t, 2.0)?, 1.0 - two, 1e-12);
        }
        Ok(())
    }

    #[test]
    fn f_with_two_degrees_agrees_with_its_closed_form_far_into_the_tail() -> Computed<()> {
        // df error = 2: 1 − (d f/(d f + 2))^(d/2); df effect = 2: (1 + 2f/e)^(−e/2).
        for f in [0.01, 1.0, 10.0, 1e3, 1e6] {
            for error in [3.0, 14.0, 77.0_f64] {
                let closed = (-0.5 * error * (2.0 * f / error).ln_1p()).exp();
                assert_close(f_upper(f, 2.0, error)?, closed, 1e-10);
                let other = -(-(0.5 * error) * (2.0 / (error * f)).ln_1p()).exp_m1();
                assert_close(f_upper(f, error, 2.0)?, other, 1e-9);
            }
            let t = t_two_sided(f.sqrt(), 11.0)?;
            assert_close(f_upper(f, 1.0, 11.0)?, t, 1e-11);
        }
        Ok(())
    }

    #[test]
    fn chi_squared_of_two_degrees_is_an_exponential_and_of_one_a_normal_squared() -> Computed<()> {
        for x in [0.01, 1.0, 7.0, 60.0, 400.0_f64] {
            assert_close(chi_squared_upper(x, 2.0)?, (-0.5 * x).exp(), 1e-11);
            assert_close(
                chi_squared_upper(x, 1.0)?,
                2.0 * normal_upper(x.sqrt()),
                1e-10,
            );
        }
        Ok(())
    }

    #[test]
    fn quantiles_lead_back_to_their_tails_on_both_sides() -> Computed<()> {
        for p in [1e-12, 1e-4, 0.025, 0.3, 0.5, 0.7, 0.975, 0.9999] {
            assert_close(normal_lower(normal_quantile(p)?), p, 1e-12);
        }
        for (p, z) in [
            (0.975, 1.959_963_984_540_054),
            (0.75, 0.674_489_750_196_081_7),
            (1e-6, -4.753_424_308_822_899),
        ] {
            assert_close(normal_quantile(p)?, z, 1e-13);
        }
        assert_eq!(normal_upper(-0.0), 0.5);
        assert_eq!(normal_upper(f64::INFINITY), 0.0);
        assert_eq!(normal_lower(1e300), 1.0);
        for df in [1.0, 2.0, 7.0, 8.2, 14.0, 200.0] {
            for tail in [1e-100, 1e-20, 1e-6, 0.005, 0.025, 0.1, 0.4] {
                assert_close(t_upper(t_quantile_upper(tail, df)?, df)?, tail, 1e-10);
            }
        }
        assert_close(t_quantile_upper(0.025, 7.0)?, 2.364_624_251_592_785, 1e-12);
        // mpmath, tests/truth/statistics.py.
        assert_close(
            t_quantile_upper(1e-100, 5.0)?,
            1.568_392_559_099_337_8e20,
            1e-12,
        );
        assert!(
            t_quantile_upper(1e-300, 1.0).is_err(),
            "its square is no number"
        );
        assert!(t_quantile_upper(1e-9, 0.01).is_err(), "nor this one's");
        Ok(())
    }

    #[test]
    fn binomial_tails_are_the_sums_of_their_masses() {
        for (n, p) in [(1, 0.5), (16, 0.25), (80, 0.25), (384, 0.5)] {
            for k in 0..=n {
                let below: f64 = (0..=k).map(|i| binomial_mass(i, n, p)).sum();
                let above: f64 = (k..=n).rev().map(|i| binomial_mass(i, n, p)).sum();
                assert_close(binomial_at_most(k, n, p), below, 1e-10);
                assert_close(binomial_at_least(k, n, p), above, 1e-10);
            }
        }
    }

    #[test]
    fn what_has_no_number_says_so() {
        assert!(normal_quantile(1.0).is_err(), "infinite");
        assert!(t_upper(f64::NAN, 3.0).is_err(), "not a number");
        assert!(t_upper(1.0, 0.0).is_err(), "no freedom");
        assert!(f_upper(-1.0, 1.0, 2.0).is_err(), "negative");
        assert!(chi_squared_upper(f64::INFINITY, 2.0).is_err(), "infinite");
    }
}
