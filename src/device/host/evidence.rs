//! What tells how long that which is sent takes until the device has it.
//!
//! STATUS names the last FRAME that was accepted and says how long ago that was. Samples have no
//! such name: how many ticks of them wait in the device's ring says which came last, and the age is
//! theirs; those that are not there when their tick begins took longer than until then. A device
//! that says nothing of its ring is measured by its answers to PINGs, there and back.

use std::time::{Duration, Instant};

use super::HostSession;
use crate::message::Status;
use crate::session_log::Note;

/// Frames under way whose acceptance is still to be told.
const UNCONFIRMED: usize = 4;
/// How much later than at the start of their tick samples count that had not come by then.
const MORE: Duration = Duration::from_millis(1);

/// What delays are learned from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DelaySource {
    /// The number and age of the last accepted FRAME.
    LastSeq,
    /// How full the device's ring is, and the age of its last samples.
    Ring,
    /// Answers to PINGs.
    RoundTrips,
}

impl DelaySource {
    /// A word for the log.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::LastSeq => "last-seq",
            Self::Ring => "ring",
            Self::RoundTrips => "round-trips",
        }
    }
}

/// What was sent and is not known to have arrived.
#[derive(Clone, Debug, Default)]
pub(super) struct Evidence {
    /// What names them (the number of a frame, the tick of samples) and when they were due, newest
    /// first.
    unconfirmed: [Option<(u32, Instant)>; UNCONFIRMED],
    /// Whether the device was seen to count the samples in its ring.
    tells_ring: bool,
    source: Option<DelaySource>,
}

impl Evidence {
    /// Frame or samples that were due then go to the link.
    pub(super) fn sent(&mut self, name: u32, due: Instant) {
        self.unconfirmed.rotate_right(1);
        self.unconfirmed[0] = Some((name, due));
    }

    /// When what has this name was due; older ones say nothing any more.
    fn confirmed(&mut self, name: u32) -> Option<Instant> {
        let is_it = |sent: &Option<(u32, Instant)>| sent.is_some_and(|(of, _)| of == name);
        let place = self.unconfirmed.iter().position(is_it)?;
        let (_, due) = self.unconfirmed[place]?;
        self.unconfirmed[place..].fill(None);
        Some(due)
    }
}

impl HostSession {
    /// A tick began at `start`, and its STATUS says what the device had by then.
    pub(super) fn learn_from_status(&mut self, now: Instant, start: Instant, status: &Status) {
        let age =
            (status.age_ms < u16::MAX).then(|| Duration::from_millis(u64::from(status.age_ms)));
        let (delay, source) = if self.plays_samples() {
            (self.delay_of_samples(start, age, status), DelaySource::Ring)
        } else {
            (
                self.delay_of_frame(start, age, status.last_seq),
                DelaySource::LastSeq,
            )
        };
        if let Some(delay) = delay {
            self.learn(now, delay, source);
        }
    }

    /// A PING was answered; a ring that tells says more.
    pub(super) fn learn_from_answer(&mut self, now: Instant, round_trip: Duration) {
        if self.plays_samples() && self.state.takes_frames() && !self.evidence.tells_ring {
            self.learn(now, round_trip, DelaySource::RoundTrips);
        }
    }

    fn delay_of_frame(
        &mut self,
        start: Instant,
        age: Option<Duration>,
        seq: u16,
    ) -> Option<Duration> {
        let age = age?;
        let due = self.evidence.confirmed(seq.into())?;
        let accepted = start.checked_sub(age).unwrap_or(start);
        Some(accepted.saturating_duration_since(due))
    }

    fn delay_of_samples(
        &mut self,
        start: Instant,
        age: Option<Duration>,
        status: &Status,
    ) -> Option<Duration> {
        let Status { tick, queued, .. } = *status;
        if queued == 0 {
            let due = self.evidence.confirmed(tick)?;
            let until_start = start.saturating_duration_since(due);
            return self.evidence.tells_ring.then_some(until_start + MORE);
        }
        self.evidence.tells_ring = true;
        let newest = tick.wrapping_add(u32::from(queued) - 1);
        let due = self.evidence.confirmed(newest)?;
        let accepted = start.checked_sub(age?).unwrap_or(start);
        Some(accepted.saturating_duration_since(due))
    }

    fn learn(&mut self, now: Instant, delay: Duration, source: DelaySource) {
        self.latching.accepted(delay);
        if self.evidence.source.replace(source) != Some(source) {
            self.note(now, Note::Delays(source));
        }
    }
}
