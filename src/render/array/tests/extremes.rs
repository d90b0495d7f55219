//! Extreme cases: nothing panics, and no NaN comes out.

use super::*;
use crate::scene::{ExplorationPath, PathRow};
use crate::{RenderError, Replay, replay};
use selvedge_foundation::numerics::Random;
use std::ops::ControlFlow;

const METHODS: [Method; 3] = [Method::Reference, Method::Banded, Method::Table];

fn weave() -> Arc<Surface> {
    cloth::uniform(cloth::weave(&mut Random::new(1), 1500))
}

fn silent(amplitudes: &[[f64; 2]]) -> bool {
    amplitudes.iter().flatten().all(|a| *a == 0.0)
}

#[test]
fn a_still_finger_is_silent() {
    let scene = scene_of(vec![placed(&weave(), [0.0, 0.0], 0.0)], exeter());
    for method in METHODS {
        let mut renderer = renderer(&scene, method);
        for speed in [0.0, -0.0, 1e-300, 0.009_999, -0.009_999] {
            let all = amplitudes(&mut renderer, &pose([40.0, 40.0], [speed, speed]));
            assert!(silent(&all), "{method:?} at {speed} mm/s");
        }
        assert_eq!(renderer.counters().directions_at_rest, 5 * 48);
        assert_eq!(renderer.counters().directions_over_speed, 0);
        assert!(!silent(&amplitudes(
            &mut renderer,
            &pose([40.0, 40.0], [0.01, 0.0])
        )));
    }
}

#[test]
fn speeds_beyond_the_first_bins_kilohertz_are_silent_and_counted() {
    let scene = scene_of(vec![placed(&weave(), [0.0, 0.0], 0.0)], exeter());
    for method in METHODS {
        let mut renderer = renderer(&scene, method);
        for speed in [4348.0, 1000.0 / 0.23, -1e300] {
            assert!(silent(&amplitudes(
                &mut renderer,
                &pose([40.0, 40.0], [speed, 0.0])
            )));
        }
        assert_eq!(
            renderer.counters().directions_over_speed,
            3 * 24,
            "{method:?}"
        );
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(silent(&amplitudes(
                &mut renderer,
                &pose([40.0, 40.0], [0.0, bad])
            )));
            assert!(silent(&amplitudes(
                &mut renderer,
                &pose([bad, 40.0], [90.0, 0.0])
            )));
            let turned = Pose {
                angle_deg: bad,
                ..pose([40.0, 40.0], [90.0, 0.0])
            };
            assert!(silent(&amplitudes(&mut renderer, &turned)));
            let turning = Pose {
                angular_rad_per_s: bad,
                ..pose([40.0, 40.0], [90.0, 0.0])
            };
            assert!(silent(&amplitudes(&mut renderer, &turning)));
        }
        assert_eq!(renderer.counters().poses_not_finite, 12, "{method:?}");
        let spinning = Pose {
            angular_rad_per_s: 1e308,
            ..pose([40.0, 40.0], [90.0, 0.0])
        };
        assert!(
            silent(&amplitudes(&mut renderer, &spinning)),
            "ω × r overflows"
        );
        let after = amplitudes(&mut renderer, &pose([40.0, 40.0], [90.0, 0.0]));
        assert!(after.iter().all(|a| a[0] > 0.0), "and then it sounds again");
    }
}

#[test]
fn flat_tiny_and_huge_heights_are_silent_or_computed() {
    let at = pose([3.0, 3.0], [130.0, 20.0]);
    let expected = amplitudes(&mut renderer(&alone(&weave()), Method::Reference), &at)[0];
    for scale in [0.0, 1e-12, 1e12] {
        let heights = cloth::weave(&mut Random::new(1), 1500);
        let heights = heights.heights_um().iter().map(|z| z * scale).collect();
        let profile = selvedge_textile::surface::Profile::new(cloth::STEP_MM, heights).unwrap();
        let scene = alone(&cloth::uniform(profile));
        for method in METHODS {
            let found = amplitudes(&mut renderer(&scene, method), &at)[0];
            for b in 0..2 {
                let error = (found[b] - expected[b] * scale).abs();
                assert!(
                    error <= 0.005 * expected[b] * scale,
                    "{method:?} × {scale}: {found:?}"
                );
            }
        }
    }
}

