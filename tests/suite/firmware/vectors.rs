//! The golden vectors: reading their file, and the packets against our framing and messages.

use std::fs;

use selvedge_device::{
    Arm, Clear, Config, Decoder, DeviceMessage, Hello, Ident, Message, Packet, Ping, Received,
    Stop, frame, kind,
};

use super::layout;
use super::reference::{bytes, hex};
use super::tools::kit;

/// A packet in words and on the wire.
pub(crate) struct GoldenPacket {
    pub(crate) name: String,
    pub(crate) said: String,
    pub(crate) wire: Vec<u8>,
}

/// Bytes of which something is no packet.
struct Invalid {
    name: String,
    /// Largest body of the receiver.
    limit: usize,
    /// By how much `bad` rises.
    bad: u64,
    /// Packets that are found nevertheless.
    found: usize,
    wire: Vec<u8>,
}

/// The whole file.
#[derive(Default)]
pub(crate) struct Vectors {
    pub(crate) packets: Vec<GoldenPacket>,
    invalid: Vec<Invalid>,
    /// Name and lines.
    pub(crate) sessions: Vec<(String, Vec<String>)>,
}

impl Vectors {
    /// The lines of a session.
    pub(crate) fn session(&self, name: &str) -> Vec<String> {
        let found = self.sessions.iter().find(|session| session.0 == name);
        found
            .unwrap_or_else(|| panic!("no session {name}"))
            .1
            .clone()
    }

    fn take(&mut self, block: &[&str]) {
        let (word, name) = block[0].split_once(' ').unwrap();
        let lines = &block[1..];
        let of = |key: &str| {
            let mut values = lines.iter().filter_map(|line| line.strip_prefix(key));
            values.next().map(str::trim)
        };
        let wire = || bytes(of("wire ").unwrap_or_else(|| panic!("{name} has no wire")));
        let name = name.to_owned();
        match word {
            "packet" => self.packets.push(GoldenPacket {
                said: of("say ").unwrap().to_owned(),
                wire: wire(),
                name,
            }),
            "invalid" => self.invalid.push(Invalid {
                limit: of("limit ").map_or(256, |limit| limit.parse().unwrap()),
                bad: of("bad ").map_or(1, |bad| bad.parse().unwrap()),
                found: of("found ").map_or(0, |found| found.parse().unwrap()),
                wire: wire(),
                name,
            }),
            "session" => {
                let lines = lines.iter().map(|line| String::from(*line)).collect();
                self.sessions.push((name, lines));
            }
            _ => panic!("vectors.txt: no such block: {word}"),
        }
    }
}

/// Reads the file: blocks of a heading and its lines; `#` begins a comment.
pub(crate) fn read() -> Vectors {
    let text = fs::read_to_string(kit().join("vectors.txt")).unwrap();
    let lines = text.lines().map(|line| line.split('#').next().unwrap());
    let lines: Vec<&str> = lines
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect();
    let is_heading = |line: &&str| {
        let word = line.split(' ').next().unwrap();
        ["packet", "invalid", "session"].contains(&word)
    };
    let mut vectors = Vectors::default();
    for block in lines.chunk_by(|_, next| !is_heading(next)) {
        vectors.take(block);
    }
    vectors
}

/// The packet in words as bytes on the wire.
pub(crate) fn wire_of(said: &str) -> Vec<u8> {
    let (kind, seq, payload) = layout::encode(said);
    Packet::encode(kind, seq, &payload)
        .unwrap()
        .as_bytes()
        .to_vec()
}

/// Every cut and every flipped bit of `wire` between its delimiters.
pub(crate) fn damaged(wire: &[u8]) -> Vec<Vec<u8>> {
    let cut = (2..wire.len() - 1).map(|length| [&wire[..length], &[0]].concat());
    let bent = (8..8 * (wire.len() - 1)).map(|bit| {
        let mut bent = wire.to_vec();
        bent[bit / 8] ^= 1 << (bit % 8);
        bent
    });
    cut.chain(bent).collect()
}

