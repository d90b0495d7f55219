//! What the session makes of each message of the device.

use std::time::{Duration, Instant};

use super::HostSession;
use super::claims::{caps_refusal, config_refusal, is_at_rest, live_refusal, standing_faults};
use super::clock::TICK;
use super::latching::Deepened;
use super::report::{BridgeEvent, BridgeState, DisarmedBy};
use super::ticks::Worth;
use super::watch::{contradiction, fault_end};
use crate::array::DeviceUid;
use crate::message::{
    Ack, AckCode, Caps, Config, DeviceMessage, DeviceState, Fault, MAGIC, Pong, Status, StopHow,
    kind,
};
use crate::session_log::{Note, event};

/// A line of the device's clock that moved further than this makes what was measured by it void.
const MOVED: Duration = Duration::from_millis(1);

impl HostSession {
    /// Takes one message. Everything before CAPS with our own nonce is left over from another
    /// session and ignored.
    pub(crate) fn on_message(&mut self, received: Instant, message: &DeviceMessage) {
        if !self.state.is_open() {
            return;
        }
        self.ticks.present(received);
        match message {
            DeviceMessage::Caps(caps) => self.on_caps(received, caps),
            _ if self.device.caps.is_none() => {}
            DeviceMessage::Cfg(config) => self.on_config(received, config),
            DeviceMessage::Ack(ack) => self.on_ack(received, *ack),
            DeviceMessage::Status(status) => self.on_status(received, status),
            DeviceMessage::Fault(fault) => self.on_fault(received, *fault),
            DeviceMessage::Pong(pong) => self.on_pong(received, *pong),
            DeviceMessage::Log(text) => {
                let text = text.to_line();
                self.note(received, Note::Said(event::DEVICE_LOG, text.clone()));
                self.event(BridgeEvent::Log(text));
            }
        }
    }

    fn on_caps(&mut self, received: Instant, caps: &Caps) {
        let ours = caps.magic == MAGIC && caps.session == self.nonce;
        if self.state != BridgeState::Greeting || !ours {
            return;
        }
        self.note(received, Note::Caps(*caps));
        if let Some(reason) = caps_refusal(caps, &self.drive.profile, self.drive.n_contactors) {
            return self.refuse(received, reason);
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
        let Some(caps) = self.device.caps.filter(|_| {
            // A CFG that nobody waits for repeats one that was judged.
            self.state == BridgeState::Configuring && self.request.is_some()
        }) else {
            return;
        };
        self.request = None;
        self.note(received, Note::Effective(*config));
        let asked = self.drive.wanted_config(&self.device);
        if let Some(reason) = config_refusal(&asked, config, &caps, self.drive.n_contactors) {
            return self.refuse(received, reason);
        }
        self.device.config = Some(*config);
        self.drive.coder.set_link(self.link_scale());
        self.latching.set_queue(self.device.deepest());
        self.settle();
    }

    /// Configured, with a base of ticks and a device that says it is ready: it may be armed.
    fn settle(&mut self) {
        let is_configured = self.state == BridgeState::Configuring && self.request.is_none();
        let is_ready = self.ticks.is_set() && self.device.status.as_ref().is_some_and(is_at_rest);
        if let Some(config) = self.device.config.filter(|_| is_configured && is_ready) {
            self.state = BridgeState::Ready;
            self.event(BridgeEvent::Ready(config));
        }
    }

    /// A fault ends output, and stands against arming until it is cleared.
    fn on_fault(&mut self, received: Instant, fault: Fault) {
        if self.notes.is_news(fault.faults) {
            self.note(received, Note::Fault(fault));
            self.event(BridgeEvent::Fault(fault));
        }
        let standing = standing_faults(fault.faults);
        if standing != 0 {
            self.fault_stands(received, standing);
        }
    }

    fn fault_stands(&mut self, received: Instant, faults: u16) {
        match self.state {
            BridgeState::Arming | BridgeState::Armed | BridgeState::Streaming => {
                self.contradicted(received, fault_end(faults));
            }
            BridgeState::Configuring | BridgeState::Ready => {
                self.request = None;
                self.state = BridgeState::Faulted;
            }
            _ => {}
        }
    }

    fn on_ack(&mut self, received: Instant, ack: Ack) {
        self.on_ident_ack(ack);
        if ack.code != AckCode::Ok {
            self.note(received, Note::Refused(ack.kind, ack.code));
            self.frames_rejected += u64::from(ack.kind == kind::FRAME);
        }
        let is_obeyed = ack.code == AckCode::Ok;
        if self
            .stopping
            .pending
            .is_some_and(|stopping| is_obeyed && stopping.is_answered_by(ack.kind, ack.seq))
        {
            self.note(received, Note::Stopped);
            self.on_stopped(received);
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
                self.disarmed(received, DisarmedBy::Device, reason);
            }
            (kind::CONFIG, AckCode::Faulted) => self.state = BridgeState::Faulted,
            (kind::CONFIG, code) => {
                let reason = format!("the device refused its settings: {}", code.describe());
                self.refuse(received, reason);
            }
            (kind::CLEAR, AckCode::Ok) => {
                self.note(received, Note::Cleared);
                self.notes.forget_faults();
                self.configure(received);
            }
            _ => {}
        }
    }

