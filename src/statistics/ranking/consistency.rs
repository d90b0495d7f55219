//! How consistent one subject's paired comparisons are (Kendall & Babington Smith 1940).

use super::preferences::Preferences;
use crate::{Computed, chi_squared_upper, undefined};

/// Up to so many items every pattern of answers is counted: 2²¹.
const MOST_EXACT: usize = 7;

/// Circular triads of one subject: a over b, b over c and c over a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Consistency {
    /// Items, each compared once with every other.
    pub n_items: usize,
    /// Triads in all.
    pub n_triads: u64,
    /// Circular ones.
    pub n_circular: u64,
    /// The most that so many items can have: k(k² − 1)/24 for odd k, k(k² − 4)/24 for even k.
    pub(crate) most_circular: u64,
    /// Kendall's ζ: 1 for an order without a circle, 0 for as many circles as there can be.
    pub zeta: f64,
    /// Probability that answers by chance have as few circular triads.
    pub p_of_chance: f64,
    /// Whether that counts every pattern of answers (up to 7 items); else it is by Kendall's χ²
    /// with k(k − 1)(k − 2)/(k − 4)² degrees of freedom.
    pub is_exact: bool,
}

/// Of one subject who compared every two items once.
///
/// # Errors
/// Fewer than three items; pairs compared never or more than once (with their list).
pub(super) fn consistency(answers: &Preferences) -> Computed<Consistency> {
    let k = answers.n_items();
    if k < 3 {
        return undefined(format!("{k} items make no triad"));
    }
    answers.check()?;
    let odd = answers.pairs_where(|n| n != 1);
    if !odd.is_empty() {
        return undefined(format!("not compared exactly once: {}", odd.join(", ")));
    }
    let preferred = |i| (0..k).map(|j| answers.wins(i, j)).sum();
    let scores: Vec<u64> = (0..k).map(preferred).collect();
    let size = k as u64;
    let (n_circular, most) = (circular(&scores), most_circular(size));
    Ok(Consistency {
        n_items: k,
        n_triads: size * (size - 1) * (size - 2) / 6,
        n_circular,
        most_circular: most,
        zeta: 1.0 - n_circular as f64 / most as f64,
        p_of_chance: if k <= MOST_EXACT {
            exact_p(k, n_circular)
        } else {
            p_by_chi_squared(size, n_circular)?
        },
        is_exact: k <= MOST_EXACT,
    })
}

/// Triads of items among comparisons that may be many of a pair, or none: each pair goes to the one
/// that was preferred more often, and to nobody where both were as often.
#[derive(Debug, Clone, PartialEq)]
pub struct Majority {
    /// Pairs that were compared.
    pub n_pairs: usize,
    /// Pairs among them that go to nobody.
    pub n_undecided: usize,
    /// Triads whose three pairs are decided.
    pub n_triads: u64,
    /// Circular ones among them; a quarter by chance.
    pub n_circular: u64,
    /// Of the majorities, where they decide every pair.
    pub consistency: Computed<Consistency>,
}

impl Majority {
    /// Of any comparisons.
    pub fn of(answers: &Preferences) -> Self {
        let k = answers.n_items();
        let mut decided = vec![vec![0; k]; k];
        let (mut n_pairs, mut n_undecided) = (0, 0);
        for (i, j) in (0..k).flat_map(|i| (i + 1..k).map(move |j| (i, j))) {
            let [forth, back] = [answers.wins(i, j), answers.wins(j, i)];
            let is_compared = forth + back > 0;
            n_pairs += usize::from(is_compared);
            n_undecided += usize::from(is_compared && forth == back);
            decided[i][j] = u64::from(forth > back);
            decided[j][i] = u64::from(back > forth);
        }
        let over = |i: usize, j: usize| decided[i][j] > 0;
        let either = |i, j| over(i, j) || over(j, i);
        let (mut n_triads, mut n_circular) = (0, 0);
        for a in 0..k {
            for b in (a + 1..k).filter(|&b| either(a, b)) {
                for c in (b + 1..k).filter(|&c| either(a, c) && either(b, c)) {
                    n_triads += 1;
                    let around = [over(a, b), over(b, c), over(c, a)];
                    n_circular += u64::from(around == [true; 3] || around == [false; 3]);
                }
            }
        }
        Self {
            n_pairs,
            n_undecided,
            n_triads,
            n_circular,
            consistency: Preferences::of_wins(&decided).and_then(|all| consistency(&all)),
        }
    }
}

