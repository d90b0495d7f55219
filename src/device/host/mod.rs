//! The host's side of HBP v1 as a pure state machine: device messages and time in, packets and
//! events out.
//!
//! It greets, checks, configures, arms, stamps frames with their apply tick and soft-start gain,
//! keeps the lease, repeats what was not answered, and notices a device that disarms itself or
//! falls silent. It owns no port, no thread and no clock (callers say what time it is), and it
//! never arms on its own.

mod array;
mod asking;
mod claims;
mod clock;
mod drive;
mod ending;
mod evidence;
mod frames;
mod ident;
mod latching;
mod noise;
mod notes;
mod pending;
mod prediction;
mod replies;
mod report;
mod reported;
mod ticks;
mod timers;
mod watch;

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU16, Ordering};
use std::time::{Duration, Instant};

use super::codes::{ArrayProfile, LinkScale};
use super::framing::Packet;
use super::message::{Caps, Message as _, Ping, Status, StopHow, kind};
use super::session_log::{Entry, Note};
pub use array::ArrayChange;
pub use clock::ClockFit;
use clock::DeviceClock;
use drive::Drive;
use evidence::Evidence;
use latching::Latching;
pub(crate) use noise::Heard;
use noise::Noise;
use notes::Notes;
use pending::{Identifying, Pending, Pings, Presence};
use prediction::{Lasting, Prediction};
pub use report::{BridgeCounters, BridgeEvent, BridgeState, DisarmedBy, SentFrame};
use reported::Reported;
pub(crate) use ticks::LONGEST_JUMP;
use ticks::Ticks;

const MAX_EVENTS: usize = 64;
const MAX_PACKETS: usize = 16;

/// The host's packet counter, shared by everything that may send on one link.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sequence(Arc<AtomicU16>);

impl Sequence {
    /// The next number; wraps.
    pub(crate) fn next(&self) -> u16 {
        self.0.fetch_add(1, Ordering::Relaxed)
    }
}

/// What goes to the device.
#[derive(Debug)]
struct Outbox {
    sequence: Sequence,
    packets: VecDeque<Packet>,
    /// A STOP, ahead of all of them.
    stop_packet: Option<Packet>,
    last_sent: Option<Instant>,
}

impl Outbox {
    fn queue(&mut self, packet: Option<&Packet>, now: Instant) {
        if let Some(packet) = packet
            && self.packets.len() < MAX_PACKETS
        {
            self.packets.push_back(*packet);
            self.last_sent = Some(now);
        }
    }
}

/// The STOP under way.
#[derive(Debug)]
struct Stopping {
    pending: Option<Pending>,
    /// When it was acknowledged: the device is to come to rest.
    obeyed: Option<Instant>,
    how: StopHow,
    /// Whether it ends output, rather than making sure of rest.
    ends_output: bool,
}

/// One session with one device.
#[derive(Debug)]
pub struct HostSession {
    nonce: u32,
    state: BridgeState,
    device: Reported,
    drive: Drive,
    outbox: Outbox,
    request: Option<Pending>,
    stopping: Stopping,
    pings: Pings,
    ident: Option<Identifying>,
    frames_rejected: u64,
    clock: DeviceClock,
    latching: Latching,
    evidence: Evidence,
    presence: Presence,
    ticks: Ticks,
    prediction: Prediction,
    noise: Noise,
    notes: Notes,
    events: VecDeque<BridgeEvent>,
}

impl HostSession {
    /// A session that will greet with `nonce` (random; 0 becomes 1) once the port is open.
    pub(crate) fn new(
        nonce: u32,
        profile: ArrayProfile,
        n_contactors: usize,
        sequence: Sequence,
    ) -> Self {
        Self {
            nonce: nonce.max(1),
            state: BridgeState::Opening,
            device: Reported::default(),
            drive: Drive::new(profile, n_contactors),
            outbox: Outbox {
                sequence,
                packets: VecDeque::with_capacity(MAX_PACKETS),
                stop_packet: None,
                last_sent: None,
            },
            request: None,
            stopping: Stopping {
                pending: None,
                obeyed: None,
                how: StopHow::Ramp,
                ends_output: false,
            },
            pings: Pings::default(),
            ident: None,
            frames_rejected: 0,
            clock: DeviceClock::new(),
            latching: Latching::new(),
            evidence: Evidence::default(),
            presence: Presence::default(),
            ticks: Ticks::default(),
            prediction: Prediction::default(),
            noise: Noise::default(),
            notes: Notes::default(),
            events: VecDeque::with_capacity(MAX_EVENTS),
        }
    }

    /// The port is open and its input purged: ends whatever text it held, then greets.
    pub fn opened(&mut self, now: Instant) {
        if self.state != BridgeState::Opening {
            return;
        }
        self.state = BridgeState::Greeting;
        self.outbox.queue(Some(&Packet::delimiter()), now);
        self.request(kind::HELLO, now);
    }

    /// The port failed or could not be opened.
    pub(crate) fn link_gone(&mut self, now: Instant, reason: String) {
        self.lose(now, reason);
    }

    /// Asks for output. True when ARM went out; `Armed` or `Disarmed` follows. Only from `Ready`.
    pub fn arm(&mut self, now: Instant) -> bool {
        if self.state != BridgeState::Ready {
            return false;
        }
        self.state = BridgeState::Arming;
        self.drive.begin();
        self.prediction.begin();
        self.request(kind::ARM, now);
        true
    }

