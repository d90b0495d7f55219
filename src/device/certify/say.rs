//! What is said to a device, good or bad, and what must come back.
//!
//! The framing is written anew here: a certificate that used the host's own encoder could not send
//! what the host never sends.

use crate::message::{Config, kind};

/// A packet's type, for people.
pub(super) fn kind_name(packet_kind: u8) -> String {
    let of_host = Some(packet_kind).filter(|kind| *kind < kind::FIRST_DEVICE);
    let name = of_host.and_then(kind::name);
    name.map_or_else(|| format!("type {packet_kind:02X}"), str::to_owned)
}

/// What a device must answer to one packet.
#[derive(Clone, Copy, Debug)]
pub(super) enum Want {
    /// Nothing: the packet is valid and has no answer.
    Nothing,
    /// Nothing, and `bad` rises by one although the framing is whole.
    Bad,
    /// Nothing; what is no packet at all is counted by its bytes.
    NoPacket,
    /// ACK with this code.
    Ack(u8),
    /// CAPS of this version with this session, otherwise as first heard.
    Caps(u8, u32),
    /// CFG with these values.
    Cfg(Config),
    /// PONG with this token.
    Pong(u32),
}

impl Want {
    /// Whether anything comes back.
    pub(super) fn is_answered(self) -> bool {
        !matches!(self, Self::Nothing | Self::Bad | Self::NoPacket)
    }
}

/// Bytes for the device, and its answer.
#[derive(Clone, Debug)]
pub(super) struct Say {
    pub(super) kind: u8,
    pub(super) seq: u16,
    pub(super) bytes: Vec<u8>,
    pub(super) want: Want,
}

impl Say {
    /// The same packet, with another answer.
    pub(super) fn wants(mut self, want: Want) -> Self {
        self.want = want;
        self
    }

    /// The bytes between both delimiters.
    pub(super) fn text(&self) -> &[u8] {
        self.bytes.get(1..self.bytes.len() - 1).unwrap_or(&[])
    }
}

/// A framed packet with a right CRC.
pub(super) fn packet(kind: u8, flags: u8, seq: u16, payload: &[u8]) -> Vec<u8> {
    let mut body = vec![kind, flags];
    body.extend(seq.to_le_bytes());
    body.extend(payload);
    let crc = crc32fast::hash(&body);
    body.extend(crc.to_le_bytes());
    framed(&body)
}

/// `00 | COBS(body) | 00`; a final block of 254 bytes has no trailing `01`.
fn framed(body: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0];
    let mut rest = Some(body);
    while let Some(text) = rest {
        let run = text.iter().take(254).take_while(|byte| **byte != 0).count();
        bytes.push(u8::try_from(run + 1).unwrap_or(u8::MAX));
        bytes.extend_from_slice(&text[..run]);
        // A full block stands for no zero; any other ends at one, or at the end.
        let after = if run == 254 { run } else { run + 1 };
        rest = match run {
            254 => text.get(after..).filter(|text| !text.is_empty()),
            _ => text.get(after..),
        };
    }
    bytes.push(0);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_framed_as_the_host_frames_them() {
        for length in [0, 1, 4, 240, 241, 242, 243, 244, 245, 246, 300, 600, 1000] {
            for fill in [0, 1, 7] {
                let payload = vec![fill; length];
                let ours = packet(4, 0, 0x0102, &payload);
                let host = crate::framing::Packet::encode(4, 0x0102, &payload).unwrap();
                assert_eq!(ours, host.as_bytes(), "{length} bytes of {fill}");
            }
        }
    }
}
