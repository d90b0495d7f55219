//! The fast methods against the reference: table, banded and auto within what they promise.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use selvedge_textile::tactile::{Filters, MAX_SPEED_MM_PER_S};

/// The largest unfiltered amplitude √(2 Σ P) of both directions together, µm.
fn unfiltered_um(surface: &Surface) -> f64 {
    let most = |d: selvedge_textile::surface::Direction| {
        let spectra = surface.spectra(d);
        let total = |point| spectra.powers_um2(point).iter().sum::<f64>();
        (0..spectra.n_points()).map(total).fold(0.0, f64::max)
    };
    let [a, b, c, d] = selvedge_textile::surface::Direction::ALL.map(most);
    (2.0 * (a.max(b) + c.max(d))).sqrt()
}

/// Asserts the promise of a renderer at a pose. The reference's own rounding is allowed for.
fn assert_within(found: &ArrayRenderer, expected: &ArrayRenderer, unfiltered_um: f64) {
    let bound = found.bound();
    let factor = 10.0_f64.powf(bound.level_db / 20.0);
    for (a, a_ref) in found.frames().iter().zip(expected.frames()) {
        for contactor in 0..a.n_contactors() {
            for (a, a_ref) in a
                .amplitude_um(contactor)
                .iter()
                .zip(a_ref.amplitude_um(contactor))
            {
                let slack = bound.floor * unfiltered_um + 1e-12 * a_ref;
                let (least, most) = (a_ref / factor - slack, a_ref * factor + slack);
                assert!(*a >= least && *a <= most, "{a} for {a_ref}: {bound:?}");
            }
        }
    }
}

fn compare(scene: &RenderScene, methods: &[Method], accuracy: &Accuracy, poses: &[Pose]) {
    let mut reference = renderer(scene, Method::Reference);
    let unfiltered = unfiltered_um(&scene.textiles[0].surface);
    for &method in methods {
        let mut found = ArrayRenderer::prepare(scene, method, accuracy).unwrap();
        if method == Method::Auto || method == Method::Table {
            assert!(
                found.bound().level_db <= accuracy.budget_db,
                "{:?}",
                found.bound()
            );
        }
        for pose in poses {
            found.tick(std::slice::from_ref(pose));
            reference.tick(std::slice::from_ref(pose));
            assert_within(&found, &reference, unfiltered);
        }
    }
}

const FAST: [Method; 3] = [Method::Table, Method::Banded, Method::Auto];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn fast_methods_keep_their_promise_on_any_cloth_at_any_speed(
        kind in 0..5_u8,
        seed in any::<u64>(),
        octaves in prop_oneof![Just(2.0), 1.0..4.0_f64],
        logs in proptest::collection::vec((-2.0..3.64_f64, 0.0..TAU, 0.0..90.0_f64), 60),
        angular_rad_per_s in prop_oneof![Just(0.0), -3.0..3.0_f64],
    ) {
        let mut scene = alone(&cloth::of_kind(kind, seed));
        scene.displays[0].offsets.push(Displacement::new(1.3, -2.1));
        scene.filters = Filters::LogGaussian { octaves };
        let poses: Vec<Pose> = logs.iter().map(|&(log_speed, heading, place)| {
            let speed = 10.0_f64.powf(log_speed);
            let velocity = [speed * heading.cos(), speed * heading.sin()];
            Pose { angular_rad_per_s, ..pose([5.0 + place, 95.0 - place], velocity) }
        }).collect();
        compare(&scene, &FAST, &Accuracy::default(), &poses);
    }
}

#[test]
fn the_table_holds_on_both_sides_of_every_segments_end() {
    let ends = (1..=500_u16).map(|k| 1000.0 / (0.23 * f64::from(k)));
    let around = ends.flat_map(|v| [v.next_down(), v, v.next_up(), 0.999 * v, 1.001 * v]);
    let felt = around.filter(|v| *v < MAX_SPEED_MM_PER_S);
    let extremes = [
        0.01,
        0.01_f64.next_up(),
        0.013,
        MAX_SPEED_MM_PER_S.next_down(),
    ];
    let poses: Vec<Pose> = felt
        .chain(extremes)
        .map(|v| pose([7.0, 7.0], [v, 0.0]))
        .collect();
    for kind in [1, 3, 4] {
        compare(
            &alone(&cloth::of_kind(kind, 77)),
            &[Method::Table],
            &Accuracy::default(),
            &poses,
        );
    }
}

