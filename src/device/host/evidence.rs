//! What tells how long that which is sent takes until the device has it.
//!
//! STATUS names the last FRAME that was accepted and says how long ago that was. Samples have no
//! such name: how many ticks of them wait in the device's ring says which came last, and the age is
//! theirs; those that are not there when their tick begins took longer than until then. A device
//! that says nothing of its ring is measured by its answers to PINGs, there and back.

use std::time::{Duration, Instant};

use crate::message::Status;
use crate::session_log::DelaySource;

/// Frames under way whose acceptance is still to be told.
const UNCONFIRMED: usize = 4;
/// How much later than at the start of their tick samples count that had not come by then.
const MORE: Duration = Duration::from_millis(1);

/// What was sent and is not known to have arrived.
#[derive(Clone, Debug, Default)]
pub(super) struct Evidence {
    /// What names them (the number of a frame, the tick of samples) and when they were due, newest
    /// first.
    unconfirmed: [Option<(u32, Instant)>; UNCONFIRMED],
    /// Whether the device was seen to count the samples in its ring.
    knows_ring: bool,
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

    /// What a STATUS tells of the last frame: how long it took from when it was due until the
    /// device had it. The tick that the STATUS announces began at `start`.
    pub(super) fn delay_of_frame(&mut self, start: Instant, status: &Status) -> Option<Duration> {
        let age = age_of(status)?;
        let due = self.confirmed(status.last_seq.into())?;
        let accepted = start.checked_sub(age).unwrap_or(start);
        Some(accepted.saturating_duration_since(due))
    }

    /// The same of samples (mode B).
    pub(super) fn delay_of_samples(&mut self, start: Instant, status: &Status) -> Option<Duration> {
        let Status { tick, queued, .. } = *status;
        if queued == 0 {
            let due = self.confirmed(tick)?;
            let until_start = start.saturating_duration_since(due);
            return self.knows_ring.then_some(until_start + MORE);
        }
        self.knows_ring = true;
        let newest = tick.wrapping_add(u32::from(queued) - 1);
        let due = self.confirmed(newest)?;
        let accepted = start.checked_sub(age_of(status)?).unwrap_or(start);
        Some(accepted.saturating_duration_since(due))
    }

    /// Whether the device was seen to count the samples in its ring.
    pub(super) fn knows_ring(&self) -> bool {
        self.knows_ring
    }

    /// A delay was learned from this source; whether from another one than before.
    pub(super) fn is_new_source(&mut self, source: DelaySource) -> bool {
        self.source.replace(source) != Some(source)
    }
}

/// How old the last accepted frame was at the start of the tick; `None` if there is none.
fn age_of(status: &Status) -> Option<Duration> {
    (status.age_ms < u16::MAX).then(|| Duration::from_millis(u64::from(status.age_ms)))
}
