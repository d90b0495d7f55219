//! Motion: order, energy, momentum.

use super::*;

/// A small cloth pinned at its top that is let go at 46°.
fn swing(integrator: Integrator, step_s: f64) -> Cloth {
    let fabric = Fabric::plain(0.2, 100.0, 20.0, 1e-5);
    let grid = ([6, 6], [0.1, 0.1]);
    let mut cloth = cloth(grid, fabric, &Pins::Top, (integrator, step_s));
    cloth.tilt(46.0);
    cloth
}

fn run(cloth: &mut Cloth, seconds: f64) {
    let n: u32 = selvedge_foundation::numerics::to_whole((seconds / cloth.stepping.step_s).round());
    (0..n).for_each(|_| cloth.step(&[]).unwrap());
}

fn rms_m(a: &Cloth, b: &[Vector]) -> f64 {
    let squares: f64 = a.x.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum();
    (squares / a.x.len() as f64).sqrt()
}

#[test]
fn implicit_euler_is_of_first_order_and_bdf2_of_second() {
    let mut reference = swing(Integrator::Explicit, 1e-3);
    reference.stepping.step_s = 2e-6;
    run(&mut reference, 0.08);
    for (integrator, order) in [(Integrator::ImplicitEuler, 1.0), (Integrator::Bdf2, 2.0)] {
        let errors = [0.2e-3, 0.1e-3, 0.05e-3].map(|step_s| {
            let mut cloth = swing(integrator, step_s);
            cloth.stepping.gain = 1e-12;
            run(&mut cloth, 0.08);
            assert_eq!(cloth.counters.redone, 0);
            rms_m(&cloth, &reference.x)
        });
        let found = [0, 1].map(|nth: usize| (errors[nth] / errors[nth + 1]).log2());
        assert!(
            (found[1] - order).abs() < 0.25,
            "{integrator:?}: {errors:?} {found:?}"
        );
    }
}

#[test]
fn a_free_cloth_keeps_its_momentum_and_a_moved_one_feels_no_force() {
    let fabric = Fabric::plain(0.2, 100.0, 20.0, 1e-5);
    let grid = ([6, 5], [0.1, 0.08]);
    let mut cloth = cloth(grid, fabric, &Pins::None, (Integrator::Explicit, 1e-4));
    cloth.gravity = Vector::zeros();
    let turn = nalgebra::Rotation3::new(Vector::new(0.3, -1.2, 0.7));
    cloth
        .x
        .iter_mut()
        .for_each(|x| *x = turn * *x + Vector::new(1.0, 2.0, 3.0));
    cloth.restart();
    let force = cloth
        .newton
        .grad
        .iter()
        .map(Vector::norm)
        .fold(0.0, f64::max);
    assert!(force < 1e-12, "{force} N of a rigid motion");
    for (node, v) in cloth.v.iter_mut().enumerate() {
        let phase = node as f64;
        *v = Vector::new(phase.sin(), (2.0 * phase).cos(), (3.0 * phase).sin());
    }
    // With the sum of what is added up: momenta, and their moments.
    let momenta = |cloth: &Cloth| {
        let nodes = || {
            cloth
                .system
                .mass_kg
                .iter()
                .zip(cloth.x.iter().zip(&cloth.v))
        };
        let along = nodes().map(|(mass, (_, v))| v * *mass);
        let about = nodes().map(|(mass, (x, v))| x.cross(v) * *mass);
        let sizes = [
            along.clone().map(|part| part.norm()).sum::<f64>(),
            about.clone().map(|part| part.norm()).sum(),
        ];
        ([along.sum::<Vector>(), about.sum()], sizes)
    };
    let (before, _) = momenta(&cloth);
    run(&mut cloth, 0.2);
    let (after, sizes) = momenta(&cloth);
    for nth in 0..2 {
        let off = (before[nth] - after[nth]).norm() / sizes[nth];
        assert!(off < 1e-12, "{nth}: {off}");
    }
}

