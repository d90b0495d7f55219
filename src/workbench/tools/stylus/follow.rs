//! The stylus on the path of the display: a simulation that goes on with every tick, or begins
//! anew where another stretch of the last minutes is looked at.
//!
//! Between two ticks the centre is led along a [`TickPath`]: it passes through every pose, and its
//! velocity does not jump. A run begins at rest, where the hand's force is borne,
//! wherever the display comes onto a textile, after a pause or a leap, and every ten seconds of
//! felt time. So what is felt at a tick follows from the path alone: looked back at, it is the same
//! as it was live.

use std::collections::VecDeque;

use selvedge_engine::TICKS_PER_S;
use selvedge_foundation::numerics::to_whole;
use selvedge_render::contact::{StylusRow, StylusRun, StylusSetup, StylusStart};
use selvedge_render::stylus::TickPath;

/// Ticks that are shown: one second.
pub(crate) const WINDOW: u64 = 40;
/// A run begins anew every so many ticks of felt time: what must be computed at most to look back.
const LEG: u64 = 400;
/// Steps that are made in one frame at most: some 20 ms of work.
const MOST_STEPS: u64 = 12_000;

/// Where the display's centre is on a textile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spot {
    /// Which textile of the scene.
    pub(crate) textile: usize,
    /// In its own frame, mm.
    pub(crate) place_mm: [f64; 2],
}

/// An instant of the stylus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FeltRow {
    /// When, in columns of the history.
    pub(crate) column: f64,
    /// The way along the surface since the run began, mm.
    pub(crate) way_mm: f64,
    /// Energy that the passivity observer counted or, of a force that acts at all times, that did
    /// not come from nowhere, J: below 0 the wall gave more than it took.
    pub(crate) observed_j: f64,
    pub(crate) felt: StylusRow,
}

/// What a step of following came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Progress {
    /// Everything is there.
    Done,
    /// More is to be computed.
    More,
    /// A textile is not prepared yet.
    Waits,
}

/// The path, and how a run on a textile is made.
pub(crate) struct Way<'a> {
    /// Where the centre is at a column, if on a textile.
    pub(crate) spot: &'a dyn Fn(u64) -> Option<Spot>,
    /// A run on a textile; `None` while that is being prepared.
    pub(crate) setup: &'a dyn Fn(usize) -> Option<Result<StylusSetup, String>>,
}

/// A run on one textile.
#[derive(Debug)]
struct Leg {
    start: u64,
    /// `None` once it broke off.
    run: Option<StylusRun>,
    n_steps: u64,
    way_mm: f64,
}

/// The rows of the last second, and the run that makes the next.
#[derive(Debug, Default)]
pub(crate) struct Follower {
    leg: Option<Leg>,
    /// The column that comes next.
    next: u64,
    /// The first column whose rows are all here.
    first: u64,
    rows: VecDeque<FeltRow>,
    /// Why a run broke off.
    pub(crate) trouble: Option<String>,
    /// The stepper of the last run.
    pub(crate) chosen: Option<String>,
    n_steps: u64,
}

impl Follower {
    /// The rows, old to new.
    pub(crate) fn rows(&self) -> &VecDeque<FeltRow> {
        &self.rows
    }

    /// Steps made so far.
    pub(crate) fn n_steps(&self) -> u64 {
        self.n_steps
    }

    /// Forgets everything: path or settings are others.
    pub(crate) fn clear(&mut self) {
        *self = Self {
            n_steps: self.n_steps,
            ..Self::default()
        };
        // No column is as late: the next call begins anew.
        self.first = u64::MAX;
    }

    /// Goes on to a column, as far as one frame may.
    pub(crate) fn follow(&mut self, way: &Way<'_>, target: u64) -> Progress {
        let shown_from = target.saturating_sub(WINDOW);
        // What is shown first may be the end of the run before.
        let start = leg_start(way.spot, shown_from.saturating_sub(1));
        let goes_on = self.first <= shown_from && (start..=target + 1).contains(&self.next);
        if !goes_on {
            self.clear();
            (self.next, self.first) = (start, start);
        }
        let before = self.n_steps;
        while self.next <= target {
            if self.n_steps - before > MOST_STEPS {
                return Progress::More;
            }
            if !self.take_column(way) {
                return Progress::Waits;
            }
            self.next += 1;
        }
        let is_old = |row: &FeltRow| row.column < shown_from as f64;
        while self.rows.front().is_some_and(is_old) {
            self.rows.pop_front();
        }
        self.first = self.first.max(shown_from);
        Progress::Done
    }

