//! Which textile and which point a contactor feels, and how a display moves over them.

use super::*;
use crate::array::{ContactInspector, ContactTrace, VibrationBin};
use selvedge_foundation::numerics::Random;
use selvedge_textile::tactile::Band;

const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

/// A cloth with one wave, and the 24.
fn one_cloth() -> RenderScene {
    let cloth = cloth::uniform(cloth::sine(1.0, 0.5));
    scene_of(vec![placed(&cloth, [0.0, 0.0], 0.0)], exeter())
}

#[test]
fn the_textile_listed_last_is_on_top() {
    let (weak, strong) = (cloth::sine(1.0, 0.5), cloth::sine(8.0, 0.5));
    let below = placed(&cloth::uniform(weak), [0.0, 0.0], 0.0);
    let above = placed(&cloth::uniform(strong), [60.0, 0.0], 0.0);
    for method in METHODS {
        let scene = scene_of(vec![below.clone(), above.clone()], exeter());
        let mut renderer = renderer(&scene, method);
        // Columns at 57, 59, 61, 63 mm: the border runs between them.
        let frame = &renderer.tick(&[pose([60.0, 50.0], [90.0, 0.0])])[0];
        for contactor in 0..24 {
            let is_right = contactor % 4 >= 2;
            assert_eq!(
                frame.textile(contactor),
                Some(usize::from(is_right)),
                "{method:?}"
            );
            let ratio = frame.amplitude_um(contactor)[1] / 0.93;
            assert!(
                if is_right { ratio > 6.0 } else { ratio < 1.5 },
                "{method:?}: {ratio}"
            );
        }
    }
}

#[test]
fn a_hundred_overlapping_textiles_are_felt_as_the_topmost() {
    let cloths: Vec<_> = (0..5_u8)
        .map(|i| cloth::uniform(cloth::sine(f64::from(i + 1), 0.5)))
        .collect();
    let textiles = (0..100)
        .map(|i| placed(&cloths[i % 5], [0.0, 0.0], 0.0))
        .collect();
    let alone = scene_of(vec![placed(&cloths[4], [0.0, 0.0], 0.0)], exeter());
    let scene = scene_of(textiles, exeter());
    for method in METHODS {
        let at = pose([50.0, 50.0], [70.0, 20.0]);
        let mut stack = renderer(&scene, method);
        assert_eq!(
            amplitudes(&mut stack, &at),
            amplitudes(&mut renderer(&alone, method), &at)
        );
        assert_eq!(stack.frames()[0].textile(0), Some(99));
    }
}

#[test]
fn contactors_beyond_an_edge_are_silent_and_those_inside_sound() {
    let scene = one_cloth();
    for method in METHODS {
        let mut renderer = renderer(&scene, method);
        let frame = &renderer.tick(&[pose([0.0, 50.0], [90.0, 0.0])])[0];
        for contactor in 0..24 {
            let is_inside = contactor % 4 >= 2;
            assert_eq!(frame.textile(contactor).is_some(), is_inside, "{method:?}");
            assert_eq!(
                frame.amplitude_um(contactor)[0] > 0.0,
                is_inside,
                "{method:?}"
            );
        }
        assert_eq!(renderer.counters().contactors_outside, 12);
    }
}

#[test]
fn edges_belong_to_the_lower_left_within_a_nanometre() {
    let scene = alone(&cloth::uniform(cloth::sine(1.0, 0.5)));
    let mut renderer = renderer(&scene, Method::Table);
    let cases = [
        (-1.1e-6, false),
        (-1e-6, true),
        (0.0, true),
        (119.999_998, true),
        (120.0 - 1e-6, false),
        (120.0, false),
        (1e300, false),
        (-1e300, false),
    ];
    for (u, is_inside) in cases {
        for position in [[u, 60.0], [60.0, u]] {
            let frame = &renderer.tick(&[pose(position, [90.0, 90.0])])[0];
            assert_eq!(frame.textile(0).is_some(), is_inside, "{position:?}");
            assert_eq!(frame.amplitudes_um()[0][1] > 0.0, is_inside, "{position:?}");
        }
    }
}

