//! Replays and recordings are exact, and runs repeat.

use super::*;

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
    let mut recording = engine.record().unwrap();
    explore(&mut engine, start, 120);
    engine.send(Command::StopRecording).unwrap();
    engine.advance(start + TICK * 121);
    recording.collect();
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
    let mut recording = engine.record().unwrap();
    engine.advance_ticks(150);
    engine.send(Command::Pause).unwrap();
    engine.advance_ticks(10);
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(10);
    engine.send(Command::StopRecording).unwrap();
    engine.advance_ticks(1);
    recording.collect();
    assert_eq!(recording.ticks().len(), 160, "what is held is not recorded");
    for (n, expected) in offline(&recording.to_path().unwrap(), Method::Banded)
        .iter()
        .enumerate()
    {
        assert_eq!(recording.amplitudes_um(n), expected, "tick {n}");
    }
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
fn another_scene_brings_snapshots_of_its_size_and_ends_the_recording() {
    let (mut engine, _) = engine(Method::Auto);
    let mut recording = engine.record().unwrap();
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
    recording.collect();
    assert!(recording.has_ended() && recording.ticks().len() == 4);
}

#[test]
fn a_pose_that_a_recording_may_hold_is_always_finite() {
    let (mut engine, start) = engine(Method::Auto);
    let mut pointer = engine.take_pointer().unwrap();
    let mut recording = engine.record().unwrap();
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
    recording.collect();
    assert!(recording.to_path().is_ok());
    assert_eq!(engine.snapshot().pointer.samples.not_finite, 20);
}
