//! Settings, numbers and levels that follow a law.

use std::path::PathBuf;

use super::*;
use crate::design::{Adaptation, Source, Track};
use crate::trial::Adapted;
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_statistics::adaptive::{Procedure as _, Staircase};

/// Trials of a staircase whose observer is right from 5 dB on and wrong below.
fn staircase_session(design: &Design, nth: usize) -> Found {
    let levels = design.composition.adaptation.as_ref().unwrap();
    let Track::Staircase(track) = &levels.track else {
        panic!("no staircase");
    };
    let mut records = Vec::new();
    for series in 0..track.starts.len() {
        let mut staircase = levels_of(levels, series);
        for _ in 0..40 {
            let value = staircase.stimulus().unwrap();
            let is_right = value >= 5.0 - nth as f64;
            staircase.answer(value, is_right).unwrap();
            let track = series;
            let task = Task {
                right: Some(0),
                adapted: Some(Adapted { track, value }),
                ..Task::default()
            };
            let answer = Answer::chosen(usize::from(!is_right), None);
            let number = records.len();
            let trial = Trial {
                block: 0,
                number,
                is_practice: false,
                task,
            };
            records.push(record(trial, answer, Some(is_right)));
        }
    }
    let subject = Subject {
        pseudonym: format!("p{nth}"),
        nth,
        session: 1,
    };
    let log = PathBuf::from(format!("nowhere/{nth}.csv"));
    Found::of_records(log, (design, subject), records)
}

fn levels_of(levels: &Adaptation, series: usize) -> Staircase {
    let Track::Staircase(track) = &levels.track else {
        panic!("no staircase");
    };
    levels_series::run_again(levels, track, series, &[]).unwrap()
}

#[test]
fn matched_gains_on_a_line_are_a_compression() {
    let design = Design::shipped("gain-matching").unwrap();
    let library = selvedge_textile::Library::shipped().unwrap();
    let level = |id: &str| {
        let textile = library.load(id).unwrap();
        let filters = selvedge_textile::tactile::Filters::default();
        selvedge_textile::tactile::Levels::of(textile.surface(), &filters)
            .level_db()
            .unwrap()
    };
    let levels: Vec<f64> = design.stimuli.iter().map(|s| level(&s.id)).collect();
    // Alternately 1 dB off either way, subject by subject.
    let found: Vec<Found> = (0..4)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                let item = task.item().unwrap();
                let off = if nth % 2 == 0 { 1.0 } else { -1.0 };
                let values = vec![3.0 + off - 0.4 * levels[item]];
                let steps = Vec::new();
                AnswerValue::Adjusted { values, steps }.into()
            })
        })
        .collect();
    let analysis = analysed(&found);
    let kappa = table(&analysis, "gain-matching-compression", "kappa");
    for row in 0..5 {
        assert!((value(kappa, row, "kappa") - 0.4).abs() < 1e-9, "{kappa:?}");
    }
    assert!(
        (value(kappa, 4, "gain_at_0_db") - 3.0).abs() < 1e-9,
        "{kappa:?}"
    );
    let stimuli = table(&analysis, "gain-matching-gain-db", "stimuli");
    assert_eq!(value(stimuli, 0, "n"), 8.0);
    assert!(
        (value(stimuli, 0, "mean") - (3.0 - 0.4 * levels[0])).abs() < 1e-9,
        "{stimuli:?}"
    );
    assert!(
        (value(stimuli, 0, "sd") - (8.0_f64 / 7.0).sqrt()).abs() < 1e-9,
        "{stimuli:?}"
    );
}

#[test]
fn every_two_stimuli_are_named_by_what_they_were_set_to_in_whatever_order() {
    let design = Design::shipped("gain-matching").unwrap();
    let set_to = |item: usize, nth: usize| item as f64 * (2.0 + 0.1 * nth as f64);
    let found: Vec<Found> = (0..4)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                let (values, steps) = (vec![set_to(task.item().unwrap(), nth)], Vec::new());
                AnswerValue::Adjusted { values, steps }.into()
            })
        })
        .collect();
    let shuffled = found[0].records.windows(2).any(|two| {
        let [one, next] = [0, 1].map(|at| two[at].trial.task.item());
        one > next
    });
    assert!(shuffled, "its trials are not in the design's order");
    let analysis = analysed(&found);
    let pairs = table(&analysis, "gain-matching-gain-db", "pairs");
    let n = design.stimuli.len();
    let all: Vec<[usize; 2]> = (0..n)
        .flat_map(|i| (i + 1..n).map(move |j| [i, j]))
        .collect();
    assert_eq!(pairs.rows.len(), all.len());
    for (row, [first, second]) in all.into_iter().enumerate() {
        let names = [first, second].map(|at| Cell::from(&design.stimuli[at].id));
        assert_eq!(pairs.rows[row][..2], names);
        let expected = (first as f64 - second as f64) * 2.15;
        let difference = value(pairs, row, "difference");
        assert!((difference - expected).abs() < 1e-9, "{pairs:?}");
    }
}

#[test]
fn a_session_broken_off_after_one_trial_is_analysed() {
    for name in ["gain-matching", "rating"] {
        let design = Design::shipped(name).unwrap();
        let mut found = held(&design, (0, 1), |_, _| match name {
            "rating" => AnswerValue::Ratings(vec![30.0; 4]).into(),
            _ => AnswerValue::Adjusted {
                values: vec![1.0],
                steps: Vec::new(),
            }
            .into(),
        });
        found.records.retain(|record| !record.trial.is_practice);
        found.records.truncate(1);
        let analysis = analysed(&[found]);
        let mut tables = analysis.sections.iter().flat_map(|one| &one.tables);
        let pairs = tables.find(|one| one.key.starts_with("pairs")).unwrap();
        assert_eq!(
            pairs.rows[0][0],
            Cell::from("all"),
            "no pair of one: {pairs:?}"
        );
    }
}

#[test]
fn numbers_that_follow_a_power_law_give_its_exponent() {
    let design = Design::shipped("magnitude").unwrap();
    let found: Vec<Found> = (0..3)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                let item = task.item().unwrap();
                let Source::Vibration { level_db, .. } = design.stimuli[item].source else {
                    panic!("no vibration");
                };
                let value = (nth as f64 + 1.0) * factor_of_gain(level_db).powf(0.6);
                AnswerValue::Number(value).into()
            })
        })
        .collect();
    let analysis = analysed(&found);
    let exponents = table(&analysis, "magnitude-exponents", "exponents");
    assert_eq!(
        exponents.rows.len(),
        8,
        "three subjects and the group, two bands"
    );
    for row in 0..8 {
        assert!(
            (value(exponents, row, "exponent") - 0.6).abs() < 1e-9,
            "{exponents:?}"
        );
    }
}

#[test]
fn staircases_and_fits_find_the_level_from_which_answers_are_right() {
    let design = Design::shipped("threshold-40").unwrap();
    let found: Vec<Found> = (0..3).map(|nth| staircase_session(&design, nth)).collect();
    let analysis = analysed(&found);
    let fits = table(&analysis, "threshold-40-thresholds", "fits");
    let means = table(&analysis, "threshold-40-staircases", "reversals");
    for nth in 0..3 {
        let edge = 4.5 - nth as f64;
        assert!(
            (value(fits, nth, "threshold_db") - edge).abs() < 1.0,
            "{fits:?}"
        );
        assert!(
            (value(means, 2 * nth, "mean_db") - edge).abs() < 1.0,
            "{means:?}"
        );
    }
}
