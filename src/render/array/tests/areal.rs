//! Areal surfaces: the same rendering over a grid of points that varies both ways.

use std::f64::consts::LN_2;

use super::*;
use selvedge_foundation::numerics::Random;
use selvedge_textile::surface::{Direction, Probe};

const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

fn under_exeter(surface: &Arc<Surface>) -> RenderScene {
    scene_of(vec![placed(surface, [0.0, 0.0], 0.0)], exeter())
}

/// Amplitudes at a place and velocity, from the formula, with the points counted out anew.
fn naive(surface: &Surface, [u, w]: [f64; 2], velocity: [f64; 2]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for (axis, forward) in [(0, Direction::WarpForward), (1, Direction::WeftForward)] {
        let spectra = surface.spectra(forward);
        let [n_along, n_across] = spectra.shape();
        let (along, across) = if axis == 0 { (u, w) } else { (w, u) };
        let index = |place: f64, n: usize| {
            let nearest = (place + 0.5 + 1e-6).floor().rem_euclid(n as f64);
            (0..n).find(|&i| i as f64 == nearest).unwrap()
        };
        let point = index(across, n_across) * n_along + index(along, n_along);
        for (k, power) in (1..).zip(spectra.powers_um2(point)) {
            let f = velocity[axis].abs() * 0.23 * f64::from(k);
            if f < 1000.0 {
                for (sum, b) in sums.iter_mut().zip([40.0_f64, 320.0]) {
                    let gain = (-0.5 * ((f / b).ln() / LN_2).powi(2) * LN_2).exp();
                    *sum += power * gain * gain;
                }
            }
        }
    }
    sums.map(|sum| (2.0 * sum).sqrt())
}

#[test]
fn the_reference_is_the_formula_at_the_nearest_point_both_ways() {
    let surface = cloth::areal(4);
    let mut reference = renderer(&alone(&surface), Method::Reference);
    for (place, velocity) in [
        ([0.0, 0.0], [90.0, 40.0]),
        ([2.6, 1.4], [-30.0, 120.0]),
        ([17.2, 33.5], [250.0, -7.0]),
        ([99.9, 4.49], [4.0, 0.0]),
    ] {
        let expected = naive(&surface, place, velocity);
        let found = amplitudes(&mut reference, &pose(place, velocity))[0];
        for b in 0..2 {
            let close = (found[b] - expected[b]).abs() <= 1e-9 * expected[b].max(1e-3);
            assert!(close, "{found:?} for {expected:?} at {place:?}");
        }
    }
}

#[test]
fn what_does_not_vary_across_is_felt_as_the_economical_surface() {
    let map = cloth::map(5, 0.0);
    let [warp, _, weft, _] = map
        .strokes(&Probe::ideal(), [4.5, 4.0], &Random::new(1))
        .unwrap();
    let economical = cloth::surface([warp, None, weft, None]);
    let areal = Arc::new(Surface::areal(&map, 0.0).unwrap());
    for method in METHODS {
        let of = |surface: &Arc<Surface>| renderer(&under_exeter(surface), method);
        let (mut one, mut other) = (of(&economical), of(&areal));
        for (place, velocity) in [([50.0, 50.0], [80.0, 25.0]), ([33.3, 60.0], [-12.0, 0.0])] {
            let pose = pose(place, velocity);
            let (a, b) = (amplitudes(&mut one, &pose), amplitudes(&mut other, &pose));
            for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
                assert!(
                    (a - b).abs() <= 1e-6 * a.max(1e-3),
                    "{method:?}: {b} for {a}"
                );
            }
        }
    }
}

#[test]
fn moving_along_a_row_changes_every_column_of_an_areal_surface_only() {
    let areal = cloth::areal(6);
    let [warp, _, weft, _] = cloth::map(6, 1.0)
        .strokes(&Probe::ideal(), [4.5, 4.0], &Random::new(1))
        .unwrap();
    let economical = cloth::surface([warp, None, weft, None]);
    // A stroke along the weft, heard at two places along the warp.
    let at = |surface: &Arc<Surface>, u_mm: f64, method: Method| {
        let pose = pose([u_mm, 40.0], [0.0, 100.0]);
        amplitudes(&mut renderer(&under_exeter(surface), method), &pose)
    };
    for method in METHODS {
        let [before, after] = [40.0, 41.0].map(|u_mm| at(&economical, u_mm, method));
        assert_eq!(
            before, after,
            "{method:?}: a row of the economical one sounds alike"
        );
        let [before, after] = [40.0, 41.0].map(|u_mm| at(&areal, u_mm, method));
        let changed = before.iter().zip(&after).filter(|(a, b)| a != b).count();
        assert_eq!(changed, 24, "{method:?}");
    }
}

#[test]
fn fast_methods_keep_within_their_bounds_however_the_display_moves() {
    let scene = scene_of(vec![placed(&cloth::areal(7), [10.0, 5.0], 30.0)], exeter());
    let mut all = METHODS.map(|method| renderer(&scene, method));
    let mut random = Random::new(10);
    let total = cloth_total(&scene.textiles[0].surface);
    for tick in 0..150 {
        let velocity = [
            random.uniform_in(-150.0, 150.0),
            random.uniform_in(-150.0, 150.0),
        ];
        let place = [random.uniform_in(20.0, 60.0), random.uniform_in(40.0, 80.0)];
        let pose = Pose {
            angular_rad_per_s: if tick % 3 == 0 { 2.0 } else { 0.0 },
            ..pose(place, velocity)
        };
        let [exact, banded, table] = all.each_mut().map(|one| amplitudes(one, &pose));
        for (fast, bound) in [(banded, all[1].bound()), (table, all[2].bound())] {
            let ratio = 10.0_f64.powf(bound.level_db / 20.0) - 1.0;
            for (a, b) in exact.iter().flatten().zip(fast.iter().flatten()) {
                let most = a * ratio + (bound.floor + 1e-7) * total;
                assert!((a - b).abs() <= most, "{b} for {a}");
            }
        }
    }
    let counters = all[2].counters();
    assert!(counters.nodes_made > 100 && counters.bins_evaluated > 0);
}

fn cloth_total(surface: &Surface) -> f64 {
    let largest = |direction| {
        let spectra = surface.spectra(direction);
        let total = |point| spectra.powers_um2(point).iter().sum::<f64>();
        (0..spectra.n_points()).map(total).fold(0.0, f64::max)
    };
    (2.0 * Direction::ALL.map(largest).iter().sum::<f64>()).sqrt()
}

#[test]
fn a_trace_explains_what_an_areal_surface_is_felt_as() {
    let scene = under_exeter(&cloth::areal(9));
    let mut reference = renderer(&scene, Method::Reference);
    let pose = pose([44.4, 31.2], [70.0, -35.0]);
    let found = amplitudes(&mut reference, &pose);
    for (contactor, amplitudes_um) in found.iter().enumerate() {
        let trace = ContactTrace::of(&scene, 0, contactor, &pose).unwrap();
        let touch = trace.touch.unwrap();
        for (traced_um, felt_um) in trace.amplitudes_um.iter().zip(amplitudes_um) {
            let error = (traced_um - felt_um).abs();
            assert!(error <= 1e-9 * felt_um, "{contactor}");
        }
        let [warp, weft] = touch.directions.map(Option::unwrap);
        assert_eq!([warp.point, weft.point], [touch.points[0], touch.points[3]]);
        assert_eq!(warp.bins.len(), 43, "up to the Nyquist wavenumber");
    }
}
