//! What an emulated device is wrong about: CAPS that are not so, and contactors wired otherwise
//! than they should be.

use std::num::ParseIntError;

use crate::framing::{Decoder, LARGEST_BODY, Packet};
use crate::message::{Caps, Message as _, kind};

/// Declares what can be said in CAPS although it is not so: the word for it, its value, and what
/// it does to them.
macro_rules! lies {
    ($($(#[$doc:meta])* $lie:ident($type:ty) = $key:literal, $apply:expr;)+) => {
        /// One thing that a device says in CAPS although it is not so.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Lie {
            $($(#[$doc])* $lie($type),)+
        }

        impl Lie {
            fn apply_to(self, caps: &mut Caps) {
                match self {
                    $(Self::$lie(value) => {
                        let apply: fn(&mut Caps, $type) = $apply;
                        apply(caps, value);
                    })+
                }
            }

            /// Reads a value of a key; `None` where nothing is called so.
            pub(crate) fn read(key: &str, value: &str) -> Option<Result<Self, ParseIntError>> {
                match key {
                    $($key => Some(value.parse().map(Self::$lie)),)+
                    _ => None,
                }
            }
        }
    };
}

lies! {
    /// The protocol version chosen; 0 is none.
    Version(u8) = "version", |caps, version| caps.version = version;
    /// Rows.
    Rows(u8) = "rows", |caps, rows| caps.rows = rows;
    /// Columns.
    Columns(u8) = "cols", |caps, cols| caps.cols = cols;
    /// Channels.
    Channels(u16) = "channels", |caps, n_ch| caps.n_ch = n_ch;
    /// Components a channel.
    Components(u8) = "components", |caps, n_comp| caps.n_comp = n_comp;
    /// Length of a tick in µs.
    TickUs(u32) = "tick-us", |caps, tick_us| caps.tick_us = tick_us;
    /// The lower carrier in mHz.
    LowMhz(u32) = "low-mhz", |caps, mhz| caps.freq_mhz[0] = mhz;
    /// The upper carrier in mHz.
    HighMhz(u32) = "high-mhz", |caps, mhz| caps.freq_mhz[1] = mhz;
    /// The largest body in bytes.
    MaxBody(u16) = "max-body", |caps, max_body| caps.max_body = max_body;
    /// The payload is cut after so many bytes.
    Cut(u16) = "cut", |_, _| {};
}

/// CAPS as a device with these lies sends them.
pub(super) fn caps_packet(mut caps: Caps, lies: &[Lie], seq: u16) -> Option<Packet> {
    for lie in lies {
        lie.apply_to(&mut caps);
    }
    let whole = caps.packet(seq)?;
    let cuts = lies.iter().filter_map(|lie| match lie {
        Lie::Cut(length) => Some(usize::from(*length)),
        _ => None,
    });
    let Some(length) = cuts.min() else {
        return Some(whole);
    };
    let mut decoder = Decoder::new(LARGEST_BODY);
    let payload = whole.as_bytes().iter().find_map(|&byte| {
        let packet = decoder.push(byte)?;
        Some(packet.payload.to_vec())
    })?;
    let kept = payload.get(..length).unwrap_or(&payload);
    Packet::encode(kind::CAPS, seq, kept)
}

/// How contactors are connected. The default: each to its own channel.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Miswiring {
    /// Channels that move nothing.
    pub dead: Vec<u16>,
    /// Pairs of channels that move each other's contactor.
    pub swapped: Vec<[u16; 2]>,
}

impl Miswiring {
    /// The largest channel that is named.
    pub fn largest(&self) -> Option<usize> {
        let named = self.dead.iter().chain(self.swapped.iter().flatten());
        named.copied().map(usize::from).max()
    }

    /// Turns the codes of channels into those of the contactors that move.
    pub(super) fn connect(&self, codes: &mut [[u16; 2]]) {
        for &channel in &self.dead {
            if let Some(code) = codes.get_mut(usize::from(channel)) {
                *code = [0; 2];
            }
        }
        for &pair in &self.swapped {
            let [a, b] = pair.map(usize::from);
            if a.max(b) < codes.len() {
                codes.swap(a, b);
            }
        }
    }
}
