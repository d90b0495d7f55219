//! Displays beside the first in a path: where each was while a finger of its own held it.

use std::path::Path;

use super::{ExplorationPath, PathRow};
use crate::scene::{Pose, SceneError};
use selvedge_foundation::files::{FileError, Table};
use selvedge_foundation::geometry::{Point, Velocity};

/// What columns of a display are called before its number.
const COLUMNS: [&str; 4] = ["x_mm", "y_mm", "vx_mm_per_s", "vy_mm_per_s"];
/// The most displays beside the first that a path file may have: a finger for each.
const MOST_OTHERS: usize = 9;

/// What is wrong with a row, and how to mend it.
const FLAW: &str = "a display beside the first is not whole";
const MEND: &str = "give place and velocity, or the place, or nothing";

/// A display at a row: place and velocity, mm and mm/s. All are missing while it goes with the
/// first display, the velocity while it rests, not even turned: no finger held it.
pub(super) type Cells = [Option<f64>; 4];

/// Displays beside the first: row after row of the path the cells of each.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Others {
    pub(super) n_others: usize,
    cells: Vec<Cells>,
}

impl Pose {
    /// What a path tells of a display beside the first, which is at `first`.
    pub fn beside(&self, first: &Self) -> [Option<f64>; 4] {
        let (at, velocity) = (self.position, self.velocity);
        if self == first {
            return [None; 4];
        }
        let [x, y] = [at.x_mm, at.y_mm].map(Some);
        if *self == self.at_rest() {
            return [x, y, None, None];
        }
        [x, y, Some(velocity.x_mm_per_s), Some(velocity.y_mm_per_s)]
    }

    /// A display of which a path tells this, while the first is at `self`.
    fn with(&self, cells: &Cells) -> Self {
        match *cells {
            [Some(x), Some(y), Some(vx), Some(vy)] => Self {
                position: Point::new(x, y),
                velocity: Velocity::new(vx, vy),
                ..*self
            },
            [Some(x), Some(y), ..] => Self {
                position: Point::new(x, y),
                ..self.at_rest()
            },
            _ => *self,
        }
    }
}

impl ExplorationPath {
    /// The names of the columns of a display, from 1.
    pub fn columns_of_other(display: usize) -> [String; 4] {
        COLUMNS.map(|column| format!("{column}_{display}"))
    }

    /// The same path with so many displays beside the first: row after row, for each of them, what
    /// [`Pose::beside`] tells. Displays that go with the first all the way are left out.
    ///
    /// # Errors
    /// A row has other than so many, a value is not finite, or stands without its neighbour.
    pub fn with_others(
        self,
        n_others: usize,
        cells: Vec<[Option<f64>; 4]>,
    ) -> Result<Self, SceneError> {
        if let Some(row) = flaw(n_others, self.rows.len(), &cells) {
            return Err(SceneError::Value {
                what: format!("row {}: {FLAW}", row + 1),
                mend: MEND.to_owned(),
            });
        }
        let are_apart = cells.iter().any(|cells| *cells != [None; 4]);
        let others = if are_apart {
            Others { n_others, cells }
        } else {
            Others::default()
        };
        Ok(Self { others, ..self })
    }

    /// Displays beside the first that it tells of.
    pub fn n_others(&self) -> usize {
        self.others.n_others
    }

    /// The poses of all displays at a tick at which the first is at `first`: each its own as far
    /// as the path tells of it, else that. Allocates nothing.
    pub fn poses_into(&self, first: &Pose, poses: &mut [Pose]) {
        poses.fill(*first);
        let n = self.others.n_others;
        if n == 0 {
            return;
        }
        let from = self.rows.partition_point(|row| row.t_s <= first.t_s);
        let (at, share) = self.place_of(first.t_s, from.saturating_sub(1));
        let [here, next] = [at, at + 1].map(|row| self.others.cells.get(row * n..).unwrap_or(&[]));
        for (nth, pose) in poses.iter_mut().skip(1).take(n).enumerate() {
            let here = here.get(nth).unwrap_or(&[None; 4]);
            let cells = match next.get(nth) {
                Some(next) if share >= 1.0 => *next,
                Some(next) if share > 0.0 => mixed(here, next, share),
                _ => *here,
            };
            *pose = first.with(&cells);
        }
    }

    /// The pose of a display at a tick at which the first is at `first`.
    pub fn pose_of(&self, display: usize, first: &Pose) -> Pose {
        let mut poses = [*first; 1 + MOST_OTHERS];
        self.poses_into(first, &mut poses);
        poses.get(display).copied().unwrap_or(*first)
    }

    /// The cells of every row, empty ones where displays are together.
    pub(super) fn others_of(&self, row: usize) -> &[Cells] {
        let n = self.others.n_others;
        self.others.cells.get(row * n..(row + 1) * n).unwrap_or(&[])
    }
}

/// The first row that is wrong.
fn flaw(n_others: usize, n_rows: usize, cells: &[Cells]) -> Option<usize> {
    if n_others > MOST_OTHERS || cells.len() != n_others * n_rows {
        return Some(0);
    }
    let is_flaw = |cells: &Cells| {
        let is_known = cells.map(|cell| cell.is_some());
        let is_whole = [[false; 4], [true, true, false, false], [true; 4]].contains(&is_known);
        !is_whole || cells.iter().flatten().any(|number| !number.is_finite())
    };
    let nth = cells.iter().position(is_flaw)?;
    Some(nth / n_others.max(1))
}

/// Between two rows: what either does not tell stays as the first of them has it.
fn mixed(here: &Cells, next: &Cells, share: f64) -> Cells {
    let is_alike = here.map(|cell| cell.is_some()) == next.map(|cell| cell.is_some());
    let mix = |(a, b): (f64, f64)| PathRow::mix(a, b, share);
    let mut cells = *here;
    for (cell, next) in cells.iter_mut().zip(next).filter(|_| is_alike) {
        *cell = cell.zip(*next).map(mix);
    }
    cells
}

/// The columns that a path file may have.
pub(super) fn columns() -> Vec<String> {
    let all = (1..=MOST_OTHERS).flat_map(ExplorationPath::columns_of_other);
    all.collect()
}

/// Displays beside the first as a table has them.
pub(super) fn read(
    path: ExplorationPath,
    (table, file): (&Table, &Path),
) -> Result<ExplorationPath, SceneError> {
    let has = |display: &usize| {
        let columns = ExplorationPath::columns_of_other(*display);
        columns.iter().any(|column| table.text(column).is_some())
    };
    let n_others = (1..=MOST_OTHERS).rfind(has).unwrap_or(0);
    let mut cells = vec![[None; 4]; n_others * table.n_rows()];
    for display in 1..=n_others {
        for (part, column) in ExplorationPath::columns_of_other(display)
            .iter()
            .enumerate()
        {
            let texts = table.text(column).unwrap_or_default();
            for (row, text) in texts
                .iter()
                .enumerate()
                .filter(|(_, text)| !text.is_empty())
            {
                let number = text.parse::<f64>().map_err(|_error| {
                    let what = format!("{column} is \"{text}\"");
                    let mend = "write a finite decimal number with a point, or nothing";
                    FileError::content(file, table.line_of(row), what, mend)
                })?;
                cells[row * n_others + display - 1][part] = Some(number);
            }
        }
    }
    if let Some(row) = flaw(n_others, table.n_rows(), &cells) {
        return Err(FileError::content(file, table.line_of(row), FLAW, MEND).into());
    }
    path.with_others(n_others, cells)
}
