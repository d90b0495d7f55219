//! The engine as its owner sees it, in told time: replays, recordings, stops, limits.

mod device;

use std::io::Cursor;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use super::*;
use crate::bridge::ArrayProfile;
use crate::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use crate::render::array::{Accuracy, ArrayRenderer, Method};
use crate::render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
use crate::scene::{ExplorationPath, Geometry, PathRow, Pose, Stroke};
use crate::surface::{Profile, ProfileSet, Surface};
use crate::tactile::Tuning;

/// A square of 100 mm with waves of 1 mm along the warp and 0.7 mm along the weft, felt by these
/// contactors.
fn render_scene(offsets: Vec<Displacement>) -> RenderScene {
    let wave = |wavelength_mm: f64, n: u32| {
        let turn = std::f64::consts::TAU / (230.0 * wavelength_mm);
        let height = |i: u32| 3.0 * (f64::from(i) * turn).sin() + f64::from(i % 7);
        Profile::new(1.0 / 230.0, (0..n).map(height).collect()).unwrap()
    };
    let mut profiles = ProfileSet::default();
    profiles[0] = Some(wave(1.0, 5000));
    profiles[2] = Some(wave(0.7, 4000));
    let surface = PlacedSurface {
        workspace_from_textile: Frame {
            origin: Point::new(10.0, 10.0),
            rotation: Rotation::from_degrees(30.0),
        },
        size_mm: [100.0, 100.0],
        manifest_gain_db: 0.0,
        scene_gain_db: 0.0,
        level: PlacedLevel::Known(0.0),
        surface: Arc::new(Surface::from_profiles(profiles, 0.0).unwrap()),
    };
    RenderScene {
        textiles: vec![surface],
        displays: vec![ContactorArray {
            offsets,
            rotation_deg: 5.0,
        }],
        ..RenderScene::default()
    }
}

fn exeter() -> Vec<Displacement> {
    Geometry::default().contactors()
}

fn prepared(offsets: Vec<Displacement>, method: Method) -> PreparedScene {
    let (scene, profile) = (render_scene(offsets), ArrayProfile::default());
    let accuracy = Accuracy::default();
    PreparedScene::from_parts(&scene, profile, Point::new(30.0, 60.0), (method, &accuracy)).unwrap()
}

fn config(method: Method) -> EngineConfig {
    EngineConfig {
        scene: prepared(exeter(), method),
        on_news: None,
    }
}

/// An engine in told time, and that time.
fn engine(method: Method) -> (Engine, Instant) {
    let start = Instant::now();
    (
        Engine::without_thread(config(method), start).unwrap(),
        start,
    )
}

/// Amplitudes of a path by an offline rendering of the same scene.
fn offline(path: &ExplorationPath, method: Method) -> Vec<Vec<[f32; 2]>> {
    let scene = render_scene(exeter());
    let mut renderer = ArrayRenderer::prepare(&scene, method, &Accuracy::default()).unwrap();
    let mut amplitudes = |pose| renderer.tick(&[pose])[0].amplitudes_um().to_vec();
    path.ticks().map(|(_, pose)| amplitudes(pose)).collect()
}

fn amplitudes(snapshot: &Snapshot) -> Vec<[f32; 2]> {
    snapshot.displays[0]
        .contactors
        .iter()
        .map(|contactor| contactor.amplitude_um)
        .collect()
}

fn is_silent(snapshot: &Snapshot) -> bool {
    amplitudes(snapshot).iter().all(|a| *a == [0.0; 2])
}

/// A path with turns, at times that are no ticks.
fn path() -> Arc<ExplorationPath> {
    let row = |n: i32| {
        let t_s = 2.0 + f64::from(n) * 0.017;
        PathRow {
            t_s,
            position: Point::new(40.0 + 8.0 * t_s.sin(), 60.0 + 9.0 * (1.7 * t_s).cos()),
            angle_deg: f64::from(n) * 0.9,
            velocity: None,
        }
    };
    Arc::new(ExplorationPath::new((0..120).map(row).collect()).unwrap())
}

