//! Cases at the edge: finite, or refused with the limit; never above the energy that was given.

use super::*;
use crate::GRAVITY;
use crate::finger::Finger;

const STIFFNESSES: [f64; 4] = [1e1, 1e3, 1e5, 1e6];
const STEPS_S: [f64; 3] = [1e-4, 4e-3, 50e-3];

fn soft(density: f64, stiffness: f64) -> Fabric {
    Fabric::plain(density, stiffness, 30.0, 1e-5)
}

/// Steps for a while; says whether it was refused. Places stay numbers, energy below its bound.
fn holds(cloth: &mut Cloth, targets: &[Vector], what: &str) -> bool {
    let scale = cloth.system.sheet.scale_j();
    let start = cloth.energy_j();
    for _ in 0..25 {
        if let Err(error) = cloth.step(targets) {
            assert!(error.to_string().contains("at most"), "{what}: {error}");
            return false;
        }
        assert!(System::is_finite(&cloth.x), "{what}");
        let gained = cloth.energy_j() - start - cloth.work_j;
        assert!(
            gained < 0.01 * (scale + start.abs()),
            "{what}: gained {gained} of {scale} J"
        );
    }
    true
}

#[test]
fn swings_of_every_stiffness_weight_and_step_are_held_or_refused() {
    let mut n_refused = 0;
    for stiffness in STIFFNESSES {
        for density in [0.02, 1.0] {
            for step_s in STEPS_S {
                for integrator in [
                    Integrator::Explicit,
                    Integrator::ImplicitEuler,
                    Integrator::Bdf2,
                ] {
                    let what = format!("{integrator:?} K {stiffness} ρ {density} dt {step_s}");
                    let fabric = soft(density, stiffness);
                    let grid = ([8, 8], [0.2, 0.2]);
                    let mut cloth = cloth(grid, fabric, &Pins::Top, (integrator, step_s));
                    cloth.stepping.gain = crate::cloth::LIVE;
                    cloth.stepping.max_steps = 20;
                    // Lying flat, let go.
                    cloth
                        .x
                        .iter_mut()
                        .for_each(|x| *x = Vector::new(x.x, 0.2, 0.2 - x.y));
                    cloth.restart();
                    n_refused += u32::from(!holds(&mut cloth, &[], &what));
                }
            }
        }
    }
    assert!(
        (10..24).contains(&n_refused),
        "{n_refused} explicit ones of 24 are refused"
    );
}

#[test]
fn corners_pulled_to_three_times_their_distance_and_a_sudden_stiffness_are_held() {
    for stiffness in STIFFNESSES {
        for step_s in STEPS_S {
            let what = format!("K {stiffness} dt {step_s}");
            let fabric = soft(0.2, stiffness);
            let grid = ([8, 8], [0.2, 0.2]);
            let mut cloth = cloth(grid, fabric, &Pins::Corners, (Integrator::Bdf2, step_s));
            cloth.stepping.gain = crate::cloth::LIVE;
            cloth.pull(3.0);
            holds(&mut cloth, &[], &what);
            for stretch in &mut cloth.system.sheet.stretch {
                stretch.tension = Tension::linear(10.0 * stiffness);
            }
            cloth.restart();
            holds(&mut cloth, &[], &what);
        }
    }
}

#[test]
fn targets_that_are_no_numbers_are_held_and_counted_and_far_ones_are_followed_slowly() {
    for far in [f64::NAN, f64::INFINITY, 1e6, -1e6] {
        let fabric = shirting();
        let mesh = Mesh::new([10, 10], [0.1; 2], fabric.density_kg_per_m2, &Pins::Top).unwrap();
        let start = Vector::new(0.05, 0.05, 0.004);
        let finger = Finger::new(100, (1.0, 0.0), &fabric, start);
        let sheet = Sheet::new(mesh, &fabric, Losses::default());
        let step = Stepping::new(Integrator::Bdf2, 1e-3);
        let mut cloth = Cloth::new(System::new(sheet, vec![finger]), step);
        for _ in 0..50 {
            cloth.step(&[Vector::new(0.05, 0.05, far)]).unwrap();
        }
        assert!(System::is_finite(&cloth.x));
        let moved = (cloth.x[100] - start).norm();
        assert!(moved <= 0.0501, "{far}: {moved} m in 50 ms");
        let held = cloth.counters.targets_held;
        assert_eq!(held, if far.is_finite() { 0 } else { 50 }, "{far}");
    }
}

#[test]
fn pads_that_cross_and_the_smallest_cloth_are_held() {
    for stiffness in [1e1, 1e4, 1e6] {
        for n in [2, 9] {
            for step_s in [1e-3, 10e-3] {
                let fabric = soft(0.2, stiffness);
                let mesh = Mesh::new([n, n], [0.1; 2], 0.2, &Pins::Top).unwrap();
                let first = mesh.n_vertices();
                let fingers = [1.0, -1.0].into_iter().enumerate().map(|(nth, side)| {
                    let start = Vector::new(0.05, 0.05, 0.01 * side);
                    Finger::new(first + nth, (side, 0.0), &fabric, start)
                });
                let sheet = Sheet::new(mesh, &fabric, Losses::default());
                let step = Stepping::new(Integrator::Bdf2, step_s);
                let mut cloth = Cloth::new(System::new(sheet, fingers.collect()), step);
                let crossed = [1.0, -1.0].map(|side| Vector::new(0.05, 0.05, -0.02 * side));
                let what = format!("K {stiffness} n {n} dt {step_s}");
                for _ in 0..8 {
                    holds(&mut cloth, &crossed, &what);
                }
                let pads = [0, 1].map(|finger| cloth.x[first + finger].z);
                // Pulp of both yields, no more: without the cloth between they would be 20 mm past.
                assert!(pads[0] > pads[1] - 16e-3, "{what}: {pads:?}");
            }
        }
    }
}

#[test]
fn what_is_stretched_beyond_what_was_measured_is_counted() {
    let mut fabric = shirting();
    fabric.tension = [Tension::new(0.5 * 0.1 * GRAVITY * 0.2, 0.01, 0.7); 2];
    let mut cloth = cloth(
        ([4, 8], [0.1, 0.2]),
        fabric,
        &Pins::Top,
        (Integrator::Bdf2, 1e-3),
    );
    cloth.settle_to_rest().unwrap();
    (0..5).for_each(|_| cloth.step(&[]).unwrap());
    assert_eq!(cloth.counters.overstretched, 5);
}
