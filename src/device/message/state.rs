//! The codes that device messages carry: states, acknowledgements, fault bits.

use std::fmt;

use crate::fields::{Field, FieldReader, FieldWriter};
use selvedge_foundation::named;

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
    /// Settings or self-test are not as they should be.
    pub(crate) const SELF_TEST: u16 = 1 << 7;

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

named! {
    /// Where a device is on the way to output.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum DeviceState {
        /// No session.
        Idle = "IDLE",
        /// A session, no output.
        Ready = "READY",
        /// Output enabled, no frame yet.
        Armed = "ARMED",
        /// Frames arrive and are applied.
        Run = "RUN",
        /// A tick had no frame; the last one stays.
        Hold = "HOLD",
        /// The gain falls to zero.
        Ramp = "RAMP",
        /// A latched fault: no output.
        Fault = "FAULT",
    }
    /// The name in capitals, as the protocol writes it.
    pub fn name;
}

impl DeviceState {
    /// The code in STATUS.
    pub fn code(self) -> u8 {
        self as u8
    }

    /// The state of a code, if v1 knows it.
    pub(crate) fn from_code(code: u8) -> Option<Self> {
        Self::ALL.get(usize::from(code)).copied()
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
    /// In the order of their bytes, with a few words for people.
    const KNOWN: [(Self, &'static str); 7] = [
        (Self::Ok, "accepted"),
        (Self::BadSession, "wrong session"),
        (Self::WrongState, "not possible in this state"),
        (Self::QueueFull, "queue full"),
        (Self::UnknownType, "not understood"),
        (Self::OutOfRange, "out of range"),
        (Self::Faulted, "a fault is latched"),
    ];

    /// The code of a byte.
    pub(crate) fn from_code(code: u8) -> Self {
        let known = Self::KNOWN.get(usize::from(code));
        known.map_or(Self::Other(code), |(known, _)| *known)
    }

    /// The byte on the wire.
    pub(crate) fn code(self) -> u8 {
        let place = Self::KNOWN
            .iter()
            .zip(0..)
            .find(|((known, _), _)| *known == self);
        match (self, place) {
            (Self::Other(code), _) => code,
            (_, place) => place.map_or(0, |(_, code)| code),
        }
    }

    /// A few words for people.
    pub(crate) fn describe(self) -> String {
        let known = Self::KNOWN.iter().find(|(known, _)| *known == self);
        known.map_or_else(
            || format!("code {}", self.code()),
            |(_, words)| (*words).to_owned(),
        )
    }
}

impl Field for AckCode {
    fn read(fields: &mut FieldReader<'_>) -> Self {
        Self::from_code(fields.take())
    }

    fn write(self, fields: &mut FieldWriter) {
        fields.put(self.code());
    }
}
