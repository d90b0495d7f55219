//! Groups of different subjects: one-way analysis of variance, Welch's, and Kruskal–Wallis.

use super::effect::Sums;
use crate::distribution::f_upper;
use crate::summary::{at_least, centred, is_rounding, largest, sum_of_squares};
use crate::{
    Computed, Freedom, Named, Outcome, Ranks, Sides, Summary, Undefined, by_chi_squared, undefined,
};

/// One-way analysis of variance between groups (Fisher 1925), sums about the mean in two passes.
/// The effect is η².
///
/// # Errors
/// Fewer than two groups, an empty one, no group with two values, values that are not finite, no
/// variation within groups.
pub fn one_way(groups: &[Vec<f64>]) -> Computed<Outcome> {
    let all = joined(groups)?;
    let (n, k) = (all.len(), groups.len());
    if n == k {
        return undefined("every group has one value alone");
    }
    let scale = largest(&all);
    let (_, about_mean) = centred(&all);
    let (mut between, mut within, mut start) = (0.0, 0.0, 0);
    for group in groups {
        let (mean, deviations) = centred(&about_mean[start..start + group.len()]);
        between += group.len() as f64 * mean * mean;
        within += sum_of_squares(&deviations);
        start += group.len();
    }
    let clean = |sum: f64| if is_rounding(sum, n, scale) { 0.0 } else { sum };
    let sums = Sums {
        ss: clean(between),
        df: k as f64 - 1.0,
        ss_error: clean(within),
        df_error: (n - k) as f64,
    };
    let row = sums.row("groups", sums.ss + sums.ss_error);
    let n = groups.iter().map(Vec::len).collect();
    let effect = row.partial_eta_squared.map(|share| Named::of("η²", share));
    let (statistic, df) = (Named::of("F", row.f?), [row.df, row.df_error]);
    by_f("one-way analysis of variance", n, (statistic, df), effect)
}

/// A test of several means whose statistic follows F.
fn by_f(
    test: &'static str,
    n: Vec<usize>,
    (statistic, [df, df_error]): (Named, [f64; 2]),
    effect: Computed<Named>,
) -> Computed<Outcome> {
    Ok(Outcome {
        test,
        n,
        statistic,
        df: Freedom::Two(df, df_error),
        p: f_upper(statistic.value, df, df_error)?,
        sides: Sides::Greater,
        effect,
        estimate: undefined("several means, not one"),
        interval: undefined("several means, not one"),
        notes: Vec::new(),
    })
}

/// Welch's analysis of variance (1951), for groups whose spreads differ. The effect is
/// ω² = df(F − 1)/(df(F − 1) + N), which is negative when F < 1.
///
/// # Errors
/// As [`one_way`], and a group with one value or without spread.
pub fn welch(groups: &[Vec<f64>]) -> Computed<Outcome> {
    joined(groups)?;
    let k = groups.len() as f64;
    let summaries: Vec<Summary> = groups
        .iter()
        .map(|g| spread_of(g))
        .collect::<Computed<_>>()?;
    // Counted from one of the means, so that an offset costs no digits.
    let origin = summaries[0].mean;
    let weights: Vec<f64> = summaries.iter().map(|s| 1.0 / (s.se * s.se)).collect();
    let total: f64 = weights.iter().sum();
    let both = || summaries.iter().zip(&weights);
    let mean = both().map(|(s, w)| w * (s.mean - origin)).sum::<f64>() / total;
    let between: f64 = both()
        .map(|(s, w)| w * (s.mean - origin - mean).powi(2))
        .sum();
    let doubt: f64 = both()
        .map(|(s, w)| (1.0 - w / total).powi(2) / (s.n as f64 - 1.0))
        .sum();
    let df = k - 1.0;
    let f = between / df / (1.0 + 2.0 * (k - 2.0) / (k * k - 1.0) * doubt);
    let df_error = (k * k - 1.0) / (3.0 * doubt);
    let n: Vec<usize> = groups.iter().map(Vec::len).collect();
    let excess = df * (f - 1.0);
    let omega = excess / (excess + n.iter().sum::<usize>() as f64);
    let effect = Ok(Named::of("ω²", omega));
    let statistic = (Named::of("F", f), [df, df_error]);
    by_f("Welch analysis of variance", n, statistic, effect)
}

