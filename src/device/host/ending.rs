//! How a session ends: lost, refused, or by a device that contradicts itself. STOP goes first.

use std::time::Instant;

use super::HostSession;
use super::pending::Pending;
use super::report::{BridgeEvent, BridgeState, DisarmedBy};
use super::watch;
use crate::message::{Message as _, Stop, StopHow, kind};
use crate::session_log::{Note, event};

impl HostSession {
    pub(super) fn lose(&mut self, now: Instant, mut reason: String) {
        if !self.state.is_open() {
            return;
        }
        // A device that was never heard of, on a port that says something, is another device.
        if self.device.caps.is_none() && self.noise.is_any() {
            reason.push_str("; what comes from it is not this protocol");
        }
        if self.state.is_live() {
            // Perhaps only the way back is broken.
            self.outbox.stop_packet = Stop {
                reason: 0,
                how: StopHow::Now,
            }
            .packet(self.outbox.sequence.next());
        }
        self.end(BridgeState::Lost);
        self.note(now, Note::Said(event::LOST, reason.clone()));
        self.event(BridgeEvent::Lost(reason));
    }

    /// The device contradicts itself, the profile or what was asked: output ends, STOP first.
    pub(super) fn contradicted(&mut self, now: Instant, (how, reason): watch::End) {
        self.stop(now, how);
        self.stopping.ends_output = false;
        self.disarmed(now, DisarmedBy::Device, reason);
    }

    /// The device is not to be driven; it may move for all we know.
    pub(super) fn refuse(&mut self, now: Instant, reason: String) {
        self.end(BridgeState::Refused);
        self.send_stop(&mut Pending::new(kind::STOP, now), now);
        self.note(now, Note::Said(event::REFUSED_DEVICE, reason.clone()));
        self.event(BridgeEvent::Refused(reason));
    }

    pub(super) fn end(&mut self, state: BridgeState) {
        self.state = state;
        self.request = None;
        self.stopping.pending = None;
        self.outbox.packets.clear();
    }

    pub(super) fn disarmed(&mut self, now: Instant, by: DisarmedBy, reason: String) {
        let event = match by {
            DisarmedBy::Device => event::DISARMED_ITSELF,
            DisarmedBy::Host => event::DISARMED,
        };
        self.note(now, Note::Said(event, reason.clone()));
        self.event(BridgeEvent::Disarmed { by, reason });
    }
}