    /// Simulates the next column; says no while its textile is being prepared.
    fn take_column(&mut self, way: &Way<'_>) -> bool {
        let column = self.next;
        let Some(spot) = (way.spot)(column) else {
            self.leg = None;
            return true;
        };
        let is_new = begins(way.spot, column);
        let setup = is_new.then(|| (way.setup)(spot.textile));
        if matches!(setup, Some(None)) {
            return false;
        }
        if let Some(before) = led_from(way.spot, column) {
            let earlier = (self.leg.as_ref())
                .filter(|leg| column >= leg.start + 2)
                .and_then(|_| led_from(way.spot, column - 1));
            self.go_on(column, &TickPath::new(earlier, before, spot.place_mm));
        }
        if let Some(setup) = setup.flatten() {
            self.begin(setup, column, spot);
        }
        true
    }

    fn begin(&mut self, setup: Result<StylusSetup, String>, column: u64, spot: Spot) {
        let run = setup.and_then(|setup| {
            let (method, why) = setup.chosen();
            self.chosen = Some(format!("{}: {why}", method.name()));
            StylusRun::new(setup, spot.place_mm, StylusStart::Resting)
                .map_err(|error| error.to_string())
        });
        let mut leg = Leg {
            start: column,
            run: None,
            n_steps: 0,
            way_mm: 0.0,
        };
        match run {
            Ok(run) => {
                self.rows.push_back(row_of(&run, column as f64, 0.0));
                leg.run = Some(run);
            }
            Err(why) => self.trouble = Some(why),
        }
        self.leg = Some(leg);
    }

    /// Steps from the tick before to this one.
    fn go_on(&mut self, column: u64, path: &TickPath) {
        let Some(leg) = &mut self.leg else { return };
        let Some(run) = &mut leg.run else { return };
        let ticks = (column - leg.start) as f64;
        let steps_a_tick = run.rate_hz() / TICKS_PER_S;
        let end = to_whole::<u64>((ticks * steps_a_tick + 1e-9).floor());
        let mut at_mm = run.row().place_mm;
        while leg.n_steps < end {
            leg.n_steps += 1;
            self.n_steps += 1;
            let s = leg.n_steps as f64 / steps_a_tick - (ticks - 1.0);
            if let Err(error) = run.step(path.at(s)) {
                self.trouble = Some(error.to_string());
                leg.run = None;
                return;
            }
            let [x, y, _] = run.row().place_mm;
            leg.way_mm += (x - at_mm[0]).hypot(y - at_mm[1]);
            at_mm = run.row().place_mm;
            let row = row_of(run, (column - 1) as f64 + s, leg.way_mm);
            // What has no number is not shown; the next step says why.
            if row.felt.force_n.is_finite() && row.felt.energy_j.is_finite() {
                self.rows.push_back(row);
            }
        }
    }
}

fn row_of(run: &StylusRun, column: f64, way_mm: f64) -> FeltRow {
    FeltRow {
        column,
        way_mm,
        observed_j: run.observed_j().unwrap_or_else(|| -run.gained_j()),
        felt: *run.row(),
    }
}

/// Where the display was a tick before, if it was led from there over the same textile.
fn led_from(spot: &dyn Fn(u64) -> Option<Spot>, column: u64) -> Option<[f64; 2]> {
    let (before, now) = (spot(column.checked_sub(1)?)?, spot(column)?);
    let path = TickPath::new(None, before.place_mm, now.place_mm);
    let is_led = before.textile == now.textile && path.is_led();
    is_led.then_some(before.place_mm)
}

/// Whether a run begins at a column that lies on a textile.
fn begins(spot: &dyn Fn(u64) -> Option<Spot>, column: u64) -> bool {
    column.is_multiple_of(LEG) || led_from(spot, column).is_none()
}

/// The column where the run began that is under way at a column.
fn leg_start(spot: &dyn Fn(u64) -> Option<Spot>, column: u64) -> u64 {
    if spot(column).is_none() {
        return column;
    }
    let back = (0..=column).rev();
    (back.take(to_whole::<usize>(LEG as f64) + 1))
        .find(|at| begins(spot, *at))
        .unwrap_or(column)
}
