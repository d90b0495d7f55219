//! What happens once: the device is silent in time, the host says so, and nothing arms by itself.

use super::*;
use crate::framing::Packet;
use crate::message::{Message as _, Status, fault_bit};

const AT_US: u64 = 3_000_000;

fn with(kind: OneOffKind, for_us: u64) -> Faults {
    Faults {
        once: vec![OneOff {
            at_us: AT_US,
            for_us,
            kind,
        }],
        ..Faults::default()
    }
}

#[test]
fn after_each_fault_nothing_is_armed_until_a_person_does_it() {
    for kind in OneOffKind::ALL {
        let mut trial = Simulation::streaming_over(&with(kind, 1_500_000), 20_000);
        let name = kind.name();
        assert_eq!(trial.arms_written, 1, "{name}: armed once, by us");
        assert!(trial.is_at_rest(), "{name}");
        assert!(trial.loudest_age_us <= 100_000, "{name}");
        assert!(!trial.host.state().is_live(), "{name}");
        let described = trial.lost().is_some() || trial.disarmed_by().is_some();
        assert!(described, "{name}: the host says so");
        // And then a person does it.
        if trial.host.state() == BridgeState::Lost {
            trial.open_anew();
        }
        trial.run(1000);
        trial.host.clear_faults(trial.now());
        trial.run(200);
        assert_eq!(trial.host.state(), BridgeState::Ready, "{name}");
        assert!(trial.host.arm(trial.now()), "{name}");
        trial.run(600);
        assert_eq!(trial.host.state(), BridgeState::Streaming, "{name}");
        assert!(trial.is_loud(), "{name}");
    }
}

#[test]
fn a_device_that_breaks_says_what_and_how_bad_it_is() {
    for (kind, bit, value, word) in [
        (
            OneOffKind::OverTemperature,
            fault_bit::OVER_TEMPERATURE,
            8500,
            "over-temperature",
        ),
        (
            OneOffKind::OverCurrent,
            fault_bit::OVER_CURRENT,
            900,
            "over-current",
        ),
        (OneOffKind::HvSag, fault_bit::HIGH_VOLTAGE, 600, "voltage"),
        (OneOffKind::Watchdog, fault_bit::WATCHDOG, 0, "watchdog"),
    ] {
        let faults = with(kind, 200_000);
        let mut trial = Simulation::streaming_over(&faults, 3100);
        if kind == OneOffKind::Watchdog {
            trial.run(1000);
            trial.open_anew();
        }
        trial.run(500);
        let described = trial.events.iter().any(|event| match event {
            crate::BridgeEvent::Fault(fault) => fault.faults == bit && fault.value == value,
            _ => false,
        });
        assert!(described, "{}: {:?}", kind.name(), trial.events);
        assert!(fault_bit::names(bit).contains(word));
    }
}

#[test]
fn sensors_show_what_breaks_while_it_lasts() {
    let status = |kind, ms| {
        let trial = Simulation::streaming_over(&with(kind, 1_000_000), ms);
        *trial.host.status().unwrap()
    };
    assert_eq!(status(OneOffKind::OverTemperature, 3500).temp_cdeg, 8500);
    assert_eq!(status(OneOffKind::OverTemperature, 4500).temp_cdeg, 2500);
    assert_eq!(status(OneOffKind::OverCurrent, 3500).i_ma, 900);
    assert_eq!(status(OneOffKind::OverCurrent, 1000).i_ma, 0);
    let state = |status: Status| status.device_state();
    assert_eq!(
        state(status(OneOffKind::HvSag, 3500)),
        Some(DeviceState::Fault)
    );
}

#[test]
fn a_supply_that_is_measured_trips_on_what_the_codes_take_and_can_be_armed_softer() {
    let above = |max_ma| Faults {
        over_current_ma: Some(max_ma),
        ..Faults::default()
    };
    let trial = Simulation::streaming_over(&above(u16::MAX), 3000);
    let status = *trial.host.status().unwrap();
    let codes = trial.device.core().output();
    let load = crate::actuator_model::ContactorModel::default().load();
    let ma = load.ma(codes.into_iter());
    assert!(ma > 2.0, "{ma}");
    assert!(
        (f64::from(status.i_ma) - ma).abs() <= 0.5,
        "{status:?}, {ma}"
    );
    assert_eq!(
        Simulation::streaming(3000).host.status().unwrap().i_ma,
        0,
        "not measured"
    );

    let mut trial = Simulation::streaming_over(&above(status.i_ma - 1), 3000);
    let fault = trial.events.iter().find_map(|event| match event {
        crate::BridgeEvent::Fault(fault) => Some(*fault),
        _ => None,
    });
    let fault = fault.expect("it trips");
    assert_eq!(fault.faults, fault_bit::OVER_CURRENT);
    assert_eq!(fault.value, i32::from(status.i_ma));
    assert!(trial.is_at_rest() && trial.arms_written == 1);
    trial.host.clear_faults(trial.now());
    trial.run(200);
    assert_eq!(trial.host.state(), BridgeState::Ready);
    trial.amplitude_um = [1.0, 2.0];
    assert!(trial.host.arm(trial.now()));
    trial.run(1500);
    assert_eq!(trial.host.state(), BridgeState::Streaming);
}

