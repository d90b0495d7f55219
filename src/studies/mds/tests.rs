//! The study runs, repeats and finds what is known.

use super::*;
use crate::tests::{assert_keeps_promises, quick};

#[test]
fn the_study_repeats_and_keeps_its_promises() {
    let (first, second) = (quick(&STUDY, 3), quick(&STUDY, 3));
    assert_keeps_promises(&first);
    for (a, b) in first.rows.iter().zip(&second.rows) {
        assert_eq!((a.error, &a.more), (b.error, &b.more), "{a:?}");
    }
    // Another program, other starts, the same lowest loss.
    let case = (2, Ties::Primary, Loss::Stress1);
    let ours = first
        .rows
        .iter()
        .filter(|row| row.method == "SMACOF + polish");
    let lowest = ours.filter_map(|row| row.further_number("stress1"));
    let off = lowest.fold(f64::INFINITY, f64::min) - outside(case).unwrap();
    assert!(off.abs() < 2e-6, "{off:e}");
    let error = |method: &str| {
        let row = first.rows.iter().find(|row| row.method == method);
        row.and_then(|row| row.error).unwrap()
    };
    assert!(error("Torgerson") > error("SMACOF"), "{:?}", first.rows);
}
