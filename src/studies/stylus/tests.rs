//! What the studies of the stylus promise, they keep; and methods differ as they should.

use super::*;
use crate::tests::{assert_keeps_promises, quick};

#[test]
fn exact_steps_keep_their_promise_and_others_grow_or_come_near() {
    let findings = quick(&STUDY, 1);
    assert_keeps_promises(&findings);
    let of = |method: Stepper, case: &str| {
        let is_it = |row: &&Row| {
            row.method == method.name() && row.case.contains(case) && row.setting == "1000 Hz"
        };
        findings.rows.iter().find(is_it).unwrap()
    };
    let stiff = of(Stepper::ExplicitEuler, "flat wall, 1e9");
    assert_eq!((stiff.error, stiff.further("standing")), (None, "unstable"));
    for case in [
        "flat wall, 1e3",
        "sine of 50 µm and 2 mm, 1e3",
        "random relief, 1e3",
    ] {
        let [exact, implicit] =
            [Stepper::Exact, Stepper::ImplicitEuler].map(|method| of(method, case));
        assert!(
            exact.error < implicit.error,
            "{case}: {exact:?} {implicit:?}"
        );
    }
    for row in &findings.rows {
        let gained = row.further_number("gained_of_put_in");
        if row.further("standing") == "stable" {
            assert!(gained.is_some_and(|gained| gained < 1e-7), "{row:?}");
        }
    }
    assert_eq!(findings.plots.len(), 3);
}

#[test]
fn limits_are_the_known_ones_and_faster_sampling_buzzes_less() {
    let findings = quick(&LIMITS, 1);
    assert_keeps_promises(&findings);
    let noise: Vec<f64> = findings
        .rows
        .iter()
        .filter(|row| row.method == "sampled")
        .map(|row| row.error.unwrap())
        .collect();
    assert!(noise.len() == 2 && noise[1] < 0.5 * noise[0], "{noise:?}");
    let ticks = findings.rows.iter().filter(|row| row.method == "tick");
    assert_eq!(ticks.filter(|row| row.cost.is_some()).count(), 2);
}
