//! What an emulated device is wrong about: CAPS that are not so, and contactors wired otherwise
//! than they should be.

use crate::framing::{Decoder, LARGEST_BODY, Packet};
use crate::message::{Caps, Message as _, kind};

/// One thing that a device says in CAPS although it is not so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lie {
    /// The protocol version chosen; 0 is none.
    Version(u8),
    /// Rows.
    Rows(u8),
    /// Columns.
    Columns(u8),
    /// Channels.
    Channels(u16),
    /// Components a channel.
    Components(u8),
    /// Length of a tick in µs.
    TickUs(u32),
    /// The lower carrier in mHz.
    LowMhz(u32),
    /// The upper carrier in mHz.
    HighMhz(u32),
    /// The largest body in bytes.
    MaxBody(u16),
    /// The payload is cut after so many bytes.
    Cut(u16),
}

impl Lie {
    fn apply_to(self, caps: &mut Caps) {
        match self {
            Self::Version(version) => caps.version = version,
            Self::Rows(rows) => caps.rows = rows,
            Self::Columns(cols) => caps.cols = cols,
            Self::Channels(n_ch) => caps.n_ch = n_ch,
            Self::Components(n_comp) => caps.n_comp = n_comp,
            Self::TickUs(tick_us) => caps.tick_us = tick_us,
            Self::LowMhz(mhz) => caps.freq_mhz[0] = mhz,
            Self::HighMhz(mhz) => caps.freq_mhz[1] = mhz,
            Self::MaxBody(max_body) => caps.max_body = max_body,
            Self::Cut(_) => {}
        }
    }
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