/// Triads less those in which one item is over both others.
fn circular(scores: &[u64]) -> u64 {
    let k = scores.len() as u64;
    let on_top: u64 = scores.iter().map(|a| a * a.saturating_sub(1) / 2).sum();
    k * (k - 1) * (k - 2) / 6 - on_top
}

fn most_circular(k: u64) -> u64 {
    k * (k * k - if k % 2 == 1 { 1 } else { 4 }) / 24
}

/// Walks all answers to all pairs in Gray code, one answer at a time.
fn exact_p(k: usize, n_circular: u64) -> f64 {
    let pairs = (0..k).flat_map(|i| (i + 1..k).map(move |j| [i, j]));
    // Winner and loser of each pair, those of an order at first.
    let mut pairs: Vec<[usize; 2]> = pairs.collect();
    let mut scores: Vec<u64> = (0..k as u64).rev().collect();
    let mut found = circular(&scores);
    let n_patterns = 1_u64 << pairs.len();
    let mut n_as_few = u64::from(found <= n_circular);
    for step in 1..n_patterns {
        let pair = &mut pairs[step.trailing_zeros() as usize];
        let [winner, loser] = *pair;
        *pair = [loser, winner];
        // Of triads with one item on top, the winner's score less 1 fewer, the loser's score more.
        scores[winner] -= 1;
        found = found + scores[winner] - scores[loser];
        scores[loser] += 1;
        n_as_few += u64::from(found <= n_circular);
    }
    n_as_few as f64 / n_patterns as f64
}

