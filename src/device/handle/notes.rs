//! What a bridge measures and writes down of its news.

use std::time::Instant;

use super::Bridge;
use crate::host::{BridgeEvent, DisarmedBy};
use crate::session_log::{HostCounters, LogFeed, Note};

/// A bridge's end of a log, if there is one.
#[derive(Debug, Default)]
pub(super) struct Notes {
    log: Option<LogFeed>,
    /// What the log knows of this side's counters.
    counted: HostCounters,
}

impl Bridge {
    /// Writes to a log what happens from now on: call it before the first [`poll`](Self::poll).
    pub fn log_to(&mut self, log: LogFeed) {
        self.session.keep_notes();
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
            Some(event) if self.notes.log.is_some() => self.note(event),
            _ => {}
        }
        self.write_notes();
    }

    /// Writes down what only an event tells.
    fn note(&mut self, event: &BridgeEvent) {
        let now = Instant::now();
        let said = match event {
            BridgeEvent::Refused(reason) => ("refused-device", reason),
            BridgeEvent::Lost(reason) => ("lost", reason),
            BridgeEvent::Log(text) => ("device-log", text),
            BridgeEvent::Disarmed {
                by: DisarmedBy::Device,
                reason,
            } => ("disarmed-itself", reason),
            BridgeEvent::Disarmed { reason, .. } => ("disarmed", reason),
            BridgeEvent::Tick { .. } => return self.note_counters(now),
            _ => return,
        };
        self.session.note(now, Note::Said(said.0, said.1.clone()));
    }

    fn note_counters(&mut self, now: Instant) {
        let counters = self.counters();
        let counted = HostCounters {
            rejected: counters.frames_rejected,
            superseded: counters.frames_superseded,
            bad_received: counters.bad_received,
            events_dropped: counters.events_dropped,
            write_timeouts: counters.write_timeouts,
        };
        if self.notes.counted != counted {
            self.notes.counted = counted;
            self.session.note(now, Note::HostCounters(counted));
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
