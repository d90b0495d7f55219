//! A host and a device at the two ends of a failing link, in virtual time: what tests and studies
//! try the protocol with.
//!
//! The host acts whenever something arrives and every 5 ms, answers each tick with one frame, and
//! does nothing else by itself: whoever runs the simulation arms, opens anew and clears faults.

use std::time::{Duration, Instant};

use super::wired::WireSink;
use super::{Faults, Injection, WiredDevice};
use crate::codes::ArrayProfile;
use crate::device::{AppliedFrame, DeviceModel, DeviceSink, Moment};
use crate::framing::{Decoder, LARGEST_BODY, Packet};
use crate::host::{BridgeEvent, BridgeState, DisarmedBy, Heard, HostSession, SentFrame, Sequence};
use crate::message::{DeviceMessage, kind};

/// Contactors of the simulated display, and channels of the usual device.
const N_CONTACTORS: usize = 24;
const MS_US: u64 = 1000;
/// How often the host acts when nothing arrives.
const HOST_EVERY_US: u64 = 5 * MS_US;
const NONCE: u32 = 0x1234_5678;

/// Host, link and device on one virtual clock.
#[derive(Debug)]
pub struct Simulation {
    /// The host.
    pub host: HostSession,
    /// The device and its link.
    pub device: WiredDevice,
    /// The host's clock when virtual time was 0.
    pub start: Instant,
    /// True time, µs.
    pub us: u64,
    /// What the device did.
    pub log: SimulationLog,
    /// What the host told, ticks and pongs left out.
    pub events: Vec<BridgeEvent>,
    /// Every frame that the host wrote.
    pub sent: Vec<SentFrame>,
    /// Amplitudes of every contactor in every frame, µm.
    pub amplitude_um: [f32; 2],
    /// Whether nothing arrives, either way.
    pub cut: bool,
    /// Whether ticks go unanswered.
    is_unheard: bool,
    /// How much faster the host's clock runs, in parts per million.
    pub(crate) host_ppm: i64,
    /// The longest time from an accepted frame to a moment with output, µs of device time.
    pub loudest_age_us: u64,
    /// Texts from the device that were no packet or no message.
    pub bad_received: u64,
    bytes_received: u64,
    /// ARM packets that the host wrote.
    pub arms_written: u32,
    /// What a log of the link holds, if one is kept.
    #[cfg(test)]
    pub(crate) record: Option<crate::session_log::VirtualLog>,
    decoder: Decoder,
    n_visits: u32,
}

/// What the device did.
#[derive(Debug, Default)]
pub struct SimulationLog {
    arrived: Vec<u8>,
    /// Tick, seq and codes of every frame that took effect.
    pub frames: Vec<(u32, u16, Vec<[u16; 2]>)>,
    /// Every change of state.
    pub changes: Vec<Moment>,
    /// Every injected fault.
    pub injections: Vec<Injection>,
}

impl DeviceSink for SimulationLog {
    fn packet(&mut self, bytes: &[u8]) {
        self.arrived.extend_from_slice(bytes);
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        self.frames
            .push((frame.moment.tick, frame.seq, frame.codes.to_vec()));
    }

    fn changed(&mut self, moment: &Moment) {
        self.changes.push(*moment);
    }
}

impl WireSink for SimulationLog {
    fn injected(&mut self, _moment: &Moment, injection: &Injection) {
        self.injections.push(*injection);
    }
}

impl Simulation {
    /// A host that has just opened the port of a device without faults.
    #[cfg(test)]
    pub(crate) fn new() -> Self {
        Self::of(DeviceModel::default(), &Faults::default())
    }

