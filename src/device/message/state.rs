//! The codes that device messages carry: states, acknowledgements, fault bits.

use std::fmt;

/// Bits of a fault word.
pub mod fault_bit {
    /// Too hot.
    pub(crate) const OVER_TEMPERATURE: u16 = 1;
    /// Too much current.
    pub(crate) const OVER_CURRENT: u16 = 1 << 1;
    /// High voltage out of range.
    pub(crate) const HIGH_VOLTAGE: u16 = 1 << 2;
    /// The device restarted by its watchdog.
    pub(crate) const WATCHDOG: u16 = 1 << 4;
    /// The host's lease ran out (informative, never latched).
    pub(crate) const LEASE_LOST: u16 = 1 << 5;

    /// The bits' names for people, joined with commas.
    pub fn names(faults: u16) -> String {
        const NAMES: [&str; 8] = [
            "over-temperature",
            "over-current",
            "high voltage out of range",
            "converter error",
            "watchdog reset",
            "host lease lost",
            "emergency stop",
            "self-test failed",
        ];
        let named: Vec<&str> = (0..8)
            .filter(|bit| faults >> bit & 1 == 1)
            .map(|bit| NAMES[bit])
            .collect();
        if named.is_empty() {
            format!("fault {faults:#06x}")
        } else {
            named.join(", ")
        }
    }
}

/// Where a device is on the way to output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviceState {
    /// No session.
    Idle,
    /// A session, no output.
    Ready,
    /// Output enabled, no frame yet.
    Armed,
    /// Frames arrive and are applied.
    Run,
    /// A tick had no frame; the last one stays.
    Hold,
    /// The gain falls to zero.
    Ramp,
    /// A latched fault: no output.
    Fault,
}

impl DeviceState {
    /// The code in STATUS.
    pub fn code(self) -> u8 {
        match self {
            Self::Idle => 0,
            Self::Ready => 1,
            Self::Armed => 2,
            Self::Run => 3,
            Self::Hold => 4,
            Self::Ramp => 5,
            Self::Fault => 6,
        }
    }

    /// The state of a code, if v1 knows it.
    pub(crate) fn from_code(code: u8) -> Option<Self> {
        use DeviceState::{Armed, Fault, Hold, Idle, Ramp, Ready, Run};
        [Idle, Ready, Armed, Run, Hold, Ramp, Fault]
            .get(usize::from(code))
            .copied()
    }

    /// The name in capitals, as the protocol writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Idle => "IDLE",
            Self::Ready => "READY",
            Self::Armed => "ARMED",
            Self::Run => "RUN",
            Self::Hold => "HOLD",
            Self::Ramp => "RAMP",
            Self::Fault => "FAULT",
        }
    }

    /// ARMED, RUN, HOLD or RAMP: output is enabled or on its way down.
    pub fn is_live(self) -> bool {
        matches!(self, Self::Armed | Self::Run | Self::Hold | Self::Ramp)
    }
}

impl fmt::Display for DeviceState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Why a request was accepted or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AckCode {
    /// Done.
    Ok,
    /// Another session, or a wrong key.
    BadSession,
    /// Not possible in this state.
    WrongState,
    /// Too far ahead of the device's queue.
    QueueFull,
    /// Not understood.
    UnknownType,
    /// A value or length outside its range.
    OutOfRange,
    /// A fault is latched or its cause persists.
    Faulted,
    /// A code that v1 does not know.
    Other(u8),
}

impl AckCode {
    const KNOWN: [Self; 7] = [
        Self::Ok,
        Self::BadSession,
        Self::WrongState,
        Self::QueueFull,
        Self::UnknownType,
        Self::OutOfRange,
        Self::Faulted,
    ];

    /// The byte on the wire.
    pub(crate) fn code(self) -> u8 {
        match self {
            Self::Ok => 0,
            Self::BadSession => 1,
            Self::WrongState => 2,
            Self::QueueFull => 3,
            Self::UnknownType => 4,
            Self::OutOfRange => 5,
            Self::Faulted => 6,
            Self::Other(code) => code,
        }
    }

    /// The code of a byte.
    pub(crate) fn from_code(code: u8) -> Self {
        Self::KNOWN
            .get(usize::from(code))
            .copied()
            .unwrap_or(Self::Other(code))
    }

    /// A few words for people.
    pub(crate) fn describe(self) -> String {
        let words = match self {
            Self::Ok => "accepted",
            Self::BadSession => "wrong session",
            Self::WrongState => "not possible in this state",
            Self::QueueFull => "queue full",
            Self::UnknownType => "not understood",
            Self::OutOfRange => "out of range",
            Self::Faulted => "a fault is latched",
            Self::Other(code) => return format!("code {code}"),
        };
        String::from(words)
    }
}
