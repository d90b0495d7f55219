//! What is worth a line in the log of a link.
//!
//! Plain values, so that writing one down neither allocates nor waits; only what has a text of its
//! own (why a link was lost) brings it along.

use std::time::{Duration, Instant};

use crate::message::{AckCode, Caps, Config, DeviceCounters, Fault, Status, StopHow};

/// One thing that happened on a link.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub at: Instant,
    /// The device's tick and its clock in µs, wraps undone, as far as they are known.
    pub tick: Option<u32>,
    pub(crate) device_us: Option<u64>,
    pub note: Note,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Note {
    /// HELLO was sent with this session number.
    Hello(u32),
    /// The device says what it is.
    Caps(Caps),
    /// These settings were asked for.
    Config(Config),
    /// These settings hold.
    Effective(Config),
    /// ARM was sent.
    Arm,
    /// The device enabled output.
    Armed,
    /// STOP was sent.
    Stop(StopHow),
    /// The all-off switch, a signal or a panic sent STOP past everything else.
    StopBySwitch(StopHow),
    /// STOP was acknowledged.
    Stopped,
    /// CLEAR was sent.
    Clear,
    /// CLEAR was accepted.
    Cleared,
    /// The device refused a message of this type.
    Refused(u8, AckCode),
    /// The device reports a fault.
    Fault(Fault),
    /// The device is in another state, by its code.
    State(u8),
    /// What the device measures of itself, and the largest `amp_sum` that our frames predict.
    Telemetry(Status, f64),
    /// Counters of the device since the session began, after a change.
    DeviceCounters(DeviceCounters),
    /// Counters of this side since the link was opened, after a change.
    HostCounters(HostCounters),
    /// How many ticks ahead frames are sent, and how long before them they are due.
    Depth(u8, Duration),
    /// Something with words of its own: an event's name and its text.
    Said(&'static str, String),
    /// So many entries found no room.
    Missing(u64),
}

/// What this side counts that ought to stay at zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct HostCounters {
    pub rejected: u64,
    pub superseded: u64,
    pub bad_received: u64,
    pub events_dropped: u64,
    pub write_timeouts: u64,
}