fn decode(wire: &[u8], limit: usize) -> (Vec<(u8, u16, Vec<u8>)>, u64) {
    let mut decoder = Decoder::new(limit);
    let mut found = Vec::new();
    for &byte in wire {
        if let Some(packet) = decoder.push(byte) {
            found.push((packet.kind, packet.seq, packet.payload.to_vec()));
        }
    }
    (found, decoder.bad())
}

/// What the library makes of a packet: read by its own tables and written again.
fn again(packet: &Received<'_>) -> Option<Packet> {
    fn message<M: Message>(packet: &Received<'_>) -> Option<Packet> {
        M::decode(packet.payload)?.packet(packet.seq)
    }
    match packet.kind {
        kind::HELLO => message::<Hello>(packet),
        kind::CONFIG => Config::decode(packet.payload, 24)?.request(packet.seq, 24),
        kind::ARM => message::<Arm>(packet),
        kind::FRAME => {
            let mut codes = vec![[0; 2]; 24];
            let tick = frame::decode_into(packet.payload, &mut codes)?;
            frame::packet(packet.seq, tick, &codes)
        }
        kind::STOP => message::<Stop>(packet),
        kind::PING => message::<Ping>(packet),
        kind::CLEAR => message::<Clear>(packet),
        kind::IDENT => message::<Ident>(packet),
        _ => match DeviceMessage::decode(packet, 24).ok()? {
            DeviceMessage::Caps(caps) => caps.packet(packet.seq),
            DeviceMessage::Cfg(config) => config.reply(packet.seq, 24),
            DeviceMessage::Ack(ack) => ack.packet(packet.seq),
            DeviceMessage::Status(status) => status.packet(packet.seq),
            DeviceMessage::Fault(fault) => fault.packet(packet.seq),
            DeviceMessage::Pong(pong) => pong.packet(packet.seq),
            DeviceMessage::Log(_) => None,
        },
    }
}

#[test]
fn golden_packets_say_in_words_what_they_are_on_the_wire() {
    let packets = read().packets;
    let mut kinds: Vec<u8> = Vec::new();
    for packet in &packets {
        let wire = wire_of(&packet.said);
        assert_eq!(hex(&wire), hex(&packet.wire), "{}: wire", packet.name);
        let (found, bad) = decode(&packet.wire, 1024);
        assert_eq!((found.len(), bad), (1, 0), "{}", packet.name);
        let (kind, seq, payload) = &found[0];
        kinds.push(*kind);
        let received = Received {
            kind: *kind,
            seq: *seq,
            payload,
        };
        // LOG and SAMPLES are read or refused, never written; the rest comes back as it was.
        if ![kind::LOG, kind::SAMPLES].contains(kind) && !packet.name.contains("appended") {
            let again = again(&received).unwrap_or_else(|| panic!("{} is read", packet.name));
            assert_eq!(hex(again.as_bytes()), hex(&packet.wire), "{}", packet.name);
        }
    }
    let every = (0x01..=0x09).chain(0x81..=0x86).chain([0x8f]);
    for kind in every {
        assert!(kinds.contains(&kind), "no golden packet of type {kind:02x}");
    }
}

#[test]
fn no_damaged_golden_packet_is_taken() {
    for packet in read().packets {
        for wire in damaged(&packet.wire) {
            let (found, bad) = decode(&wire, 1024);
            assert!(
                found.is_empty() && bad > 0,
                "{}: {}",
                packet.name,
                hex(&wire)
            );
        }
    }
}

#[test]
fn invalid_texts_are_counted_as_the_vectors_say() {
    let invalid = read().invalid;
    assert!(invalid.len() >= 10, "{}", invalid.len());
    for text in invalid {
        let (found, bad) = decode(&text.wire, text.limit);
        assert_eq!((found.len(), bad), (text.found, text.bad), "{}", text.name);
    }
}
