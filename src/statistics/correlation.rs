//! Correlations of Pearson and Spearman, with p and interval.

use super::distribution::t_two_sided;
use super::interval::fisher_z_with;
use super::summary::{at_least, centred, dot, is_rounding, largest, sum_of_squares};
use super::wilcoxon::Ranks;
use super::{Computed, Freedom, Interval, Named, Outcome, Sides, undefined};

/// Up to so many pairs Spearman's p is exact: 8! orders.
const MOST_EXACT: usize = 8;
const LEVEL: f64 = 0.95;

/// Pearson's r of pairs with the t test of n − 2 degrees of freedom, t = r√((n − 2)/(1 − r²)), and
/// the interval by Fisher's z.
///
/// # Errors
/// Fewer than 3 pairs, values that are not finite, one side all equal, all points on a line
/// (t is infinite then; [`pearson_r`] still gives r).
pub fn pearson(x: &[f64], y: &[f64]) -> Computed<Outcome> {
    let r = pearson_r(x, y)?;
    let mut outcome = with_t("Pearson correlation", "r", r, x.len())?;
    outcome.interval = Interval::fisher_z(r, x.len(), LEVEL);
    Ok(outcome)
}

/// Pearson's r alone.
///
/// # Errors
/// As [`pearson`], but for points on a line.
pub fn pearson_r(x: &[f64], y: &[f64]) -> Computed {
    if x.len() != y.len() {
        return undefined(format!("{} values against {}: not pairs", x.len(), y.len()));
    }
    at_least(x, 3)?;
    at_least(y, 3)?;
    let deviations = |values: &[f64], side: &str| {
        let (mean, deviations) = centred(values);
        let squares = sum_of_squares(&deviations);
        if is_rounding(squares, values.len(), largest(values)) {
            let reason = format!("all {} values of {side} equal {mean}", values.len());
            return undefined(reason);
        }
        Ok((deviations, squares.sqrt()))
    };
    let (dx, size_x) = deviations(x, "x")?;
    let (dy, size_y) = deviations(y, "y")?;
    let product: f64 = dx
        .iter()
        .zip(&dy)
        .map(|(a, b)| (a / size_x) * (b / size_y))
        .sum();
    // A line but for rounding is a line.
    let is_line = 1.0 - product.abs() < 8.0 * f64::EPSILON;
    Ok(if is_line { product.signum() } else { product })
}

/// Spearman's rank correlation: r of the ranks, equal values sharing theirs.
///
/// p is exact given the ties up to 8 pairs, by all orders of one side; beyond, by the t test.
/// The interval is Fisher's z with variance (1 + r²/2)/(n − 3) (Bonett & Wright 2000).
///
/// # Errors
/// As [`pearson`]; ranks in perfect order with more than 8 pairs have no t.
pub fn spearman(x: &[f64], y: &[f64]) -> Computed<Outcome> {
    pearson_r(x, y)?;
    let (ranks_x, ranks_y) = (Ranks::of(x), Ranks::of(y));
    let r = pearson_r(&ranks_x.ranks, &ranks_y.ranks)?;
    let n = x.len();
    let (test, symbol) = ("Spearman rank correlation", "ρ");
    let mut outcome = if n <= MOST_EXACT {
        let mut outcome = blank(test, symbol, r, n);
        outcome.p = exact_p(&ranks_x.ranks, &ranks_y.ranks);
        outcome.notes.push("exact over all orders".to_owned());
        outcome
    } else {
        with_t(test, symbol, r, n)?
    };
    outcome.interval = fisher_z_with(r, n, 1.0 + 0.5 * r * r, LEVEL);
    if ranks_x.tie_sum + ranks_y.tie_sum > 0.0 {
        let note = "equal values share the mean of their ranks".to_owned();
        outcome.notes.push(note);
    }
    Ok(outcome)
}