/// Moves the pointer along a curve at 125 Hz while the engine ticks, turning now and then.
fn explore(engine: &mut Engine, start: Instant, n_ticks: u32) {
    let mut pointer = engine.take_pointer().unwrap();
    let mut n_sample = 0;
    for n in 1..=n_ticks {
        let now = start + TICK * n;
        while start + Duration::from_millis(8) * n_sample < now {
            let stamp = start + Duration::from_millis(8) * n_sample;
            let t_s = (stamp - start).as_secs_f64();
            let position = Point::new(50.0 + 15.0 * (3.0 * t_s).sin(), 60.0 + 40.0 * t_s / 3.0);
            pointer.push(PointerSample { stamp, position });
            n_sample += 1;
        }
        if n % 10 == 3 {
            engine.send(Command::TurnBy(1.5)).unwrap();
        }
        engine.advance(now);
    }
}

#[test]
fn a_replay_gives_the_amplitudes_of_an_offline_rendering_bit_for_bit() {
    for method in [Method::Reference, Method::Banded, Method::Table] {
        let (mut engine, _) = engine(method);
        let path = path();
        engine
            .send(Command::SetSource(InputSource::Replay(Arc::clone(&path))))
            .unwrap();
        engine.send(Command::SetLoop(true)).unwrap();
        engine.send(Command::Play).unwrap();
        let expected = offline(&path, method);
        assert!(
            expected.iter().flatten().any(|a| a[0] > 0.0),
            "the path is felt"
        );
        for (tick, expected) in expected.iter().chain(&expected).enumerate() {
            engine.advance_ticks(1);
            assert_eq!(
                &amplitudes(engine.snapshot()),
                expected,
                "{method:?} tick {tick}"
            );
        }
    }
}

#[test]
fn a_recorded_live_exploration_replays_bit_for_bit() {
    let (mut engine, start) = engine(Method::Auto);
    engine.advance(start);
    engine.send(Command::StartRecording).unwrap();
    explore(&mut engine, start, 120);
    engine.send(Command::StopRecording).unwrap();
    engine.advance(start + TICK * 121);
    let recording = engine.take_recording().unwrap();
    assert_eq!(recording.ticks().len(), 120);

    let csv = recording.to_path().unwrap().to_csv().unwrap();
    let path = ExplorationPath::from_csv(&csv, std::path::Path::new("live.csv")).unwrap();
    let replayed = offline(&path, Method::Auto);
    assert_eq!(replayed.len(), 120);
    let mut n_felt = 0;
    for (n, expected) in replayed.iter().enumerate() {
        assert_eq!(recording.amplitudes_um(n), expected, "tick {n}");
        n_felt += usize::from(expected.iter().any(|a| a[0] > 0.0));
        assert_eq!(path.rows()[n].t_s, n as f64 / 40.0);
    }
    assert!(n_felt > 100, "{n_felt} ticks are felt");
    assert!(
        recording
            .ticks()
            .iter()
            .any(|tick| tick.pose.angular_rad_per_s != 0.0),
        "it turned"
    );
}

#[test]
fn a_recording_that_begins_in_a_turn_and_crosses_a_loop_replays_too() {
    let (mut engine, _) = engine(Method::Banded);
    engine
        .send(Command::SetSource(InputSource::Replay(path())))
        .unwrap();
    engine.send(Command::SetLoop(true)).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(20);
    engine.send(Command::StartRecording).unwrap();
    engine.advance_ticks(150);
    engine.send(Command::Pause).unwrap();
    engine.advance_ticks(10);
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(10);
    engine.send(Command::StopRecording).unwrap();
    engine.advance_ticks(1);
    let recording = engine.take_recording().unwrap();
    assert_eq!(recording.ticks().len(), 160, "what is held is not recorded");
    for (n, expected) in offline(&recording.to_path().unwrap(), Method::Banded)
        .iter()
        .enumerate()
    {
        assert_eq!(recording.amplitudes_um(n), expected, "tick {n}");
    }
}

#[test]
fn still_finger_is_silent() {
    let (mut engine, start) = engine(Method::Auto);
    explore(&mut engine, start, 20);
    assert!(!is_silent(engine.snapshot()), "it moves");
    assert!(engine.snapshot().pointer.age.is_some());
    // The mouse says nothing any more: at rest after 50 ms.
    engine.advance(start + TICK * 23);
    let snapshot = engine.snapshot();
    assert!(is_silent(snapshot), "it rests");
    assert_eq!(snapshot.pose.velocity, Velocity::ZERO);
    assert_eq!(snapshot.pointer.age, None);
    assert!(
        snapshot.displays[0]
            .contactors
            .iter()
            .all(|c| c.textile == Some(0)),
        "on the cloth"
    );
}

