//! QUEST+ against Bayes' rule written out.

use super::*;
use crate::psychometric::Guess;

fn small_grid() -> QuestGrid {
    QuestGrid {
        family: Family::Gumbel,
        guess: Guess::Share(0.5),
        stimuli: (-10..=10).map(f64::from).collect(),
        thresholds: (-8..=8).map(f64::from).collect(),
        widths: vec![3.0, 6.0, 12.0],
        lapses: vec![0.0, 0.02, 0.04],
    }
}

/// Bayes' rule written out, without logarithms.
fn by_hand(grid: &QuestGrid, trials: &[(f64, bool)]) -> (Vec<f64>, f64) {
    let mut masses = Vec::new();
    for threshold in &grid.thresholds {
        for width in &grid.widths {
            for lapse in &grid.lapses {
                let curve = Psychometric {
                    family: grid.family,
                    threshold: *threshold,
                    width: *width,
                    guess: 0.5,
                    lapse: *lapse,
                };
                let of = |(x, is_right): &(f64, bool)| {
                    let p = curve.at(*x);
                    if *is_right { p } else { 1.0 - p }
                };
                masses.push(trials.iter().map(of).product::<f64>());
            }
        }
    }
    let sum: f64 = masses.iter().sum();
    for mass in &mut masses {
        *mass /= sum;
    }
    let entropy = masses
        .iter()
        .map(|m| if *m > 0.0 { -m * m.ln() } else { 0.0 })
        .sum();
    (masses, entropy)
}

#[test]
fn the_posterior_of_quest_plus_is_bayes_rule_written_out() -> Computed<()> {
    let mut quest = QuestPlus::new(small_grid(), Stop::Trials(20))?;
    let before = quest.summary();
    let mut random = Random::new(6);
    let mut trials = Vec::new();
    for _ in 0..20 {
        let asked = quest.stimulus().unwrap();
        // Delivered a little beside what was asked for.
        let presented = asked + 0.37;
        let is_right = random.uniform() < 0.5 + 0.5 * observer().at(presented);
        quest.answer(presented, is_right)?;
        trials.push((presented, is_right));
        let (masses, entropy) = by_hand(quest.grid(), &trials);
        for (found, expected) in quest.masses().iter().zip(&masses) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
        assert!((quest.entropy() - entropy).abs() < 1e-11, "{entropy}");
    }
    assert!(
        quest.stimulus().is_none() && quest.answer(0.0, true).is_err(),
        "over"
    );
    assert!(
        quest.summary().threshold.sd < before.threshold.sd,
        "it learns"
    );
    assert_eq!(quest.trials()[3].presented, trials[3].0);
    Ok(())
}

#[test]
fn the_next_stimulus_is_the_one_that_leaves_least_entropy() -> Computed<()> {
    let mut quest = QuestPlus::new(small_grid(), Stop::Trials(9))?;
    let mut trials = Vec::new();
    for is_right in [true, false, true, true, false, true] {
        let expected = quest.expected_entropies();
        for (stimulus, found) in quest.grid().stimuli.iter().zip(&expected) {
            let after = |is_right: bool| {
                by_hand(
                    quest.grid(),
                    &[trials.as_slice(), &[(*stimulus, is_right)]].concat(),
                )
                .1
            };
            let (now, _) = by_hand(quest.grid(), &trials);
            let p: f64 = (0..now.len())
                .map(|i| now[i] * quest.grid().curve(i).at(*stimulus))
                .sum();
            let mean = p * after(true) + (1.0 - p) * after(false);
            assert!((mean - found).abs() < 1e-11, "{mean} {found}");
        }
        let least = expected.iter().copied().fold(f64::INFINITY, f64::min);
        let first = expected.iter().position(|e| *e < least + 1e-11).unwrap();
        let asked = quest.stimulus().unwrap();
        assert_eq!(asked, quest.grid().stimuli[first]);
        quest.answer(asked, is_right)?;
        trials.push((asked, is_right));
    }
    Ok(())
}

#[test]
fn ties_go_to_the_first_stimulus_and_impossible_answers_are_refused_unharmed() -> Computed<()> {
    let grid = QuestGrid {
        family: Family::Logistic,
        guess: Guess::Share(0.0),
        stimuli: vec![3.0, -3.0, 3.0],
        thresholds: vec![-1.0, 0.0, 1.0],
        widths: vec![1e-3],
        lapses: vec![0.0],
    };
    let mut quest = QuestPlus::new(grid.clone(), Stop::Trials(5))?;
    assert_eq!(
        quest.stimulus(),
        Some(3.0),
        "nothing tells anything: the first"
    );
    let before = quest.masses().to_vec();
    assert!(
        quest.answer(3.0, false).is_err(),
        "wrong far above any threshold, no lapses"
    );
    assert_eq!(
        (quest.masses(), quest.trials().len()),
        (before.as_slice(), 0)
    );
    let stop = || Stop::Trials(5);
    let refused = |grid: QuestGrid| QuestPlus::new(grid, stop()).is_err();
    assert!(
        refused(QuestGrid {
            widths: Vec::new(),
            ..grid.clone()
        }),
        "no widths"
    );
    assert!(
        refused(QuestGrid {
            widths: vec![0.0],
            ..grid.clone()
        }),
        "a width of 0"
    );
    assert!(
        refused(QuestGrid {
            family: Family::Weibull,
            ..grid.clone()
        }),
        "ln −1"
    );
    assert!(
        QuestPlus::new(grid, Stop::Reversals(3)).is_err(),
        "no reversals"
    );
    Ok(())
}

#[test]
fn a_posterior_narrow_enough_stops() -> Computed<()> {
    let stop = Stop::Any(vec![Stop::Trials(400), Stop::PosteriorSd(0.8)]);
    let mut quest = QuestPlus::new(small_grid(), stop)?;
    let curve = Psychometric {
        family: Family::Gumbel,
        guess: 0.5,
        ..observer()
    };
    answers(&mut quest, &curve, &mut Random::new(2))?;
    assert!(
        quest.summary().threshold.sd <= 0.8 && quest.trials().len() < 400,
        "{quest:?}"
    );
    assert!(
        quest.summary().threshold.mean.abs() < 2.5,
        "{:?}",
        quest.summary()
    );
    Ok(())
}

#[test]
fn a_choice_on_a_large_grid_is_quick_and_its_cost_is_printed() -> Computed<()> {
    let along = |n: u32, from: f64, to: f64| -> Vec<f64> {
        (0..n)
            .map(|i| from + (to - from) * f64::from(i) / f64::from(n - 1))
            .collect()
    };
    let grid = QuestGrid {
        family: Family::Gumbel,
        guess: Guess::Share(0.25),
        stimuli: along(100, -40.0, 0.0),
        thresholds: along(50, -38.0, -2.0),
        widths: along(50, 2.0, 20.0),
        lapses: along(6, 0.0, 0.05),
    };
    let start = std::time::Instant::now();
    let mut quest = QuestPlus::new(grid, Stop::Trials(10))?;
    let tables_s = start.elapsed().as_secs_f64();
    let before = quest.entropy();
    let start = std::time::Instant::now();
    let curve = Psychometric {
        threshold: -20.0,
        family: Family::Gumbel,
        ..observer()
    };
    answers(&mut quest, &curve, &mut Random::new(3))?;
    let trial_ms = 100.0 * start.elapsed().as_secs_f64();
    println!("100 × 50 × 50 × 6: tables {tables_s:.3} s, {trial_ms:.2} ms a trial");
    assert_eq!(quest.trials().len(), 10);
    assert!(quest.entropy() < before, "it learns");
    Ok(())
}
