//! Fingers that hold displays of their own, and displays that follow the first.

use super::*;
use crate::input::feed;
use selvedge_render::array::DisplayFrame;
use selvedge_render::{Counters, Replay, replay};
use std::ops::ControlFlow;

/// The same cloth under so many displays of the same shape.
pub(super) fn with_displays(n_displays: usize) -> (Engine, PointerSender, Instant) {
    let mut scene = render_scene(exeter());
    scene.displays = vec![scene.displays[0].clone(); n_displays];
    let how = (Method::Auto, &Accuracy::default());
    let start_at = Point::new(30.0, 60.0);
    let profile = ArrayProfile::default();
    let scene = PreparedScene::from_parts(&scene, profile, start_at, how).unwrap();
    let start = Instant::now();
    let config = EngineConfig {
        scene,
        on_news: None,
    };
    let mut engine = Engine::without_thread(config, start).unwrap();
    let pointer = engine.take_pointer().unwrap();
    (engine, pointer, start)
}

/// Where a finger is that strokes along a line of its own.
fn at(finger: usize, t_s: f64) -> Point {
    let (phase, y_mm) = [(0.0, 50.0), (1.0, 70.0), (2.0, 80.0)][finger];
    Point::new(45.0 + 12.0 * (4.0 * t_s + phase).sin(), y_mm + 8.0 * t_s)
}

/// Hands over what a finger does from one tick to the next, every 8 ms.
pub(super) fn stroke(
    pointer: &mut PointerSender,
    (display, finger): (usize, usize),
    start: Instant,
    n: u32,
) {
    for k in 0..3 {
        let since = TICK * n + Duration::from_millis(8) * k;
        let (stamp, position) = (start + since, at(finger, since.as_secs_f64()));
        pointer.push_to(display, PointerSample { stamp, position });
    }
}

fn of_display(snapshot: &Snapshot, display: usize) -> Vec<[f32; 2]> {
    let contactors = &snapshot.displays[display].contactors;
    contactors.iter().map(|c| c.amplitude_um).collect()
}

fn sounds(amplitudes_um: &[[f32; 2]]) -> bool {
    amplitudes_um.iter().any(|um| *um != [0.0; 2])
}

/// What one finger alone feels tick for tick, and what was evaluated for it.
fn alone(finger: usize, n_ticks: u32) -> (Vec<Vec<[f32; 2]>>, Counters) {
    let (mut engine, mut pointer, start) = with_displays(1);
    let felt = (0..n_ticks).map(|n| {
        stroke(&mut pointer, (0, finger), start, n);
        engine.advance(start + TICK * (n + 1));
        amplitudes(engine.snapshot())
    });
    (felt.collect(), engine.snapshot().rendering.counters)
}

#[test]
fn displays_that_no_finger_holds_follow_the_first() {
    let (expected, counters) = alone(0, 40);
    let (mut engine, mut pointer, start) = with_displays(2);
    for (n, expected) in (0..).zip(&expected) {
        stroke(&mut pointer, (0, 0), start, n);
        engine.advance(start + TICK * (n + 1));
        let snapshot = engine.snapshot();
        assert_eq!(&of_display(snapshot, 0), expected, "tick {n}");
        assert_eq!(&of_display(snapshot, 1), expected, "tick {n}");
        assert_eq!(snapshot.displays[1].pose, snapshot.pose);
    }
    let both = engine.snapshot().rendering.counters;
    assert_eq!(both.ticks, counters.ticks);
    assert_eq!(both.contactors_inside, 2 * counters.contactors_inside);
    assert!(expected.iter().filter(|um| sounds(um)).count() > 30);
}

#[test]
fn every_finger_feels_as_if_it_were_alone() {
    let expected = [alone(0, 40).0, alone(1, 40).0, alone(2, 40).0];
    let (mut engine, mut pointer, start) = with_displays(3);
    for n in 0..40 {
        for finger in 0..3 {
            stroke(&mut pointer, (finger, finger), start, n);
        }
        engine.advance(start + TICK * (n + 1));
        for (finger, expected) in expected.iter().enumerate() {
            let felt = of_display(engine.snapshot(), finger);
            let tick = usize::try_from(n).unwrap();
            assert_eq!(felt, expected[tick], "finger {finger}, tick {n}");
        }
    }
    let samples = engine.snapshot().pointer.samples;
    assert_eq!(samples.accepted, 3 * 3 * 40, "all are counted");
}

