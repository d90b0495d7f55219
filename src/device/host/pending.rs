//! A request without its reply yet: when to send it again, when to give up, which replies are its
//! own.

use std::time::{Duration, Instant};

use crate::message::kind;

const REPEAT_AFTER: Duration = Duration::from_millis(250);
const HELLO_PATIENCE: Duration = Duration::from_secs(5);
const MOST_REPEATS: u8 = 8;

/// What to do about a request now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    Wait,
    Repeat,
    GiveUp,
}

/// One request and its repeats.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending {
    kind: u8,
    began: Instant,
    sent_at: Instant,
    first_seq: u16,
    last_seq: u16,
    sendings: u8,
}

impl Pending {
    pub(super) fn new(kind: u8, now: Instant) -> Self {
        Self {
            kind,
            began: now,
            sent_at: now,
            first_seq: 0,
            last_seq: 0,
            sendings: 0,
        }
    }

    pub(super) fn kind(&self) -> u8 {
        self.kind
    }

    pub(super) fn sent(&mut self, seq: u16, now: Instant) {
        if self.sendings == 0 {
            self.first_seq = seq;
        }
        self.last_seq = seq;
        self.sent_at = now;
        self.sendings = self.sendings.saturating_add(1);
    }

    pub(super) fn verdict(&self, now: Instant) -> Verdict {
        if now.saturating_duration_since(self.sent_at) < REPEAT_AFTER {
            return Verdict::Wait;
        }
        let worn_out = if self.kind == kind::HELLO {
            now.saturating_duration_since(self.began) >= HELLO_PATIENCE
        } else {
            self.sendings > MOST_REPEATS
        };
        if worn_out {
            Verdict::GiveUp
        } else {
            Verdict::Repeat
        }
    }

    /// Whether an ACK answers one of this request's sendings, and not an older request of the same
    /// type.
    pub(super) fn is_answered_by(&self, kind: u8, seq: u16) -> bool {
        let span = self.last_seq.wrapping_sub(self.first_seq);
        kind == self.kind && seq.wrapping_sub(self.first_seq) <= span
    }
}
