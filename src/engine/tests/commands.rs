//! What commands and the stop switch do, and what is news.

use std::sync::atomic::Ordering;

use super::*;

#[test]
fn the_switch_silences_holds_and_ends_until_armed_again() {
    let (mut engine, _) = engine(Method::Auto);
    engine
        .send(Command::SetSource(InputSource::Replay(path())))
        .unwrap();
    engine.send(Command::Play).unwrap();
    let mut recording = engine.record().unwrap();
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
    recording.collect();
    assert!(recording.has_ended() && recording.ticks().len() == 10);
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
    let mut recording = engine.record().unwrap();
    engine.advance_ticks(1);
    engine.send(Command::StopRecording).unwrap();
    engine.advance_ticks(1);
    recording.collect();
    let [shown] = recording.ticks() else {
        panic!("one tick: {recording:?}")
    };
    assert!(shown.sent.is_none(), "it was shown and not felt");
    assert!(shown.pose.velocity.speed_mm_per_s() > 0.0, "it moved");
    assert!(recording.amplitudes_um(0).iter().all(|um| *um == [0.0; 2]));
    engine.send(Command::Arm).unwrap();
    engine.advance_ticks(3);
    assert!(
        !engine.snapshot().is_stopped && !is_silent(engine.snapshot()),
        "armed: felt again"
    );
}