#[test]
fn explicit_energy_is_bounded_over_a_million_steps() {
    let fabric = Fabric::plain(0.2, 100.0, 20.0, 1e-5);
    let grid = ([3, 3], [0.03, 0.03]);
    let mut cloth = cloth(grid, fabric, &Pins::Top, (Integrator::Explicit, 1e-4));
    cloth.stepping.step_s = 0.5 * cloth.limit_s();
    cloth.tilt(46.0);
    let scale = cloth.system.sheet.scale_j();
    let start = cloth.energy_j();
    let (mut most, mut means) = (0.0_f64, [0.0; 10]);
    for step in 0..1_000_000 {
        cloth.step(&[]).unwrap();
        if step % 97 == 0 {
            let off = (cloth.energy_j() - start) / scale;
            most = most.max(off.abs());
            means[step / 100_000] += off * 97.0 / 100_000.0;
        }
    }
    assert!(most < 1e-3, "{most} of its weight times its length");
    let [low, high] = selvedge_foundation::numerics::extent(means);
    assert!(high - low < 5e-6, "it drifts: {means:?}");
}

#[test]
fn no_implicit_step_gains_energy() {
    for integrator in [Integrator::ImplicitEuler, Integrator::Bdf2] {
        for step_s in [0.5e-3, 2e-3, 10e-3] {
            let mut cloth = cloth(
                ([10, 10], [0.2; 2]),
                shirting(),
                &Pins::Corners,
                (integrator, step_s),
            );
            cloth.stepping.gain = crate::cloth::LIVE;
            cloth.tilt(80.0);
            let scale = cloth.system.sheet.scale_j();
            let start = cloth.energy_j();
            for _ in 0..200 {
                cloth.step(&[]).unwrap();
                let gained = (cloth.energy_j() - start) / scale;
                assert!(gained < 0.01, "{integrator:?} {step_s}: {gained}");
            }
        }
    }
}

#[test]
fn an_explicit_step_beyond_its_limit_is_refused_with_it() {
    let mut cloth = swing(Integrator::Explicit, 1.0);
    let limit_s = cloth.limit_s();
    let before = cloth.x.clone();
    let error = cloth.step(&[]).unwrap_err().to_string();
    assert!(
        error.contains(&format!("at most {:.3} ms", 1e3 * limit_s)),
        "{error}"
    );
    assert_eq!(cloth.x, before, "nothing moved");
    // The largest of a soft cloth is what the wave along its yarns says.
    let h = 0.02;
    let wave = h * (0.2_f64 / 120.0).sqrt();
    assert!((limit_s / wave - 1.0).abs() < 1e-9, "{limit_s} {wave}");
}

#[test]
fn a_cloth_that_rests_sleeps() {
    let mut cloth = cloth(
        ([6, 6], [0.1; 2]),
        shirting(),
        &Pins::Top,
        (Integrator::Bdf2, 2e-3),
    );
    cloth.settle_to_rest().unwrap();
    run(&mut cloth, 1.0);
    assert_eq!(cloth.counters.steps, 500);
    assert!(
        (245..=255).contains(&cloth.counters.asleep),
        "{:?}",
        cloth.counters
    );
}

#[test]
fn one_pass_of_positions_is_softer_as_told() {
    let (stiffness, length, step_s) = (5e3, 0.2, 1.0 / 2400.0);
    let grid = ([2, 26], [0.008, length]);
    let fabric = Fabric::plain(0.2, stiffness, 0.0, 0.0);
    let mut strip = cloth(grid, fabric, &Pins::Top, (Integrator::Xpbd, step_s));
    let softening = strip.system.sheet.softening(step_s);
    assert!(softening > 60.0, "{softening}");
    let (mut low, n) = (0.0, 4000);
    for step in 0..2 * n {
        strip.step(&[]).unwrap();
        if step >= n {
            low += strip.x[0].y / f64::from(n);
        }
    }
    let grown = 0.2 * crate::GRAVITY * length * length / (2.0 * stiffness);
    let found = -low / grown;
    assert!(
        (found / softening - 1.0).abs() < 0.11,
        "{found} {softening}"
    );
}

