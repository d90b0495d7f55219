//! A million mutated packets and streams into each side: no panic, no arming, no growth.
//!
//! `SELVEDGE_MUTATIONS` sets another number than a million.

use std::time::{Duration, Instant};

use super::*;
use crate::codes::ArrayProfile;
use crate::device::DeviceCore;
use crate::device::tests::{SESSION, opening, wish};
use crate::framing::{Decoder, LARGEST_BODY, Packet};
use crate::host::{HostSession, Sequence};
use crate::message::{
    Ack, AckCode, Arm, Clear, DeviceMessage, Fault, Hello, Ident, Message as _, Ping, Pong, Status,
    Stop, StopHow, frame, kind,
};
use selvedge_foundation::numerics::Random;

fn n_mutations() -> u64 {
    let said = std::env::var("SELVEDGE_MUTATIONS").ok();
    said.and_then(|text| text.parse().ok()).unwrap_or(1_000_000)
}

/// Makes streams out of good packets.
struct Mutator {
    random: Random,
    /// Packets that may also arrive as they are, or changed under a CRC that fits.
    harmless: Vec<Vec<u8>>,
    /// Packets that only arrive harmed.
    dangerous: Vec<Vec<u8>>,
    out: Vec<u8>,
}

impl Mutator {
    fn next(&mut self) -> &[u8] {
        self.out.clear();
        match self.random.index(10) {
            0..=3 => self.harm_one(),
            4 => self.splice(),
            5 => self.noise(),
            6 => self.whole_of_random(),
            7 => self.changed_under_its_crc(),
            8 => {
                let packet = self.pick(false);
                self.out.extend(packet);
            }
            _ => self.oversize(),
        }
        &self.out
    }

    fn byte(&mut self) -> u8 {
        u8::try_from(self.random.index(256)).unwrap()
    }

    fn pick(&mut self, also_dangerous: bool) -> Vec<u8> {
        let n_dangerous = if also_dangerous {
            self.dangerous.len()
        } else {
            0
        };
        let at = self.random.index(self.harmless.len() + n_dangerous);
        let packets = self.harmless.iter().chain(&self.dangerous);
        packets.into_iter().nth(at).unwrap().clone()
    }

    /// One to four bytes between the delimiters changed, lost, added, or all from there on lost.
    fn harm_one(&mut self) {
        let mut packet = self.pick(true);
        for _ in 0..=self.random.index(4) {
            let at = 1 + self.random.index(packet.len().saturating_sub(2).max(1));
            let byte = self.byte();
            match self.random.index(4) {
                0 => packet[at] ^= byte.max(1),
                1 if packet.len() > 4 => {
                    packet.remove(at);
                }
                2 => packet.insert(at, byte),
                _ => packet.truncate(at.max(2)),
            }
        }
        // Changes may undo each other, or leave the text between the delimiters whole.
        let is_whole = |bad: &Vec<u8>| {
            let text = &bad[1..bad.len() - 1];
            packet.windows(text.len()).any(|part| part == text)
        };
        if !self.dangerous.iter().any(is_whole) {
            self.out = packet;
        }
    }

    /// The head of one packet and the tail of another.
    fn splice(&mut self) {
        let (head, tail) = (self.pick(true), self.pick(false));
        // Without its last byte at least, so that the head is never whole.
        let cut = 1 + self.random.index(head.len() - 3);
        let from = 1 + self.random.index(tail.len() - 1);
        self.out.extend(&head[..cut]);
        self.out.extend(&tail[from..]);
    }

    fn noise(&mut self) {
        for _ in 0..self.random.index(300) {
            let byte = self.byte();
            self.out.push(byte);
        }
    }

    fn whole_of_random(&mut self) {
        let payload: Vec<u8> = (0..self.random.index(140)).map(|_| self.byte()).collect();
        let (kind, seq) = (self.byte(), u16::from(self.byte()));
        let packet = Packet::encode(kind, seq, &payload).unwrap();
        self.out.extend(packet.as_bytes());
    }

