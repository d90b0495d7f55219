//! Savings: amplitudes are the same to the bit without them, and what is left out is counted.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::{Rule, Rules};
use selvedge_foundation::numerics::Random;

const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

/// Every set of rules that is worth a try.
fn sets() -> Vec<Rules> {
    let of_rule = |rule| [Rules::only(rule), Rules::ALL.without(rule)];
    let one_by_one = Rule::ALL.into_iter().flat_map(of_rule);
    std::iter::once(Rules::NONE).chain(one_by_one).collect()
}

/// Up to four turned textiles of three surfaces, one of them areal, that overlap by chance, under
/// 24 contactors.
fn random_scene(random: &mut Random) -> RenderScene {
    let mut cloths = [1, 3, 4].map(|kind| cloth::of_kind(kind, 1 + random.index(1000) as u64));
    cloths[2] = cloth::areal(1 + random.index(1000) as u64);
    let textile = |random: &mut Random| {
        let origin = [random.uniform_in(-5.0, 35.0), random.uniform_in(-5.0, 35.0)];
        let turn = if random.index(2) == 0 { 0.0 } else { 35.0 };
        let size_mm = [random.uniform_in(2.0, 40.0), random.uniform_in(2.0, 40.0)];
        PlacedSurface {
            size_mm,
            ..placed(&cloths[random.index(3)], origin, turn)
        }
    };
    let textiles = (0..=random.index(4)).map(|_| textile(random)).collect();
    scene_of(textiles, exeter())
}

/// A pose of any kind: at rest, moving, turning, too fast, nowhere.
fn random_pose(random: &mut Random) -> Pose {
    let position = [random.uniform_in(0.0, 40.0), random.uniform_in(0.0, 40.0)];
    let speed = [0.0, 0.005, 20.0, 20.0, 333.3, 6000.0, f64::NAN][random.index(7)];
    let (sin, cos) = random.uniform_in(0.0, TAU).sin_cos();
    let axis = random.index(3);
    let velocity = [
        if axis == 0 { 0.0 } else { speed * cos },
        if axis == 1 { 0.0 } else { speed * sin },
    ];
    Pose {
        angle_deg: [0.0, 40.0][random.index(2)],
        angular_rad_per_s: [0.0, 0.0, 2.0][random.index(3)],
        ..pose(position, velocity)
    }
}

fn random_path(random: &mut Random) -> Vec<Pose> {
    let twice = |pose: Pose| [pose, pose];
    (0..6).flat_map(|_| twice(random_pose(random))).collect()
}

/// Amplitudes and owners of every tick, bit by bit.
fn felt(renderer: &mut ArrayRenderer, path: &[Pose]) -> Vec<([u64; 2], [u32; 2], Option<usize>)> {
    let mut felt = Vec::new();
    for pose in path {
        let frame = &renderer.tick(std::slice::from_ref(pose))[0];
        felt.extend((0..frame.n_contactors()).map(|contactor| {
            (
                frame.amplitude_um(contactor).map(f64::to_bits),
                frame.amplitudes_um()[contactor].map(f32::to_bits),
                frame.textile(contactor),
            )
        }));
    }
    felt
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn savings_keep_every_bit_of_every_amplitude(seed in any::<u64>()) {
        let mut random = Random::new(seed);
        let scene = random_scene(&mut random);
        let path = random_path(&mut random);
        let exact = felt(&mut renderer(&scene, Method::Reference), &path);
        for method in METHODS {
            let prepared = renderer(&scene, method);
            let expected = felt(&mut prepared.clone(), &path);
            for rules in sets() {
                let mut found = prepared.clone().with_rules(rules);
                prop_assert_eq!(found.rules(), rules);
                let found = felt(&mut found, &path);
                // With the bins below its floor, banded sums just what the reference does.
                let is_banded = method == Method::Banded;
                let is_full = is_banded && !rules.has(Rule::BelowFloor);
                let expected = if is_full { &exact } else { &expected };
                prop_assert!(found == *expected, "{:?} with {:?}", method, rules);
            }
        }
    }
}