#[test]
fn the_first_tick_after_a_clock_jump_is_silent_and_the_next_is_not() {
    let (mut engine, start) = engine(Method::Auto);
    let mut pointer = engine.take_pointer().unwrap();
    let mut felt = Vec::new();
    for n in 0..40_u32 {
        for k in 0..3 {
            let since = TICK * n + Duration::from_millis(8) * k;
            let jump = if n < 20 {
                Duration::ZERO
            } else {
                Duration::from_hours(1)
            };
            let position = Point::new(40.0 + since.as_secs_f64() * 50.0, 60.0);
            pointer.push(PointerSample {
                stamp: start + jump + since,
                position,
            });
        }
        engine.advance(start + TICK * (n + 1));
        felt.push(!is_silent(engine.snapshot()));
    }
    let silent: Vec<usize> = (0..40).filter(|n| !felt[*n]).collect();
    // The very first tick begins a series, too.
    assert_eq!(silent, [0, 20]);
    assert_eq!(engine.snapshot().pointer.samples.clock_jumps, 1);
}

#[test]
fn felt_age_counts_from_the_stamp_to_the_middle_of_the_tick() {
    let (mut engine, start) = engine(Method::Auto);
    let mut pointer = engine.take_pointer().unwrap();
    pointer.push(PointerSample {
        stamp: start,
        position: Point::new(50.0, 50.0),
    });
    let now = start + Duration::from_millis(7);
    engine.advance(now);
    let pointer = engine.snapshot().pointer;
    assert_eq!(pointer.age, Some(Duration::from_millis(7)));
    assert_eq!(pointer.felt_age, Some(Duration::from_micros(19_500)));
}

#[test]
fn the_switch_silences_holds_and_ends_until_armed_again() {
    let (mut engine, _) = engine(Method::Auto);
    engine
        .send(Command::SetSource(InputSource::Replay(path())))
        .unwrap();
    engine.send(Command::Play).unwrap();
    engine.send(Command::StartRecording).unwrap();
    engine.advance_ticks(10);
    assert!(!is_silent(engine.snapshot()), "it plays");
    // An arm that was on its way when the switch was pressed is void.
    engine.send(Command::Arm).unwrap();
    engine.stop_switch().press();
    engine.advance_ticks(5);
    let snapshot = engine.snapshot();
    assert!(
        snapshot.is_stopped && snapshot.is_silent && is_silent(snapshot),
        "{snapshot:?}"
    );
    assert!(!snapshot.playback.is_playing && !snapshot.recording.is_recording);
    assert_eq!(engine.take_recording().unwrap().ticks().len(), 10);
    let notices: Vec<String> = std::iter::from_fn(|| engine.next_notice())
        .map(|n| format!("{n:?}"))
        .collect();
    assert!(
        notices[0].contains("Stopped") && notices[1].contains("arm again"),
        "{notices:?}"
    );

    engine.send(Command::Play).unwrap();
    engine.advance_ticks(3);
    assert!(
        is_silent(engine.snapshot()),
        "playing alone does not end the silence"
    );
    engine.send(Command::StartRecording).unwrap();
    engine.advance_ticks(1);
    assert!(
        engine.take_recording().unwrap().ticks().is_empty(),
        "nor is silence recorded"
    );
    engine.send(Command::Arm).unwrap();
    engine.advance_ticks(3);
    assert!(
        !engine.snapshot().is_stopped && !is_silent(engine.snapshot()),
        "armed: felt again"
    );
}

#[test]
fn a_held_replay_shows_its_moment_and_plays_silence() {
    let (mut engine, _) = engine(Method::Auto);
    let path = path();
    let expected = offline(&path, Method::Auto);
    engine
        .send(Command::SetSource(InputSource::Replay(path)))
        .unwrap();
    for (n, expected) in expected.iter().enumerate().take(5) {
        engine.send(Command::Step).unwrap();
        engine.advance_ticks(1);
        assert!(!engine.snapshot().is_silent, "a step is felt");
        engine.advance_ticks(7);
        let snapshot = engine.snapshot();
        assert_eq!(&amplitudes(snapshot), expected);
        assert!(snapshot.is_silent && !snapshot.playback.is_playing);
        assert_eq!(snapshot.playback.tick, n as u64);
    }
}

#[test]
fn two_runs_give_the_same_snapshots() {
    let run = || {
        let start = Instant::now();
        let mut engine = Engine::without_thread(config(Method::Auto), start).unwrap();
        explore(&mut engine, start, 60);
        let snapshot = engine.snapshot().clone();
        format!(
            "{:?}",
            Snapshot {
                scene_serial: 0,
                ..snapshot
            }
        )
    };
    assert_eq!(run(), run());
}

