//! What the host sends: HELLO, ARM, FRAME, STOP, PING, CLEAR, SAMPLES, IDENT (CONFIG has its own
//! file, being two messages).

use super::{FieldReader, FieldWriter, MAGIC, kind, message};
use crate::fields::Field;

/// XOR-ed with the session to make the ARM key, so that no stray bytes arm a device.
pub(crate) const ARM_KEY: u32 = 0xa5c3_0f96;
/// The apply tick that means "the next one".
pub(crate) const NEXT_TICK: u32 = u32::MAX;

message! {
    /// Opens a session; from any state it stops, empties the queue and disarms.
    ///
    /// ```text
    /// 0 "HBP1" | 4 session u32 | 8 ver_min u8 | 9 ver_max u8 | 10 host_flags u16
    /// 12 lease_ms u16 | 14 reserved u16
    /// ```
    pub struct Hello = kind::HELLO {
        /// The first four bytes; anything but `HBP1` is not for us.
        pub magic: [u8; 4],
        /// Random, non-zero; CAPS echoes it.
        pub session: u32,
        /// Lowest version the host speaks.
        pub ver_min: u8,
        /// Highest version the host speaks.
        pub ver_max: u8,
        /// Bit 0: wants STATUS; bit 1: wants LOG.
        pub host_flags: u16,
        /// Silence after which the device ends the session, in ms; 0 means 1000.
        pub lease_ms: u16,
    } reserved u16
}

impl Hello {
    /// Bit of `host_flags` that asks for STATUS at every tick.
    pub(crate) const WANT_STATUS: u16 = 1;
    /// Bit of `host_flags` that asks for LOG.
    pub(crate) const WANT_LOG: u16 = 1 << 1;

    /// A version 1 HELLO that wants STATUS and keeps the default lease.
    pub fn new(session: u32) -> Self {
        Self {
            magic: MAGIC,
            session,
            ver_min: super::VERSION,
            ver_max: super::VERSION,
            host_flags: Self::WANT_STATUS,
            lease_ms: 0,
        }
    }
}

message! {
    /// Enables output. Only a host that knows the session can make the key.
    ///
    /// ```text
    /// 0 session u32 | 4 key u32 = session XOR A5C30F96
    /// ```
    pub struct Arm = kind::ARM {
        /// The session of HELLO.
        pub session: u32,
        /// The session XOR [`ARM_KEY`].
        pub key: u32,
    }
}

impl Arm {
    /// The one ARM that `session` accepts.
    pub fn new(session: u32) -> Self {
        Self {
            session,
            key: session ^ ARM_KEY,
        }
    }
}

/// How output ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopHow {
    /// Over the configured ramp.
    Ramp,
    /// At once, high voltage off.
    Now,
}

impl Field for StopHow {
    fn read(fields: &mut FieldReader<'_>) -> Self {
        if fields.take::<u8>() == 0 {
            Self::Ramp
        } else {
            Self::Now
        }
    }

    fn write(self, fields: &mut FieldWriter) {
        fields.put(u8::from(self == Self::Now));
    }
}

message! {
    /// Ends output in every state, without a session check.
    ///
    /// ```text
    /// 0 reason u8 | 1 how u8 (0 ramp, else zero now)
    /// ```
    pub struct Stop = kind::STOP {
        /// Free for logs.
        pub reason: u8,
        /// Ramp or at once.
        pub how: StopHow,
    }
}

message! {
    /// Asks for a PONG; renews the lease.
    ///
    /// ```text
    /// 0 token u32
    /// ```
    pub struct Ping = kind::PING {
        /// Comes back in the PONG.
        pub token: u32,
    }
}

message! {
    /// Clears latched faults whose cause is gone.
    ///
    /// ```text
    /// 0 bits u16
    /// ```
    pub struct Clear = kind::CLEAR {
        /// Fault bits to clear.
        pub bits: u16,
    }
}

message! {
    /// Drives one contactor at 320 Hz, for wiring checks.
    ///
    /// ```text
    /// 0 channel u16 | 2 ms u16 | 4 amp u16
    /// ```
    pub struct Ident = kind::IDENT {
        /// Contactor index.
        pub channel: u16,
        /// Duration in ms, at most 1000.
        pub ms: u16,
        /// Amplitude code.
        pub amp: u16,
    }
}

/// FRAME: the full state of the array for one tick. Free functions, because its length depends on
/// the device.
///
/// ```text
/// 0 apply_tick u32 (FFFFFFFF = next) | 4 per channel: A40 u16, A320 u16
/// ```
pub mod frame {
    use super::{FieldReader, FieldWriter, kind};
    use crate::framing::Packet;

    /// Payload bytes for `n_channels` channels.
    pub(crate) fn payload_len(n_channels: usize) -> usize {
        4 + 4 * n_channels
    }

    /// The framed packet; `None` beyond the largest body (253 channels).
    pub fn packet(seq: u16, apply_tick: u32, codes: &[[u16; 2]]) -> Option<Packet> {
        let mut fields = FieldWriter::new();
        fields.put(apply_tick);
        for code in codes {
            fields.put(*code);
        }
        Packet::encode(kind::FRAME, seq, fields.finish()?)
    }

    /// Reads a payload of exactly the right length into `codes` and gives the apply tick.
    pub fn decode_into(payload: &[u8], codes: &mut [[u16; 2]]) -> Option<u32> {
        if payload.len() != payload_len(codes.len()) {
            return None;
        }
        let mut fields = FieldReader::new(payload);
        let apply_tick = fields.take();
        for code in codes {
            *code = fields.take();
        }
        Some(apply_tick)
    }
}
