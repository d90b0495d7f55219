//! Shapes at rest and frequencies that are known.

use super::*;
use crate::GRAVITY;

const RHO: f64 = 0.2;

/// A strip of `n` edges, 10 mm wide, hung at its upper end.
fn strip(n: usize, length_m: f64, fabric: Fabric) -> Cloth {
    let (grid, size) = ([2, n + 1], [0.01, length_m]);
    cloth(
        (grid, size),
        fabric,
        &Pins::Top,
        (Integrator::ImplicitEuler, 1e-3),
    )
}

#[test]
fn a_strip_grows_by_its_own_weight() {
    let (length, stiffness) = (0.2, 1000.0);
    let mut linear = strip(40, length, Fabric::plain(RHO, stiffness, 0.0, 0.0));
    assert!(linear.settle_to_rest().unwrap());
    let grown = -linear.x[0].y;
    let expected = RHO * GRAVITY * length * length / (2.0 * stiffness);
    assert!((grown / expected - 1.0).abs() < 1e-6, "{grown} {expected}");
}

#[test]
fn a_strip_of_an_exponential_yarn_grows_as_the_integral_says() {
    let mut fabric = Fabric::plain(RHO, 1.0, 0.0, 0.0);
    let (force, strain, linearity) = (2.0, 0.1, 0.6);
    fabric.tension = [Tension::new(force, strain, linearity); 2];
    let a = crate::fabric::exponent(linearity);
    let c = force / a.exp_m1();
    let s = RHO * GRAVITY * 0.2 / c;
    let expected = strain / a * (c / (RHO * GRAVITY)) * ((1.0 + s) * s.ln_1p() - s);
    let mut strip = strip(100, 0.2, fabric);
    assert!(strip.settle_to_rest().unwrap());
    let grown = -strip.x[0].y;
    assert!((grown / expected - 1.0).abs() < 1e-3, "{grown} {expected}");
}

#[test]
fn a_slack_strip_hangs_as_a_catenary() {
    let (length, span) = (0.2, 0.15);
    let fabric = Fabric::plain(RHO, 1e3, 0.0, 0.0);
    let grid = ([101, 2], [length, 0.01]);
    let mut strip = cloth(grid, fabric, &Pins::Ends, (Integrator::ImplicitEuler, 1e-3));
    // 2A sinh(D/2A) = L.
    let along = |a: f64| 2.0 * a * (span / (2.0 * a)).sinh();
    let a = selvedge_foundation::numerics::bisected([0.01, 10.0], 100, |a| along(a) > length);
    let sag = a * ((span / (2.0 * a)).cosh() - 1.0);
    for (vertex, x) in strip.x.iter_mut().enumerate() {
        let share = (vertex % 101) as f64 / 100.0;
        x.x = span * share;
        // Anything below the span will do to begin with.
        x.y -= 0.06 * (std::f64::consts::PI * share).sin();
    }
    for row in [0, 1] {
        strip.x[row * 101].y = 0.01 * row as f64;
        strip.x[row * 101 + 100].y = 0.01 * row as f64;
    }
    strip.restart();
    // A yarn that hardly stretches is come to by way of softer ones.
    for stiffness in [1e3, 1e4, 1e5, 1e6] {
        for stretch in &mut strip.system.sheet.stretch {
            stretch.tension = Tension::linear(stiffness);
        }
        assert!(strip.relax(), "{stiffness}");
    }
    let lowest = -strip.x[50].y;
    assert!((lowest / sag - 1.0).abs() < 1e-3, "{lowest} {sag}");
    let mut grad = strip.newton.grad.clone();
    strip.system.evaluate_cloth(&strip.x.clone(), &mut grad);
    let pull = (grad[0].x + grad[101].x).abs() / 0.01;
    let expected = RHO * GRAVITY * a;
    assert!((pull / expected - 1.0).abs() < 1e-3, "{pull} {expected}");
}

#[test]
fn a_cantilever_bends_as_the_elastica() {
    let spacing = 5e-3;
    // Two columns are held: the clamp is midway between them.
    let (n_free, length) = (40, 40.5_f64 * spacing);
    for (gamma, chord_deg) in [
        (1.0, 7.1),
        (5.0, 30.358),
        (8.004, 41.5),
        (20.0, 61.786),
        (50.0, 74.898),
    ] {
        let rigidity = RHO * GRAVITY * length.powi(3) / gamma;
        let fabric = Fabric::plain(RHO, 1e5, 0.0, rigidity);
        let size = [(n_free + 1) as f64 * spacing, spacing];
        let grid = ([n_free + 2, 2], size);
        let mut strip = cloth(
            grid,
            fabric,
            &Pins::Columns(2),
            (Integrator::ImplicitEuler, 1e-3),
        );
        // Gravity across the cloth.
        strip.gravity = Vector::new(0.0, 0.0, -GRAVITY);
        assert!(strip.settle_to_rest().unwrap(), "{gamma}");
        let tip = strip.x[n_free + 1];
        let angle = (-tip.z).atan2(tip.x - 0.5 * spacing).to_degrees();
        assert!(
            (angle / chord_deg - 1.0).abs() < 5e-3,
            "{gamma}: {angle} {chord_deg}"
        );
    }
}

