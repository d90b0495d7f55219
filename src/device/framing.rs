//! Framing of HBP v1: `00 | COBS(body) | 00`, the body ending in a CRC-32.
//!
//! A packet is `type u8, flags u8, seq u16, payload, crc32 u32`, all little-endian. The leading
//! zero makes a half-sent or garbage-prefixed packet cost only itself. The decoder works byte by
//! byte in bounded memory and counts, once each, every text between zeros that is not a packet. It
//! knows nothing of what a type means.
//!
//! ```text
//! 00 | cobs( type | flags | seq lo | seq hi | payload … | crc 0 | crc 1 | crc 2 | crc 3 ) | 00
//! ```

use std::fmt;

/// Bytes of a body before its payload: type, flags, seq.
pub(crate) const HEADER_LEN: usize = 4;
/// Bytes of the CRC-32 at the end of a body.
pub(crate) const CRC_LEN: usize = 4;
/// The largest body that any v1 device may announce.
pub const LARGEST_BODY: usize = 1024;
/// The largest packet: delimiters, COBS overhead of one byte per 254, body.
pub(crate) const LARGEST_PACKET: usize = LARGEST_BODY + LARGEST_BODY / 254 + 1 + 2;

/// One encoded packet, ready for a single write. `Copy`, so it crosses threads without allocation.
#[derive(Clone, Copy)]
pub struct Packet {
    bytes: [u8; LARGEST_PACKET],
    len: usize,
}

impl Packet {
    /// The lone delimiter that ends whatever a port held before.
    pub(crate) fn delimiter() -> Self {
        Self {
            bytes: [0; LARGEST_PACKET],
            len: 1,
        }
    }

    /// These bytes as they are, packet or not; `None` where they are too many for one.
    pub(crate) fn verbatim(wire: &[u8]) -> Option<Self> {
        let mut packet = Self {
            bytes: [0; LARGEST_PACKET],
            len: wire.len(),
        };
        packet.bytes.get_mut(..wire.len())?.copy_from_slice(wire);
        Some(packet)
    }

    /// Header and payload, closed by CRC-32 and framed. A payload beyond the largest body gives
    /// `None`.
    pub fn encode(kind: u8, seq: u16, payload: &[u8]) -> Option<Self> {
        let mut covered = [0; LARGEST_BODY];
        let len = HEADER_LEN + payload.len();
        let [seq_low, seq_high] = seq.to_le_bytes();
        covered[..HEADER_LEN].copy_from_slice(&[kind, 0, seq_low, seq_high]);
        covered.get_mut(HEADER_LEN..len)?.copy_from_slice(payload);
        Self::sealed(&covered[..len])
    }

    /// Header and payload as they are, closed by CRC-32 and framed; `None` beyond the largest body.
    pub(crate) fn sealed(covered: &[u8]) -> Option<Self> {
        let mut body = [0; LARGEST_BODY];
        let len = covered.len() + CRC_LEN;
        let (head, crc) = body.get_mut(..len)?.split_at_mut(covered.len());
        head.copy_from_slice(covered);
        crc.copy_from_slice(&crc32fast::hash(covered).to_le_bytes());
        Some(Self::frame(&body[..len]))
    }

    /// The bytes on the wire, both delimiters included.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes[..self.len]
    }

    /// COBS between two zeros. After a final block of 254 bytes the trailing `01` is omitted.
    fn frame(body: &[u8]) -> Self {
        let mut packet = Self {
            bytes: [0; LARGEST_PACKET],
            len: 2,
        };
        let mut code_at = 1;
        let mut run = 1;
        for (index, &byte) in body.iter().enumerate() {
            if byte != 0 {
                packet.bytes[packet.len] = byte;
                packet.len += 1;
                run += 1;
            }
            let full_with_more = run == u8::MAX && index + 1 < body.len();
            if byte == 0 || full_with_more {
                packet.bytes[code_at] = run;
                code_at = packet.len;
                packet.len += 1;
                run = 1;
            }
        }
        packet.bytes[code_at] = run;
        packet.len += 1;
        packet
    }
}

impl fmt::Debug for Packet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Packet(")?;
        for byte in self.as_bytes() {
            write!(f, " {byte:02x}")?;
        }
        f.write_str(" )")
    }
}

/// A packet that arrived whole: CRC checked, at least header and CRC long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Received<'a> {
    /// Message type.
    pub kind: u8,
    /// The sender's packet counter.
    pub seq: u16,
    /// What lies between header and CRC.
    pub payload: &'a [u8],
}

