//! What the files hold: strokes in the order of travel, each with its place on the textile.

use std::collections::BTreeSet;
use std::path::Path;

use super::marks::{Mark, marks_of};
use super::section::covered_mm;
use super::strokes::{RawStroke, Reader, name_of};
use super::{KesAsk, KesOptions, ReturnOrder, StrokeSide, TextileAxis, asks, returns};
use crate::error::TextileError;
use crate::surface::{Direction, SurfaceError, WINDOW_LENGTH_MM};
use selvedge_foundation::files::{FileError, sha256_hex};
use selvedge_foundation::numerics::to_index;

/// Heights that span more than this are in another unit than they say, µm.
const MAX_SPAN_UM: f64 = 20_000.0;
/// Heights that span less than this are remarked upon, µm.
const MIN_SPAN_UM: f64 = 0.1;

/// A file of the tester.
#[derive(Debug, Clone, Copy)]
pub struct KesFile<'a> {
    /// What it is called, in errors and in the textile's manifest.
    pub path: &'a Path,
    /// Its content.
    pub bytes: &'a [u8],
}

/// A stroke of heights.
#[derive(Debug, Clone, PartialEq)]
pub struct KesStroke {
    /// Where it runs.
    pub direction: Direction,
    /// The distance between samples, mm.
    pub step_mm: f64,
    /// The place of the first sample along the forward axis, mm.
    pub start_mm: f64,
    /// Heights without tilt, µm, in the order of travel.
    pub heights_um: Vec<f64>,
    /// The tilt that was taken off, µm for every mm of travel.
    pub tilt_um_per_mm: f64,
    /// What does not look like the rest of it.
    pub marks: Vec<Mark>,
}

/// A trace of friction.
#[derive(Debug, Clone, PartialEq)]
pub struct KesFriction {
    /// The distance between samples, mm.
    pub step_mm: f64,
    /// The place of the first sample along the forward axis, mm.
    pub start_mm: f64,
    /// Coefficients, in the order of travel.
    pub mu: Vec<f64>,
}

/// What files of the tester hold.
#[derive(Debug, Clone, PartialEq)]
pub struct KesReading {
    /// The strokes, by [`Direction::index`] in rising order.
    pub strokes: Vec<KesStroke>,
    /// The friction along the warp.
    pub friction: Option<KesFriction>,
    /// What was decided on the way, one line each.
    pub notes: Vec<String>,
    /// Every file's name and SHA-256.
    pub files: Vec<[String; 2]>,
    /// What one volt stands for, µm, where heights were in volts.
    pub um_per_volt: Option<f64>,
    /// Units that are assumed because nothing states them: `heights in µm`.
    pub assumed: Vec<String>,
}

impl KesStroke {
    /// The place of a sample along the forward axis, mm.
    pub fn place_mm(&self, index: usize) -> f64 {
        let travelled_mm = index as f64 * self.step_mm;
        if self.direction.is_reverse() {
            self.start_mm - travelled_mm
        } else {
            self.start_mm + travelled_mm
        }
    }

    /// The lowest and the highest place, mm.
    pub fn range_mm(&self) -> [f64; 2] {
        let last = self.place_mm(self.heights_um.len().saturating_sub(1));
        [self.start_mm.min(last), self.start_mm.max(last)]
    }
}

