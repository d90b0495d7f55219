//! The last columns of a spectrogram, computed from the history when somebody looks.
//!
//! A column is computed once. After a time unseen only what would be visible is caught up, a
//! limited number of columns a frame.

use std::ops::Range;

use crate::bench::signals::history::{Entry, History};
use crate::bench::signals::rows::{N_ROWS, Rows};

/// Columns that are shown: 8 s of felt time.
pub(crate) const N_COLUMNS: usize = 320;
/// Columns that are held: some more, so that the oldest shown never touches the newest.
pub(crate) const N_SLOTS: usize = 336;
/// Most columns that are computed in one frame.
const MAX_COLUMNS_A_FRAME: u64 = 120;
/// What stands where there is no column: pauses, and what is not computed.
const EMPTY: Rows = [f32::NAN; N_ROWS];

/// What catching up did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Progress {
    /// The columns that are new or have become empty.
    pub fresh: Range<u64>,
    /// Whether more columns are due than one frame computes.
    pub(crate) is_behind: bool,
}

/// A ring of columns; a value that is NaN is none.
#[derive(Debug, Clone)]
pub(crate) struct ColumnRing {
    slots: Vec<Rows>,
    /// The column after the newest one that is here.
    pub(crate) next: u64,
    n_columns_computed: u64,
}

impl Default for ColumnRing {
    fn default() -> Self {
        Self {
            slots: vec![EMPTY; N_SLOTS],
            next: 0,
            n_columns_computed: 0,
        }
    }
}

impl ColumnRing {
    /// Forgets every column.
    pub(crate) fn restart(&mut self) {
        self.slots.fill(EMPTY);
        self.next = 0;
    }

    /// Computes what the history has and the ring has not, old to new.
    pub(crate) fn catch_up(
        &mut self,
        history: &History,
        mut fill: impl FnMut(&Entry, &mut Rows),
    ) -> Progress {
        let end = history.newest().map_or(0, |newest| newest.column + 1);
        let wanted = self.next.max(end.saturating_sub(N_COLUMNS as u64));
        let stop = end.min(wanted + MAX_COLUMNS_A_FRAME).max(self.next);
        let first = self.next.max(stop.saturating_sub(N_SLOTS as u64));
        for column in first..stop {
            let slot = &mut self.slots[slot_of(column)];
            *slot = EMPTY;
            let entry = history.at_column(column).filter(|_| column >= wanted);
            if let Some(entry) = entry {
                fill(entry, slot);
                self.n_columns_computed += 1;
            }
        }
        self.next = stop;
        Progress {
            fresh: first..stop,
            is_behind: stop < end,
        }
    }

    /// The rows in a slot.
    pub(crate) fn slot(&self, slot: usize) -> &Rows {
        self.slots.get(slot).unwrap_or(&EMPTY)
    }

    /// The rows of a column that is shown; `None` for one that is not.
    pub(crate) fn column(&self, column: u64) -> Option<&Rows> {
        let is_shown = column < self.next && column + N_COLUMNS as u64 >= self.next;
        is_shown.then(|| &self.slots[slot_of(column)])
    }

    /// Columns computed since it was made: it stands still while nobody looks.
    pub(crate) fn n_columns_computed(&self) -> u64 {
        self.n_columns_computed
    }
}

/// Where a column is held.
pub(crate) fn slot_of(column: u64) -> usize {
    usize::try_from(column % N_SLOTS as u64).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_engine::TickSample;

    fn take(history: &mut History, ticks: Range<u64>) {
        for tick in ticks {
            history.take(TickSample {
                tick,
                ..TickSample::default()
            });
        }
    }

    fn mark(entry: &Entry, rows: &mut Rows) {
        rows.fill(f32::from(u16::try_from(entry.tick_sample.tick).unwrap()));
    }

    #[test]
    fn every_column_is_computed_once() {
        let (mut ring, mut history) = (ColumnRing::default(), History::default());
        assert_eq!(ring.catch_up(&history, mark).fresh, 0..0);
        take(&mut history, 0..50);
        assert_eq!(ring.catch_up(&history, mark).fresh, 0..50);
        assert_eq!(ring.catch_up(&history, mark).fresh, 50..50);
        take(&mut history, 50..51);
        ring.catch_up(&history, mark);
        assert_eq!(ring.n_columns_computed(), 51);
        assert_eq!(ring.column(50).map(|rows| rows[7]), Some(50.0));
        assert!(ring.column(51).is_none(), "yet to come");
    }

    #[test]
    fn a_frame_computes_a_limited_number_and_says_that_more_are_due() {
        let (mut ring, mut history) = (ColumnRing::default(), History::default());
        take(&mut history, 0..480);
        let mut n_frames = 0;
        while ring.catch_up(&history, mark).is_behind {
            n_frames += 1;
            assert!(n_frames < 9, "it comes to an end");
        }
        assert_eq!((n_frames, ring.n_columns_computed()), (2, 320));
        assert_eq!(ring.column(160).map(|rows| rows[0]), Some(160.0));
    }

    #[test]
    fn pauses_and_what_was_missed_are_empty() {
        let (mut ring, mut history) = (ColumnRing::default(), History::default());
        take(&mut history, 0..3);
        take(&mut history, 900..903);
        ring.catch_up(&history, mark);
        assert!(
            ring.column(3).is_some_and(|rows| rows[0].is_nan()),
            "the pause"
        );
        take(&mut history, 903..1_600);
        let progress = ring.catch_up(&history, mark);
        assert!(
            progress.fresh.start <= progress.fresh.end - 320,
            "{progress:?}"
        );
        let old = ring.column(ring.next - 320);
        assert!(
            old.is_some_and(|rows| rows[0].is_nan()),
            "not computed: not shown"
        );
    }
}
