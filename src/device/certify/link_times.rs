//! How late the link is, learnt from PONGs: when to speak so that it is heard at a told phase, and
//! whether host or link were later than usual.

use std::collections::VecDeque;

use super::predict::Between;

/// A time that differs by more from the usual tells of a host or link that was late, µs.
const LATE_US: u64 = 4000;
/// The same for what comes back: an adapter may keep it for 16 ms.
const LATE_BACK_US: i64 = 20_000;
/// PONGs by which the link is known.
const N_PONGS: usize = 15;

/// What is known of the link.
#[derive(Debug, Default)]
pub(super) struct LinkTimes {
    /// Device time minus host time at writing, of the last PONGs, µs.
    offsets_us: VecDeque<i64>,
    /// Host time at arrival minus device time, of what came last, µs.
    arrivals_us: VecDeque<i64>,
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
        keep(&mut self.offsets_us, offset_us);
    }

    /// What was said at `said_us` of the device came at `now_us` of the host.
    pub(super) fn came(&mut self, said_us: u64, now_us: u64) {
        let took_us = now_us.cast_signed() - said_us.cast_signed();
        let usual_us = median(&self.arrivals_us).unwrap_or(took_us);
        self.is_late |= took_us.saturating_sub(usual_us) > LATE_BACK_US;
        keep(&mut self.arrivals_us, took_us);
    }

    /// The host woke at `now_us` and wanted to at `wanted_us`.
    pub(super) fn woke(&mut self, now_us: u64, wanted_us: u64) {
        self.is_late |= now_us > wanted_us + LATE_US;
    }

    /// Device time minus host time at writing as it mostly is, µs.
    pub(super) fn offset_us(&self) -> i64 {
        median(&self.offsets_us).unwrap_or(0)
    }
}

fn keep(times_us: &mut VecDeque<i64>, us: i64) {
    times_us.push_back(us);
    if times_us.len() > N_PONGS {
        times_us.pop_front();
    }
}

fn median(times_us: &VecDeque<i64>) -> Option<i64> {
    let mut sorted: Vec<i64> = times_us.iter().copied().collect();
    sorted.sort_unstable();
    sorted.get(sorted.len() / 2).copied()
}