/// The correlation of ranks alone, of any number of pairs; equal values share the mean of their
/// ranks.
///
/// # Errors
/// All values of one side are equal.
pub fn rank_correlation(a: &[f64], b: &[f64]) -> Computed {
    let middle = 0.5 * (a.len() as f64 + 1.0);
    let about = |values: &[f64]| -> Vec<f64> {
        Ranks::of(values).ranks.iter().map(|r| r - middle).collect()
    };
    let (a, b) = (about(a), about(b));
    let spread = (dot(&a, &a) * dot(&b, &b)).sqrt();
    if spread > 0.0 {
        Ok(dot(&a, &b) / spread)
    } else {
        undefined("all distances are equal")
    }
}

fn blank(test: &'static str, symbol: &'static str, r: f64, n: usize) -> Outcome {
    let named = Named::of(symbol, r);
    Outcome {
        test,
        n: vec![n],
        statistic: named,
        df: Freedom::None,
        p: 1.0,
        sides: Sides::Two,
        effect: Ok(named),
        estimate: Ok(named),
        interval: undefined("no interval"),
        notes: Vec::new(),
    }
}

fn with_t(test: &'static str, symbol: &'static str, r: f64, n: usize) -> Computed<Outcome> {
    let df = n as f64 - 2.0;
    let rest = (1.0 - r) * (1.0 + r);
    if rest <= 0.0 {
        return undefined(format!("{symbol} = {r:+}: in perfect order, t is infinite"));
    }
    let t = r * (df / rest).sqrt();
    let mut outcome = blank(test, symbol, r, n);
    outcome.statistic = Named::of("t", t);
    outcome.df = Freedom::One(df);
    outcome.p = t_two_sided(t, df)?;
    Ok(outcome)
}

