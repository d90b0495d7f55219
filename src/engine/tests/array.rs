//! Another array profile and identified channels, with an emulated device in real time.

use std::thread;

use super::*;
use selvedge_device::{BridgeEvent, BridgeState, Target};

/// Waits for a notice, for as long as a busy machine may take.
fn wait_for(engine: &mut Engine, what: &str, is_it: impl Fn(&Notice) -> bool) {
    for _ in 0..4000 {
        if std::iter::from_fn(|| engine.next_notice()).any(|notice| is_it(&notice)) {
            return;
        }
        thread::sleep(Duration::from_millis(5));
    }
    panic!("{what} did not happen; {:?}", engine.snapshot().link);
}

fn wait_for_event(engine: &mut Engine, what: &str, is_it: impl Fn(&BridgeEvent) -> bool) {
    wait_for(
        engine,
        what,
        |notice| matches!(notice, Notice::Bridge(event) if is_it(event)),
    );
}

fn faint() -> ArrayProfile {
    ArrayProfile {
        limit_um: [0.001, 0.001],
        ..ArrayProfile::default()
    }
}

fn n_limited(engine: &mut Engine) -> usize {
    let contactors = &engine.snapshot().displays[0].contactors;
    contactors
        .iter()
        .filter(|one| one.limiter.limited[0])
        .count()
}

#[test]
fn limits_of_the_profile_bite_from_the_next_tick_on_and_in_scenes_that_follow() {
    let (mut engine, start) = engine(Method::Table);
    explore(&mut engine, start, 4);
    assert_eq!(n_limited(&mut engine), 0);
    engine
        .send(Command::SetArray(Some(Box::new(faint()))))
        .unwrap();
    engine.advance_ticks(1);
    assert_eq!(*engine.profile(), faint());
    assert_eq!(n_limited(&mut engine), 24);
    let scene = Box::new(prepared(exeter(), Method::Table));
    engine.send(Command::UpdateScene(scene)).unwrap();
    engine.advance_ticks(1);
    assert_eq!(*engine.profile(), faint(), "an edit changes no array");
    let other = ArrayProfile {
        rows: 5,
        cols: 5,
        ..faint()
    };
    engine
        .send(Command::SetArray(Some(Box::new(other))))
        .unwrap();
    assert_eq!(
        *engine.profile(),
        ArrayProfile::default(),
        "it does not fit"
    );
    engine.send(Command::SetArray(None)).unwrap();
    assert_eq!(*engine.profile(), ArrayProfile::default());
}

#[test]
fn a_profile_that_may_raise_waits_while_the_device_is_armed() {
    let mut engine = Engine::start(config(Method::Auto)).unwrap();
    engine
        .send(Command::SetArray(Some(Box::new(faint()))))
        .unwrap();
    engine.send(Command::Connect(Target::Emulator)).unwrap();
    wait_for_event(&mut engine, "ready", |event| {
        matches!(event, BridgeEvent::Ready(_))
    });
    engine.send(Command::Arm).unwrap();
    wait_for_event(&mut engine, "armed", |event| *event == BridgeEvent::Armed);
    engine.send(Command::SetArray(None)).unwrap();
    wait_for(&mut engine, "the refusal", |notice| {
        matches!(notice, Notice::ArrayWaits)
    });
}

#[test]
fn while_channels_are_identified_an_armed_device_gets_no_frames() {
    let mut engine = Engine::start(config(Method::Auto)).unwrap();
    let channel = |channel| Command::IdentifyChannel {
        channel,
        amplitude_um: 10.0,
        duration_ms: 100,
    };
    engine.send(Command::Connect(Target::Emulator)).unwrap();
    wait_for_event(&mut engine, "ready", |event| {
        matches!(event, BridgeEvent::Ready(_))
    });
    engine.send(channel(0)).unwrap();
    wait_for(&mut engine, "a refusal", |notice| {
        matches!(notice, Notice::Refused(_))
    });
    engine.send(Command::Identify(true)).unwrap();
    engine.send(Command::Arm).unwrap();
    wait_for_event(&mut engine, "armed", |event| *event == BridgeEvent::Armed);
    engine.send(channel(7)).unwrap();
    wait_for_event(&mut engine, "a channel", |event| {
        *event == BridgeEvent::Identified { channel: 7 }
    });
    thread::sleep(Duration::from_millis(200));
    let link = engine.snapshot().link.unwrap();
    assert_eq!(
        (link.state, link.counters.frames_sent),
        (BridgeState::Armed, 0)
    );
    engine.send(Command::Identify(false)).unwrap();
    wait_for_event(&mut engine, "rest", |event| {
        matches!(event, BridgeEvent::Disarmed { .. })
    });
    assert_eq!(engine.snapshot().link.unwrap().counters.frames_sent, 0);
}
