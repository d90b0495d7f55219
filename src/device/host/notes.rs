//! What a session writes down for its log, if anybody keeps one.

use std::collections::VecDeque;
use std::time::Instant;

use super::HostSession;
use crate::message::kind;
use crate::session_log::{Entry, Note};

/// Notes between two times that they are fetched.
const MOST_NOTES: usize = 64;

/// Notes that were not fetched yet; none are taken until somebody wants them.
#[derive(Debug, Default)]
pub(super) struct Notes {
    waiting: VecDeque<Entry>,
    is_wanted: bool,
    faults: u16,
}

impl HostSession {
    /// From now on what happens is written down. Allocates.
    pub fn keep_notes(&mut self) {
        self.notes.is_wanted = true;
        self.notes.waiting.reserve(MOST_NOTES);
    }

    /// The next thing that was written down.
    pub(crate) fn next_note(&mut self) -> Option<Entry> {
        self.notes.waiting.pop_front()
    }

    /// Writes something down, with the times of host and device.
    pub(crate) fn note(&mut self, now: Instant, note: Note) {
        if !self.notes.is_wanted || self.notes.waiting.len() >= MOST_NOTES {
            return;
        }
        let tick = self.status.map(|_| self.present_tick(now));
        let device_us = self.clock.device_us(now);
        self.notes.waiting.push_back(Entry {
            at: now,
            tick,
            device_us,
            note,
        });
    }

    /// The note of a request that is sent.
    pub(super) fn note_of(&self, request: u8) -> Note {
        match request {
            kind::HELLO => Note::Hello(self.nonce),
            kind::CONFIG => Note::Config(self.wish()),
            kind::CLEAR => Note::Clear,
            _ => Note::Arm,
        }
    }

    /// Whether fault bits are news: FAULT comes every 100 ms.
    pub(super) fn is_news(&mut self, faults: u16) -> bool {
        std::mem::replace(&mut self.notes.faults, faults) != faults
    }
}
