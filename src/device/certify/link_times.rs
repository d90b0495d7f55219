//! How late the link is, learnt from PONGs: when to speak so that it is heard at a told phase, and
//! whether host or link were later than usual.

use std::collections::VecDeque;

use super::predict::Between;

/// A time that differs by more from the usual tells of a host or link that was late, µs.
const LATE_US: u64 = 4000;
/// PONGs by which the link is known.
const N_PONGS: usize = 15;

/// What is known of the link.
#[derive(Debug, Default)]
pub(super) struct LinkTimes {
    /// Device time minus host time at writing, of the last PONGs, µs.
    offsets_us: VecDeque<i64>,
    pub(super) is_late: bool,
}

impl LinkTimes {
    /// What was written at `sent_us` of the host was heard between these.
    pub(super) fn learn(&mut self, heard: Between, sent_us: u64) {
        let offset_us = heard.from_us.cast_signed() - sent_us.cast_signed();
        if !self.offsets_us.is_empty() {
            self.is_late |= self.offset_us().abs_diff(offset_us) > LATE_US;
        }
        self.is_late |= heard.to_us.saturating_sub(heard.from_us) > LATE_US;
        self.offsets_us.push_back(offset_us);
        if self.offsets_us.len() > N_PONGS {
            self.offsets_us.pop_front();
        }
    }

    /// The host woke at `now_us` and wanted to at `wanted_us`.
    pub(super) fn woke(&mut self, now_us: u64, wanted_us: u64) {
        self.is_late |= now_us > wanted_us + LATE_US;
    }

    /// Device time minus host time at writing as it mostly is, µs.
    pub(super) fn offset_us(&self) -> i64 {
        let mut sorted: Vec<i64> = self.offsets_us.iter().copied().collect();
        sorted.sort_unstable();
        sorted.get(sorted.len() / 2).copied().unwrap_or(0)
    }
}
