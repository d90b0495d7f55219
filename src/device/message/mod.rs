//! The messages of HBP v1: one struct a message, its byte table beside its encoder and decoder.
//!
//! Offsets in the tables are within the payload; all integers are little-endian. Payloads may grow
//! in later 1.x versions: trailing bytes are ignored, missing ones are an error. Meaning (what a
//! device does with a message) lives elsewhere.

mod caps;
mod config;
mod device;
mod host;
mod state;

pub use caps::Caps;
pub(crate) use config::ChannelMask;
pub use config::{Config, LARGEST_CHANNELS};
pub use device::{Ack, DeviceCounters, DeviceMessage, Fault, LogText, Pong, Status, Unreadable};
pub(crate) use host::{ARM_KEY, NEXT_TICK};
pub use host::{Arm, Clear, Hello, Ident, Ping, Stop, StopHow, frame};
pub(crate) use state::AckCode;
pub use state::{DeviceState, fault_bit};

use super::fields::{FieldReader, FieldWriter};
use super::framing::Packet;

/// The four bytes that open HELLO and CAPS.
pub(crate) const MAGIC: [u8; 4] = *b"HBP1";
/// The only protocol version so far.
pub(crate) const VERSION: u8 = 1;
/// Device tick in µs: every amplitude lasts one tick, in which both carriers complete whole
/// periods.
pub(crate) const TICK_US: u32 = 25_000;

macro_rules! kinds {
    ($($(#[doc = $doc:literal])+ $kind:ident = $code:literal;)+) => {
        /// Message types, as on the wire. Host to device below `80`, device to host from there on.
        pub mod kind {
            $($(#[doc = $doc])+ pub const $kind: u8 = $code;)+
            /// Types from here on travel from the device to the host.
            pub(crate) const FIRST_DEVICE: u8 = 0x80;
            const NAMES: &[(u8, &str)] = &[$(($code, stringify!($kind))),+];

            /// The name of a type, if it is one.
            pub(crate) fn name(kind: u8) -> Option<&'static str> {
                let known = NAMES.iter().find(|(known, _)| *known == kind);
                known.map(|(_, name)| *name)
            }

            /// The type of a name.
            pub(crate) fn of_name(name: &str) -> Option<u8> {
                let known = NAMES.iter().find(|(_, known)| *known == name);
                known.map(|(kind, _)| *kind)
            }
        }
    };
}

kinds! {
    /// Opens a session.
    HELLO = 0x01;
    /// Asks for hold, ramp, limits and channels.
    CONFIG = 0x02;
    /// Enables output.
    ARM = 0x03;
    /// Amplitude codes of all channels for one tick.
    FRAME = 0x04;
    /// Ends output.
    STOP = 0x05;
    /// Asks for a sign of life.
    PING = 0x06;
    /// Clears latched faults.
    CLEAR = 0x07;
    /// Reserved: samples that a host would make; no device plays them.
    SAMPLES = 0x08;
    /// Drives one contactor.
    IDENT = 0x09;
    /// Answers HELLO.
    CAPS = 0x81;
    /// Answers CONFIG with the effective values.
    CFG = 0x82;
    /// Answers requests that carry no data back.
    ACK = 0x83;
    /// Sent at every tick of a session.
    STATUS = 0x84;
    /// Sent every 100 ms while a fault lasts.
    FAULT = 0x85;
    /// Answers PING.
    PONG = 0x86;
    /// Text for people.
    LOG = 0x8f;
}

/// A message with a fixed type and a payload of named fields.
pub trait Message: Sized {
    /// Its type on the wire.
    const KIND: u8;
    /// Reads a payload; `None` when it is shorter than the table.
    fn decode(payload: &[u8]) -> Option<Self>;
    /// The framed packet; `None` when the payload exceeds the largest body.
    fn packet(&self, seq: u16) -> Option<Packet>;
}

/// Declares a message with the fields of its table in order, and what is reserved after them.
macro_rules! message {
    ($(#[$meta:meta])* pub struct $message:ident = $kind:path {
        $($(#[$doc:meta])* $vis:vis $field:ident: $type:ty,)+
    } $(reserved $reserved:ty)?) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $message {
            $($(#[$doc])* $vis $field: $type,)+
        }

        impl $crate::message::Message for $message {
            const KIND: u8 = $kind;

            fn decode(payload: &[u8]) -> Option<Self> {
                let mut fields = $crate::fields::FieldReader::new(payload);
                let message = Self {
                    $($field: fields.take(),)+
                };
                $(let _: $reserved = fields.take();)?
                fields.finish(message)
            }

            fn packet(&self, seq: u16) -> Option<$crate::framing::Packet> {
                let mut fields = $crate::fields::FieldWriter::new();
                $(fields.put(self.$field);)+
                $(fields.put(<$reserved>::default());)?
                $crate::framing::Packet::encode($kind, seq, fields.finish()?)
            }
        }
    };
}
use message;

#[cfg(test)]
mod tests;
