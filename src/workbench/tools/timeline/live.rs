//! What is drawn of the last minutes: tiles that grow with what is felt, in felt time, where a
//! pause is one empty column.

use std::ops::Range;

use crate::bench::Bench;
use crate::bench::on_finger::OnFinger;
use crate::bench::recording::tiles::Tiles;
use crate::bench::signals::contact::ContactColumns;
use crate::bench::signals::history::{CAPACITY, Entry, History};
use crate::bench::signals::rows::{N_ROWS, Rows};
use crate::tools::timeline::columns::{Limits, n_felt_rows, write_felt, write_levels};
use crate::tools::timeline::layer::limits;
use crate::tools::timeline::span::Span;
use selvedge_device::{ArrayProfile, LinkScale};

/// Ticks of felt exploration that are shown until another part is asked for: 12 s.
pub(crate) const N_SHOWN: f64 = 480.0;
/// Most columns of the spectrum that are computed in one frame.
const MOST_IN_A_FRAME: usize = 120;

/// What is drawn of the last minutes.
#[derive(Debug, Default)]
pub(crate) struct LiveTiles {
    felt: Tiles,
    /// The history that the tiles are of: how often it was cleared, and its contactors.
    of: (u64, usize),
    /// The column that comes next.
    next: u64,
    limits: Option<((ArrayProfile, Option<LinkScale>), Limits)>,
    spectrum: Tiles,
    spectrum_of: (u64, u64, usize),
    /// Columns whose spectrum is there, without a gap between them.
    whole: Range<u64>,
    columns: ContactColumns,
}

impl LiveTiles {
    /// Speed, levels and limits.
    pub(crate) fn felt(&self) -> &Tiles {
        &self.felt
    }

    /// What arrives at the contactor.
    pub(crate) fn spectrum(&self) -> &Tiles {
        &self.spectrum
    }

    /// Takes in what was felt since, and computes the spectra of the columns in sight, as many as
    /// one frame may. Whether more are due.
    pub(crate) fn follow(&mut self, bench: &mut Bench, contactor: usize, in_sight: Span) -> bool {
        let history = &bench.past.history;
        let of = (history.n_clears, history.n_contactors());
        if self.of != of || self.felt.n_rows == 0 {
            self.of = of;
            self.felt = Tiles::new(n_felt_rows(of.1), 0);
            self.next = 0;
            self.limits = None;
        }
        if history
            .newest()
            .is_some_and(|newest| newest.column >= self.next)
        {
            self.take_felt(bench);
        }
        self.take_spectra(bench, contactor, in_sight)
    }

    fn take_felt(&mut self, bench: &Bench) {
        let scale = bench.live.bridge.as_ref().and_then(|bridge| bridge.scale);
        let (key, n_contactors) = ((bench.array(), scale), self.of.1);
        if self.limits.as_ref().is_none_or(|(known, _)| *known != key) {
            let made = limits(&key, n_contactors);
            self.limits = Some((key, made));
        }
        let Some((_, limits)) = &mut self.limits else {
            return;
        };
        let history = &bench.past.history;
        let mut rows = vec![0; n_felt_rows(n_contactors)];
        let mut felt_um = Vec::with_capacity(n_contactors);
        for entry in history.entries().range(history.place_of(self.next)..) {
            felt_um.clear();
            felt_um.extend(history.felt_um(entry.column).into_iter().flatten());
            write_felt(motion(entry), &felt_um, limits, &mut rows);
            self.felt.put(entry.column, &rows);
            self.next = entry.column + 1;
        }
        self.felt
            .forget_before(self.next.saturating_sub(2 * CAPACITY as u64));
    }

    /// The newest columns in sight come first.
    fn take_spectra(&mut self, bench: &mut Bench, contactor: usize, in_sight: Span) -> bool {
        let display = bench.display();
        let (history, inspection) = (&bench.past.history, &mut bench.inspection);
        let of = (history.n_clears, inspection.n_scenes, contactor);
        if self.spectrum_of != of || self.spectrum.n_rows == 0 {
            self.spectrum_of = of;
            self.spectrum = Tiles::new(N_ROWS, 0);
            self.whole = 0..0;
        }
        let Some(all) = columns_of(history) else {
            return false;
        };
        let sight = in_sight.ticks();
        let sight = sight.start.max(all.start)..sight.end.min(all.end);
        if !joins(&self.whole, &sight) {
            self.whole = sight.end..sight.end;
        }
        let after = self.whole.end..sight.end;
        let before = sight.start..self.whole.start;
        let due: Vec<u64> = after.chain(before.rev()).take(MOST_IN_A_FRAME).collect();
        let mut levels_db: Rows = [0.0; N_ROWS];
        let mut rows = [0; N_ROWS];
        for column in &due {
            if let Some(entry) = history.at_column(*column) {
                let (inspector, pose) = (&mut inspection.inspector, &entry.tick_sample.pose);
                self.columns
                    .levels_db(inspector, [display, contactor], pose, &mut levels_db);
                write_levels(&levels_db, &mut rows);
                self.spectrum.put(*column, &rows);
            }
            self.whole = self.whole.start.min(*column)..self.whole.end.max(column + 1);
        }
        self.spectrum.forget_before(all.start);
        due.len() == MOST_IN_A_FRAME
    }
}

/// Whether what is whole and what is in sight touch.
fn joins(whole: &Range<u64>, sight: &Range<u64>) -> bool {
    !whole.is_empty() && whole.start <= sight.end && sight.start <= whole.end
}

/// The columns that a history has; `None` before anything was felt.
pub(crate) fn columns_of(history: &History) -> Option<Range<u64>> {
    let first = history.entries().front()?.column;
    Some(first..history.newest()?.column + 1)
}

/// All that can be shown of a history; at least so much as is shown at first.
pub(crate) fn extent_of(history: &History) -> Span {
    let columns = columns_of(history).unwrap_or(0..0);
    let end = columns.end as f64;
    Span::new((columns.start as f64).min(end - N_SHOWN), end)
}

/// The speed of a tick, mm/s, and what the finger got.
fn motion(entry: &Entry) -> (f64, OnFinger) {
    let sample = &entry.tick_sample;
    let on_finger = if sample.is_silent {
        OnFinger::Held
    } else {
        OnFinger::sent(sample.display == 0 && sample.apply_tick.is_some())
    };
    (sample.pose.velocity.speed_mm_per_s(), on_finger)
}
