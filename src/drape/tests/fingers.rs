//! Fingers: how hard they press, what friction holds, and that only slip is felt.

use super::*;
use crate::finger::Finger;

/// Vertices along a side, and the one in the middle.
const SIDE: usize = 15;
const MIDDLE: usize = SIDE / 2 * (SIDE + 1);

/// A cloth with these pins and fingers of these sides, centred above it, 10 mm away.
fn touched(fabric: Fabric, pins: &Pins, sides: &[f64], step_s: f64) -> Cloth {
    let (n, size_m) = ([SIDE, SIDE], [0.1, 0.1]);
    let mesh = Mesh::new(n, size_m, fabric.density_kg_per_m2, pins).unwrap();
    let n_vertices = mesh.n_vertices();
    let fingers = sides.iter().enumerate().map(|(nth, side)| {
        let start = Vector::new(0.05, 0.05, 0.01 * side);
        Finger::new(n_vertices + nth, (*side, 0.0), &fabric, start)
    });
    let sheet = Sheet::new(mesh, &fabric, LOSSLESS);
    let system = System::new(sheet, fingers.collect());
    let mut stepping = Stepping::new(Integrator::Bdf2, step_s);
    stepping.gain = 1e-2 * crate::cloth::LIVE;
    Cloth::new(system, stepping)
}

/// The same, held everywhere: a plate.
fn plate(sides: &[f64]) -> Cloth {
    let mut cloth = touched(
        Fabric::plain(0.2, 1e3, 50.0, 1e-5),
        &Pins::None,
        sides,
        1e-3,
    );
    cloth.system.sheet.mesh.is_pinned.fill(true);
    cloth
}

/// Leads all fingers to a place each, evenly, in so many steps.
fn lead(cloth: &mut Cloth, to: &[Vector], n_steps: u32) {
    let from: Vec<Vector> = cloth.fingers().iter().map(|finger| finger.target).collect();
    for step in 1..=n_steps {
        let share = f64::from(step) / f64::from(n_steps);
        let targets: Vec<Vector> = from
            .iter()
            .zip(to)
            .map(|(a, b)| a + (b - a) * share)
            .collect();
        cloth.step(&targets).unwrap();
    }
}

fn wait(cloth: &mut Cloth, n_steps: u32) {
    let targets: Vec<Vector> = cloth.fingers().iter().map(|finger| finger.target).collect();
    lead(cloth, &targets, n_steps);
}

fn apex(cloth: &Cloth, finger: usize) -> Vector {
    cloth.x[cloth.system.sheet.mesh.n_vertices() + finger]
}

#[test]
fn a_pad_presses_a_plate_as_a_paraboloid_of_springs() {
    for side in [1.0, -1.0] {
        for deep_mm in [1.0, 1.5, 1.9] {
            let mut cloth = plate(&[side]);
            lead(
                &mut cloth,
                &[Vector::new(0.05, 0.05, -1e-3 * deep_mm * side)],
                300,
            );
            wait(&mut cloth, 200);
            let half = 0.25e-3;
            let overlap = half - side * apex(&cloth, 0).z;
            assert!((0.5e-3..1.5e-3).contains(&overlap), "{overlap}");
            let springs = std::f64::consts::PI * 5e6 * (8e-3_f64 * 12e-3).sqrt();
            let expected = springs * overlap * overlap;
            let finger = &cloth.fingers()[0];
            assert!(
                (finger.press_n() / expected - 1.0).abs() < 0.05,
                "{deep_mm}: {expected}"
            );
            let felt = side * finger.force_n().z;
            assert!((felt / finger.press_n() - 1.0).abs() < 1e-3, "{felt}");
        }
    }
}

