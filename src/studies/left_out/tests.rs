//! The study of what is left out: complete and exact.

use super::*;
use crate::tests::quick;

#[test]
fn every_saving_is_tried_on_six_scenes_and_changes_nothing() {
    let findings = quick(&LeftOutStudy, 1);
    let cases = scenes::cases(Effort::Quick).unwrap();
    assert_eq!(cases.len(), 6);
    for case in &cases {
        let of_table: Vec<&Row> = findings
            .rows
            .iter()
            .filter(|row| row.case == case.name && row.method == "table")
            .collect();
        // All, none, and ten alone.
        assert_eq!(of_table.len(), 12, "{}", case.name);
    }
    for row in &findings.rows {
        assert_ne!(row.is_kept(), Some(false), "{row:?}");
        assert!(row.cost.is_some(), "{row:?}");
    }
    // Without the floor, banded really sums more.
    let of_banded = |row: &&Row| row.method == "banded" && row.case == "one textile";
    let mut banded = findings.rows.iter().filter(of_banded);
    assert!(
        banded.any(|row| row.error > Some(0.0)),
        "some bins are heard"
    );
    assert_eq!(findings.notes.len(), Rule::ALL.len() + 3);
    let engine = findings.rows.iter().filter(|row| row.method == "engine");
    let left_out: Vec<(&str, Option<&str>)> = engine
        .map(|row| (&row.setting[..], row.more.first().map(|(_, n)| &n[..])))
        .collect();
    let expected = [
        ("all", None),
        ("none", None),
        ("only unheard frames", Some("100")),
        ("only unasked glimpses", Some("100")),
    ];
    assert_eq!(left_out, expected, "as many as there were ticks");
}

#[test]
fn a_single_bit_is_a_difference() {
    assert_eq!(largest_difference(&[[1.0, 0.0]], &[[1.0, 0.0]]), 0.0);
    assert!(largest_difference(&[[1.0, 0.0]], &[[1.0, -0.0]]) > 0.0);
    let off = largest_difference(&[[1.0, 2.0]], &[[1.0, 2.5]]);
    assert_eq!(off, 0.5);
}
