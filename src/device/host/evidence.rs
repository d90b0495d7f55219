//! What tells how long that which is sent takes until the device has it: STATUS names the last
//! FRAME that was accepted and says how long ago that was.

use std::time::{Duration, Instant};

use crate::message::Status;

/// Frames under way whose acceptance is still to be told.
const UNCONFIRMED: usize = 4;

/// What was sent and is not known to have arrived.
#[derive(Clone, Debug, Default)]
pub(super) struct Evidence {
    /// Numbers of frames and when they were due, newest first.
    unconfirmed: [Option<(u16, Instant)>; UNCONFIRMED],
}

impl Evidence {
    /// A frame that was due then goes to the link.
    pub(super) fn sent(&mut self, seq: u16, due: Instant) {
        self.unconfirmed.rotate_right(1);
        self.unconfirmed[0] = Some((seq, due));
    }

    /// When the frame with this number was due; older ones say nothing any more.
    fn confirmed(&mut self, seq: u16) -> Option<Instant> {
        let is_it = |sent: &Option<(u16, Instant)>| sent.is_some_and(|(of, _)| of == seq);
        let place = self.unconfirmed.iter().position(is_it)?;
        let (_, due) = self.unconfirmed[place]?;
        self.unconfirmed[place..].fill(None);
        Some(due)
    }

    /// What a STATUS tells of the last frame: how long it took from when it was due until the
    /// device had it. The tick that the STATUS announces began at `start`.
    pub(super) fn delay_of_frame(&mut self, start: Instant, status: &Status) -> Option<Duration> {
        let age = age_of(status)?;
        let due = self.confirmed(status.last_seq)?;
        let accepted = start.checked_sub(age).unwrap_or(start);
        Some(accepted.saturating_duration_since(due))
    }
}

/// How old the last accepted frame was at the start of the tick; `None` if there is none.
fn age_of(status: &Status) -> Option<Duration> {
    (status.age_ms < u16::MAX).then(|| Duration::from_millis(u64::from(status.age_ms)))
}
