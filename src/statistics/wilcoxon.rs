//! Wilcoxon's signed rank test, exact for small samples with ties too.

use selvedge_foundation::numerics::{median, to_whole};

use super::distribution::normal_upper;
use super::summary::{at_least, largest, rounding};
use super::{Computed, Freedom, Interval, Named, Outcome, Sides, undefined};

/// Up to so many differences that are not zero every pattern of signs is counted.
const MOST_EXACT: usize = 50;
const LEVEL: f64 = 0.95;

/// Whether `values` lie evenly about `expected`, two-sided (Wilcoxon 1945).
///
/// Differences of zero are left out, as Wilcoxon did, and said. V is the sum of the ranks of
/// positive differences. Up to 50 differences its distribution is exact given the ties: every
/// pattern of signs is counted. Beyond, the normal with correction for ties and continuity. The
/// effect is the matched-pairs rank biserial correlation (Kerby 2014); the estimate is the
/// Hodges–Lehmann median of the means of all pairs, its interval of Walsh means too, so long as
/// neither ties nor zeros spoil it.
///
/// # Errors
/// No difference at all, values that are not finite.
pub fn wilcoxon_signed_rank(values: &[f64], expected: f64) -> Computed<Outcome> {
    let differences = values.iter().map(|v| v - expected).collect();
    signed_rank(differences, expected, largest(values).max(expected.abs()))
}

/// Sizes that differ by no more than the rounding of numbers as large as `scale` become equal, and
/// such differences 0.
fn without_rounding(mut differences: Vec<f64>, scale: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..differences.len()).collect();
    order.sort_by(|&a, &b| differences[a].abs().total_cmp(&differences[b].abs()));
    let mut size: f64 = 0.0;
    for which in order {
        let difference = differences[which];
        if difference.abs() - size > rounding(scale) {
            size = difference.abs();
        }
        differences[which] = size.copysign(difference);
    }
    differences
}

fn signed_rank(differences: Vec<f64>, expected: f64, scale: f64) -> Computed<Outcome> {
    at_least(&differences, 1)?;
    let differences = without_rounding(differences, scale);
    let kept: Vec<f64> = differences
        .iter()
        .copied()
        .filter(|d| d.abs() > 0.0)
        .collect();
    if kept.is_empty() {
        return undefined(format!("all {} differences are zero", differences.len()));
    }
    let sizes: Vec<f64> = kept.iter().map(|d| d.abs()).collect();
    let signed = SignedRanks::of(&kept, Ranks::of(&sizes));
    let n_zero = differences.len() - kept.len();
    let is_exact = kept.len() <= MOST_EXACT;
    let total = signed.total();
    Ok(Outcome {
        test: "Wilcoxon signed rank",
        n: vec![kept.len()],
        statistic: Named::of("V", signed.positive),
        df: Freedom::None,
        p: if is_exact {
            signed.exact_p()
        } else {
            signed.normal_p()
        },
        sides: Sides::Two,
        effect: Ok(Named::of("r_rb", (2.0 * signed.positive - total) / total)),
        estimate: Ok(Named::of(
            "pseudomedian",
            expected + median(&mut walsh_means(&differences)),
        )),
        interval: signed.interval(&differences, expected, n_zero),
        notes: notes(n_zero, kept.len(), signed.ranks.tie_sum),
    })
}

fn notes(n_zero: usize, n_kept: usize, tie_sum: f64) -> Vec<String> {
    let mut notes = vec![if n_kept <= MOST_EXACT {
        "exact over all patterns of signs".to_owned()
    } else {
        "normal approximation with continuity correction".to_owned()
    }];
    if n_zero > 0 {
        notes.push(format!("{n_zero} differences of zero left out"));
    }
    if tie_sum > 0.0 {
        notes.push("equal sizes share the mean of their ranks".to_owned());
    }
    notes
}

fn walsh_means(values: &[f64]) -> Vec<f64> {
    let pairs = values.iter().enumerate();
    pairs
        .flat_map(|(i, a)| values[i..].iter().map(move |b| 0.5 * (a + b)))
        .collect()
}

struct SignedRanks {
    ranks: Ranks,
    positive: f64,
}

