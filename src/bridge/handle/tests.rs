//! The whole link in real time against emulators: states and counters only, never durations.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;
use crate::bridge::host::DisarmedBy;
use crate::bridge::message::DeviceState;

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

fn streaming() -> Bridge {
    let (mut bridge, _) = emulated();
    until(&mut bridge, |event| matches!(event, BridgeEvent::Ready(_)));
    assert!(bridge.send(&[[10.0, 5.0]; 24], None).is_none(), "not armed");
    assert!(bridge.arm());
    until(&mut bridge, |event| *event == BridgeEvent::Armed);
    for _ in 0..10 {
        until(&mut bridge, |event| {
            matches!(event, BridgeEvent::Tick { .. })
        });
    }
    bridge
}

#[test]
fn an_emulated_device_streams_and_stops() {
    let mut bridge = streaming();
    assert_eq!(bridge.state(), BridgeState::Streaming);
    let device = bridge.status().and_then(Status::device_state);
    assert!(device.is_some_and(DeviceState::is_live));
    bridge.stop(StopHow::Ramp);
    let event = until(&mut bridge, |event| {
        matches!(event, BridgeEvent::Disarmed { .. })
    });
    assert!(matches!(
        event,
        BridgeEvent::Disarmed {
            by: DisarmedBy::Host,
            ..
        }
    ));
    let counters = bridge.counters();
    assert!(counters.frames_sent > 0);
    assert_eq!((counters.device.bad, counters.bad_received), (0, 0));
    let timings = bridge.timings();
    assert_eq!(timings.status_to_write.n, timings.stamp_to_write.n);
    assert!(timings.status_to_write.n > 0);
    bridge.close(PATIENCE).unwrap();
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
        matches!(
            event,
            BridgeEvent::Disarmed {
                by: DisarmedBy::Host,
                ..
            }
        )
    });
    assert!(stopper.join().unwrap());
    assert!(bridge.send(&[[10.0, 5.0]; 24], None).is_none());
}

#[test]
fn a_closed_bridge_has_left_the_device_at_rest() {
    streaming().close(PATIENCE).unwrap();
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
    bridge.close(PATIENCE).unwrap();
}

#[test]
fn a_display_that_does_not_match_is_refused() {
    let mut bridge = Bridge::open(Target::Emulator, ArrayProfile::default(), 25, || {});
    until(&mut bridge, |event| {
        matches!(event, BridgeEvent::Refused(_))
    });
    assert!(!bridge.arm());
}