#[test]
fn senseless_gains_angles_and_methods_are_ignored_with_a_notice() {
    let (mut engine, _) = engine(Method::Auto);
    let tuning = Tuning {
        gain_db: f64::NAN,
        ..Tuning::default()
    };
    engine.send(Command::SetTuning(tuning)).unwrap();
    engine
        .send(Command::SetTextileGain {
            textile: 0,
            gain_db: f64::INFINITY,
        })
        .unwrap();
    engine
        .send(Command::SetTextileGain {
            textile: 9,
            gain_db: 0.0,
        })
        .unwrap();
    engine.send(Command::SetLevels(vec![])).unwrap();
    engine.send(Command::SetAngle(f64::NAN)).unwrap();
    let method = VelocityMethod::LineFit { window_s: f64::NAN };
    engine.send(Command::SetVelocityMethod(method)).unwrap();
    engine.advance_ticks(1);
    assert_eq!(engine.snapshot().counters.ignored, 6);
    assert_eq!(engine.snapshot().tuning, Tuning::default());
    assert_eq!(std::iter::from_fn(|| engine.next_notice()).count(), 6);
    let circle = Stroke::Circle {
        centre: Point::default(),
        radius_mm: 0.0,
        speed_mm_per_s: 1.0,
    };
    let refused = engine.send(Command::SetSource(InputSource::Stroke(circle)));
    assert!(matches!(refused, Err(EngineError::Scene(_))), "{refused:?}");
}

#[test]
fn gains_change_at_a_tick_and_scale_what_is_felt() {
    let (mut engine, _) = engine(Method::Auto);
    let line = Stroke::Line {
        start: Point::new(40.0, 60.0),
        end: Point::new(60.0, 70.0),
        speed_mm_per_s: 0.0,
    };
    engine
        .send(Command::SetSource(InputSource::Stroke(line)))
        .unwrap();
    engine
        .send(Command::SetSource(InputSource::Replay(path())))
        .unwrap();
    engine.send(Command::Step).unwrap();
    engine.send(Command::Step).unwrap();
    engine.advance_ticks(2);
    engine.send(Command::Step).unwrap();
    engine.advance_ticks(1);
    let before = amplitudes(engine.snapshot());
    // While the replay is held its moment is shown with the gains of now.
    engine
        .send(Command::SetTuning(Tuning {
            gain_db: -20.0,
            ..Tuning::default()
        }))
        .unwrap();
    engine
        .send(Command::SetTextileGain {
            textile: 0,
            gain_db: 14.0,
        })
        .unwrap();
    engine.advance_ticks(1);
    for (before, after) in before.iter().zip(amplitudes(engine.snapshot())) {
        assert!(
            (after[0] - before[0] * 0.501_187).abs() < 1e-4,
            "{before:?} {after:?}"
        );
    }
}

#[test]
fn limits_that_bite_are_shown_by_contactor() {
    let (mut engine, start) = engine(Method::Auto);
    engine
        .send(Command::SetTuning(Tuning {
            gain_db: 60.0,
            ..Tuning::default()
        }))
        .unwrap();
    explore(&mut engine, start, 10);
    let contactors = &engine.snapshot().displays[0].contactors;
    assert!(
        contactors.iter().all(|contactor| contactor.bite.limited[0]),
        "{contactors:?}"
    );
}

#[test]
fn another_scene_brings_snapshots_of_its_size_and_ends_the_recording() {
    let (mut engine, _) = engine(Method::Auto);
    engine.send(Command::StartRecording).unwrap();
    engine.advance_ticks(4);
    let offsets = vec![Displacement::default(); 100];
    let scene = Box::new(prepared(offsets, Method::Table));
    let serial = scene.serial();
    engine.send(Command::SetScene(scene)).unwrap();
    assert_eq!(
        engine.snapshot().displays[0].contactors.len(),
        24,
        "not before a tick"
    );
    engine.advance_ticks(1);
    let snapshot = engine.snapshot();
    assert_eq!(
        (snapshot.displays[0].contactors.len(), snapshot.scene_serial),
        (100, serial)
    );
    assert_eq!(engine.take_recording().unwrap().ticks().len(), 4);
}

