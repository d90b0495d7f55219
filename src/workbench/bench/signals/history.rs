//! The last minutes, tick by tick: what timelines and spectrograms are drawn from.
//!
//! It keeps tick samples as they came. Time in it is felt time: every tick sample is one column
//! wide, and a pause, however long, is one empty column.

use std::collections::VecDeque;
use std::ops::Range;

use selvedge_engine::TickSample;
use selvedge_render::scene::Pose;

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
    /// As many for each entry: [A40, A320] of the contactors of all displays one after the other,
    /// µm.
    felt_um: VecDeque<[f32; 2]>,
    /// As many for each entry: the poses of all displays, none where there is one.
    poses: VecDeque<Pose>,
    /// How many of those an entry has.
    n_each: [usize; 2],
    /// The display that is watched, and its contactors among those of all.
    watched: (u32, Range<usize>),
    next_column: u64,
    /// How often it was cleared: what was made from it before is void when this changes.
    pub(crate) n_clears: u64,
}

impl History {
    /// Takes in a tick without amplitudes.
    #[cfg(test)]
    pub(crate) fn take(&mut self, tick_sample: TickSample) -> bool {
        self.take_felt((tick_sample, &[], &[]))
    }

    /// Takes in a tick with the amplitudes [A40, A320] of the contactors of all displays, µm, and
    /// the poses of all displays, none where there is one. Says whether it was new: a tick that is
    /// already here changes nothing, and one from before it (the engine began anew), or of another
    /// display, clears what was there.
    pub(crate) fn take_felt(
        &mut self,
        (tick_sample, felt_um, poses): (TickSample, &[[f32; 2]], &[Pose]),
    ) -> bool {
        let n_each = [felt_um.len(), poses.len()];
        let [first, n] = [tick_sample.first_contactor, tick_sample.n_contactors]
            .map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        let end = first.saturating_add(n).min(felt_um.len());
        let watched = (tick_sample.display, first.min(end)..end);
        if (n_each, &watched) != (self.n_each, &self.watched) {
            if !self.entries.is_empty() {
                self.clear();
            }
            (self.n_each, self.watched) = (n_each, watched);
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
            self.felt_um.drain(..self.n_each[0]);
            self.poses.drain(..self.n_each[1]);
        }
        self.felt_um.extend(felt_um);
        self.poses.extend(poses);
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
        self.poses.clear();
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

    /// Contactors of the display that is watched.
    pub(crate) fn n_contactors(&self) -> usize {
        self.watched.1.len()
    }

    /// Its [A40, A320] by contactor at a column, after gains and before output limits, µm.
    pub(crate) fn felt_um(&self, column: u64) -> Option<impl Iterator<Item = [f32; 2]> + Clone> {
        let place = self.place_of(column);
        let entry = self.entries.get(place);
        entry.filter(|entry| entry.column == column)?;
        let before = place * self.n_each[0];
        let watched = &self.watched.1;
        let felt_um = (self.felt_um).range(before + watched.start..before + watched.end);
        Some(felt_um.copied())
    }

    /// The entries at these columns: each with the poses of all displays, and the amplitudes of
    /// their contactors one after the other.
    pub(crate) fn of_all_displays(
        &self,
        columns: Range<u64>,
    ) -> impl Iterator<Item = (&Entry, Vec<Pose>, Vec<[f32; 2]>)> {
        let places = self.place_of(columns.start)..self.place_of(columns.end);
        let [n_contactors, n_poses] = self.n_each;
        let entries = places.clone().zip(self.entries.range(places));
        entries.map(move |(place, entry)| {
            let poses = self.poses.range(place * n_poses..(place + 1) * n_poses);
            let mut poses: Vec<Pose> = poses.copied().collect();
            if poses.is_empty() {
                poses.push(entry.tick_sample.pose);
            }
            let felt_um = place * n_contactors..(place + 1) * n_contactors;
            (entry, poses, self.felt_um.range(felt_um).copied().collect())
        })
    }

    /// Where the first entry lies that is not before a column.
    pub(crate) fn place_of(&self, column: u64) -> usize {
        self.entries.partition_point(|entry| entry.column < column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::Point;

    fn tick_sample(tick: u64) -> TickSample {
        TickSample {
            tick,
            ..TickSample::default()
        }
    }

    fn of_contactors(tick: u64, n_contactors: u32) -> TickSample {
        TickSample {
            n_contactors,
            ..tick_sample(tick)
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
            history.take_felt((of_contactors(tick, 2), &felt(tick), &[]));
        }
        for tick in [7, 500, CAPACITY as u64 + 6] {
            let kept = history.felt_um(tick).unwrap();
            assert!(kept.eq(felt(tick)), "{tick}");
        }
        assert!(history.felt_um(6).is_none(), "forgotten");
        history.take_felt((of_contactors(99_999, 1), &[[1.0; 2]], &[]));
        let n_contactors = history.n_contactors();
        assert_eq!((history.tick_samples().len(), n_contactors), (1, 1));
    }

    #[test]
    fn all_displays_are_kept_and_the_watched_one_is_shown() {
        let mut history = History::default();
        let pose = |x_mm: f64| Pose {
            position: Point::new(x_mm, 0.0),
            ..Pose::default()
        };
        for tick in 0..CAPACITY as u64 + 3 {
            let of_second = TickSample {
                display: 1,
                first_contactor: 2,
                ..of_contactors(tick, 1)
            };
            let um = [[1.0; 2], [2.0; 2], [tick as f32; 2]];
            history.take_felt((of_second, &um, &[pose(tick as f64), pose(-1.0)]));
        }
        assert!(history.felt_um(5).unwrap().eq([[5.0; 2]]));
        let kept: Vec<_> = history.of_all_displays(7..9).collect();
        for ((entry, poses, um), tick) in kept.iter().zip([7_u16, 8]) {
            assert_eq!(entry.tick_sample.tick, u64::from(tick));
            assert_eq!(poses[..], [pose(f64::from(tick)), pose(-1.0)]);
            assert_eq!(um[..], [[1.0; 2], [2.0; 2], [f32::from(tick); 2]]);
        }
        assert_eq!(kept.len(), 2);
        let of_first = of_contactors(99_999, 2);
        history.take_felt((of_first, &[[1.0; 2]; 3], &[pose(0.0); 2]));
        assert_eq!(
            history.tick_samples().len(),
            1,
            "another display begins anew"
        );
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
