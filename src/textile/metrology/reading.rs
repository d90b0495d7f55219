//! From the numbers of a file to heights in µm with steps in mm.

use std::path::Path;

use crate::error::TextileError;
use crate::surface::{HeightMap, MAX_POINTS, SurfaceError};
use crate::unit::LengthUnit;
use selvedge_foundation::files::FileError;
use selvedge_foundation::numerics::Grid;

/// What a file may leave open. What it states is not overridden: a contradiction is refused.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HeightOptions {
    /// The unit of the heights.
    pub height_unit: Option<LengthUnit>,
    /// The unit of places along and across.
    pub length_unit: Option<LengthUnit>,
    /// The distance of points, mm.
    pub step_mm: Option<f64>,
    /// The height of white above black in a picture, µm.
    pub range_um: Option<f64>,
    /// The column of heights in a table: its name, or its number from 1.
    pub column: Option<String>,
    /// Which of several fields of heights, from 1.
    pub layer: Option<usize>,
    /// Whether points that are not even are brought to even steps.
    pub resample: bool,
}

/// What a file says about itself.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct About {
    /// The format.
    pub format: &'static str,
    /// What the data are called.
    pub title: String,
    /// The instrument.
    pub instrument: String,
    /// When it was measured, as the file spells it.
    pub date: String,
    /// What people noted.
    pub comment: String,
}

/// Measured heights.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Heights, µm, rows in the order of rising w, a profile in one row; NaN where missing.
    pub heights_um: Grid<f64>,
    /// Steps along and across, mm.
    pub step_mm: [f64; 2],
    /// What the file says about itself.
    pub about: About,
    /// What is odd about the file, one line each.
    pub warnings: Vec<String>,
    /// The titles of the fields to choose from; none where there is but one.
    pub layers: Vec<String>,
}

impl Measured {
    /// Whether it is a profile, not a map.
    pub fn is_profile(&self) -> bool {
        self.heights_um.height() == 1
    }

    /// Points without a height.
    pub fn n_missing(&self) -> usize {
        let values = self.heights_um.values().iter();
        values.filter(|height| height.is_nan()).count()
    }

    /// The same with every missing point filled, along its row and its column between the nearest
    /// heights, the mean of both (see [`HeightMap::filled`]).
    ///
    /// # Errors
    /// Steps that no surface has.
    pub fn filled(&self) -> Result<Self, SurfaceError> {
        let map = HeightMap::new(self.heights_um.clone(), self.step_mm)?;
        Ok(Self {
            heights_um: map.filled().heights_um().clone(),
            ..self.clone()
        })
    }

    /// Lowest and highest height, µm.
    pub fn range_um(&self) -> [f64; 2] {
        let present = self.present();
        present.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
            [low.min(z), high.max(z)]
        })
    }

    /// Sq (ISO 25178-2) of the points that have a height, µm, without levelling or filtering.
    pub fn sq_um(&self) -> f64 {
        let n = self.present().count() as f64;
        let mean = self.present().sum::<f64>() / n;
        let squares = self.present().map(|z| (z - mean) * (z - mean));
        (squares.sum::<f64>() / n).sqrt()
    }

    fn present(&self) -> impl Iterator<Item = f64> + '_ {
        let values = self.heights_um.values().iter().copied();
        values.filter(|height| !height.is_nan())
    }
}

/// Highest relief that is believed without a word, µm, and at all, mm.
const MAX_RELIEF_UM: f64 = 1e5;
const MAX_SPAN_MM: f64 = 1e6;

/// A unit that a file states.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) enum Stated {
    /// None.
    #[default]
    Nothing,
    /// A length.
    Length(LengthUnit),
    /// A word that is no length.
    Other(String),
}

impl Stated {
    /// What a word states.
    pub(super) fn of(word: &str) -> Self {
        match (word.trim(), LengthUnit::of(word)) {
            ("", _) => Self::Nothing,
            (_, Some(unit)) => Self::Length(unit),
            (word, None) => Self::Other(word.to_owned()),
        }
    }

    /// The length, if it is one.
    pub(super) fn length(&self) -> Option<LengthUnit> {
        match self {
            Self::Length(unit) => Some(*unit),
            _ => None,
        }
    }
}

impl From<Option<LengthUnit>> for Stated {
    fn from(unit: Option<LengthUnit>) -> Self {
        unit.map_or(Self::Nothing, Self::Length)
    }
}

/// What a reader found: numbers as the file has them.
#[derive(Debug)]
pub(super) struct Reading {
    /// Numbers, NaN where missing, rows in the order of rising w.
    pub(super) values: Grid<f64>,
    /// Their unit.
    pub(super) height_unit: Stated,
    /// Steps along and across, if the file states them.
    pub(super) steps: Option<[f64; 2]>,
    /// Their unit.
    pub(super) length_unit: Stated,
    pub(super) about: About,
    pub(super) warnings: Vec<String>,
    pub(super) layers: Vec<String>,
}

