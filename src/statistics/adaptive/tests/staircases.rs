//! Staircases against their Markov chains; constant stimuli; turns.

use super::stationary::stationary;
use super::*;
use crate::psychometric::Model;

fn endless(rule: Rule, steps: [f64; 2], n: u32) -> StaircasePlan {
    StaircasePlan {
        limits: [-20.0, 20.0],
        stop: Stop::Trials(n),
        ..StaircasePlan::steady(rule, 0.0, steps)
    }
}

#[test]
fn a_long_staircase_stays_where_its_chain_says() -> Computed<()> {
    let cases = [
        (1, 1, [1, 1]),
        (1, 2, [1, 1]),
        (1, 3, [2, 1]),
        (2, 1, [1, 1]),
        (1, 1, [3, 1]),
    ];
    for (n_up, m_down, steps) in cases {
        let rule = Rule { n_up, m_down };
        let p: Vec<f64> = (-20..=20).map(|x| observer().at(f64::from(x))).collect();
        let exact = stationary(rule, steps, &p)?;
        let plan = endless(
            rule,
            steps.map(|s| f64::from(u32::try_from(s).unwrap())),
            200_000,
        );
        let mut staircase = Staircase::new(plan)?;
        answers(&mut staircase, &observer(), &mut Random::new(4))?;
        let trials = staircase.trials();
        let n = trials.len() as f64;
        let mean = trials.iter().map(|t| t.asked).sum::<f64>() / n;
        let right = trials.iter().filter(|t| t.is_right).count() as f64 / n;
        let turned = staircase.reversals();
        let at_turns = turned.iter().map(|r| r.stimulus).sum::<f64>() / turned.len() as f64;
        assert!(
            (mean - (exact.mean_place - 20.0)).abs() < 0.04,
            "{rule:?}: {mean} {exact:?}"
        );
        assert!(
            (right - exact.share_right).abs() < 0.004,
            "{rule:?}: {right}"
        );
        let exact_turns = exact.mean_reversal_place - 20.0;
        assert!(
            (at_turns - exact_turns).abs() < 0.04,
            "{rule:?}: {at_turns} {exact_turns}"
        );
        let rate = turned.len() as f64 / n;
        assert!(
            (rate - exact.reversals_per_trial).abs() < 0.004,
            "{rule:?}: {rate}"
        );
        let at = |place: i32| {
            trials
                .iter()
                .filter(|t| t.asked == f64::from(place))
                .count() as f64
        };
        for place in [-3, 0, 2] {
            let share = exact.shares[usize::try_from(place + 20).unwrap()];
            assert!((at(place) / n - share).abs() < 0.006, "{rule:?} at {place}");
        }
    }
    Ok(())
}

#[test]
fn small_steps_approach_the_target_and_large_ones_are_right_a_little_less_often() -> Computed<()> {
    let curve = observer();
    for (m, target) in [(1, 0.5), (2, 0.5_f64.sqrt()), (3, 0.793_7), (4, 0.840_9)] {
        // Steps of 2 and of 0.2 of a width of 8.
        let long_run = |n: i32| -> Computed<f64> {
            let at = |x: i32| curve.at(f64::from(x) * 20.0 / f64::from(n));
            let p: Vec<f64> = (-n..=n).map(at).collect();
            Ok(stationary(Rule::one_up(m), [1, 1], &p)?.share_right)
        };
        let (large, small) = (long_run(10)?, long_run(100)?);
        assert!((small - target).abs() < 2e-3, "{m}: {small}");
        if m > 1 {
            assert!(
                large < small && small < target && target - large > 4e-3,
                "{m}: {large} {small}"
            );
        }
    }
    Ok(())
}

