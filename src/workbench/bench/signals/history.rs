//! The last minutes, tick by tick: what timelines and spectrograms are drawn from.
//!
//! It keeps tick samples as they came. Time in it is felt time: every tick sample is one column
//! wide, and a pause, however long, is one empty column.

use std::collections::VecDeque;

use selvedge_engine::TickSample;

/// How many tick samples are kept: five minutes of exploration, which take some 4 MB.
pub(crate) const CAPACITY: usize = 5 * 60 * 40;

/// A tick with its place in felt time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Entry {
    /// Its column, counted from the first tick sample ever; a pause before it leaves one out.
    pub column: u64,
    /// What happened.
    pub tick_sample: TickSample,
}

/// The last minutes of exploration.
#[derive(Debug, Clone, Default)]
pub(crate) struct History {
    entries: VecDeque<Entry>,
    /// As many for each entry: [A40, A320] of every contactor, µm.
    felt_um: VecDeque<[f32; 2]>,
    /// Contactors that amplitudes are known of.
    pub(crate) n_contactors: usize,
    next_column: u64,
    /// How often it was cleared: what was made from it before is void when this changes.
    pub(crate) n_clears: u64,
}

impl History {
    /// Takes in a tick without amplitudes.
    #[cfg(test)]
    pub(crate) fn take(&mut self, tick_sample: TickSample) -> bool {
        self.take_felt(tick_sample, &[])
    }

    /// Takes in a tick with the amplitudes [A40, A320] of every contactor, µm. Says whether it was
    /// new: a tick that is already here changes nothing, and one from before it (the engine began
    /// anew), or of another display, clears what was there.
    pub(crate) fn take_felt(&mut self, tick_sample: TickSample, felt_um: &[[f32; 2]]) -> bool {
        if felt_um.len() != self.n_contactors {
            if !self.entries.is_empty() {
                self.clear();
            }
            self.n_contactors = felt_um.len();
        }
        let last = self.entries.back().map(|entry| entry.tick_sample.tick);
        match last {
            Some(last) if tick_sample.tick == last => return false,
            Some(last) if tick_sample.tick < last => self.clear(),
            Some(last) if tick_sample.tick - last > 1 => self.next_column += 1,
            _ => {}
        }
        if self.entries.len() == CAPACITY {
            self.entries.pop_front();
            self.felt_um.drain(..self.n_contactors);
        }
        self.felt_um.extend(felt_um);
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
        self.felt_um.clear();
        self.n_clears += 1;
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

    /// [A40, A320] of every contactor at a column, after gains and before output limits, µm.
    pub(crate) fn felt_um(&self, column: u64) -> Option<impl Iterator<Item = [f32; 2]> + Clone> {
        let place = self.place_of(column);
        let entry = self.entries.get(place);
        entry.filter(|entry| entry.column == column)?;
        let first = place * self.n_contactors;
        let felt_um = self.felt_um.range(first..first + self.n_contactors);
        Some(felt_um.copied())
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
    fn five_minutes_are_kept_old_to_new() {
        let history = of(0..13_520);
        assert_eq!(history.tick_samples().len(), CAPACITY);
        assert_eq!(history.tick_samples().next().map(|g| g.tick), Some(1_520));
        assert_eq!(
            history.tick_samples().next_back().map(|g| g.tick),
            Some(13_519)
        );
        assert!(history.at_column(1_519).is_none(), "forgotten");
        assert_eq!(
            history.at_column(1_520).map(|e| e.tick_sample.tick),
            Some(1_520)
        );
    }

    #[test]
    fn amplitudes_stay_with_their_ticks_and_another_display_begins_anew() {
        let mut history = History::default();
        let felt = |tick: u64| [[tick as f32, 1.0], [0.0, tick as f32]];
        for tick in 0..CAPACITY as u64 + 7 {
            history.take_felt(tick_sample(tick), &felt(tick));
        }
        for tick in [7, 500, CAPACITY as u64 + 6] {
            let kept = history.felt_um(tick).unwrap();
            assert!(kept.eq(felt(tick)), "{tick}");
        }
        assert!(history.felt_um(6).is_none(), "forgotten");
        history.take_felt(tick_sample(99_999), &[[1.0; 2]]);
        let n_contactors = history.n_contactors;
        assert_eq!((history.tick_samples().len(), n_contactors), (1, 1));
    }

    #[test]
    fn a_tick_counts_once_and_an_earlier_one_begins_anew() {
        let mut history = of([10, 11]);
        assert!(!history.take(tick_sample(11)), "it is there already");
        assert_eq!((history.tick_samples().len(), history.n_clears), (2, 0));
        assert!(history.take(tick_sample(3)), "another engine");
        assert_eq!((history.tick_samples().len(), history.n_clears), (1, 1));
        history.clear();
        assert!(history.newest().is_none(), "nothing left");
    }
}
