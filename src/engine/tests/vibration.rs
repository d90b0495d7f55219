//! Steady vibrations in place of a scene.

use super::*;

fn step(amplitude_um: [f32; 2], n_ticks: u32) -> VibrationStep {
    VibrationStep {
        amplitude_um,
        n_ticks,
    }
}

fn two_intervals() -> Vec<VibrationStep> {
    vec![step([0.5, 0.0], 3), step([0.0; 2], 2), step([0.0, 0.25], 3)]
}

#[test]
fn every_contactor_vibrates_alike_whatever_the_finger_does() {
    let (mut engine, _) = engine(Method::Auto);
    let source = InputSource::Replay(path());
    engine.send(Command::SetSource(source)).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(3);
    let tuning = Tuning {
        gain_db: 20.0,
        ..Tuning::default()
    };
    engine.send(Command::SetTuning(tuning)).unwrap();
    engine.send(Command::Vibrate(two_intervals())).unwrap();
    let mut played = Vec::new();
    for _ in 0..8 {
        engine.advance_ticks(1);
        let snapshot = engine.snapshot();
        let all = amplitudes(snapshot);
        assert!(all.iter().all(|one| *one == all[0]), "{all:?}");
        played.push((snapshot.vibration, all[0]));
    }
    let expected = [(0, [0.5, 0.0], 3), (1, [0.0; 2], 2), (2, [0.0, 0.25], 3)];
    let expected: Vec<_> = expected
        .into_iter()
        .flat_map(|(step, um, n)| vec![(Some(step), um); n])
        .collect();
    assert_eq!(played, expected);
    engine.advance_ticks(1);
    let snapshot = engine.snapshot();
    assert_eq!(snapshot.vibration, None);
    assert!(!is_silent(snapshot), "the scene is felt again");
}

#[test]
fn limits_show_and_masked_contactors_stay_silent() {
    let (mut engine, _) = engine(Method::Auto);
    engine
        .send(Command::SetContactorMask(vec![true, false]))
        .unwrap();
    engine
        .send(Command::Vibrate(vec![step([1e6, 0.0], 4)]))
        .unwrap();
    engine.advance_ticks(1);
    let snapshot = engine.snapshot();
    let contactors = &snapshot.displays[0].contactors;
    assert_eq!(contactors[1].amplitude_um, [0.0; 2]);
    assert_ne!(
        contactors[0].limiter,
        selvedge_device::LimiterState::default()
    );
}

#[test]
fn all_off_ends_a_sequence_and_lets_none_begin() {
    let (mut engine, _) = engine(Method::Auto);
    engine.send(Command::Vibrate(two_intervals())).unwrap();
    engine.advance_ticks(1);
    engine.send(Command::StopAll).unwrap();
    engine.advance_ticks(1);
    assert!(is_silent(engine.snapshot()));
    assert_eq!(engine.snapshot().vibration, None);
    engine.send(Command::Vibrate(two_intervals())).unwrap();
    engine.advance_ticks(1);
    assert!(is_silent(engine.snapshot()), "everything is off");
    let refused = std::iter::from_fn(|| engine.next_notice())
        .any(|notice| matches!(notice, Notice::Refused(words) if words.contains("arm")));
    assert!(refused);
}

#[test]
fn a_vibration_that_is_no_number_is_refused() {
    let (mut engine, _) = engine(Method::Auto);
    for um in [f32::NAN, f32::INFINITY, -1.0] {
        engine
            .send(Command::Vibrate(vec![step([um, 0.0], 4)]))
            .unwrap();
        engine.advance_ticks(1);
        assert!(is_silent(engine.snapshot()), "{um}");
        assert!(matches!(engine.next_notice(), Some(Notice::Refused(_))));
    }
}