#[test]
fn a_full_queue_refuses_and_a_stop_does_not_wait_for_it() {
    let (mut engine, _) = engine(Method::Auto);
    let mut n_sent = 0;
    while engine.send(Command::Rewind).is_ok() {
        n_sent += 1;
    }
    assert_eq!(n_sent, 64);
    assert!(matches!(engine.send(Command::Play), Err(EngineError::Busy)));
    engine.send(Command::StopAll).unwrap();
    engine.advance_ticks(1);
    assert!(engine.snapshot().is_stopped, "the stop was heard");
    engine.send(Command::Play).unwrap();
}

#[test]
fn many_scenes_at_once_are_obeyed_as_what_they_replace_is_taken_back() {
    let (mut engine, _) = engine(Method::Auto);
    let mut last = 0;
    for _ in 0..10 {
        let scene = prepared(exeter(), Method::Banded);
        last = scene.serial();
        engine.send(Command::SetScene(Box::new(scene))).unwrap();
    }
    engine.advance_ticks(20);
    assert_eq!(engine.snapshot().scene_serial, last);
}

#[test]
fn a_stream_of_lines_moves_the_display_and_ends_with_a_notice() {
    let (mut engine, _) = engine(Method::Auto);
    let lines = Cursor::new("nonsense\n42,43\n44,45\n");
    engine
        .send(Command::SetSource(InputSource::Lines(Box::new(lines))))
        .unwrap();
    let mut has_ended = false;
    for _ in 0..10_000 {
        engine.advance_ticks(1);
        has_ended |= matches!(engine.next_notice(), Some(Notice::SourceEnded));
        if has_ended {
            break;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(has_ended, "the stream ends");
    let snapshot = engine.snapshot();
    assert_eq!(snapshot.pose.position, Point::new(44.0, 45.0));
    assert_eq!(
        (snapshot.pointer.samples.bad_lines, snapshot.source),
        (1, SourceKind::Lines)
    );
}

#[test]
fn nothing_changing_is_no_news() {
    let n_news = Arc::new(AtomicU64::new(0));
    let heard = Arc::clone(&n_news);
    let on_news = move || {
        heard.fetch_add(1, Ordering::SeqCst);
    };
    let config = EngineConfig {
        on_news: Some(Box::new(on_news)),
        ..config(Method::Auto)
    };
    let mut engine = Engine::without_thread(config, Instant::now()).unwrap();
    let settle = || std::thread::sleep(Duration::from_millis(50));
    engine.advance_ticks(2);
    settle();
    let before = n_news.load(Ordering::SeqCst);
    assert!(before > 0, "the first snapshot is news");
    engine.advance_ticks(200);
    settle();
    assert_eq!(n_news.load(Ordering::SeqCst), before);
    engine.send(Command::SetAngle(10.0)).unwrap();
    engine.advance_ticks(1);
    settle();
    assert!(
        n_news.load(Ordering::SeqCst) > before,
        "a turned display is news"
    );
}

#[test]
fn a_pose_that_a_recording_may_hold_is_always_finite() {
    let (mut engine, start) = engine(Method::Auto);
    let mut pointer = engine.take_pointer().unwrap();
    engine.send(Command::StartRecording).unwrap();
    for n in 0..20_u32 {
        let stamp = start + TICK * n;
        let x_mm = if n % 2 == 0 { 1e308 } else { -1e308 };
        pointer.push(PointerSample {
            stamp,
            position: Point::new(x_mm, f64::NAN),
        });
        pointer.push(PointerSample {
            stamp,
            position: Point::new(x_mm, 0.0),
        });
        engine.advance(stamp);
        assert!(
            is_silent(engine.snapshot()),
            "beyond any speed that is felt"
        );
    }
    engine.send(Command::StopRecording).unwrap();
    engine.advance(start + TICK * 20);
    assert!(engine.take_recording().unwrap().to_path().is_ok());
    assert_eq!(engine.snapshot().pointer.samples.not_finite, 20);
}

#[test]
fn poses_of_a_live_exploration_turn_as_the_display_does() {
    let (mut engine, start) = engine(Method::Auto);
    engine.advance(start);
    engine.send(Command::SetAngle(9.0)).unwrap();
    engine.advance(start + TICK);
    let turning = engine.snapshot().pose.angular_rad_per_s;
    assert_eq!(turning, Pose::turning_rad_per_s(0.0, 9.0));
    engine.advance(start + TICK * 2);
    assert_eq!(engine.snapshot().pose.angular_rad_per_s, 0.0);
}
