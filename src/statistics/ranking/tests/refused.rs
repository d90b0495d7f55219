//! What has no finite scale, or none at all.

use super::super::davidson::davidson;
use super::super::*;
use super::{SIX, assert_close, drawn};
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
    let refused = reason(plackett_luce(4, &rankings, Prior::None));
    assert!(refused.contains("{1, 3} over {2, 4}"), "{refused}");
    let pairs = Preferences::of_rankings(4, &rankings)?;
    let refused = reason(bradley_terry(&pairs, Prior::None));
    assert!(refused.contains("{1, 3} over {2, 4}"), "{refused}");
    assert!(reason(thurstone(&pairs)).contains("{1, 3} over {2, 4}"));
    assert_eq!(pairs.connection().groups(), [vec![0, 2], vec![1, 3]]);
    for strength in [1e-3, 0.1, 1.0, 10.0] {
        let found = plackett_luce(4, &rankings, Prior::Gamma(strength))?;
        let sums = found.scale.values[0] + found.scale.values[2];
        assert!(sums > 0.0 && sums.is_finite(), "{found:?}");
        assert!(found.scale.centred().iter().all(|e| e.se > 0.0));
    }
    for strength in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = reason(plackett_luce(4, &rankings, Prior::Gamma(strength)));
        assert!(refused.contains("above 0 needed"), "{refused}");
    }
    Ok(())
}

#[test]
fn items_that_nothing_joins_are_named() -> Computed<()> {
    let pairs = wins(&[[0, 2, 0, 0], [1, 0, 0, 0], [0, 0, 0, 3], [0, 0, 1, 0]]);
    for refused in [
        reason(bradley_terry(&pairs, Prior::None)),
        reason(thurstone(&pairs)),
        reason(davidson(
            &pairs.clone().with_ties(&[
                vec![0, 1, 0, 0],
                vec![1, 0, 0, 0],
                vec![0; 4],
                vec![0; 4],
            ])?,
            Prior::None,
        )),
    ] {
        assert!(refused.contains("{1, 2} and {3, 4}"), "{refused}");
    }
    let rows = reason(mosteller(&pairs));
    assert!(
        rows.contains("1 and 3, 1 and 4, 2 and 3, 2 and 4"),
        "{rows}"
    );
    let never = reason(plackett_luce(3, &[[0, 1], [1, 0]], Prior::None));
    assert!(never.contains("{1, 2} and {3}"), "{never}");
    Ok(())
}

#[test]
fn one_item_and_no_comparisons_are_refused() {
    let none: [Vec<usize>; 0] = [];
    assert_eq!(reason(plackett_luce(4, &none, Prior::None)), "no rankings");
    let alone = "one item alone: nothing to compare";
    assert_eq!(reason(plackett_luce(1, &[[0]], Prior::None)), alone);
    assert_eq!(
        reason(bradley_terry(&Preferences::new(1), Prior::None)),
        alone
    );
    assert_eq!(reason(thurstone(&Preferences::new(0))), "no items");
    let empty = Preferences::new(3);
    assert_eq!(reason(mosteller(&empty)), "no comparisons");
    assert_eq!(
        reason(davidson(&empty, Prior::Gamma(1.0))),
        "no comparisons"
    );
    let how = crate::Resampling {
        n_resamples: 100,
        seed: 1,
        level: 0.95,
    };
    let silent = [vec![vec![0, 1], vec![1, 0]], vec![]];
    let refused = reason(plackett_luce_over_subjects(2, &silent, Prior::None, how));
    assert_eq!(refused, "subject 2: no rankings");
}

#[test]
fn ties_are_for_davidson_alone_and_he_needs_some() -> Computed<()> {
    let plain = wins(&[[0, 2, 2, 1], [1, 0, 2, 2], [1, 1, 0, 2], [1, 1, 1, 0]]);
    assert!(reason(davidson(&plain, Prior::None)).contains("ν is 0"));
    let ties = vec![
        vec![0, 1, 1, 0],
        vec![1, 0, 0, 0],
        vec![1, 0, 0, 0],
        vec![0; 4],
    ];
    let tied = plain.clone().with_ties(&ties)?;
    let refused = reason(bradley_terry(&tied, Prior::None));
    assert!(
        refused.contains("2 of 19 comparisons are ties"),
        "{refused}"
    );
    assert!(thurstone(&tied).is_err() && mosteller(&tied).is_err());
    assert!(davidson(&tied, Prior::None).is_ok(), "some of each");
    let all = Preferences::new(4).with_ties(&ties)?;
    assert!(reason(davidson(&all, Prior::None)).contains("all 2 comparisons are ties"));
    assert_eq!(tied.without_ties(), plain);
    Ok(())
}

#[test]
fn ties_that_make_steps_leave_nu_without_end_though_all_are_joined() -> Computed<()> {
    // Preferred five times, tied five times, never the other way: 1/2, 1/2 and 0 are only reached
    // with both infinitely large.
    let mut steps = Preferences::of_wins(&[vec![0, 5], vec![0, 0]])?;
    for _ in 0..5 {
        steps.tie(0, 1)?;
    }
    assert_eq!(steps.connection_with_ties(), Connection::Whole);
    assert!(reason(davidson(&steps, Prior::None)).contains("steps"));
    let found = davidson(&steps, Prior::Gamma(0.5))?;
    assert!(found.log_nu.value.is_finite(), "{found:?}");
    // A circle of three that passes one tie goes round once more up than down.
    let mut circle = Preferences::new(3);
    circle.prefer(0, 1)?;
    circle.prefer(1, 2)?;
    circle.tie(2, 0)?;
    assert!(davidson(&circle, Prior::None).is_ok(), "two up, one beside");
    Ok(())
}

