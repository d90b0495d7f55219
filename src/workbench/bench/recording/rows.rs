//! The table of a recording, row by row: four columns for every display beside the first, two for
//! every contactor. A piece of a last row is left out.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};

use selvedge_foundation::files::FileError;
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::scene::PathRow;

/// The table.
pub(super) const TICKS: &str = "ticks.csv";
/// The first columns of the table; four for every display beside the first and two for every
/// contactor follow.
pub(super) const COLUMNS: [&str; 8] = [
    "t_s",
    "tick",
    "x_mm",
    "y_mm",
    "angle_deg",
    "vx_mm_per_s",
    "vy_mm_per_s",
    "device_tick",
];
/// A longer line is in no table of ours.
const LONGEST_LINE: u64 = 1 << 20;
/// The most ticks that are read: those of the longest recording.
const MOST_TICKS: usize = 4 * 3600 * 40;

/// A row of the table.
pub(super) struct Row<'a> {
    pub(super) path: PathRow,
    pub(super) engine_tick: u64,
    pub(super) device_tick: Option<u32>,
    pub(super) others: &'a [[Option<f64>; 4]],
    pub(super) amplitudes_um: &'a [f32],
}

/// The lines of a recording's table one after the other; a piece of a last one is left out.
pub(super) struct Lines {
    path: PathBuf,
    reader: BufReader<File>,
    n_read: usize,
}

impl Lines {
    pub(super) fn open(folder: &Path) -> Result<Self, FileError> {
        let path = folder.join(TICKS);
        let file = File::open(&path).map_err(FileError::read(&path))?;
        let reader = BufReader::new(file);
        Ok(Self {
            path,
            reader,
            n_read: 0,
        })
    }

    /// The next line without its end; `None` after the last.
    pub(super) fn next(&mut self) -> Result<Option<String>, FileError> {
        let mut line = String::new();
        let mut bounded = (&mut self.reader).take(LONGEST_LINE);
        let n_bytes = bounded.read_line(&mut line);
        let n_bytes = n_bytes.map_err(FileError::read(&self.path))?;
        self.n_read += 1;
        if line.ends_with('\n') {
            line.pop();
            return Ok(Some(line));
        }
        if n_bytes as u64 == LONGEST_LINE {
            return Err(self.wrong("this line is too long"));
        }
        Ok(None)
    }

    /// What is wrong with the line that was read last.
    fn wrong(&self, what: &str) -> FileError {
        let mend = "delete the recording, or restore the file";
        FileError::content(&self.path, self.n_read, what, mend)
    }
}

/// Reads the rows of a recording one after the other.
pub(super) fn read_rows(folder: &Path, mut take: impl FnMut(Row<'_>)) -> Result<(), FileError> {
    let mut lines = Lines::open(folder)?;
    let (mut amplitudes_um, mut n_columns, mut others) = (Vec::new(), 0, Vec::new());
    for nth in 0..=MOST_TICKS {
        let Some(line) = lines.next()? else {
            return Ok(());
        };
        let cells = line.as_str();
        let wrong = |what: &str| lines.wrong(what);
        if nth == 0 {
            n_columns = cells.split(',').count();
            if !cells.starts_with(&COLUMNS.join(",")) || n_columns % 2 == 1 {
                return Err(wrong("this is no header of a recording"));
            }
            let more = cells.split(',').skip(COLUMNS.len());
            let n_others = more.filter(|column| column.starts_with("x_mm_")).count();
            others.resize(n_others, [None; 4]);
            continue;
        }
        amplitudes_um.clear();
        let row = row_of(cells, &mut others, &mut amplitudes_um);
        let (path_row, engine_tick, device_tick) =
            row.ok_or_else(|| wrong("this is no row of a recording"))?;
        if COLUMNS.len() + 4 * others.len() + amplitudes_um.len() != n_columns {
            return Err(wrong("this row has other columns than the header"));
        }
        take(Row {
            path: path_row,
            engine_tick,
            device_tick,
            others: &others,
            amplitudes_um: &amplitudes_um,
        });
    }
    Ok(())
}

fn row_of(
    line: &str,
    others: &mut [[Option<f64>; 4]],
    amplitudes_um: &mut Vec<f32>,
) -> Option<(PathRow, u64, Option<u32>)> {
    let mut cells = line.split(',');
    let t_s = cells.next()?.parse().ok()?;
    let engine_tick = cells.next()?.parse().ok()?;
    let mut number = || cells.next()?.parse::<f64>().ok();
    let [x_mm, y_mm, angle_deg, vx, vy] = [number()?, number()?, number()?, number()?, number()?];
    let device_tick = match cells.next()? {
        "" => None,
        cell => Some(cell.parse().ok()?),
    };
    for known in others.as_flattened_mut() {
        *known = match cells.next()? {
            "" => None,
            cell => Some(cell.parse().ok()?),
        };
    }
    for cell in cells {
        amplitudes_um.push(cell.parse().ok()?);
    }
    let row = PathRow {
        t_s,
        position: Point::new(x_mm, y_mm),
        angle_deg,
        velocity: Some(Velocity::new(vx, vy)),
    };
    Some((row, engine_tick, device_tick))
}
