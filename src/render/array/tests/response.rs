//! Maps, curves and readings of the inspector against what the reference renders.

use super::*;
use selvedge_textile::tactile::Filters;

/// Two cloths, the upper one turned by 90° and by an odd angle, with gains that differ.
fn two_cloths() -> RenderScene {
    let cloths = [cloth::of_kind(1, 5), cloth::of_kind(2, 9)];
    let mut textiles = vec![
        placed(&cloths[0], [10.0, 10.0], 0.0),
        placed(&cloths[1], [290.0, 20.0], 90.0),
        placed(&cloths[1], [40.0, 200.0], 23.0),
    ];
    textiles[0].scene_gain_db = -7.0;
    textiles[1].manifest_gain_db = 3.0;
    scene_of(textiles, single_contactor())
}

fn velocities() -> Vec<[f64; 2]> {
    vec![
        [100.0, 0.0],
        [0.0, -35.0],
        [-80.0, 55.0],
        [3.0, 2.0],
        [1900.0, -400.0],
        [0.0, 0.0],
        [0.004, 60.0],
        [-5000.0, 9.0],
    ]
}

fn close(found: [f64; 2], expected: [f64; 2]) -> bool {
    let pairs = found.iter().zip(expected);
    pairs
        .into_iter()
        .all(|(a, b)| (a - b).abs() <= 1e-13 * b.abs())
}

/// Where a place in a textile's frame is in the workspace.
fn in_workspace(placed: &PlacedSurface, [u_mm, w_mm]: [f64; 2]) -> [f64; 2] {
    let at = placed.workspace_from_textile.point(Point::new(u_mm, w_mm));
    [at.x_mm, at.y_mm]
}

#[test]
fn a_map_holds_what_the_reference_renders_at_every_place() {
    for filters in [Filters::default(), Filters::Receptor] {
        let mut scene = two_cloths();
        scene.filters = filters;
        let inspector = ContactInspector::new(&scene);
        let mut reference = renderer(&scene, Method::Reference);
        for (number, placed) in scene.textiles.iter().enumerate() {
            let response = inspector.response(number).unwrap();
            for velocity in velocities() {
                let own = response.along(Velocity::new(velocity[0], velocity[1]));
                let map = response.map(own);
                for place in [[0.2, 0.3], [3.5, 117.2], [44.9, 16.2], [80.0, 61.7]] {
                    let at = pose(in_workspace(placed, place), velocity);
                    let expected = amplitudes(&mut reference, &at)[0];
                    let found = map.amplitudes_um(place);
                    assert!(
                        close(found, expected),
                        "{velocity:?}: {found:?}, {expected:?}"
                    );
                }
            }
        }
    }
    assert!(ContactInspector::new(&two_cloths()).response(3).is_none());
}

#[test]
fn curves_over_direction_and_speed_hold_what_the_reference_renders() {
    let scene = two_cloths();
    let inspector = ContactInspector::new(&scene);
    let mut reference = renderer(&scene, Method::Reference);
    let place = [33.4, 71.8];
    for (number, placed) in scene.textiles.iter().enumerate() {
        let response = inspector.response(number).unwrap();
        let points = response.points_at(place);
        let position = in_workspace(placed, place);
        let frame = placed.workspace_from_textile.rotation;
        for speed in [4.0, 60.0, 700.0] {
            let around = response.by_direction(speed, Some(points), 6);
            assert_eq!(around.len(), 24);
            for (k, spread) in (0..24_u8).zip(&around) {
                let angle = std::f64::consts::TAU * f64::from(k) / 24.0;
                let own = Velocity::new(speed * angle.cos(), speed * angle.sin());
                let moved = frame.turn_velocity(own);
                let at = pose(position, [moved.x_mm_per_s, moved.y_mm_per_s]);
                let expected = amplitudes(&mut reference, &at)[0];
                let found = spread.at_place_um.unwrap();
                // The same angle rounded by another way moves a frequency by 1e-16 of itself.
                let is_near = |b: usize| (found[b] / expected[b] - 1.0).abs() < 1e-9;
                assert!(is_near(0) && is_near(1), "{k}: {found:?}, {expected:?}");
                let alone = response.at(own, Some(points)).at_place_um.unwrap();
                assert!((0..2).all(|b| (alone[b] / expected[b] - 1.0).abs() < 1e-9));
            }
        }
    }
}