#[test]
fn a_finger_without_a_display_changes_nothing() {
    let (expected, counters) = alone(0, 30);
    let (mut engine, mut pointer, start) = with_displays(1);
    for (n, expected) in (0..).zip(&expected) {
        stroke(&mut pointer, (0, 0), start, n);
        stroke(&mut pointer, (1, 1), start, n);
        stroke(&mut pointer, (usize::MAX, 2), start, n);
        engine.advance(start + TICK * (n + 1));
        assert_eq!(&amplitudes(engine.snapshot()), expected, "tick {n}");
    }
    let snapshot = engine.snapshot();
    assert_eq!(
        format!("{counters:?}"),
        format!("{:?}", snapshot.rendering.counters)
    );
    assert_eq!(snapshot.pointer.samples.accepted, 90);
}

#[test]
fn a_display_whose_finger_is_lifted_is_silent_where_it_was_and_the_other_goes_on() {
    for lifted in [0, 1] {
        let other = 1 - lifted;
        let (mut engine, mut pointer, start) = with_displays(2);
        for n in 0..12 {
            (0..2).for_each(|finger| stroke(&mut pointer, (finger, finger), start, n));
            engine.advance(start + TICK * (n + 1));
        }
        let before = engine.snapshot().displays[lifted].pose;
        pointer.lift(lifted);
        for n in 12..24 {
            stroke(&mut pointer, (other, other), start, n);
            engine.advance(start + TICK * (n + 1));
            let snapshot = engine.snapshot();
            assert!(!sounds(&of_display(snapshot, lifted)), "{lifted} at {n}");
            assert!(sounds(&of_display(snapshot, other)), "{other} at {n}");
            assert_eq!(snapshot.displays[lifted].pose.position, before.position);
        }
        // It touches far from there: no velocity spans the air.
        for n in 24..28 {
            stroke(&mut pointer, (lifted, 2), start, n);
            stroke(&mut pointer, (other, other), start, n);
            engine.advance(start + TICK * (n + 1));
            let speed = engine.snapshot().displays[lifted].pose.velocity;
            assert!(speed.speed_mm_per_s() < 100.0, "{speed:?} at {n}");
        }
        assert!(sounds(&of_display(engine.snapshot(), lifted)), "felt again");
    }
}

#[test]
fn a_display_that_was_never_touched_is_silent_once_fingers_are_apart() {
    let (mut engine, mut pointer, start) = with_displays(3);
    for n in 0..10 {
        stroke(&mut pointer, (0, 0), start, n);
        engine.advance(start + TICK * (n + 1));
    }
    let parted = engine.snapshot().pose.position;
    for n in 10..20 {
        stroke(&mut pointer, (0, 0), start, n);
        stroke(&mut pointer, (1, 1), start, n);
        engine.advance(start + TICK * (n + 1));
        let snapshot = engine.snapshot();
        assert!(!sounds(&of_display(snapshot, 2)), "tick {n}");
        assert_eq!(snapshot.displays[2].pose.position, parted);
    }
}

#[test]
fn another_source_or_scene_brings_them_together() {
    let (mut engine, mut pointer, start) = with_displays(2);
    let mut n = 0;
    let mut go_on = |engine: &mut Engine, pointer: &mut PointerSender, fingers: usize| {
        for _ in 0..6 {
            (0..fingers).for_each(|finger| stroke(pointer, (finger, finger), start, n));
            n += 1;
            engine.advance(start + TICK * n);
        }
        let [first, second] = [0, 1].map(|nth| engine.snapshot().displays[nth].pose);
        first.position == second.position
    };
    assert!(go_on(&mut engine, &mut pointer, 1));
    assert!(!go_on(&mut engine, &mut pointer, 2), "apart");
    assert!(!go_on(&mut engine, &mut pointer, 1), "they stay so");
    let pointed = Command::SetSource(InputSource::Pointer);
    engine.send(pointed).unwrap();
    assert!(go_on(&mut engine, &mut pointer, 1), "another source");
    assert!(!go_on(&mut engine, &mut pointer, 2));
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    assert!(go_on(&mut engine, &mut pointer, 2), "a replay moves both");
}