#[test]
fn silence_stays_silent_under_any_gain_that_can_be_written() {
    // At rest along the weft, and beside the textile.
    let mut scene = alone(&weave());
    scene.tuning.gain_db = 800.0;
    let places = [
        pose([3.0, 3.0], [0.0, 0.0]),
        pose([-300.0, 3.0], [90.0, 0.0]),
    ];
    for method in METHODS {
        let mut live = renderer(&scene, method);
        for at in &places {
            assert!(silent(&amplitudes(&mut live, at)), "{method:?}");
        }
        let loud = amplitudes(&mut live, &pose([3.0, 3.0], [130.0, 20.0]));
        assert!(
            loud.iter().flatten().all(|um| !um.is_nan()),
            "{method:?}: {loud:?}"
        );
    }
}

#[test]
fn senseless_gains_are_refused_and_keep_the_last() {
    let mut scene = alone(&weave());
    let at = pose([3.0, 3.0], [130.0, 20.0]);
    for method in METHODS {
        let mut live = renderer(&scene, method);
        let before = amplitudes(&mut live, &at);
        for gain_db in [f64::NAN, f64::INFINITY] {
            let tuning = Tuning {
                gain_40_db: gain_db,
                ..Tuning::default()
            };
            assert!(matches!(
                live.set_tuning(&tuning),
                Err(RenderError::Tuning(_))
            ));
            assert_eq!(amplitudes(&mut live, &at), before);
        }
        let silence = Tuning {
            gain_40_db: f64::NEG_INFINITY,
            ..Tuning::default()
        };
        live.set_tuning(&silence).unwrap();
        assert_eq!(amplitudes(&mut live, &at)[0], [0.0, before[0][1]]);
        let loud = Tuning {
            gain_db: 1e300,
            ..Tuning::default()
        };
        live.set_tuning(&loud).unwrap();
        assert!(
            amplitudes(&mut live, &at)
                .iter()
                .flatten()
                .all(|a| a.is_finite())
        );
    }
    scene.textiles[0].scene_gain_db = f64::NAN;
    let refused = ArrayRenderer::prepare(&scene, Method::Auto, &Accuracy::default());
    assert!(matches!(refused, Err(RenderError::Tuning(_))), "in a scene");
}

#[test]
fn nothing_placed_and_nothing_to_feel_with_are_silent() {
    let bare = scene_of(Vec::new(), exeter());
    let fingerless = scene_of(
        vec![placed(&weave(), [0.0, 0.0], 0.0)],
        ContactorArray::default(),
    );
    for method in Method::ALL {
        let mut none = renderer(&bare, method);
        assert!(
            silent(&amplitudes(&mut none, &pose([40.0, 40.0], [90.0, 0.0]))),
            "{method:?}"
        );
        assert_eq!(none.counters().contactors_outside, 24);
        assert!(
            amplitudes(
                &mut renderer(&fingerless, method),
                &pose([4.0, 4.0], [9.0, 0.0])
            )
            .is_empty()
        );
    }
}

#[test]
fn a_display_without_a_pose_is_silent_and_counted() {
    let mut scene = alone(&weave());
    scene.displays.push(single_contactor());
    let mut renderer = renderer(&scene, Method::Table);
    let at = pose([3.0, 3.0], [90.0, 0.0]);
    let frames = renderer.tick(&[at, at]);
    assert_eq!(frames[0].amplitudes_um(), frames[1].amplitudes_um());
    let frames = renderer.tick(&[at]);
    assert_eq!(frames[1].amplitudes_um(), [[0.0; 2]]);
    assert!(
        frames[0].amplitudes_um()[0][0] > 0.0,
        "the first display still sounds"
    );
    assert_eq!(renderer.counters().poses_missing, 1);
}

