//! The whole link in real time against emulators: states and counters only, never durations.

#[cfg(unix)]
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
#[cfg(unix)]
use crate::Coder;
use crate::device::DeviceModel;
use crate::message::{DeviceState, Status};
use crate::wire::Faults;
use selvedge_scratch::ScratchFolder;

const PATIENCE: Duration = Duration::from_secs(20);

fn emulated() -> (Bridge, Arc<AtomicUsize>) {
    let wakes = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&wakes);
    let bridge = Bridge::open(Target::Emulator, ArrayProfile::default(), 24, move || {
        counted.fetch_add(1, Ordering::Relaxed);
    });
    (bridge, wakes)
}

/// Polls, answering ticks, until an event satisfies `wanted`.
fn until(bridge: &mut Bridge, wanted: impl Fn(&BridgeEvent) -> bool) -> BridgeEvent {
    let deadline = Instant::now() + PATIENCE;
    while Instant::now() < deadline {
        let Some(event) = bridge.poll() else {
            std::thread::sleep(Duration::from_millis(1));
            continue;
        };
        if let BridgeEvent::Tick { received, .. } = event {
            bridge.send(&[[10.0, 5.0]; 24], Some(received));
        }
        if wanted(&event) {
            return event;
        }
    }
    panic!("not seen in state {}", bridge.state());
}

/// Ends output, waits until the device is at rest, and lets go of it.
pub(crate) fn rested(mut bridge: Bridge) {
    bridge.stop(StopHow::Ramp);
    let deadline = Instant::now() + PATIENCE;
    while bridge.session().is_ending() {
        assert!(Instant::now() < deadline, "not at rest: {}", bridge.state());
        if bridge.poll().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
    assert_eq!(bridge.state(), BridgeState::Ready);
    bridge.close(PATIENCE);
}

fn streaming() -> Bridge {
    let (mut bridge, _) = emulated();
    until(&mut bridge, |event| matches!(event, BridgeEvent::Ready(_)));
    assert!(bridge.send(&[[10.0, 5.0]; 24], None).is_none(), "not armed");
    // A machine that starves this thread for 100 ms disarms the device, as it should: try again.
    for _ in 0..20 {
        assert!(bridge.arm());
        until(&mut bridge, |event| *event == BridgeEvent::Armed);
        for _ in 0..10 {
            until(&mut bridge, |event| {
                matches!(event, BridgeEvent::Tick { .. })
            });
        }
        if bridge.state() == BridgeState::Streaming {
            return bridge;
        }
        until(&mut bridge, |event| {
            matches!(event, BridgeEvent::Tick { .. })
        });
    }
    panic!("never streaming: {}", bridge.state());
}

#[test]
fn an_emulated_device_streams_and_stops() {
    let mut bridge = streaming();
    assert_eq!(bridge.state(), BridgeState::Streaming);
    let device = bridge.session().status().and_then(Status::device_state);
    assert!(device.is_some_and(DeviceState::is_live));
    bridge.stop(StopHow::Ramp);
    until(&mut bridge, |event| {
        matches!(event, BridgeEvent::Disarmed { .. })
    });
    let counters = bridge.counters();
    assert!(counters.frames_sent > 0);
    assert_eq!((counters.device.bad, counters.bad_received), (0, 0));
    let timings = bridge.timings();
    assert_eq!(timings.due_to_write.n, timings.stamp_to_write.n);
    assert!(timings.due_to_write.n > 0);
    rested(bridge);
}

#[test]
fn a_bridge_may_move_to_the_engines_thread() {
    fn moves<T: Send>(_: &T) {}
    let (bridge, _) = emulated();
    moves(&bridge);
}

#[test]
fn pings_come_back() {
    let (mut bridge, wakes) = emulated();
    until(&mut bridge, |event| matches!(event, BridgeEvent::Ready(_)));
    bridge.ping();
    until(&mut bridge, |event| {
        matches!(event, BridgeEvent::Pong { .. })
    });
    assert!(wakes.load(Ordering::Relaxed) > 0);
}

#[test]
fn a_stop_handle_stops_from_another_thread() {
    let mut bridge = streaming();
    let handle = bridge.stop_handle().unwrap();
    let stopper = std::thread::Builder::new()
        .spawn(move || {
            handle.stop(StopHow::Now);
            handle.wait_written(PATIENCE)
        })
        .unwrap();
    until(&mut bridge, |event| {
        matches!(event, BridgeEvent::Disarmed { .. })
    });
    assert!(stopper.join().unwrap());
    assert!(bridge.send(&[[10.0, 5.0]; 24], None).is_none());
}

#[test]
fn a_bridge_that_is_closed_while_it_streams_says_stop() {
    let bridge = streaming();
    let shared = bridge.stop_handle().unwrap();
    bridge.close(PATIENCE);
    assert!(shared.wait_written(Duration::ZERO), "STOP was written");
}

#[test]
fn a_port_that_is_not_there_is_lost_with_a_line() {
    let target = Target::Port(std::env::temp_dir().join("no-such-port"));
    let mut bridge = Bridge::open(target, ArrayProfile::default(), 24, || {});
    let event = until(&mut bridge, |event| matches!(event, BridgeEvent::Lost(_)));
    let BridgeEvent::Lost(reason) = event else {
        unreachable!("waited for Lost")
    };
    assert!(reason.contains("no such port"), "{reason}");
    assert_eq!(bridge.state(), BridgeState::Lost);
}

#[test]
fn a_display_that_does_not_match_is_refused() {
    let mut bridge = Bridge::open(Target::Emulator, ArrayProfile::default(), 25, || {});
    until(&mut bridge, |event| {
        matches!(event, BridgeEvent::Refused(_))
    });
    assert!(!bridge.arm());
}

/// What was sent, by seq.
#[cfg(unix)]
type Sent = BTreeMap<u16, (SentFrame, Vec<[f32; 2]>)>;

#[cfg(unix)]
fn check_log(text: &str, sent: &Sent) {
    let profile = ArrayProfile::default();
    let mut ticks = Vec::new();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        if fields[2] != "frame" {
            continue;
        }
        ticks.push(fields[1].parse::<u32>().unwrap());
        let (stamp, amplitudes_um) = &sent[&fields[4].parse::<u16>().unwrap()];
        let expected = Coder::new(&profile, 24).encode(amplitudes_um, stamp.gain);
        let logged: Vec<u16> = fields[8..]
            .iter()
            .map(|code| code.parse().unwrap())
            .collect();
        assert_eq!(logged, expected.concat());
    }
    assert!(
        !ticks.is_empty() && ticks.is_sorted_by(|a, b| a < b),
        "{ticks:?}"
    );
    assert!(
        text.lines().last().unwrap().contains(",READY,"),
        "ends at rest"
    );
}

