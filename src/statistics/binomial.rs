//! The exact binomial test.

use super::distribution::{binomial_at_least, binomial_at_most, binomial_mass};

use super::{Computed, Freedom, Interval, Named, Outcome, Sides, undefined};
use selvedge_foundation::numerics::to_whole;

/// Masses this much above that of what was seen still count as equally rare: rounding.
const SAME: f64 = 1.0 + 1e-7;

/// Whether `hits` of `trials` agree with a chance `expected`. Two-sided: the sum of all counts
/// that are no more probable than the one seen (Fisher; as R's `binom.test`).
///
/// The interval is Wilson's at 95 %; the effect Cohen's h = 2 asin √p − 2 asin √p₀.
///
/// # Errors
/// No trials, more hits than trials, a chance that is not between 0 and 1.
pub fn exact_binomial(hits: u64, trials: u64, expected: f64, sides: Sides) -> Computed<Outcome> {
    if trials == 0 || hits > trials || !(expected > 0.0 && expected < 1.0) {
        let reason = format!("{hits} of {trials} trials against a chance of {expected}");
        return undefined(reason);
    }
    let p = match sides {
        Sides::Greater => binomial_at_least(hits, trials, expected),
        Sides::Less => binomial_at_most(hits, trials, expected),
        Sides::Two => two_sided(hits, trials, expected),
    };
    let share = hits as f64 / trials as f64;
    let angle = |share: f64| 2.0 * share.sqrt().asin();
    Ok(Outcome {
        test: "exact binomial",
        n: vec![usize::try_from(trials).unwrap_or(usize::MAX)],
        statistic: Named::of("hits", hits as f64),
        df: Freedom::None,
        p,
        sides,
        effect: Ok(Named::of("h", angle(share) - angle(expected))),
        estimate: Ok(Named::of("share", share)),
        interval: Interval::wilson(hits, trials, 0.95),
        notes: Vec::new(),
    })
}

/// The tail seen, exactly, and what of the other tail is no more probable. The masses rise to
/// their mode and fall from it, so the other tail ends where a bisection finds it.
fn two_sided(hits: u64, trials: u64, expected: f64) -> f64 {
    let seen = binomial_mass(hits, trials, expected) * SAME;
    let is_rare = |k: u64| binomial_mass(k, trials, expected) <= seen;
    let middle = trials as f64 * expected;
    // The mode lies within one of the mean, so each tail is monotone beyond it.
    let mode = (0..=2)
        .map(|step| nearby(middle, step, trials))
        .max_by(|&a, &b| {
            binomial_mass(a, trials, expected).total_cmp(&binomial_mass(b, trials, expected))
        })
        .unwrap_or(0);
    if hits == mode {
        return 1.0;
    }
    let p = if hits > mode {
        // The rare counts up to the mode are 0 … n_rare − 1; two modes may be equal.
        let n_rare = first_that(0, mode + 1, |k| !is_rare(k));
        let below = (n_rare > 0).then(|| binomial_at_most(n_rare - 1, trials, expected));
        binomial_at_least(hits, trials, expected) + below.unwrap_or(0.0)
    } else {
        let first = first_that(mode, trials + 1, is_rare);
        binomial_at_most(hits, trials, expected) + binomial_at_least(first, trials, expected)
    };
    p.min(1.0)
}

/// Whole numbers about a mean: one below, itself rounded down, one above.
fn nearby(mean: f64, step: u64, most: u64) -> u64 {
    (to_whole::<u64>(mean) + step).saturating_sub(1).min(most)
}

/// The first number in `low..high` that a condition holds for, where it holds from some number
/// on; `high` if for none.
fn first_that(mut low: u64, mut high: u64, holds: impl Fn(u64) -> bool) -> u64 {
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p_of(hits: u64, trials: u64, expected: f64, sides: Sides) -> Computed {
        Ok(exact_binomial(hits, trials, expected, sides)?.p)
    }

    #[test]
    fn one_subject_needs_twenty_seven_of_eighty_against_a_quarter() -> Computed<()> {
        let p = p_of(27, 80, 0.25, Sides::Greater)?;
        assert!((p - 0.0499).abs() < 5e-5, "{p}");
        assert!(
            (p_of(28, 80, 0.25, Sides::Greater)? - 0.029).abs() < 5e-4,
            "28"
        );
        assert!(p_of(26, 80, 0.25, Sides::Greater)? > 0.05, "26");
        Ok(())
    }

    #[test]
    fn two_sided_is_the_sum_of_all_that_is_as_rare() -> Computed<()> {
        for (n, chance) in [
            (1, 0.5),
            (7, 0.5),
            (7, 1.0 / 3.0),
            (15, 0.25),
            (80, 0.25),
            (40, 0.9),
        ] {
            for k in 0..=n {
                let seen = binomial_mass(k, n, chance) * SAME;
                let masses = (0..=n).map(|i| binomial_mass(i, n, chance));
                let sum: f64 = masses.filter(|&m| m <= seen).sum();
                let p = p_of(k, n, chance, Sides::Two)?;
                assert!(
                    (p - sum.min(1.0)).abs() < 1e-10,
                    "{k} of {n}: {p} for {sum}"
                );
            }
        }
        Ok(())
    }

    #[test]
    fn a_fair_coin_has_twice_its_tail() -> Computed<()> {
        let p = p_of(9, 10, 0.5, Sides::Two)?;
        assert!((p - 22.0 / 1024.0).abs() < 1e-14, "{p}");
        assert!(
            (p_of(1, 10, 0.5, Sides::Less)? - 11.0 / 1024.0).abs() < 1e-14,
            "left"
        );
        Ok(())
    }

    #[test]
    fn no_trials_are_not_computable() {
        assert!(exact_binomial(0, 0, 0.25, Sides::Two).is_err(), "none");
        assert!(exact_binomial(3, 2, 0.25, Sides::Two).is_err(), "too many");
        assert!(exact_binomial(1, 2, 0.0, Sides::Two).is_err(), "no chance");
    }
}