/// Splits a byte stream into packets; never holds more than `max_body` bytes.
#[derive(Clone, Debug)]
pub struct Decoder {
    body: Vec<u8>,
    max_body: usize,
    /// Data bytes still to come in the present COBS block.
    remaining: u8,
    /// Whether the present block stands for a zero after its data (its code was below 255).
    zero_after: bool,
    text: Text,
    bad: u64,
}

/// What is known of the text since the last zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Text {
    Empty,
    Growing,
    /// Too long, already counted: everything up to the next zero is dropped.
    Oversize,
}

impl Decoder {
    /// A decoder that accepts decoded bodies of at most `max_body` bytes, header and CRC included.
    pub fn new(max_body: usize) -> Self {
        Self {
            body: Vec::with_capacity(max_body),
            max_body,
            remaining: 0,
            zero_after: false,
            text: Text::Empty,
            bad: 0,
        }
    }

    /// Texts that were no packet, plus what [`count_bad`](Self::count_bad) added.
    pub fn bad(&self) -> u64 {
        self.bad
    }

    /// Bytes that it holds room for.
    #[cfg(test)]
    pub(crate) fn capacity(&self) -> usize {
        self.body.capacity()
    }

    /// Counts a packet that was whole but whose meaning was refused by the layer above.
    pub(crate) fn count_bad(&mut self) {
        self.bad += 1;
    }

    /// The flags of the packet that was completed last; 0 before the first.
    pub(crate) fn flags(&self) -> u8 {
        self.body.get(1).copied().unwrap_or(0)
    }

    /// Takes one byte; gives the packet that it completes.
    pub fn push(&mut self, byte: u8) -> Option<Received<'_>> {
        if byte == 0 {
            return self.end_of_text();
        }
        match self.text {
            Text::Oversize => return None,
            Text::Empty => self.start_text(),
            Text::Growing => {}
        }
        if self.remaining > 0 {
            self.remaining -= 1;
            self.store(byte);
        } else {
            if self.zero_after {
                self.store(0);
            }
            self.remaining = byte - 1;
            self.zero_after = byte < u8::MAX;
        }
        None
    }

    fn start_text(&mut self) {
        self.text = Text::Growing;
        self.body.clear();
        self.remaining = 0;
        self.zero_after = false;
    }

    fn store(&mut self, byte: u8) {
        if self.body.len() < self.max_body {
            self.body.push(byte);
        } else if self.text != Text::Oversize {
            self.text = Text::Oversize;
            self.bad += 1;
        }
    }

    fn end_of_text(&mut self) -> Option<Received<'_>> {
        let text = std::mem::replace(&mut self.text, Text::Empty);
        if text != Text::Growing {
            return None;
        }
        if self.remaining > 0 || !is_whole(&self.body) {
            self.bad += 1;
            return None;
        }
        let (header, rest) = self.body.split_at(HEADER_LEN);
        Some(Received {
            kind: header[0],
            seq: u16::from_le_bytes([header[2], header[3]]),
            payload: &rest[..rest.len() - CRC_LEN],
        })
    }
}

