//! What a bridge measures and writes down of its news.

use std::time::{Duration, Instant};

use super::Bridge;
use crate::host::{BridgeCounters, BridgeEvent};
use crate::link::Link;
use crate::session_log::{HostCounters, LogFeed, Note, SessionLog};

/// From one line of telemetry to the next.
const TELEMETRY_EVERY: Duration = Duration::from_secs(1);

/// A bridge's end of a log, if there is one.
#[derive(Debug, Default)]
pub(super) struct Notes {
    log: Option<LogFeed>,
    /// What the log knows of this side's counters.
    counted: HostCounters,
    /// When telemetry was written last.
    told: Option<Instant>,
    has_ended: bool,
}

impl Bridge {
    /// An end of a log for this link, in the time in which the link lives. Allocates.
    pub fn feed_of(&self, log: &SessionLog) -> LogFeed {
        let told = self.link.as_ref().filter(|link| !link.has_threads());
        log.feed_told(&self.target, told.map(Link::now))
    }

    /// Writes to a log what happens from now on: call it before the first [`poll`](Self::poll).
    pub fn log_to(&mut self, log: LogFeed) {
        self.session.keep_notes();
        if let Some(taps) = self.link.as_mut().and_then(Link::take_taps) {
            log.follow(taps);
        }
        self.notes.log = Some(log);
    }

    /// Takes note of a piece of news.
    pub(super) fn heed(&mut self, event: Option<&BridgeEvent>) {
        match event {
            Some(BridgeEvent::Pong { round_trip, .. }) => {
                if let Some(link) = &self.link {
                    link.record_round_trip(*round_trip);
                }
            }
            Some(BridgeEvent::Tick { .. }) => self.note_tick(self.now()),
            Some(BridgeEvent::Refused(_) | BridgeEvent::Lost(_) | BridgeEvent::Disarmed { .. }) => {
                self.note_last(self.now());
            }
            _ => {}
        }
        self.write_notes();
    }

    fn note_tick(&mut self, now: Instant) {
        let counted = host_counters(&self.counters());
        if self.notes.counted != counted {
            self.notes.counted = counted;
            self.session.note(now, Note::HostCounters(counted));
        }
        let since = |told: Instant| now.saturating_duration_since(told);
        if self
            .notes
            .told
            .is_none_or(|told| since(told) >= TELEMETRY_EVERY)
        {
            self.note_telemetry(now);
        }
    }

    fn note_telemetry(&mut self, now: Instant) {
        self.notes.told = Some(now);
        if let Some(status) = self.session.status().copied() {
            let predicted = self.session.predicted_sum();
            self.session.note(now, Note::Telemetry(status, predicted));
        }
    }

    /// Output or the link has ended: what was measured and counted last, whether it changed or not.
    fn note_last(&mut self, now: Instant) {
        self.note_telemetry(now);
        let device = self.session.counters().device;
        self.session.note(now, Note::DeviceCounters(device));
        self.notes.counted = host_counters(&self.counters());
        self.session
            .note(now, Note::HostCounters(self.notes.counted));
    }

    /// The link is let go: the same, once.
    pub(super) fn note_end(&mut self) {
        if self.notes.log.is_some() && !std::mem::replace(&mut self.notes.has_ended, true) {
            self.note_last(self.now());
        }
    }

    pub(super) fn write_notes(&mut self) {
        if let Some(log) = &mut self.notes.log {
            while let Some(entry) = self.session.next_note() {
                log.push(entry);
            }
        }
    }
}

/// What a log holds of the counters of a link.
pub(crate) fn host_counters(counters: &BridgeCounters) -> HostCounters {
    HostCounters {
        rejected: counters.frames_rejected,
        superseded: counters.frames_superseded,
        bad_received: counters.bad_received,
        events_dropped: counters.events_dropped,
        write_timeouts: counters.write_timeouts,
    }
}