#[test]
fn places_that_are_not_finite_are_refused() {
    let mut scene = alone(&weave());
    scene.textiles[0].size_mm = [f64::NAN, 10.0];
    let refused = ArrayRenderer::prepare(&scene, Method::Table, &Accuracy::default());
    assert_eq!(
        refused.err(),
        Some(RenderError::NotFinite {
            what: "textile",
            index: 0
        })
    );
}

#[test]
fn a_profile_of_metres_is_tabulated_where_it_is_touched() {
    let long = cloth::noise(&mut Random::new(4), 1_100_000);
    let cloth = cloth::surface([Some(long), None, None, None]);
    let scene = scene_of(vec![placed(&cloth, [0.0, 0.0], 0.0)], exeter());
    let [mut table, mut exact] = [Method::Table, Method::Reference].map(|m| renderer(&scene, m));
    assert!(table.n_bytes() < 270_000_000, "{}", table.n_bytes());
    let at = pose([70.0, 40.0], [90.0, 60.0]);
    let found = amplitudes(&mut table, &at);
    for (a, b) in found
        .iter()
        .flatten()
        .zip(amplitudes(&mut exact, &at).iter().flatten())
    {
        assert!((a / b - 1.0).abs() < 0.005, "{a} for {b}");
    }
}

#[test]
fn where_tables_would_not_fit_another_method_takes_over() {
    let profile = cloth::noise(&mut Random::new(4), 1000 + 63 * 230);
    let alone = || cloth::surface([Some(profile.clone()), None, None, None]);
    let all = (0..500).map(|_| placed(&alone(), [0.0, 0.0], 0.0));
    let scene = scene_of(all.collect(), exeter());
    let refused = ArrayRenderer::prepare(&scene, Method::Table, &Accuracy::default());
    assert!(
        matches!(refused, Err(RenderError::TableTooLarge { .. })),
        "explicitly"
    );
    let auto = renderer(&scene, Method::Auto);
    assert_eq!(auto.method(), Method::Banded);
}

#[test]
fn a_replay_counts_times_and_measures_errors() {
    let scene = scene_of(vec![placed(&weave(), [0.0, 0.0], 0.0)], exeter());
    let ticks = (0..50_u64).map(|n| n as f64 / 40.0).map(|t_s| PathRow {
        t_s,
        position: Point::new(30.0 + 60.0 * t_s, 30.0),
        angle_deg: 0.0,
        velocity: Some(Velocity::new(60.0, 5.0 * t_s)),
    });
    let path = ExplorationPath::new(ticks.collect()).unwrap();
    let mut now_ns = 0;
    let mut clock = || {
        now_ns += 100;
        now_ns
    };
    for method in Method::ALL {
        let what = Replay {
            scene: &scene,
            method,
            accuracy: Accuracy::default(),
            measures_error: true,
        };
        let mut n_frames = 0;
        let mut sink = |tick: u64, _: &Pose, frames: &[DisplayFrame]| {
            assert_eq!((tick, frames.len()), (n_frames, 1));
            n_frames += 1;
            if n_frames == 45 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let stats = replay(&what, &path, &mut clock, &mut sink).unwrap();
        let counted = (n_frames, stats.counters.ticks, stats.n_contactors);
        assert_eq!(counted, (45, 45, 24));
        assert_eq!(stats.tick_median_ns, 100.0);
        let unfiltered_um = unfiltered_um(&scene.textiles[0].surface);
        assert_eq!(stats.unfiltered_um, Some(unfiltered_um));
        let share = stats.bound_share.unwrap();
        let is_exact = stats.method_used == Method::Reference;
        assert!(
            share <= 1.0 && (share > 0.0) != is_exact,
            "{method:?}: {share}"
        );
        let error = stats.level_error.unwrap();
        assert!(
            error.max_db <= 0.05 && error.max_share_below < 6e-6,
            "{method:?}: {error:?}"
        );
        assert_eq!(
            error.max_db == 0.0,
            method == Method::Reference,
            "{error:?}"
        );
        // A second is worth no table.
        let expected = if method == Method::Auto {
            Method::Banded
        } else {
            method
        };
        assert_eq!(stats.method_used, expected);
    }
}
