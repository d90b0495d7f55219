//! The host's side of HBP v1 as a pure state machine: device messages and time in, packets and
//! events out.
//!
//! It greets, checks, configures, arms, stamps frames with their apply tick and soft-start gain,
//! keeps the lease, repeats what was not answered, and notices a device that disarms itself or
//! falls silent. It owns no port, no thread and no clock (callers say what time it is), and it
//! never arms on its own.

mod array;
mod checks;
mod clock;
mod delays;
mod frames;
mod ident;
mod latching;
mod notes;
mod pending;
mod replies;
mod report;
mod samples;
mod timers;

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU16, Ordering};
use std::time::{Duration, Instant};

use super::array::DeviceUid;
use super::codes::{ArrayProfile, Bite, Coder};
use super::framing::Packet;
use super::message::{
    Arm, Caps, ChannelMask, Clear, Config, LARGEST_CHANNELS, Message as _, Ping, Status, Stop,
    StopHow, kind,
};
use super::session_log::Note;
pub use array::ArrayChange;
pub use clock::ClockFit;
use clock::DeviceClock;
pub(super) use delays::DelaySource;
use delays::Evidence;
#[cfg(test)]
pub(crate) use frames::SOFT_START_TICKS;
use ident::Identifying;
use latching::Latching;
use notes::Notes;
use pending::Pending;
pub use report::{BridgeCounters, BridgeEvent, BridgeState, DeviceCounters, DisarmedBy, SentFrame};
pub(crate) use samples::CutSamples;
pub(super) use samples::MOST_TICKS;
pub use samples::Waveform;

const TICK: Duration = Duration::from_millis(25);
const MOST_EVENTS: usize = 64;
const MOST_PACKETS: usize = 16;

/// The host's packet counter, shared by everything that may send on one link.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sequence(Arc<AtomicU16>);

impl Sequence {
    /// The next number; wraps.
    pub(crate) fn next(&self) -> u16 {
        self.0.fetch_add(1, Ordering::Relaxed)
    }
}

