//! What a device says before it is armed, against what was asked: one test a sentence.

use super::*;
use crate::message::{ChannelMask, Config, LogText};

/// A session with this profile that has heard these CAPS.
fn greeted(profile: ArrayProfile, caps: Caps) -> (HostSession, Instant) {
    let now = Instant::now();
    let mut host = HostSession::new(NONCE, profile, 24, Sequence::default());
    host.opened(now);
    host.on_message(now, &DeviceMessage::Caps(caps));
    (host, now)
}

fn good_caps() -> Caps {
    DeviceModel::default().caps(NONCE, 1)
}

/// The line with which a session was refused; it never armed.
fn refusal(host: &mut HostSession, now: Instant) -> Option<String> {
    assert!(!host.arm(now), "{}", host.state());
    while let Some(event) = host.next_event() {
        if let BridgeEvent::Refused(reason) = event {
            assert!(!reason.contains('\n'), "{reason}");
            return Some(reason);
        }
    }
    None
}

#[test]
fn caps_that_allow_nothing_or_have_another_shape_are_refused() {
    let good = good_caps();
    for (caps, words) in [
        (Caps { version: 3, ..good }, "not offered"),
        (
            Caps {
                rows: 4,
                cols: 6,
                ..good
            },
            "4 rows × 6 columns",
        ),
        (
            Caps {
                rows: 1,
                cols: 24,
                ..good
            },
            "1 rows × 24 columns",
        ),
        (
            Caps {
                modes: Caps::MODE_IDENT,
                ..good
            },
            "mode A",
        ),
        (Caps { queue: 0, ..good }, "queue 0"),
        (
            Caps {
                slew_max: 0,
                ..good
            },
            "slew_max 0",
        ),
        (
            Caps {
                comp_limit: [65535, 0],
                ..good
            },
            "comp_limit 0",
        ),
        (
            Caps {
                hv_max_dv: 0,
                ..good
            },
            "hv_max_dV 0",
        ),
        (Caps { fs_mv: 0, ..good }, "fs_mV 0"),
    ] {
        let (mut host, now) = greeted(ArrayProfile::default(), caps);
        let reason = refusal(&mut host, now).unwrap();
        assert!(reason.contains(words), "{words}: {reason}");
    }
}

#[test]
fn a_device_of_another_voltage_gets_other_codes_or_is_refused_with_both_voltages() {
    for (fs_mv, is_driven) in [
        (49_999, false),
        (50_000, true),
        (200_000, true),
        (800_000, true),
        (800_001, false),
        (4_294_967_295, false),
    ] {
        let caps = Caps {
            fs_mv,
            ..good_caps()
        };
        let (mut host, now) = greeted(ArrayProfile::default(), caps);
        assert_eq!(
            host.state() == BridgeState::Configuring,
            is_driven,
            "{fs_mv}"
        );
        if is_driven {
            let part = 50_000.0 / f64::from(fs_mv);
            let asked = host.drive.wanted_config(&host.device).comp_limit;
            assert_eq!(f64::from(asked[0]), (65535.0 * part).ceil());
        } else {
            let reason = refusal(&mut host, now).unwrap();
            let volts = f64::from(fs_mv) / 1e3;
            assert!(reason.contains(&format!("{volts} V")), "{reason}");
            assert!(reason.contains("at 50 V"), "{reason}");
        }
    }
}

/// Changes what a device says that it granted.
type Lie = fn(&mut Config);

#[test]
fn settings_that_exceed_or_silence_what_was_asked_are_refused() {
    let asked = |host: &HostSession| host.drive.wanted_config(&host.device);
    let lies: [(Lie, &str); 17] = [
        (|cfg| cfg.hold_ms = 65_000, "hold of 65000 ms"),
        (|cfg| cfg.hold_ms = 61, "hold of 61 ms"),
        (|cfg| cfg.hold_ms = 0, "hold of 0 ms"),
        (|cfg| cfg.hold_ms = 24, "24 ms only"),
        (|cfg| cfg.ramp_ms = 41, "ramp of 41 ms"),
        (|cfg| cfg.ramp_ms = 0, "ramp of 0 ms"),
        (|cfg| cfg.hv_dv = 65_530, "6553 V"),
        (|cfg| cfg.hv_dv = 601, "60.1 V"),
        (|cfg| cfg.hv_dv = 0, "high voltage of 0"),
        (|cfg| cfg.slew = 0, "slew of 0"),
        (|cfg| cfg.comp_limit[0] = 60_001, "limit at 40 Hz of 60001"),
        (|cfg| cfg.comp_limit[1] = 0, "limit at 320 Hz of 0"),
        (|cfg| cfg.mode = 1, "mode 1"),
        (|cfg| cfg.flags = 1, "flags 1"),
        (|cfg| cfg.mask = ChannelMask::default(), "channel 0 is off"),
        (|cfg| cfg.mask = ChannelMask::first(23), "channel 23 is off"),
        (|cfg| cfg.slew = 30_001, "slew of 30001"),
    ];
    for (lie, words) in lies {
        let caps = Caps {
            comp_limit: [60_000, 65_535],
            slew_max: 30_000,
            ..good_caps()
        };
        let (mut host, now) = greeted(ArrayProfile::default(), caps);
        let model = DeviceModel {
            comp_limit: caps.comp_limit,
            slew_max: caps.slew_max,
            ..DeviceModel::default()
        };
        let mut cfg = model.clamp(&asked(&host));
        lie(&mut cfg);
        host.on_message(now, &DeviceMessage::Cfg(cfg));
        let reason = refusal(&mut host, now).unwrap_or_else(|| panic!("{words} was believed"));
        assert!(reason.contains(words), "{words}: {reason}");
    }
}

