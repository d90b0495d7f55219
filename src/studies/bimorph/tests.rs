//! The exact hold is exact, the others are not, and limits are where theory has them.

use super::*;
use crate::tests::quick;
use selvedge_device::Skin;

#[test]
fn the_exact_hold_keeps_its_promise_everywhere_and_no_other_method_does() {
    let findings = quick(&STUDY, 1);
    let broken: Vec<&Row> = findings.broken().collect();
    assert!(broken.is_empty(), "{broken:#?}");
    let sample = |method: StepMethod| {
        let is_it = |row: &&Row| {
            row.method == method.name()
                && step_of(row).is_some_and(|step_s| (step_s - SAMPLE_S).abs() < 1e-12)
        };
        findings
            .rows
            .iter()
            .filter(is_it)
            .map(|row| row.error)
            .collect::<Vec<_>>()
    };
    assert!(
        sample(StepMethod::RungeKutta4).iter().all(Option::is_none),
        "it grows"
    );
    for method in [StepMethod::Trapezoid, StepMethod::BackwardEuler] {
        let errors = sample(method);
        let least = errors
            .iter()
            .map(|error| error.unwrap())
            .fold(1.0, f64::min);
        assert!(least > 1e-6, "{}: {least:e}", method.name());
    }
    assert_eq!(findings.plots.len(), 4);
    assert!(findings.rows.iter().any(|row| row.method == "emulator"));
}

#[test]
fn smaller_steps_of_runge_kutta_come_near_the_closed_form() {
    let case = Case {
        name: String::new(),
        model: ContactorModel::default(),
    };
    let error = |per_hold| {
        let step = Step {
            hold_s: SAMPLE_S,
            per_hold,
        };
        error_of(&case, StepMethod::RungeKutta4, &step).unwrap()
    };
    assert!(
        error(16) < 1e-4 && error(32) < error(16) / 8.0,
        "{:e}",
        error(16)
    );
}

#[test]
fn runge_kutta_is_stable_up_to_about_2_8_over_the_fastest_eigenvalue() {
    let model = ContactorModel {
        skin: Skin::FREE,
        ..ContactorModel::default()
    };
    // Beam and pin against each other: √(k / both masses) = 1.9e5 rad/s.
    let both_kg = 1.0 / (1.0 / model.bimorph.mass_kg() + 1e6 / model.pin_mg);
    let fastest = (model.stem_n_per_m / both_kg).sqrt();
    let found = limits::limit_s(&model, StepMethod::RungeKutta4) * fastest;
    assert!((2.7..3.0).contains(&found), "{found}");
    for method in [
        StepMethod::Trapezoid,
        StepMethod::BackwardEuler,
        StepMethod::ExactHold,
    ] {
        assert!(limits::limit_s(&model, method) > 0.99, "{}", method.name());
    }
}
