//! The sign-flip permutation test of paired differences: under the null hypothesis each subject's
//! labels could as well be exchanged, whatever the distribution of answers.

use selvedge_foundation::numerics::Random;

use super::summary::{at_least, largest};
use super::{Computed, Freedom, Named, Outcome, Sides, undefined};

/// Up to so many subjects all patterns are tried.
const MOST_EXACT: usize = 20;

/// Whether differences lie evenly about 0, two-sided: the share of sign patterns whose mean is at
/// least as far from 0.
///
/// All 2ⁿ patterns up to 20 subjects; beyond, `n_random` patterns from `seed` with
/// p = (b + 1)/(N + 1), which counts the pattern seen (Phipson & Smyth 2010). The effect is the
/// mean over the root mean square, between −1 and 1.
///
/// # Errors
/// No values, values that are not finite, all differences zero, fewer than 99 random patterns
/// where they are needed.
pub fn sign_flip(differences: &[f64], n_random: usize, seed: u64) -> Computed<Outcome> {
    at_least(differences, 1)?;
    let n = differences.len();
    if n > MOST_EXACT && n_random < 99 {
        let reason = format!("{n_random} random sign patterns are too few, 99 are needed");
        return undefined(reason);
    }
    let sum: f64 = differences.iter().sum();
    let size = largest(differences);
    if size <= 0.0 {
        return undefined(format!("all {n} differences are zero"));
    }
    // Patterns that tie but for rounding are as extreme.
    let least = sum.abs() - 1e-12 * size * n as f64;
    let (p, note) = if n <= MOST_EXACT {
        let patterns = 1_u64 << n;
        let count = exact_count(differences, sum, least) as f64;
        (
            count / patterns as f64,
            format!("all {patterns} sign patterns"),
        )
    } else {
        let count = random_count(differences, least, n_random, seed) as f64;
        let p = (count + 1.0) / (n_random as f64 + 1.0);
        (p, format!("{n_random} random sign patterns, seed {seed}"))
    };
    let mean = sum / n as f64;
    let square = differences.iter().map(|d| (d / size).powi(2)).sum::<f64>() / n as f64;
    Ok(Outcome {
        test: "sign-flip permutation",
        n: vec![n],
        statistic: Named::of("mean", mean),
        df: Freedom::None,
        p,
        sides: Sides::Two,
        effect: Ok(Named::of("mean/rms", mean / size / square.sqrt())),
        estimate: Ok(Named::of("mean difference", mean)),
        interval: undefined("a permutation test gives no interval"),
        notes: vec![note],
    })
}

/// Walks the patterns in Gray code, one sign at a time.
fn exact_count(differences: &[f64], sum: f64, least: f64) -> u64 {
    let patterns = 1_u64 << differences.len();
    let mut signed = differences.to_vec();
    let mut flipped = sum;
    let mut count = 1;
    for step in 1..patterns {
        let which = step.trailing_zeros() as usize;
        signed[which] = -signed[which];
        flipped += 2.0 * signed[which];
        // Summed anew now and then, so that rounding does not gather.
        if step % 1024 == 0 {
            flipped = signed.iter().sum();
        }
        count += u64::from(flipped.abs() >= least);
    }
    count
}

fn random_count(differences: &[f64], least: f64, n_random: usize, seed: u64) -> usize {
    let mut random = Random::new(seed).branch("sign flips");
    let mut flipped = || -> f64 {
        let signs = differences.iter();
        signs
            .map(|d| if random.uniform() < 0.5 { -d } else { *d })
            .sum()
    };
    (0..n_random).filter(|_| flipped().abs() >= least).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Summary, one_sample_t};

    #[test]
    fn few_differences_are_counted_by_hand() -> Computed<()> {
        // 1 + 2 + 4 = 7 and its mirror image alone are as far from 0.
        assert_eq!(sign_flip(&[1.0, 2.0, 4.0], 0, 0)?.p, 2.0 / 8.0);
        // Sum 5: |±1 ±2 ±4| ≥ 5 for 7, 5 and their mirror images.
        assert_eq!(sign_flip(&[-1.0, 2.0, 4.0], 0, 0)?.p, 4.0 / 8.0);
        // Rounding does not break ties.
        assert_eq!(sign_flip(&[0.1, 0.2, -0.3], 0, 0)?.p, 1.0);
        assert!(sign_flip(&[0.0; 8], 0, 0).is_err(), "nothing to flip");
        assert!(sign_flip(&[1.0; 21], 10, 0).is_err(), "too few patterns");
        Ok(())
    }

    #[test]
    fn random_patterns_agree_with_all_of_them_and_with_t() -> Computed<()> {
        let mut random = Random::new(11);
        let few: Vec<f64> = (0..16).map(|_| random.normal() + 0.6).collect();
        let exact = sign_flip(&few, 0, 0)?.p;
        let least = few.iter().sum::<f64>().abs() - 1e-9;
        let count = random_count(&few, least, 40_000, 2) as f64;
        assert!((count / 40_000.0 - exact).abs() < 0.005, "{exact}");
        let t = one_sample_t(&Summary::of(&few)?, 0.0)?.p;
        assert!((t - exact).abs() < 0.02, "{t} and {exact}");
        let many: Vec<f64> = (0..40).map(|_| random.normal() + 0.3).collect();
        let found = sign_flip(&many, 9999, 7)?;
        let t = one_sample_t(&Summary::of(&many)?, 0.0)?.p;
        assert!((found.p - t).abs() < 0.02, "{t} and {}", found.p);
        assert_eq!(found, sign_flip(&many, 9999, 7)?, "the seed decides");
        Ok(())
    }
}
