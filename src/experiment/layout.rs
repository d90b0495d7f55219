//! What a trial presents on the array: what lies where under which number, what the experimenter
//! lays on the table, and which vibrations are played.
//!
//! Pure: a function of the design and the trial. Labels are numbers of places, never of stimuli.

use super::design::{Design, Source, Standard, TunedParameter};
use super::trial::Task;
use selvedge_engine::{TICKS_PER_S, VibrationStep};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_render::scene::{Display, PlacedTextile, Scene};
use selvedge_textile::tactile::{Band, Tuning};

/// Side of a stimulus, mm (Philpott & Summers 2012).
const SIDE_MM: f64 = 100.0;
/// Between the edge of the workspace and what lies in it, mm.
const MARGIN_MM: f64 = 10.0;
/// Between two stimuli without one in the middle, mm.
const GAP_MM: f64 = 20.0;
/// Between two intervals, ms.
const PAUSE_MS: u32 = 300;
/// A vibration that is felt alone, ms.
const ALONE_MS: u32 = 1000;

/// Where the stimuli of a trial lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Width and height of the workspace, mm.
    pub size_mm: [f64; 2],
    /// The stimuli, the target last.
    pub places: Vec<Place>,
}

/// One stimulus in the workspace.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// The design's number of it.
    pub stimulus: usize,
    /// Its lower left corner, mm.
    pub origin_mm: Point,
    /// Its position from 1; `None` for a target and for one that lies alone.
    pub number: Option<usize>,
}

impl Layout {
    /// Where the stimuli of a task lie. Four lie at the corners, a virtual target in the middle of
    /// them; others side by side.
    pub fn of(design: &Design, task: &Task) -> Self {
        match task {
            Task::Rank {
                target,
                alternatives,
            } => {
                let is_virtual = design.method.standard() == Some(Standard::Virtual);
                four(alternatives, is_virtual.then_some(*target))
            }
            Task::OddOne { items, .. } => in_a_row(items),
            Task::JudgePair { items, .. } => in_a_row(items),
            Task::Adjust { item, .. }
            | Task::Judge { item, .. }
            | Task::Estimate { item }
            | Task::Rate { item } => in_a_row(&[*item]),
            Task::Interval { .. } => Self::empty(),
        }
    }

    /// A workspace in which nothing lies.
    pub fn empty() -> Self {
        let places = Vec::new();
        Self {
            places,
            ..in_a_row(&[0])
        }
    }

    /// One stimulus with room for a guided movement.
    pub fn to_practise(stimulus: usize) -> Self {
        let side_mm = SIDE_MM + 2.0 * MARGIN_MM;
        Self {
            size_mm: [side_mm; 2],
            ..in_a_row(&[stimulus])
        }
    }

    /// The scene of what lies here: textiles alone, each in its full size.
    pub fn scene(&self, design: &Design, display: &Display, tuning: Tuning) -> Scene {
        let placed = self.places.iter().filter_map(|place| {
            let stimulus = design.stimuli.get(place.stimulus)?;
            let Source::Textile { id, gain_db } = &stimulus.source else {
                return None;
            };
            Some(PlacedTextile {
                id: id.clone(),
                origin_mm: place.origin_mm,
                size_mm: [SIDE_MM; 2],
                rotation_deg: 0.0,
                gain_db: *gain_db,
                label: place.number.map_or_else(String::new, |n| n.to_string()),
            })
        });
        Scene {
            name: "Trial".to_owned(),
            library: design.library.clone(),
            size_mm: self.size_mm,
            textiles: placed.collect(),
            displays: vec![display.clone()],
            tuning: Some(tuning),
            ..Scene::default()
        }
    }
}

impl Place {
    /// Its extent, mm.
    pub const SIZE_MM: [f64; 2] = [SIDE_MM; 2];
}

/// Positions 1 and 2 above, 3 and 4 below; a target in the middle takes as much room as a gap.
fn four(alternatives: &[usize], target: Option<usize>) -> Layout {
    let gap_mm = if target.is_some() {
        SIDE_MM + 2.0 * MARGIN_MM
    } else {
        GAP_MM
    };
    let far_mm = MARGIN_MM + SIDE_MM + gap_mm;
    let corners = [
        [MARGIN_MM, far_mm],
        [far_mm, far_mm],
        [MARGIN_MM; 2],
        [far_mm, MARGIN_MM],
    ];
    let mut places: Vec<Place> = (alternatives.iter().zip(corners).enumerate())
        .map(|(at, (stimulus, [x_mm, y_mm]))| Place {
            stimulus: *stimulus,
            origin_mm: Point::new(x_mm, y_mm),
            number: Some(at + 1),
        })
        .collect();
    let side_mm = far_mm + SIDE_MM + MARGIN_MM;
    let middle_mm = 0.5 * (side_mm - SIDE_MM);
    places.extend(target.map(|stimulus| Place {
        stimulus,
        origin_mm: Point::new(middle_mm, middle_mm),
        number: None,
    }));
    Layout {
        size_mm: [side_mm; 2],
        places,
    }
}

