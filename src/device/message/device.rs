//! What the device sends: ACK, STATUS, FAULT, PONG, LOG, and the sum of all its messages.

use std::fmt;

use super::{AckCode, Caps, Config, DeviceState, Message as _, kind, message};
use crate::framing::{Packet, Received};

message! {
    /// Answers ARM, STOP, CLEAR, IDENT, and whatever was refused.
    ///
    /// ```text
    /// 0 acked type u8 | 1 code u8 | 2 acked seq u16
    /// ```
    pub struct Ack = kind::ACK {
        /// Type of the packet answered.
        pub kind: u8,
        /// What became of it.
        pub(crate) code: AckCode,
        /// Seq of the packet answered.
        pub seq: u16,
    }
}

message! {
    /// The device at the start of a tick, the frame of that tick applied. Counters run from boot
    /// and wrap at 65536.
    ///
    /// ```text
    /// 0 tick u32 | 4 dev_us u32 | 8 last_seq u16 | 10 state u8 | 11 queued u8
    /// 12 underrun u16 | 14 late u16 | 16 dup u16
    /// 18 bad u16 | 20 clipped u16 | 22 hv_dV u16 | 24 i_mA u16
    /// 26 temp i16 | 28 faults u16 | 30 age_ms u16 | 32 amp_sum u32
    /// ```
    #[derive(Default)]
    pub struct Status = kind::STATUS {
        /// Ticks since boot.
        pub tick: u32,
        /// Device clock in µs, modulo 2³².
        pub dev_us: u32,
        /// Seq of the last accepted FRAME of this session.
        pub last_seq: u16,
        /// State code, see [`DeviceState`].
        pub state: u8,
        /// Frames waiting for later ticks.
        pub queued: u8,
        /// Ticks without a frame while armed.
        pub underrun: u16,
        /// Frames for a tick that had passed.
        pub late: u16,
        /// Repeated frames.
        pub dup: u16,
        /// Texts that were no packet.
        pub bad: u16,
        /// Values above the limit and channels over full drive.
        pub clipped: u16,
        /// Measured high voltage in 0.1 V.
        pub hv_dv: u16,
        /// Measured current in mA.
        pub i_ma: u16,
        /// Temperature in 0.01 °C.
        pub temp_cdeg: i16,
        /// Fault bits.
        pub faults: u16,
        /// Age of the last accepted frame in ms; 65535 = none or older.
        pub age_ms: u16,
        /// Sum of all output codes after gain, rounded down.
        pub amp_sum: u32,
    }
}

impl Status {
    /// The state, if v1 knows its code.
    pub(crate) fn device_state(&self) -> Option<DeviceState> {
        DeviceState::from_code(self.state)
    }
}

message! {
    /// Something is wrong; repeated every 100 ms until cleared.
    ///
    /// ```text
    /// 0 faults u16 | 2 channel u16 (FFFF none) | 4 value i32 | 8 tick u32
    /// ```
    pub struct Fault = kind::FAULT {
        /// Fault bits.
        pub faults: u16,
        /// Channel concerned, 65535 = none.
        pub channel: u16,
        /// Measured value in the fault's own unit.
        pub value: i32,
        /// Tick at which it was seen.
        pub tick: u32,
    }
}

message! {
    /// Answers PING with the device's clock.
    ///
    /// ```text
    /// 0 token u32 | 4 dev_us u32 | 8 tick u32 | 12 phase_us u16
    /// ```
    pub struct Pong = kind::PONG {
        /// Of the PING.
        pub token: u32,
        /// Device clock in µs, modulo 2³².
        pub dev_us: u32,
        /// Present tick.
        pub tick: u32,
        /// Time since the tick began in µs.
        pub phase_us: u16,
    }
}

/// The first bytes of a LOG text; `Copy`, so it crosses threads without allocation.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct LogText {
    bytes: [u8; 120],
    len: usize,
}

impl LogText {
    fn new(payload: &[u8]) -> Self {
        let mut text = Self {
            bytes: [0; 120],
            len: payload.len().min(120),
        };
        text.bytes[..text.len].copy_from_slice(&payload[..text.len]);
        text
    }

    /// The framed LOG of a device; a text that is too long is cut.
    pub fn packet(seq: u16, text: &str) -> Option<Packet> {
        let bytes = text.as_bytes();
        Packet::encode(kind::LOG, seq, &bytes[..bytes.len().min(120)])
    }

    /// The text in one line, as [`escaped`].
    pub(crate) fn to_line(self) -> String {
        escaped(&self.bytes[..self.len])
    }
}

impl fmt::Debug for LogText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "LogText({:?})", self.to_line())
    }
}

/// Words of a device in one line: control characters are shown escaped, what is no UTF-8 replaced.
pub(super) fn escaped(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let mut line = String::with_capacity(text.len());
    for letter in text.trim_end().chars() {
        if letter.is_control() {
            line.extend(letter.escape_default());
        } else {
            line.push(letter);
        }
    }
    line
}

/// Any message of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviceMessage {
    /// Answer to HELLO.
    Caps(Caps),
    /// Answer to CONFIG.
    Cfg(Config),
    /// Answer to most other requests.
    Ack(Ack),
    /// A tick.
    Status(Status),
    /// A fault.
    Fault(Fault),
    /// Answer to PING.
    Pong(Pong),
    /// Text.
    Log(LogText),
}

/// Why a whole packet is no message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unreadable {
    /// Its payload is shorter than its table.
    Short,
    /// Its type is not known, or not one that a device sends.
    UnknownKind,
}

impl DeviceMessage {
    /// Reads a packet from a device with `n_channels` channels.
    pub fn decode(packet: &Received<'_>, n_channels: usize) -> Result<Self, Unreadable> {
        let payload = packet.payload;
        let message = match packet.kind {
            kind::CAPS => Caps::decode(payload).map(Self::Caps),
            kind::CFG => Config::decode(payload, n_channels).map(Self::Cfg),
            kind::ACK => Ack::decode(payload).map(Self::Ack),
            kind::STATUS => Status::decode(payload).map(Self::Status),
            kind::FAULT => Fault::decode(payload).map(Self::Fault),
            kind::PONG => Pong::decode(payload).map(Self::Pong),
            kind::LOG => Some(Self::Log(LogText::new(payload))),
            _ => return Err(Unreadable::UnknownKind),
        };
        message.ok_or(Unreadable::Short)
    }
}

/// The device's counters since this session began; the wire's wrap at 65536 is undone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DeviceCounters {
    /// Ticks without a frame while armed.
    pub underrun: u64,
    /// Frames that came after their tick had begun.
    pub late: u64,
    /// Repeated frames.
    pub dup: u64,
    /// Texts that were no packet.
    pub bad: u64,
    /// Values and channels that the device had to lower.
    pub clipped: u64,
}

impl DeviceCounters {
    /// Adds what happened between two STATUS.
    pub(crate) fn add(&mut self, before: &Status, now: &Status) {
        let difference = |now: u16, before: u16| u64::from(now.wrapping_sub(before));
        self.underrun += difference(now.underrun, before.underrun);
        self.late += difference(now.late, before.late);
        self.dup += difference(now.dup, before.dup);
        self.bad += difference(now.bad, before.bad);
        self.clipped += difference(now.clipped, before.clipped);
    }
}