    fn changed_under_its_crc(&mut self) {
        let packet = self.pick(false);
        let mut decoder = Decoder::new(LARGEST_BODY);
        let found = packet.iter().find_map(|&byte| {
            let found = decoder.push(byte)?;
            Some((found.kind, found.seq, found.payload.to_vec()))
        });
        let Some((kind, seq, mut payload)) = found else {
            return;
        };
        if kind == kind::ARM || payload.is_empty() {
            return;
        }
        for _ in 0..=self.random.index(3) {
            let at = self.random.index(payload.len());
            payload[at] = self.byte();
        }
        if self.random.index(4) == 0 {
            payload.truncate(self.random.index(payload.len()));
        }
        let packet = Packet::encode(kind, seq, &payload).unwrap();
        self.out.extend(packet.as_bytes());
    }

    /// Without an end, rarely long: no buffer may grow with it.
    fn oversize(&mut self) {
        let length = if self.random.index(50) == 0 { 5000 } else { 20 };
        let byte = self.byte();
        self.out.resize(length, byte);
    }
}

#[expect(
    clippy::large_types_passed_by_value,
    reason = "what an encoder gives goes in as it is"
)]
fn wire(packet: Option<Packet>) -> Vec<u8> {
    packet.unwrap().as_bytes().to_vec()
}

fn to_device() -> Mutator {
    let stop = Stop {
        reason: 0,
        how: StopHow::Ramp,
    };
    let ident = Ident {
        channel: 3,
        ms: 900,
        amp: 30_000,
    };
    // The right session with a key that never fits it.
    let mut wrong = Arm::new(SESSION);
    wrong.key ^= 1;
    Mutator {
        random: Random::new(17),
        harmless: vec![
            wire(Hello::new(SESSION).packet(1)),
            wire(wish().request(2, 24)),
            wire(wrong.packet(3)),
            wire(frame::packet(4, 7, &[[40_000, 20_000]; 24])),
            wire(stop.packet(5)),
            wire(Ping { token: 9 }.packet(6)),
            wire(Clear { bits: u16::MAX }.packet(7)),
            wire(ident.packet(8)),
        ],
        dangerous: vec![wire(Arm::new(SESSION).packet(9))],
        out: Vec::new(),
    }
}

#[test]
fn a_million_mutated_packets_neither_arm_nor_grow_a_device() {
    let mut mutator = to_device();
    let mut core = DeviceCore::new(DeviceModel::default());
    let mut answers: Vec<u8> = Vec::new();
    for packet in &opening()[..2] {
        core.receive(0, packet.as_bytes(), &mut answers);
    }
    let held = core.held();
    let mut now_us = 0;
    for nth in 0..n_mutations() {
        now_us += 700;
        answers.clear();
        core.receive(now_us, mutator.next(), &mut answers);
        assert!(!core.state().is_live(), "mutation {nth} armed it");
        // One answer a packet, and a STATUS; most of what comes is a packet of some 20 bytes.
        assert!(answers.len() <= 2000, "mutation {nth}: {}", answers.len());
        assert_eq!(core.held(), held, "mutation {nth}");
    }
    assert!(core.output().iter().all(|codes| *codes == [0; 2]));
}

#[test]
fn an_armed_device_under_mutated_packets_keeps_its_bounds_and_falls_silent() {
    let mut mutator = to_device();
    let mut core = DeviceCore::new(DeviceModel::default());
    let mut answers: Vec<u8> = Vec::new();
    let mut now_us = 0;
    let mut n_loud = 0;
    for nth in 0..n_mutations() / 10 {
        if nth % 500 == 0 {
            for packet in opening() {
                core.receive(now_us, packet.as_bytes(), &mut answers);
            }
        }
        answers.clear();
        now_us += 700;
        core.receive(now_us, mutator.next(), &mut answers);
        assert_eq!(core.loud_age_us(100_000), None, "mutation {nth}");
        n_loud += u32::from(core.moment().amp_sum > 0);
    }
    assert!(n_loud > 100, "frames among them sounded: {n_loud}");
    core.advance(now_us + 200_000, &mut answers);
    assert!(core.output().iter().all(|codes| *codes == [0; 2]));
}

