//! An exploration: where a display was when, as a path file states it, and its ticks.
//!
//! Tick n is at `t_first + n/40` s. Between rows values are `a + (b − a)·s`; within 1e-9 s of a
//! row they are the row's. Everything is a function of the rows: no clock, no random number.
//! Displays beside the first have columns of their own where fingers held them ([`others`]).

mod others;

use std::path::Path;

use super::{Pose, SceneError, TICKS_PER_S};
use others::Others;
use selvedge_foundation::files::{self, FileError, Table, TableWriter};
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_foundation::numerics::to_whole;

/// Within this of a row, a tick is the row itself, s.
const SAME_TIME_S: f64 = 1e-9;
/// What rounding may take from the last tick, in ticks.
const LAST_TICK_SLACK: f64 = 1e-6;
/// The longest exploration, s: about eleven days.
const MAX_DURATION_S: f64 = 1e6;

const REQUIRED: [&str; 3] = ["t_s", "x_mm", "y_mm"];
const OPTIONAL: [&str; 3] = ["angle_deg", "vx_mm_per_s", "vy_mm_per_s"];

/// One row of a path.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathRow {
    /// When, s.
    pub t_s: f64,
    /// The display's centre in the workspace, mm.
    pub position: Point,
    /// Its turn counter-clockwise, degrees; not wrapped.
    pub angle_deg: f64,
    /// Its velocity, mm/s, if the path carries its own.
    pub velocity: Option<Velocity>,
}

/// A recorded or drawn exploration: at least one row, times strictly rising, every value finite.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplorationPath {
    rows: Vec<PathRow>,
    has_velocity: bool,
    others: Others,
}

impl PathRow {
    /// So far on the way from a number to another.
    fn mix(a: f64, b: f64, share: f64) -> f64 {
        a + (b - a) * share
    }
}

impl ExplorationPath {
    /// A path through these rows, with velocities if every row has one.
    ///
    /// # Errors
    /// No rows, a value that is not finite, a time that does not rise, longer than 10⁶ s. The
    /// message names the row, from 1.
    pub fn new(rows: Vec<PathRow>) -> Result<Self, SceneError> {
        match rows_flaw(&rows) {
            None => Ok(Self::of_good_rows(rows)),
            Some((row, what, mend)) => Err(SceneError::Value {
                what: format!("row {}: {what}", row + 1),
                mend: mend.to_owned(),
            }),
        }
    }

