//! What the session makes of each message of the device.

use std::time::Instant;

use super::checks::refusal;
use super::{BridgeEvent, BridgeState, DEEPEST, DEPTH_PATIENCE, DisarmedBy, HostSession};
use crate::bridge::message::{
    Ack, AckCode, Caps, Config, DeviceMessage, DeviceState, MAGIC, Pong, Status, fault_bit, kind,
};

impl HostSession {
    /// Takes one message. Everything before CAPS with our own nonce is left over from another
    /// session and ignored.
    pub fn on_message(&mut self, received: Instant, message: &DeviceMessage) {
        if !self.state.is_open() {
            return;
        }
        match message {
            DeviceMessage::Caps(caps) => self.on_caps(received, caps),
            _ if self.caps.is_none() => {}
            DeviceMessage::Cfg(config) => self.on_config(config),
            DeviceMessage::Ack(ack) => self.on_ack(received, *ack),
            DeviceMessage::Status(status) => self.on_status(received, status),
            DeviceMessage::Fault(fault) => self.event(BridgeEvent::Fault(*fault)),
            DeviceMessage::Pong(pong) => self.on_pong(received, *pong),
            DeviceMessage::Log(text) => self.event(BridgeEvent::Log(text.to_line())),
        }
    }

    fn on_caps(&mut self, received: Instant, caps: &Caps) {
        let ours = caps.magic == MAGIC && caps.session == self.nonce;
        if self.state != BridgeState::Greeting || !ours {
            return;
        }
        if let Some(reason) = refusal(caps, self.n_contactors) {
            self.end(BridgeState::Refused);
            self.event(BridgeEvent::Refused(reason));
            return;
        }
        self.caps = Some(*caps);
        self.event(BridgeEvent::Connected(*caps));
        self.configure(received);
    }

    pub(super) fn configure(&mut self, now: Instant) {
        self.state = BridgeState::Configuring;
        self.request(kind::CONFIG, now);
    }

    fn on_config(&mut self, config: &Config) {
        if self.state != BridgeState::Configuring {
            return;
        }
        self.request = None;
        self.coder.set_link_limit(config.comp_limit);
        self.config = Some(*config);
        self.state = BridgeState::Ready;
        self.event(BridgeEvent::Ready(*config));
    }

    fn on_ack(&mut self, received: Instant, ack: Ack) {
        self.on_ident_ack(ack);
        if ack.kind == kind::FRAME && ack.code != AckCode::Ok {
            self.frames_rejected += 1;
        }
        if self
            .stopping
            .is_some_and(|stopping| stopping.is_answered_by(ack.kind, ack.seq))
        {
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
            (kind::CLEAR, AckCode::Ok) => self.configure(received),
            _ => {}
        }
    }

    /// STOP is acknowledged. The device may still ramp: `Stopping` lasts until a STATUS shows it at
    /// rest.
    fn on_stopped(&mut self) {
        self.stopping = None;
        if self.stop_ends_output {
            self.stop_ends_output = false;
            self.disarmed(DisarmedBy::Host, String::from("stopped"));
        }
    }

    fn on_status(&mut self, received: Instant, status: &Status) {
        if let Some(before) = self.status.replace(*status) {
            let late = self.counters.late;
            self.counters.add(&before, status);
            if self.counters.late > late {
                self.deepen(received);
            }
        }
        self.status_received = Some(received);
        self.silent_for = std::time::Duration::ZERO;
        self.follow(received, status);
        if self.state.is_open() {
            self.event(BridgeEvent::Tick {
                tick: status.tick,
                received,
            });
        }
    }

    /// Compares the device's state with ours. It may leave output by itself; it never gets back
    /// without a new command.
    fn follow(&mut self, received: Instant, status: &Status) {
        let device = status.device_state();
        let at_rest = !device.is_some_and(DeviceState::is_live);
        let acknowledged = self.stopping.is_none();
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

    fn on_pong(&mut self, received: Instant, pong: Pong) {
        if let Some((token, sent)) = self.ping
            && token == pong.token
        {
            self.ping = None;
            let round_trip = received.saturating_duration_since(sent);
            self.event(BridgeEvent::Pong {
                round_trip,
                phase_us: pong.phase_us,
            });
        }
    }

    /// Late frames: aim further ahead, at most one tick more every 10 s and never beyond 3.
    fn deepen(&mut self, now: Instant) {
        let rested = self
            .depth_raised
            .is_none_or(|raised| now.saturating_duration_since(raised) >= DEPTH_PATIENCE);
        if self.depth < DEEPEST && rested {
            self.depth += 1;
            self.depth_raised = Some(now);
            self.event(BridgeEvent::DepthRaised(self.depth));
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