#[test]
fn a_textile_of_one_point_is_the_same_everywhere() {
    let cloth = cloth::uniform(cloth::weave(&mut Random::new(1), 1000));
    let scene = scene_of(vec![placed(&cloth, [0.0, 0.0], 0.0)], exeter());
    for method in METHODS {
        let all = amplitudes(
            &mut renderer(&scene, method),
            &pose([50.0, 50.0], [70.0, 20.0]),
        );
        assert!(
            all[0][0] > 0.0 && all.iter().all(|a| *a == all[0]),
            "{method:?}"
        );
    }
}

#[test]
fn contactors_of_a_row_share_the_weft_and_of_a_column_the_warp() {
    let cloth = cloth::surface([
        Some(cloth::weave(&mut Random::new(1), 4600)),
        None,
        Some(cloth::weave(&mut Random::new(2), 4600)),
        None,
    ]);
    let scene = scene_of(vec![placed(&cloth, [0.0, 0.0], 0.0)], exeter());
    let mut banded = renderer(&scene, Method::Banded);
    let along_u = amplitudes(&mut banded, &pose([50.0, 50.0], [70.0, 0.0]));
    let along_w = amplitudes(&mut banded, &pose([50.0, 50.0], [0.0, 70.0]));
    for i in 0..24 {
        assert_eq!(along_u[i], along_u[i % 4], "columns");
        assert_eq!(along_w[i], along_w[i / 4 * 4], "rows");
    }
    assert!(
        along_u[0] != along_u[1] && along_w[0] != along_w[4],
        "and differ otherwise"
    );
    // Four distinct points along the warp, six along the weft; the other direction is at rest.
    let counters = banded.counters();
    assert_eq!(counters.directions_evaluated, 4 + 6);
    assert_eq!(counters.directions_repeated, 20 + 18);
    assert_eq!(counters.directions_at_rest, 48);
}

#[test]
fn a_turning_display_moves_its_contactors_apart() {
    let scene = one_cloth();
    for method in METHODS {
        let mut renderer = renderer(&scene, method);
        let turning = Pose {
            angular_rad_per_s: 10.0,
            ..pose([50.0, 50.0], [0.0, 0.0])
        };
        let turned = amplitudes(&mut renderer, &turning);
        let counters = renderer.counters();
        let n_felt = counters.directions_evaluated + counters.directions_repeated;
        assert_eq!(n_felt, 48, "no contactor is at rest");
        // Contactor 0 at (−3, 5) mm moves at (−50, −30) mm/s.
        let alone = amplitudes(&mut renderer, &pose([50.0, 50.0], [-50.0, -30.0]));
        assert!(
            (turned[0][0] / alone[0][0] - 1.0).abs() < 1e-5,
            "{method:?}"
        );
        assert!(turned[0] != turned[10], "nearer to the centre it is slower");
    }
}

#[test]
fn ten_thousand_contactors_render_as_one_by_one() {
    let cloth = cloth::uniform(cloth::weave(&mut Random::new(5), 4600));
    let offsets: Vec<Displacement> = (0..10_000)
        .map(|i| Displacement::new(f64::from(i % 100) * 0.7, f64::from(i / 100) * 0.7))
        .collect();
    let array = ContactorArray {
        offsets: offsets.clone(),
        rotation_deg: 0.0,
    };
    let scene = scene_of(vec![placed(&cloth, [0.0, 0.0], 10.0)], array);
    let lone = scene_of(scene.textiles.clone(), single_contactor());
    for method in [Method::Banded, Method::Table] {
        let (mut many, mut one) = (renderer(&scene, method), renderer(&lone, method));
        let all = amplitudes(&mut many, &pose([20.0, 3.0], [60.0, 30.0]));
        for index in (0..10_000).step_by(97) {
            let place = [20.0 + offsets[index].x_mm, 3.0 + offsets[index].y_mm];
            let lone = amplitudes(&mut one, &pose(place, [60.0, 30.0]))[0];
            for b in 0..2 {
                assert!(
                    (all[index][b] - lone[b]).abs() <= 1e-6 * lone[b],
                    "{method:?} {index}"
                );
            }
        }
    }
}

