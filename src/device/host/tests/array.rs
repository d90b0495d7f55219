//! Another profile, and one channel alone, against the device in virtual time.

use super::*;
use crate::array::{Calibration, DeviceUid, Wiring};
use crate::session_log::Note;

fn limited(limit_um: [f64; 2]) -> ArrayProfile {
    ArrayProfile {
        limit_um,
        ..ArrayProfile::default()
    }
}

fn set(pair: &mut Pair, profile: ArrayProfile) -> Result<(), &'static str> {
    let now = pair.now();
    pair.host.set_array(now, &mut ArrayChange::new(profile, 24))
}

#[test]
fn what_lowers_takes_effect_at_once_and_what_raises_waits_for_rest() {
    let mut pair = Pair::streaming(2000);
    assert_eq!(pair.device.core().output(), vec![[13107, 26214]; 24]);
    assert_eq!(set(&mut pair, limited([50.0, 10.0])), Ok(()));
    pair.run(100);
    assert_eq!(pair.device.core().output(), vec![[13107, 13107]; 24]);
    assert_eq!(pair.host.state(), BridgeState::Streaming, "it goes on");
    let refused = set(&mut pair, limited([50.0, 11.0]));
    assert!(
        refused
            .unwrap_err()
            .contains("until the device is disarmed")
    );
    pair.run(100);
    assert_eq!(
        pair.device.core().output(),
        vec![[13107, 13107]; 24],
        "nothing rose"
    );
    let counted = pair.host.counters().codes.limited;
    assert!(counted[1] >= 24, "the counters go on: {counted:?}");

    pair.host.stop(pair.now(), StopHow::Ramp);
    pair.run(200);
    assert_eq!(set(&mut pair, limited([50.0, 11.0])), Ok(()));
    pair.run(100);
    assert_eq!(pair.host.state(), BridgeState::Ready);
    let asked = pair.host.device.config.unwrap().comp_limit;
    assert_eq!(asked, [65535, 14418], "the device was configured anew");
    assert!(pair.host.arm(pair.now()));
    pair.run(1000);
    assert_eq!(pair.device.core().output(), vec![[13107, 14418]; 24]);
}

#[test]
fn a_profile_of_another_array_is_refused() {
    let mut pair = Pair::new();
    pair.run(500);
    let other = ArrayProfile {
        rows: 5,
        ..ArrayProfile::default()
    };
    assert!(
        set(&mut pair, other)
            .unwrap_err()
            .contains("number of contactors")
    );
}

#[test]
fn a_profile_that_comes_before_the_device_answers_is_what_it_is_configured_with() {
    let mut pair = Pair::new();
    assert_eq!(set(&mut pair, limited([5.0, 50.0])), Ok(()));
    pair.run(500);
    assert_eq!(pair.host.state(), BridgeState::Ready);
    assert_eq!(pair.host.device.config.unwrap().comp_limit, [6554, 65535]);
}

/// Runs without frames, as a wizard does, and gives what was said of channels.
fn run_unheard(pair: &mut Pair, ms: u64) -> Vec<BridgeEvent> {
    let before = pair.events.len();
    pair.run_without_frames(ms);
    let is_of_ident = |event: &&BridgeEvent| {
        matches!(
            event,
            BridgeEvent::Identified { .. } | BridgeEvent::NotIdentified { .. }
        )
    };
    pair.events[before..]
        .iter()
        .filter(is_of_ident)
        .cloned()
        .collect()
}

fn channels(pair: &Pair) -> Vec<(usize, [u16; 2])> {
    let output = pair.device.core().output();
    let driven = output.into_iter().enumerate();
    driven.filter(|(_, code)| *code != [0, 0]).collect()
}

#[test]
fn one_channel_at_a_time_is_driven_and_ends_by_itself() {
    let mut pair = Pair::new();
    pair.run(500);
    let early = pair.host.identify(pair.now(), 3, (10.0, 300));
    assert!(early.unwrap_err().contains("only while armed"));
    assert!(pair.host.arm(pair.now()));
    run_unheard(&mut pair, 5);
    assert_eq!(pair.host.state(), BridgeState::Armed);
    assert_eq!(pair.host.identify(pair.now(), 3, (10.0, 300)), Ok(()));
    let described = run_unheard(&mut pair, 100);
    assert_eq!(described, [BridgeEvent::Identified { channel: 3 }]);
    assert_eq!(channels(&pair), [(3, [0, 13107])]);
    assert_eq!(pair.host.identify(pair.now(), 7, (80.0, 9999)), Ok(()));
    run_unheard(&mut pair, 100);
    assert_eq!(
        channels(&pair),
        [(7, [0, 65535])],
        "only the last, within the limit"
    );
    run_unheard(&mut pair, 950);
    assert_eq!(channels(&pair), [], "after a second at most it is silent");
    assert_eq!(
        pair.host.state(),
        BridgeState::Armed,
        "pings keep the lease"
    );
    let beyond = pair.host.identify(pair.now(), 24, (10.0, 300));
    assert!(beyond.unwrap_err().contains("no such channel"));
}