    /// Reads a path file.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::from_csv(&files::read_text(path)?, path)
    }

    /// Reads the text of a path file: `t_s,x_mm,y_mm` and optionally `angle_deg`,
    /// `vx_mm_per_s,vy_mm_per_s`, and of displays beside the first
    /// `x_mm_1,y_mm_1,vx_mm_per_s_1,vy_mm_per_s_1,…`. `path` only names it in errors.
    pub fn from_csv(text: &str, path: &Path) -> Result<Self, SceneError> {
        let of_others = others::columns();
        let optional = OPTIONAL.into_iter();
        let optional: Vec<&str> = optional
            .chain(of_others.iter().map(String::as_str))
            .collect();
        let table = Table::read(text, path, &REQUIRED, &optional)?;
        let [times, xs, ys] = REQUIRED.map(|column| table.required_numbers(column));
        let (times, xs, ys) = (times?, xs?, ys?);
        let angles = table.numbers("angle_deg")?;
        let velocities = match (table.numbers("vx_mm_per_s")?, table.numbers("vy_mm_per_s")?) {
            (Some(vx), Some(vy)) => Some((vx, vy)),
            (None, None) => None,
            _ => {
                let what = "one velocity column without the other";
                let mend = "give both vx_mm_per_s and vy_mm_per_s, or neither";
                return Err(FileError::content(path, 1, what, mend).into());
            }
        };
        let row = |i: usize| PathRow {
            t_s: times[i],
            position: Point::new(xs[i], ys[i]),
            angle_deg: angles.as_ref().map_or(0.0, |angles| angles[i]),
            velocity: velocities
                .as_ref()
                .map(|(vx, vy)| Velocity::new(vx[i], vy[i])),
        };
        let rows: Vec<PathRow> = (0..table.n_rows()).map(row).collect();
        if let Some((row, what, mend)) = rows_flaw(&rows) {
            return Err(FileError::content(path, table.line_of(row), what, mend).into());
        }
        others::read(Self::of_good_rows(rows), (&table, path))
    }

    /// The text of its file. Reading it gives the same path again.
    pub fn to_csv(&self) -> Result<String, SceneError> {
        let has_angle = self.rows.iter().any(|row| row.angle_deg != 0.0);
        let mut header = REQUIRED.to_vec();
        header.extend_from_slice(&OPTIONAL[..usize::from(has_angle)]);
        if self.has_velocity {
            header.extend_from_slice(&OPTIONAL[1..]);
        }
        let of_others = (1..=self.n_others()).flat_map(Self::columns_of_other);
        let of_others: Vec<String> = of_others.collect();
        header.extend(of_others.iter().map(String::as_str));
        let mut table = TableWriter::new(Vec::new(), Path::new("path"), &header)?;
        for (nth, row) in self.rows.iter().enumerate() {
            table
                .number(row.t_s)
                .number(row.position.x_mm)
                .number(row.position.y_mm);
            if has_angle {
                table.number(row.angle_deg);
            }
            if let Some(velocity) = row.velocity {
                table
                    .number(velocity.x_mm_per_s)
                    .number(velocity.y_mm_per_s);
            }
            for cell in self.others_of(nth).as_flattened() {
                table.optional(*cell);
            }
            table.end_row()?;
        }
        let bytes = table.finish()?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Writes a path file; a crash leaves the old one or the new one.
    pub fn write(&self, path: &Path) -> Result<(), SceneError> {
        Ok(files::write_atomic(path, self.to_csv()?.as_bytes())?)
    }

    /// The rows.
    pub fn rows(&self) -> &[PathRow] {
        &self.rows
    }

    /// Time from the first row to the last, s.
    pub fn duration_s(&self) -> f64 {
        self.rows[self.rows.len() - 1].t_s - self.rows[0].t_s
    }

    /// How many ticks it has: `⌊40 (t_last − t_first) + 1e-6⌋ + 1`.
    pub fn n_ticks(&self) -> u64 {
        to_whole::<u64>(TICKS_PER_S * self.duration_s() + LAST_TICK_SLACK) + 1
    }

    /// The ticks in order, each with its number from 0.
    pub fn ticks(&self) -> Ticks<'_> {
        Ticks {
            path: self,
            cursor: PathCursor::default(),
        }
    }

    fn of_good_rows(mut rows: Vec<PathRow>) -> Self {
        let has_velocity = rows.iter().all(|row| row.velocity.is_some());
        if !has_velocity {
            for row in &mut rows {
                row.velocity = None;
            }
        }
        Self {
            rows,
            has_velocity,
            others: Others::default(),
        }
    }

    /// When a tick is, s.
    fn tick_s(&self, tick: u64) -> f64 {
        self.rows[0].t_s + tick as f64 / TICKS_PER_S
    }

    /// The row at a time that lies at or after row `from`, interpolated, and the row to start from
    /// next time. Past the end it is the last row.
    pub fn row_at(&self, t_s: f64, from: usize) -> (PathRow, usize) {
        let (at, share) = self.place_of(t_s, from);
        let here = self.rows[at];
        let Some(&next) = self.rows.get(at + 1).filter(|_| share > 0.0) else {
            return (here, at);
        };
        if share >= 1.0 {
            return (next, at);
        }
        let mix = |a: f64, b: f64| PathRow::mix(a, b, share);
        let velocity = here.velocity.zip(next.velocity).map(|(a, b)| {
            Velocity::new(
                mix(a.x_mm_per_s, b.x_mm_per_s),
                mix(a.y_mm_per_s, b.y_mm_per_s),
            )
        });
        let row = PathRow {
            t_s,
            position: here.position.toward(next.position, share),
            angle_deg: mix(here.angle_deg, next.angle_deg),
            velocity,
        };
        (row, at)
    }

    /// The row before a time that lies at or after row `from`, and how far on the way to the next
    /// the time is: 0 at the one, 1 at the other, within what counts as the same time.
    fn place_of(&self, t_s: f64, from: usize) -> (usize, f64) {
        let rows = self.rows[from..].iter();
        let n_ahead = rows.take_while(|row| row.t_s <= t_s).count();
        let at = (from + n_ahead).saturating_sub(1);
        let here_s = self.rows[at].t_s;
        let Some(next) = self.rows.get(at + 1) else {
            return (at, 0.0);
        };
        if (t_s - here_s).abs() <= SAME_TIME_S {
            return (at, 0.0);
        }
        if (next.t_s - t_s).abs() <= SAME_TIME_S {
            return (at, 1.0);
        }
        // Not one of the two, so no share says so.
        let share = (t_s - here_s) / (next.t_s - here_s);
        (at, share)
    }
}

