//! What the session makes of each message of the device.

use std::time::{Duration, Instant};

use super::HostSession;
use super::checks::refusal;
use super::clock::TICK;
use super::latching::Deepened;
use super::report::{BridgeEvent, BridgeState, DisarmedBy};
use crate::array::DeviceUid;
use crate::message::{
    Ack, AckCode, Caps, Config, DeviceMessage, DeviceState, MAGIC, Pong, Status, fault_bit, kind,
};
use crate::session_log::Note;

/// A line of the device's clock that moved further than this makes what was measured by it void.
const MOVED: Duration = Duration::from_millis(1);

impl HostSession {
    /// Takes one message. Everything before CAPS with our own nonce is left over from another
    /// session and ignored.
    pub(crate) fn on_message(&mut self, received: Instant, message: &DeviceMessage) {
        if !self.state.is_open() {
            return;
        }
        match message {
            DeviceMessage::Caps(caps) => self.on_caps(received, caps),
            _ if self.device.caps.is_none() => {}
            DeviceMessage::Cfg(config) => self.on_config(received, config),
            DeviceMessage::Ack(ack) => self.on_ack(received, *ack),
            DeviceMessage::Status(status) => self.on_status(received, status),
            DeviceMessage::Fault(fault) => {
                if self.notes.is_news(fault.faults) {
                    self.note(received, Note::Fault(*fault));
                }
                self.event(BridgeEvent::Fault(*fault));
            }
            DeviceMessage::Pong(pong) => self.on_pong(received, *pong),
            DeviceMessage::Log(text) => self.event(BridgeEvent::Log(text.to_line())),
        }
    }

    fn on_caps(&mut self, received: Instant, caps: &Caps) {
        let ours = caps.magic == MAGIC && caps.session == self.nonce;
        if self.state != BridgeState::Greeting || !ours {
            return;
        }
        self.note(received, Note::Caps(*caps));
        if let Some(reason) = refusal(caps, self.drive.n_contactors) {
            self.end(BridgeState::Refused);
            self.event(BridgeEvent::Refused(reason));
            return;
        }
        self.device.caps = Some(*caps);
        self.event(BridgeEvent::Connected(*caps));
        self.compare_device(received, DeviceUid(caps.uid));
        self.configure(received);
    }

    pub(super) fn configure(&mut self, now: Instant) {
        self.state = BridgeState::Configuring;
        self.request(kind::CONFIG, now);
    }

    fn on_config(&mut self, received: Instant, config: &Config) {
        if self.state != BridgeState::Configuring {
            return;
        }
        self.request = None;
        self.note(received, Note::Effective(*config));
        self.drive.coder.set_link_limit(config.comp_limit);
        self.device.config = Some(*config);
        self.latching.set_queue(self.device.deepest());
        self.state = BridgeState::Ready;
        self.event(BridgeEvent::Ready(*config));
    }

    fn on_ack(&mut self, received: Instant, ack: Ack) {
        self.on_ident_ack(ack);
        if ack.code != AckCode::Ok {
            self.note(received, Note::Refused(ack.kind, ack.code));
            self.frames_rejected += u64::from(ack.kind == kind::FRAME);
        }
        if self
            .stopping
            .pending
            .is_some_and(|stopping| stopping.is_answered_by(ack.kind, ack.seq))
        {
            self.note(received, Note::Stopped);
            self.on_stopped();
        }
        if !self
            .request
            .is_some_and(|request| request.is_answered_by(ack.kind, ack.seq))
        {
            return;
        }
        self.request = None;
        match (ack.kind, ack.code) {
            (kind::ARM, AckCode::Ok) => {
                self.note(received, Note::Armed);
                self.state = BridgeState::Armed;
                self.event(BridgeEvent::Armed);
            }
            (kind::ARM, code) => {
                self.state = BridgeState::Ready;
                let reason = format!("the device refused ARM: {}", code.describe());
                self.disarmed(DisarmedBy::Device, reason);
            }
            (kind::CONFIG, AckCode::Faulted) => self.state = BridgeState::Faulted,
            (kind::CONFIG, code) => {
                self.end(BridgeState::Refused);
                let reason = format!("the device refused its settings: {}", code.describe());
                self.event(BridgeEvent::Refused(reason));
            }
            (kind::CLEAR, AckCode::Ok) => {
                self.note(received, Note::Cleared);
                self.configure(received);
            }
            _ => {}
        }
    }

    /// STOP is acknowledged. The device may still ramp: `Stopping` lasts until a STATUS shows it at
    /// rest.
    fn on_stopped(&mut self) {
        self.stopping.pending = None;
        if self.stopping.ends_output {
            self.stopping.ends_output = false;
            self.disarmed(DisarmedBy::Host, String::from("stopped"));
        }
    }