impl Reading {
    /// Numbers in rows from the first line of the file on.
    pub(super) fn of_rows(
        n_columns: usize,
        values: Vec<f64>,
        format: &'static str,
        path: &Path,
    ) -> Result<Self, FileError> {
        let values = Grid::from_rows(n_columns, values)
            .filter(|grid| grid.height() > 0)
            .ok_or_else(|| {
                FileError::whole(path, "no whole row of points", "get an intact copy")
            })?;
        Ok(Self {
            values,
            height_unit: Stated::Nothing,
            steps: None,
            length_unit: Stated::Nothing,
            about: About {
                format,
                ..About::default()
            },
            warnings: Vec::new(),
            layers: Vec::new(),
        })
    }

    /// The same with the first row of the file as the last: files that begin at the top.
    pub(super) fn turned_over(mut self) -> Self {
        self.values = self.values.turned_over();
        self
    }

    /// Heights in µm with steps in mm.
    pub(super) fn finish(
        mut self,
        path: &Path,
        asked: &HeightOptions,
    ) -> Result<Measured, TextileError> {
        let mend = "give height_unit (--height-unit): m, mm, um or nm";
        let unit = self.height_unit.clone();
        let unit = self.decide(("heights", mend), &unit, asked.height_unit, path)?;
        let step_mm = self.step_mm(path, asked)?;
        for value in self.values.values_mut() {
            let um = *value * unit.um();
            *value = if um.is_finite() { um } else { f64::NAN };
        }
        if self.values.values().iter().all(|value| value.is_nan()) {
            return Err(TextileError::surface(path)(SurfaceError::AllMissing));
        }
        let mut measured = Measured {
            heights_um: self.values,
            step_mm,
            about: self.about,
            warnings: self.warnings,
            layers: if self.layers.len() > 1 {
                self.layers
            } else {
                Vec::new()
            },
        };
        let [low, high] = measured.range_um();
        let span_mm = (high - low) * 1e-3;
        if span_mm > MAX_SPAN_MM {
            let what = format!("heights span {span_mm:?} mm, more than a kilometre");
            return Err(FileError::whole(path, what, "state their unit").into());
        }
        if high - low > MAX_RELIEF_UM {
            let line = format!("heights span {span_mm:.0} mm: their unit may be another");
            measured.warnings.push(line);
        }
        Ok(measured)
    }

    /// The unit to use: the one stated, else the one asked for. A word that is no length gives way,
    /// with a warning.
    fn decide(
        &mut self,
        (of, mend): (&str, &str),
        stated: &Stated,
        asked: Option<LengthUnit>,
        path: &Path,
    ) -> Result<LengthUnit, FileError> {
        let what = match (stated, asked) {
            (Stated::Length(stated), Some(asked)) if *stated != asked => {
                let (said, asked) = (stated.word(), asked.word());
                let what = format!("the file states the {of} in {said}, {asked} was asked for");
                let option = mend.split_once(": ").map_or(mend, |(option, _)| option);
                let mend = format!("{option} only where the file states none");
                return Err(FileError::whole(path, what, mend));
            }
            (Stated::Length(stated), _) => return Ok(*stated),
            (Stated::Nothing, Some(asked)) => return Ok(asked),
            (Stated::Other(said), Some(asked)) => {
                let word = asked.word();
                let line = format!("the file states {of} in {said}; they are taken in {word}");
                self.warnings.push(line);
                return Ok(asked);
            }
            (Stated::Other(word), None) => format!("the unit of the {of} is \"{word}\", no length"),
            (Stated::Nothing, None) => format!("the unit of the {of} is not stated"),
        };
        Err(FileError::whole(path, what, mend))
    }

    /// The even step of places along an axis, 0 along rows and 1 across them; where `may_resample`
    /// the heights are brought to even steps if they are not, with a warning.
    pub(super) fn even_step(
        &mut self,
        (places, axis): (&[f64], usize),
        slack: f64,
        may_resample: bool,
    ) -> Result<f64, String> {
        let what = match even_step(places, slack) {
            Err(what) if may_resample => what,
            step => return step,
        };
        self.values = match axis {
            0 => resampled(&self.values, places),
            _ => resampled(&self.values.transposed(), places).transposed(),
        };
        self.warnings.push(format!("brought to even steps: {what}"));
        let n = places.len();
        Ok((places[n - 1] - places[0]) / (n - 1) as f64)
    }

