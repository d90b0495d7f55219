//! What waits for the device: requests without their reply (when to send them again, when to give
//! up, which replies are their own), PINGs, and a device that says nothing.

use std::time::{Duration, Instant};

use crate::message::kind;

const REPEAT_AFTER: Duration = Duration::from_millis(250);
const HELLO_PATIENCE: Duration = Duration::from_secs(5);
/// The device acknowledges IDENT within this, or never.
const IDENT_PATIENCE: Duration = Duration::from_millis(250);
const MAX_REPEATS: u8 = 8;

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

    /// Number of its last sending.
    #[cfg(test)]
    pub(super) fn last_seq(&self) -> u16 {
        self.last_seq
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
            self.sendings > MAX_REPEATS
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

/// An IDENT without its acknowledgement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Identifying {
    pub(super) channel: u16,
    pub(super) seq: u16,
    pub(super) sent: Instant,
}

impl Identifying {
    /// Whether no acknowledgement will come any more.
    pub(super) fn is_late(&self, now: Instant) -> bool {
        now.saturating_duration_since(self.sent) >= IDENT_PATIENCE
    }
}

/// PINGs of a session.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pings {
    /// Token and time of the last one, until it is answered.
    pub(super) under_way: Option<(u32, Instant)>,
    pub(super) last: Option<Instant>,
}

/// How long the device has been silent, counted while the caller was there to hear it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Presence {
    pub(super) last_time: Option<Instant>,
    pub(super) silent_for: Duration,
}
