//! Strokes as a file holds them: which columns, which rows, which units.

use std::collections::BTreeSet;
use std::path::Path;

use super::columns::{Column, axis_of, columns_of, side_of, tokens};
use super::places::{Run, Uneven, run_of, step_of};
use super::text::text_of;
use super::{ColumnRole, KesAsk, KesOptions, KesPlace, StrokeSide, TextileAxis, asks};
use crate::error::TextileError;
use crate::number_table::{NoTable, RawTable, table_of};
use selvedge_foundation::files::FileError;

/// Longer strokes than this are in another unit than they say, mm.
const LONGEST_MM: f64 = 300.0;

/// A stroke in the order of its rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawStroke {
    pub(super) axis: TextileAxis,
    pub(super) side: StrokeSide,
    /// Friction, not heights.
    pub(super) is_friction: bool,
    /// Whether its rows are known to follow one another as they were measured.
    pub(super) is_travel: bool,
    pub(super) step_mm: f64,
    /// The places of the first and the last row, mm.
    pub(super) ends_mm: [f64; 2],
    /// Heights in µm, or coefficients.
    pub(super) values: Vec<f64>,
    /// The line of the first row.
    pub(super) line: usize,
}

/// A file while it is read.
pub(super) struct Reader<'a> {
    pub(super) path: &'a Path,
    pub(super) options: &'a KesOptions,
    /// Its place among the files.
    pub(super) nth: usize,
    pub(super) n_files: usize,
    /// Whether it was given as a file of friction.
    pub(super) is_friction: bool,
    pub(super) notes: &'a mut Vec<String>,
    /// Units that neither a file nor anybody states.
    pub(super) assumed: &'a mut BTreeSet<String>,
}

/// Some rows of a table with their places.
struct Rows {
    range: std::ops::Range<usize>,
    step_mm: f64,
    ends_mm: [f64; 2],
    /// Whether places fall: a way back as it was measured.
    is_back: bool,
}