#[test]
fn stop_and_the_first_frame_end_an_identified_channel() {
    let mut pair = Pair::new();
    pair.run(500);
    assert!(pair.host.arm(pair.now()));
    run_unheard(&mut pair, 5);
    assert_eq!(pair.host.identify(pair.now(), 3, (10.0, 1000)), Ok(()));
    run_unheard(&mut pair, 50);
    pair.amplitude_um = [0.0, 0.0];
    pair.run(100);
    assert_eq!(channels(&pair), [], "frames have come");
    let late = pair.host.identify(pair.now(), 3, (10.0, 1000));
    assert!(late.unwrap_err().contains("before anything is played"));
    pair.host.stop(pair.now(), StopHow::Ramp);
    pair.run(200);
    assert!(pair.host.arm(pair.now()));
    run_unheard(&mut pair, 5);
    assert_eq!(pair.host.identify(pair.now(), 5, (10.0, 1000)), Ok(()));
    run_unheard(&mut pair, 50);
    assert_eq!(channels(&pair), [(5, [0, 13107])]);
    pair.host.stop(pair.now(), StopHow::Ramp);
    run_unheard(&mut pair, 5);
    assert_eq!(channels(&pair), []);
}

#[test]
fn a_device_that_cannot_or_does_not_answer_is_told_of() {
    let mut pair = Pair::of(
        DeviceModel {
            modes: Caps::MODE_A,
            ..DeviceModel::default()
        },
        &Faults::default(),
    );
    pair.run(500);
    assert!(pair.host.arm(pair.now()));
    run_unheard(&mut pair, 5);
    let cannot = pair.host.identify(pair.now(), 0, (10.0, 300));
    assert!(cannot.unwrap_err().contains("cannot drive a channel alone"));

    let mut pair = Pair::new();
    pair.run(500);
    assert!(pair.host.arm(pair.now()));
    run_unheard(&mut pair, 5);
    pair.cut = true;
    assert_eq!(pair.host.identify(pair.now(), 9, (10.0, 300)), Ok(()));
    let described = run_unheard(&mut pair, 300);
    let reason = String::from("the device did not answer");
    assert_eq!(
        described,
        [BridgeEvent::NotIdentified { channel: 9, reason }]
    );
}

#[test]
fn calibration_and_wiring_reach_the_device() {
    let mut profile = ArrayProfile::default();
    let strong = Calibration {
        drive_gain: [1.0, 0.5],
        is_off: false,
    };
    profile.set_calibration(0, strong);
    profile.wiring = Some(Wiring {
        device_uid: DeviceUid(*b"selvedge-emu"),
        channels: (0..24).rev().collect(),
    });
    let mut pair = Pair::new();
    assert_eq!(set(&mut pair, profile), Ok(()));
    pair.run(500);
    assert!(pair.host.arm(pair.now()));
    pair.run(1000);
    let output = pair.device.core().output();
    assert_eq!(
        output[23],
        [13107, 13107],
        "contactor 0 on the last channel"
    );
    assert_eq!(output[..23], vec![[13107, 26214]; 23]);
}

/// What a host says that comes after a device with the number 7… and meets the emulator.
fn told_of_another(profile: ArrayProfile, before: [u8; 12]) -> Option<String> {
    let now = Instant::now();
    let mut host = HostSession::new(NONCE, profile, 24, Sequence::default());
    host.keep_notes();
    host.came_after(DeviceUid(before));
    host.opened(now);
    let caps = DeviceModel::default().caps(NONCE, 1);
    host.on_message(now, &DeviceMessage::Caps(caps));
    let described = std::iter::from_fn(|| host.next_event()).find_map(|event| match event {
        BridgeEvent::OtherDevice(words) => Some(words),
        _ => None,
    });
    let noted = std::iter::from_fn(|| host.next_note()).find_map(|entry| match entry.note {
        Note::Said("other-device", words) => Some(words),
        _ => None,
    });
    assert_eq!(described, noted, "the log says what people are told");
    described
}

#[test]
fn another_device_than_before_is_always_told_and_with_the_mend_where_it_was_measured() {
    let caps = DeviceModel::default().caps(NONCE, 1);
    assert_eq!(told_of_another(ArrayProfile::default(), caps.uid), None);
    let plain = told_of_another(ArrayProfile::default(), [7; 12]).unwrap();
    assert!(
        plain.ends_with("it was 070707070707070707070707"),
        "{plain}"
    );
    let mut measured = ArrayProfile {
        calibration: vec![Calibration::default(); 24],
        ..ArrayProfile::default()
    };
    let warned = told_of_another(measured.clone(), [7; 12]).unwrap();
    assert!(warned.starts_with(&plain), "{warned}");
    assert!(
        warned.contains("calibration in") && warned.contains("own profile"),
        "{warned}"
    );
    measured.wiring = Some(Wiring {
        device_uid: DeviceUid([7; 12]),
        channels: (0..24).collect(),
    });
    let warned = told_of_another(measured.clone(), [7; 12]).unwrap();
    assert!(warned.contains("calibration and wiring"), "{warned}");
    measured.wiring.as_mut().unwrap().device_uid = DeviceUid(caps.uid);
    let own = told_of_another(measured, [7; 12]).unwrap();
    assert_eq!(own, plain, "it is the one that was measured");
}
