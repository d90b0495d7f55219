//! The last seconds, tick by tick: what timelines and spectrograms are drawn from.
//!
//! It keeps tick samples as they came. Time in it is felt time: every tick sample is one column
//! wide, and a pause, however long, is one empty column.

use std::collections::VecDeque;

use selvedge_engine::TickSample;

/// How many tick samples are kept: 12 s of exploration.
pub(crate) const CAPACITY: usize = 480;

/// A tick with its place in felt time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Entry {
    /// Its column, counted from the first tick sample ever; a pause before it leaves one out.
    pub column: u64,
    /// What happened.
    pub tick_sample: TickSample,
}

/// The last 12 s of exploration.
#[derive(Debug, Clone, Default)]
pub(crate) struct History {
    entries: VecDeque<Entry>,
    next_column: u64,
    n_clears: u64,
}

impl History {
    /// Takes in a tick. Says whether it was new: a tick that is already here changes nothing, and
    /// one from before it (the engine began anew) clears what was there.
    pub(crate) fn take(&mut self, tick_sample: TickSample) -> bool {
        let last = self.entries.back().map(|entry| entry.tick_sample.tick);
        match last {
            Some(last) if tick_sample.tick == last => return false,
            Some(last) if tick_sample.tick < last => self.clear(),
            Some(last) if tick_sample.tick - last > 1 => self.next_column += 1,
            _ => {}
        }
        if self.entries.len() == CAPACITY {
            self.entries.pop_front();
        }
        let column = self.next_column;
        self.entries.push_back(Entry {
            column,
            tick_sample,
        });
        self.next_column += 1;
        true
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.entries.clear();
        self.n_clears += 1;
    }

    /// How often it was cleared: what was made from it before is void when this changes.
    pub(crate) fn n_clears(&self) -> u64 {
        self.n_clears
    }

    /// The ticks, old to new.
    pub(crate) fn tick_samples(
        &self,
    ) -> impl DoubleEndedIterator<Item = &TickSample> + ExactSizeIterator + Clone {
        self.entries.iter().map(|entry| &entry.tick_sample)
    }

    /// The ticks with their places in felt time, old to new.
    pub(crate) fn entries(&self) -> &VecDeque<Entry> {
        &self.entries
    }

    /// The newest tick.
    pub(crate) fn newest(&self) -> Option<&Entry> {
        self.entries.back()
    }

    /// The tick at a column; `None` in a pause, and for what is forgotten or yet to come.
    pub(crate) fn at_column(&self, column: u64) -> Option<&Entry> {
        let place = self.place_of(column);
        self.entries
            .get(place)
            .filter(|entry| entry.column == column)
    }

    /// Where the first entry lies that is not before a column.
    pub(crate) fn place_of(&self, column: u64) -> usize {
        self.entries.partition_point(|entry| entry.column < column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tick_sample(tick: u64) -> TickSample {
        TickSample {
            tick,
            ..TickSample::default()
        }
    }

    fn of(ticks: impl IntoIterator<Item = u64>) -> History {
        let mut history = History::default();
        for tick in ticks {
            history.take(tick_sample(tick));
        }
        history
    }

    #[test]
    fn a_pause_is_one_column_however_long() {
        let history = of([5, 6, 7, 4_000, 4_001, 4_003]);
        let columns: Vec<u64> = history.entries().iter().map(|e| e.column).collect();
        assert_eq!(columns, [0, 1, 2, 4, 5, 7]);
        assert!(history.at_column(3).is_none(), "the pause");
        assert_eq!(
            history.at_column(4).map(|e| e.tick_sample.tick),
            Some(4_000)
        );
        assert!(history.at_column(8).is_none(), "yet to come");
    }

    #[test]
    fn twelve_seconds_are_kept_old_to_new() {
        let history = of(0..2_000);
        assert_eq!(history.tick_samples().len(), CAPACITY);
        assert_eq!(history.tick_samples().next().map(|g| g.tick), Some(1_520));
        assert_eq!(
            history.tick_samples().next_back().map(|g| g.tick),
            Some(1_999)
        );
        assert!(history.at_column(1_519).is_none(), "forgotten");
        assert_eq!(
            history.at_column(1_520).map(|e| e.tick_sample.tick),
            Some(1_520)
        );
    }

    #[test]
    fn a_tick_counts_once_and_an_earlier_one_begins_anew() {
        let mut history = of([10, 11]);
        assert!(!history.take(tick_sample(11)), "it is there already");
        assert_eq!((history.tick_samples().len(), history.n_clears()), (2, 0));
        assert!(history.take(tick_sample(3)), "another engine");
        assert_eq!((history.tick_samples().len(), history.n_clears()), (1, 1));
        history.clear();
        assert!(history.newest().is_none(), "nothing left");
    }
}