#[test]
fn all_off_silences_every_finger_and_a_clock_that_jumps_one_of_them() {
    let (mut engine, mut pointer, start) = with_displays(2);
    let jump = Duration::from_hours(1);
    for n in 0..12 {
        stroke(&mut pointer, (0, 0), start, n);
        let ahead = if n < 8 { Duration::ZERO } else { jump };
        for k in 0..3 {
            let since = TICK * n + Duration::from_millis(8) * k;
            let (stamp, position) = (start + ahead + since, at(1, since.as_secs_f64()));
            pointer.push_to(1, PointerSample { stamp, position });
        }
        engine.advance(start + TICK * (n + 1));
        let snapshot = engine.snapshot();
        let heard = [0, 1].map(|nth| sounds(&of_display(snapshot, nth)));
        assert_eq!(heard, [n > 0, n > 0 && n != 8], "tick {n}");
    }
    engine.send(Command::StopAll).unwrap();
    stroke(&mut pointer, (0, 0), start, 12);
    stroke(&mut pointer, (1, 1), start, 12);
    engine.advance(start + TICK * 13);
    let snapshot = engine.snapshot();
    assert!((0..2).all(|nth| !sounds(&of_display(snapshot, nth))));
}

#[test]
fn samples_of_ticks_tell_of_all_displays_and_more_of_the_one_that_is_watched() {
    for watched in [0, 1] {
        let (mut engine, mut pointer, start) = with_displays(2);
        engine.send(Command::SampleTicks(true)).unwrap();
        engine.send(Command::WatchDisplay(watched)).unwrap();
        engine.send(Command::Watch(5)).unwrap();
        for n in 0..10 {
            // The first rests; a finger moves the second alone.
            stroke(&mut pointer, (1, 1), start, n);
            engine.advance(start + TICK * (n + 1));
            let (all_poses, all_um) = {
                let snapshot = engine.snapshot();
                let poses = [0, 1].map(|nth| snapshot.displays[nth].pose);
                (poses, [0, 1].map(|nth| of_display(snapshot, nth)))
            };
            let (sample, um, poses) = engine.next_felt_tick().unwrap();
            assert_eq!((um, poses), (&all_um.concat()[..], &all_poses[..]), "{n}");
            assert_eq!(sample.pose, all_poses[watched], "tick {n}");
            assert_eq!(sample.watched_um, all_um[watched][5]);
            let first = usize::try_from(sample.first_contactor).unwrap();
            let own = first..first + usize::try_from(sample.n_contactors).unwrap();
            assert_eq!(um[own], all_um[watched]);
            assert!(n == 0 || sounds(&all_um[1]) && !sounds(&all_um[0]));
        }
        pointer.lift(1);
        (11..20).for_each(|n| engine.advance(start + TICK * n));
        let n_after = std::iter::from_fn(|| engine.next_tick_sample()).count();
        assert!(
            (1..=2).contains(&n_after),
            "{n_after}: all rest and are silent"
        );
    }
}

#[test]
fn fingers_of_a_touch_frame_that_is_read_directly_hold_displays_of_their_own() {
    let expected = [alone(0, 30).0, alone(1, 30).0];
    let (mut engine, _pointer, start) = with_displays(2);
    let (mut sender, input) = feed(SourceKind::Device);
    let source = InputSource::Live(Box::new(input));
    engine.send(Command::SetSource(source)).unwrap();
    for n in 0..36 {
        for finger in 0..2 {
            for k in 0..3 {
                let since = TICK * n + Duration::from_millis(8) * k;
                let (stamp, position) = (start + since, at(finger, since.as_secs_f64()));
                let sample = PointerSample { stamp, position };
                match n {
                    0..30 => sender.push_of(finger, Some(sample)),
                    30 if finger == 1 => sender.push_of(1, None),
                    _ if finger == 0 => sender.push_of(0, Some(sample)),
                    _ => {}
                }
            }
        }
        engine.advance(start + TICK * (n + 1));
        let snapshot = engine.snapshot();
        let tick = usize::try_from(n).unwrap();
        for (finger, expected) in expected.iter().enumerate() {
            let felt = of_display(snapshot, finger);
            match expected.get(tick) {
                Some(expected) => assert_eq!(felt, *expected, "finger {finger}, tick {n}"),
                None => assert_eq!(sounds(&felt), finger == 0, "the second was lifted"),
            }
        }
    }
}

