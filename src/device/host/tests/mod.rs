//! The session in virtual time: alone against scripted messages, and end to end against the device.

mod alone;
mod armed;
mod array;
mod claims;
mod latched;
mod together;

use super::clock::TICK;
use super::drive::soft_start_gain;
use super::*;
use crate::codes::Coder;
use crate::device::DeviceModel;
use crate::message::{
    Ack, AckCode, DeviceCounters, DeviceMessage, DeviceState, Fault, Stop, fault_bit, frame,
};
use crate::wire::{Faults, LinkFaults, Simulation};

const NONCE: u32 = 0x1234_5678;

fn session() -> HostSession {
    HostSession::new(NONCE, ArrayProfile::default(), 24, Sequence::default())
}

/// A STATUS of a device in this state.
fn at(tick: u32, state: DeviceState) -> DeviceMessage {
    DeviceMessage::Status(Status {
        tick,
        dev_us: tick.wrapping_mul(25_000),
        state: state.code(),
        ..Status::default()
    })
}

/// Session and device on one virtual clock.
type Pair = Simulation;

/// Brings a session alone to `Ready`, emptying its queues.
fn ready_alone(now: Instant) -> HostSession {
    let mut host = session();
    host.opened(now);
    host.on_message(
        now,
        &DeviceMessage::Caps(DeviceModel::default().caps(NONCE, 1)),
    );
    let asked = host.drive.wanted_config(&host.device);
    let effective = DeviceModel::default().clamp(&asked);
    host.on_message(now, &DeviceMessage::Cfg(effective));
    for tick in 1..=3 {
        host.on_message(now, &at(tick, DeviceState::Ready));
    }
    assert_eq!(host.state(), BridgeState::Ready);
    while host.next_packet().is_some() {}
    while host.next_event().is_some() {}
    host
}
