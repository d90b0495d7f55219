//! The engine as its owner sees it, in told time: replays, recordings, stops, limits.

mod array;
mod clip;
mod cloth;
mod commands;
mod device;
mod exact;
mod fingers;
mod headroom;
mod lift;
mod mask;
mod second;
mod seek;
mod sequence;
mod shown;
mod sound;
mod stylus;
mod tick_samples;
mod update;

use std::io::Cursor;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use super::*;
use selvedge_device::ArrayProfile;
use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation, Velocity};
use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::{ExplorationPath, Geometry, PathRow, Pose, Stroke};
use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
use selvedge_textile::surface::{Profile, ProfileSet, Surface};
use selvedge_textile::tactile::Tuning;

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
        scene_band_gains_db: [0.0; 2],
        within_mm: None,
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

/// The same, and how often its owner was told that there is news.
fn config_counting_news(method: Method) -> (EngineConfig, Arc<AtomicU64>) {
    let n_news = Arc::new(AtomicU64::new(0));
    let heard = Arc::clone(&n_news);
    let on_news = move || {
        heard.fetch_add(1, Ordering::SeqCst);
    };
    let config = EngineConfig {
        on_news: Some(Box::new(on_news)),
        ..config(method)
    };
    (config, n_news)
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

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(40))]

    #[test]
    fn no_samples_make_a_tick_fail_or_a_pose_or_an_amplitude_be_no_number(
        samples in proptest::collection::vec(
            (-4_000_000_i64..4_000_000, proptest::num::f64::ANY, proptest::num::f64::ANY),
            0..60,
        ),
        ticks in proptest::collection::vec(0_u64..100, 1..20),
    ) {
        // A day after the system's origin, so that every stamp exists.
        let mut now = Instant::now() + Duration::from_hours(24);
        let mut engine = Engine::without_thread(config(Method::Banded), now).unwrap();
        let mut pointer = engine.take_pointer().unwrap();
        let mut samples = samples.into_iter();
        for pause_ms in ticks {
            now += Duration::from_millis(pause_ms);
            for (offset_ms, x_mm, y_mm) in samples.by_ref().take(4) {
                let by = Duration::from_millis(offset_ms.unsigned_abs());
                let stamp = if offset_ms < 0 { now.checked_sub(by).unwrap() } else { now + by };
                pointer.push(PointerSample { stamp, position: Point::new(x_mm, y_mm) });
            }
            engine.advance(now);
            let snapshot = engine.snapshot();
            let pose = snapshot.pose;
            assert!(pose.position.is_finite() && pose.velocity.is_finite(), "{pose:?}");
            assert!(amplitudes(snapshot).iter().flatten().all(|a| a.is_finite() && *a >= 0.0));
        }
    }
}
