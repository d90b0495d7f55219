//! The study runs, repeats, and keeps its promise.

use super::*;
use crate::tests::quick;

#[test]
fn one_profile_is_audibly_off_and_tables_of_all_points_are_not() {
    let findings = quick(&STUDY, 7);
    assert_eq!(
        findings.rows.len(),
        10,
        "three surfaces of three reliefs, and the reference"
    );
    assert_eq!((findings.plots.len(), findings.notes.len()), (1, 3));
    assert_eq!(findings.n_broken(), 0, "{:?}", findings.rows);
    for row in &findings.rows {
        let error = row.error.unwrap();
        let is_areal = row.method == "areal";
        assert!(is_areal == (error < 0.05), "{row:?}");
        assert!(
            row.setting == "by reference"
                || row.cost.is_some() && row.bytes.is_some_and(|bytes| bytes <= 300_000_000)
        );
    }
    let again = quick(&STUDY, 7);
    for (a, b) in findings.rows.iter().zip(&again.rows) {
        assert_eq!(
            (a.error, a.error_p99, a.bytes),
            (b.error, b.error_p99, b.bytes)
        );
    }
}

#[test]
fn levels_spread_by_their_standard_deviation() {
    let frame = vec![[1.0, 1.0], [10.0, 10.0]];
    assert!((spread_db(&[frame]) - 10.0).abs() < 1e-9, "0 and 20 dB");
    let errors = errors_db(&[vec![[2.0, 1e-9]]], &[vec![[1.0, 1e-9]]]);
    assert!((errors[0] - level_db(2.0)).abs() < 1e-12 && errors.len() == 2);
}