#[test]
fn the_trace_explains_the_reference() {
    let cloth = cloth::uniform(cloth::weave(&mut Random::new(5), 4600));
    let mut scene = scene_of(vec![placed(&cloth, [5.0, 7.0], 20.0)], exeter());
    scene.tuning.gain_320_db = -4.0;
    let at = Pose {
        angle_deg: 12.0,
        angular_rad_per_s: 2.0,
        ..pose([30.0, 60.0], [60.0, -30.0])
    };
    let expected = amplitudes(&mut renderer(&scene, Method::Reference), &at);
    let mut renderer = renderer(&scene, Method::Reference);
    for contactor in [0, 7, 23] {
        let trace = ContactTrace::of(&scene, 0, contactor, &at).unwrap();
        let frame = &renderer.tick(&[at])[0];
        assert_eq!(trace.position, frame.contactor_position(contactor));
        for (a, expected) in trace.amplitudes_um.iter().zip(expected[contactor]) {
            let ratio = a / expected;
            assert!((ratio - 1.0).abs() < 1e-12, "{trace:?}");
        }
        let touch = trace.touch.unwrap();
        assert_eq!(touch.textile, 0);
        assert_eq!(touch.gains[1].total_db(), -4.0);
        let warp = touch.directions[0].as_ref().unwrap();
        assert_eq!(warp.bins.len(), 500);
        let speed = touch.velocity_mm_per_s[0].abs();
        assert!(
            (warp.bins[9].frequency_hz - 2.3 * speed).abs() < 1e-9,
            "bin 10"
        );
    }
    assert!(
        ContactTrace::of(&scene, 0, 24, &at).is_none(),
        "no such contactor"
    );
    let outside = ContactTrace::of(&scene, 0, 0, &pose([-50.0, 0.0], [60.0, 0.0])).unwrap();
    assert_eq!((outside.touch, outside.amplitudes_um), (None, [0.0; 2]));
}

#[test]
fn the_vibration_at_a_contactor_is_what_the_renderer_filters() {
    let cloth = cloth::uniform(cloth::weave(&mut Random::new(6), 4600));
    let scene = scene_of(vec![placed(&cloth, [5.0, 7.0], 20.0)], exeter());
    let at = pose([30.0, 60.0], [60.0, -30.0]);
    let expected = amplitudes(&mut renderer(&scene, Method::Reference), &at);
    let mut inspector = ContactInspector::new(&scene);
    let mut bins = Vec::new();
    for (contactor, expected) in expected.iter().enumerate() {
        inspector.vibration_into(0, contactor, &at, &mut bins);
        for band in Band::ALL {
            let filtered = |bin: &VibrationBin| {
                bin.power_um2 * scene.filters.power_gain(band, bin.frequency_hz)
            };
            let amplitude_um = (2.0 * bins.iter().map(filtered).sum::<f64>()).sqrt();
            let ratio = amplitude_um / expected[band.index()];
            assert!((ratio - 1.0).abs() < 1e-12, "{contactor} {band:?}: {ratio}");
        }
        assert!(
            bins.iter().all(|bin| bin.frequency_hz < 1000.0),
            "all heard"
        );
    }
    let touch = inspector.trace(0, 3, &at).unwrap().touch.unwrap();
    for felt in touch.directions.iter().flatten() {
        assert_eq!(touch.points[felt.direction.index()], felt.point);
    }
}

