//! Scales against closed forms, each other, Hunter's MM and worths that are known.

mod known;
mod refused;

use super::*;
use crate::{Computed, Freedom};
use selvedge_foundation::numerics::Random;

/// A ranking of some items by Luce's rule, worths given by their logarithms: the order of
/// exponential times at which items would come (Plackett 1975).
fn drawn(log_worths: &[f64], among: &[usize], random: &mut Random) -> Vec<usize> {
    let time = |&item: &usize| -(1.0 - random.uniform()).ln() / log_worths[item].exp();
    let times: Vec<f64> = among.iter().map(time).collect();
    let mut order: Vec<usize> = (0..among.len()).collect();
    order.sort_by(|&a, &b| times[a].total_cmp(&times[b]));
    order.iter().map(|&place| among[place]).collect()
}

/// Rankings of four of the items each, sets by chance.
fn fours(log_worths: &[f64], n: usize, random: &mut Random) -> Vec<Vec<usize>> {
    let mut items: Vec<usize> = (0..log_worths.len()).collect();
    (0..n)
        .map(|_| {
            random.shuffle(&mut items);
            drawn(log_worths, &items[..4], random)
        })
        .collect()
}

/// Log-likelihood of rankings, stage by stage, by another route than the fit's.
fn by_stages(log_worths: &[f64], rankings: &[Vec<usize>]) -> f64 {
    let stage = |rest: &[usize]| {
        let sum: f64 = rest.iter().map(|&i| log_worths[i].exp()).sum();
        log_worths[rest[0]] - sum.ln()
    };
    let stages = |r: &Vec<usize>| (0..r.len()).map(|from| stage(&r[from..])).sum::<f64>();
    rankings.iter().map(stages).sum()
}

/// One round of Hunter's MM for Plackett and Luce's model (2004, equation 30).
fn mm_round(worths: &[f64], rankings: &[Vec<usize>]) -> Vec<f64> {
    let mut wins = vec![0.0; worths.len()];
    let mut shares = vec![0.0; worths.len()];
    for ranking in rankings {
        for from in 0..ranking.len() - 1 {
            wins[ranking[from]] += 1.0;
            let sum: f64 = ranking[from..].iter().map(|&i| worths[i]).sum();
            for &item in &ranking[from..] {
                shares[item] += 1.0 / sum;
            }
        }
    }
    let next: Vec<f64> = wins.iter().zip(&shares).map(|(w, s)| w / s).collect();
    let sum: f64 = next.iter().sum();
    next.iter().map(|worth| worth / sum).collect()
}

fn assert_close(found: &[f64], expected: &[f64], error: f64) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() <= error, "{found:?} for {expected:?}");
    }
}

const SIX: [f64; 6] = [1.2, 0.6, 0.1, -0.2, -0.6, -1.1];

#[test]
fn the_peak_is_where_mm_ends_and_no_step_from_it_leads_up() -> Computed<()> {
    let rankings = fours(&SIX, 60, &mut Random::new(4));
    let found = PlackettLuce::fit(6, &rankings, Prior::None)?;
    let values = &found.scale.values;
    assert!(values.iter().sum::<f64>().abs() < 1e-13, "centred");
    assert!((found.log_likelihood - by_stages(values, &rankings)).abs() < 1e-9);
    assert_close(
        &mm_round(&found.worths(), &rankings),
        &found.worths(),
        1e-13,
    );
    let mut from_equal = vec![1.0 / 6.0; 6];
    for _ in 0..3000 {
        from_equal = mm_round(&from_equal, &rankings);
    }
    assert_close(&from_equal, &found.worths(), 1e-10);
    for item in 0..6 {
        let moved = |by: f64| {
            let mut x = values.clone();
            x[item] += by;
            by_stages(&x, &rankings)
        };
        for by in [-0.5, -0.01, 0.01, 0.5] {
            assert!(moved(by) < found.log_likelihood, "item {item} by {by}");
        }
        let slope = (moved(1e-4) - moved(-1e-4)) / 2e-4;
        assert!(slope.abs() < 1e-5, "{slope}");
    }
    Ok(())
}

#[test]
fn errors_are_those_of_the_curvature_seen_by_differences() -> Computed<()> {
    let rankings = fours(&SIX, 80, &mut Random::new(6));
    let found = PlackettLuce::fit(6, &rankings, Prior::None)?;
    // The covariance times the information is the identity less the mean.
    let h = 1e-3;
    let bent = |i: usize, j: usize| {
        let at = |a: f64, b: f64| {
            let mut x = found.scale.values.clone();
            x[i] += a;
            x[j] += b;
            by_stages(&x, &rankings)
        };
        -(at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4.0 * h * h)
    };
    for i in 0..6 {
        for j in 0..6 {
            let terms = (0..6).map(|k| found.scale.covariance[i][k] * bent(k, j));
            let expected = f64::from(u8::from(i == j)) - 1.0 / 6.0;
            let product: f64 = terms.sum();
            assert!((product - expected).abs() < 1e-4, "{i} {j}: {product}");
        }
    }
    Ok(())
}