#[test]
fn without_a_device_the_gentle_press_leaves_the_screen_alone_and_voids_an_arm_on_its_way() {
    let (mut engine, _) = engine(Method::Auto);
    engine
        .send(Command::SetSource(InputSource::Replay(path())))
        .unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(10);
    engine.send(Command::Arm).unwrap();
    engine.stop_switch().press_if_armed();
    engine.advance_ticks(5);
    let snapshot = engine.snapshot();
    assert!(!snapshot.is_stopped && snapshot.playback.is_playing);
    assert!(!is_silent(snapshot), "it goes on");
    let notices: Vec<String> = std::iter::from_fn(|| engine.next_notice())
        .map(|n| format!("{n:?}"))
        .collect();
    assert!(
        notices.len() == 1 && notices[0].contains("arm again"),
        "{notices:?}"
    );
    engine.stop_switch().press();
    engine.advance_ticks(1);
    assert!(engine.snapshot().is_stopped, "the full press does stop it");
    engine.send(Command::Resume).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(3);
    assert!(!engine.snapshot().is_stopped && !is_silent(engine.snapshot()));
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
        .send(Command::SetGains {
            tuning: Tuning::default(),
            textiles_db: vec![(0, f64::INFINITY)],
        })
        .unwrap();
    engine
        .send(Command::SetGains {
            tuning: Tuning {
                gain_db: -6.0,
                ..Tuning::default()
            },
            textiles_db: vec![(9, 0.0)],
        })
        .unwrap();
    engine.send(Command::SetLevels(vec![])).unwrap();
    engine.send(Command::SetAngle(f64::NAN)).unwrap();
    engine.advance_ticks(1);
    assert_eq!(engine.snapshot().counters.ignored, 5);
    assert_eq!(engine.snapshot().rendering.tuning, Tuning::default());
    assert_eq!(std::iter::from_fn(|| engine.next_notice()).count(), 5);
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
        .send(Command::SetGains {
            tuning: Tuning {
                gain_db: -20.0,
                ..Tuning::default()
            },
            textiles_db: vec![(0, 14.0)],
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
        contactors
            .iter()
            .all(|contactor| contactor.limiter.limited[0]),
        "{contactors:?}"
    );
}

#[test]
fn a_stroke_turns_as_it_is_told_and_a_replay_has_its_own_angles() {
    let (mut engine, _) = engine(Method::Auto);
    let stroke = Stroke::Circle {
        centre: Point::new(50.0, 60.0),
        radius_mm: 10.0,
        speed_mm_per_s: 80.0,
    };
    let source = InputSource::Stroke(stroke);
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(1);
    let mut turns = Vec::new();
    for _ in 0..3 {
        engine.send(Command::TurnBy(5.0)).unwrap();
        engine.advance_ticks(1);
        let snapshot = engine.snapshot();
        turns.push((snapshot.turn_deg, snapshot.pose.angle_deg));
        let expected = 5.0_f64.to_radians() * 40.0;
        assert!((snapshot.pose.angular_rad_per_s - expected).abs() < 1e-12);
    }
    assert_eq!(turns, [(5.0, 5.0), (10.0, 10.0), (15.0, 15.0)]);
    engine.advance_ticks(1);
    let expected = Pose {
        angle_deg: 15.0,
        ..stroke.pose_at(4.0 / 40.0)
    };
    assert_eq!(engine.snapshot().pose, expected, "it turned no further");
    // Turned while it is held, it is shown turned and does not whirl when it goes on.
    engine.send(Command::Pause).unwrap();
    engine.send(Command::SetAngle(90.0)).unwrap();
    engine.advance_ticks(2);
    assert_eq!(engine.snapshot().pose.angle_deg, 90.0);
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(1);
    let pose = engine.snapshot().pose;
    assert_eq!((pose.angle_deg, pose.angular_rad_per_s), (90.0, 0.0));

    let path = path();
    let source = InputSource::Replay(Arc::clone(&path));
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Play).unwrap();
    for (_, pose) in path.ticks().take(5) {
        engine.send(Command::TurnBy(1.0)).unwrap();
        engine.advance_ticks(1);
        assert_eq!(engine.snapshot().pose, pose);
    }
    assert_eq!(engine.snapshot().turn_deg, 95.0);
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
fn nothing_changing_is_no_news() {
    let (config, n_news) = config_counting_news(Method::Auto);
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
fn a_panic_anywhere_in_the_process_presses_the_switch() {
    let (mut engine, _) = engine(Method::Auto);
    engine.stop_switch().press_on_panic();
    let panics = || panic!("on purpose: any thread of the process");
    let thread = std::thread::Builder::new()
        .name("clumsy".to_owned())
        .spawn(panics)
        .unwrap();
    assert!(thread.join().is_err());
    engine.advance_ticks(1);
    assert!(engine.snapshot().is_stopped);
}

#[test]
fn dropping_a_running_engine_ends_its_threads() {
    let news = Arc::new(());
    let held = Arc::clone(&news);
    let on_news: Box<dyn Fn() + Send> = Box::new(move || drop(Arc::clone(&held)));
    let mut engine = Engine::start(EngineConfig {
        on_news: Some(on_news),
        ..config(Method::Auto)
    })
    .unwrap();
    while engine.snapshot().tick < 3 {
        std::thread::sleep(Duration::from_millis(5));
    }
    drop(engine);
    assert_eq!(
        Arc::strong_count(&news),
        1,
        "the listener is gone, and its thread with it"
    );
}

#[test]
fn tuning_and_gains_of_textiles_change_in_one_tick_or_not_at_all() {
    let (mut engine, _) = engine(Method::Auto);
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Seek(30)).unwrap();
    engine.advance_ticks(2);
    let before = amplitudes(engine.snapshot());
    assert!(before.iter().any(|um| um[0] > 0.0), "it is shown");
    let tuned = |gain_db| Tuning {
        gain_db,
        ..Tuning::default()
    };
    // They take each other back: a tick between the two would show one alone.
    let n_sent = engine.commands_sent();
    for (tuning, gain_db) in [(tuned(-20.0), 20.0), (tuned(20.0), -20.0)] {
        let textiles_db = vec![(0, gain_db)];
        let set = Command::SetGains {
            tuning,
            textiles_db,
        };
        engine.send(set).unwrap();
        engine.advance_ticks(1);
        assert_eq!(amplitudes(engine.snapshot()), before);
    }
    assert_eq!(engine.commands_sent(), n_sent + 2);
    let refused = Command::SetGains {
        tuning: tuned(-6.0),
        textiles_db: vec![(0, 6.0), (1, 0.0)],
    };
    engine.send(refused).unwrap();
    engine.advance_ticks(1);
    let snapshot = engine.snapshot();
    assert_eq!(amplitudes(snapshot), before, "no half of it");
    assert_eq!(
        (snapshot.rendering.tuning, snapshot.counters.ignored),
        (tuned(20.0), 1)
    );
}