#[test]
fn one_up_one_down_is_the_birth_and_death_chain_by_hand() -> Computed<()> {
    // Three places, detailed balance π₀(1 − p₀) = π₁p₁, π₁(1 − p₁) = π₂p₂.
    let p = [0.2, 0.5, 0.9];
    let found = stationary(Rule::one_up(1), [1, 1], &p)?;
    let ratios = [1.0, 0.8 / 0.5, 0.8 / 0.5 * 0.5 / 0.9];
    let sum: f64 = ratios.iter().sum();
    for (share, ratio) in found.shares.iter().zip(ratios) {
        assert!((share - ratio / sum).abs() < 1e-12, "{found:?}");
    }
    assert!(stationary(Rule::one_up(1), [0, 1], &p).is_err(), "no step");
    assert!(
        stationary(Rule::one_up(1), [1, 1], &[0.5, 1.5]).is_err(),
        "no probability"
    );
    Ok(())
}

#[test]
fn steps_shrink_after_reversals_and_reversals_are_counted_stage_by_stage() -> Computed<()> {
    let stage = |size: f64, n_reversals| Stage {
        up: size,
        down: size,
        n_reversals,
    };
    let mut staircase = Staircase::new(StaircasePlan {
        stages: vec![stage(8.0, 2), stage(4.0, 1), stage(2.0, 0)],
        stop: Stop::Trials(11),
        ..StaircasePlan::steady(Rule::one_up(1), 20.0, [1.0, 1.0])
    })?;
    // 20 dB, down 12, 4, turn up 12, turn down: steps of 4 from here, 8, turn up: steps of 2.
    let right = [
        true, true, false, true, false, false, true, false, true, false, true,
    ];
    let expected_db = [
        20.0, 12.0, 4.0, 12.0, 8.0, 10.0, 12.0, 10.0, 12.0, 10.0, 12.0,
    ];
    for (is_right, db) in right.into_iter().zip(expected_db) {
        let stimulus = staircase.stimulus().unwrap();
        assert!((stimulus - db).abs() < 1e-9, "{staircase:?}");
        staircase.answer(stimulus, is_right)?;
    }
    let stages: Vec<usize> = staircase.reversals().iter().map(|r| r.stage).collect();
    assert_eq!(stages, [0, 0, 1, 2, 2, 2, 2, 2]);
    // The last four turned at 10, 12, 10, 12 dB; five are asked for.
    let mean = staircase.reversal_mean(5)?;
    assert_eq!(mean.n_reversals, 4);
    assert!((mean.threshold - 11.0).abs() < 1e-9, "{mean:?}");
    assert!((mean.target - 0.5).abs() < 1e-11, "{mean:?}");
    assert!(staircase.answer(1.0, true).is_err(), "over");
    assert!(staircase.reversal_mean(1).is_err(), "one reversal");
    Ok(())
}

#[test]
fn a_limit_holds_and_every_step_that_it_cuts_short_is_counted_and_said() -> Computed<()> {
    let mut staircase = Staircase::new(StaircasePlan {
        limits: [0.0, 3.0],
        stop: Stop::Trials(9),
        ..StaircasePlan::steady(Rule::one_up(1), 1.5, [1.0, 1.0])
    })?;
    for is_right in [false, false, false, false, true, true, true, true, true] {
        let stimulus = staircase.stimulus().unwrap();
        assert!((0.0..=3.0).contains(&stimulus), "{stimulus}");
        staircase.answer(stimulus, is_right)?;
    }
    assert_eq!(staircase.n_clamped(Limit::High), 3);
    assert_eq!(staircase.n_clamped(Limit::Low), 2);
    let warnings = staircase.warnings();
    assert!(
        warnings[1].contains("3 steps were cut short at the upper limit 3"),
        "{warnings:?}"
    );
    Ok(())
}

#[test]
fn plans_that_make_no_sense_are_refused() {
    let plan = || endless(Rule::one_up(2), [1.0, 1.0], 10);
    let refused = |plan: StaircasePlan| Staircase::new(plan).is_err();
    assert!(!refused(plan()), "this one is good");
    assert!(
        refused(StaircasePlan {
            stages: Vec::new(),
            ..plan()
        }),
        "no steps"
    );
    assert!(
        refused(StaircasePlan {
            start: 21.0,
            ..plan()
        }),
        "beyond its limits"
    );
    assert!(
        refused(StaircasePlan {
            stop: Stop::PosteriorSd(1.0),
            ..plan()
        }),
        "no posterior"
    );
    assert!(
        refused(StaircasePlan {
            limits: [1.0, 0.0],
            ..plan()
        }),
        "in disorder"
    );
}