#[test]
fn a_dragged_finger_slips_at_the_force_that_friction_holds() {
    let mut cloth = plate(&[1.0]);
    lead(&mut cloth, &[Vector::new(0.05, 0.05, -2e-3)], 300);
    wait(&mut cloth, 200);
    // As far as the anchors and the coupling give way, it only leans.
    lead(&mut cloth, &[Vector::new(0.0501, 0.05, -2e-3)], 100);
    wait(&mut cloth, 200);
    let slipped = |cloth: &Cloth| {
        let points = cloth.fingers()[0].points.iter();
        points.map(|point| point.slipped_m[0]).fold(0.0, f64::max)
    };
    let contactor = 20;
    let before = cloth.fingers()[0].points[contactor].slipped_m[0];
    assert_eq!(before, 0.0, "what sticks is still");
    lead(&mut cloth, &[Vector::new(0.07, 0.05, -2e-3)], 1000);
    let finger = &cloth.fingers()[0];
    let (pull, press) = (-finger.force_n().x, finger.press_n());
    assert!(
        (pull / (0.4 * press) - 1.0).abs() < 0.01,
        "{pull} of {press}"
    );
    assert!(slipped(&cloth) > 0.015, "{}", slipped(&cloth));
}

#[test]
fn energy_that_a_step_left_is_that_of_where_it_ended() {
    for integrator in [Integrator::Bdf2, Integrator::Explicit] {
        let mut cloth = plate(&[1.0]);
        lead(&mut cloth, &[Vector::new(0.05, 0.05, -2e-3)], 300);
        cloth.stepping.integrator = integrator;
        cloth.stepping.step_s = 1e-5;
        lead(&mut cloth, &[Vector::new(0.052, 0.05, -2e-3)], 500);
        let left_j = cloth.energy_j();
        let (x, mut grad) = (cloth.x.clone(), cloth.x.clone());
        cloth.system.evaluate(&x, &mut grad);
        let here_j = cloth.energy_j();
        assert!(left_j > 1e-5, "{left_j}");
        assert!(
            (left_j / here_j - 1.0).abs() < 1e-3,
            "{integrator:?}: {left_j} {here_j}"
        );
    }
}

#[test]
fn a_pinch_holds_twice_what_one_side_holds() {
    for (share, holds) in [(0.98, true), (1.02, false)] {
        // As stiff as a board: what hangs below the pads does not wrinkle away from them.
        let fabric = Fabric::plain(2.0, 1e5, 1e4, 1e-2);
        let mut cloth = touched(fabric, &Pins::None, &[1.0, -1.0], 1e-3);
        cloth.gravity = Vector::zeros();
        let pinch = [1.0, -1.0].map(|side| Vector::new(0.05, 0.05, -1.2e-3 * side));
        lead(&mut cloth, &pinch, 300);
        wait(&mut cloth, 400);
        let press = cloth.fingers()[0].press_n();
        let mass: f64 = cloth.system.sheet.mesh.mass_kg.iter().sum();
        // Drawn in its plane, slowly enough that nothing swings.
        let most = share * 2.0 * 0.4 * press / mass;
        for step in 0..2000 {
            cloth.gravity.y = -most * (f64::from(step) / 1000.0).min(1.0);
            wait(&mut cloth, 1);
        }
        let low = cloth.x[0].y;
        assert_eq!(low > -3e-3, holds, "{share}: {low} m");
    }
}

#[test]
fn a_cloth_that_moves_with_its_fingers_is_silent() {
    let fabric = Fabric::plain(0.1, 1e3, 50.0, 1e-5);
    let mut cloth = touched(fabric, &Pins::None, &[1.0, -1.0], 1e-3);
    cloth.gravity = Vector::zeros();
    let pinch = [1.0, -1.0].map(|side| Vector::new(0.05, 0.05, -1.2e-3 * side));
    lead(&mut cloth, &pinch, 300);
    wait(&mut cloth, 300);
    let counted = |cloth: &Cloth| {
        let points = cloth.fingers().iter().flat_map(|finger| &finger.points);
        points.map(|point| point.slipped_m).collect::<Vec<_>>()
    };
    let before = counted(&cloth);
    let away = pinch.map(|at| at + Vector::new(0.02, -0.01, 0.015));
    lead(&mut cloth, &away, 2000);
    let moved = (cloth.x[0] - cloth.system.sheet.mesh.at_rest().next().unwrap()).norm();
    assert!(moved > 0.02, "{moved}");
    let felt = cloth
        .fingers()
        .iter()
        .flat_map(|finger| &finger.points)
        .map(crate::finger::Point::is_felt);
    for ((before, after), felt) in before.iter().zip(counted(&cloth)).zip(felt) {
        assert!(!felt || *before == after, "{before:?} {after:?}");
    }
}