/// The first row that is wrong, what is wrong with it and how to mend it.
fn rows_flaw(rows: &[PathRow]) -> Option<(usize, String, &'static str)> {
    let Some(first) = rows.first() else {
        return Some((
            0,
            "the path has no rows".to_owned(),
            "give at least one row",
        ));
    };
    let mut before = f64::NEG_INFINITY;
    for (index, row) in rows.iter().enumerate() {
        let is_finite = row.t_s.is_finite()
            && row.position.is_finite()
            && row.angle_deg.is_finite()
            && row.velocity.is_none_or(Velocity::is_finite);
        if !is_finite {
            return Some((
                index,
                "a value is not finite".to_owned(),
                "write finite numbers",
            ));
        }
        if row.t_s <= before {
            let what = format!("t_s is {} after {before}", row.t_s);
            return Some((index, what, "let the time rise strictly from row to row"));
        }
        if row.t_s - first.t_s > MAX_DURATION_S {
            let what = format!("t_s is {} s after the first row", row.t_s - first.t_s);
            return Some((
                index,
                what,
                "split the path into parts of at most 1000000 s",
            ));
        }
        before = row.t_s;
    }
    None
}

/// A place in a path's ticks, so that whoever owns a path can step through it: plain data.
#[derive(Debug, Clone, Copy, Default)]
pub struct PathCursor {
    tick: u64,
    row: usize,
    before: Option<(Point, f64)>,
}

impl PathCursor {
    /// A cursor whose next step is this tick of the path, or its last if it has none such. That
    /// step gives the very pose that stepping through the path gives. Allocates nothing.
    pub fn at(path: &ExplorationPath, tick: u64) -> Self {
        let tick = tick.min(path.n_ticks() - 1);
        let Some(before) = tick.checked_sub(1) else {
            return Self::default();
        };
        let t_s = path.tick_s(before);
        let n_past = path.rows.partition_point(|row| row.t_s <= t_s);
        let (row, from) = path.row_at(t_s, n_past.saturating_sub(1));
        Self {
            tick,
            row: from,
            before: Some((row.position, row.angle_deg)),
        }
    }

    /// The next tick of the path and its pose; `None` past the end. Allocates nothing.
    pub fn step(&mut self, path: &ExplorationPath) -> Option<(u64, Pose)> {
        let tick = self.tick;
        if tick >= path.n_ticks() {
            return None;
        }
        let t_s = path.tick_s(tick);
        let (row, from) = path.row_at(t_s, self.row);
        let (before_position, before_deg) = self.before.unwrap_or((row.position, row.angle_deg));
        let moved = || Pose::moving_mm_per_s(before_position, row.position);
        *self = Self {
            tick: tick + 1,
            row: from,
            before: Some((row.position, row.angle_deg)),
        };
        let pose = Pose {
            t_s,
            position: row.position,
            angle_deg: row.angle_deg,
            velocity: row.velocity.unwrap_or_else(moved),
            angular_rad_per_s: Pose::turning_rad_per_s(before_deg, row.angle_deg),
        };
        Some((tick, pose))
    }
}

/// The ticks of a path in order.
#[derive(Debug, Clone)]
pub struct Ticks<'a> {
    path: &'a ExplorationPath,
    cursor: PathCursor,
}

impl Iterator for Ticks<'_> {
    type Item = (u64, Pose);

    fn next(&mut self) -> Option<Self::Item> {
        self.cursor.step(self.path)
    }
}

#[cfg(test)]
mod tests;