fn in_a_row(items: &[usize]) -> Layout {
    let mut x_mm = MARGIN_MM;
    let mut places = Vec::with_capacity(items.len());
    for (at, stimulus) in items.iter().enumerate() {
        places.push(Place {
            stimulus: *stimulus,
            origin_mm: Point::new(x_mm, MARGIN_MM),
            number: (items.len() > 1).then_some(at + 1),
        });
        x_mm += SIDE_MM + GAP_MM;
    }
    Layout {
        size_mm: [x_mm - GAP_MM + MARGIN_MM, SIDE_MM + 2.0 * MARGIN_MM],
        places,
    }
}

/// What the experimenter lays on the table for a task: the position, `None` for what is compared
/// with, and the cloth.
pub fn on_the_table(design: &Design, task: &Task) -> Vec<(Option<usize>, String)> {
    let compared = match task {
        Task::Rank { target: item, .. } | Task::Adjust { item, .. } => Some(*item),
        _ => None,
    };
    let is_real = design.method.standard() == Some(Standard::RealCloth);
    let standard = compared.filter(|_| is_real).map(|item| {
        let found = design.stimuli.get(item);
        found.map_or_else(String::new, |stimulus| stimulus.material.clone())
    });
    let mut cloths: Vec<(Option<usize>, String)> =
        standard.into_iter().map(|cloth| (None, cloth)).collect();
    for place in Layout::of(design, task).places {
        let found = design.stimuli.get(place.stimulus);
        if let Some(Source::RealCloth(name)) = found.map(|stimulus| &stimulus.source) {
            cloths.push((place.number, name.clone()));
        }
    }
    cloths
}

/// A tuning with the parameters of an adjustment at these values.
pub fn tuned(mut tuning: Tuning, parameters: &[TunedParameter], values: &[f64]) -> Tuning {
    for (parameter, value) in parameters.iter().zip(values) {
        parameter.what.set(&mut tuning, *value);
    }
    tuning
}

/// What is played in a trial of vibrations, a pause between each two: step 2n is interval n. Empty
/// where cloth is felt.
pub fn vibrations(design: &Design, task: &Task) -> Vec<VibrationStep> {
    let step = |band: Band, level_db: Option<f64>, ms: u32| {
        let mut amplitude_um = [0.0; 2];
        if let Some(level_db) = level_db {
            amplitude_um[band.index()] = amplitude_of(level_db);
        }
        VibrationStep {
            amplitude_um,
            n_ticks: ticks(ms),
        }
    };
    let mut steps = Vec::new();
    match task {
        Task::Interval {
            level_db, signal, ..
        } => {
            let Some(levels) = design.method.levels() else {
                return steps;
            };
            for interval in 0..levels.intervals {
                if interval > 0 {
                    steps.push(step(levels.band, None, PAUSE_MS));
                }
                let is_signal = interval == *signal;
                let level_db = is_signal.then_some(*level_db).or(levels.reference_db);
                steps.push(step(levels.band, level_db, levels.interval_ms));
            }
        }
        Task::Estimate { item } | Task::Rate { item } | Task::Judge { item, .. } => {
            let found = design.stimuli.get(*item).map(|stimulus| &stimulus.source);
            if let Some(Source::Vibration { band, level_db }) = found {
                steps.push(step(*band, Some(*level_db), ALONE_MS));
            }
        }
        _ => {}
    }
    steps
}

/// A level as a peak amplitude, µm.
#[expect(
    clippy::cast_possible_truncation,
    reason = "devices take single precision"
)]
fn amplitude_of(level_db: f64) -> f32 {
    factor_of_gain(level_db) as f32
}

/// The whole ticks that are nearest to a time, at least one.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "some seconds"
)]
fn ticks(ms: u32) -> u32 {
    (f64::from(ms) * 1e-3 * TICKS_PER_S).round().max(1.0) as u32
}

#[cfg(test)]
mod tests;