/// A cloth of 26² vertices that swings from 46° for a quarter of a second.
fn swung(stiffness: f64, (integrator, step_s): (Integrator, f64)) -> Cloth {
    let fabric = Fabric::plain(0.2, stiffness, 30.0, 1e-5);
    let grid = ([26, 26], [0.2; 2]);
    let mut cloth = cloth(grid, fabric, &Pins::Top, (integrator, step_s));
    cloth.tilt(46.0);
    run(&mut cloth, 0.25);
    cloth
}

#[test]
fn projective_dynamics_locks_what_turns_the_more_the_stiffer_it_is() {
    for (stiffness, locked_mm) in [(1e3, 30.0), (1e4, 101.0)] {
        // Within 0.02 mm of explicit steps at a twentieth of their limit.
        let reference = swung(stiffness, (Integrator::Bdf2, 0.5e-3));
        for (integrator, expected_mm) in [
            (Integrator::Projective, locked_mm),
            (Integrator::ImplicitEuler, 3.8),
            (Integrator::Bdf2, 0.37),
        ] {
            let other = swung(stiffness, (integrator, 1.0 / 240.0));
            let off_mm = 1e3 * rms_m(&other, &reference.x);
            assert!(
                (off_mm / expected_mm - 1.0).abs() < 0.12,
                "K {stiffness} {integrator:?}: {off_mm} mm"
            );
        }
    }
}

/// Two masses on a yarn each that swing along it, ω dt apart in phase from step to step: the
/// damping of the amplitude by phase, and how much slower they swing than they would.
fn oscillates(integrator: Integrator, omega_dt: f64) -> [f64; 2] {
    let (stiffness, density, h) = (1e3_f64, 0.2, 0.1);
    // ½ K of a yarn at the edge on ¼ ρh².
    let omega = (2.0 * stiffness / (density * h * h)).sqrt();
    let fabric = Fabric::plain(density, stiffness, 0.0, 0.0);
    let step = (integrator, omega_dt / omega);
    let mut cloth = cloth(([2, 2], [h; 2]), fabric, &Pins::Top, step);
    (cloth.gravity, cloth.stepping.gain) = (Vector::zeros(), 1e-14);
    (0..2).for_each(|node| cloth.x[node].y = -1e-4);
    cloth.restart();
    // Both formulas have v = iωx in a free oscillation, so that no ripple is in the amplitude.
    let phasor = |cloth: &Cloth| nalgebra::Complex::new(cloth.x[0].y, -cloth.v[0].y / omega);
    (0..20).for_each(|_| cloth.step(&[]).unwrap());
    let (n, mut before) = (400, phasor(&cloth));
    let (mut log, mut phase) = (0.0, 0.0);
    for _ in 0..n {
        cloth.step(&[]).unwrap();
        let turn = phasor(&cloth) / before;
        before = phasor(&cloth);
        log += turn.norm().ln();
        phase += turn.arg();
    }
    let all = f64::from(n) * omega_dt;
    [-log / all, phase / all - 1.0]
}

#[test]
fn what_steps_damp_and_slow_down_is_that_of_their_formulas() {
    for a in [0.05_f64, 0.1] {
        for (integrator, damped) in [
            (Integrator::ImplicitEuler, 0.5 * a),
            (Integrator::Bdf2, 0.25 * a.powi(3)),
        ] {
            let [damping, slower] = oscillates(integrator, a);
            let what = format!("{integrator:?} {a}: {damping} {slower}");
            assert!((damping / damped - 1.0).abs() < 0.03, "{what}");
            assert!((slower / (-a * a / 3.0) - 1.0).abs() < 0.03, "{what}");
        }
    }
}