fn spread_of(group: &[f64]) -> Computed<Summary> {
    let summary = Summary::of(group)?;
    if summary.sd > 0.0 {
        Ok(summary)
    } else {
        Err(summary.without_spread())
    }
}

/// Whether groups differ in rank (Kruskal & Wallis 1952), H corrected for ties, p by χ². The
/// effect is ε² = H/(N − 1) (Kelley 1935).
///
/// # Errors
/// Fewer than two groups, an empty one, all values equal, values that are not finite.
pub fn kruskal_wallis(groups: &[Vec<f64>]) -> Computed<Outcome> {
    let all = joined(groups)?;
    let n = all.len() as f64;
    let Ranks { ranks, tie_sum } = Ranks::of(&all);
    let untied = 1.0 - tie_sum / (n * n * n - n);
    if untied <= 0.0 {
        return undefined(format!("all {} values equal {}", all.len(), all[0]));
    }
    let (mut between, mut start) = (0.0, 0);
    for group in groups {
        let size = group.len() as f64;
        let sum: f64 = ranks[start..start + group.len()].iter().sum();
        between += size * (sum / size - 0.5 * (n + 1.0)).powi(2);
        start += group.len();
    }
    let h = 12.0 / (n * (n + 1.0)) * between / untied;
    let df = groups.len() as f64 - 1.0;
    let statistic = (Named::of("H", h), df);
    let effect = Ok(Named::of("ε²", h / (n - 1.0)));
    let n = groups.iter().map(Vec::len).collect();
    let mut outcome = by_chi_squared(
        "Kruskal–Wallis",
        n,
        statistic,
        effect,
        "several groups, not one",
    )?;
    if tie_sum > 0.0 {
        outcome.notes.push("corrected for ties".to_owned());
    }
    Ok(outcome)
}

