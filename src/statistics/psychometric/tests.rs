//! Fits against known functions, brute force and simulation.

use super::*;
use crate::{Computed, Resampling};
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

/// Mean and standard deviation of a quantity over a posterior.
fn moments(posterior: &Posterior, quantity: impl Fn(&Psychometric) -> f64) -> [f64; 2] {
    let over = |of: &dyn Fn(f64) -> f64| -> f64 {
        let cells = posterior.cells.iter();
        cells.map(|(curve, mass)| mass * of(quantity(curve))).sum()
    };
    let mean = over(&|v| v);
    [mean, over(&|v| (v - mean).powi(2)).sqrt()]
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

fn drawn(curve: &Psychometric, n: u32, random: &mut Random) -> Vec<Block> {
    let block = |x: f64| {
        let p = curve.at(x);
        let n_right = (0..n).map(|_| u32::from(random.uniform() < p)).sum();
        Block { x, n, n_right }
    };
    (1..=9).map(f64::from).map(block).collect()
}

#[test]
fn expected_answers_give_the_function_back_in_every_family() -> Computed<()> {
    for family in Family::ALL {
        let truth = truth(family);
        let fit = Model::alternatives(family, 2).fit(&expected(&truth, 1_000_000))?;
        let found = fit.curve;
        assert!(
            (found.threshold - 5.0).abs() < 2e-3,
            "{family:?}: {found:?}"
        );
        assert!(
            (found.width / truth.width - 1.0).abs() < 2e-3,
            "{family:?}: {found:?}"
        );
        assert!((found.lapse - 0.02).abs() < 1e-3, "{family:?}: {found:?}");
        assert!(fit.notes.is_empty() && fit.deviance < 1.0, "{fit:?}");
    }
    Ok(())
}

#[test]
fn the_mode_is_no_lower_than_any_place_of_a_fine_grid_and_close_to_its_best() -> Computed<()> {
    let mut random = Random::new(8);
    for family in Family::ALL {
        let blocks = drawn(&truth(family), 12, &mut random);
        let fit = Model::alternatives(family, 2).fit(&blocks)?;
        let target = fit.target();
        let ([from, to], widths) = (fit.priors.threshold_support(), fit.priors.width_support());
        let mut best = (f64::NEG_INFINITY, [0.0; 3]);
        for i in 0..150 {
            for j in 0..150 {
                for k in 0..=12 {
                    let along = |[low, high]: [f64; 2], i: i32| {
                        low + (high - low) * (f64::from(i) + 0.5) / 150.0
                    };
                    let place = [
                        along([from, to], i),
                        along(widths.map(f64::ln), j),
                        f64::from(k) * 0.005,
                    ];
                    let value = target.ln_posterior(place);
                    if value > best.0 {
                        best = (value, place);
                    }
                }
            }
        }
        assert!(
            fit.ln_posterior >= best.0,
            "{family:?}: {} {best:?}",
            fit.ln_posterior
        );
        assert!(
            fit.ln_posterior - best.0 < 0.02,
            "{family:?}: {} {best:?}",
            fit.ln_posterior
        );
    }
    Ok(())
}

#[test]
fn three_ways_to_an_interval_agree_where_trials_are_many() -> Computed<()> {
    let truth = Psychometric {
        guess: 0.25,
        ..truth(Family::Logistic)
    };
    let blocks = drawn(&truth, 150, &mut Random::new(3));
    let fit = Model::alternatives(Family::Logistic, 4).fit(&blocks)?;
    let threshold = |curve: &Psychometric| Ok(curve.threshold);
    let (se, delta) = fit.delta(threshold, 0.95)?;
    let posterior = fit.posterior();
    let by_bayes = posterior.interval(threshold, 0.95)?;
    let how = Resampling {
        n_resamples: 500,
        seed: 4,
        level: 0.95,
    };
    let resamples = fit.resample(how)?;
    let (_, by_simulation) = resamples.interval(threshold)?;
    for other in [by_bayes, by_simulation] {
        assert!(
            (other.low - delta.low).abs() < 0.5 * se,
            "{other:?} {delta:?}"
        );
        assert!(
            (other.high - delta.high).abs() < 0.5 * se,
            "{other:?} {delta:?}"
        );
    }
    let [_, sd] = moments(&posterior, |curve| curve.threshold);
    assert!((sd / se - 1.0).abs() < 0.15, "{se}");
    assert!(delta.holds(5.0), "{delta:?}");
    assert!(
        (0.01..0.99).contains(&resamples.p_deviance()),
        "{}",
        resamples.p_deviance()
    );
    assert_eq!(resamples, fit.resample(how)?, "the seed decides");
    Ok(())
}

#[test]
fn the_posterior_is_that_of_a_finer_grid() -> Computed<()> {
    // Flat priors about the data: a posterior that direct summation over 400 × 400 cells gives.
    let blocks = [(2.0, 6, 1), (4.0, 6, 3), (6.0, 6, 4), (8.0, 6, 6)];
    let blocks = blocks.map(|(x, n, n_right)| Block { x, n, n_right });
    let model = Model {
        family: Family::Logistic,
        guess: Guess::Share(0.0),
        max_lapse: 0.0,
    };
    let fit = model.fit(&blocks)?;
    let (target, n) = (fit.target(), 400);
    let ([from, to], [narrow, wide]) = (fit.priors.threshold_support(), fit.priors.width_support());
    let (mut sum, mut sum_m, mut sum_w) = (0.0, 0.0, 0.0);
    for i in 0..n {
        for j in 0..n {
            let along = |low: f64, high: f64, i: i32| {
                low + (high - low) * (f64::from(i) + 0.5) / f64::from(n)
            };
            let (m, w) = (along(from, to, i), along(narrow, wide, j));
            let mass = target.ln_posterior([m, w.ln(), 0.0]).exp();
            sum += mass;
            sum_m += mass * m;
            sum_w += mass * w;
        }
    }
    let posterior = fit.posterior();
    let [m, _] = moments(&posterior, |curve| curve.threshold);
    let [w, _] = moments(&posterior, |curve| curve.width);
    assert!((m - sum_m / sum).abs() < 0.01, "{m} {}", sum_m / sum);
    assert!(
        (w / (sum_w / sum) - 1.0).abs() < 0.01,
        "{w} {}",
        sum_w / sum
    );
    Ok(())
}

#[test]
fn two_sided_answers_give_pse_jnd_and_weber_fraction() -> Computed<()> {
    let truth = Psychometric {
        guess: 0.01,
        lapse: 0.01,
        ..truth(Family::Normal)
    };
    let fit = Model::two_sided(Family::Normal).fit(&expected(&truth, 2000))?;
    let how = Resampling {
        n_resamples: 100,
        seed: 1,
        level: 0.95,
    };
    let found = fit.comparison(4.5, &fit.resample(how)?)?;
    assert!((found.pse.value - 5.0).abs() < 0.02, "{:?}", found.pse);
    assert!((found.constant_error - 0.5).abs() < 0.02, "{found:?}");
    let jnd = truth.jnd()?;
    assert!(
        (found.jnd.value / jnd - 1.0).abs() < 0.02,
        "{:?}",
        found.jnd
    );
    let weber = found.weber_fraction?.value;
    assert!((weber - found.jnd.value / 4.5).abs() < 1e-12, "{weber}");
    assert!(
        found.jnd.delta?.holds(jnd) && found.jnd.bootstrap?.holds(jnd),
        "held"
    );
    let of_nothing = fit.comparison(0.0, &fit.resample(how)?)?;
    assert!(of_nothing.weber_fraction.is_err(), "over zero");
    Ok(())
}

#[test]
fn answers_that_say_nothing_are_refused() {
    let model = Model::alternatives(Family::Logistic, 4);
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
    let model = Model::alternatives(Family::Logistic, 4);
    let block = |(x, n, n_right): (f64, u32, u32)| Block { x, n, n_right };
    let beyond = [(1.0, 40, 10), (2.0, 40, 11), (3.0, 40, 13)].map(block);
    assert!(!model.fit(&beyond)?.notes.is_empty(), "not bracketed");
    let zero = [
        Block {
            x: 0.0,
            n: 9,
            n_right: 2,
        },
        Block {
            x: 1.0,
            n: 9,
            n_right: 8,
        },
    ];
    assert!(
        Model::alternatives(Family::Weibull, 4).fit(&zero).is_err(),
        "ln 0"
    );
    let bad = Model {
        max_lapse: 0.7,
        ..model
    };
    assert!(bad.fit(&zero).is_err(), "a lapse rate of 0.7");
    let perfect = [
        Block {
            x: 0.0,
            n: 9,
            n_right: 0,
        },
        Block {
            x: 1.0,
            n: 9,
            n_right: 9,
        },
    ];
    let yes_no = Model {
        guess: Guess::Share(0.0),
        max_lapse: 0.0,
        ..model
    };
    assert!(
        (yes_no.fit(&perfect)?.curve.threshold - 0.5).abs() < 0.01,
        "a step"
    );
    Ok(())
}

#[test]
fn trials_become_blocks_of_equal_stimuli() {
    let found = blocks([(2.0, true), (1.0, false), (2.0, false), (2.0, true)]);
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
