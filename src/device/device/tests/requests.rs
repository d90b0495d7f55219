//! Sessions, arming, settings, faults, and every ACK code.

use super::*;

#[test]
fn the_handshake_leads_to_frames_at_their_ticks() {
    let mut bench = Bench::new();
    bench.send(&Hello::new(SESSION));
    let [DeviceMessage::Caps(caps)] = bench.take()[..] else {
        panic!("CAPS alone")
    };
    assert_eq!(
        (caps.session, caps.version, caps.n_ch, caps.tick_us),
        (SESSION, 1, 24, 25_000)
    );
    bench.configure(&Config {
        hold_ms: 90,
        ramp_ms: 90,
        slew: 0,
        hv_dv: 9999,
        ..wish()
    });
    let [DeviceMessage::Cfg(config)] = bench.take()[..] else {
        panic!("CFG alone")
    };
    assert_eq!((config.hold_ms, config.ramp_ms), (90, 10));
    assert_eq!((config.slew, config.hv_dv), (65535, 600));
    assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Ok));
    bench.frame(1, [1000, 2000]);
    assert!(bench.is_silent(), "not before its tick");
    bench.at(25_000);
    assert_eq!(bench.core.output(), vec![[1000, 2000]; 24]);
    let status = bench.last_status().unwrap();
    assert_eq!(
        (status.tick, status.amp_sum, status.hv_dv),
        (1, 24 * 3000, 600)
    );
    assert_eq!(status.device_state(), Some(DeviceState::Run));
}

#[test]
fn what_comes_before_arming_is_refused() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::WrongState),
        "idle"
    );
    assert_eq!(
        bench.ack_of(&Stop {
            reason: 0,
            how: StopHow::Now
        }),
        Some(AckCode::Ok)
    );
    assert_eq!(bench.frame_ack(1), Some(AckCode::WrongState));
    bench.send(&Hello::new(SESSION));
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::WrongState),
        "no CONFIG yet"
    );
    bench.configure(&wish());
    assert_eq!(bench.ack_of(&Arm::new(1)), Some(AckCode::BadSession));
    let key = Arm {
        session: SESSION,
        key: SESSION,
    };
    assert_eq!(bench.ack_of(&key), Some(AckCode::BadSession));
    let ident = Ident {
        channel: 3,
        ms: 10,
        amp: 77,
    };
    assert_eq!(bench.ack_of(&ident), Some(AckCode::WrongState));
}

#[test]
fn every_ack_code_of_an_armed_device_is_given() {
    let mut bench = Bench::ready();
    let ident = Ident {
        channel: 3,
        ms: 10,
        amp: 77,
    };
    assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Ok));
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::Ok),
        "repeated"
    );
    assert_eq!(
        bench.ack_of(&Ident {
            channel: 24,
            ..ident
        }),
        Some(AckCode::OutOfRange)
    );
    assert_eq!(
        bench.ack_of(&Ident { ms: 1001, ..ident }),
        Some(AckCode::OutOfRange)
    );
    assert_eq!(bench.ack_of(&ident), Some(AckCode::Ok));
    assert_eq!(bench.core.output()[3], [0, 77]);
    bench.at(10_000);
    assert!(bench.is_silent(), "10 ms are over");
    assert_eq!(bench.frame_ack(5), Some(AckCode::QueueFull));
    assert_eq!(bench.frame_ack(4), None, "an accepted FRAME has no ACK");
    assert_eq!(
        bench.ack_of(&Arm::new(SESSION)),
        Some(AckCode::WrongState),
        "running"
    );
    bench.bytes(
        Packet::encode(kind::FRAME, 900, &[0; 101])
            .unwrap()
            .as_bytes(),
    );
    assert_eq!(bench.last_ack().unwrap().code, AckCode::OutOfRange);
    for unknown in [0x00, 0x0a, 0x7f, kind::SAMPLES] {
        bench.bytes(Packet::encode(unknown, 9, &[0; 8]).unwrap().as_bytes());
        let ack = bench.last_ack().unwrap();
        assert_eq!((ack.kind, ack.code), (unknown, AckCode::UnknownType));
    }
}