#[test]
fn a_reboot_starts_tick_and_counters_anew_and_keeps_no_session() {
    let mut trial = Simulation::streaming_over(&with(OneOffKind::Reboot, 300_000), 2800);
    let before = trial.device.core().tick();
    trial.run(700);
    assert!(trial.device.core().tick() < 40 && before > 100);
    assert_eq!(trial.device.core().state(), DeviceState::Idle);
    assert_eq!(trial.device.counters_of_boots().len(), 2);
    trial.run(1000);
    // It answers PINGs, so that nobody is sent to look after the cable.
    assert!(trial.lost().unwrap().contains("advances for 500 ms"));
}

#[test]
fn a_short_stall_either_way_is_lived_through() {
    for kind in [OneOffKind::StallReading, OneOffKind::StallWriting] {
        let mut trial = Simulation::streaming_over(&with(kind, 50_000), 8000);
        assert_eq!(
            trial.host.state(),
            BridgeState::Streaming,
            "{}",
            kind.name()
        );
        let device = trial.host.counters().device;
        assert!(device.underrun > 0, "{}: {device:?}", kind.name());
        assert_eq!(device.bad, 0);
        trial.run(1000);
        assert!(trial.is_loud());
    }
}

#[test]
fn chatter_and_banners_cost_a_text_and_no_more() {
    let spoken = LinkFaults {
        chatter: true,
        ..LinkFaults::default()
    };
    let trial = Simulation::streaming_over(&both(spoken), 2000);
    assert_eq!(trial.host.state(), BridgeState::Streaming);
    assert!(trial.device.core().counters().bad >= 1);
    assert!(trial.bad_texts_received() >= 1);
    assert_eq!(
        trial.host.counters().device.bad,
        0,
        "all before the session"
    );
    assert_eq!(trial.log.injections.len(), 2);
}

#[test]
fn the_same_seed_gives_the_same_life_and_another_seed_another() {
    let noisy = LinkFaults {
        drop_rate: 1e-3,
        garbage_every_us: Some(300_000),
        latency: Latency::Normal {
            mean_us: 2000,
            deviation_us: 900,
        },
        ..LinkFaults::default()
    };
    let life = |seed| {
        let faults = Faults {
            seed,
            tick_jitter_us: 1000,
            ..both(noisy)
        };
        let trial = Simulation::streaming_over(&faults, 10_000);
        (trial.log.frames, trial.log.injections)
    };
    assert_eq!(life(1), life(1));
    assert!(life(1) != life(2));
}

#[test]
fn without_a_cable_nothing_passes_and_what_was_under_way_is_gone() {
    let faults = with(OneOffKind::Unplug, 1_000_000);
    let mut device = WiredDevice::new(DeviceModel::default(), &faults);
    let mut out = Vec::new();
    device.advance(AT_US + 10, &mut out);
    assert!(!device.is_plugged());
    let ping = crate::message::Ping { token: 1 }.packet(1).unwrap();
    device.host_wrote(AT_US + 20, ping.as_bytes());
    device.host_wrote(AT_US + 30, Packet::delimiter().as_bytes());
    device.advance(AT_US + 2_000_000, &mut out);
    assert!(device.is_plugged() && out.is_empty());
    device.host_wrote(AT_US + 2_000_000, ping.as_bytes());
    device.advance(AT_US + 2_000_000, &mut out);
    assert!(!out.is_empty(), "and then it answers");
}

#[test]
fn who_disarmed_is_told_right_when_the_host_is_not_heard() {
    let trial = Simulation::streaming_over(&with(OneOffKind::StallReading, 400_000), 3600);
    let (by, reason) = trial.disarmed_by().unwrap();
    assert_eq!(by, DisarmedBy::Device);
    assert!(reason.contains("no frame reached it in time"), "{reason}");
}

#[test]
fn a_link_on_which_a_fifth_breaks_ends_with_the_word_noisy_and_a_clean_one_does_not() {
    let over = |flip_rate| {
        let breaking = LinkFaults {
            flip_rate,
            ..LinkFaults::default()
        };
        let faults = Faults {
            seed: 3,
            to_host: breaking,
            ..Faults::default()
        };
        Simulation::streaming_over(&faults, 8000)
    };
    let noisy = over(0.005);
    let (by, reason) = noisy.disarmed_by().unwrap();
    assert_eq!(by, DisarmedBy::Device);
    assert!(
        reason.contains("noisy") && !reason.contains("powered"),
        "{reason}"
    );
    assert!(noisy.is_at_rest());
    assert_eq!(over(0.0002).host.state(), BridgeState::Streaming);
}