/// Frequencies of small motion along some axes about where a cloth is, Hz, rising.
fn frequencies_hz(cloth: &mut Cloth, axes: &[usize]) -> Vec<f64> {
    cloth.system.lag.mu = 0.0;
    cloth.system.lag.sigma = 0.0;
    let at = cloth.x.clone();
    let mut scratch = at.clone();
    cloth.system.evaluate(&at, &mut scratch);
    let free = (0..at.len()).filter(|node| !cloth.system.is_held(*node));
    let places: Vec<(usize, usize)> = free
        .flat_map(|node| axes.iter().map(move |axis| (node, *axis)))
        .collect();
    let mut stiffness = nalgebra::DMatrix::zeros(places.len(), places.len());
    for (column, (node, axis)) in places.iter().enumerate() {
        let mut unit = vec![Vector::zeros(); at.len()];
        unit[*node][*axis] = 1.0;
        cloth.system.product(&unit, &mut scratch);
        for (row, (other, along)) in places.iter().enumerate() {
            let masses = cloth.system.mass_kg[*node] * cloth.system.mass_kg[*other];
            stiffness[(row, column)] = scratch[*other][*along] / masses.sqrt();
        }
    }
    let squares = stiffness.symmetric_eigenvalues();
    let mut hz: Vec<f64> = squares
        .iter()
        .map(|square| square.max(0.0).sqrt())
        .collect();
    hz.sort_by(f64::total_cmp);
    hz.iter()
        .map(|omega| omega / std::f64::consts::TAU)
        .collect()
}

#[test]
fn a_hanging_strip_swings_at_the_roots_of_bessels_function() {
    let length = 0.2_f64;
    let roots = [2.404_826, 5.520_078, 8.653_728];
    let off_percent = |n: usize| {
        let mut strip = strip(n, length, Fabric::plain(RHO, 1e5, 0.0, 0.0));
        assert!(strip.settle_to_rest().unwrap());
        let found = frequencies_hz(&mut strip, &[2]);
        // Both columns swing alike.
        [0, 1, 2].map(|nth| {
            let hz = roots[nth] * (GRAVITY / length).sqrt() / (4.0 * std::f64::consts::PI);
            100.0 * (found[2 * nth] / hz - 1.0)
        })
    };
    let (coarse, fine) = (off_percent(25), off_percent(50));
    for (nth, expected) in [-0.05, -0.6, -2.5].into_iter().enumerate() {
        assert!(
            (coarse[nth] - expected).abs() < 0.06,
            "{nth}: {}",
            coarse[nth]
        );
        assert!(
            (coarse[nth] / fine[nth] - 4.0).abs() < 0.4,
            "{coarse:?} {fine:?}"
        );
    }
}

#[test]
fn waves_of_a_taut_and_of_an_elastic_strip_have_their_speeds() {
    let (length, n, stiffness) = (0.2, 20, 1000.0);
    let grid = ([n + 1, 2], [length, 0.01]);
    let fabric = Fabric::plain(RHO, stiffness, 0.0, 0.0);
    let mut strip = cloth(grid, fabric, &Pins::Ends, (Integrator::Explicit, 1e-5));
    let h = length / n as f64;
    let strain = 0.01;
    strip.x.iter_mut().for_each(|x| x.x *= 1.0 + strain);
    let mode = |nth: usize| (nth as f64 * std::f64::consts::PI / (2.0 * n as f64)).sin();
    // In material coordinates: the spring's rate across is T/ℓ.
    let across = 2.0 / h * (stiffness * strain / (1.0 + strain) / RHO).sqrt();
    let along = 2.0 / h * (stiffness / RHO).sqrt();
    for (axis, omega) in [(2, across), (0, along)] {
        let found = frequencies_hz(&mut strip, &[axis]);
        for nth in 1..6 {
            let hz = omega * mode(nth) / std::f64::consts::TAU;
            let off = found[2 * nth - 2] / hz - 1.0;
            assert!(off.abs() < 1e-9, "{axis} {nth}: {off}");
        }
    }
}