/// Kendall's χ² is of as many circles or more; as few as `n_circular` is the rest, half a circle
/// higher.
fn p_by_chi_squared(k: u64, n_circular: u64) -> Computed {
    let size = k as f64;
    let df = size * (size - 1.0) * (size - 2.0) / (size - 4.0).powi(2);
    let expected = size * (size - 1.0) * (size - 2.0) / 24.0;
    let chi = 8.0 / (size - 4.0) * (expected - n_circular as f64 - 0.5) + df;
    chi_squared_upper(chi.max(0.0), df)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    fn answers(k: usize, is_first: impl FnMut(usize, usize) -> bool) -> Preferences {
        let mut is_first = is_first;
        let mut all = Preferences::new(k);
        for (i, j) in (0..k).flat_map(|i| (i + 1..k).map(move |j| (i, j))) {
            let (upper, lower) = if is_first(i, j) { (i, j) } else { (j, i) };
            all.prefer(upper, lower);
        }
        all
    }

    fn counted(answers: &Preferences) -> u64 {
        let k = answers.n_items();
        let over = |i, j| answers.wins(i, j) == 1;
        let mut n = 0;
        for (a, b, c) in
            (0..k).flat_map(|a| (a + 1..k).flat_map(move |b| (b + 1..k).map(move |c| (a, b, c))))
        {
            let one_way = over(a, b) && over(b, c) && over(c, a);
            let other_way = over(b, a) && over(c, b) && over(a, c);
            n += u64::from(one_way || other_way);
        }
        n
    }

    #[test]
    fn an_order_has_no_circle_and_a_wheel_has_the_most() -> Computed<()> {
        for k in 3..=12 {
            let order = consistency(&answers(k, |_, _| true))?;
            assert_eq!((order.n_circular, order.zeta), (0, 1.0));
            // Each over the next half of the others around the wheel.
            let wheel = consistency(&answers(k, |i, j| 2 * (j - i) <= k))?;
            assert_eq!(wheel.n_circular, wheel.most_circular, "{k}");
            assert_eq!(wheel.zeta, 0.0);
            assert!(wheel.p_of_chance > 0.98, "{wheel:?}");
        }
        let three = consistency(&answers(3, |_, _| true))?;
        assert_eq!(three.p_of_chance, 6.0 / 8.0);
        assert_eq!(three.n_triads, 1);
        Ok(())
    }

    #[test]
    fn triads_are_as_many_as_counted_one_by_one() -> Computed<()> {
        let mut random = Random::new(5);
        for k in [4, 5, 7, 8, 11] {
            let found = answers(k, |_, _| random.uniform() < 0.5);
            assert_eq!(consistency(&found)?.n_circular, counted(&found), "{k}");
        }
        Ok(())
    }

    #[test]
    fn majorities_are_counted_where_they_decide() -> Computed<()> {
        let mut random = Random::new(6);
        let once = answers(9, |_, _| random.uniform() < 0.5);
        let thrice = Preferences::together([&once, &once, &answers(9, |_, _| true)])?;
        let (found, own) = (Majority::of(&thrice), consistency(&once)?);
        assert_eq!((found.n_pairs, found.n_undecided), (36, 0));
        assert_eq!(
            (found.n_triads, found.n_circular),
            (own.n_triads, own.n_circular)
        );
        assert_eq!(found.consistency, Ok(own));
        // One against one leaves a pair to nobody, and seven triads with it.
        let mut split = once.clone();
        split.prefer(0, 1);
        split.prefer(1, 0);
        let (upper, lower) = if once.wins(0, 1) > 0 { (1, 0) } else { (0, 1) };
        split.prefer(upper, lower);
        let found = Majority::of(&split);
        assert_eq!((found.n_undecided, found.n_triads), (1, 84 - 7));
        assert!(found.consistency.is_err(), "a pair is missing");
        Ok(())
    }

    #[test]
    fn an_order_of_all_is_as_likely_by_chance_as_orders_are_among_patterns() {
        for (k, orders) in [(4, 24.0), (5, 120.0), (6, 720.0), (7, 5040.0_f64)] {
            let n_pairs = i32::try_from(k * (k - 1) / 2).unwrap();
            let share = orders / 2.0_f64.powi(n_pairs);
            assert!((exact_p(k, 0) / share - 1.0).abs() < 1e-12, "{k}");
        }
    }

    #[test]
    fn chi_squared_agrees_with_every_pattern_and_with_random_answers() -> Computed<()> {
        for n_circular in [2, 5, 8, 11] {
            let (exact, by_chi) = (exact_p(7, n_circular), p_by_chi_squared(7, n_circular)?);
            assert!((exact - by_chi).abs() < 0.02, "{exact} and {by_chi}");
        }
        let mut random = Random::new(9);
        let n = 4000;
        let mut n_as_few = 0;
        for _ in 0..n {
            let found = answers(16, |_, _| random.uniform() < 0.5);
            n_as_few += i32::from(consistency(&found)?.n_circular <= 130);
        }
        let share = f64::from(n_as_few) / f64::from(n);
        let by_chi = p_by_chi_squared(16, 130)?;
        assert!((share - by_chi).abs() < 0.03, "{share} and {by_chi}");
        Ok(())
    }

    #[test]
    fn answers_that_are_not_one_a_pair_are_refused_with_their_list() {
        let mut some = Preferences::new(3);
        some.prefer(0, 1);
        some.prefer(0, 1);
        some.prefer(1, 2);
        let reason = consistency(&some).map_err(|e| e.reason).unwrap_err();
        assert_eq!(reason, "not compared exactly once: 1 and 2, 1 and 3");
        assert!(consistency(&Preferences::new(2)).is_err(), "no triad");
    }
}
