//! How a session ends: lost, refused, or by a device that contradicts itself. STOP goes first.

use std::time::Instant;

use super::HostSession;
use super::pending::Pending;
use super::report::{BridgeEvent, BridgeState, DisarmedBy};
use super::watch;
use crate::message::{Message as _, Stop, StopHow, kind};
use crate::session_log::Note;

impl HostSession {
    pub(super) fn lose(&mut self, reason: String) {
        if !self.state.is_open() {
            return;
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
        self.event(BridgeEvent::Lost(reason));
    }

    /// The device contradicts itself, the profile or what was asked: output ends, STOP first.
    pub(super) fn contradicted(&mut self, now: Instant, (how, reason): watch::End) {
        self.stop(now, how);
        self.stopping.ends_output = false;
        self.note(now, Note::Said("contradiction", reason.clone()));
        self.disarmed(DisarmedBy::Device, reason);
    }

    /// The device is not to be driven; it may move for all we know.
    pub(super) fn refuse(&mut self, now: Instant, reason: String) {
        self.end(BridgeState::Refused);
        self.send_stop(&mut Pending::new(kind::STOP, now), now);
        self.event(BridgeEvent::Refused(reason));
    }

    pub(super) fn end(&mut self, state: BridgeState) {
        self.state = state;
        self.request = None;
        self.stopping.pending = None;
        self.outbox.packets.clear();
    }

    pub(super) fn disarmed(&mut self, by: DisarmedBy, reason: String) {
        self.event(BridgeEvent::Disarmed { by, reason });
    }
}