    fn on_status(&mut self, received: Instant, status: &Status) {
        let before = self.device.status.replace(*status);
        let counted = self.device.counters;
        if let Some(before) = before {
            self.device.counters.add(&before, status);
        }
        self.presence.silent_for = Duration::ZERO;
        self.time(received, status);
        if before.is_none_or(|before| before.state != status.state) {
            self.note(received, Note::State(status.state));
        }
        if self.device.counters != counted {
            self.note(received, Note::DeviceCounters(self.device.counters));
        }
        let late = self.device.counters.late - counted.late;
        let missing = self.device.counters.underrun - counted.underrun;
        self.latch(received, [late, missing]);
        self.follow(received, status);
        if self.state.is_open() {
            let start = self.device.tick_start.unwrap_or(received);
            let due = self.latching.due(start, received);
            self.drive.due = Some(due);
            self.event(BridgeEvent::Tick {
                tick: status.tick,
                received,
                due,
            });
        }
    }

    /// Places the tick that a STATUS announces on our clock, and learns how long the last frame
    /// took until it was accepted.
    fn time(&mut self, received: Instant, status: &Status) {
        let device_us = self.clock.unwrapped(status.dev_us);
        // No line through answers may say what cannot be: a tick after its STATUS arrived.
        let start = self.clock.at(device_us).unwrap_or(received).min(received);
        let earliest = received.checked_sub(TICK).unwrap_or(received);
        let start = start.max(earliest);
        self.device.tick_start = Some(start);
        self.learn_from_status(start, status);
    }

    fn latch(&mut self, now: Instant, lost: [u64; 2]) {
        let news = self
            .device
            .tick_start
            .map(|at| now.saturating_duration_since(at));
        let depth = match self.latching.tick(now, news.unwrap_or_default(), lost) {
            Deepened::No => return,
            Deepened::Raised => BridgeEvent::DepthRaised(self.latching.depth()),
            Deepened::Lowered => BridgeEvent::DepthLowered(self.latching.depth()),
        };
        let (ticks, lead) = (self.latching.depth(), self.latching.lead());
        self.note(now, Note::Depth(ticks, lead));
        self.event(depth);
    }

    /// Compares the device's state with ours. It may leave output by itself; it never gets back
    /// without a new command.
    fn follow(&mut self, received: Instant, status: &Status) {
        let device = status.device_state();
        let at_rest = !device.is_some_and(DeviceState::is_live);
        let acknowledged = self.stopping.pending.is_none();
        match self.state {
            BridgeState::Armed | BridgeState::Streaming if at_rest => {
                self.rest(device);
                let reason = self_disarm_reason(device, status.faults);
                self.disarmed(DisarmedBy::Device, reason);
            }
            BridgeState::Stopping if at_rest && acknowledged => self.rest(device),
            BridgeState::Ready if device == Some(DeviceState::Fault) => self.rest(device),
            BridgeState::Faulted
                if device == Some(DeviceState::Ready) && self.request.is_none() =>
            {
                self.configure(received);
            }
            _ => {}
        }
    }

    fn rest(&mut self, device: Option<DeviceState>) {
        self.state = match device {
            Some(DeviceState::Ready) => BridgeState::Ready,
            _ => BridgeState::Faulted,
        };
    }

    /// A tick began at `start`, and its STATUS says what the device had by then.
    fn learn_from_status(&mut self, start: Instant, status: &Status) {
        if let Some(delay) = self.evidence.delay_of_frame(start, status) {
            self.latching.accepted(delay);
        }
    }

    fn on_pong(&mut self, received: Instant, pong: Pong) {
        if let Some((token, sent)) = self.pings.under_way
            && token == pong.token
        {
            self.pings.under_way = None;
            let round_trip = received.saturating_duration_since(sent);
            let moved = self.clock.answered(sent, received, pong.dev_us);
            if moved > MOVED {
                // What was measured by the old line is wrong by as much.
                self.latching.forget();
            }
            self.event(BridgeEvent::Pong {
                round_trip,
                phase_us: pong.phase_us,
            });
        }
    }
}

fn self_disarm_reason(device: Option<DeviceState>, faults: u16) -> String {
    match device {
        Some(DeviceState::Fault) => {
            format!("the device reports a fault: {}", fault_bit::names(faults))
        }
        Some(DeviceState::Ready) => {
            String::from("the device disarmed itself: no frame reached it in time")
        }
        _ => String::from("the device ended the session by itself"),
    }
}
