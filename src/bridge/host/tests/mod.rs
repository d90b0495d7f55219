//! The session in virtual time: alone against scripted messages, and end to end against the device.

mod alone;
mod array;
mod together;

use super::*;
use crate::bridge::device::{AppliedFrame, DeviceCore, DeviceModel, DeviceSink, Moment};
use crate::bridge::framing::Decoder;
use crate::bridge::message::{Ack, AckCode, DeviceMessage, DeviceState, Fault, fault_bit};

const NONCE: u32 = 0x1234_5678;

fn session() -> HostSession {
    HostSession::new(NONCE, ArrayProfile::default(), 24, Sequence::default())
}

/// Drops, flips and inserts bytes; the same ones in every run.
struct Noise {
    seed: u64,
    /// One byte in so many suffers.
    one_in: u64,
}

impl Noise {
    fn next(&mut self) -> u64 {
        self.seed = self
            .seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        self.seed >> 33
    }

    fn damage(&mut self, wire: &mut Vec<u8>) {
        let mut damaged = Vec::with_capacity(wire.len());
        for &byte in wire.iter() {
            let harm = self.next() % (3 * self.one_in);
            let [random, ..] = self.next().to_le_bytes();
            match harm {
                0 => {}
                1 => damaged.push(byte ^ random),
                2 => damaged.extend([random, byte]),
                _ => damaged.push(byte),
            }
        }
        *wire = damaged;
    }
}

/// Session and device on one virtual clock; the link delivers at once unless told to lose.
struct Pair {
    host: HostSession,
    device: DeviceCore,
    start: Instant,
    us: u64,
    decoder: Decoder,
    log: Log,
    events: Vec<BridgeEvent>,
    sent: Vec<(SentFrame, Vec<[f32; 2]>)>,
    amplitude_um: [f32; 2],
    cut: bool,
    /// How much faster the host's clock runs, in parts per million.
    host_ppm: i64,
    /// Damages what the host writes.
    noise: Option<Noise>,
    /// Whether ticks go unanswered.
    is_unheard: bool,
}

#[derive(Default)]
struct Log {
    bytes: Vec<u8>,
    frames: Vec<(u32, u16, Vec<[u16; 2]>)>,
}

impl DeviceSink for Log {
    fn packet(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        self.frames
            .push((frame.moment.tick, frame.seq, frame.codes.to_vec()));
    }

    fn changed(&mut self, _moment: &Moment) {}
}

impl Pair {
    fn new() -> Self {
        Self::of(DeviceModel::default())
    }

    fn of(model: DeviceModel) -> Self {
        let start = Instant::now();
        let mut host = session();
        host.opened(start);
        Self {
            host,
            device: DeviceCore::new(model),
            start,
            us: 0,
            decoder: Decoder::new(1024),
            log: Log::default(),
            events: Vec::new(),
            sent: Vec::new(),
            amplitude_um: [10.0, 20.0],
            cut: false,
            host_ppm: 0,
            noise: None,
            is_unheard: false,
        }
    }

    fn now(&self) -> Instant {
        let us = i64::try_from(self.us).unwrap();
        let host_us = us + us * self.host_ppm / 1_000_000;
        self.start + Duration::from_micros(u64::try_from(host_us).unwrap())
    }

    /// Runs for `ms`, the host acting every ms and answering every tick with a frame.
    fn run(&mut self, ms: u64) {
        for _ in 0..ms {
            self.us += 1000;
            self.device.advance(self.us, &mut self.log);
            self.deliver();
            self.host.on_time(self.now());
            self.exchange();
        }
    }

    /// As `run`, but ticks go unanswered.
    fn run_without_frames(&mut self, ms: u64) {
        self.is_unheard = true;
        self.run(ms);
        self.is_unheard = false;
    }

    fn exchange(&mut self) {
        while let Some(event) = self.host.next_event() {
            if matches!(event, BridgeEvent::Tick { .. }) {
                if self.is_unheard {
                    continue;
                }
                let amplitudes = vec![self.amplitude_um; 24];
                if let Some((stamp, packet)) = self.host.frame(self.now(), &amplitudes) {
                    self.sent.push((stamp, amplitudes));
                    self.host_writes(&packet);
                }
            } else {
                self.events.push(event);
            }
        }
        while let Some(packet) = self.host.take_stop().or_else(|| self.host.next_packet()) {
            self.host_writes(&packet);
            self.deliver();
        }
    }

    fn host_writes(&mut self, packet: &Packet) {
        let mut wire = packet.as_bytes().to_vec();
        if let Some(noise) = &mut self.noise {
            noise.damage(&mut wire);
        }
        if !self.cut {
            self.device.receive(self.us, &wire, &mut self.log);
        }
    }

    fn deliver(&mut self) {
        let bytes = std::mem::take(&mut self.log.bytes);
        if self.cut {
            return;
        }
        let now = self.now();
        for byte in bytes {
            if let Some(packet) = self.decoder.push(byte) {
                self.host
                    .on_message(now, &DeviceMessage::decode(&packet, 24).unwrap());
            }
        }
    }

    fn streaming(ms: u64) -> Self {
        let mut pair = Self::new();
        pair.run(60);
        assert_eq!(pair.host.state(), BridgeState::Ready);
        assert!(pair.host.arm(pair.now()));
        pair.run(ms);
        pair
    }

    fn disarmed_by(&self) -> Option<(DisarmedBy, &str)> {
        self.events.iter().rev().find_map(|event| match event {
            BridgeEvent::Disarmed { by, reason } => Some((*by, reason.as_str())),
            _ => None,
        })
    }

    fn lost(&self) -> Option<&str> {
        self.events.iter().find_map(|event| match event {
            BridgeEvent::Lost(reason) => Some(reason.as_str()),
            _ => None,
        })
    }
}

/// Brings a session alone to `Ready`, emptying its queues.
fn ready_alone(now: Instant) -> HostSession {
    let mut host = session();
    host.opened(now);
    host.on_message(
        now,
        &DeviceMessage::Caps(DeviceModel::default().caps(NONCE, 1)),
    );
    let config = host.wish();
    host.on_message(now, &DeviceMessage::Cfg(config));
    assert_eq!(host.state(), BridgeState::Ready);
    while host.next_packet().is_some() {}
    while host.next_event().is_some() {}
    host
}
