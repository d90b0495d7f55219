//! Fits and populations against known functions, and answers that say nothing.

use super::*;
use crate::Computed;
use selvedge_foundation::numerics::Random;

fn truth(family: Family) -> Psychometric {
    Psychometric {
        family,
        threshold: 5.0,
        width: if family == Family::Weibull { 0.8 } else { 4.0 },
        guess: 0.5,
        lapse: 0.02,
    }
}

fn expected(curve: &Psychometric, n: u32) -> Vec<Block> {
    let block = |x: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "≤ n"
        )]
        let n_right = (f64::from(n) * curve.at(x)).round() as u32;
        Block { x, n, n_right }
    };
    (1..=9).map(|x| block(f64::from(x))).collect()
}

/// Answers to stimuli at these distances from 5.
fn drawn(curve: &Psychometric, offsets: &[f64], n: u32, random: &mut Random) -> Vec<Block> {
    let block = |offset: &f64| {
        let (x, p) = (5.0 + offset, curve.at(5.0 + offset));
        let n_right = (0..n).map(|_| u32::from(random.uniform() < p)).sum();
        Block { x, n, n_right }
    };
    offsets.iter().map(block).collect()
}

#[test]
fn expected_answers_give_the_function_back_in_every_family() -> Computed<()> {
    for family in Family::ALL {
        let truth = truth(family);
        let model = Model::alternatives(family, 2, [1.4 * truth.width, 0.5]);
        let fit = model.fit(&expected(&truth, 400))?;
        let found = fit.curve;
        assert!((found.threshold - 5.0).abs() < 0.1, "{family:?}: {found:?}");
        let of_width = found.width / truth.width;
        assert!((of_width - 1.0).abs() < 0.12, "{family:?}: {found:?}");
        assert!((found.lapse - 0.02).abs() < 0.01, "{family:?}: {found:?}");
        assert!(fit.own.holds(5.0) && fit.notes.is_empty(), "{fit:?}");
        assert_eq!(fit.pooled.1, fit.own, "alone");
    }
    Ok(())
}

#[test]
fn the_interval_is_that_of_direct_summation() -> Computed<()> {
    let truth = truth(Family::Logistic);
    let offsets = [-3.0, -1.0, 0.0, 1.0, 3.0];
    let blocks = drawn(&truth, &offsets, 12, &mut Random::new(3));
    let fit = Model::alternatives(Family::Logistic, 2, [4.0, 0.5]).fit(&blocks)?;
    let mut cells: Vec<[f64; 2]> = Vec::new();
    for i in 0..400 {
        let threshold = -2.0 + 14.0 * (f64::from(i) + 0.5) / 400.0;
        let mut mass = 0.0;
        for j in -40..=40 {
            for k in 0..24 {
                let (z, lapse) = (f64::from(j) / 20.0, 0.12 * (f64::from(k) + 0.5) / 24.0);
                let curve = Psychometric {
                    threshold,
                    width: 4.0 * (0.5 * z).exp(),
                    lapse,
                    ..truth
                };
                let likelihood: f64 = blocks
                    .iter()
                    .map(|b| {
                        let [p, q] = curve.at_place(b.x);
                        f64::from(b.n_right) * p.ln() + f64::from(b.n - b.n_right) * q.ln()
                    })
                    .sum();
                mass += (likelihood - 0.5 * z * z - lapse / 0.02).exp();
            }
        }
        cells.push([threshold, mass]);
    }
    let total: f64 = cells.iter().map(|[_, mass]| mass).sum();
    let quantile = |share: f64| {
        let mut below = 0.0;
        let found = cells.iter().find(|[_, mass]| {
            below += mass / total;
            below >= share
        });
        found.map_or(f64::NAN, |[threshold, _]| *threshold)
    };
    for (found, share) in [
        (fit.own.low, 0.025),
        (fit.curve.threshold, 0.5),
        (fit.own.high, 0.975),
    ] {
        let exact = quantile(share);
        assert!((found - exact).abs() < 0.15, "{share}: {found} {exact}");
    }
    Ok(())
}

/// Answers of subjects whose thresholds scatter by 2 about 5, to seven stimuli.
fn subjects(n: usize, random: &mut Random) -> (Vec<f64>, Vec<Vec<Block>>) {
    let offsets = [-9.0, -6.0, -3.0, 0.0, 3.0, 6.0, 9.0];
    let one = |_| {
        let threshold = 5.0 + 2.0 * random.normal();
        let curve = Psychometric {
            threshold,
            width: 10.0,
            ..truth(Family::Gumbel)
        };
        (threshold, drawn(&curve, &offsets, 8, random))
    };
    (0..n).map(one).unzip()
}

