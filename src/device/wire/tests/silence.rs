//! When output ends after the last frame, and clocks that differ for an hour.

use super::*;
use crate::device::tests::opening;
use crate::framing::Packet;
use crate::message::{DeviceCounters, frame};

/// A device that is armed through its link, without a host that would answer.
fn armed(faults: &Faults) -> (WiredDevice, Vec<u8>, u64) {
    let mut device = WiredDevice::new(DeviceModel::default(), faults);
    let mut sink = Vec::new();
    let mut at_us = 100_000;
    for packet in opening() {
        device.host_wrote(at_us, packet.as_bytes());
        at_us += 10_000;
        device.advance(at_us, &mut sink);
    }
    assert_eq!(device.core().state(), DeviceState::Armed);
    (device, sink, 250_000)
}

fn loud(seq: u16, apply_tick: u32) -> Packet {
    frame::packet(seq, apply_tick, &[[30_000, 20_000]; 24]).unwrap()
}

/// How long output lasts after the last of some frames that are written `phase_us` into each tick,
/// `depth` ticks ahead.
fn lasts_us(faults: &Faults, phase_us: u64, depth: u32) -> u64 {
    let (mut device, mut sink, start_us) = armed(faults);
    for nth in 0..8_u16 {
        let now_us = start_us + u64::from(nth) * 25_000 + phase_us;
        device.advance(now_us, &mut sink);
        let tick = device.core().tick();
        device.host_wrote(now_us, loud(10 + nth, tick + depth).as_bytes());
        device.advance(now_us, &mut sink);
    }
    let mut longest_us = 0;
    let last_us = start_us + 7 * 25_000 + phase_us;
    for after_us in (0..200_000).step_by(100) {
        device.advance(last_us + after_us, &mut sink);
        let loud_us = device.core().loud_age_us(longest_us);
        longest_us = loud_us.unwrap_or(longest_us);
    }
    assert_eq!(device.core().state(), DeviceState::Ready, "disarmed");
    assert!(device.core().output().iter().all(|codes| *codes == [0; 2]));
    longest_us
}

#[test]
fn output_ends_within_100_ms_for_every_ms_in_a_tick_every_depth_and_any_clock() {
    let slow_usb = LinkFaults {
        latency: Latency::UsbFrame,
        ..LinkFaults::default()
    };
    let cases = [
        Faults::default(),
        Faults {
            clock_ppm: 100,
            ..both(slow_usb)
        },
        Faults {
            clock_ppm: -100,
            tick_jitter_us: 3000,
            ..Faults::default()
        },
    ];
    for (nth, faults) in cases.iter().enumerate() {
        for depth in 1..=3 {
            for phase_ms in 0..25 {
                // Off the whole ms, where rounding would show.
                for phase_us in [phase_ms * 1000, phase_ms * 1000 + 637] {
                    let lasts_us = lasts_us(faults, phase_us, depth);
                    assert!(
                        (90_000..=100_000).contains(&lasts_us),
                        "case {nth}, depth {depth}, phase {phase_us} µs: {lasts_us} µs"
                    );
                }
            }
        }
    }
}

#[test]
fn a_pulled_cable_ramps_within_20_ms_and_does_not_wait_for_the_hold() {
    let unplug = OneOff {
        at_us: 800_000,
        for_us: 2_000_000,
        kind: OneOffKind::Unplug,
    };
    let faults = Faults {
        once: vec![unplug],
        ..Faults::default()
    };
    let trial = Simulation::streaming_over(&faults, 2000);
    let at = |state| {
        let change = trial.log.changes.iter().find(|it| it.state == state);
        change.map(|it| it.dev_us).unwrap()
    };
    assert!((800_000..=820_000).contains(&at(DeviceState::Ramp)));
    // IDLE is also where it began.
    let last = trial.log.changes.last().unwrap();
    assert_eq!(last.state, DeviceState::Idle);
    assert!(last.dev_us <= 860_000, "{} µs", last.dev_us);
}

/// An hour with a device's clock that differs from the host's, over USB.
fn an_hour_at(clock_ppm: i32) {
    let faults = Faults {
        clock_ppm,
        ..both(LinkFaults {
            latency: Latency::UsbFrame,
            ..LinkFaults::default()
        })
    };
    let trial = Simulation::streaming_over(&faults, 3_600_000);
    assert_eq!(trial.host.state(), BridgeState::Streaming);
    assert_eq!(trial.host.counters().device, DeviceCounters::default());
    let ticks: Vec<u32> = trial.log.frames.iter().map(|(tick, ..)| *tick).collect();
    assert!(ticks.windows(2).all(|two| two[1] == two[0] + 1), "no skip");
    assert!(ticks.len() > 143_900, "{} ticks", ticks.len());
    assert_eq!(trial.host.depth(), 1);
}

#[test]
fn a_device_100_ppm_fast_misses_no_tick_in_an_hour() {
    an_hour_at(100);
}

#[test]
fn a_device_100_ppm_slow_misses_no_tick_in_an_hour() {
    an_hour_at(-100);
}