fn is_whole(body: &[u8]) -> bool {
    let Some((covered, crc)) = body.split_last_chunk::<CRC_LEN>() else {
        return false;
    };
    covered.len() >= HEADER_LEN && crc32fast::hash(covered).to_le_bytes() == *crc
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn packets(bytes: &[u8], max_body: usize) -> (Vec<(u8, u16, Vec<u8>)>, u64) {
        let mut decoder = Decoder::new(max_body);
        let mut found = Vec::new();
        for &byte in bytes {
            if let Some(packet) = decoder.push(byte) {
                found.push((packet.kind, packet.seq, packet.payload.to_vec()));
            }
        }
        (found, decoder.bad())
    }

    fn packet(payload: &[u8]) -> Vec<u8> {
        Packet::encode(4, 10, payload).unwrap().as_bytes().to_vec()
    }

    #[test]
    fn crc_has_the_check_value_and_agrees_with_another_implementation() {
        assert_eq!(crc32fast::hash(b"123456789"), 0xcbf4_3926);
        let oracle = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
        assert_eq!(oracle.checksum(b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn a_leading_zero_confines_garbage() {
        let good = packet(&[1, 2, 3]);
        let stream = [b"AT+GCAP\r\n".as_slice(), &good, &good[..7], &good].concat();
        let (found, bad) = packets(&stream, 256);
        assert_eq!((found.len(), bad), (2, 2));
    }

    #[test]
    fn empty_texts_are_ignored_and_a_lone_one_is_bad() {
        assert_eq!(packets(&[0, 0, 0, 0], 256).1, 0);
        assert_eq!(packets(&[0, 1, 0], 256).1, 1);
        assert_eq!(
            packets(&[0, 5, 1, 2, 0, 3, 0], 256).1,
            2,
            "blocks cut short"
        );
    }

    #[test]
    fn oversize_counts_once_and_resynchronises() {
        let mut stream = vec![0];
        stream.extend([7; 5000]);
        stream.push(0);
        stream.extend(packet(&[9]));
        let (found, bad) = packets(&stream, 256);
        assert_eq!((found.len(), bad), (1, 1));
    }

    #[test]
    fn the_bound_is_the_decoded_body() {
        for (payload_len, fits) in [(247, true), (248, true), (249, false)] {
            let wire = packet(&vec![1; payload_len]);
            let (found, bad) = packets(&wire, 256);
            assert_eq!(
                (found.len() == 1, bad),
                (fits, u64::from(!fits)),
                "{payload_len}"
            );
        }
        assert!(Packet::encode(4, 0, &[0; 1017]).is_none());
        assert_eq!(
            Packet::encode(4, 0, &[1; 1016]).unwrap().as_bytes().len(),
            1031
        );
    }

    #[test]
    fn a_final_full_block_may_or_may_not_carry_its_trailing_one() {
        // Behind the zero of the flags lie 2 + 248 + 4 bytes: a full block, if none of them is
        // zero.
        let packets_of = |seq| Packet::encode(0x44, seq, &[0x55; 248]).unwrap();
        let seq = (0x0101..=u16::MAX)
            .find(|seq| packets_of(*seq).as_bytes()[3] == u8::MAX)
            .unwrap();
        let wire = packets_of(seq).as_bytes().to_vec();
        assert_eq!(wire.len(), 1 + 2 + 255 + 1, "the encoder omits it");
        let longer = [&wire[..wire.len() - 1], &[1, 0]].concat();
        for wire in [wire, longer] {
            let (found, bad) = packets(&wire, 256);
            assert_eq!((found[0].1, found.len(), bad), (seq, 1, 0));
        }
    }

    #[test]
    fn every_truncation_and_bit_flip_of_a_packet_is_rejected() {
        let good = packet(&(0..100).collect::<Vec<u8>>());
        for length in 1..good.len() - 1 {
            let (found, bad) = packets(&[&good[..length], &[0]].concat(), 256);
            assert!(found.is_empty(), "cut to {length}");
            assert_eq!(bad, u64::from(length > 1));
        }
        for bit in 8..8 * (good.len() - 1) {
            let mut flipped = good.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            let (found, bad) = packets(&flipped, 256);
            assert!(found.is_empty() && bad > 0, "bit {bit}");
        }
    }

    proptest! {
        #[test]
        fn cobs_agrees_with_another_implementation(
            body in prop::collection::vec(any::<u8>(), 1..600),
        ) {
            let ours = Packet::frame(&body);
            let wire = ours.as_bytes();
            let inner = &wire[1..wire.len() - 1];
            prop_assert!(!inner.contains(&0));
            prop_assert_eq!(cobs::decode_vec(inner).unwrap(), body.clone());
            let theirs = cobs::encode_vec(&body);
            // The other encoder may write the optional trailing 01.
            prop_assert!(theirs == inner || theirs == [inner, &[1]].concat());
        }

        #[test]
        fn packets_survive_the_wire(
            kind in any::<u8>(), seq in any::<u16>(),
            payload in prop::collection::vec(prop_oneof![Just(0u8), any::<u8>()], 0..1016),
        ) {
            let wire = Packet::encode(kind, seq, &payload).unwrap();
            let (found, bad) = packets(wire.as_bytes(), LARGEST_BODY);
            prop_assert_eq!(bad, 0);
            prop_assert_eq!(found, vec![(kind, seq, payload)]);
        }

        #[test]
        fn random_bytes_stay_within_bounds(bytes in prop::collection::vec(any::<u8>(), 0..4000)) {
            let mut decoder = Decoder::new(64);
            for byte in bytes {
                prop_assert!(decoder.push(byte).is_none());
                prop_assert!(decoder.body.capacity() <= 64);
            }
        }
    }
}
