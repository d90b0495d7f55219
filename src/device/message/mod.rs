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
pub const TICK_US: u32 = 25_000;

/// Message types, as on the wire. Host to device below `80`, device to host from there on.
pub mod kind {
    /// Opens a session.
    pub const HELLO: u8 = 0x01;
    /// Asks for hold, ramp, limits and channels.
    pub const CONFIG: u8 = 0x02;
    /// Enables output.
    pub const ARM: u8 = 0x03;
    /// Amplitude codes of all channels for one tick.
    pub const FRAME: u8 = 0x04;
    /// Ends output.
    pub const STOP: u8 = 0x05;
    /// Asks for a sign of life.
    pub const PING: u8 = 0x06;
    /// Clears latched faults.
    pub const CLEAR: u8 = 0x07;
    /// Reserved: samples that a host would make; no device plays them.
    pub const SAMPLES: u8 = 0x08;
    /// Drives one contactor.
    pub const IDENT: u8 = 0x09;
    /// Types from here on travel from the device to the host.
    pub(crate) const FIRST_DEVICE: u8 = 0x80;
    /// Answers HELLO.
    pub const CAPS: u8 = 0x81;
    /// Answers CONFIG with the effective values.
    pub const CFG: u8 = 0x82;
    /// Answers requests that carry no data back.
    pub const ACK: u8 = 0x83;
    /// Sent at every tick of a session.
    pub const STATUS: u8 = 0x84;
    /// Sent every 100 ms while a fault lasts.
    pub const FAULT: u8 = 0x85;
    /// Answers PING.
    pub const PONG: u8 = 0x86;
    /// Text for people.
    pub const LOG: u8 = 0x8f;
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
                    $($field: $crate::fields::Field::read(&mut fields),)+
                };
                $(let _: $reserved = $crate::fields::Field::read(&mut fields);)?
                fields.finish(message)
            }

            fn packet(&self, seq: u16) -> Option<$crate::framing::Packet> {
                let mut fields = $crate::fields::FieldWriter::new();
                $($crate::fields::Field::write(self.$field, &mut fields);)+
                $($crate::fields::Field::write(<$reserved>::default(), &mut fields);)?
                $crate::framing::Packet::encode($kind, seq, fields.finish()?)
            }
        }
    };
}
use message;

#[cfg(test)]
mod tests;