impl Reader<'_> {
    /// The strokes of a file.
    pub(super) fn strokes(&mut self, bytes: &[u8]) -> Result<Vec<RawStroke>, TextileError> {
        let text = text_of(bytes, self.path)?;
        let table = table_of(&text, self.options.decimal).map_err(|none| self.no_table(none))?;
        let said = self
            .options
            .columns
            .as_deref()
            .filter(|_| !self.is_friction);
        let columns = columns_of(&table, said)
            .map_err(|what| asks(self.path, table.lines[0], what, KesAsk::Columns))?;
        let parts = self.parts(&table, &columns)?;
        self.assume(&columns);
        let measured: Vec<(usize, Column)> = columns
            .into_iter()
            .enumerate()
            .filter(|(_, column)| {
                matches!(
                    column.role,
                    ColumnRole::Height(..) | ColumnRole::Friction(_)
                )
            })
            .collect();
        if measured.is_empty() {
            let what = "no column of heights";
            return Err(asks(self.path, table.lines[0], what, KesAsk::Columns));
        }
        let mut strokes = Vec::new();
        for (index, column) in &measured {
            for rows in &parts {
                let is_split = parts.len() > 1;
                let alone = measured.len() == 1;
                let place = self.place(*column, rows, (alone, is_split), table.lines[0])?;
                strokes.push(self.stroke(&table, (*index, *column), rows, place)?);
            }
        }
        Ok(strokes)
    }

    /// Notes which units are the usual ones because none is stated.
    fn assume(&mut self, columns: &[Column]) {
        let options = self.options;
        let lacks = |is_of: fn(ColumnRole) -> bool| {
            let mut of = columns.iter().filter(|column| is_of(column.role));
            of.any(|column| column.unit.is_none())
        };
        let is_place_said = options.x_unit.is_some() || options.step_mm.is_some();
        if !is_place_said && lacks(|role| role == ColumnRole::Distance) {
            self.assumed.insert("places in mm".to_owned());
        }
        let is_height_said = options.height_unit.is_some() || options.um_per_volt.is_some();
        if !is_height_said && lacks(|role| matches!(role, ColumnRole::Height(..))) {
            self.assumed.insert("heights in µm".to_owned());
        }
    }

    fn no_table(&self, none: NoTable) -> TextileError {
        match none {
            NoTable::NoNumbers { .. } => FileError::content(
                self.path,
                1,
                "no table of numbers",
                "give rows of numbers with tabs, commas, semicolons or blanks between",
            )
            .into(),
            NoTable::Broken { line, text, .. } => FileError::content(
                self.path,
                line,
                format!("\"{text}\" is no row of the table of numbers"),
                "fill or cut missing points; give every row as many finite numbers",
            )
            .into(),
            NoTable::Ambiguous { line } => {
                let what = "two columns of whole numbers, or one with a decimal comma";
                asks(self.path, line, what, KesAsk::Decimal)
            }
            NoTable::TooLong => {
                let [what, mend] = NoTable::TOO_LONG;
                FileError::whole(self.path, what, mend).into()
            }
        }
    }

    /// The rows of one way each, with their places.
    fn parts(&mut self, table: &RawTable, columns: &[Column]) -> Result<Vec<Rows>, TextileError> {
        let n_rows = table.lines.len();
        let is_place =
            |column: &Column| matches!(column.role, ColumnRole::Distance | ColumnRole::Time);
        let step_mm = self.said_step_mm()?;
        let Some(index) = columns.iter().position(is_place) else {
            let Some(step_mm) = step_mm else {
                let what = "no column of distance";
                return Err(asks(self.path, table.lines[0], what, KesAsk::Step));
            };
            return Ok(vec![even(0..n_rows, step_mm)]);
        };
        let x = &table.columns[index];
        let ranges = match run_of(x) {
            Err(row) => return Err(self.out_of_order(table, x, row)),
            Ok(Run::Rising) => vec![(0..n_rows, false)],
            Ok(Run::Falling) => vec![(0..n_rows, true)],
            Ok(Run::OutAndBack { turn }) => vec![(0..turn + 1, false), (turn + 1..n_rows, true)],
        };
        if let Some(step_mm) = step_mm {
            self.notes.push(format!(
                "{}: places by the step given, {step_mm} mm, not by column {}",
                name_of(self.path),
                index + 1
            ));
            return Ok(ranges
                .into_iter()
                .map(|(range, is_back)| turned(even(range, step_mm), is_back))
                .collect());
        }
        let scale = self.mm_of_places(columns[index], table.lines[0])?;
        let mut parts = Vec::new();
        for (range, is_back) in ranges {
            let quantum = table.quanta[index];
            let (step, is_rounded) = step_of(&x[range.clone()], quantum)
                .map_err(|uneven| self.uneven(table, range.start, uneven, scale))?;
            let step_mm = step * scale;
            self.check_step(
                step_mm,
                range.len(),
                table.lines[range.start],
                KesAsk::XUnit,
            )?;
            if is_rounded {
                self.notes.push(format!(
                    "{}: places are printed to {} mm; taken as even steps of {step_mm:.6} mm",
                    name_of(self.path),
                    rounded(quantum * scale)
                ));
            }
            let ends_mm = [x[range.start] * scale, x[range.end - 1] * scale];
            parts.push(Rows {
                range,
                step_mm,
                ends_mm,
                is_back,
            });
        }
        Ok(parts)
    }

    /// The step that was said, if one was.
    fn said_step_mm(&self) -> Result<Option<f64>, TextileError> {
        let options = self.options;
        let step_mm = match (options.step_mm, options.speed_mm_per_s, options.rate_hz) {
            (Some(step_mm), None, None) => step_mm,
            (None, Some(speed), Some(rate)) => speed / rate,
            (None, _, None) => return Ok(None),
            _ => {
                let what = "a step, or a speed and a rate, not both";
                return Err(asks(self.path, 1, what, KesAsk::Step));
            }
        };
        if !(0.0005..=0.5).contains(&step_mm) {
            let what = format!("the step given is {step_mm} mm, not 0.0005 to 0.5");
            return Err(asks(self.path, 1, what, KesAsk::Step));
        }
        Ok(Some(step_mm))
    }

    fn check_step(
        &self,
        step_mm: f64,
        n_rows: usize,
        line: usize,
        ask: KesAsk,
    ) -> Result<(), TextileError> {
        let length_mm = step_mm * n_rows as f64;
        let wrong = if !(0.0005..=0.5).contains(&step_mm) {
            format!("the step is {} mm, not 0.0005 to 0.5", rounded(step_mm))
        } else if length_mm > LONGEST_MM {
            format!("the stroke is {length_mm:.0} mm long, more than {LONGEST_MM}")
        } else {
            return Ok(());
        };
        Err(asks(self.path, line, wrong, ask))
    }

    fn out_of_order(&self, table: &RawTable, x: &[f64], row: usize) -> TextileError {
        let what = if x.get(row) == row.checked_sub(1).and_then(|before| x.get(before)) {
            format!("x is {} twice", x[row])
        } else {
            format!("x turns back more than once, at {}", x[row])
        };
        let mend = "let x rise, fall, or go out and back; or say --step-mm where x is too coarse";
        FileError::content(self.path, table.lines[row], what, mend).into()
    }

    fn uneven(&self, table: &RawTable, start: usize, off: Uneven, scale: f64) -> TextileError {
        let [step, mean] = [off.step, off.mean].map(|step| rounded(step.abs() * scale));
        let what = format!("x goes on by {step} mm where the mean step is {mean} mm");
        let mend = "resample to even steps (within 1 %), or say --step-mm if x is wrong";
        FileError::content(self.path, table.lines[start + off.row], what, mend).into()
    }

    /// The axis and the side of a stroke.
    fn place(
        &self,
        column: Column,
        rows: &Rows,
        (is_alone, is_split): (bool, bool),
        line: usize,
    ) -> Result<(TextileAxis, StrokeSide), TextileError> {
        let said = self.options.directions.get(self.nth).copied().flatten();
        let said = said.filter(|_| !self.is_friction);
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let name = tokens(&name);
        let (axis, side) = match column.role {
            ColumnRole::Height(axis, side) => (axis, side),
            ColumnRole::Friction(side) => (None, side),
            _ => (None, None),
        };
        let only = (self.n_files == 1 || self.is_friction).then_some(TextileAxis::Warp);
        let axis = axis
            .or_else(|| said.map(|place: KesPlace| place.axis))
            .or_else(|| axis_of(&name))
            .or(only);
        let Some(axis) = axis else {
            let what = "nothing says whether this is along the warp or the weft";
            return Err(asks(self.path, line, what, KesAsk::Direction));
        };
        let said_side = said.and_then(|place| place.side).filter(|_| is_alone);
        let by_run = rows.is_back.then_some(StrokeSide::Return);
        let side = if is_split {
            by_run.unwrap_or(StrokeSide::Forward)
        } else {
            let named = side_of(&name).filter(|_| is_alone);
            said_side
                .or(side)
                .or(by_run)
                .or(named)
                .unwrap_or(StrokeSide::Forward)
        };
        if rows.is_back && side == StrokeSide::Forward {
            let what = "x falls in a forward stroke";
            return Err(asks(self.path, line, what, KesAsk::Direction));
        }
        Ok((axis, side))
    }

    fn stroke(
        &self,
        table: &RawTable,
        (index, column): (usize, Column),
        rows: &Rows,
        (axis, side): (TextileAxis, StrokeSide),
    ) -> Result<RawStroke, TextileError> {
        let is_friction = self.is_friction || matches!(column.role, ColumnRole::Friction(_));
        let line = table.lines[rows.range.start];
        let scale = if is_friction {
            self.check_friction(column, line)?;
            1.0
        } else {
            self.um_of_heights(column, &table.header, line)?
        };
        let values = &table.columns[index][rows.range.clone()];
        Ok(RawStroke {
            axis,
            side,
            is_friction,
            is_travel: rows.is_back || side == StrokeSide::Forward,
            step_mm: rows.step_mm,
            ends_mm: rows.ends_mm,
            values: values.iter().map(|value| value * scale).collect(),
            line,
        })
    }
}

/// What a file is called in notes: where it lies is no part of what it holds.
pub(super) fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// Rows at even places from 0.
fn even(range: std::ops::Range<usize>, step_mm: f64) -> Rows {
    let last_mm = range.len().saturating_sub(1) as f64 * step_mm;
    Rows {
        range,
        step_mm,
        ends_mm: [0.0, last_mm],
        is_back: false,
    }
}

/// The same on the way back.
fn turned(mut rows: Rows, is_back: bool) -> Rows {
    if is_back {
        rows.ends_mm.reverse();
        rows.is_back = true;
    }
    rows
}

/// A length for people: six digits at most.
fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}