/// The share of all orders of `y` whose product with `x` is as far from its mean.
fn exact_p(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len();
    let expected = x.iter().sum::<f64>() * y.iter().sum::<f64>() / n as f64;
    let away = |y: &[f64]| {
        let product: f64 = x.iter().zip(y).map(|(a, b)| a * b).sum();
        (product - expected).abs()
    };
    let least = away(y) - 1e-9;
    let (mut order, mut counters) = (y.to_vec(), vec![0; n]);
    let (mut n_extreme, mut n_all) = (1_u32, 1_u32);
    // Heap's algorithm: each order once, one exchange apart.
    let mut place = 1;
    while place < n {
        if counters[place] < place {
            let other = if place % 2 == 0 { 0 } else { counters[place] };
            order.swap(other, place);
            n_all += 1;
            n_extreme += u32::from(away(&order) >= least);
            counters[place] += 1;
            place = 1;
        } else {
            counters[place] = 0;
            place += 1;
        }
    }
    f64::from(n_extreme) / f64::from(n_all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn r_of_sixteen_textiles_has_the_p_that_follows_from_its_size() -> Computed<()> {
        let outcome = with_t("Pearson correlation", "r", 0.55, 16)?;
        assert!((outcome.p - 0.027).abs() < 5e-4, "{}", outcome.p);
        assert_eq!(outcome.df, Freedom::One(14.0));
        Ok(())
    }

    #[test]
    fn r_is_that_by_hand_at_any_offset() -> Computed<()> {
        // Deviations (−1.5, −0.5, 0.5, 1.5) and (−1, −2, 1, 2): r = 6/√(5·10).
        let (x, y) = ([1.0, 2.0, 3.0, 4.0], [2.0, 1.0, 4.0, 5.0]);
        let r = pearson_r(&x, &y)?;
        assert!((r - 6.0 / 50.0_f64.sqrt()).abs() < 1e-14, "{r}");
        let far: Vec<f64> = x.iter().map(|v| v + 1e12).collect();
        assert!((pearson_r(&far, &y)? - r).abs() < 1e-14, "offset");
        Ok(())
    }

    #[test]
    fn ranks_agree_whatever_the_values_and_disagree_when_turned_round() -> Computed<()> {
        let places = [1.0, 2.0, 3.0, 4.0];
        let rising = [10.0, 11.0, 1000.0, 1001.0];
        assert!((rank_correlation(&places, &rising)? - 1.0).abs() < 1e-12);
        assert!((rank_correlation(&places, &rising.map(|y| -y))? + 1.0).abs() < 1e-12);
        let one_swapped = [1.0, 3.0, 2.0, 4.0];
        assert!((rank_correlation(&places, &one_swapped)? - 0.8).abs() < 1e-12);
        assert!(rank_correlation(&[1.0], &[1.0]).is_err(), "one pair");
        Ok(())
    }

    #[test]
    fn p_agrees_with_shuffling() -> Computed<()> {
        let x: Vec<f64> = (0..12).map(f64::from).collect();
        let y = [3.0, 1.0, 2.0, 6.0, 4.0, 4.5, 9.0, 2.5, 7.0, 5.0, 6.5, 5.5];
        let outcome = pearson(&x, &y)?;
        let seen = outcome.estimate.clone().map(|e| e.value)?;
        let mut random = Random::new(4);
        let mut shuffled = y;
        let mut n_extreme = 0;
        for _ in 0..20_000 {
            for i in (1..shuffled.len()).rev() {
                shuffled.swap(i, random.index(i + 1));
            }
            n_extreme += i32::from(pearson_r(&x, &shuffled)?.abs() >= seen.abs());
        }
        let share = f64::from(n_extreme) / 20_000.0;
        assert!(
            (share - outcome.p).abs() < 0.01,
            "{share} and {}",
            outcome.p
        );
        Ok(())
    }

    #[test]
    fn spearman_of_few_counts_all_orders() -> Computed<()> {
        let x = [1.0, 2.0, 3.0, 4.0, 5.0];
        // Perfect order: it and its reverse of 5! = 120.
        let perfect = spearman(&x, &[1.0, 8.0, 9.0, 20.0, 70.0])?;
        assert_eq!(perfect.p, 2.0 / 120.0);
        assert!(perfect.interval.is_err(), "ρ = 1 has no z");
        // ρ = 0.9, n = 5: tabulated two-sided p 0.083.
        let next = spearman(&x, &[1.0, 2.0, 3.0, 5.0, 4.0])?;
        assert!((next.statistic.value - 0.9).abs() < 1e-14, "{next:?}");
        assert!((next.p - 10.0 / 120.0).abs() < 1e-15, "{}", next.p);
        let tied = spearman(&x, &[1.0, 1.0, 2.0, 2.0, 3.0])?;
        assert!(tied.notes.iter().any(|n| n.contains("share")), "said");
        Ok(())
    }

    #[test]
    fn spearman_of_many_is_close_to_all_orders_of_eight() -> Computed<()> {
        let x: Vec<f64> = (0..8).map(f64::from).collect();
        let y = [1.0, 0.0, 3.0, 2.0, 7.0, 4.0, 5.0, 6.0];
        let exact = spearman(&x, &y)?;
        let by_t = with_t("", "ρ", exact.statistic.value, 8)?;
        assert!(
            (exact.p - by_t.p).abs() < 0.01,
            "{} and {}",
            exact.p,
            by_t.p
        );
        Ok(())
    }

    #[test]
    fn what_has_no_correlation_says_why() {
        let reason = |x: &[f64], y: &[f64]| pearson(x, y).map(|_| ()).map_err(|e| e.reason);
        let same = reason(&[2.0; 4], &[1.0, 2.0, 3.0, 4.0]);
        assert_eq!(same, Err("all 4 values of x equal 2".to_owned()));
        let line = reason(&[1.0, 2.0, 3.0], &[2.0, 4.0, 6.0]);
        assert!(
            line.is_err_and(|r| r.contains("perfect order")),
            "on a line"
        );
        assert!(reason(&[1.0, 2.0], &[2.0, 1.0]).is_err(), "two pairs");
    }
}