/// All values one after another, of at least two groups none of which is empty.
fn joined(groups: &[Vec<f64>]) -> Computed<Vec<f64>> {
    if groups.len() < 2 {
        return undefined(format!("{} groups, at least 2 are needed", groups.len()));
    }
    for (index, group) in groups.iter().enumerate() {
        let name = |e: Undefined| Undefined::because(format!("group {}: {}", index + 1, e.reason));
        at_least(group, 1).map_err(name)?;
    }
    Ok(groups.concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TwoSamples;
    use selvedge_foundation::numerics::Random;

    fn groups() -> Vec<Vec<f64>> {
        vec![
            vec![6.0, 8.0, 4.0, 5.0, 3.0, 4.0],
            vec![8.0, 12.0, 9.0, 11.0, 6.0, 8.0],
            vec![13.0, 9.0, 11.0, 8.0, 7.0, 12.0],
        ]
    }

    #[test]
    fn one_way_is_that_by_hand() -> Computed<()> {
        // Means 5, 9, 10, grand mean 8: between 6(9 + 1 + 4) = 84; within 16 + 24 + 28 = 68.
        let found = one_way(&groups())?;
        let f = found.statistic.value;
        assert!((f - 42.0 / (68.0 / 15.0)).abs() < 1e-12, "{found:?}");
        // F with 2 and e degrees: p = (1 + 2F/e)^(−e/2) = (152/68)^(−7.5).
        let p = (152.0_f64 / 68.0).powf(-7.5);
        assert!((found.p / p - 1.0).abs() < 1e-11, "closed form");
        assert!((found.effect?.value - 84.0 / 152.0).abs() < 1e-14, "η²");
        Ok(())
    }

    #[test]
    fn an_offset_of_a_million_million_changes_nothing() -> Computed<()> {
        let far: Vec<Vec<f64>> = groups()
            .iter()
            .map(|g| g.iter().map(|v| v + 1e12).collect())
            .collect();
        let (near, far_off) = (one_way(&groups())?, one_way(&far)?);
        let ratio = near.statistic.value / far_off.statistic.value;
        assert!((ratio - 1.0).abs() < 1e-12, "one-way");
        let (near, far_off) = (welch(&groups())?, welch(&far)?);
        assert!((near.p / far_off.p - 1.0).abs() < 1e-9, "Welch");
        assert_eq!(kruskal_wallis(&groups())?, kruskal_wallis(&far)?);
        Ok(())
    }

    #[test]
    fn two_groups_are_a_t_test_squared() -> Computed<()> {
        let two = &groups()[..2];
        let both = TwoSamples::of(&Summary::of(&two[0])?, &Summary::of(&two[1])?)?;
        let one = one_way(two)?;
        assert!(
            (one.statistic.value - both.student.statistic.value.powi(2)).abs() < 1e-12,
            "Student"
        );
        assert!((one.p - both.student.p).abs() < 1e-14, "Student p");
        let unequal = welch(two)?;
        let squared = both.welch.statistic.value.powi(2);
        assert!((unequal.statistic.value - squared).abs() < 1e-12, "Welch");
        assert!((unequal.p - both.welch.p).abs() < 1e-13, "Welch p");
        Ok(())
    }

    #[test]
    fn kruskal_wallis_is_an_analysis_of_ranks() -> Computed<()> {
        // H = (N − 1)·SS between/SS total of the ranks, ties included.
        let found = kruskal_wallis(&groups())?;
        let ranks = Ranks::of(&groups().concat()).ranks;
        let of_ranks: Vec<Vec<f64>> = ranks.chunks(6).map(<[f64]>::to_vec).collect();
        let h = 17.0 * one_way(&of_ranks)?.effect?.value;
        assert!((found.statistic.value - h).abs() < 1e-12, "{found:?}");
        assert!((found.p - (-0.5 * h).exp()).abs() < 1e-12, "χ² of 2");
        assert!(
            found.notes.contains(&"corrected for ties".to_owned()),
            "said"
        );
        Ok(())
    }

    #[test]
    fn f_agrees_with_shuffling_the_labels() -> Computed<()> {
        let groups: Vec<Vec<f64>> = vec![
            vec![6.0, 8.0, 4.0, 5.5],
            vec![8.0, 7.0, 9.0, 4.5],
            vec![6.5, 9.0, 8.5, 7.5],
        ];
        let seen = one_way(&groups)?;
        let mut all = groups.concat();
        let mut random = Random::new(8);
        let mut n_extreme = 0;
        let f = seen.statistic.value;
        for _ in 0..20_000 {
            for i in (1..all.len()).rev() {
                all.swap(i, random.index(i + 1));
            }
            let shuffled: Vec<Vec<f64>> = all.chunks(4).map(<[f64]>::to_vec).collect();
            n_extreme += i32::from(one_way(&shuffled)?.statistic.value >= f - 1e-9);
        }
        let share = f64::from(n_extreme) / 20_000.0;
        let p = seen.p;
        assert!((share - p).abs() < 0.015, "{share} and {p}");
        Ok(())
    }

    #[test]
    fn groups_that_say_nothing_are_refused() {
        let same = vec![vec![2.0; 3]; 3];
        assert!(
            one_way(&same).is_err_and(|e| e.reason.contains("0/0")),
            "0/0"
        );
        assert!(kruskal_wallis(&same).is_err(), "all equal");
        assert!(welch(&same).is_err(), "no spread");
        assert!(one_way(&[vec![1.0, 2.0]]).is_err(), "one group");
        assert!(one_way(&[vec![1.0], vec![2.0]]).is_err(), "one each");
        let empty = one_way(&[vec![1.0, 2.0], vec![]]);
        assert!(
            empty.is_err_and(|e| e.reason == "group 2: no values"),
            "place"
        );
    }
}
