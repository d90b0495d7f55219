//! The study of what is left out: complete and exact.

use super::*;
use crate::Effort;
use crate::tests::quick;

#[test]
fn every_saving_is_counted_on_six_scenes_and_changes_nothing() {
    let findings = quick(&STUDY, 1);
    let cases = scenes::cases(Effort::Quick).unwrap();
    assert_eq!(cases.len(), 6);
    for case in &cases {
        let of_table: Vec<&Row> = findings
            .rows
            .iter()
            .filter(|row| row.case == case.name && row.method == "table")
            .collect();
        // As it is, what is touched, and ten savings.
        assert_eq!(of_table.len(), 12, "{}", case.name);
    }
    for row in &findings.rows {
        assert_ne!(row.is_kept(), Some(false), "{row:?}");
        assert!(row.cost.is_some() || !row.more.is_empty(), "{row:?}");
    }
    for rule in Rule::ALL {
        let is_counted =
            |row: &Row| row.setting == format!("only {}", rule.name()) && row.more[0].1 != "0";
        let is_fast = rule == Rule::TooFast;
        assert!(is_fast || findings.rows.iter().any(is_counted), "{rule:?}");
    }
    assert_eq!(findings.notes.len(), Rule::ALL.len() + 4);
    let unread = findings
        .rows
        .iter()
        .find(|row| row.case == "a stroke over one of sixteen");
    assert_eq!(unread.unwrap().further("left_out_a_tick_of_all"), "15");
    let engine = findings.rows.iter().filter(|row| row.method == "engine");
    let left_out: Vec<(&str, Option<&str>)> = engine
        .map(|row| (&row.setting[..], row.more.first().map(|(_, n)| &n[..])))
        .collect();
    let expected = [
        ("all", None),
        ("none", None),
        ("only unheard frames", Some("100")),
        ("only unasked tick samples", Some("100")),
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
