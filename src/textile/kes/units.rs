//! Units: what one of a column is, by what the user says, else by its header.

use super::columns::{Column, tokens};
use super::strokes::Reader;
use super::{ColumnRole, KesAsk, asks};
use crate::error::TextileError;
use crate::unit::Unit;
use selvedge_foundation::files::FileError;

impl Reader<'_> {
    /// What one unit of a column of places is, mm.
    pub(super) fn mm_of_places(&self, column: Column, line: usize) -> Result<f64, TextileError> {
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
        let unit = self.options.x_unit.map(Unit::Length).or(column.unit);
        match unit.map(Unit::length) {
            None => Ok(1.0),
            Some(Some(unit)) => Ok(unit.um() / 1e3),
            Some(None) => {
                let what = "the distance has a unit that is no length";
                Err(asks(self.path, line, what, KesAsk::XUnit))
            }
        }
    }

    pub(super) fn check_friction(&self, column: Column, line: usize) -> Result<(), FileError> {
        let what = match column.unit {
            None => return Ok(()),
            Some(_) => "friction with a unit",
        };
        let mend = "give the coefficient: the force divided by the load (50 gf)";
        Err(FileError::content(self.path, line, what, mend))
    }

    /// What one unit of a column of heights is, µm.
    pub(super) fn um_of_heights(
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
        let is_length = |unit: Option<Unit>| unit.and_then(Unit::length).is_some();
        match (self.options.um_per_volt, self.options.height_unit) {
            (Some(_), stated) if is_length(stated.or(column.unit)) => ask(
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
            (None, None) if header_says_volts => ask("heights in volts", KesAsk::UmPerVolt),
            (None, stated) => match stated.or(column.unit) {
                None => Ok(1.0),
                Some(Unit::Length(unit)) => Ok(unit.um()),
                Some(Unit::Volt | Unit::Millivolt) => ask("heights in volts", KesAsk::UmPerVolt),
                Some(_) => ask("heights with a unit that is no length", KesAsk::HeightUnit),
            },
        }
    }
}
