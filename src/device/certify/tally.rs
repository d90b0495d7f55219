//! Counters of the device, and by how much they must have risen.

use super::predict::Allowed;
use super::say::{Say, Want};
use super::verdict::{Verdict, ensure};
use crate::framing::{Decoder, LARGEST_BODY};
use crate::message::Status;

/// Counters that must have risen since the check began.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Due {
    pub(super) late: u16,
    pub(super) dup: u16,
    pub(super) bad: u16,
    pub(super) clipped: u16,
}

/// What counters stood at when a check began, and what is due since.
pub(super) struct Tally {
    /// What a device's decoder makes of the bytes that were written.
    mirror: Decoder,
    base: Option<Status>,
    pub(super) due: Due,
}

impl Tally {
    pub(super) fn new() -> Self {
        Self {
            mirror: Decoder::new(LARGEST_BODY),
            base: None,
            due: Due::default(),
        }
    }

    /// Judges oversize as a device does whose bodies have at most so many bytes.
    pub(super) fn know_largest_body(&mut self, max_body: u16) {
        self.mirror = Decoder::new(usize::from(max_body));
    }

    /// Counts from this STATUS on.
    pub(super) fn begin(&mut self, base: Option<Status>) {
        self.base = base;
        self.due = Due {
            bad: self.mirror_bad().wrapping_neg(),
            ..Due::default()
        };
    }

    /// These bytes go to the device.
    pub(super) fn written(&mut self, say: &Say) {
        for &byte in &say.bytes {
            self.mirror.push(byte);
        }
        let is_bad = matches!(say.want, Want::Bad);
        self.due.bad = self.due.bad.wrapping_add(u16::from(is_bad));
    }

    /// A FRAME with so much to clip was received.
    pub(super) fn clipped(&mut self, allowed: &Allowed) {
        self.due.clipped = self.due.clipped.wrapping_add(allowed.clipped);
    }

    /// Compares the counters of a STATUS with what was due so far.
    pub(super) fn compare(&self, now: &Status) -> Verdict {
        let Some(base) = &self.base else {
            return Ok(());
        };
        let bad = self.due.bad.wrapping_add(self.mirror_bad());
        let rows = [
            ("late", base.late, now.late, self.due.late),
            ("dup", base.dup, now.dup, self.due.dup),
            ("bad", base.bad, now.bad, bad),
            ("clipped", base.clipped, now.clipped, self.due.clipped),
        ];
        for (name, before, after, due) in rows {
            let risen = after.wrapping_sub(before);
            ensure!(risen == due, "{name} rose by {risen}, not by {due}")?;
        }
        Ok(())
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "counters wrap at 65536 on the wire"
    )]
    fn mirror_bad(&self) -> u16 {
        self.mirror.bad() as u16
    }
}
