//! Profiles from a probe and a tracker that were read over time [Wall & Harwin 1999, 2.1–2.2].
//!
//! Two instruments, two clocks of samples: both are resampled every 0.1 s, heights are looked up
//! against places, and the profile is resampled every 0.5 mm over 50 mm; its line is taken off.
//! Places come in steps of the tracker (half a millimetre in the paper): how coarse the worst is
//! is reported, because no resampling makes up for it.

use std::path::Path;

use crate::error::TextileError;
use crate::surface::Profile;
use selvedge_foundation::files::{FileError, Table};
use selvedge_foundation::numerics::{to_index, without_line};

/// Both instruments are resampled at this interval, s.
const INTERVAL_S: f64 = 0.1;
/// Distance of the profile's samples, mm.
const STEP_MM: f64 = 0.5;
/// Samples of the profile: 50 mm.
const N_SAMPLES: usize = 101;

/// What one instrument read.
#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    /// When, s, rising.
    pub t_s: Vec<f64>,
    /// What.
    pub values: Vec<f64>,
}

/// A profile from readings, and how coarse they were.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedProfile {
    /// 101 heights 0.5 mm apart, µm, without their line.
    pub profile: Profile,
    /// The largest distance between neighbouring places that were read, mm.
    pub worst_step_mm: f64,
    /// Readings at which the tracker stood still or went back.
    pub n_not_rising: usize,
}

impl Readings {
    /// Reads a CSV of `t_s` and one column of values. `path` only names it in errors.
    ///
    /// # Errors
    /// Times that do not rise, with their line.
    pub fn from_csv(text: &str, path: &Path, column: &str) -> Result<Self, TextileError> {
        let table = Table::read(text, path, &["t_s", column], &[])?;
        let t_s = table.required_numbers("t_s")?;
        if let Some(row) = t_s.windows(2).position(|pair| pair[1] <= pair[0]) {
            let line = table.line_of(row + 1);
            let what = format!("t_s is {}, not after {}", t_s[row + 1], t_s[row]);
            return Err(FileError::content(path, line, what, "put the rows in order").into());
        }
        let values = table.required_numbers(column)?;
        Ok(Self { t_s, values })
    }

    /// The value at a time, by straight lines; the end's beyond the ends.
    fn at(&self, t_s: f64) -> f64 {
        let after = self.t_s.partition_point(|&t| t <= t_s);
        let (a, b) = (after.saturating_sub(1), after.min(self.t_s.len() - 1));
        let span = self.t_s[b] - self.t_s[a];
        let share = if span > 0.0 {
            (t_s - self.t_s[a]) / span
        } else {
            0.0
        };
        self.values[a] + (self.values[b] - self.values[a]) * share
    }
}

/// The profile of a probe's heights (µm) at a tracker's places (mm).
///
/// # Errors
/// Readings that overlap in time for less than two intervals or cover less than 50 mm.
pub fn import(probe: &Readings, tracker: &Readings) -> Result<ImportedProfile, TextileError> {
    let wrong = |what: String| TextileError::Model(what);
    let ends = |r: &Readings| Some([*r.t_s.first()?, *r.t_s.last()?]);
    let (Some(p), Some(t)) = (ends(probe), ends(tracker)) else {
        return Err(wrong(
            "no readings; give rows of both instruments".to_owned(),
        ));
    };
    let [from_s, to_s] = [p[0].max(t[0]), p[1].min(t[1])];
    let n = ((to_s - from_s) / INTERVAL_S + 1e-9).floor();
    if !(1.0..=1e7).contains(&n) {
        return Err(wrong(format!(
            "probe and tracker overlap for {:.2} s; give readings of the same stroke",
            (to_s - from_s).max(0.0)
        )));
    }
    let times = (0..=to_index(n)).map(|i| from_s + INTERVAL_S * i as f64);
    let mut pairs: Vec<[f64; 2]> = times.map(|s| [tracker.at(s), probe.at(s)]).collect();
    if pairs[pairs.len() - 1][0] < pairs[0][0] {
        pairs.reverse();
    }
    let n_pairs = pairs.len();
    let places = risen(pairs);
    let reach_mm = places[places.len() - 1][0] - places[0][0];
    let length_mm = STEP_MM * (N_SAMPLES - 1) as f64;
    if reach_mm < length_mm - 1e-6 {
        return Err(wrong(format!(
            "the readings cover {reach_mm:.1} mm; stroke at least {length_mm:.0} mm"
        )));
    }
    let gaps = places.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    let worst_step_mm = gaps.fold(0.0, f64::max);
    let heights: Vec<f64> = (0..N_SAMPLES)
        .map(|i| between(&places, places[0][0] + STEP_MM * i as f64))
        .collect();
    let profile = Profile::new(STEP_MM, without_line(&heights))
        .map_err(TextileError::surface("the readings"))?;
    Ok(ImportedProfile {
        profile,
        worst_step_mm,
        n_not_rising: n_pairs - places.len(),
    })
}

/// Places that rise; heights read while the tracker stood still are averaged, those read while it
/// went back are left out.
fn risen(pairs: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut places: Vec<([f64; 2], f64)> = Vec::new();
    for pair in pairs {
        match places.last_mut() {
            Some((last, n)) if pair[0] <= last[0] => {
                if (last[0] - pair[0]).abs() < 1e-9 {
                    *n += 1.0;
                    last[1] += (pair[1] - last[1]) / *n;
                }
            }
            _ => places.push((pair, 1.0)),
        }
    }
    places.into_iter().map(|(pair, _)| pair).collect()
}

/// The height at a place, by straight lines between `places`.
fn between(places: &[[f64; 2]], x_mm: f64) -> f64 {
    let after = places.partition_point(|place| place[0] <= x_mm);
    let a = places[after.saturating_sub(1)];
    let b = places[after.min(places.len() - 1)];
    let span = b[0] - a[0];
    let share = if span > 0.0 {
        (x_mm - a[0]) / span
    } else {
        0.0
    };
    a[1] + (b[1] - a[1]) * share
}
