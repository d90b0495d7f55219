//! What a session writes down for its log, if anybody keeps one.

use std::collections::VecDeque;

use crate::session_log::Entry;

/// Notes between two times that they are fetched.
const MAX_NOTES: usize = 64;

/// Notes that were not fetched yet; none are taken until somebody wants them.
#[derive(Debug, Default)]
pub(super) struct Notes {
    waiting: VecDeque<Entry>,
    is_wanted: bool,
    faults: u16,
}

impl Notes {
    /// From now on notes are taken. Allocates.
    pub(super) fn begin(&mut self) {
        self.is_wanted = true;
        self.waiting.reserve(MAX_NOTES);
    }

    /// Takes a note, if somebody wants it and there is room.
    pub(super) fn add(&mut self, entry: Entry) {
        if self.is_wanted && self.waiting.len() < MAX_NOTES {
            self.waiting.push_back(entry);
        }
    }

    /// The oldest note.
    pub(super) fn next(&mut self) -> Option<Entry> {
        self.waiting.pop_front()
    }

    /// Faults were cleared: the next are news.
    pub(super) fn forget_faults(&mut self) {
        self.faults = 0;
    }

    /// Whether fault bits are news: FAULT comes every 100 ms.
    pub(super) fn is_news(&mut self, faults: u16) -> bool {
        std::mem::replace(&mut self.faults, faults) != faults
    }
}
