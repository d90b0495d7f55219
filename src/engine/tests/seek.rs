//! Going to a tick of a replay or a stroke.

use super::*;

fn replay() -> (Engine, Arc<ExplorationPath>, Vec<Vec<[f32; 2]>>) {
    let (mut engine, _) = engine(Method::Banded);
    let path = path();
    let felt = offline(&path, Method::Banded);
    let source = InputSource::Replay(Arc::clone(&path));
    engine.send(Command::SetSource(source)).unwrap();
    (engine, path, felt)
}

#[test]
fn a_held_replay_shows_the_tick_it_goes_to() {
    let (mut engine, path, felt) = replay();
    let last = path.n_ticks() - 1;
    for (wanted, tick) in [
        (40, 40),
        (3, 3),
        (0, 0),
        (last, last),
        (u64::MAX, last),
        (17, 17),
    ] {
        engine.send(Command::Seek(wanted)).unwrap();
        engine.advance_ticks(1);
        let snapshot = engine.snapshot();
        let expected = &felt[usize::try_from(tick).unwrap()];
        assert_eq!(&amplitudes(snapshot), expected, "tick {tick}");
        assert!(!snapshot.is_silent, "as a step is");
        assert_eq!(snapshot.playback.tick, tick);
        engine.advance_ticks(2);
        let snapshot = engine.snapshot();
        assert!(snapshot.is_silent && !snapshot.playback.is_playing);
        assert_eq!(&amplitudes(snapshot), expected);
    }
    engine.send(Command::Step).unwrap();
    engine.advance_ticks(1);
    assert_eq!(
        amplitudes(engine.snapshot()),
        felt[18],
        "a step goes on from there"
    );
}

#[test]
fn a_part_is_replayed_again_and_again() {
    let (mut engine, _, felt) = replay();
    engine.send(Command::SetLoop(true)).unwrap();
    engine.send(Command::LoopWithin(Some([20, 24]))).unwrap();
    engine.send(Command::Seek(18)).unwrap();
    engine.send(Command::Play).unwrap();
    let expected = [18, 19, 20, 21, 22, 23, 24, 20, 21, 22, 23, 24, 20];
    for tick in expected {
        engine.advance_ticks(1);
        let snapshot = engine.snapshot();
        assert_eq!(snapshot.playback.tick, tick);
        assert_eq!(amplitudes(snapshot), felt[usize::try_from(tick).unwrap()]);
    }
    engine.send(Command::LoopWithin(None)).unwrap();
    engine.advance_ticks(8);
    assert_eq!(engine.snapshot().playback.tick, 28, "it goes on");
}

#[test]
fn a_replay_that_plays_goes_on_from_the_tick_it_goes_to() {
    let (mut engine, _, felt) = replay();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(5);
    engine.send(Command::Seek(50)).unwrap();
    for expected in &felt[50..60] {
        engine.advance_ticks(1);
        assert_eq!(&amplitudes(engine.snapshot()), expected);
    }
    assert!(engine.snapshot().playback.is_playing);
}

#[test]
fn a_replay_that_ended_is_held_where_it_is_sent() {
    let (mut engine, path, felt) = replay();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(path.n_ticks() + 3);
    assert!(engine.snapshot().playback.has_ended);
    engine.send(Command::Seek(20)).unwrap();
    engine.advance_ticks(3);
    let playback = engine.snapshot().playback;
    assert!(!playback.has_ended && !playback.is_playing);
    assert_eq!(amplitudes(engine.snapshot()), felt[20]);
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(1);
    assert_eq!(amplitudes(engine.snapshot()), felt[21]);
}

#[test]
fn a_stroke_goes_to_any_tick_and_live_samples_do_not_care() {
    let (mut engine, _) = engine(Method::Auto);
    engine.send(Command::Seek(9)).unwrap();
    engine.advance_ticks(1);
    let stroke = Stroke::Circle {
        centre: Point::new(50.0, 60.0),
        radius_mm: 20.0,
        speed_mm_per_s: 100.0,
    };
    engine
        .send(Command::SetSource(InputSource::Stroke(stroke)))
        .unwrap();
    for tick in [1000_u32, 7] {
        engine.send(Command::Seek(u64::from(tick))).unwrap();
        engine.advance_ticks(2);
        let snapshot = engine.snapshot();
        assert_eq!(snapshot.pose, stroke.pose_at(f64::from(tick) / 40.0));
        assert_eq!(snapshot.playback.tick, u64::from(tick));
    }
    engine.send(Command::Seek(u64::MAX)).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(2);
}
