//! Closed forms of decays, oscillators and nilpotent matrices.

use std::f64::consts::PI;

use super::*;

/// A damped oscillator of unit frequency: `x'' = −x − 2ζ x' + u`.
fn oscillator(damping: f64) -> LinearSystem<2, 1> {
    LinearSystem {
        a: [[0.0, 1.0], [-1.0, -2.0 * damping]],
        b: [[0.0], [1.0]],
    }
}

/// Where it is after `t` from `[1, 0]` with the input 0.
fn swung(damping: f64, t: f64) -> [f64; 2] {
    let omega = (1.0 - damping * damping).sqrt();
    let (sin, cos) = (omega * t).sin_cos();
    let decay = (-damping * t).exp();
    [decay * (cos + damping / omega * sin), -decay / omega * sin]
}

fn assert_near(found: &[f64], wanted: &[f64], tolerance: f64) {
    for (found, wanted) in found.iter().zip(wanted) {
        assert!((found - wanted).abs() <= tolerance, "{found}, not {wanted}");
    }
}

#[test]
fn the_exponential_of_a_rotation_turns() {
    for angle in [0.0, 1e-8, 1.0, PI, 100.0] {
        let found = exponential(&[[0.0, -angle], [angle, 0.0]]).unwrap();
        let (sin, cos) = f64::sin_cos(angle);
        assert_near(
            found.as_flattened(),
            &[cos, -sin, sin, cos],
            1e-13 * (1.0 + angle),
        );
    }
}

#[test]
fn the_exponential_of_a_nilpotent_matrix_is_its_finite_series() {
    let found = exponential(&[[0.0, 2.0, 0.0], [0.0, 0.0, 3.0], [0.0; 3]]).unwrap();
    let wanted = [1.0, 2.0, 3.0, 0.0, 1.0, 3.0, 0.0, 0.0, 1.0];
    assert_near(found.as_flattened(), &wanted, 1e-15);
}

#[test]
fn badly_scaled_states_cost_no_digits() {
    // The same rotation by 200 rad with states whose units differ by 10⁹.
    let found = exponential(&[[0.0, -200e9], [200e-9, 0.0]]).unwrap();
    let (sin, cos) = f64::sin_cos(200.0);
    let scaled = [
        found[0][0],
        found[0][1] * 1e-9,
        found[1][0] * 1e9,
        found[1][1],
    ];
    assert_near(&scaled, &[cos, -sin, sin, cos], 1e-11);
}

#[test]
fn what_is_not_finite_has_no_exponential() {
    assert!(exponential(&[[f64::NAN]]).is_none());
    assert!(exponential(&[[f64::INFINITY]]).is_none());
    assert!(exponential(&[[1e3]]).is_none(), "e^1000 overflows");
    assert!(exponential(&[[-1e3]]).is_some_and(|found| found[0][0] < 1e-300));
}

#[test]
fn the_exact_hold_follows_the_closed_form_at_any_step() {
    for step_s in [1e-3, 0.7, 20.0] {
        let step = oscillator(0.05)
            .propagator::<3>(StepMethod::ExactHold, step_s)
            .unwrap();
        assert_near(&step.step(&[1.0, 0.0], &[0.0]), &swung(0.05, step_s), 1e-13);
        // A held input of 1 has its rest at x = 1: what is left is the swing about it.
        let [x, v] = swung(0.05, step_s);
        assert_near(&step.step(&[0.0; 2], &[1.0]), &[1.0 - x, -v], 1e-13);
    }
}

#[test]
fn two_half_steps_are_one() {
    let system = oscillator(0.3);
    let half = system.propagator::<3>(StepMethod::ExactHold, 0.35).unwrap();
    let whole = system.propagator::<3>(StepMethod::ExactHold, 0.7).unwrap();
    for twice in [half.then(&half), half.repeated(2)] {
        assert_near(
            twice.state.as_flattened(),
            whole.state.as_flattened(),
            1e-15,
        );
        assert_near(
            twice.input.as_flattened(),
            whole.input.as_flattened(),
            1e-15,
        );
    }
}

#[test]
fn the_stages_of_runge_kutta_make_its_polynomial() {
    let system = oscillator(0.2);
    let step = system
        .propagator::<3>(StepMethod::RungeKutta4, 0.4)
        .unwrap();
    let staged = system.runge_kutta_4(&[0.3, -0.8], &[0.6], 0.4);
    assert_near(&step.step(&[0.3, -0.8], &[0.6]), &staged, 1e-15);
}

#[test]
fn halving_the_step_divides_errors_by_two_to_the_order() {
    let error = |method: StepMethod, n_steps: u32| {
        let step_s = 2.0 / f64::from(n_steps);
        let step = oscillator(0.1).propagator::<3>(method, step_s).unwrap();
        let found = step.repeated(n_steps).step(&[1.0, 0.0], &[0.0]);
        let wanted = swung(0.1, 2.0);
        (found[0] - wanted[0]).hypot(found[1] - wanted[1])
    };
    let orders = [
        (StepMethod::RungeKutta4, 4.0),
        (StepMethod::Trapezoid, 2.0),
        (StepMethod::BackwardEuler, 1.0),
    ];
    for (method, order) in orders {
        let found = (error(method, 64) / error(method, 128)).log2();
        assert!(
            (found - order).abs() < 0.1,
            "{}: order {found}",
            method.name()
        );
    }
}

#[test]
fn growth_tells_where_runge_kutta_turns_unstable() {
    // The region of stability ends on the imaginary axis at 2√2, on the real one at −2.785.
    let growth = |method, system: LinearSystem<2, 1>, step_s| {
        system.propagator::<3>(method, step_s).unwrap().growth()
    };
    let pure = oscillator(0.0);
    assert!(growth(StepMethod::RungeKutta4, pure, 2.82) < 1.0);
    assert!(growth(StepMethod::RungeKutta4, pure, 2.84) > 1.0);
    for step_s in [0.1, 10.0, 1e4] {
        let damped = oscillator(0.01);
        assert!(growth(StepMethod::Trapezoid, damped, step_s) <= 1.0 + 1e-12);
        assert!(growth(StepMethod::BackwardEuler, damped, step_s) < 1.0);
        let exact = growth(StepMethod::ExactHold, damped, step_s);
        assert!((exact - (-0.01 * step_s).exp()).abs() < 1e-9, "{exact}");
    }
}

#[test]
fn responses_are_those_of_the_transfer_function() {
    let system = oscillator(0.1);
    let omega = 1.7;
    let wanted = 1.0 / crate::numerics::Complex::new(1.0 - omega * omega, 0.2 * omega);
    let found = system.response(omega).unwrap()[0][0];
    assert!((found - wanted).norm() < 1e-14, "{found}");
    // A hold of short steps delays by half a step and changes little else.
    let step_s = 1e-3;
    let step = system
        .propagator::<3>(StepMethod::ExactHold, step_s)
        .unwrap();
    let held = step.response(omega * step_s).unwrap()[0][0];
    let delay = crate::numerics::Complex::from_polar(1.0, -0.5 * omega * step_s);
    assert!((held - wanted * delay).norm() < 1e-6, "{held}");
}