#[test]
fn a_population_finds_its_middle_and_spread_and_pools_its_subjects() -> Computed<()> {
    let (thresholds, answers) = subjects(40, &mut Random::new(7));
    let model = Model::alternatives(Family::Gumbel, 2, [12.0, 0.5]);
    let evidence = answers.iter().map(|blocks| model.evidence(blocks));
    let evidence = evidence.collect::<Computed<Vec<_>>>()?;
    let found = Population::of(&evidence, 1)?;
    assert!(found.threshold.interval.holds(5.0), "{:?}", found.threshold);
    assert!(found.spread.interval.holds(2.0), "{:?}", found.spread);
    assert!(found.width.interval.holds(10.0), "{:?}", found.width);
    assert!(
        (0.2..0.6).contains(&found.threshold.se),
        "{:?}",
        found.threshold
    );
    let rms = |of: &dyn Fn(&Fit) -> f64| {
        let both = found.subjects.iter().zip(&thresholds);
        (both
            .map(|(fit, true_one)| (of(fit) - true_one).powi(2))
            .sum::<f64>()
            / 40.0)
            .sqrt()
    };
    let [own, pooled] = [rms(&|fit| fit.curve.threshold), rms(&|fit| fit.pooled.0)];
    assert!(pooled < own && own < 2.5, "{own} {pooled}");
    let held = found
        .subjects
        .iter()
        .zip(&thresholds)
        .filter(|(fit, t)| fit.own.holds(**t));
    assert!(held.count() >= 36, "of 40");
    assert_eq!(found, Population::of(&evidence, 1)?, "the seed decides");
    assert!(Population::of(&evidence[..1], 1).is_err(), "one subject");
    assert!(
        Population::of(&evidence[..2], 1)?.threshold.se > found.threshold.se,
        "two"
    );
    Ok(())
}

#[test]
fn answers_of_another_shape_fit_worse_than_answers_of_the_function() -> Computed<()> {
    let model = Model::alternatives(Family::Logistic, 2, [4.0, 0.5]);
    let offsets = [-4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0];
    let mut random = Random::new(5);
    let blocks = drawn(&truth(Family::Logistic), &offsets, 40, &mut random);
    let p_of = |blocks: &[Block]| -> Computed {
        let evidence = model.evidence(blocks)?;
        let fit = model.fit(blocks)?;
        Ok(Goodness::of(&evidence, &fit, (199, 2)).p())
    };
    assert!(p_of(&blocks)? > 0.05, "{}", p_of(&blocks)?);
    let mut bent = blocks;
    (bent[1].n_right, bent[4].n_right) = (38, 22);
    assert!(p_of(&bent)? < 0.02, "{}", p_of(&bent)?);
    Ok(())
}

#[test]
fn answers_that_say_nothing_are_refused() {
    let model = Model::alternatives(Family::Logistic, 4, [2.0, 0.5]);
    let reason = |blocks: &[(f64, u32, u32)]| {
        let block = |&(x, n, n_right): &(f64, u32, u32)| Block { x, n, n_right };
        let blocks: Vec<Block> = blocks.iter().map(block).collect();
        model
            .fit(&blocks)
            .map(|fit| fit.notes)
            .map_err(|e| e.reason)
    };
    assert_eq!(reason(&[]), Err("no trials".to_owned()));
    assert!(
        reason(&[(1.0, 5, 3)]).is_err_and(|r| r.contains("one stimulus")),
        "one"
    );
    assert!(
        reason(&[(1.0, 5, 5), (2.0, 5, 5)]).is_err_and(|r| r.contains("all 10")),
        "right"
    );
    assert!(
        reason(&[(1.0, 5, 0), (2.0, 5, 0)]).is_err_and(|r| r.contains("none of 10")),
        "wrong"
    );
    assert!(reason(&[(1.0, 5, 6), (2.0, 5, 1)]).is_err(), "six of five");
    assert!(
        reason(&[(f64::NAN, 5, 1), (2.0, 5, 1)]).is_err(),
        "no stimulus"
    );
}

#[test]
fn thresholds_outside_the_stimuli_are_said_and_models_of_nothing_refused() -> Computed<()> {
    let model = Model::alternatives(Family::Logistic, 4, [2.0, 0.5]);
    let block = |(x, n, n_right): (f64, u32, u32)| Block { x, n, n_right };
    let beyond = [(1.0, 40, 10), (2.0, 40, 11), (3.0, 40, 13)].map(block);
    assert!(!model.fit(&beyond)?.notes.is_empty(), "not bracketed");
    let zero = [(0.0, 9, 2), (1.0, 9, 8)].map(block);
    let weibull = Model::alternatives(Family::Weibull, 4, [2.0, 0.5]);
    assert!(weibull.fit(&zero).is_err(), "ln 0");
    let bad = Model {
        usual_width: 0.0,
        ..model
    };
    assert!(bad.fit(&zero).is_err(), "no width");
    Ok(())
}

#[test]
fn trials_become_blocks_of_equal_stimuli() {
    let found = Block::of_trials([(2.0, true), (1.0, false), (2.0, false), (2.0, true)]);
    let expected = [
        Block {
            x: 1.0,
            n: 1,
            n_right: 0,
        },
        Block {
            x: 2.0,
            n: 3,
            n_right: 2,
        },
    ];
    assert_eq!(found, expected);
}