    /// A host that has just opened the port of this device.
    pub fn of(model: DeviceModel, faults: &Faults) -> Self {
        let start = Instant::now();
        let mut host = session(NONCE);
        host.opened(start);
        Self {
            host,
            device: WiredDevice::new(model, faults),
            start,
            us: 0,
            log: SimulationLog::default(),
            events: Vec::new(),
            sent: Vec::new(),
            amplitude_um: [10.0, 20.0],
            cut: false,
            is_unheard: false,
            host_ppm: 0,
            loudest_age_us: 0,
            bad_received: 0,
            bytes_received: 0,
            arms_written: 0,
            #[cfg(test)]
            record: None,
            decoder: Decoder::new(LARGEST_BODY),
            n_visits: 0,
        }
    }

    /// Runs until the device may be armed, arms it, and goes on for `ms`.
    pub fn streaming(ms: u64) -> Self {
        Self::streaming_over(&Faults::default(), ms)
    }

    /// The same over a link and with a device that have these faults.
    pub fn streaming_over(faults: &Faults, ms: u64) -> Self {
        let mut simulation = Self::of(DeviceModel::default(), faults);
        simulation.arm_and_run(ms);
        simulation
    }

    fn arm_and_run(&mut self, ms: u64) {
        self.run_until(5000, |it| it.host.state() == BridgeState::Ready);
        self.host.arm(self.now());
        self.run(ms);
    }

    /// The host's clock.
    pub fn now(&self) -> Instant {
        let us = i64::try_from(self.us).unwrap_or(i64::MAX / 2);
        let host_us =
            us + us / 1_000_000 * self.host_ppm + us % 1_000_000 * self.host_ppm / 1_000_000;
        self.start + Duration::from_micros(u64::try_from(host_us).unwrap_or(0))
    }

    /// Lets so many ms pass.
    pub fn run(&mut self, ms: u64) {
        let end_us = self.us + ms * MS_US;
        while self.us < end_us {
            let host_us = (self.us / HOST_EVERY_US + 1) * HOST_EVERY_US;
            let turn_us = host_us.min(end_us);
            let next_us = self.device.next_deadline_us().unwrap_or(turn_us);
            self.us = next_us.clamp(self.us, turn_us);
            self.meet();
            if self.us == turn_us {
                self.host.heard(self.now(), self.heard());
                self.host.on_time(self.now());
                self.exchange();
            }
        }
    }

    /// As `run`, but ticks go unanswered.
    pub fn run_without_frames(&mut self, ms: u64) {
        self.is_unheard = true;
        self.run(ms);
        self.is_unheard = false;
    }

    /// Runs until `is_so`, at most `ms`; whether it became so.
    pub fn run_until(&mut self, ms: u64, is_so: impl Fn(&Self) -> bool) -> bool {
        for _ in 0..ms {
            if is_so(self) {
                return true;
            }
            self.run(1);
        }
        is_so(self)
    }

    /// The port is closed and opened anew, as a person would do: another session, not armed.
    pub fn open_anew(&mut self) {
        self.n_visits += 1;
        self.host = session(NONCE.wrapping_add(self.n_visits));
        #[cfg(test)]
        if self.record.is_some() {
            self.host.keep_notes();
        }
        self.decoder = Decoder::new(LARGEST_BODY);
        self.host.opened(self.now());
        self.exchange();
    }

    /// Writes a packet as the host would.
    #[cfg(test)]
    pub(crate) fn host_writes(&mut self, packet: &Packet) {
        if !self.cut {
            self.device.host_wrote(self.us, packet.as_bytes());
        }
        self.meet();
    }

    /// Who ended output last, and why.
    pub fn disarmed_by(&self) -> Option<(DisarmedBy, &str)> {
        self.events.iter().rev().find_map(|event| match event {
            BridgeEvent::Disarmed { by, reason } => Some((*by, reason.as_str())),
            _ => None,
        })
    }

    /// Why the link was lost first, if it was.
    pub fn lost(&self) -> Option<&str> {
        self.events.iter().find_map(|event| match event {
            BridgeEvent::Lost(reason) => Some(reason.as_str()),
            _ => None,
        })
    }

    /// Why the device was refused, if it was.
    pub fn refused(&self) -> Option<&str> {
        self.events.iter().find_map(|event| match event {
            BridgeEvent::Refused(reason) => Some(reason.as_str()),
            _ => None,
        })
    }

