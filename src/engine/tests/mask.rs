//! Contactors of the first display that are switched off.

use std::sync::atomic::Ordering;

use super::*;

/// A mask in which these contactors are not felt.
fn without(masked: &[usize]) -> Command {
    Command::SetContactorMask((0..24).map(|index| !masked.contains(&index)).collect())
}

fn is_silent_at(engine: &mut Engine, index: usize) -> bool {
    amplitudes(engine.snapshot())[index] == [0.0; 2]
}

#[test]
fn a_masked_contactor_is_silent_everywhere_and_the_others_are_as_before() {
    for method in [Method::Banded, Method::Table] {
        let (mut engine, _) = engine(method);
        let path = path();
        let felt = offline(&path, method);
        let source = InputSource::Replay(path);
        engine.send(Command::SetSource(source)).unwrap();
        engine.send(without(&[3, 11])).unwrap();
        engine.send(Command::SampleTicks(true)).unwrap();
        engine.send(Command::Watch(11)).unwrap();
        let mut recording = engine.record().unwrap();
        engine.send(Command::Play).unwrap();
        engine.advance_ticks(40);
        engine.send(Command::StopRecording).unwrap();
        engine.advance_ticks(1);
        recording.collect();
        for (n, felt) in felt.iter().take(40).enumerate() {
            let mut expected = felt.clone();
            expected[3] = [0.0; 2];
            expected[11] = [0.0; 2];
            assert_eq!(recording.amplitudes_um(n), expected, "tick {n}");
            assert_eq!(engine.next_tick_sample().unwrap().watched_um, [0.0; 2]);
        }
        assert!(is_silent_at(&mut engine, 3) && !is_silent_at(&mut engine, 4));
    }
}

#[test]
fn a_mask_outlives_scenes_and_covers_only_what_it_names() {
    let (mut engine, _) = engine(Method::Auto);
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine
        .send(Command::SetContactorMask(vec![true, false]))
        .unwrap();
    engine.send(Command::Seek(30)).unwrap();
    engine.advance_ticks(1);
    let scene = Box::new(prepared(exeter(), Method::Table));
    engine.send(Command::SetScene(scene)).unwrap();
    engine.advance_ticks(1);
    for index in 0..24 {
        assert_eq!(is_silent_at(&mut engine, index), index == 1, "{index}");
    }
    let one = Box::new(prepared(vec![Displacement::default()], Method::Table));
    engine.send(without(&[20])).unwrap();
    engine.send(Command::SetScene(one)).unwrap();
    engine.advance_ticks(1);
    assert!(
        !is_silent_at(&mut engine, 0),
        "the mask is longer than the display"
    );
    engine.send(Command::SetContactorMask(Vec::new())).unwrap();
    engine.advance_ticks(1);
}

#[test]
fn a_mask_and_a_gain_are_news_even_while_nothing_moves() {
    let (config, n_news) = config_counting_news(Method::Auto);
    let mut engine = Engine::without_thread(config, Instant::now()).unwrap();
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Seek(30)).unwrap();
    engine.advance_ticks(3);
    let settle = || std::thread::sleep(Duration::from_millis(50));
    let gain = Command::SetGains {
        tuning: Tuning::default(),
        textiles_db: vec![(0, -3.0)],
    };
    for command in [without(&[5]), gain] {
        settle();
        let before = n_news.load(Ordering::SeqCst);
        engine.send(command).unwrap();
        engine.advance_ticks(1);
        settle();
        assert!(n_news.load(Ordering::SeqCst) > before);
    }
    assert!(is_silent_at(&mut engine, 5) && !is_silent_at(&mut engine, 6));
}