/// Two fingers for 60 ticks, of which the second comes later, is lifted once and the display
/// turns: as it was recorded.
fn two_recorded() -> (Engine, Recording) {
    let (mut engine, mut pointer, start) = with_displays(2);
    engine.advance(start);
    let mut recording = engine.record().unwrap();
    for n in 0..60 {
        stroke(&mut pointer, (0, 0), start, n);
        match n {
            10..30 | 40.. => stroke(&mut pointer, (1, 1), start, n),
            30 => assert!(pointer.lift(1)),
            _ => {}
        }
        let turn = Command::TurnBy(if (20..50).contains(&n) { 0.7 } else { 0.0 });
        engine.send(turn).unwrap();
        engine.advance(start + TICK * (n + 1));
    }
    engine.send(Command::StopRecording).unwrap();
    engine.advance(start + TICK * 61);
    recording.collect();
    assert_eq!(recording.ticks().len(), 60);
    let felt = (0..60).filter(|n| sounds(&recording.amplitudes_um(*n)[24..]));
    assert!(felt.count() > 35, "the second display is felt");
    let apart = (0..60).filter(|n| {
        let [first, second] = recording.amplitudes_um(*n).split_at(24).into();
        first != second
    });
    assert!(apart.count() > 40, "it feels something else");
    (engine, recording)
}

#[test]
fn a_recording_of_two_fingers_replays_bit_for_bit_from_its_file_in_the_engine_and_without() {
    let (mut engine, recording) = two_recorded();
    let csv = recording.to_path().unwrap().to_csv().unwrap();
    let path = ExplorationPath::from_csv(&csv, std::path::Path::new("two.csv")).unwrap();
    assert_eq!(path, recording.to_path().unwrap());
    let mut scene = render_scene(exeter());
    scene.displays = vec![scene.displays[0].clone(); 2];
    let what = Replay {
        scene: &scene,
        method: Method::Auto,
        accuracy: Accuracy::default(),
        measures_error: false,
    };
    let mut n_ticks = 0;
    replay(&what, &path, &mut || 0, &mut |tick, _, frames| {
        let felt: Vec<_> = frames
            .iter()
            .flat_map(DisplayFrame::amplitudes_um)
            .collect();
        let expected = recording.amplitudes_um(usize::try_from(tick).unwrap());
        assert!(expected.iter().eq(felt), "tick {tick}");
        n_ticks += 1;
        ControlFlow::Continue(())
    })
    .unwrap();
    assert_eq!(n_ticks, 60);
    let source = InputSource::Replay(Arc::new(path));
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Play).unwrap();
    let felt_at = |engine: &mut Engine, n: usize| {
        engine.advance_ticks(1);
        let snapshot = engine.snapshot();
        let felt = [0, 1].map(|display| of_display(snapshot, display)).concat();
        assert_eq!(felt, recording.amplitudes_um(n), "tick {n}");
        assert_eq!(
            snapshot.displays[1].pose.position,
            recording.others(n)[0].position
        );
    };
    (0..60).for_each(|n| felt_at(&mut engine, n));
    engine.advance_ticks(1);
    let ended = [0, 1].map(|display| of_display(engine.snapshot(), display));
    assert!(!ended.iter().any(|felt| sounds(felt)), "over");
    for tick in [45, 15, 33, 5] {
        engine.send(Command::Seek(tick)).unwrap();
        felt_at(&mut engine, usize::try_from(tick).unwrap());
    }
}
