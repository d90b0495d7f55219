//! Rankings whose scores and matrices are known.

use std::collections::BTreeMap;
use std::path::Path;

use super::*;

/// The target first in so many trials, second in the others; others by how near they stand in the
/// design.
fn ranked(n_first: usize) -> impl FnMut(&Task, usize) -> Answer {
    move |task, number| {
        let (target, own) = (task.reference.unwrap(), task.right.unwrap());
        let mut order: Vec<usize> = (0..4).filter(|at| *at != own).collect();
        order.sort_by_key(|at| task.items[*at].abs_diff(target));
        order.insert(usize::from(number >= n_first), own);
        Answer::in_order(&order)
    }
}

fn rankings(design: &str, n_first: [usize; 8]) -> Vec<Found> {
    let design = Design::shipped(design).unwrap();
    let all = n_first.into_iter().enumerate();
    all.map(|(nth, n)| held(&design, (nth, 1), ranked(n)))
        .collect()
}

/// Eight subjects of 80 trials whose mean and standard error are the printed ones, 41.3 ± 1.6 %
/// and 64.1 ± 5.5 %.
fn both_experiments() -> Vec<Found> {
    let mut all = rankings("ranking-real-target", [28, 29, 31, 32, 34, 35, 37, 38]);
    all.extend(rankings(
        "ranking-virtual-target",
        [34, 38, 43, 48, 56, 60, 63, 68],
    ));
    all
}

#[test]
fn printed_scores_of_both_ranking_experiments_give_their_printed_tests() {
    let analysis = analysed(&both_experiments());
    let group = table(&analysis, "ranking-real-target-identification", "group");
    assert!((value(group, 0, "mean") - 41.25).abs() < 1e-9, "{group:?}");
    // Deviations 5, 4, 2, 1 either way of 80 trials: sd = √(92/7)/0.8.
    let se = (92.0_f64 / 7.0).sqrt() / 0.8 / 8.0_f64.sqrt();
    assert!((value(group, 0, "se") - se).abs() < 1e-9, "{group:?}");
    let tests = table(&analysis, "ranking-real-target-identification", "tests");
    assert!(
        (value(tests, 0, "value") - 16.25 / se).abs() < 1e-9,
        "{tests:?}"
    );
    assert!((value(tests, 0, "value") - 10.2).abs() < 0.1, "as printed");
    assert_eq!(value(tests, 0, "df"), 7.0);
    assert!(
        (value(tests, 0, "p") / 1.9e-5 - 1.0).abs() < 0.1,
        "as printed"
    );
    let tests = table(&analysis, "ranking-virtual-target-identification", "tests");
    assert!((value(tests, 0, "value") - 7.11).abs() < 0.1, "as printed");
    let both = table(&analysis, "comparison", "tests");
    assert!(
        (value(both, 0, "value").abs() - 3.98).abs() < 0.05,
        "{both:?}"
    );
    assert!((value(both, 0, "df") - 8.2).abs() < 0.1, "Welch: {both:?}");
    assert!(
        (value(both, 0, "p") - 0.0039).abs() < 0.0003,
        "Welch: {both:?}"
    );
    assert_eq!(value(both, 1, "df"), 14.0);
    assert!(
        (value(both, 1, "p") - 0.0014).abs() < 0.0002,
        "Student: {both:?}"
    );
}

#[test]
fn ranks_become_the_matrices_that_they_were_given_by() {
    let found = rankings("ranking-virtual-target", [80; 8]);
    let analysis = analysed(&found);
    let subjects = table(
        &analysis,
        "ranking-virtual-target-identification",
        "subjects",
    );
    assert_eq!(value(subjects, 0, "percent"), 100.0);
    assert_eq!(value(subjects, 0, "mean_rank"), 1.0);
    let means = table(&analysis, "ranking-virtual-target-confusions", "mean-ranks");
    let diagonal = (0..16).map(|i| means.rows[i][i + 1].number());
    assert!(diagonal.clone().all(|rank| rank == Some(1.0)), "{means:?}");
    let targets = table(&analysis, "ranking-virtual-target-confusions", "targets");
    assert_eq!(value(targets, 3, "trials"), 40.0);
    // No spread between subjects: no t, and a reason instead.
    let tests = table(&analysis, "ranking-virtual-target-identification", "tests");
    let t = tests.cell(0, "value");
    assert!(
        matches!(t, Some(Cell::Undefined(why)) if why.contains("spread")),
        "{t:?}"
    );
    let stress = table(&analysis, "ranking-virtual-target-map", "stress");
    assert_eq!(stress.rows.len(), 5);
    assert!(
        value(stress, 1, "sstress") <= value(stress, 0, "sstress") + 1e-9,
        "{stress:?}"
    );
    let turns = table(&analysis, "ranking-virtual-target-map", "turns");
    assert!(value(turns, 0, "p_sum") > 0.0, "{turns:?}");
}

#[test]
fn what_the_rules_leave_out_is_listed_and_not_counted() {
    let mut found = rankings("ranking-virtual-target", [60; 8]);
    let fast = &mut found[0].records[4 + 9];
    fast.timing.response_ns = fast.timing.start_ns + 1_999_000_000;
    found[1].records.truncate(4 + 79);
    found[1].has_torn_row = true;
    let analysis = analysed(&found);
    let out = table(&analysis, "ranking-virtual-target-sessions", "left-out");
    let described = |row: usize, column: &str| out.cell(row, column).cloned();
    assert_eq!(out.rows.len(), 2);
    assert_eq!(described(0, "trials"), Some(Cell::Text("10".to_owned())));
    assert_eq!(described(1, "trials"), Some(Cell::Text("1–79".to_owned())));
    let why = described(1, "why");
    assert_eq!(why, Some(Cell::Text("79 trials, fewer than 80".to_owned())));
    let sessions = table(&analysis, "ranking-virtual-target-sessions", "held");
    let state = sessions.cell(1, "state");
    assert!(
        matches!(state, Some(Cell::Text(t)) if t.contains("torn")),
        "{state:?}"
    );
    let subjects = table(
        &analysis,
        "ranking-virtual-target-identification",
        "subjects",
    );
    assert_eq!(subjects.rows.len(), 7);
    assert_eq!(value(subjects, 0, "trials"), 79.0);
}

#[test]
fn designs_of_one_name_and_two_texts_are_analysed_apart() {
    let mut found = rankings("ranking-virtual-target", [60; 8]);
    let text = Design::shipped_text("ranking-virtual-target").unwrap();
    let other = text.replace("least_trials = 80", "least_trials = 70");
    let other = Design::from_toml(&other, Path::new("other.toml")).unwrap();
    for one in &mut found[4..] {
        one.design = other.clone();
    }
    let analysis = analysed(&found);
    let keys: BTreeMap<&str, usize> = analysis
        .sections
        .iter()
        .map(|s| (s.key.as_str(), 1))
        .collect();
    assert_eq!(keys.len(), analysis.sections.len(), "no two share a key");
    for n in [1, 2] {
        let key = format!("ranking-virtual-target-design-{n}-identification");
        assert_eq!(table(&analysis, &key, "subjects").rows.len(), 4);
    }
}
