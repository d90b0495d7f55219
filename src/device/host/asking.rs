//! What is asked of the device, and sent again until it answers: HELLO, CONFIG, ARM, CLEAR, STOP.

use std::time::Instant;

use super::HostSession;
use super::pending::Pending;
use crate::message::{Arm, Clear, Hello, Message as _, Stop, kind};
use crate::session_log::Note;

impl HostSession {
    /// The note of a request that is sent.
    pub(super) fn note_of(&self, request: u8) -> Note {
        match request {
            kind::HELLO => Note::Hello(self.nonce),
            kind::CONFIG => Note::Config(self.drive.wanted_config(&self.device)),
            kind::CLEAR => Note::Clear,
            _ => Note::Arm,
        }
    }

    pub(super) fn request(&mut self, kind: u8, now: Instant) {
        let mut request = Pending::new(kind, now);
        self.send_request(&mut request, now);
        self.request = Some(request);
    }

    pub(super) fn send_request(&mut self, request: &mut Pending, now: Instant) {
        let seq = self.outbox.sequence.next();
        request.sent(seq, now);
        self.note(now, self.note_of(request.kind()));
        let packet = match request.kind() {
            kind::HELLO => Hello {
                host_flags: Hello::WANT_STATUS | Hello::WANT_LOG,
                ..Hello::new(self.nonce)
            }
            .packet(seq),
            kind::CONFIG => self
                .drive
                .wanted_config(&self.device)
                .request(seq, self.drive.n_contactors),
            kind::CLEAR => Clear { bits: u16::MAX }.packet(seq),
            _ => Arm::new(self.nonce).packet(seq),
        };
        self.outbox.queue(packet.as_ref(), now);
    }

    pub(super) fn send_stop(&mut self, stopping: &mut Pending, now: Instant) {
        let seq = self.outbox.sequence.next();
        stopping.sent(seq, now);
        self.note(now, Note::Stop(self.stopping.how));
        self.outbox.stop_packet = Stop {
            reason: 0,
            how: self.stopping.how,
        }
        .packet(seq);
        self.outbox.last_sent = Some(now);
    }
}
