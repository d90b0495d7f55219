//! Groups of stimuli kept apart, and groups of subjects compared.

use super::*;
use selvedge_statistics::variance::holm;

fn text<'a>(table: &'a Table, row: usize, column: &str) -> &'a str {
    match table.cell(row, column) {
        Some(Cell::Text(text)) => text,
        other => panic!("{} {row} {column}: {other:?}", table.key),
    }
}

#[test]
fn fabrics_seen_and_unseen_have_two_way_tables_and_comparisons_of_their_own() {
    let design = Design::shipped("real-or-generated").unwrap();
    let is_real = |task: &Task| design.stimuli[task.items[0]].condition == "measured";
    // Of seen fabrics all is called real, of unseen ones what is.
    let found: Vec<Found> = (0..3)
        .map(|nth| {
            held(&design, (nth, 1), |task, number| {
                let is_seen = design.stimuli[task.items[0]].group == "seen";
                judged(task, is_seen || is_real(task) || number == 7 * nth, 3)
            })
        })
        .collect();
    let analysis = analysed(&found);
    for (group, n_materials) in [("", 8.0), ("-seen", 5.0), ("-unseen", 3.0)] {
        let key = format!("single-judgements-called-real{group}");
        let effects = table(&analysis, &key, "anova");
        assert_eq!(text(effects, 0, "effect"), "material", "{group}");
        assert_eq!(value(effects, 0, "df"), n_materials - 1.0, "{group}");
        assert_eq!(table(&analysis, &key, "differences").rows.len(), 1);
    }
    let seen = table(&analysis, "single-judgements-called-real-seen", "cells");
    assert!((0..seen.rows.len()).all(|row| value(seen, row, "mean") == 100.0));
    let apart = table(&analysis, "single-judgements-power", "equivalence");
    let whats: Vec<&str> = (1..4).map(|row| text(apart, row, "what")).collect();
    let difference = "measured less generated, %";
    let expected = ["", "seen: ", "unseen: "].map(|group| format!("{group}{difference}"));
    assert_eq!(whats, expected);
}

#[test]
fn settings_of_seen_and_unseen_fabrics_are_compared() {
    let design = Design::shipped("adjustment-two-gains").unwrap();
    let found: Vec<Found> = (0..3)
        .map(|nth| {
            held(&design, (nth, 1), |task, number| {
                let is_seen = design.stimuli[task.items[0]].group == "seen";
                let off = if is_seen { 2.0 + 0.1 * nth as f64 } else { 0.0 };
                let off = off + f64::from(u8::from(number == nth));
                let steps = Vec::new();
                let values = vec![off, 0.0];
                AnswerValue::Adjusted { values, steps }.into()
            })
        })
        .collect();
    let analysis = analysed(&found);
    let key = "adjustment-two-gains-gain-40-db";
    assert_eq!(value(table(&analysis, key, "anova-seen"), 0, "df"), 4.0);
    assert_eq!(value(table(&analysis, key, "anova-unseen"), 0, "df"), 2.0);
    let tests = table(&analysis, key, "tests");
    let row = tests.rows.len() - 1;
    assert_eq!(text(tests, row, "what"), "seen less unseen, gain_40_db");
    let difference = value(tests, row, "estimate_value");
    assert!((difference - 2.0).abs() < 0.2, "{difference}");
}

#[test]
fn three_groups_are_compared_together_and_in_pairs_by_holm_in_one_table() {
    let mut found = Vec::new();
    for (group, name) in ["odd-one-out", "odd-one-out-optical", "odd-one-out-pen"]
        .into_iter()
        .enumerate()
    {
        let design = Design::shipped(name).unwrap();
        // More are right in each group, and in each of its subjects.
        found.extend((0..4).map(|nth| {
            held(&design, (4 * group + nth, 1), |task, number| {
                odd(task, number % 7 < 1 + 2 * group + nth % 2, Grade::Easy)
            })
        }));
    }
    let analysis = analysed(&found);
    let tests = table(&analysis, "comparison", "tests");
    let names = [0, 1, 2].map(|row| text(tests, row, "test"));
    let together = [
        "one-way analysis of variance",
        "Welch analysis of variance",
        "Kruskal–Wallis",
    ];
    assert_eq!(names, together);
    assert_eq!(value(tests, 0, "n"), 12.0);
    let welch = Cell::from("Welch t, two samples");
    let is_welch = |row: &usize| tests.cell(*row, "test") == Some(&welch);
    let pairs: Vec<usize> = (0..tests.rows.len()).filter(is_welch).collect();
    let column = |name: &str| pairs.iter().map(|row| value(tests, *row, name)).collect();
    let (p, p_holm): (Vec<f64>, Vec<f64>) = (column("p"), column("p_holm"));
    assert_eq!(p.len(), 3);
    assert_eq!(p_holm, holm(&p));
    let why = tests.cell(0, "p_holm");
    assert!(matches!(why, Some(Cell::Undefined(_))), "{why:?}");
}
