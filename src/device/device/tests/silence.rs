//! The safety clock: hold, ramp, STOP, lease.

use super::*;

#[test]
fn silence_comes_within_100_ms_at_every_phase_and_depth() {
    for depth in 1..=3 {
        for phase_us in (0..25_000).step_by(457) {
            let mut bench = Bench::armed();
            for tick in 0..8 {
                bench.at(tick * 25_000 + phase_us);
                bench.frame(u32::try_from(tick).unwrap() + depth, [30_000, 20_000]);
            }
            let last_us = bench.now();
            bench.at(last_us + 60_000);
            assert!(!bench.is_silent(), "held at first");
            bench.at(last_us + 100_000);
            assert!(bench.is_silent(), "depth {depth}, phase {phase_us}");
            assert_eq!(bench.core.state(), DeviceState::Ready);
            assert_eq!(bench.core.moment().amp_sum, 0);
        }
    }
}

#[test]
fn the_ramp_falls_by_equal_steps_on_the_ms_clock() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    for ms in 0..=60 {
        bench.at(ms * 1000);
    }
    for ms in 61..100_u16 {
        bench.at(u64::from(ms) * 1000);
        let expected = u32::from(100 - ms) * 1000;
        assert_eq!(u32::from(bench.core.output()[0][0]), expected, "{ms} ms");
    }
    bench.at(100_000);
    assert!(bench.is_silent());
}

#[test]
fn a_frame_in_the_ramp_raises_the_gain_without_a_jump() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    bench.at(80_000);
    assert_eq!(bench.core.output()[0][0], 20_000);
    bench.frame(NEXT_TICK, [40_000, 0]);
    assert_eq!(bench.core.state(), DeviceState::Run);
    assert_eq!(bench.core.output()[0][0], 20_000);
    bench.at(90_000);
    assert_eq!(bench.core.output()[0][0], 30_000);
    bench.at(110_000);
    assert_eq!(bench.core.output()[0][0], 40_000);
}

#[test]
fn a_ramp_of_zero_is_silence_at_once() {
    let mut bench = Bench::armed_with(&Config {
        hold_ms: 20,
        ramp_ms: 0,
        ..wish()
    });
    bench.frame(NEXT_TICK, [40_000, 0]);
    bench.at(20_000);
    assert_eq!(bench.core.state(), DeviceState::Run);
    bench.at(21_000);
    assert_eq!(bench.core.state(), DeviceState::Ready);
}

#[test]
fn stop_ramps_or_ends_at_once_and_frames_meanwhile_are_refused() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    bench.at(30_000);
    assert_eq!(
        bench.ack_of(&Stop {
            reason: 0,
            how: StopHow::Ramp
        }),
        Some(AckCode::Ok)
    );
    assert_eq!(bench.core.state(), DeviceState::Ramp);
    assert_eq!(bench.frame_ack(NEXT_TICK), Some(AckCode::WrongState));
    bench.at(50_000);
    assert_eq!(bench.core.output()[0][0], 20_000);
    bench.at(70_000);
    assert_eq!(bench.core.state(), DeviceState::Ready);
    assert!(bench.is_silent());
    assert_eq!(
        bench.core.moment().age_ms,
        70,
        "the age goes on until the next ARM"
    );
    assert_eq!(
        bench.core.counters().underrun,
        0,
        "a stopped device misses nothing"
    );

    bench.send(&Arm::new(SESSION));
    bench.frame(NEXT_TICK, [40_000, 0]);
    bench.at(80_000);
    assert!(!bench.is_silent());
    bench.send(&Stop {
        reason: 0,
        how: StopHow::Now,
    });
    assert!(bench.is_silent());
    assert_eq!(bench.core.state(), DeviceState::Ready);
}

#[test]
fn the_lease_ends_a_quiet_session_and_ramps_running_output_first() {
    let mut bench = Bench::armed();
    bench.at(900_000);
    bench.send(&Ping { token: 1 });
    bench.at(1_900_000);
    assert_eq!(
        bench.core.state(),
        DeviceState::Armed,
        "a PING renews the lease"
    );
    bench.take();
    bench.at(1_901_000);
    assert_eq!(bench.core.state(), DeviceState::Idle);
    bench.at(10_000_000);
    assert!(bench.take().is_empty(), "no STATUS without a session");
    assert_eq!(bench.core.tick(), 400);

    let mut bench = Bench::new();
    bench.send(&Hello {
        lease_ms: 30,
        ..Hello::new(SESSION)
    });
    bench.configure(&wish());
    bench.send(&Arm::new(SESSION));
    bench.frame(1, [40_000, 0]);
    bench.at(31_000);
    assert_eq!(bench.core.state(), DeviceState::Ramp);
    assert_eq!(bench.core.output()[0][0], 39_000);
    bench.at(50_000);
    assert_ne!(
        bench.last_status().unwrap().faults & fault_bit::LEASE_LOST,
        0
    );
    bench.at(70_000);
    assert_eq!(bench.core.state(), DeviceState::Idle);
    assert!(bench.is_silent());
}

#[test]
fn hello_while_running_is_zero_at_once_and_a_foreign_one_changes_nothing() {
    let mut bench = Bench::armed();
    bench.frame(1, [40_000, 0]);
    bench.at(25_000);
    bench.send(&Hello {
        magic: *b"HBP2",
        ..Hello::new(7)
    });
    bench.send(&Hello::new(0));
    assert_eq!(bench.core.counters().bad, 2);
    assert_eq!(bench.core.state(), DeviceState::Run);
    bench.send(&Hello::new(7));
    assert_eq!(bench.core.state(), DeviceState::Ready);
    assert!(bench.is_silent());
    assert_eq!(
        bench.ack_of(&Arm::new(7)),
        Some(AckCode::WrongState),
        "a new session has no CONFIG"
    );
    bench.take();
    bench.send(&Hello {
        ver_min: 2,
        ver_max: 9,
        ..Hello::new(8)
    });
    let [DeviceMessage::Caps(caps)] = bench.take()[..] else {
        panic!("CAPS alone")
    };
    assert_eq!((caps.version, caps.magic), (0, MAGIC));
    assert_eq!(bench.core.state(), DeviceState::Idle);
}

#[test]
fn deadlines_miss_nothing() {
    let mut stepped = Bench::armed();
    let mut waiting = Bench::armed();
    for bench in [&mut stepped, &mut waiting] {
        bench.at(3300);
        bench.frame(NEXT_TICK, [40_000, 0]);
    }
    for us in (3300..2_000_000).step_by(100) {
        stepped.at(us);
    }
    while let Some(deadline_us) = waiting.core.next_deadline_us() {
        assert!(deadline_us > waiting.now());
        waiting.at(deadline_us);
    }
    stepped.at(2_000_000);
    assert_eq!(stepped.sink.changes, waiting.sink.changes);
    assert_eq!(stepped.take(), waiting.take());
}
