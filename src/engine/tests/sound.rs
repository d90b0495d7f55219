//! What is heard of what is felt, to the sample.

use super::*;

/// Amplitudes up to these, µm.
const LIMIT_UM: [f32; 2] = [0.5, 0.25];

/// What a tick is heard as.
fn heard(sonifier: &mut Sonifier) -> Vec<[f32; 2]> {
    let mut block = vec![[9.0; 2]; 1200];
    sonifier.fill(&mut block);
    block
}

/// A replay that is heard, on an array that is limited.
fn replayed() -> (Engine, Sonifier, SoundControl) {
    let (mut engine, _) = engine(Method::Banded);
    let profile = ArrayProfile {
        limit_um: LIMIT_UM.map(f64::from),
        ..ArrayProfile::default()
    };
    let (feed, sonifier, control) = sonification();
    for command in [
        Command::SetArray(Some(Box::new(profile))),
        Command::SetSound(Some(Box::new(feed))),
        Command::SetSource(InputSource::Replay(path())),
        Command::Play,
    ] {
        engine.send(command).unwrap();
    }
    (engine, sonifier, control)
}

#[test]
fn what_is_heard_is_what_limits_leave_of_all_contactors_or_of_one_alone() {
    for alone in [None, Some(7)] {
        let (mut engine, mut sonifier, control) = replayed();
        control.choose(false, alone);
        let (_, mut expected, mut moments) = sonification();
        let mut n_limited = 0;
        for tick in 0..40 {
            engine.advance_ticks(1);
            let snapshot = engine.snapshot();
            let contactors = snapshot.displays[0].contactors.iter().map(|contactor| {
                let [low, high] = contactor.amplitude_um;
                let within = [low.min(LIMIT_UM[0]), high.min(LIMIT_UM[1])];
                (contactor.position.x_mm, within)
            });
            let all = amplitudes(snapshot);
            n_limited += all.iter().filter(|[low, _]| *low > LIMIT_UM[0]).count();
            let middle_mm = snapshot.pose.position.x_mm;
            let levels = stereo_levels([middle_mm, 30.0], contactors, alone);
            moments.scrub(Some(levels));
            let (found, wanted) = (heard(&mut sonifier), heard(&mut expected));
            let pairs = found.iter().flatten().zip(wanted.iter().flatten());
            for (found, wanted) in pairs {
                assert!((found - wanted).abs() < 1e-7, "tick {tick}");
            }
        }
        assert!(n_limited > 100, "{n_limited}");
    }
}

#[test]
fn what_is_held_is_silent_and_so_is_a_contactor_that_is_not_there() {
    let (mut engine, mut sonifier, control) = replayed();
    let mut loudest = |engine: &mut Engine| {
        let mut last = Vec::new();
        for _ in 0..5 {
            engine.advance_ticks(1);
            last = heard(&mut sonifier);
        }
        last.iter()
            .flatten()
            .fold(0.0, |most: f32, x| most.max(x.abs()))
    };
    assert!(loudest(&mut engine) > 1e-3);
    control.choose(false, Some(24));
    assert_eq!(loudest(&mut engine), 0.0);
    control.choose(true, None);
    assert!(loudest(&mut engine) > 1e-3);
    engine.send(Command::Pause).unwrap();
    assert_eq!(loudest(&mut engine), 0.0);
}