impl SignedRanks {
    fn of(differences: &[f64], ranks: Ranks) -> Self {
        let both = differences.iter().zip(&ranks.ranks);
        // A sum of nothing is −0.
        let positive = both.filter(|(d, _)| **d > 0.0).map(|(_, r)| r).sum::<f64>() + 0.0;
        Self { ranks, positive }
    }

    fn total(&self) -> f64 {
        self.ranks.ranks.iter().sum()
    }

    /// The share of sign patterns with V equal to 0, ½, 1, … : ranks doubled are whole.
    fn distribution(&self) -> Vec<f64> {
        let mut shares = vec![1.0];
        for rank in &self.ranks.ranks {
            let step = whole(2.0 * rank);
            let mut next = vec![0.0; shares.len() + step];
            for (v, share) in shares.iter().enumerate() {
                next[v] += 0.5 * share;
                next[v + step] += 0.5 * share;
            }
            shares = next;
        }
        shares
    }

    /// Twice the smaller tail; the distribution is symmetric.
    fn exact_p(&self) -> f64 {
        let shares = self.distribution();
        let smaller = self.positive.min(self.total() - self.positive);
        let tail: f64 = shares[..=whole(2.0 * smaller)].iter().sum();
        (2.0 * tail).min(1.0)
    }

    fn normal_p(&self) -> f64 {
        let n = self.ranks.ranks.len() as f64;
        let variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - self.ranks.tie_sum / 48.0;
        let away = (self.positive - 0.5 * self.total()).abs() - 0.5;
        (2.0 * normal_upper(away.max(0.0) / variance.sqrt())).min(1.0)
    }

    /// From the Walsh mean after the largest count that the test rejects to its mirror image.
    fn interval(&self, values: &[f64], expected: f64, n_zero: usize) -> Computed<Interval> {
        let n = values.len();
        if n_zero > 0 || self.ranks.tie_sum > 0.0 || n > MOST_EXACT {
            let reason = "the exact interval wants up to 50 differences without ties or zeros";
            return undefined(reason);
        }
        let mut tail = 0.0;
        let is_rejected = |share: &f64| {
            tail += share;
            tail <= 0.5 * (1.0 - LEVEL)
        };
        // Without ties V is whole: every second entry.
        let shares: Vec<f64> = self.distribution().into_iter().step_by(2).collect();
        let n_rejected = shares.iter().copied().take_while(is_rejected).count();
        if n_rejected == 0 {
            return undefined(format!("{n} differences cannot reach 95 %"));
        }
        let mut means = walsh_means(values);
        means.sort_by(f64::total_cmp);
        Ok(Interval::new(
            [
                expected + means[n_rejected - 1],
                expected + means[means.len() - n_rejected],
            ],
            LEVEL,
        ))
    }
}

fn whole(doubled: f64) -> usize {
    to_whole(doubled.round())
}

/// Ranks from 1 of some values, and the sum of t³ − t over groups of t equal ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranks {
    /// The rank of each value.
    pub ranks: Vec<f64>,
    /// Σ(t³ − t): 0 without ties.
    pub(crate) tie_sum: f64,
}

