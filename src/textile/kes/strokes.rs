//! Strokes as a file holds them: which columns, which rows, which units.

use std::path::Path;

use super::columns::{Column, Unit, axis_of, columns_of, side_of, tokens};
use super::dialect::{NoTable, RawTable, table_of};
use super::places::{Run, Uneven, run_of, step_of};
use super::text::text_of;
use super::{
    ClothAxis, ColumnRole, HeightUnit, KesAsk, KesOptions, KesPlace, PlaceUnit, StrokeSide, asks,
};
use crate::files::FileError;
use crate::textile::TextileError;

/// Longer strokes than this are in another unit than they say, mm.
const LONGEST_MM: f64 = 300.0;

/// A stroke in the order of its rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RawStroke {
    pub(super) axis: ClothAxis,
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
        let measured: Vec<(usize, Column)> = columns
            .into_iter()
            .enumerate()
            .filter(|(_, column)| self.is_measured(column.role))
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

    fn is_measured(&self, role: ColumnRole) -> bool {
        match role {
            // In a file of friction an unnamed column is friction.
            ColumnRole::Height(..) => true,
            ColumnRole::Friction(_) => true,
            ColumnRole::Distance | ColumnRole::Time | ColumnRole::Skip => false,
        }
    }

    fn no_table(&self, none: NoTable) -> TextileError {
        match none {
            NoTable::NoNumbers => FileError::content(
                self.path,
                1,
                "no table of numbers",
                "give rows of numbers with tabs, commas, semicolons or blanks between",
            )
            .into(),
            NoTable::Broken { line, text } => FileError::content(
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
                self.path.display(),
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
                    self.path.display(),
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

    /// What one unit of a column of places is, mm.
    fn mm_of_places(&self, column: Column, line: usize) -> Result<f64, TextileError> {
        if column.role == ColumnRole::Time {
            let speed = self.options.speed_mm_per_s.ok_or_else(|| {
                let what = "a column of times, and no speed";
                asks(self.path, line, what, KesAsk::Speed)
            })?;
            if !(speed > 0.0 && speed.is_finite()) {
                let what = format!("the speed is {speed} mm/s");
                return Err(asks(self.path, line, what, KesAsk::Speed));
            }
            return Ok(speed);
        }
        match self.options.x_unit {
            Some(PlaceUnit::Mm) => return Ok(1.0),
            Some(PlaceUnit::Cm) => return Ok(10.0),
            Some(PlaceUnit::Um) => return Ok(1e-3),
            None => {}
        }
        match column.unit {
            None | Some(Unit::Millimetre) => Ok(1.0),
            Some(Unit::Centimetre) => Ok(10.0),
            Some(Unit::Micrometre) => Ok(1e-3),
            Some(Unit::Metre) => Ok(1e3),
            Some(_) => {
                let what = "the distance has a unit that is no length";
                Err(asks(self.path, line, what, KesAsk::XUnit))
            }
        }
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
    ) -> Result<(ClothAxis, StrokeSide), TextileError> {
        let said = self.options.directions.get(self.nth).copied().flatten();
        let said = said.filter(|_| !self.is_friction);
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let name = tokens(&name);
        let (axis, side) = match column.role {
            ColumnRole::Height(axis, side) => (axis, side),
            ColumnRole::Friction(side) => (None, side),
            _ => (None, None),
        };
        let only = (self.n_files == 1 || self.is_friction).then_some(ClothAxis::Warp);
        let axis = axis
            .or(said.map(|place: KesPlace| place.axis))
            .or(axis_of(&name))
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
        (axis, side): (ClothAxis, StrokeSide),
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

    fn check_friction(&self, column: Column, line: usize) -> Result<(), FileError> {
        let what = match column.unit {
            None => return Ok(()),
            Some(_) => "friction with a unit",
        };
        let mend = "give the coefficient: the force divided by the load (50 gf)";
        Err(FileError::content(self.path, line, what, mend))
    }

    /// What one unit of a column of heights is, µm.
    fn um_of_heights(
        &self,
        column: Column,
        header: &[String],
        line: usize,
    ) -> Result<f64, TextileError> {
        let ask = |what: &str, ask| Err(asks(self.path, line, what, ask));
        let volts = ["v", "mv", "volt", "volts"];
        let in_volts = |word: &String| volts.contains(&word.as_str());
        let header_says_volts =
            column.unit.is_none() && header.iter().any(|line| tokens(line).iter().any(in_volts));
        let is_length = matches!(
            column.unit,
            Some(Unit::Metre | Unit::Centimetre | Unit::Millimetre | Unit::Micrometre)
        );
        match (self.options.um_per_volt, self.options.height_unit) {
            (Some(_), Some(HeightUnit::Um | HeightUnit::Mm)) => ask(
                "a sensitivity, and heights that are no volts",
                KesAsk::HeightUnit,
            ),
            (Some(_), None) if is_length => ask(
                "a sensitivity, and heights that are no volts",
                KesAsk::HeightUnit,
            ),
            (Some(um_per_volt), _) if !um_per_volt.is_finite() || um_per_volt.abs() < 1e-12 => ask(
                "the sensitivity is no number other than 0",
                KesAsk::UmPerVolt,
            ),
            (Some(um_per_volt), _) if column.unit == Some(Unit::Millivolt) => {
                Ok(um_per_volt * 1e-3)
            }
            (Some(um_per_volt), _) => Ok(um_per_volt),
            (None, Some(HeightUnit::Um)) => Ok(1.0),
            (None, Some(HeightUnit::Mm)) => Ok(1e3),
            (None, Some(HeightUnit::Volt)) => ask("heights in volts", KesAsk::UmPerVolt),
            (None, None) if header_says_volts => ask("heights in volts", KesAsk::UmPerVolt),
            (None, None) => match column.unit {
                None | Some(Unit::Micrometre) => Ok(1.0),
                Some(Unit::Millimetre) => Ok(1e3),
                Some(Unit::Centimetre) => Ok(1e4),
                Some(Unit::Metre) => Ok(1e6),
                Some(Unit::Volt | Unit::Millivolt) => ask("heights in volts", KesAsk::UmPerVolt),
                Some(_) => ask("heights with a unit that is no length", KesAsk::HeightUnit),
            },
        }
    }
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