#[test]
fn usual_cloths_stay_far_below_the_budget() {
    // The promise holds for any spectrum; a weave, a sine and Brownian motion do much better.
    for kind in 0..3 {
        let scene = alone(&cloth::of_kind(kind, 5));
        let mut reference = renderer(&scene, Method::Reference);
        let mut table = renderer(&scene, Method::Table);
        for step in 0..600 {
            let at = pose([3.0, 3.0], [1.0127_f64.powi(step), 0.0]);
            let (a, b) = (
                amplitudes(&mut table, &at)[0],
                amplitudes(&mut reference, &at)[0],
            );
            for (a, b) in a.iter().zip(b) {
                let error_db = (20.0 * (a / b).log10()).abs();
                assert!(
                    error_db < 0.01 || b < 1e-4,
                    "kind {kind}, {at:?}: {error_db} dB of {b} µm"
                );
            }
        }
    }
}

#[test]
fn other_filters_keep_their_promise_too() {
    let poses: Vec<Pose> = (0..500)
        .map(|step| {
            pose(
                [7.0, 7.0],
                [0.0101 * 1.026_f64.powi(step), 30.0 / f64::from(step + 1)],
            )
        })
        .collect();
    let narrow = Filters::LogGaussian { octaves: 0.5 };
    for filters in [Filters::Receptor, narrow] {
        for kind in [0, 3, 4] {
            let mut scene = alone(&cloth::of_kind(kind, 21));
            scene.filters = filters;
            compare(
                &scene,
                &[Method::Banded, Method::Auto],
                &Accuracy::default(),
                &poses,
            );
        }
    }
}

#[test]
fn banded_keeps_its_bound_at_coarse_floors() {
    let poses: Vec<Pose> = (0..300)
        .map(|step| pose([4.0, 9.0], [0.3 * 1.03_f64.powi(step), 11.0]))
        .collect();
    for banded_floor in [0.0, 1e-4, 0.01, 0.3] {
        let accuracy = Accuracy {
            banded_floor,
            ..Accuracy::default()
        };
        for kind in 0..5 {
            let scene = alone(&cloth::of_kind(kind, 9));
            let mut banded = ArrayRenderer::prepare(&scene, Method::Banded, &accuracy).unwrap();
            let mut reference = renderer(&scene, Method::Reference);
            let unfiltered = unfiltered_um(&scene.textiles[0].surface);
            for pose in &poses {
                let found = amplitudes(&mut banded, pose)[0];
                let expected = amplitudes(&mut reference, pose)[0];
                for (a, a_ref) in found.iter().zip(expected) {
                    let lost = a_ref - a;
                    assert!(lost >= -1e-12 * a_ref, "{a} is no part of {a_ref}");
                    assert!(
                        lost <= banded_floor * unfiltered + 1e-12 * a_ref,
                        "{a} of {a_ref}"
                    );
                }
            }
            assert_eq!(banded_floor > 0.0, banded.counters().bins_below_floor > 0);
        }
    }
}

#[test]
fn auto_takes_the_cheapest_method_that_fits_the_budget() {
    let scene = scene_of(
        vec![placed(&cloth::of_kind(1, 1), [0.0, 0.0], 0.0)],
        exeter(),
    );
    let chosen = |scene: &RenderScene, budget_db| {
        let accuracy = Accuracy::within_db(budget_db);
        let auto = ArrayRenderer::prepare(scene, Method::Auto, &accuracy).unwrap();
        assert!(auto.bound().level_db <= budget_db, "{:?}", auto.bound());
        auto.method()
    };
    assert_eq!(chosen(&scene, 0.05), Method::Table);
    assert_eq!(chosen(&scene, 1e-5), Method::Banded);
    assert_eq!(chosen(&scene, 0.0), Method::Reference);
    let narrow = RenderScene {
        filters: Filters::LogGaussian { octaves: 0.01 },
        ..scene
    };
    assert_eq!(chosen(&narrow, 0.05), Method::Banded);
}
