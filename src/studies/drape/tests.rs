//! Studies of the hanging cloth keep their promises; better ways are better.

use super::integrators::PRECONDITIONERS;
use super::*;
use crate::Row;
use crate::tests::{assert_keeps_promises, quick};

#[test]
fn bdf2_comes_nearest_at_a_given_step_and_a_sleeping_cloth_costs_next_to_nothing() {
    let findings = quick(&STUDY, 1);
    assert_keeps_promises(&findings);
    let of = |method: &str, case: &str, setting: &str| {
        let is_it = |row: &&Row| {
            row.method == method && row.case.starts_with(case) && row.setting.starts_with(setting)
        };
        findings.rows.iter().find(is_it).unwrap()
    };
    let [bdf2, euler, locked] = ["bdf2", "ie", "pd"].map(|way| of(way, "swing", "4."));
    assert!(
        bdf2.error < euler.error && euler.error < locked.error,
        "{:#?}",
        findings.rows
    );
    assert!(of("bdf2", "swing", "1.00").error < bdf2.error);
    assert!(of("bdf2", "grasp", "1.00").error.unwrap() < 0.5);
    let [awake, asleep] =
        ["awake", "asleep"].map(|way| of(way, "rest", "bdf2").cost.unwrap().cpu_s);
    assert!(asleep < 0.05 * awake, "{asleep} {awake}");
    assert_eq!(of("asleep", "rest", "bdf2").further("steps_asleep"), "400");
    let of_k = |method: &str, k: &str| {
        let rows = findings.rows.iter().filter(|row| row.method == method);
        let mut rows = rows.filter(|row| row.setting == "4.17 ms" && row.case.contains(k));
        rows.next().unwrap().further_number("iterations").unwrap()
    };
    // Every row of the numbers that are asked for.
    let with = |column: &str| {
        let rows = findings.rows.iter();
        rows.filter(|row| row.further_number(column).is_some_and(|n| n > 0.0))
            .map(|row| row.method.as_str())
            .collect::<Vec<&str>>()
    };
    let parts = ["gradient", "product", "line", "making line", "XPBD substep"];
    assert_eq!(with("ns_a_vertex"), parts);
    assert_eq!(with("us_a_newton_step"), ["contact"]);
    assert_eq!(with("p99_ms"), ["bdf2"; 3]);
    assert!(
        of("contact", "a part", "two")
            .further_number("points")
            .unwrap()
            > 10.0
    );
    for k in ["K 1e1 N", "K 1e4 N"] {
        let [diagonal, line] = PRECONDITIONERS.map(|name| of_k(name, k));
        assert!(5.0 < line && line < diagonal, "{k}: {diagonal} {line}");
    }
}

#[test]
fn orders_are_those_of_their_methods() {
    let findings = quick(&ORDERS, 1);
    assert_keeps_promises(&findings);
    let promised = findings.rows.iter().filter(|row| row.promised.is_some());
    assert_eq!(promised.count(), 3, "two in time, one in space");
    assert_eq!(findings.rows.len(), 2 * 3 + 2);
}

#[test]
fn every_case_is_held_or_refused() {
    let findings = quick(&STABILITY, 1);
    assert_keeps_promises(&findings);
    let n_lossy = 8 * 3 * 3 * 3;
    let n_of_drift = 7 * 2;
    assert_eq!(
        findings.rows.len(),
        8 * 5 * 3 * 2 * 3 + n_lossy + n_of_drift
    );
    let lossy = |row: &&Row| row.case.contains("air and hysteresis");
    assert_eq!(findings.rows.iter().filter(lossy).count(), n_lossy + 7);
    let left = |method: &str, losses: &str| {
        let is_it = |row: &&Row| row.method == method && row.case.ends_with(losses);
        let row = findings.rows.iter().rev().find(is_it).unwrap();
        row.further_number("energy_since_start_percent").unwrap()
    };
    for method in ["explicit", "bdf2"] {
        let [bare, lossy] = ["bare", "hysteresis"].map(|losses| left(method, losses));
        assert!(lossy < bare && bare < 0.0, "{method}: {bare} {lossy}");
    }
    assert_eq!(findings.plots.len(), 5);
    let refused = findings
        .rows
        .iter()
        .filter(|row| row.further("standing") == "refused");
    let methods: Vec<&str> = refused.map(|row| row.method.as_str()).collect();
    assert!(
        methods.len() > 30 && methods.iter().all(|method| *method == "explicit"),
        "{methods:?}"
    );
    let held = findings
        .rows
        .iter()
        .filter_map(|row| row.further_number("targets_held"));
    assert!(held.sum::<f64>() > 0.0);
}
