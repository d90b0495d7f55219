//! CONFIG and CFG: one payload, asked for by the host and answered by the device with the values in
//! effect.

use super::{FieldReader, FieldWriter, kind};
use crate::fields::{read_fields, write_fields};
use crate::framing::Packet;

/// The most channels that a v1 FRAME can carry.
pub const LARGEST_CHANNELS: usize = 253;
const MASK_WORDS: usize = LARGEST_CHANNELS.div_ceil(32);

/// Which channels may sound, one bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ChannelMask {
    words: [u32; MASK_WORDS],
}

impl ChannelMask {
    /// Channels `0..n_channels` on, the others off.
    pub(crate) fn first(n_channels: usize) -> Self {
        Self::of(n_channels, |_| true)
    }

    /// Those of channels `0..n_channels` on that are said to be.
    pub(crate) fn of(n_channels: usize, is_on: impl Fn(usize) -> bool) -> Self {
        let mut mask = Self::default();
        for channel in (0..n_channels.min(32 * MASK_WORDS)).filter(|channel| is_on(*channel)) {
            mask.words[channel / 32] |= 1 << (channel % 32);
        }
        mask
    }

    /// Whether a channel may sound.
    pub(crate) fn contains(&self, channel: usize) -> bool {
        let word = self.words.get(channel / 32).copied().unwrap_or(0);
        word >> (channel % 32) & 1 == 1
    }

    /// The channels of both masks.
    #[must_use]
    pub(crate) fn and(mut self, other: &Self) -> Self {
        for (word, other) in self.words.iter_mut().zip(other.words) {
            *word &= other;
        }
        self
    }

    /// A mask whose first 32 channels are the bits of `word`.
    #[cfg(test)]
    pub(crate) fn from_first_word(word: u32) -> Self {
        let mut mask = Self::default();
        mask.words[0] = word;
        mask
    }
}

/// Output settings. CONFIG carries what is asked, CFG the clamped values that hold.
///
/// ```text
/// 0 mode u8 | 1 flags u8 | 2 hold_ms u16 | 4 ramp_ms u16 | 6 slew u16 | 8 hv_dV u16
/// 10 comp_limit u16[2] | 14 reserved u16 | 16 ch_mask u32, one more per further 32 channels
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Config {
    /// 0: amplitudes (mode A), the only one.
    pub mode: u8,
    /// Bit 0: interpolate inside the tick.
    pub flags: u8,
    /// Age of the last accepted frame at which the ramp starts, in ms.
    pub hold_ms: u16,
    /// Duration of the ramp to silence, in ms.
    pub ramp_ms: u16,
    /// Largest change of a code per tick; 0 asks for the device's largest.
    pub slew: u16,
    /// High voltage in 0.1 V.
    pub hv_dv: u16,
    /// Largest code per component.
    pub comp_limit: [u16; 2],
    /// Channels that may sound.
    pub(crate) mask: ChannelMask,
}

impl Config {
    /// `mode`: the device makes the carriers, the host sends amplitudes.
    pub(crate) const AMPLITUDES: u8 = 0;
    /// Bit of `flags`: amplitudes move linearly inside a tick.
    pub(crate) const INTERPOLATE: u8 = 1;

    /// Reads a CONFIG or CFG payload of a device with `n_channels` channels.
    pub fn decode(payload: &[u8], n_channels: usize) -> Option<Self> {
        let mut fields = FieldReader::new(payload);
        let mut config = Self::default();
        read_fields! { fields, config {
            mode flags hold_ms ramp_ms slew hv_dv comp_limit
        } }
        let _reserved: u16 = fields.take();
        for word in config.mask.words.iter_mut().take(mask_words(n_channels)) {
            *word = fields.take();
        }
        fields.finish(config)
    }

    /// The framed CONFIG of a host.
    pub fn request(&self, seq: u16, n_channels: usize) -> Option<Packet> {
        self.packet(kind::CONFIG, seq, n_channels)
    }

    /// The framed CFG of a device.
    pub fn reply(&self, seq: u16, n_channels: usize) -> Option<Packet> {
        self.packet(kind::CFG, seq, n_channels)
    }

    fn packet(&self, kind: u8, seq: u16, n_channels: usize) -> Option<Packet> {
        let mut fields = FieldWriter::new();
        write_fields! { fields, self {
            mode flags hold_ms ramp_ms slew hv_dv comp_limit
        } }
        fields.put(0_u16);
        for &word in self.mask.words.iter().take(mask_words(n_channels)) {
            fields.put(word);
        }
        Packet::encode(kind, seq, fields.finish()?)
    }
}

fn mask_words(n_channels: usize) -> usize {
    n_channels.div_ceil(32).clamp(1, MASK_WORDS)
}
