//! Triads and judgements whose counts are known.

use super::*;
use selvedge_foundation::numerics::Random;

#[test]
fn triads_that_are_always_easy_are_all_at_the_ceiling_and_give_no_map() {
    let design = Design::shipped("odd-one-out").unwrap();
    let found: Vec<Found> = (0..4)
        .flat_map(|nth| (1..=3).map(move |session| (nth, session)))
        .map(|who| held(&design, who, |task, _| odd(task, true, Grade::Easy)))
        .collect();
    let analysis = analysed(&found);
    let distances = table(&analysis, "odd-one-out-distances", "distances");
    assert_eq!(
        value(distances, 0, "polyamide-rib"),
        12.0,
        "four subjects, three sessions"
    );
    let map = analysis
        .sections
        .iter()
        .find(|s| s.key == "odd-one-out-map")
        .unwrap();
    assert!(
        map.notes.iter().any(|n| n.contains("No map")),
        "{:?}",
        map.notes
    );
}

#[test]
fn errors_and_weights_of_triads_are_those_by_hand() {
    let design = Design::shipped("odd-one-out").unwrap();
    // Whatever holds the first fabric is missed; the others are normal.
    let answer = |task: &Task, _: usize| odd(task, !task.items.contains(&0), Grade::Normal);
    let found: Vec<Found> = (0..4).map(|nth| held(&design, (nth, 1), answer)).collect();
    let analysis = analysed(&found);
    let subjects = table(&analysis, "odd-one-out-accuracy", "subjects");
    assert_eq!(
        value(subjects, 0, "right"),
        15.0,
        "21 pairs, 6 with the first"
    );
    let errors = table(&analysis, "odd-one-out-distances", "errors");
    assert_eq!(value(errors, 0, "percent"), 100.0);
    assert!(
        (value(errors, 1, "percent") - 100.0 / 6.0).abs() < 1e-9,
        "one pair of six"
    );
    let distances = table(&analysis, "odd-one-out-distances", "distances");
    let names: Vec<&str> = distances.columns.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        (value(distances, 0, names[2]), value(distances, 1, names[3])),
        (0.0, 2.0)
    );
    let grades = table(&analysis, "odd-one-out-grades", "grades");
    assert_eq!(value(grades, 1, "count"), 60.0, "right and normal");
    assert_eq!(value(grades, 4, "count"), 24.0, "wrong and normal");
}

#[test]
fn sensitivity_of_judgements_is_that_of_their_counts() {
    let design = Design::shipped("real-or-generated").unwrap();
    // Real ones are called real in the first block, generated ones never; the confidence varies.
    let found: Vec<Found> = (0..3)
        .map(|nth| {
            held(&design, (nth, 1), |task, number| {
                let is_real = task.right == Some(0);
                let confidence = if number % 2 == 0 { 1 } else { 3 };
                judged(task, is_real && number < 16, confidence)
            })
        })
        .collect();
    let analysis = analysed(&found);
    let subjects = table(&analysis, "single-judgements-sensitivity", "subjects");
    assert_eq!(
        (value(subjects, 0, "hits"), value(subjects, 0, "n_real")),
        (8.0, 16.0)
    );
    assert_eq!(value(subjects, 0, "false_alarms"), 0.0);
    let rates = [
        value(subjects, 0, "hit_rate"),
        value(subjects, 0, "false_alarm_rate"),
    ];
    assert_eq!(rates, [8.5 / 17.0, 0.5 / 17.0]);
    let d_prime = -selvedge_statistics::normal_quantile(0.5 / 17.0).unwrap();
    assert!(
        (value(subjects, 0, "d_prime") - d_prime).abs() < 1e-12,
        "{subjects:?}"
    );
    let anova = table(&analysis, "single-judgements-called-real", "anova");
    assert_eq!(anova.rows.len(), 3);
    let cells = table(&analysis, "single-judgements-called-real", "cells");
    let all = cells
        .rows
        .iter()
        .find(|r| r[0] == Cell::Text("all materials, measured, %".to_owned()));
    assert_eq!(all.and_then(|row| row[2].number()), Some(50.0));
}

#[test]
fn complementary_percentages_of_pairs_leave_no_effect_of_material() {
    let design = pair_design();
    let mut random = Random::new(3);
    let found: Vec<Found> = (0..5)
        .map(|nth| {
            held(&design, (nth, 1), |task, _| {
                judged(task, random.index(3) > 0, 1)
            })
        })
        .collect();
    let analysis = analysed(&found);
    let anova = table(&analysis, "single-judgements-called-real", "anova");
    assert!(
        matches!(anova.cell(0, "f"), Some(Cell::Undefined(_))),
        "{anova:?}"
    );
    assert!(value(anova, 1, "f") > 0.0, "{anova:?}");
    // With two conditions that add up to 100, t² against 50 is F.
    let tests = table(&analysis, "single-judgements-sensitivity", "tests");
    let (t, f) = (value(tests, 0, "value"), value(anova, 1, "f"));
    assert!((t * t / f - 1.0).abs() < 1e-9, "{t}² and {f}");
}

#[test]
fn missing_cells_of_an_analysis_of_variance_are_refused_with_their_list() {
    let design = Design::shipped("real-or-generated").unwrap();
    let mut found: Vec<Found> = (0..3)
        .map(|nth| held(&design, (nth, 1), |task, n| judged(task, n % 3 == 0, 1)))
        .collect();
    for one in &mut found {
        one.design.rules.least_trials = 0;
    }
    let jute = design
        .stimuli
        .iter()
        .position(|s| s.id == "jute-plain-measured");
    found[1].records.retain(|r| r.trial.task.item() != jute);
    let analysis = analysed(&found);
    let anova = table(&analysis, "single-judgements-called-real", "anova");
    let why = anova.cell(0, "remarks");
    let is_listed =
        |t: &str| t.contains("p02") && t.contains("jute-plain") && t.contains("measured");
    assert!(
        matches!(why, Some(Cell::Text(t)) if is_listed(t)),
        "{why:?}"
    );
}