    fn step_mm(&mut self, path: &Path, asked: &HeightOptions) -> Result<[f64; 2], FileError> {
        let mend = "give step_mm (--step-mm), the distance of points in mm";
        let wrong = |what: String| FileError::whole(path, what, mend);
        let stated = self
            .steps
            .zip(self.length_unit.length().or(asked.length_unit));
        let stated = stated.map(|(steps, unit)| steps.map(|step| step * unit.um() / 1000.0));
        let steps_mm = match (asked.step_mm, self.steps) {
            (Some(step_mm), _) => {
                let is_other = |stated: &f64| (stated / step_mm - 1.0).abs() > SAME_STEP;
                if let Some(stated) = stated.iter().flatten().find(|stated| is_other(stated)) {
                    let what = format!("the points lie {stated} mm apart, not {step_mm} mm");
                    let mend = "leave step_mm (--step-mm) out, or correct the file";
                    return Err(FileError::whole(path, what, mend));
                }
                stated.unwrap_or([step_mm; 2])
            }
            (None, Some(steps)) => {
                let mend = "give length_unit (--length-unit) or step_mm (--step-mm)";
                let unit = self.length_unit.clone();
                let unit = self.decide(("places", mend), &unit, asked.length_unit, path)?;
                steps.map(|step| step * unit.um() / 1000.0)
            }
            (None, None) => return Err(wrong("the distance of points is not stated".to_owned())),
        };
        let is_step = |step: &f64| step.is_finite() && *step > 0.0;
        match steps_mm.iter().find(|step| !is_step(step)) {
            Some(step_mm) => Err(wrong(format!("the step is {step_mm} mm"))),
            None => Ok(steps_mm),
        }
    }
}

/// Steps that differ by at most this share are one.
const SAME_STEP: f64 = 0.01;

/// Heights at uneven places, brought to as many even ones between the first and the last, along
/// each row by straight lines; missing where one of both neighbours is. Places rise or fall.
fn resampled(values: &Grid<f64>, places: &[f64]) -> Grid<f64> {
    let n = places.len();
    let (first, last) = (places[0], places[n - 1]);
    let sign = (last - first).signum();
    let mut even = values.clone();
    let mut before = 0;
    for column in 0..n {
        let at = first + (last - first) * column as f64 / (n - 1) as f64;
        while before + 2 < n && sign * places[before + 1] <= sign * at {
            before += 1;
        }
        let (from, to) = (places[before], places[before + 1]);
        let share = if (to - from).abs() > 0.0 {
            ((at - from) / (to - from)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        for row in 0..values.height() {
            let (a, b) = (values.row(row)[before], values.row(row)[before + 1]);
            even.row_mut(row)[column] = match share {
                0.0 => a,
                1.0 => b,
                _ => a + share * (b - a),
            };
        }
    }
    even
}

/// The even step of places in order; `slack` is how far a place may stand beside its even one
/// because of rounding. Falling places have a step below 0.
///
/// # Errors
/// Places that are not even (within 1 % of the step), or fewer than two, as a line.
pub(super) fn even_step(places: &[f64], slack: f64) -> Result<f64, String> {
    let (&[first, .., last], n) = (places, places.len()) else {
        return Err("fewer than two points".to_owned());
    };
    let step = (last - first) / (n - 1) as f64;
    let is_even = |i: usize, pair: &[f64]| {
        let along = first + step * (i + 1) as f64;
        let is_near = (pair[1] - along).abs() <= slack;
        is_near || (pair[1] - pair[0] - step).abs() <= 0.01 * step.abs()
    };
    let uneven = places
        .windows(2)
        .enumerate()
        .find(|(i, pair)| !is_even(*i, pair));
    if let Some((i, pair)) = uneven {
        let to = pair[1] - pair[0];
        return Err(format!(
            "point {} of {n}: the step is {to} where the mean step is {step}",
            i + 2
        ));
    }
    if step.abs() > 0.0 && step.is_finite() {
        Ok(step)
    } else {
        Err(format!("the step is {step}"))
    }
}

/// What to do about places that are not even.
pub(super) const UNEVEN_MEND: &str = "give resample (--resample) for even steps (within 1 %)";

/// The number of points of a grid, checked against [`MAX_POINTS`].
pub(super) fn n_points(n_columns: usize, n_rows: usize, path: &Path) -> Result<usize, FileError> {
    let n = n_columns.checked_mul(n_rows);
    n.filter(|n| (1..=MAX_POINTS).contains(n)).ok_or_else(|| {
        let what = format!("{n_columns} × {n_rows} points where 1 to {MAX_POINTS} are read");
        FileError::whole(path, what, "the header lies, or cut out what you need")
    })
}
