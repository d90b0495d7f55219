//! How far off its null hypothesis a test must be taken to lie: the noncentrality of t, F and χ²
//! for which what was seen is as large, or as small, as one time in forty.

use statrs::function::{beta, gamma};

use super::detection::inverted;
use super::distribution::{ln_gamma, normal_lower};

/// The tail to either side: 95 % lie between.
const TAIL: f64 = 0.025;
/// Steps of Simpson's rule over a standard deviation's own distribution.
const N_STEPS: u32 = 200;
/// Terms of a sum that are as small are left out.
const NOTHING: f64 = 1e-14;

/// The 95 % interval of the noncentrality of a t.
pub(super) fn of_t(t: f64, df: f64) -> [f64; 2] {
    let end = |share: f64| {
        let reach = 10.0 + 2.0 * t.abs();
        solved([t - reach, t + reach], |delta| {
            t_lower(t, df, delta) - share
        })
    };
    [end(1.0 - TAIL), end(TAIL)]
}

/// That of an F, not below 0.
pub(super) fn of_f(f: f64, df: f64, df_error: f64) -> [f64; 2] {
    let share = df * f / (df * f + df_error);
    at_least_none(df * f, |lambda| {
        mixed(lambda, |j| {
            beta::beta_reg(0.5 * df + j, 0.5 * df_error, share)
        })
    })
}

/// That of a χ², not below 0.
pub(super) fn of_chi_squared(x: f64, df: f64) -> [f64; 2] {
    at_least_none(x, |lambda| {
        mixed(lambda, |j| gamma::gamma_lr(0.5 * df + j, 0.5 * x))
    })
}

/// The ends of a noncentrality whose cumulative probability is given and falls with it.
fn at_least_none(seen: f64, lower: impl Fn(f64) -> f64) -> [f64; 2] {
    let most = 40.0 + 4.0 * seen;
    [1.0 - TAIL, TAIL].map(|share| {
        if seen <= 0.0 || lower(0.0) <= share {
            0.0
        } else {
            solved([0.0, most], |lambda| lower(lambda) - share)
        }
    })
}

/// Where a falling function crosses 0.
fn solved(ends: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    inverted(|noncentrality| -of(noncentrality), 0.0, ends)
}

/// P(T ≤ t): the normal's share below t·s − δ, over s = √(χ²/df).
fn t_lower(t: f64, df: f64, delta: f64) -> f64 {
    let half = 0.5 * df;
    let ln_scale = std::f64::consts::LN_2 + half * half.ln() - ln_gamma(half);
    let spread = 8.0 / (2.0 * df).sqrt();
    let (from, to) = ((1.0 - spread).max(0.0), 1.0 + spread);
    let step = (to - from) / f64::from(N_STEPS);
    let at = |i: u32| {
        let s = from + step * f64::from(i);
        if s <= 0.0 {
            return 0.0;
        }
        let density = (ln_scale + (df - 1.0) * s.ln() - half * s * s).exp();
        density * normal_lower(t * s - delta)
    };
    let weight = |i: u32| match i {
        0 | N_STEPS => 1.0,
        i if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=N_STEPS).map(|i| weight(i) * at(i)).sum::<f64>() * step / 3.0
}

/// A probability over a Poisson number of further degrees of freedom, two each, of mean λ.
fn mixed(lambda: f64, of: impl Fn(f64) -> f64) -> f64 {
    let mean = 0.5 * lambda;
    if mean <= 0.0 {
        return of(0.0);
    }
    let term = |j: f64| (j * mean.ln() - mean - ln_gamma(j + 1.0)).exp() * of(j);
    let middle = mean.floor();
    let mut sum = term(middle);
    for way in [-1.0, 1.0] {
        let mut j = middle + way;
        while j >= 0.0 {
            let next = term(j);
            sum += next;
            if next < NOTHING {
                break;
            }
            j += way;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::t_upper;
    use crate::{Computed, f_upper};
    use selvedge_foundation::numerics::Random;

    #[test]
    fn without_noncentrality_the_distributions_are_the_plain_ones() -> Computed<()> {
        for (t, df) in [(0.7, 3.0), (-1.9, 7.0), (2.4, 40.0)] {
            let plain = 1.0 - t_upper(t, df)?;
            assert!((t_lower(t, df, 0.0) - plain).abs() < 1e-6, "{t} {df}");
        }
        let share = 3.0 * 2.2 / (3.0 * 2.2 + 20.0);
        let lower = mixed(0.0, |j| beta::beta_reg(1.5 + j, 10.0, share));
        assert!((lower - 1.0 + f_upper(2.2, 3.0, 20.0)?).abs() < 1e-12, "F");
        Ok(())
    }

    #[test]
    fn a_t_squared_is_an_f_and_the_normal_its_limit() {
        for delta in [0.5, 2.0, 4.0] {
            let both = t_lower(2.0, 12.0, delta) - t_lower(-2.0, 12.0, delta);
            let share = 4.0 / (4.0 + 12.0);
            let of_f = mixed(delta * delta, |j| beta::beta_reg(0.5 + j, 6.0, share));
            assert!((both - of_f).abs() < 1e-7, "{delta}: {both} {of_f}");
        }
        let [low, high] = of_t(3.0, 1e4);
        assert!(
            (low - 1.04).abs() < 0.01 && (high - 4.96).abs() < 0.01,
            "{low} {high}"
        );
    }

    #[test]
    fn intervals_hold_the_truth_95_times_in_100() {
        let mut random = Random::new(4);
        let (mut n_t, mut n_chi) = (0, 0);
        for _ in 0..1000 {
            let z = random.normal() + 1.5;
            let rest: Vec<f64> = (0..7).map(|_| random.normal()).collect();
            let square: f64 = rest.iter().map(|z| z * z).sum();
            let [low, high] = of_t(z / (square / 7.0).sqrt(), 7.0);
            n_t += i32::from(low <= 1.5 && 1.5 <= high);
            let x = (random.normal() + 3.0).powi(2) + square;
            let [low, high] = of_chi_squared(x, 8.0);
            n_chi += i32::from(low <= 9.0 && 9.0 <= high);
        }
        assert!((930..=970).contains(&n_t), "{n_t}");
        assert!((930..=970).contains(&n_chi), "{n_chi}");
        assert_eq!(of_f(0.01, 3.0, 20.0), [0.0, 0.0], "less than chance");
    }
}