#[test]
fn where_nothing_is_felt_no_vibration_arrives() {
    let cloth = cloth::uniform(cloth::weave(&mut Random::new(6), 4600));
    let mut inspector = ContactInspector::new(&alone(&cloth));
    let mut bins = Vec::new();
    let (on, moving) = ([30.0, 60.0], [60.0, 0.0]);
    let cases = [
        (0, 0, pose(on, [0.0, 0.0])),
        (0, 0, pose([-9.0, 0.0], moving)),
        (0, 0, pose([f64::NAN, 0.0], moving)),
        (0, 0, pose(on, [f64::NAN, 0.0])),
        (0, 1, pose(on, moving)),
        (1, 0, pose(on, moving)),
    ];
    for (display, contactor, at) in cases {
        inspector.vibration_into(0, 0, &pose(on, moving), &mut bins);
        assert!(!bins.is_empty(), "it is felt there");
        inspector.vibration_into(display, contactor, &at, &mut bins);
        assert!(bins.is_empty(), "{display} {contactor} {at:?}");
    }
    ContactInspector::new(&RenderScene::default()).vibration_into(
        0,
        0,
        &Pose::default(),
        &mut bins,
    );
    assert!(bins.is_empty(), "an empty scene");
}

#[test]
fn a_turned_cloth_is_felt_within_its_corners_as_without_them_and_nowhere_else() {
    let cloth = cloth::of_kind(4, 7);
    let whole = placed(&cloth, [40.0, -40.0], 30.0);
    let cut = PlacedSurface {
        within_mm: Some([[20.0, 0.0], [40.0, 20.0]].map(Point::from)),
        ..whole.clone()
    };
    for method in METHODS {
        let felt = |textile: &PlacedSurface, at| {
            let scene = scene_of(vec![textile.clone()], exeter());
            let mut renderer = renderer(&scene, method);
            let frame = &renderer.tick(&[pose(at, [60.0, 25.0])])[0];
            let each = |contactor| {
                let is_on_it = frame.textile(contactor).is_some();
                (is_on_it, frame.amplitude_um(contactor).map(f64::to_bits))
            };
            (0..24).map(each).collect::<Vec<_>>()
        };
        let inside = [30.0, 10.0];
        assert_eq!(felt(&cut, inside), felt(&whole, inside), "{method:?}");
        // Columns at 37, 39, 41, 43 mm: the border runs between them.
        let at_border = [40.0, 10.0];
        let both = felt(&cut, at_border).into_iter();
        for (contactor, (cut, whole)) in both.zip(felt(&whole, at_border)).enumerate() {
            let expected = if contactor % 4 < 2 {
                whole
            } else {
                (false, [0.0_f64.to_bits(); 2])
            };
            assert_eq!(cut, expected, "{method:?}: {contactor}");
        }
    }
}

#[test]
fn contactors_that_touch_by_themselves_feel_what_a_moving_display_would() {
    for method in METHODS {
        let scene = one_cloth();
        let mut flat = renderer(&scene, method);
        let mut hung = renderer(&scene, method);
        let moving = pose([40.3, 51.2], [90.0, -35.0]);
        let frame = flat.tick(&[moving])[0].clone();
        let contact = |contactor: usize| {
            let place = frame.contactor_position(contactor);
            MaterialContact {
                place_mm: [place.x_mm, place.y_mm],
                velocity_mm_per_s: [90.0, -35.0],
            }
        };
        let mut contacts: Vec<_> = (0..24).map(|contactor| Some(contact(contactor))).collect();
        let touched = hung.touch((0, 0), &contacts).unwrap();
        assert_eq!(touched.amplitudes_um(), frame.amplitudes_um(), "{method:?}");
        contacts[3] = None;
        contacts[4] = Some(MaterialContact {
            place_mm: [f64::NAN, 0.0],
            velocity_mm_per_s: [90.0, 0.0],
        });
        let touched = hung.touch((0, 0), &contacts[..20]).unwrap();
        for contactor in 0..24 {
            let is_felt = contactor < 20 && contactor != 3 && contactor != 4;
            assert_eq!(
                touched.amplitudes_um()[contactor][1] > 0.0,
                is_felt,
                "{contactor}"
            );
            assert_eq!(touched.textile(contactor), is_felt.then_some(0));
        }
        assert!(hung.touch((7, 0), &contacts).is_none(), "no such display");
        let silent = hung.touch((0, 7), &contacts).unwrap();
        assert!(
            silent.amplitudes_um().iter().all(|a| *a == [0.0; 2]),
            "no such textile"
        );
    }
}