#[test]
fn bits_of_a_mask_beyond_the_channels_are_nobodys_business() {
    let (mut host, now) = greeted(ArrayProfile::default(), good_caps());
    let mut cfg = DeviceModel::default().clamp(&host.drive.wanted_config(&host.device));
    cfg.mask = ChannelMask::first(32);
    host.on_message(now, &DeviceMessage::Cfg(cfg));
    for tick in 1..=3 {
        host.on_message(now, &at(tick, DeviceState::Ready));
    }
    assert_eq!(host.state(), BridgeState::Ready);
}

#[test]
fn without_a_voltage_in_the_profile_the_effective_one_is_taken() {
    let profile = ArrayProfile {
        hv_dv: None,
        ..ArrayProfile::default()
    };
    let (host, _) = greeted(profile, good_caps());
    let asked = host.drive.wanted_config(&host.device);
    assert_eq!(asked.hv_dv, good_caps().hv_max_dv);
}

/// A configured session that waits for a STATUS.
fn configured() -> (HostSession, Instant) {
    let (mut host, now) = greeted(ArrayProfile::default(), good_caps());
    let cfg = DeviceModel::default().clamp(&host.drive.wanted_config(&host.device));
    host.on_message(now, &DeviceMessage::Cfg(cfg));
    assert_eq!(host.state(), BridgeState::Configuring);
    (host, now)
}

#[test]
fn arm_waits_for_three_advancing_status_of_which_the_last_says_ready() {
    let (mut host, now) = configured();
    for (tick, is_ready) in [(7, false), (7, false), (8, false), (6, false), (9, true)] {
        assert!(!host.arm(now));
        host.on_message(now, &at(tick, DeviceState::Ready));
        assert_eq!(host.state() == BridgeState::Ready, is_ready, "tick {tick}");
    }
    assert!(host.arm(now));
}

#[test]
fn a_device_that_is_live_before_arm_gets_stop_and_is_refused() {
    for state in [
        DeviceState::Armed,
        DeviceState::Run,
        DeviceState::Hold,
        DeviceState::Ramp,
    ] {
        for after in [0, 3] {
            let (mut host, now) = configured();
            for tick in 1..=after {
                host.on_message(now, &at(tick, DeviceState::Ready));
            }
            host.on_message(now, &at(after + 1, state));
            assert_eq!(host.state(), BridgeState::Refused, "{state}");
            assert!(host.take_stop().is_some(), "{state}: STOP goes out");
            let reason = refusal(&mut host, now).unwrap();
            assert!(reason.contains("before it was armed"), "{reason}");
        }
    }
}

#[test]
fn fault_bits_stand_against_arming_until_a_person_clears_them_and_a_lost_lease_does_not() {
    let faulty = |tick, faults| match at(tick, DeviceState::Ready) {
        DeviceMessage::Status(status) => DeviceMessage::Status(Status { faults, ..status }),
        other => other,
    };
    for (faults, stands) in [(1, true), (64, true), (32, false), (33, true)] {
        let (mut host, now) = configured();
        for tick in 1..=3 {
            host.on_message(now, &faulty(tick, faults));
        }
        assert_eq!(host.arm(now), !stands, "{faults:#x}");
        if stands {
            assert_eq!(host.state(), BridgeState::Faulted);
            host.clear_faults(now);
            let clear = std::iter::from_fn(|| host.next_packet()).last().unwrap();
            assert_eq!(clear.as_bytes().get(2), Some(&kind::CLEAR));
        }
    }
}

#[test]
fn names_and_texts_of_a_device_are_shown_escaped() {
    let mut name = [0; 32];
    name[..7].copy_from_slice(b"a\x1b[31m\n");
    name[7] = 0xff;
    let caps = Caps {
        name,
        ..good_caps()
    };
    assert_eq!(caps.shown_name(), "a\\u{1b}[31m\\n\u{fffd}");
    let (host, _) = greeted(ArrayProfile::default(), caps);
    assert_eq!(
        host.state(),
        BridgeState::Configuring,
        "no reason to refuse"
    );
    let packet = LogText::packet(1, "line\u{7}\r\nnext\n").unwrap();
    let mut decoder = crate::framing::Decoder::new(256);
    let line = packet.as_bytes().iter().find_map(|&byte| {
        let received = decoder.push(byte)?;
        match DeviceMessage::decode(&received, 24) {
            Ok(DeviceMessage::Log(text)) => Some(text.to_line()),
            _ => None,
        }
    });
    assert_eq!(line.unwrap(), "line\\u{7}\\r\\nnext");
}
