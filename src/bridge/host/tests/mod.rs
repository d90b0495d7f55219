//! The session in virtual time: alone against scripted messages, and end to end against the device.

mod alone;
mod together;

use super::*;
use crate::bridge::device::{AppliedFrame, DeviceCore, DeviceModel, DeviceSink, Moment};
use crate::bridge::framing::Decoder;
use crate::bridge::message::{Ack, AckCode, DeviceMessage, DeviceState, Fault, fault_bit};

const NONCE: u32 = 0x1234_5678;

fn session() -> HostSession {
    HostSession::new(NONCE, ArrayProfile::default(), 24, Sequence::default())
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
        }
    }

    fn now(&self) -> Instant {
        self.start + Duration::from_micros(self.us)
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

    fn exchange(&mut self) {
        while let Some(event) = self.host.next_event() {
            if matches!(event, BridgeEvent::Tick { .. }) {
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
        if !self.cut {
            self.device
                .receive(self.us, packet.as_bytes(), &mut self.log);
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