/// What the device logged as applied is what was sent, code for code, over a real terminal.
#[cfg(unix)]
#[test]
fn every_frame_that_the_device_logged_holds_the_codes_of_its_amplitudes() {
    use std::fs;
    use std::sync::atomic::AtomicBool;

    use crate::emulator::PtyEmulator;

    let folder = ScratchFolder::made("stream");
    let (link, log) = (folder.join("array"), folder.join("log.csv"));
    let emulator = PtyEmulator::new(
        DeviceModel::default(),
        &Faults::default(),
        &link,
        Some(&log),
    )
    .unwrap();
    let ended = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&ended);
    let device = std::thread::Builder::new()
        .spawn(move || emulator.run(&seen, |_, _| {}))
        .unwrap();

    let mut bridge = Bridge::open(Target::Port(link), ArrayProfile::default(), 24, || {});
    until(&mut bridge, |event| matches!(event, BridgeEvent::Ready(_)));
    assert!(bridge.arm());
    let mut sent = Sent::new();
    let deadline = Instant::now() + PATIENCE;
    while sent.len() < 60 && bridge.state().is_live() && Instant::now() < deadline {
        if !matches!(bridge.poll(), Some(BridgeEvent::Tick { .. })) {
            std::thread::sleep(Duration::from_millis(1));
            continue;
        }
        let step = f32::from(u8::try_from(sent.len()).unwrap());
        let amplitudes_um: Vec<[f32; 2]> = (0..24_u8)
            .map(|index| [f32::from(index) + 0.1 * step, 40.0 - step])
            .collect();
        if let Some(stamp) = bridge.send(&amplitudes_um, None) {
            sent.insert(stamp.seq, (stamp, amplitudes_um));
        }
    }
    rested(bridge);
    ended.store(true, Ordering::Release);
    device.join().unwrap().unwrap();

    check_log(&fs::read_to_string(&log).unwrap(), &sent);
}

/// Letting a port go takes a moment; whoever opens it again at once need not know.
#[cfg(unix)]
#[test]
fn a_port_can_be_opened_again_at_once() {
    use std::sync::atomic::AtomicBool;

    use crate::emulator::PtyEmulator;

    let folder = ScratchFolder::made("again");
    let link = folder.join("array");
    let emulator =
        PtyEmulator::new(DeviceModel::default(), &Faults::default(), &link, None).unwrap();
    let ended = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&ended);
    let device = std::thread::Builder::new()
        .spawn(move || emulator.run(&seen, |_, _| {}))
        .unwrap();
    for _ in 0..3 {
        let target = Target::Port(link.clone());
        let mut bridge = Bridge::open(target, ArrayProfile::default(), 24, || {});
        until(&mut bridge, |event| matches!(event, BridgeEvent::Ready(_)));
        drop(bridge);
    }
    ended.store(true, Ordering::Release);
    device.join().unwrap().unwrap();
}