    /// Whether any contactor is driven.
    pub fn is_loud(&self) -> bool {
        self.device
            .core()
            .output()
            .iter()
            .any(|codes| *codes != [0; 2])
    }

    /// Device and host at this moment.
    fn meet(&mut self) {
        self.device.advance(self.us, &mut self.log);
        let loud_us = self.device.core().loud_age_us(self.loudest_age_us);
        self.loudest_age_us = loud_us.unwrap_or(self.loudest_age_us);
        if !self.device.is_plugged() {
            // What a reader of the port would find at once.
            let reason = String::from("the device is gone: check the cable");
            self.host.link_gone(self.now(), reason);
        }
        self.deliver();
        self.exchange();
    }

    fn deliver(&mut self) {
        let bytes = std::mem::take(&mut self.log.arrived);
        if self.cut || !self.host.state().is_open() {
            return;
        }
        let now = self.now();
        self.bytes_received += u64::try_from(bytes.len()).unwrap_or(u64::MAX);
        for byte in bytes {
            let Some(packet) = self.decoder.push(byte) else {
                continue;
            };
            #[cfg(test)]
            if let Some(record) = &mut self.record
                && let Some(body) = crate::session_log::Body::new(&packet)
            {
                record.received(now, &body);
            }
            match DeviceMessage::decode(&packet, N_CONTACTORS) {
                Ok(message) => self.host.on_message(now, &message),
                Err(_) => self.bad_received += 1,
            }
        }
    }

    fn exchange(&mut self) {
        loop {
            while let Some(event) = self.host.next_event() {
                self.hear(event);
            }
            let Some(packet) = self.host.take_stop().or_else(|| self.host.next_packet()) else {
                return;
            };
            self.write(&packet);
        }
    }

    fn hear(&mut self, event: BridgeEvent) {
        match event {
            BridgeEvent::Tick { .. } if self.is_unheard => {}
            BridgeEvent::Tick { .. } => self.answer(),
            BridgeEvent::Pong { .. } => {}
            other => self.events.push(other),
        }
    }

    fn answer(&mut self) {
        let (now, amplitudes) = (self.now(), [self.amplitude_um; N_CONTACTORS]);
        if let Some((stamp, packet)) = self.host.frame(now, &amplitudes) {
            self.sent.push(stamp);
            self.write(&packet);
        }
    }

    fn write(&mut self, packet: &Packet) {
        self.arms_written += u32::from(is_arm(packet));
        #[cfg(test)]
        self.record_sent(packet);
        if self.cut {
            return;
        }
        self.device.host_wrote(self.us, packet.as_bytes());
        self.device.advance(self.us, &mut self.log);
        self.deliver();
    }

    fn heard(&self) -> Heard {
        Heard {
            bytes: self.bytes_received,
            bad: self.bad_texts_received(),
        }
    }

    #[cfg(test)]
    fn record_sent(&mut self, packet: &Packet) {
        let now = self.now();
        if let Some(record) = &mut self.record {
            record.sent(now, packet);
            while let Some(entry) = self.host.next_note() {
                record.entry(entry);
            }
        }
    }

    /// Texts that were no packet to the host's decoder.
    pub fn bad_texts_received(&self) -> u64 {
        self.decoder.bad() + self.bad_received
    }

    /// Whether the device is at rest: output neither there nor enabled.
    pub fn is_at_rest(&self) -> bool {
        !self.device.core().state().is_live() && !self.is_loud()
    }
}

fn is_arm(packet: &Packet) -> bool {
    // Behind the delimiter and the first COBS code lies the type, which is never 0.
    packet.as_bytes().get(2) == Some(&kind::ARM)
}

fn session(nonce: u32) -> HostSession {
    HostSession::new(
        nonce,
        ArrayProfile::default(),
        N_CONTACTORS,
        Sequence::default(),
    )
}