/// One session with one device.
#[derive(Debug)]
pub struct HostSession {
    nonce: u32,
    profile: ArrayProfile,
    n_contactors: usize,
    sequence: Sequence,
    /// Whether samples are sent where the device plays them.
    prefers_samples: bool,
    coder: Coder,
    codes: Vec<[u16; 2]>,
    state: BridgeState,
    caps: Option<Caps>,
    config: Option<Config>,
    status: Option<Status>,
    status_received: Option<Instant>,
    counters: DeviceCounters,
    frames_rejected: u64,
    request: Option<Pending>,
    stopping: Option<Pending>,
    stop_how: StopHow,
    /// Whether the STOP under way ends output, rather than making sure of rest.
    stop_ends_output: bool,
    /// Token and time of the last PING.
    ping: Option<(u32, Instant)>,
    last_ping: Option<Instant>,
    ident: Option<Identifying>,
    first_apply_tick: Option<u32>,
    /// The last tick whose samples were made since ARM (mode B).
    last_played_tick: Option<u32>,
    clock: DeviceClock,
    latching: Latching,
    /// The device that the link before this one had.
    before: Option<DeviceUid>,
    /// Start of the last STATUS's tick, by our clock.
    tick_start: Option<Instant>,
    /// When the answer to the last STATUS is due; taken by the frame that is it.
    due: Option<Instant>,
    evidence: Evidence,
    last_sent: Option<Instant>,
    last_time: Option<Instant>,
    silent_for: Duration,
    notes: Notes,
    events: VecDeque<BridgeEvent>,
    packets: VecDeque<Packet>,
    stop_packet: Option<Packet>,
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
            coder: Coder::new(&profile, n_contactors),
            codes: vec![[0; 2]; n_contactors.min(LARGEST_CHANNELS)],
            profile,
            prefers_samples: false,
            n_contactors,
            sequence,
            state: BridgeState::Opening,
            caps: None,
            config: None,
            status: None,
            status_received: None,
            counters: DeviceCounters::default(),
            frames_rejected: 0,
            request: None,
            stopping: None,
            stop_how: StopHow::Ramp,
            stop_ends_output: false,
            ping: None,
            last_ping: None,
            ident: None,
            first_apply_tick: None,
            last_played_tick: None,
            clock: DeviceClock::new(),
            latching: Latching::new(),
            before: None,
            tick_start: None,
            due: None,
            evidence: Evidence::default(),
            last_sent: None,
            last_time: None,
            silent_for: Duration::ZERO,
            notes: Notes::default(),
            events: VecDeque::with_capacity(MOST_EVENTS),
            packets: VecDeque::with_capacity(MOST_PACKETS),
            stop_packet: None,
        }
    }

    /// The port is open and its input purged: ends whatever text it held, then greets.
    pub fn opened(&mut self, now: Instant) {
        if self.state != BridgeState::Opening {
            return;
        }
        self.state = BridgeState::Greeting;
        self.queue(Some(&Packet::delimiter()), now);
        self.request(kind::HELLO, now);
    }

    /// The port failed or could not be opened.
    pub(crate) fn link_gone(&mut self, reason: &str) {
        self.lose(String::from(reason));
    }

    /// Asks for output. True when ARM went out; `Armed` or `Disarmed` follows. Only from `Ready`.
    pub fn arm(&mut self, now: Instant) -> bool {
        if self.state != BridgeState::Ready {
            return false;
        }
        self.state = BridgeState::Arming;
        self.first_apply_tick = None;
        self.last_played_tick = None;
        self.request(kind::ARM, now);
        true
    }

    /// Ends output, ahead of everything else, in any state with an open port.
    pub fn stop(&mut self, now: Instant, how: StopHow) {
        if self.state == BridgeState::Opening || !self.state.is_open() {
            return;
        }
        // A gentler wish never softens a STOP under way.
        if self.stopping.is_none() || how == StopHow::Now {
            self.stop_how = how;
        }
        self.stop_ends_output |= self.state.is_live() && self.state != BridgeState::Stopping;
        if self.state.is_live() || self.state == BridgeState::Ready {
            self.request = None;
            self.packets.clear();
            self.state = BridgeState::Stopping;
        }
        let mut stopping = Pending::new(kind::STOP, now);
        self.send_stop(&mut stopping, now);
        // A device that has not answered HELLO cannot be expected to answer STOP.
        self.stopping = self.caps.is_some().then_some(stopping);
    }

    /// Asks the device to clear all latched faults.
    pub fn clear_faults(&mut self, now: Instant) {
        if self.state == BridgeState::Faulted {
            self.request(kind::CLEAR, now);
        }
    }

    /// Sends a PING; `Pong` follows.
    pub(crate) fn ping(&mut self, now: Instant) {
        let seq = self.sequence.next();
        let token = u32::from(seq) | self.nonce << 16;
        self.ping = Some((token, now));
        self.last_ping = Some(now);
        self.queue(Ping { token }.packet(seq).as_ref(), now);
    }

    /// The next packet to write, STOP excepted.
    pub(crate) fn next_packet(&mut self) -> Option<Packet> {
        self.packets.pop_front()
    }

    /// A STOP to write ahead of everything else.
    pub(crate) fn take_stop(&mut self) -> Option<Packet> {
        self.stop_packet.take()
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
        self.caps.as_ref()
    }

    /// The device's effective settings.
    pub fn config(&self) -> Option<&Config> {
        self.config.as_ref()
    }

    /// The last STATUS.
    pub fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// When the last STATUS arrived.
    pub(crate) fn status_received(&self) -> Option<Instant> {
        self.status_received
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

    /// The 99.9th percentile of the times from when a frame was due until the device accepted it,
    /// of the last two minutes; zero before the first.
    pub fn delay(&self) -> Duration {
        self.latching.delay().0
    }

    /// What the last frame's amplitudes ran into, per contactor.
    pub fn limited(&self) -> &[Bite] {
        self.coder.limited()
    }

    /// The counters that a session knows; those of the link's threads are 0.
    pub fn counters(&self) -> BridgeCounters {
        BridgeCounters {
            device: self.counters,
            codes: self.coder.counters(),
            frames_rejected: self.frames_rejected,
            ..BridgeCounters::default()
        }
    }

    /// How much it holds room for: events, packets, codes.
    #[cfg(test)]
    pub fn held(&self) -> usize {
        self.events.capacity() + self.packets.capacity() + self.codes.capacity()
    }

    fn request(&mut self, kind: u8, now: Instant) {
        let mut request = Pending::new(kind, now);
        self.send_request(&mut request, now);
        self.request = Some(request);
    }

    fn send_request(&mut self, request: &mut Pending, now: Instant) {
        let seq = self.sequence.next();
        request.sent(seq, now);
        self.note(now, self.note_of(request.kind()));
        let packet = match request.kind() {
            kind::HELLO => self.hello().packet(seq),
            kind::CONFIG => self.wish().request(seq, self.n_contactors),
            kind::CLEAR => Clear { bits: u16::MAX }.packet(seq),
            _ => Arm::new(self.nonce).packet(seq),
        };
        self.queue(packet.as_ref(), now);
    }

    fn send_stop(&mut self, stopping: &mut Pending, now: Instant) {
        let seq = self.sequence.next();
        stopping.sent(seq, now);
        self.note(now, Note::Stop(self.stop_how));
        self.stop_packet = Stop {
            reason: 0,
            how: self.stop_how,
        }
        .packet(seq);
        self.last_sent = Some(now);
    }

    /// What to ask of the device, within its CAPS.
    fn wish(&self) -> Config {
        let (hv_max_dv, most) = self
            .caps
            .map_or((0, [0; 2]), |caps| (caps.hv_max_dv, caps.comp_limit));
        let wanted = self.coder.comp_limit();
        Config {
            mode: self.mode(),
            flags: 0,
            hold_ms: self.profile.hold_ms,
            ramp_ms: self.profile.ramp_ms,
            slew: 0,
            hv_dv: self.profile.hv_dv.min(hv_max_dv),
            comp_limit: [0, 1].map(|band| wanted[band].min(most[band])),
            mask: ChannelMask::first(self.n_contactors),
        }
    }

    fn lose(&mut self, reason: String) {
        if !self.state.is_open() {
            return;
        }
        if self.state.is_live() {
            // Perhaps only the way back is broken.
            self.stop_packet = Stop {
                reason: 0,
                how: StopHow::Now,
            }
            .packet(self.sequence.next());
        }
        self.end(BridgeState::Lost);
        self.event(BridgeEvent::Lost(reason));
    }

    fn end(&mut self, state: BridgeState) {
        self.state = state;
        self.request = None;
        self.stopping = None;
        self.packets.clear();
    }

    fn disarmed(&mut self, by: DisarmedBy, reason: String) {
        self.event(BridgeEvent::Disarmed { by, reason });
    }

    fn queue(&mut self, packet: Option<&Packet>, now: Instant) {
        if let Some(packet) = packet
            && self.packets.len() < MOST_PACKETS
        {
            self.packets.push_back(*packet);
            self.last_sent = Some(now);
        }
    }

    fn event(&mut self, event: BridgeEvent) {
        if self.events.len() >= MOST_EVENTS {
            // Ticks are the only news that comes in numbers, and an old one is worth nothing.
            self.events.pop_front();
        }
        self.events.push_back(event);
    }
}

#[cfg(test)]
mod tests;