impl KesReading {
    /// Reads the files of a textile; `friction` may be a file of its own.
    ///
    /// # Errors
    /// What is no table of strokes, and what must be said because no file says it.
    pub fn of(
        files: &[KesFile<'_>],
        friction: Option<KesFile<'_>>,
        options: &KesOptions,
    ) -> Result<Self, TextileError> {
        let given_friction = friction;
        let (mut notes, mut assumed) = (Vec::new(), BTreeSet::new());
        let mut raw: Vec<(&Path, RawStroke)> = Vec::new();
        for (nth, (file, is_friction)) in files
            .iter()
            .map(|file| (file, false))
            .chain(friction.iter().map(|file| (file, true)))
            .enumerate()
        {
            let mut reader = Reader {
                path: file.path,
                options,
                nth,
                n_files: files.len(),
                is_friction,
                notes: &mut notes,
                assumed: &mut assumed,
            };
            let strokes = reader.strokes(file.bytes)?;
            raw.extend(strokes.into_iter().map(|stroke| (file.path, stroke)));
        }
        let (friction, heights): (Vec<_>, Vec<_>) =
            raw.into_iter().partition(|(_, stroke)| stroke.is_friction);
        let friction = friction
            .into_iter()
            .map(|(_, stroke)| stroke)
            .find(|stroke| stroke.side == StrokeSide::Forward);
        let mut strokes = assembled(heights, options, &mut notes)?;
        strokes.sort_by_key(|stroke| stroke.direction.index());
        let files = files.iter().chain(&given_friction).map(hashed).collect();
        Ok(Self {
            strokes,
            friction: friction.map(|stroke| KesFriction {
                step_mm: stroke.step_mm,
                start_mm: stroke.ends_mm[0],
                mu: stroke.values,
            }),
            notes,
            files,
            um_per_volt: options.um_per_volt,
            assumed: assumed.into_iter().collect(),
        })
    }

    /// What all strokes of an axis cover, mm; `None` where none runs along it.
    pub fn covered_mm(&self, axis: TextileAxis) -> Option<[f64; 2]> {
        let along = self.strokes.iter().filter(|stroke| stroke.axis() == axis);
        covered_mm(&along.collect::<Vec<_>>())
    }

    /// The stroke of a direction.
    pub fn stroke(&self, direction: Direction) -> Option<&KesStroke> {
        self.strokes
            .iter()
            .find(|stroke| stroke.direction == direction)
    }
}

fn hashed(file: &KesFile<'_>) -> [String; 2] {
    [name_of(file.path), sha256_hex([file.bytes])]
}

/// Strokes in the order of travel, without tilt, at their places.
fn assembled(
    raw: Vec<(&Path, RawStroke)>,
    options: &KesOptions,
    notes: &mut Vec<String>,
) -> Result<Vec<KesStroke>, TextileError> {
    check_once(&raw)?;
    let mut strokes: Vec<KesStroke> = Vec::new();
    let (forward, back): (Vec<_>, Vec<_>) = raw
        .into_iter()
        .partition(|(_, stroke)| stroke.side == StrokeSide::Forward);
    for (path, stroke) in forward.into_iter().chain(back) {
        let direction = direction_of(stroke.axis, stroke.side);
        check_length(&stroke, path)?;
        let opposite = direction_of(stroke.axis, StrokeSide::Forward);
        let forward = strokes.iter().find(|other| other.direction == opposite);
        let mut heights_um = stroke.values.clone();
        let mut tilt_um_per_mm = remove_tilt(&mut heights_um, &[], stroke.step_mm);
        // What is marked does not look like the textile: it has no say in how the textile lies.
        let marks = marks_of(&heights_um, stroke.step_mm, direction);
        tilt_um_per_mm += remove_tilt(&mut heights_um, &marks, stroke.step_mm);
        check_span(&heights_um, (path, stroke.line), notes)?;
        let order = order_of((&stroke, &heights_um), forward, (path, options), notes)?;
        let start_mm = match (order, forward) {
            _ if stroke.is_travel => stroke.ends_mm[0],
            (ReturnOrder::Travel, Some(forward)) => forward.range_mm()[1],
            _ => stroke.ends_mm[1],
        };
        if order == ReturnOrder::Mirrored {
            heights_um.reverse();
            tilt_um_per_mm = -tilt_um_per_mm;
        }
        let mut stroke = KesStroke {
            direction,
            step_mm: stroke.step_mm,
            start_mm,
            heights_um,
            tilt_um_per_mm,
            marks: Vec::new(),
        };
        stroke.marks = marks_of(&stroke.heights_um, stroke.step_mm, direction);
        strokes.push(stroke);
    }
    Ok(strokes)
}

/// The direction of a stroke.
fn direction_of(axis: TextileAxis, side: StrokeSide) -> Direction {
    Direction::BY_AXIS[axis as usize][side as usize]
}

fn check_once(raw: &[(&Path, RawStroke)]) -> Result<(), TextileError> {
    let place = |stroke: &RawStroke| (stroke.axis, stroke.side);
    for (index, (path, stroke)) in raw.iter().enumerate() {
        let earlier = raw[..index]
            .iter()
            .find(|(_, other)| place(other) == place(stroke));
        if let Some((other, _)) = earlier {
            let label = direction_of(stroke.axis, stroke.side).label();
            let what = format!("a second stroke {label}, after that of {}", other.display());
            return Err(asks(path, stroke.line, what, KesAsk::Direction));
        }
    }
    if raw
        .iter()
        .any(|(_, stroke)| stroke.axis == TextileAxis::Warp)
    {
        return Ok(());
    }
    let (path, line) = raw
        .first()
        .map_or_else(|| (Path::new("-"), 1), |(path, raw)| (*path, raw.line));
    let what = "no stroke along the warp, which a textile needs";
    Err(asks(path, line, what, KesAsk::Direction))
}

fn check_length(stroke: &RawStroke, path: &Path) -> Result<(), TextileError> {
    let (n_samples, window) = (stroke.values.len(), WINDOW_LENGTH_MM / stroke.step_mm);
    if n_samples as f64 + 0.5 >= window {
        return Ok(());
    }
    Err(TextileError::surface(path)(SurfaceError::TooShort {
        n_samples,
        n_window: to_index(window.round()),
    }))
}

fn check_span(
    heights_um: &[f64],
    (path, line): (&Path, usize),
    notes: &mut Vec<String>,
) -> Result<(), TextileError> {
    let max = heights_um.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let min = heights_um.iter().copied().fold(f64::INFINITY, f64::min);
    let span_um = max - min;
    if !span_um.is_finite() {
        let mend = "give heights that a cloth can have";
        return Err(FileError::content(path, line, "heights beyond all numbers", mend).into());
    }
    if span_um > MAX_SPAN_UM {
        let what = format!("heights span {span_um:.0} µm, more than any cloth");
        return Err(asks(path, line, what, KesAsk::HeightUnit));
    }
    if span_um < MIN_SPAN_UM {
        notes.push(format!(
            "{}: heights span {span_um:.4} µm only; if they are in mm or volts, say so",
            name_of(path)
        ));
    }
    Ok(())
}

/// The order of a stroke's rows; for a way back whose places rise the textile tells.
fn order_of(
    (stroke, heights_um): (&RawStroke, &[f64]),
    forward: Option<&KesStroke>,
    (path, options): (&Path, &KesOptions),
    notes: &mut Vec<String>,
) -> Result<ReturnOrder, TextileError> {
    if stroke.is_travel {
        return Ok(ReturnOrder::Travel);
    }
    let label = direction_of(stroke.axis, stroke.side).label();
    if let Some(order) = options.return_order {
        return Ok(order);
    }
    let Some(forward) = forward else {
        notes.push(format!("{label}: taken as rows in the order of measuring"));
        return Ok(ReturnOrder::Travel);
    };
    let is_alike = (stroke.step_mm / forward.step_mm - 1.0).abs() < 1e-3;
    let found = is_alike
        .then(|| returns::order_of(&forward.heights_um, heights_um, stroke.step_mm))
        .flatten();
    let Some(order) = found else {
        let what = format!("{label}: the cloth does not tell how its rows are ordered");
        return Err(asks(path, stroke.line, what, KesAsk::ReturnOrder));
    };
    notes.push(match order {
        ReturnOrder::Travel => format!("{label}: rows in the order of measuring, by the cloth"),
        ReturnOrder::Mirrored => {
            format!("{label}: rows by their places, turned round, by the cloth")
        }
    });
    Ok(order)
}

/// Takes a straight line off the whole stroke and returns its slope a mm: that of least squares
/// through the samples that are not marked, if these are most of them.
pub(super) fn remove_tilt(heights_um: &mut [f64], marks: &[Mark], step_mm: f64) -> f64 {
    let mut is_used = vec![true; heights_um.len()];
    for mark in marks {
        is_used[mark.samples.clone()].fill(false);
    }
    let n_used = is_used.iter().filter(|used| **used).count();
    if 2 * n_used < heights_um.len() {
        return 0.0;
    }
    let used = || {
        let all = heights_um.iter().enumerate().zip(&is_used);
        all.filter(|(_, used)| **used)
            .map(|((index, height), _)| (index as f64, *height))
    };
    let n = n_used as f64;
    let (middle, mean) = used().fold((0.0, 0.0), |(x, z), (index, height)| {
        (x + index / n, z + height / n)
    });
    let (along, squares) = used().fold((0.0, 0.0), |(along, squares), (index, height)| {
        let off = index - middle;
        (along + off * (height - mean), squares + off * off)
    });
    let slope = if squares > 0.0 { along / squares } else { 0.0 };
    for (index, height) in heights_um.iter_mut().enumerate() {
        *height -= mean + slope * (index as f64 - middle);
    }
    slope / step_mm
}
