//! Real terminals that do not do what they should. The caller goes on; only counters, states and
//! words are asserted, never a time.
#![cfg(unix)]

use std::io::Write as _;
use std::path::PathBuf;
use std::time::Duration;

use serialport::{SerialPort as _, TTYPort};

use crate::codes::ArrayProfile;
use crate::handle::{Bridge, Target};
use crate::host::BridgeEvent;

const NAP: Duration = Duration::from_millis(2);

/// A terminal that nobody serves, and a bridge that has just been opened to it.
fn opened() -> (TTYPort, TTYPort, Bridge) {
    let (master, slave) = TTYPort::pair().unwrap();
    let target = Target::Port(PathBuf::from(slave.name().unwrap()));
    let bridge = Bridge::open(target, ArrayProfile::default(), 24, || {});
    (master, slave, bridge)
}

/// Why the link was lost; in between, `meanwhile` is done at every turn of the caller.
fn lost(bridge: &mut Bridge, mut meanwhile: impl FnMut(&mut Bridge)) -> (String, u64) {
    let mut n_turns = 0;
    loop {
        n_turns += 1;
        meanwhile(bridge);
        match bridge.poll() {
            Some(BridgeEvent::Lost(reason)) => return (reason, n_turns),
            Some(_) => {}
            None => std::thread::sleep(NAP),
        }
        assert!(n_turns < 1_000_000, "it is never lost");
    }
}

#[test]
fn a_port_that_only_says_garbage_is_given_up_with_the_reason() {
    let (mut master, _slave, mut bridge) = opened();
    let (reason, n_turns) = lost(&mut bridge, |_| {
        master.write_all(b"AT+GCAP\r\n\0").unwrap();
    });
    assert!(reason.contains("no answer within 5 s"), "{reason}");
    assert!(reason.ends_with("is not this protocol"), "{reason}");
    assert!(bridge.counters().bad_received > 10);
    assert!(n_turns > 100, "the caller went on: {n_turns} turns");
}

#[test]
fn a_port_that_takes_nothing_is_lost_and_holds_no_caller() {
    let (_master, _slave, mut bridge) = opened();
    let (reason, n_turns) = lost(&mut bridge, |bridge| {
        for _ in 0..4 {
            bridge.ping();
        }
        assert!(bridge.send(&[[1.0; 2]; 24], None).is_none());
    });
    assert!(reason.contains("stopped taking data"), "{reason}");
    assert!(bridge.counters().write_timeouts >= 2);
    // Both time-outs of 50 ms went by while the caller turned on.
    assert!(n_turns > 20, "the caller went on: {n_turns} turns");
}
