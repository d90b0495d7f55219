//! What has no finite scale, or none at all.

use super::super::*;
use crate::Computed;
use selvedge_foundation::numerics::Random;

fn reason<T: std::fmt::Debug>(found: Computed<T>) -> String {
    found.map_err(|e| e.reason).unwrap_err()
}

fn wins(rows: &[[u64; 4]; 4]) -> Preferences {
    Preferences::of_wins(&rows.map(|row| row.to_vec())).unwrap()
}

#[test]
fn groups_one_above_the_other_are_named_and_a_prior_makes_them_finite() -> Computed<()> {
    let rankings = [vec![2, 0, 1, 3], vec![0, 2, 3, 1], vec![2, 0, 3, 1]];
    let refused = reason(PlackettLuce::fit(4, &rankings, Prior::None));
    assert!(refused.contains("{1, 3} over {2, 4}"), "{refused}");
    let pairs = Preferences::of_rankings(4, &rankings)?;
    let refused = reason(BradleyTerry::fit(&pairs, Prior::None));
    assert!(refused.contains("{1, 3} over {2, 4}"), "{refused}");
    assert!(reason(Thurstone::fit(&pairs)).contains("{1, 3} over {2, 4}"));
    assert_eq!(pairs.connection().groups(), [vec![0, 2], vec![1, 3]]);
    for strength in [1e-3, 0.1, 1.0, 10.0] {
        let found = PlackettLuce::fit(4, &rankings, Prior::Gamma(strength))?;
        let sums = found.scale.values[0] + found.scale.values[2];
        assert!(sums > 0.0 && sums.is_finite(), "{found:?}");
        assert!(found.scale.centred().iter().all(|e| e.se > 0.0));
    }
    for strength in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = reason(PlackettLuce::fit(4, &rankings, Prior::Gamma(strength)));
        assert!(refused.contains("above 0 needed"), "{refused}");
    }
    Ok(())
}

#[test]
fn items_that_nothing_joins_are_named() {
    let pairs = wins(&[[0, 2, 0, 0], [1, 0, 0, 0], [0, 0, 0, 3], [0, 0, 1, 0]]);
    for refused in [
        reason(BradleyTerry::fit(&pairs, Prior::None)),
        reason(Thurstone::fit(&pairs)),
    ] {
        assert!(refused.contains("{1, 2} and {3, 4}"), "{refused}");
    }
    let rows = reason(Mosteller::of(&pairs));
    assert!(
        rows.contains("1 and 3, 1 and 4, 2 and 3, 2 and 4"),
        "{rows}"
    );
    let never = reason(PlackettLuce::fit(3, &[[0, 1], [1, 0]], Prior::None));
    assert!(never.contains("{1, 2} and {3}"), "{never}");
}

#[test]
fn one_item_and_no_comparisons_are_refused() {
    let none: [Vec<usize>; 0] = [];
    assert_eq!(
        reason(PlackettLuce::fit(4, &none, Prior::None)),
        "no rankings"
    );
    let alone = "one item alone: nothing to compare";
    assert_eq!(reason(PlackettLuce::fit(1, &[[0]], Prior::None)), alone);
    assert_eq!(
        reason(BradleyTerry::fit(&Preferences::new(1), Prior::None)),
        alone
    );
    assert_eq!(reason(Thurstone::fit(&Preferences::new(0))), "no items");
    let empty = Preferences::new(3);
    assert_eq!(reason(Mosteller::of(&empty)), "no comparisons");
}

#[test]
fn whatever_is_not_refused_settles_at_finite_values() {
    let mut random = Random::new(29);
    let mut n_whole = 0;
    for round in 0..400 {
        let n = 2 + random.index(5);
        let mut sparse = Preferences::new(n);
        for _ in 0..=random.index(4 * n) {
            let i = random.index(n);
            let j = (i + 1 + random.index(n - 1)) % n;
            match random.index(5) {
                0 => {}
                // One way now and then very often: nearly a group of its own.
                1 => (0..1000).for_each(|_| sparse.prefer(i, j)),
                _ => sparse.prefer(i, j),
            }
        }
        let is_whole = sparse.n_comparisons() > 0 && sparse.connection() == Connection::Whole;
        let logit = BradleyTerry::fit(&sparse, Prior::None);
        let probit = Thurstone::fit(&sparse);
        assert_eq!(
            (logit.is_ok(), probit.is_ok()),
            (is_whole, is_whole),
            "{round}: {sparse:?}"
        );
        n_whole += i32::from(is_whole);
        for scale in [logit.map(|f| f.scale), probit.map(|f| f.scale)]
            .iter()
            .flatten()
        {
            assert!(scale.values.iter().all(|v| v.abs() < 100.0), "{scale:?}");
            assert!(scale.centred().iter().all(|e| e.se > 0.0), "{scale:?}");
        }
    }
    assert!(n_whole > 40, "{n_whole}");
}
