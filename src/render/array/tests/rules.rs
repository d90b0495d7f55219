//! Savings: what is left out changes no bit of any amplitude, and is counted.

use std::f64::consts::TAU;

use proptest::prelude::*;

use super::*;
use crate::Rule;
use selvedge_foundation::numerics::Random;

const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

/// Up to four turned textiles of three surfaces, one of them areal, that overlap by chance, under
/// 24 contactors.
fn random_scene(random: &mut Random) -> RenderScene {
    let mut cloths = [1, 3, 4].map(|kind| cloth::of_kind(kind, 1 + random.index(1000) as u64));
    cloths[2] = cloth::areal(1 + random.index(1000) as u64);
    let textile = |random: &mut Random| {
        let origin = [random.uniform_in(-5.0, 35.0), random.uniform_in(-5.0, 35.0)];
        let turn = if random.index(2) == 0 { 0.0 } else { 35.0 };
        let size_mm = [random.uniform_in(2.0, 40.0), random.uniform_in(2.0, 40.0)];
        let corners = [[10.0, 5.0], [25.0, 30.0]].map(Point::from);
        PlacedSurface {
            size_mm,
            within_mm: (random.index(4) == 0).then_some(corners),
            scene_band_gains_db: [random.uniform_in(-6.0, 6.0), 0.0],
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

/// The same scene without the textiles that no contactor touches on a path.
fn without_untouched(scene: &RenderScene, path: &[Pose]) -> (RenderScene, Vec<usize>) {
    let mut renderer = renderer(scene, Method::Reference);
    let mut touched: Vec<usize> = Vec::new();
    for pose in path {
        let frame = &renderer.tick(std::slice::from_ref(pose))[0];
        touched.extend((0..frame.n_contactors()).filter_map(|contactor| frame.textile(contactor)));
    }
    touched.sort_unstable();
    touched.dedup();
    let mut lean = scene.clone();
    lean.textiles = touched
        .iter()
        .map(|at| scene.textiles[*at].clone())
        .collect();
    (lean, touched)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn what_no_contactor_touches_changes_no_bit_of_any_amplitude(seed in any::<u64>()) {
        let mut random = Random::new(seed);
        let scene = random_scene(&mut random);
        let path = random_path(&mut random);
        let (lean, touched) = without_untouched(&scene, &path);
        for method in METHODS {
            let expected = felt(&mut renderer(&scene, method), &path);
            let found = felt(&mut renderer(&lean, method), &path);
            let name = |(a, b, textile): (_, _, Option<_>)| (a, b, textile.map(|at| touched[at]));
            let named = found.into_iter().map(name);
            prop_assert!(named.eq(expected), "{:?}", method);
        }
    }

    #[test]
    fn savings_of_banded_beside_its_floor_keep_every_bit_of_the_reference(seed in any::<u64>()) {
        let mut random = Random::new(seed);
        let scene = random_scene(&mut random);
        let path = random_path(&mut random);
        let exact = felt(&mut renderer(&scene, Method::Reference), &path);
        let no_floor = Accuracy { banded_floor: 0.0, ..Accuracy::default() };
        let mut banded = ArrayRenderer::prepare(&scene, Method::Banded, &no_floor).unwrap();
        prop_assert!(felt(&mut banded, &path) == exact);
        prop_assert_eq!((banded.bound().level_db, banded.bound().floor), (0.0, 0.0));
    }

    #[test]
    fn what_ticks_repeat_is_what_each_tick_alone_renders(seed in any::<u64>()) {
        let mut random = Random::new(seed);
        let scene = random_scene(&mut random);
        let path = random_path(&mut random);
        for method in METHODS {
            let prepared = renderer(&scene, method);
            let expected: Vec<_> = path
                .iter()
                .flat_map(|pose| felt(&mut prepared.clone(), std::slice::from_ref(pose)))
                .collect();
            prop_assert!(felt(&mut prepared.clone(), &path) == expected, "{:?}", method);
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
fn every_saving_counts_what_it_leaves_out() {
    let (scene, path) = (busy_scene(), busy_path());
    let counters = METHODS.map(|method| {
        let mut renderer = renderer(&scene, method);
        felt(&mut renderer, &path);
        *renderer.counters()
    });
    for rule in Rule::ALL {
        let counts = counters.map(|counters| rule.left_out(&counters));
        assert!(counts.into_iter().any(|n| n > 0), "{rule:?}: {counts:?}");
    }
    for counters in counters {
        // Each contactor's two directions in each tick on its own textile, once.
        let n_directions = counters.directions_evaluated
            + counters.directions_repeated
            + counters.directions_at_rest
            + counters.directions_over_speed;
        assert_eq!(n_directions, 2 * counters.contactors_inside);
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
