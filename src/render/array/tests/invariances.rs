//! What must not matter, and what must matter just so.

use proptest::prelude::*;

use super::*;
use selvedge_foundation::numerics::Random;

fn two_cloths() -> RenderScene {
    let mut random = Random::new(3);
    let one = cloth::uniform(cloth::weave(&mut random, 3100));
    let other = cloth::uniform(cloth::weave(&mut random, 1500));
    let textiles = vec![
        placed(&one, [0.0, 0.0], 0.0),
        placed(&other, [90.0, 12.0], 25.0),
    ];
    scene_of(textiles, exeter())
}

/// The scene turned about the workspace's origin.
fn turned(scene: &RenderScene, by: Rotation) -> RenderScene {
    let mut scene = scene.clone();
    for textile in &mut scene.textiles {
        let frame = &mut textile.workspace_from_textile;
        frame.origin = Point::default() + by.turn(frame.origin - Point::default());
        frame.rotation = by.after(frame.rotation);
    }
    scene
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn turning_scene_and_display_together_changes_nothing(
        angle_deg in -720.0..720.0_f64,
        place in (-5.0..215.0_f64, -5.0..140.0_f64),
        velocity in (-400.0..400.0_f64, -400.0..400.0_f64),
        own_angle_deg in -180.0..180.0_f64,
        angular_rad_per_s in prop_oneof![Just(0.0), -8.0..8.0_f64],
    ) {
        let by = Rotation::from_degrees(angle_deg);
        let scene = two_cloths();
        let straight = Pose {
            angle_deg: own_angle_deg,
            angular_rad_per_s,
            ..pose([place.0, place.1], [velocity.0, velocity.1])
        };
        let aslant = Pose {
            position: Point::default() + by.turn(straight.position - Point::default()),
            velocity: by.turn_velocity(straight.velocity),
            angle_deg: own_angle_deg + angle_deg,
            ..straight
        };
        let expected = amplitudes(&mut renderer(&scene, Method::Reference), &straight);
        let found = amplitudes(&mut renderer(&turned(&scene, by), Method::Reference), &aslant);
        for (a, b) in expected.iter().flatten().zip(found.iter().flatten()) {
            // Turning rounds places and speeds to about 1e-13; 20 dB an octave make it 1e-12.
            prop_assert!((a - b).abs() <= 1e-9 * a.max(1e-3), "{a} {b}");
        }
    }

    #[test]
    fn gains_scale_linearly(
        master in -60.0..40.0_f64, low in -60.0..40.0_f64, high in -60.0..40.0_f64,
        manifest in -20.0..20.0_f64, of_scene in -20.0..20.0_f64,
        of_bands in prop::array::uniform2(-20.0..20.0_f64),
        method in prop_oneof![Just(Method::Reference), Just(Method::Banded)],
    ) {
        let cloth = cloth::uniform(cloth::weave(&mut Random::new(8), 1200));
        let mut scene = alone(&cloth);
        let at = pose([3.0, 3.0], [120.0, 40.0]);
        let before = amplitudes(&mut renderer(&scene, method), &at)[0];
        scene.textiles[0].manifest_gain_db = manifest;
        scene.textiles[0].scene_gain_db = of_scene;
        scene.textiles[0].scene_band_gains_db = of_bands;
        let mut live = renderer(&scene, method);
        let tuning = Tuning {
            gain_db: master, gain_40_db: low, gain_320_db: high, ..Tuning::default()
        };
        live.set_tuning(&tuning).unwrap();
        let after = amplitudes(&mut live, &at)[0];
        for (b, band) in [low, high].into_iter().enumerate() {
            let own = manifest + of_scene + of_bands[b];
            let factor = 10.0_f64.powf((master + band + own) / 20.0);
            prop_assert!((after[b] / (before[b] * factor) - 1.0).abs() < 1e-12, "{after:?}");
        }
    }
}

#[test]
fn the_table_takes_the_same_gains_live() {
    let cloth = cloth::uniform(cloth::weave(&mut Random::new(8), 1200));
    let mut table = renderer(&alone(&cloth), Method::Table);
    let at = pose([3.0, 3.0], [120.0, 40.0]);
    let before = amplitudes(&mut table, &at)[0];
    let tuning = Tuning {
        gain_db: -7.0,
        gain_320_db: 3.0,
        ..Tuning::default()
    };
    table.set_tuning(&tuning).unwrap();
    let after = amplitudes(&mut table, &at)[0];
    for (b, gain_db) in [-7.0, -4.0].into_iter().enumerate() {
        let found_db = 20.0 * (after[b] / before[b]).log10();
        assert!((found_db - gain_db).abs() < 1e-5, "{found_db} dB"); // two roundings to f32
    }
}

#[test]
fn a_tick_does_not_depend_on_the_ticks_before_it() {
    let scene = two_cloths();
    for method in [Method::Reference, Method::Banded, Method::Table] {
        let mut used = renderer(&scene, method);
        let mut random = Random::new(2);
        for tick in 0..200 {
            let place = [random.uniform_in(0.0, 200.0), random.uniform_in(0.0, 120.0)];
            let velocity = [200.0 * random.normal(), 50.0 * random.normal()];
            let mut at = pose(place, velocity);
            at.angle_deg = if tick % 3 == 0 {
                0.0
            } else {
                30.0 * random.normal()
            };
            at.angular_rad_per_s = if tick % 2 == 0 { 0.0 } else { random.normal() };
            let expected = amplitudes(&mut used, &at);
            if tick % 20 == 0 {
                assert_eq!(amplitudes(&mut renderer(&scene, method), &at), expected);
            }
        }
    }
}