#[test]
fn interleaved_staircases_take_turns_by_the_seed_alone_and_all_end() -> Computed<()> {
    let run = |seed: u64| -> Computed<(Vec<usize>, Vec<f64>)> {
        let both = [-8.0, 8.0].map(|start| {
            let plan = endless(Rule::one_up(2), [1.0, 1.0], 40);
            Staircase::new(StaircasePlan { start, ..plan })
        });
        let [low, high] = both;
        let mut both = Interleaved::new(vec![low?, high?], seed)?;
        let mut random = Random::new(1);
        let mut stimuli = Vec::new();
        while let Some((_, stimulus)) = both.stimulus() {
            stimuli.push(stimulus);
            both.answer(stimulus, random.uniform() < observer().at(stimulus))?;
        }
        assert!(
            both.procedures().iter().all(|s| s.trials().len() == 40),
            "all end"
        );
        assert!(both.answer(0.0, true).is_err(), "over");
        Ok((both.order().to_vec(), stimuli))
    };
    assert_eq!(run(3)?, run(3)?);
    let order = run(3)?.0;
    assert_ne!(order, run(4)?.0, "another seed");
    let n_changes = order.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!((20..60).contains(&n_changes), "{n_changes}");
    assert!(
        Interleaved::<Staircase>::new(Vec::new(), 1).is_err(),
        "none"
    );
    Ok(())
}

#[test]
fn a_fit_of_all_trials_comes_as_near_as_the_reversals() -> Computed<()> {
    let curve = Psychometric {
        guess: 0.25,
        ..observer()
    };
    let rule = Rule::one_up(3);
    let wanted = curve.stimulus_at(0.5_f64.cbrt())?;
    let (mut by_reversals, mut by_fit) = (0.0, 0.0);
    let mut random = Random::new(9);
    for _ in 0..60 {
        let mut staircase = Staircase::new(endless(rule, [1.0, 1.0], 120))?;
        answers(&mut staircase, &curve, &mut random)?;
        by_reversals += (staircase.reversal_mean(20)?.threshold - wanted).powi(2) / 60.0;
        let model = Model::alternatives(Family::Logistic, 4, [curve.width, 0.5]);
        let fit = model.fit(&staircase.blocks())?;
        by_fit += (fit.curve.stimulus_at(0.5_f64.cbrt())? - wanted).powi(2) / 60.0;
    }
    assert!(
        by_fit.sqrt() < 1.2 && by_fit < 1.3 * by_reversals,
        "{by_fit} {by_reversals}"
    );
    Ok(())
}

#[test]
fn constant_stimuli_come_each_as_often_in_every_round() -> Computed<()> {
    let stimuli = [1.0, 2.0, 4.0, 8.0];
    let mut constant = ConstantStimuli::new(&stimuli, 10, 3)?;
    let mut again = ConstantStimuli::new(&stimuli, 10, 3)?;
    while let Some(stimulus) = constant.stimulus() {
        assert_eq!(again.stimulus(), Some(stimulus), "the seed decides");
        constant.answer(stimulus, true)?;
        again.answer(stimulus, false)?;
    }
    for round in constant.trials().chunks(4) {
        let mut asked: Vec<f64> = round.iter().map(|t| t.asked).collect();
        asked.sort_by(f64::total_cmp);
        assert_eq!(asked, stimuli);
    }
    assert!(
        constant
            .blocks()
            .iter()
            .all(|b| b.n == 10 && b.n_right == 10),
        "collected"
    );
    assert!(
        ConstantStimuli::new(&[], 3, 1).is_err() && constant.answer(1.0, true).is_err(),
        ""
    );
    Ok(())
}