#[test]
fn rankings_of_two_are_paired_comparisons() -> Computed<()> {
    let mut random = Random::new(11);
    let pairs: Vec<Vec<usize>> = (0..300)
        .map(|n| drawn(&SIX, &[n % 6, (n + 1 + n / 60) % 6], &mut random))
        .collect();
    let ranked = PlackettLuce::fit(6, &pairs, Prior::None)?;
    let compared = BradleyTerry::fit(&Preferences::of_rankings(6, &pairs)?, Prior::None)?;
    assert_close(&ranked.scale.values, &compared.scale.values, 1e-12);
    let se = |scale: &Scale| scale.centred().iter().map(|e| e.se).collect::<Vec<f64>>();
    assert_close(&se(&ranked.scale), &se(&compared.scale), 1e-12);
    assert!((ranked.log_likelihood - compared.log_likelihood).abs() < 1e-10);
    let fall = 2.0 * (ranked.log_likelihood - ranked.null_log_likelihood);
    let deviance = compared.deviance;
    assert!((fall - (deviance.null - deviance.residual)).abs() < 1e-9);
    let test = compared.deviance.against_equal()?;
    assert_eq!(test.df, Freedom::One(5.0));
    assert!((test.p - ranked.against_chance()?.p).abs() < 1e-12);
    Ok(())
}

#[test]
fn other_numbers_for_the_items_change_nothing_else() -> Computed<()> {
    let mut random = Random::new(8);
    let rankings = fours(&SIX, 100, &mut random);
    let mut to: Vec<usize> = (0..6).collect();
    random.shuffle(&mut to);
    let renamed: Vec<Vec<usize>> = rankings
        .iter()
        .map(|r| r.iter().map(|&i| to[i]).collect())
        .collect();
    let (one, other) = (
        PlackettLuce::fit(6, &rankings, Prior::None)?,
        PlackettLuce::fit(6, &renamed, Prior::None)?,
    );
    let pairs = |r: &[Vec<usize>]| Preferences::of_rankings(6, r);
    let (probit, probit_renamed) = (
        Thurstone::fit(&pairs(&rankings)?)?,
        Thurstone::fit(&pairs(&renamed)?)?,
    );
    let (rows, rows_renamed) = (
        Mosteller::of(&pairs(&rankings)?)?,
        Mosteller::of(&pairs(&renamed)?)?,
    );
    for (i, &j) in to.iter().enumerate() {
        let (a, b) = (one.scale.centred()[i], other.scale.centred()[j]);
        assert_close(&[a.value, a.se], &[b.value, b.se], 1e-11);
        let (a, b) = (probit.scale.centred()[i], probit_renamed.scale.centred()[j]);
        assert_close(&[a.value, a.se], &[b.value, b.se], 1e-11);
        assert_close(&[rows.values[i]], &[rows_renamed.values[j]], 1e-12);
    }
    Ok(())
}

#[test]
fn known_worths_lie_in_their_intervals_as_often_as_those_say() -> Computed<()> {
    let mut random = Random::new(21);
    let (mut n_held, mut n_all) = (0, 0);
    for _ in 0..100 {
        let found = PlackettLuce::fit(6, &fours(&SIX, 80, &mut random), Prior::None)?;
        for (estimate, truth) in found.scale.centred().iter().zip(SIX) {
            n_all += 1;
            n_held += i32::from(estimate.interval(0.95)?.holds(truth));
        }
    }
    let coverage = f64::from(n_held) / f64::from(n_all);
    assert!((0.92..0.98).contains(&coverage), "{coverage}");
    Ok(())
}

#[test]
fn answers_that_fit_one_scale_are_rejected_as_often_as_they_should() -> Computed<()> {
    let mut random = Random::new(31);
    let (mut logit, mut probit, mut arcsine) = (0, 0, 0);
    let n = 300;
    for _ in 0..n {
        let mut pairs = Preferences::new(5);
        for (i, j) in (0..5).flat_map(|i| (i + 1..5).map(move |j| (i, j))) {
            for _ in 0..60 {
                let lead = 0.3 * (j - i) as f64;
                let (upper, lower) = if random.normal() < lead {
                    (i, j)
                } else {
                    (j, i)
                };
                pairs.prefer(upper, lower);
            }
        }
        let is_rejected = |p: f64| i32::from(p < 0.05);
        let deviance = BradleyTerry::fit(&pairs, Prior::None)?.deviance;
        logit += is_rejected(deviance.goodness_of_fit()?.p);
        probit += is_rejected(Thurstone::fit(&pairs)?.deviance.goodness_of_fit()?.p);
        arcsine += is_rejected(Mosteller::of(&pairs)?.fit?.p);
    }
    // Standard error of a share of 0.05: 0.013. Logits fit these probits nearly as well, and row
    // means are not the closest fit, so that theirs is a little larger.
    for count in [logit, probit, arcsine] {
        let share = f64::from(count) / f64::from(n);
        assert!((0.015..0.1).contains(&share), "{logit} {probit} {arcsine}");
    }
    Ok(())
}

#[test]
fn sixteen_items_in_640_rankings_are_quick_and_settle_in_few_steps() -> Computed<()> {
    let truth: Vec<f64> = (0..16).map(|i| 0.2 * f64::from(i) - 1.5).collect();
    let rankings = fours(&truth, 640, &mut Random::new(2));
    let start = selvedge_foundation::progress::thread_cpu_seconds();
    let found = PlackettLuce::fit(16, &rankings, Prior::None)?;
    let ms = 1000.0 * (selvedge_foundation::progress::thread_cpu_seconds() - start);
    println!(
        "16 items, 640 rankings: {ms:.1} ms of CPU, {} steps",
        found.n_steps
    );
    assert!(found.n_steps < 15, "{}", found.n_steps);
    for (estimate, truth) in found.scale.centred().iter().zip(truth) {
        assert!(
            (estimate.value - truth).abs() < 4.0 * estimate.se,
            "{estimate:?}"
        );
    }
    Ok(())
}