fn to_host() -> Mutator {
    let caps = DeviceModel::default().caps(SESSION, 1);
    let status = |state: u8| Status {
        tick: 40,
        state,
        ..Status::default()
    };
    let ack = |kind, code| Ack { kind, code, seq: 3 };
    let fault = Fault {
        faults: 1,
        channel: 3,
        value: 9000,
        tick: 50,
    };
    let pong = Pong {
        token: 1,
        dev_us: 2,
        tick: 3,
        phase_us: 4,
    };
    let mut harmless = vec![
        wire(caps.packet(1)),
        wire(DeviceModel::default().clamp(&wish()).reply(2, 24)),
        wire(fault.packet(4)),
        wire(pong.packet(5)),
        wire(Packet::encode(kind::LOG, 6, b"a line of text")),
    ];
    harmless.extend((0..8).map(|state| wire(status(state).packet(7))));
    for (acked, code) in [
        (kind::ARM, AckCode::Ok),
        (kind::STOP, AckCode::Ok),
        (kind::CONFIG, AckCode::Faulted),
        (kind::FRAME, AckCode::WrongState),
    ] {
        harmless.push(wire(ack(acked, code).packet(8)));
    }
    Mutator {
        random: Random::new(18),
        harmless,
        dangerous: Vec::new(),
        out: Vec::new(),
    }
}

/// A host that nobody has told to arm, and what it writes.
struct Host {
    session: HostSession,
    decoder: Decoder,
    held: usize,
}

impl Host {
    fn new(now: Instant) -> Self {
        let profile = ArrayProfile::default();
        let mut session = HostSession::new(SESSION, profile, 24, Sequence::default());
        session.opened(now);
        Self {
            held: session.held(),
            session,
            decoder: Decoder::new(LARGEST_BODY),
        }
    }

    fn take(&mut self, now: Instant, bytes: &[u8]) {
        for &byte in bytes {
            if let Some(packet) = self.decoder.push(byte)
                && let Ok(message) = DeviceMessage::decode(&packet, 24)
            {
                self.session.on_message(now, &message);
            }
        }
        self.session.on_time(now);
    }

    /// A true STATUS of a device at rest between the mutated ones.
    fn tick(&mut self, now: Instant, nth: u64) {
        let status = Status {
            tick: u32::try_from(1000 + nth).unwrap_or(u32::MAX),
            state: DeviceState::Ready.code(),
            ..Status::default()
        };
        self.take(now, &wire(status.packet(9)));
    }

    fn check(&mut self, nth: u64) {
        assert!(!self.session.state().is_live(), "mutation {nth} armed it");
        assert_eq!(self.session.held(), self.held, "mutation {nth}");
        assert!(self.decoder.capacity() <= LARGEST_BODY, "mutation {nth}");
        while let Some(packet) = self.session.next_packet() {
            let kind = packet.as_bytes().get(2).copied();
            assert!(kind != Some(kind::ARM), "mutation {nth}: ARM");
            assert!(kind != Some(kind::FRAME), "mutation {nth}: FRAME");
        }
    }
}

#[test]
fn a_million_mutated_packets_neither_arm_nor_grow_a_host() {
    let mut mutator = to_host();
    let mut now = Instant::now();
    let mut host = Host::new(now);
    let mut n_ready = 0;
    for nth in 0..n_mutations() {
        now += Duration::from_millis(1);
        host.take(now, mutator.next());
        if nth % 25 == 0 {
            host.tick(now, nth / 25);
        }
        host.check(nth);
        n_ready += u64::from(host.session.state() == BridgeState::Ready);
        // News pile up for a while, as with an owner that is busy.
        if nth % 100 == 0 {
            while host.session.next_event().is_some() {}
            if !host.session.state().is_open() || nth % 1000 == 0 {
                host = Host::new(now);
            }
        }
    }
    assert!(n_ready > n_mutations() / 100, "it got far: {n_ready}");
}