    /// Ends output, ahead of everything else, in any state with an open port.
    pub fn stop(&mut self, now: Instant, how: StopHow) {
        if self.state == BridgeState::Opening || !self.state.is_open() {
            return;
        }
        // A gentler wish never softens a STOP under way.
        if self.stopping.pending.is_none() || how == StopHow::Now {
            self.stopping.how = how;
        }
        self.stopping.ends_output |= self.state.is_live() && self.state != BridgeState::Stopping;
        if self.state.is_live() || self.state == BridgeState::Ready {
            self.request = None;
            self.outbox.packets.clear();
            self.state = BridgeState::Stopping;
        }
        let mut stopping = Pending::new(kind::STOP, now);
        self.send_stop(&mut stopping, now);
        self.stopping.obeyed = None;
        // A device that has not answered HELLO cannot be expected to answer STOP.
        self.stopping.pending = self.device.caps.is_some().then_some(stopping);
    }

    /// Asks the device to clear all latched faults.
    pub fn clear_faults(&mut self, now: Instant) {
        if self.state == BridgeState::Faulted {
            self.request(kind::CLEAR, now);
        }
    }

    /// Sends a PING; `Pong` follows.
    pub(crate) fn ping(&mut self, now: Instant) {
        let seq = self.outbox.sequence.next();
        let token = u32::from(seq) | self.nonce << 16;
        self.pings.under_way = Some((token, now));
        self.pings.last = Some(now);
        self.outbox.queue(Ping { token }.packet(seq).as_ref(), now);
    }

    /// The next packet to write, STOP excepted.
    pub(crate) fn next_packet(&mut self) -> Option<Packet> {
        self.outbox.packets.pop_front()
    }

    /// A STOP to write ahead of everything else.
    pub(crate) fn take_stop(&mut self) -> Option<Packet> {
        self.outbox.stop_packet.take()
    }

    /// The next piece of news.
    pub(crate) fn next_event(&mut self) -> Option<BridgeEvent> {
        self.events.pop_front()
    }

    /// Where the session stands.
    pub fn state(&self) -> BridgeState {
        self.state
    }

    /// The device's CAPS, once accepted.
    pub fn caps(&self) -> Option<&Caps> {
        self.device.caps.as_ref()
    }

    /// What the device makes of codes: its limits in force, or before it is configured its largest.
    pub fn link_scale(&self) -> Option<LinkScale> {
        let caps = self.device.caps?;
        let config = self.device.config;
        Some(LinkScale {
            comp_limit: config.map_or(caps.comp_limit, |config| config.comp_limit),
            fs_mv: caps.fs_mv,
        })
    }

    /// The last STATUS.
    pub fn status(&self) -> Option<&Status> {
        self.device.status.as_ref()
    }

    /// The largest `amp_sum` that our own frames allow the device at its last tick.
    pub fn predicted_sum(&self) -> f64 {
        self.prediction.last_bound()
    }

    /// Whether the device may still be moving, or has not acknowledged the last STOP.
    pub(crate) fn is_ending(&self) -> bool {
        self.state.is_live() || self.stopping.pending.is_some()
    }

    /// The device's tick now, by its last STATUS and the time since; `None` without a base.
    pub(crate) fn present_tick(&self, now: Instant) -> Option<u32> {
        let is_known = self.state.is_open() && self.ticks.is_set();
        is_known.then(|| self.device.present_tick(now))
    }

    /// How many ticks ahead frames are sent, 1…3.
    pub fn depth(&self) -> u8 {
        self.latching.depth()
    }

    /// How long before the tick in which it is felt a frame is due.
    pub fn lead(&self) -> Duration {
        self.latching.lead()
    }

    /// What is known of the device's clock.
    pub fn clock(&self) -> ClockFit {
        self.clock.fit_view()
    }

    /// The counters that a session knows; those of the link's threads are 0.
    pub fn counters(&self) -> BridgeCounters {
        BridgeCounters {
            device: self.device.counters,
            codes: self.drive.coder.counters(),
            frames_rejected: self.frames_rejected,
            stray_status: self.ticks.n_strays(),
            ..BridgeCounters::default()
        }
    }

    /// How much it holds room for: events, packets, codes.
    #[cfg(test)]
    pub fn held(&self) -> usize {
        self.events.capacity() + self.outbox.packets.capacity() + self.drive.codes.capacity()
    }

    /// From now on what happens is written down. Allocates.
    pub fn keep_notes(&mut self) {
        self.notes.begin();
    }

    /// The next thing that was written down.
    pub(crate) fn next_note(&mut self) -> Option<Entry> {
        self.notes.next()
    }

    /// Writes something down, with the times of host and device.
    pub(crate) fn note(&mut self, now: Instant, note: Note) {
        let tick = self.device.status.map(|_| self.device.present_tick(now));
        let device_us = self.clock.device_us(now);
        self.notes.add(Entry {
            at: now,
            tick,
            device_us,
            note,
        });
    }

    /// What makes amplitudes last in the device.
    fn lasting(&self) -> Lasting {
        let config = self.device.config.unwrap_or_default();
        let n_codes = 2 * self.drive.n_contactors;
        Lasting {
            silencing_ms: u32::from(config.hold_ms) + u32::from(config.ramp_ms),
            depth: self.latching.depth(),
            fall: n_codes as f64 * f64::from(config.slew),
        }
    }

    fn event(&mut self, event: BridgeEvent) {
        if self.events.len() >= MAX_EVENTS {
            // Ticks are the only news that comes in numbers, and an old one is worth nothing.
            self.events.pop_front();
        }
        self.events.push_back(event);
    }
}

#[cfg(test)]
mod tests;
