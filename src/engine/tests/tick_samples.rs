//! Which ticks leave a sample, and what it holds.

use super::*;

fn samples(engine: &mut Engine) -> Vec<TickSample> {
    std::iter::from_fn(|| engine.next_tick_sample()).collect()
}

fn replay(method: Method) -> Engine {
    let (mut engine, _) = engine(method);
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::SampleTicks(true)).unwrap();
    engine
}

#[test]
fn nobody_who_listens_is_told_nothing() {
    let (mut engine, start) = engine(Method::Auto);
    explore(&mut engine, start, 30);
    assert_eq!(samples(&mut engine), []);
    assert_eq!(engine.snapshot().counters.tick_samples_lost, 0);
}

#[test]
fn a_still_finger_leaves_one_and_a_moving_one_leaves_all() {
    let (mut engine, start) = engine(Method::Auto);
    engine.send(Command::SampleTicks(true)).unwrap();
    engine.advance_ticks(20);
    let still = samples(&mut engine);
    assert_eq!(still.len(), 1, "the first that did not move: {still:?}");
    explore(&mut engine, start + TICK * 20, 30);
    engine.advance_ticks(40);
    let moved = samples(&mut engine);
    assert!((30..36).contains(&moved.len()), "{}", moved.len());
    assert!(
        moved
            .windows(2)
            .all(|pair| pair[1].tick == pair[0].tick + 1)
    );
    let last = moved[moved.len() - 1];
    assert_eq!(
        (last.mean_um, last.pose.velocity),
        ([0.0; 2], Velocity::ZERO)
    );
    engine.send(Command::TurnBy(5.0)).unwrap();
    engine.advance_ticks(9);
    let turned = samples(&mut engine);
    assert_eq!(
        turned.len(),
        2,
        "the turn, and the first tick after it: {turned:?}"
    );
    assert!(turned[0].pose.angular_rad_per_s > 0.0 && turned[0].watched_um[0] > 0.0);
}

#[test]
fn a_held_replay_that_is_put_elsewhere_leaves_none_and_a_step_from_there_one() {
    let mut engine = replay(Method::Auto);
    engine.advance_ticks(2);
    samples(&mut engine);
    for tick in [40, 3, 17] {
        engine.send(Command::Seek(tick)).unwrap();
        engine.advance_ticks(2);
        assert_eq!(samples(&mut engine), [], "{tick}");
    }
    engine.send(Command::Step).unwrap();
    engine.advance_ticks(2);
    assert_eq!(samples(&mut engine).len(), 1);
}

#[test]
fn a_sample_brings_the_amplitudes_of_every_contactor() {
    let mut engine = replay(Method::Auto);
    engine.send(Command::Play).unwrap();
    for _ in 0..30 {
        engine.advance_ticks(1);
        let expected = amplitudes(engine.snapshot());
        let (sample, felt_um, poses) = engine.next_felt_tick().unwrap();
        assert_eq!(sample.n_contactors as usize, felt_um.len());
        assert!(poses.is_empty(), "there is one display");
        assert_eq!(felt_um, expected);
    }
}

#[test]
fn a_held_replay_leaves_none_and_a_step_leaves_one() {
    let mut engine = replay(Method::Auto);
    engine.advance_ticks(5);
    assert_eq!(samples(&mut engine), []);
    for n in 0..4 {
        engine.send(Command::Step).unwrap();
        engine.advance_ticks(3);
        let seen = samples(&mut engine);
        assert_eq!(seen.len(), 1, "step {n}: {seen:?}");
    }
}

#[test]
fn a_tick_sample_holds_the_mean_over_textiles_and_the_one_that_is_watched() {
    let mut engine = replay(Method::Table);
    engine.send(Command::Watch(7)).unwrap();
    engine.send(Command::Play).unwrap();
    for _ in 0..60 {
        engine.advance_ticks(1);
        let seen = samples(&mut engine);
        let snapshot = engine.snapshot();
        let contactors = &snapshot.displays[0].contactors;
        assert_eq!(seen[0].pose, snapshot.pose);
        assert_eq!((seen.len(), seen[0].tick), (1, snapshot.tick));
        assert_eq!(
            (seen[0].watched, seen[0].watched_um),
            (7, contactors[7].amplitude_um)
        );
        let on_cloth = contactors.iter().filter(|c| c.textile.is_some());
        let amplitudes: Vec<f32> = on_cloth.map(|c| c.amplitude_um[1]).collect();
        let mean_um = amplitudes.iter().sum::<f32>() / amplitudes.len() as f32;
        assert!(
            (seen[0].mean_um[1] - mean_um).abs() <= 1e-5 * mean_um,
            "{seen:?} {mean_um}"
        );
    }
    engine.send(Command::Watch(usize::MAX)).unwrap();
    engine.advance_ticks(1);
    let beyond = samples(&mut engine)[0];
    assert_eq!((beyond.watched, beyond.watched_um), (u32::MAX, [0.0; 2]));
    assert!(beyond.mean_um[0] > 0.0);
}

#[test]
fn what_is_stopped_moves_in_silence() {
    let mut engine = replay(Method::Auto);
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(3);
    engine.send(Command::StopAll).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(3);
    let seen = samples(&mut engine);
    let silent: Vec<bool> = seen.iter().map(|sample| sample.is_silent).collect();
    assert_eq!(silent, [false, false, false, true, true, true]);
    assert!(seen[5].mean_um == [0.0; 2] && seen[5].pose.velocity != Velocity::ZERO);
}

#[test]
fn a_full_ring_loses_the_newest_and_counts_them() {
    let mut engine = replay(Method::Table);
    engine.send(Command::SetLoop(true)).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(600);
    assert_eq!(engine.snapshot().counters.tick_samples_lost, 600 - 512);
    let seen = samples(&mut engine);
    assert_eq!((seen.len(), seen[511].tick), (512, 512));
    engine.advance_ticks(1);
    assert_eq!(samples(&mut engine).len(), 1, "there is room again");
}
