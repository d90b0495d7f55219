//! The study of savings: complete, balanced and least where it says so.

use super::*;
use crate::Effort;
use crate::tests::quick;

#[test]
fn every_rule_is_counted_on_every_scene_and_does_what_is_needed() {
    let findings = quick(&STUDY, 1);
    let cases = scenes::cases(Effort::Quick).unwrap();
    assert_eq!(findings.rows.len(), cases.len() * (12 + 10) + 1 + 2 + 4 + 2);
    for row in &findings.rows {
        assert_ne!(row.is_kept(), Some(false), "{row:?}");
        let n = |column: &str| row.further_number(column).unwrap();
        assert!(n("done") <= n("asked_for"), "{row:?}");
        let needed = row.further_number("needed");
        assert!(needed.is_none_or(|needed| needed <= n("done")), "{row:?}");
    }
    let unread = findings.rows.iter().find(|row| row.setting == "never felt");
    assert_eq!(unread.unwrap().further("left_out"), "15");
    let slept = findings.rows.iter().find(|row| row.setting == "asleep");
    assert!(
        slept.unwrap().further_number("left_out") > Some(0.0),
        "it sleeps after a while"
    );
    let named = findings.notes.last().unwrap();
    assert!(named.contains("any of these scenes: too fast."), "{named}");
}

#[test]
fn what_rules_leave_over_is_what_counters_say_was_evaluated() {
    for case in scenes::cases(Effort::Quick).unwrap() {
        let mut renderer = textiles::prepared(&case.scene, Method::Banded).unwrap();
        for pose in &case.poses {
            renderer.tick(std::slice::from_ref(pose));
        }
        let needed = Needed::default();
        let counters = renderer.counters();
        let done = |rule| work_of(rule, &case, (counters, &needed)).done;
        assert_eq!(
            done(Rule::SamePoint),
            counters.directions_evaluated,
            "{}",
            case.name
        );
        assert_eq!(
            done(Rule::BelowFloor),
            counters.bins_evaluated,
            "{}",
            case.name
        );
        let n_moved = done(Rule::Standing);
        let n_felt = counters.contactors_inside;
        assert!(
            n_moved < counters.ticks || done(Rule::Beneath) == n_felt,
            "{}",
            case.name
        );
    }
}