#[test]
fn the_spread_is_that_of_all_pairs_of_points() {
    let scene = two_cloths();
    let response = ContactInspector::new(&scene).response(1).unwrap();
    for velocity in [Velocity::new(60.0, -25.0), Velocity::new(0.0, 90.0)] {
        let map = response.map(velocity);
        let [n_warp, n_weft] = map.n_points();
        let pairs = (0..n_warp).flat_map(|i| (0..n_weft).map(move |j| [i, j]));
        let all: Vec<[f64; 2]> = pairs.map(|pair| map.at_points_um(pair)).collect();
        let spread = response.at(velocity, None);
        assert_eq!(spread.at_place_um, None);
        for b in 0..2 {
            let of_band = all.iter().map(|a| a[b]);
            let mean_square = of_band.clone().map(|a| a * a).sum::<f64>() / all.len() as f64;
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
            assert!(near(spread.rms_um[b], mean_square.sqrt()), "{spread:?}");
            let most = of_band.clone().fold(0.0, f64::max);
            let least = of_band.fold(f64::INFINITY, f64::min);
            assert!(near(spread.max_um[b], most) && near(spread.min_um[b], least));
        }
    }
}

#[test]
fn a_textile_that_cannot_be_felt_at_a_velocity_is_silent_everywhere() {
    let response = ContactInspector::new(&two_cloths()).response(0).unwrap();
    for still in [0.0, 0.005, f64::NAN, f64::INFINITY] {
        let map = response.map(Velocity::new(still, -still));
        assert_eq!(map.n_points(), [1, 1]);
        assert_eq!(map.amplitudes_um([7.0, 8.0]), [0.0; 2]);
        let spread = response.at(Velocity::new(still, 0.0), Some([0; 4]));
        assert_eq!(
            (spread.max_um, spread.at_place_um),
            ([0.0; 2], Some([0.0; 2]))
        );
        let around = response.by_direction(still, None, 3);
        assert!(
            around.iter().all(|spread| spread.rms_um == [0.0; 2]),
            "{still}"
        );
    }
}

#[test]
fn readings_are_those_of_the_traces_of_each_contactor() {
    let mut scene = two_cloths();
    scene.displays = vec![exeter()];
    let mut inspector = ContactInspector::new(&scene);
    let mut readings = Vec::new();
    let mut n_read = 0;
    for (position, angular_rad_per_s) in [
        ([60.3, 70.2], 0.0),
        ([60.3, 70.2], 2.5),
        ([10.0, 12.0], -1.0),
        ([130.2, 90.0], 0.3),
        ([-50.0, 3.0], 1.0),
    ] {
        let at = Pose {
            angle_deg: 12.0,
            angular_rad_per_s,
            ..pose(position, [40.0, -3.0])
        };
        inspector.readings_into(0, &at, &mut readings);
        assert_eq!(readings.len(), 24);
        for (contactor, found) in readings.iter().enumerate() {
            let trace = inspector.trace(0, contactor, &at).unwrap();
            assert_eq!(found.position, trace.position);
            assert_eq!(found.reading.is_some(), trace.touch.is_some());
            let Some((reading, touch)) = found.reading.zip(trace.touch) else {
                continue;
            };
            n_read += 1;
            assert_eq!(reading.textile, touch.textile);
            assert_eq!(reading.place_mm, touch.place_mm);
            assert_eq!(reading.points, touch.points);
            assert_eq!(reading.velocity_mm_per_s, touch.velocity_mm_per_s);
            let felt = touch.directions.each_ref();
            let felt = felt.map(|direction| direction.as_ref().map(|d| d.direction));
            assert_eq!(reading.directions, felt);
            let response = inspector.response(touch.textile).unwrap();
            let own = response.along(found.velocity);
            let [along_warp, along_weft] = touch.velocity_mm_per_s;
            assert!((own.x_mm_per_s - along_warp).abs() < 1e-9, "{own:?}");
            assert!((own.y_mm_per_s - along_weft).abs() < 1e-9, "{own:?}");
            for (nearest, place) in reading.nearest_mm.iter().zip(reading.place_mm) {
                assert!(
                    (nearest - place).abs() <= 0.5 + 2e-6,
                    "{nearest} for {place}"
                );
            }
        }
    }
    assert!(n_read > 40, "{n_read} contactors read something");
    inspector.readings_into(1, &pose([60.0, 70.0], [1.0, 0.0]), &mut readings);
    assert!(readings.is_empty(), "there is no such display");
    inspector.readings_into(0, &pose([f64::NAN, 70.0], [1.0, 0.0]), &mut readings);
    assert!(readings.is_empty(), "it is nowhere");
}