#[test]
fn davidsons_peak_has_no_way_up_and_recovers_what_made_the_answers() -> Computed<()> {
    let mut random = Random::new(17);
    let nu = 0.8_f64;
    let mut answers = Preferences::new(6);
    for n in 0..3000 {
        let (i, j) = (n % 6, (n + 1 + n / 600) % 6);
        let half = 0.5 * (SIX[i] - SIX[j]);
        let (upper, lower) = (half.exp(), (-half).exp());
        let at = random.uniform() * (upper + lower + nu);
        if at < upper {
            answers.prefer(i, j)?;
        } else if at < upper + lower {
            answers.prefer(j, i)?;
        } else {
            answers.tie(i, j)?;
        }
    }
    let found = davidson(&answers, Prior::None)?;
    for (estimate, truth) in found.scale.centred().iter().zip(SIX) {
        assert!(
            (estimate.value - truth).abs() < 4.0 * estimate.se,
            "{estimate:?}"
        );
    }
    assert!((found.log_nu.value - nu.ln()).abs() < 4.0 * found.log_nu.se);
    let value = |x: &[f64], log_nu: f64| {
        let mut sum = 0.0;
        for (i, j) in (0..6).flat_map(|i| (i + 1..6).map(move |j| (i, j))) {
            let (a, b) = (x[i].exp(), x[j].exp());
            let tie = (log_nu + 0.5 * (x[i] + x[j])).exp();
            let all = a + b + tie;
            for (n, p) in [
                (answers.wins(i, j), a / all),
                (answers.wins(j, i), b / all),
                (answers.ties(i, j), tie / all),
            ] {
                sum += n as f64 * p.ln();
            }
        }
        sum
    };
    let (x, log_nu) = (&found.scale.values, found.log_nu.value);
    assert_close(&[value(x, log_nu)], &[found.log_likelihood], 1e-8);
    for by in [-0.1, 0.1] {
        assert!(value(x, log_nu + by) < found.log_likelihood);
        for item in 0..6 {
            let mut moved = x.clone();
            moved[item] += by;
            assert!(value(&moved, log_nu) < found.log_likelihood);
        }
    }
    // Each pair of the thirty orders met: two free shares each.
    assert_eq!((found.deviance.df, found.deviance.null_df), (24, 29));
    assert!(
        found.deviance.goodness_of_fit()?.p > 1e-3,
        "the right model"
    );
    Ok(())
}

#[test]
fn a_draw_of_subjects_that_falls_into_groups_is_counted_and_not_made_up() -> Computed<()> {
    let mut random = Random::new(3);
    let mut subjects: Vec<Vec<Vec<usize>>> = (0..5)
        .map(|_| (0..4).map(|_| drawn(&SIX, &[0, 1], &mut random)).collect())
        .collect();
    subjects.push(vec![vec![0, 1], vec![1, 0], vec![1, 2], vec![2, 1]]);
    let how = crate::Resampling {
        n_resamples: 300,
        seed: 1,
        level: 0.95,
    };
    // Item 3 is there for one subject of six: missing in (5/6)⁶ = 0.33 of the draws.
    let found = plackett_luce_over_subjects(3, &subjects, Prior::None, how)?;
    assert!((60..150).contains(&found[2].n_undefined), "{:?}", found[2]);
    assert!(found[2].bca.is_err(), "without that subject there is none");
    let with_prior = plackett_luce_over_subjects(3, &subjects, Prior::Gamma(0.5), how)?;
    assert!(with_prior.iter().all(|item| item.n_undefined == 0));
    Ok(())
}

#[test]
fn whatever_is_not_refused_settles_at_finite_values() -> Computed<()> {
    let mut random = Random::new(29);
    let (mut n_whole, mut n_tied) = (0, 0);
    for round in 0..400 {
        let n = 2 + random.index(5);
        let mut sparse = Preferences::new(n);
        for _ in 0..=random.index(4 * n) {
            let i = random.index(n);
            let j = (i + 1 + random.index(n - 1)) % n;
            match random.index(5) {
                0 => sparse.tie(i, j)?,
                // One way now and then very often: nearly a group of its own.
                1 => (0..1000).try_for_each(|_| sparse.prefer(i, j))?,
                _ => sparse.prefer(i, j)?,
            }
        }
        let untied = sparse.clone().without_ties();
        let is_whole = untied.n_comparisons() > 0 && untied.connection() == Connection::Whole;
        let logit = bradley_terry(&untied, Prior::None);
        let probit = thurstone(&untied);
        assert_eq!(
            (logit.is_ok(), probit.is_ok()),
            (is_whole, is_whole),
            "{round}: {untied:?}"
        );
        n_whole += i32::from(is_whole);
        for scale in [logit.map(|f| f.scale), probit.map(|f| f.scale)]
            .iter()
            .flatten()
        {
            assert!(scale.values.iter().all(|v| v.abs() < 100.0), "{scale:?}");
            assert!(scale.centred().iter().all(|e| e.se > 0.0), "{scale:?}");
        }
        match davidson(&sparse, Prior::None) {
            Ok(found) => {
                n_tied += 1;
                let is_finite = found.log_nu.value.abs() < 100.0 && found.log_nu.se < 1e4;
                assert!(is_finite, "{round}: {found:?}");
            }
            Err(e) => {
                let is_named = ["settle", "flat"].iter().all(|w| !e.reason.contains(w));
                assert!(is_named, "{round}: {e}");
            }
        }
    }
    assert!(n_whole > 40 && n_tied > 40, "{n_whole}, {n_tied}");
    Ok(())
}