#[test]
fn a_stretched_cloth_is_rubbed_more_slowly_in_its_own_millimetres() {
    for strain in [0.0, 0.05] {
        let mut cloth = plate(&[1.0]);
        let n_vertices = cloth.system.sheet.mesh.n_vertices();
        cloth.x[..n_vertices]
            .iter_mut()
            .for_each(|x| x.x *= 1.0 + strain);
        cloth.restart();
        lead(&mut cloth, &[Vector::new(0.04, 0.05, -1e-3)], 300);
        lead(&mut cloth, &[Vector::new(0.05, 0.05, -1e-3)], 250);
        let at = |cloth: &Cloth| cloth.fingers()[0].points[20].slipped_m[0];
        let start = at(&cloth);
        lead(&mut cloth, &[Vector::new(0.06, 0.05, -1e-3)], 250);
        let slipped = at(&cloth) - start;
        assert!(
            (slipped * (1.0 + strain) / 0.01 - 1.0).abs() < 1e-3,
            "{strain}: {slipped}"
        );
    }
}

#[test]
fn a_finger_does_not_pass_through_and_comes_back_on_either_side_past_an_edge() {
    let fabric = shirting();
    // Of 5 N what comes fast holds a part by friction on the slopes around it.
    for (speed, least_n) in [(0.1, 4.9), (1.0, 3.3)] {
        let mut cloth = touched(fabric, &Pins::Frame, &[1.0], 1e-3);
        cloth.gravity = Vector::zeros();
        let deep = Vector::new(0.05, 0.05, -0.04);
        let n: u32 = selvedge_foundation::numerics::to_whole(50.0 / speed);
        lead(&mut cloth, &[deep], n);
        wait(&mut cloth, 300);
        let (middle, pad) = (cloth.x[MIDDLE], apex(&cloth, 0));
        // Pulp under 5 N yields by √(F/πk_f√(R_xR_y)) = 5.7 mm.
        assert!(
            pad.z > middle.z - 6.5e-3,
            "{speed}: pad {pad}, cloth {middle}"
        );
        assert!(
            cloth.fingers()[0].press_n() > least_n,
            "{}",
            cloth.fingers()[0].press_n()
        );
        // Past the edge, behind, and on from there.
        for to in [
            Vector::new(0.05, 0.05, 0.03),
            Vector::new(0.2, 0.05, 0.03),
            Vector::new(0.2, 0.05, -0.03),
            Vector::new(0.05, 0.05, -0.03),
            Vector::new(0.05, 0.05, 0.005),
        ] {
            lead(&mut cloth, &[to], 400);
        }
        wait(&mut cloth, 300);
        let (middle, pad) = (cloth.x[MIDDLE], apex(&cloth, 0));
        assert!(
            middle.z > 3e-3 && pad.z < middle.z + 1e-3,
            "from behind: {pad} {middle}"
        );
    }
}

#[test]
fn a_step_after_each_new_contact_looks_back_at_nothing() {
    let mut cloth = plate(&[1.0, -1.0]);
    let places = |first: f64, second: f64| [first, second].map(|z| Vector::new(0.05, 0.05, z));
    let mut afresh = Vec::new();
    for (to, n_steps) in [(places(-1e-3, -0.01), 200), (places(-1e-3, 1e-3), 200)] {
        for _ in 0..n_steps {
            lead(&mut cloth, &to, 1);
            if cloth.n_past == 0 {
                let touching = cloth.fingers().iter().map(|finger| finger.press_n() > 0.0);
                afresh.push(touching.collect::<Vec<bool>>());
            }
        }
    }
    assert_eq!(afresh, [[true, false], [true, true]]);
}