/// Four textiles: two that lie on each other, one at their edge, one far away.
fn busy_scene() -> RenderScene {
    let cloths = [1, 4].map(|kind| cloth::of_kind(kind, 3));
    let at = |cloth: usize, origin| placed(&cloths[cloth], origin, 0.0);
    let textiles = vec![
        at(0, [0.0, 0.0]),
        at(1, [0.0, 0.0]),
        at(0, [118.0, 0.0]),
        at(1, [500.0, 500.0]),
    ];
    scene_of(textiles, exeter())
}

fn busy_path() -> Vec<Pose> {
    vec![
        pose([60.0, 60.0], [0.0, 0.0]),
        pose([60.0, 60.0], [0.0, 0.0]),
        pose([60.0, 60.0], [70.0, 0.0]),
        pose([60.0, 60.0], [0.8, 0.3]),
        pose([60.0, 60.0], [5000.0, 900.0]),
        pose([118.0, 60.0], [70.0, 30.0]),
        Pose {
            angular_rad_per_s: 1.0,
            ..pose([60.0, 60.0], [70.0, 30.0])
        },
    ]
}

#[test]
fn every_saving_counts_what_it_leaves_out_and_nothing_once_it_is_off() {
    let (scene, path) = (busy_scene(), busy_path());
    let left_out = |method: Method, rules: Rules, rule: Rule| {
        let mut renderer = renderer(&scene, method).with_rules(rules);
        felt(&mut renderer, &path);
        rule.left_out(renderer.counters())
    };
    for rule in Rule::ALL {
        let counts = METHODS.map(|method| left_out(method, Rules::ALL, rule));
        assert!(counts.into_iter().any(|n| n > 0), "{rule:?}: {counts:?}");
        for method in METHODS {
            let without = left_out(method, Rules::ALL.without(rule), rule);
            assert_eq!(without, 0, "{rule:?} by {method:?}");
        }
    }
}

#[test]
fn without_savings_every_contactor_is_evaluated_on_every_textile_with_every_bin() {
    let (scene, path) = (busy_scene(), busy_path());
    let n_directions = (path.len() * scene.textiles.len() * 24 * 2) as u64;
    for method in METHODS {
        let mut renderer = renderer(&scene, method).with_rules(Rules::NONE);
        felt(&mut renderer, &path);
        let counters = renderer.counters();
        assert_eq!(counters.directions_evaluated, n_directions, "{method:?}");
        let n_bins = if method == Method::Table { 0 } else { 1000 };
        assert_eq!(counters.bins_evaluated, n_bins * n_directions, "{method:?}");
        assert_eq!(
            counters.contactors_inside,
            path.len() as u64 * 24,
            "{method:?}"
        );
    }
}

#[test]
fn a_display_that_stands_is_where_it_was_and_sounds_once_it_moves() {
    let mut renderer = renderer(&busy_scene(), Method::Table);
    let (rest, moving) = (busy_path()[0], busy_path()[2]);
    let owners = |frames: &[DisplayFrame]| frames[0].textile(0);
    assert_eq!(owners(renderer.tick(&[rest])), Some(1));
    assert_eq!(owners(renderer.tick(&[rest])), Some(1));
    assert_eq!(renderer.counters().displays_standing, 1);
    assert_eq!(renderer.counters().directions_at_rest, 2 * 48);
    assert_eq!(owners(renderer.tick(&[])), None);
    assert_eq!(owners(renderer.tick(&[rest])), Some(1));
    renderer.reset();
    assert_eq!(owners(renderer.frames()), None);
    assert_eq!(owners(renderer.tick(&[rest])), Some(1));
    assert_eq!(renderer.counters().displays_standing, 0);
    assert!(renderer.tick(&[moving])[0].amplitudes_um()[0][0] > 0.0);
    assert_eq!(renderer.tick(&[rest])[0].amplitudes_um()[0], [0.0; 2]);
    assert_eq!(renderer.counters().displays_standing, 0);
}

#[test]
fn without_its_floor_banded_promises_the_reference() {
    let banded = renderer(&busy_scene(), Method::Banded);
    let floor = Accuracy::default().banded_floor;
    assert_eq!(banded.bound().floor, floor);
    let full = banded.with_rules(Rules::ALL.without(Rule::BelowFloor));
    assert_eq!((full.bound().level_db, full.bound().floor), (0.0, 0.0));
    let again = full.with_rules(Rules::ALL);
    assert_eq!(again.bound().floor, floor);
}
