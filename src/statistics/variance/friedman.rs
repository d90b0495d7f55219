//! Ranks within subjects: Friedman's test and Kendall's W.

use crate::summary::at_least;
use crate::{Computed, Named, Outcome, Ranks, Undefined, by_chi_squared, undefined};

/// Whether conditions differ in rank within subjects (Friedman 1937).
///
/// One row of values a subject, one column a condition. χ² corrected for ties, p by χ² with k − 1
/// degrees of freedom; the effect is Kendall's W = χ²/(n(k − 1)), 0 for no agreement between
/// subjects and 1 for full.
///
/// # Errors
/// Fewer than two subjects or conditions, rows of different lengths (with their numbers), values
/// that are not finite, every subject's answers all equal.
pub fn friedman(rows: &[Vec<f64>]) -> Computed<Outcome> {
    let k = check(rows)?;
    let (n, levels) = (rows.len() as f64, k as f64);
    let mut sums = vec![0.0; k];
    let mut tie_sum = 0.0;
    for row in rows {
        let ranks = Ranks::of(row);
        tie_sum += ranks.tie_sum;
        for (sum, rank) in sums.iter_mut().zip(&ranks.ranks) {
            *sum += rank;
        }
    }
    let expected = 0.5 * n * (levels + 1.0);
    let between: f64 = sums.iter().map(|s| (s - expected).powi(2)).sum();
    let possible = n * levels * (levels + 1.0) - tie_sum / (levels - 1.0);
    if possible <= 0.0 {
        return undefined("every subject's answers are all equal: nothing to rank");
    }
    let chi = 12.0 * between / possible;
    let df = levels - 1.0;
    let statistic = (Named::of("χ²", chi), df);
    let effect = Ok(Named::of("W", chi / (n * df)));
    let n = vec![rows.len()];
    let mut outcome = by_chi_squared(
        "Friedman",
        n,
        statistic,
        effect,
        "several conditions, not one",
    )?;
    if tie_sum > 0.0 {
        outcome.notes.push("corrected for ties".to_owned());
    }
    Ok(outcome)
}

fn check(rows: &[Vec<f64>]) -> Computed<usize> {
    let k = rows.first().map_or(0, Vec::len);
    if rows.len() < 2 || k < 2 {
        let reason = format!(
            "{} subjects in {k} conditions: 2 of each needed",
            rows.len()
        );
        return undefined(reason);
    }
    for (index, row) in rows.iter().enumerate() {
        let subject = index + 1;
        if row.len() != k {
            let reason = format!("subject {subject} has {} of {k} conditions", row.len());
            return undefined(reason);
        }
        let name = |e: Undefined| Undefined::because(format!("subject {subject}: {}", e.reason));
        at_least(row, k).map_err(name)?;
    }
    Ok(k)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn full_agreement_is_one_and_none_is_zero() -> Computed<()> {
        let agreed = friedman(&vec![vec![1.0, 5.0, 7.0, 9.0]; 5])?;
        assert_eq!(agreed.effect.map(|e| e.value)?, 1.0);
        assert_eq!(agreed.statistic.value, 15.0);
        let opposed = friedman(&[vec![1.0, 2.0, 3.0], vec![3.0, 2.0, 1.0]])?;
        assert_eq!(opposed.effect.map(|e| e.value)?, 0.0);
        assert_eq!(opposed.p, 1.0);
        Ok(())
    }

    #[test]
    fn w_with_ties_follows_from_the_mean_correlation_of_ranks() -> Computed<()> {
        // Without ties mean Spearman r = (nW − 1)/(n − 1), for two subjects r = 2W − 1; with ties
        // in both alike the same.
        let (a, b) = (vec![1.0, 2.0, 2.0, 4.0, 5.0], vec![2.0, 1.0, 4.0, 4.0, 3.0]);
        let w = friedman(&[a.clone(), b.clone()])?.effect?.value;
        let r = crate::spearman(&a, &b)?.estimate?.value;
        assert!((r - (2.0 * w - 1.0)).abs() < 1e-13, "{r} and {w}");
        Ok(())
    }

    #[test]
    fn p_agrees_with_shuffling_within_subjects() -> Computed<()> {
        let mut random = Random::new(6);
        let mut rows: Vec<Vec<f64>> = (0..10)
            .map(|_| {
                (0..4)
                    .map(|c| random.normal() + 0.3 * f64::from(c))
                    .collect()
            })
            .collect();
        let seen = friedman(&rows)?;
        let mut n_extreme = 0;
        for _ in 0..10_000 {
            for row in &mut rows {
                for i in (1..row.len()).rev() {
                    row.swap(i, random.index(i + 1));
                }
            }
            let chi = friedman(&rows)?.statistic.value;
            n_extreme += i32::from(chi >= seen.statistic.value - 1e-9);
        }
        let share = f64::from(n_extreme) / 10_000.0;
        assert!((share - seen.p).abs() < 0.02, "{share} and {}", seen.p);
        Ok(())
    }

    #[test]
    fn tables_with_holes_are_refused_with_their_place() {
        let reason = |rows: &[Vec<f64>]| friedman(rows).map(|_| ()).map_err(|e| e.reason);
        let short = reason(&[vec![1.0, 2.0], vec![1.0]]);
        assert_eq!(short, Err("subject 2 has 1 of 2 conditions".to_owned()));
        let broken = reason(&[vec![1.0, f64::NAN], vec![1.0, 2.0]]);
        assert_eq!(
            broken,
            Err("subject 1: value 2 of 2 is not finite".to_owned())
        );
        assert!(reason(&[vec![1.0, 2.0]]).is_err(), "one subject");
        assert!(reason(&[vec![1.0; 3], vec![2.0; 3]]).is_err(), "all equal");
    }
}
