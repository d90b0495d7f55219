//! The host's side of HBP v1 as a pure state machine: device messages and time in, packets and
//! events out.
//!
//! It greets, checks, configures, arms, stamps frames with their apply tick and soft-start gain,
//! keeps the lease, repeats what was not answered, and notices a device that disarms itself or
//! falls silent. It owns no port, no thread and no clock (callers say what time it is), and it
//! never arms on its own.

mod array;
mod checks;
mod ident;
mod pending;
mod replies;
mod report;
mod timers;

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU16, Ordering};
use std::time::{Duration, Instant};

use super::codes::{ArrayProfile, Bite, Coder};
use super::framing::Packet;
use super::message::{
    Arm, Caps, ChannelMask, Clear, Config, Hello, LARGEST_CHANNELS, Message as _, Ping, Status,
    Stop, StopHow, frame, kind,
};
pub use array::ArrayChange;
use ident::Identifying;
use pending::Pending;
pub use report::{BridgeCounters, BridgeEvent, BridgeState, DeviceCounters, DisarmedBy, SentFrame};

const TICK: Duration = Duration::from_millis(25);
/// Ticks of the linear soft start after ARM.
pub const SOFT_START_TICKS: u32 = 20;
const DEEPEST: u8 = 3;
const DEPTH_PATIENCE: Duration = Duration::from_secs(10);
const MOST_EVENTS: usize = 64;
const MOST_PACKETS: usize = 16;

/// The host's packet counter, shared by everything that may send on one link.
#[derive(Clone, Debug, Default)]
pub struct Sequence(Arc<AtomicU16>);

impl Sequence {
    /// The next number; wraps.
    pub fn next(&self) -> u16 {
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
    ident: Option<Identifying>,
    first_apply_tick: Option<u32>,
    depth: u8,
    depth_raised: Option<Instant>,
    last_sent: Option<Instant>,
    last_time: Option<Instant>,
    silent_for: Duration,
    events: VecDeque<BridgeEvent>,
    packets: VecDeque<Packet>,
    stop_packet: Option<Packet>,
}

impl HostSession {
    /// A session that will greet with `nonce` (random; 0 becomes 1) once the port is open.
    pub fn new(nonce: u32, profile: ArrayProfile, n_contactors: usize, sequence: Sequence) -> Self {
        Self {
            nonce: nonce.max(1),
            coder: Coder::new(&profile, n_contactors),
            codes: vec![[0; 2]; n_contactors.min(LARGEST_CHANNELS)],
            profile,
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
            ident: None,
            first_apply_tick: None,
            depth: 1,
            depth_raised: None,
            last_sent: None,
            last_time: None,
            silent_for: Duration::ZERO,
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
    pub fn link_gone(&mut self, reason: &str) {
        self.lose(String::from(reason));
    }

    /// Asks for output. True when ARM went out; `Armed` or `Disarmed` follows. Only from `Ready`.
    pub fn arm(&mut self, now: Instant) -> bool {
        if self.state != BridgeState::Ready {
            return false;
        }
        self.state = BridgeState::Arming;
        self.first_apply_tick = None;
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
    pub fn ping(&mut self, now: Instant) {
        let seq = self.sequence.next();
        let token = u32::from(seq) | self.nonce << 16;
        self.ping = Some((token, now));
        self.queue(Ping { token }.packet(seq).as_ref(), now);
    }

    /// A FRAME for the tick `depth` after the present one, soft start applied; `None` unless armed
    /// and a STATUS has come.
    ///
    /// The present tick is that of the last STATUS plus whole ticks since it arrived, so a lost
    /// STATUS costs nothing.
    pub fn frame(
        &mut self,
        now: Instant,
        amplitudes_um: &[[f32; 2]],
    ) -> Option<(SentFrame, Packet)> {
        if !self.state.takes_frames() || self.status.is_none() {
            return None;
        }
        let apply_tick = self.present_tick(now).wrapping_add(u32::from(self.depth));
        let first = *self.first_apply_tick.get_or_insert(apply_tick);
        let gain = soft_start_gain(first, apply_tick);
        self.coder.encode_into(amplitudes_um, gain, &mut self.codes);
        let seq = self.sequence.next();
        let packet = frame::packet(seq, apply_tick, &self.codes)?;
        self.state = BridgeState::Streaming;
        self.last_sent = Some(now);
        Some((
            SentFrame {
                seq,
                apply_tick,
                gain,
            },
            packet,
        ))
    }

    /// The next packet to write, STOP excepted.
    pub fn next_packet(&mut self) -> Option<Packet> {
        self.packets.pop_front()
    }

    /// A STOP to write ahead of everything else.
    pub fn take_stop(&mut self) -> Option<Packet> {
        self.stop_packet.take()
    }

    /// The next piece of news.
    pub fn next_event(&mut self) -> Option<BridgeEvent> {
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
    pub fn status_received(&self) -> Option<Instant> {
        self.status_received
    }

    /// How many ticks ahead frames are sent, 1…3.
    pub fn depth(&self) -> u8 {
        self.depth
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

    fn present_tick(&self, now: Instant) -> u32 {
        let tick = self.status.map_or(0, |status| status.tick);
        let since = self
            .status_received
            .map_or(Duration::ZERO, |at| now.saturating_duration_since(at));
        let whole = since.as_micros() / TICK.as_micros();
        tick.wrapping_add(u32::try_from(whole).unwrap_or(0))
    }

    fn request(&mut self, kind: u8, now: Instant) {
        let mut request = Pending::new(kind, now);
        self.send_request(&mut request, now);
        self.request = Some(request);
    }

    fn send_request(&mut self, request: &mut Pending, now: Instant) {
        let seq = self.sequence.next();
        request.sent(seq, now);
        let packet = match request.kind() {
            kind::HELLO => Hello::new(self.nonce).packet(seq),
            kind::CONFIG => self.wish().request(seq, self.n_contactors),
            kind::CLEAR => Clear { bits: u16::MAX }.packet(seq),
            _ => Arm::new(self.nonce).packet(seq),
        };
        self.queue(packet.as_ref(), now);
    }

    fn send_stop(&mut self, stopping: &mut Pending, now: Instant) {
        let seq = self.sequence.next();
        stopping.sent(seq, now);
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
            mode: 0,
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

/// `min(1, (ticks since the first FRAME after ARM + 1) / 20)`.
fn soft_start_gain(first_apply_tick: u32, apply_tick: u32) -> f64 {
    let since = apply_tick.wrapping_sub(first_apply_tick);
    // A depth or clock correction may step back behind the first frame.
    let since = if since.cast_signed() < 0 { 0 } else { since };
    let ticks = since.saturating_add(1).min(SOFT_START_TICKS);
    f64::from(ticks) / f64::from(SOFT_START_TICKS)
}

#[cfg(test)]
mod tests;