#[test]
fn faults_refuse_and_latch_until_their_cause_is_gone() {
    let mut bench = Bench::armed();
    bench.frame(1, [9000, 9000]);
    bench.at(25_000);
    assert!(!bench.is_silent());
    let mut sink = std::mem::take(&mut bench.sink);
    bench
        .core
        .raise_fault(fault_bit::OVER_CURRENT, 5, 42, &mut sink);
    bench.sink = sink;
    assert!(bench.is_silent());
    assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Faulted));
    assert_eq!(bench.frame_ack(NEXT_TICK), Some(AckCode::Faulted));
    assert_eq!(
        bench.ack_of(&Clear { bits: 0xffff }),
        Some(AckCode::Faulted),
        "cause persists"
    );
    bench.core.end_fault_cause(fault_bit::OVER_CURRENT);
    assert_eq!(bench.ack_of(&Clear { bits: 0xffff }), Some(AckCode::Ok));
    assert_eq!(bench.core.state(), DeviceState::Ready);
}

#[test]
fn a_device_without_ident_does_not_know_it() {
    let ident = Ident {
        channel: 3,
        ms: 10,
        amp: 77,
    };
    let plain = DeviceModel {
        modes: Caps::MODE_A,
        ..DeviceModel::default()
    };
    assert_eq!(Bench::of(plain).ack_of(&ident), Some(AckCode::UnknownType));
}

#[test]
fn config_is_taken_in_ready_only() {
    let mut bench = Bench::armed();
    bench.take();
    bench.configure(&Config {
        hold_ms: 1,
        ..wish()
    });
    assert_eq!(bench.last_ack().unwrap().code, AckCode::WrongState);
    assert_eq!(bench.core.config.hold_ms, 60);
}

#[test]
fn faults_are_told_every_100_ms_in_a_session() {
    let mut bench = Bench::ready();
    let mut sink = std::mem::take(&mut bench.sink);
    bench
        .core
        .raise_fault(fault_bit::HIGH_VOLTAGE, 0xffff, 7, &mut sink);
    bench.sink = sink;
    bench.at(350_000);
    let faults = bench
        .take()
        .into_iter()
        .filter(|m| matches!(m, DeviceMessage::Fault(_)))
        .count();
    assert_eq!(faults, 4);
    bench.send(&Hello::new(9));
    assert_eq!(
        bench.core.state(),
        DeviceState::Fault,
        "HELLO does not clear"
    );
}

#[test]
fn a_new_session_is_told_of_an_old_fault_at_once() {
    let mut bench = Bench::new();
    bench.send(&Hello {
        lease_ms: 99,
        ..Hello::new(SESSION)
    });
    let mut sink = std::mem::take(&mut bench.sink);
    bench
        .core
        .raise_fault(fault_bit::OVER_CURRENT, 5, 42, &mut sink);
    // The lease ends in the very step in which the fault would be told again.
    bench.at(110_000);
    bench.send(&Hello::new(9));
    bench.take();
    bench.at(111_000);
    assert!(matches!(bench.take()[..], [DeviceMessage::Fault(_)]));
}

#[test]
fn short_payloads_and_device_types_are_bad_and_do_not_renew_the_lease() {
    let mut bench = Bench::ready();
    let kinds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 0x80, 0x84, 0xff];
    for kind in kinds {
        bench.at(500_000);
        bench.bytes(Packet::encode(kind, 1, &[0]).unwrap().as_bytes());
        assert!(bench.last_ack().is_none(), "{kind}");
    }
    assert_eq!(usize::from(bench.core.counters().bad), kinds.len());
    bench.at(1_001_000);
    assert_eq!(bench.core.state(), DeviceState::Idle);
}