impl Ranks {
    /// Of finite values.
    pub fn of(values: &[f64]) -> Self {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let mut ranks = vec![0.0; values.len()];
        let (mut start, mut tie_sum) = (0, 0.0);
        while let Some(&first) = order.get(start) {
            let is_same = |&&i: &&usize| values[i] <= values[first];
            let n_same = order[start..].iter().take_while(is_same).count();
            let t = n_same as f64;
            for &i in &order[start..start + n_same] {
                ranks[i] = start as f64 + 0.5 * (t + 1.0);
            }
            tie_sum += t * t * t - t;
            start += n_same;
        }
        Self { ranks, tie_sum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::differences;

    /// Of the differences of pairs.
    fn pairs(a: &[f64], b: &[f64]) -> Computed<Outcome> {
        signed_rank(differences(a, b)?, 0.0, largest(a).max(largest(b)))
    }

    /// The two-sided p by trying every pattern of signs.
    fn by_enumeration(values: &[f64]) -> f64 {
        let sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
        let ranks = Ranks::of(&sizes).ranks;
        let total: f64 = ranks.iter().sum();
        let seen: f64 = (0..values.len())
            .filter(|&i| values[i] > 0.0)
            .map(|i| ranks[i])
            .sum();
        let patterns = 1_u32 << values.len();
        let is_extreme = |signs: &u32| {
            let chosen = (0..values.len()).filter(|i| signs >> i & 1 == 1);
            let v: f64 = chosen.map(|i| ranks[i]).sum();
            (v - 0.5 * total).abs() >= (seen - 0.5 * total).abs()
        };
        (0..patterns).filter(is_extreme).count() as f64 / f64::from(patterns)
    }

    #[test]
    fn exact_p_is_the_share_of_sign_patterns_with_ties_too() -> Computed<()> {
        for values in [
            vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
            vec![1.5, -0.5, 3.0, 2.5, -1.0, 4.0, 6.0],
            vec![1.0, -1.0, 2.0, 2.0, 2.0, -3.0, 4.0, 4.0, 5.0],
        ] {
            let found = wilcoxon_signed_rank(&values, 0.0)?;
            assert!(
                (found.p - by_enumeration(&values)).abs() < 1e-15,
                "{found:?}"
            );
        }
        Ok(())
    }

    #[test]
    fn eight_of_one_sign_give_the_smallest_p_and_the_interval_of_the_extremes() -> Computed<()> {
        let found = wilcoxon_signed_rank(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.5], 0.0)?;
        assert_eq!(found.statistic.value, 36.0);
        assert_eq!(found.p, 2.0 / 256.0);
        assert_eq!(found.effect.map(|e| e.value)?, 1.0);
        // Critical V at n = 8, two-sided 5 %, is 3: the fourth Walsh mean from either end, of
        // 1, 1.5, 2, 2, … and 8.5, 7.75, 7.25, 7, …
        let interval = found.interval?;
        assert_eq!((interval.low, interval.high), (2.0, 7.0));
        Ok(())
    }

    #[test]
    fn zeros_are_left_out_and_ties_are_said() -> Computed<()> {
        let found = pairs(&[1.0, 2.0, 5.0, 5.0], &[1.0, 1.0, 4.0, 2.0])?;
        assert_eq!(found.n, [3]);
        assert!(
            found
                .notes
                .iter()
                .any(|n| n.contains("1 differences of zero")),
            "said"
        );
        assert!(
            found.notes.iter().any(|n| n.contains("share the mean")),
            "said"
        );
        assert!(found.interval.is_err(), "ties");
        assert!(
            wilcoxon_signed_rank(&[25.0; 8], 25.0).is_err(),
            "nothing left"
        );
        Ok(())
    }

    #[test]
    fn rounding_breaks_no_ties_and_leaves_no_zeros() -> Computed<()> {
        let shares = pairs(&[0.3, 0.8, 0.7, 0.1 + 0.2], &[0.2, 0.7, 0.8, 0.3])?;
        let whole = pairs(&[3.0, 8.0, 7.0, 3.0], &[2.0, 7.0, 8.0, 3.0])?;
        assert_eq!((shares.n, shares.p), (whole.n, whole.p));
        assert_eq!(shares.statistic, whole.statistic);
        assert_eq!(shares.notes, whole.notes);
        Ok(())
    }

    #[test]
    fn the_normal_takes_over_where_counting_ends_without_a_jump() -> Computed<()> {
        let values: Vec<f64> = (1..=50)
            .map(|i| f64::from(i) * if i % 3 == 0 { -1.0 } else { 1.0 })
            .collect();
        let exact = wilcoxon_signed_rank(&values, 0.0)?.p;
        let sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
        let normal = SignedRanks::of(&values, Ranks::of(&sizes)).normal_p();
        assert!((exact - normal).abs() < 2e-3, "{exact} and {normal}");
        Ok(())
    }

    #[test]
    fn equal_values_share_the_mean_of_their_ranks() {
        let found = Ranks::of(&[3.0, 1.0, 3.0, 0.0, 3.0, -0.0]);
        assert_eq!(found.ranks, [5.0, 3.0, 5.0, 1.5, 5.0, 1.5]);
        assert_eq!(found.tie_sum, 24.0 + 6.0);
        assert_eq!(Ranks::of(&[]).ranks, Vec::<f64>::new());
    }
}