    /// STOP is acknowledged. The device may still ramp: `Stopping` lasts until a STATUS shows it at
    /// rest.
    fn on_stopped(&mut self, received: Instant) {
        self.stopping.pending = None;
        self.stopping.obeyed = Some(received);
        if self.stopping.ends_output {
            self.stopping.ends_output = false;
            self.disarmed(received, DisarmedBy::Host, String::from("stopped"));
        }
    }

    /// One whose tick does not advance tells nothing.
    fn on_status(&mut self, received: Instant, status: &Status) {
        let worth = self.ticks.announced(status.tick);
        if worth == Worth::Stray {
            return;
        }
        self.noise.good_status();
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
        self.judge(received, status);
        if self.state.is_open() && worth == Worth::Pacing {
            let start = self.device.tick_start.unwrap_or(received);
            let due = self.latching.due(start, received);
            self.drive.due = Some(due);
            self.event(BridgeEvent::Tick { received, due });
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

    /// Compares what the device says with what was asked of it. It may leave output by itself; it
    /// never gets back without a new command.
    fn judge(&mut self, received: Instant, status: &Status) {
        let device = status.device_state();
        let faults = standing_faults(status.faults);
        match self.state {
            BridgeState::Configuring | BridgeState::Ready => {
                let is_based = self.ticks.is_set() && self.request.is_none();
                if let Some(reason) = live_refusal(status, is_based) {
                    self.refuse(received, reason);
                } else if device == Some(DeviceState::Fault) || faults != 0 {
                    self.fault_stands(received, faults);
                } else {
                    self.settle();
                }
            }
            BridgeState::Arming if faults != 0 => self.fault_stands(received, faults),
            BridgeState::Armed | BridgeState::Streaming => self.judge_output(received, status),
            BridgeState::Stopping
                if self.stopping.pending.is_none() && !device.is_some_and(DeviceState::is_live) =>
            {
                self.rest(status);
            }
            BridgeState::Faulted if is_at_rest(status) && self.request.is_none() => {
                self.configure(received);
            }
            _ => {}
        }
    }

    fn judge_output(&mut self, received: Instant, status: &Status) {
        let bound = self.prediction.bound(status.tick, self.lasting());
        let is_louder = self.prediction.is_exceeded(status.amp_sum);
        let config = self.device.config.unwrap_or_default();
        let end = contradiction(status, &self.drive.profile, &config);
        if let Some(end) = end {
            self.contradicted(received, end);
        } else if is_louder {
            let reason = format!(
                "the device puts out {} codes in all where {bound:.0} were asked at most: check \
                 its firmware",
                status.amp_sum
            );
            self.contradicted(received, (StopHow::Now, reason));
        }
    }

    fn rest(&mut self, status: &Status) {
        self.state = if is_at_rest(status) {
            BridgeState::Ready
        } else {
            BridgeState::Faulted
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
