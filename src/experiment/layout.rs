//! What a trial presents on the array: what lies where under which number, what the experimenter
//! lays on the table, and what is played in which sequence.
//!
//! Pure: a function of the design and the trial. Labels are numbers of places, never of stimuli.

mod sequence;

pub use sequence::sequence;

use super::design::{Design, Form, Shown, Source, Standard, Tunable, Variant};
use super::trial::Task;
use selvedge_foundation::geometry::{Displacement, Point, Rotation};
use selvedge_render::scene::{Display, PlacedTextile, Scene};
use selvedge_textile::tactile::Tuning;

/// Side of a stimulus, mm (Philpott & Summers 2012).
const SIDE_MM: f64 = 100.0;
/// Between the edge of the workspace and what lies in it, mm.
const MARGIN_MM: f64 = 10.0;
/// Between two stimuli without one in the middle, mm.
const GAP_MM: f64 = 20.0;
/// How far a textile that is turned reaches beyond its place, where it is not felt, at least, mm.
const HEM_MM: f64 = 1.0;

/// Where the stimuli of a trial lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Width and height of the workspace, mm.
    pub size_mm: [f64; 2],
    /// The stimuli, what they are compared with last.
    pub places: Vec<Place>,
}

/// One stimulus in the workspace.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// The design's number of it.
    pub stimulus: usize,
    /// Its lower left corner, mm.
    pub origin_mm: Point,
    /// Its position from 1; `None` for a reference and for one that lies alone.
    pub number: Option<usize>,
    /// The number of it that is adapted.
    pub(crate) adapted: Option<f64>,
}

impl Layout {
    /// Where the stimuli of a task lie: up to three side by side, four at the corners, more in
    /// rows. A virtual reference lies in the middle of four, else behind the others. Textiles that
    /// come in intervals lie upon each other.
    pub fn of(design: &Design, task: &Task) -> Self {
        let composition = &design.composition;
        let is_in_time = composition.presentation.shown == Shown::Intervals;
        if is_in_time && design.plays_vibrations() {
            return Self::empty();
        }
        let is_real = composition.presentation.reference == Standard::RealCloth;
        let reference = task.reference.filter(|_| !is_real);
        let mut layout = match (task.items.len(), reference) {
            (_, reference) if is_in_time => upon_each_other(&task.items, reference),
            (4, reference) => four(&task.items, reference),
            (_, None) => in_rows(&task.items),
            (_, Some(reference)) => beside(&task.items, reference),
        };
        let adaptation = composition.adaptation.as_ref().filter(|adaptation| {
            // The tuning of one alone has its value.
            let is_of_tuning = adaptation.parameter.is_of_tuning();
            task.adapted.is_some() && !(is_of_tuning && composition.presentation.n == 1)
        });
        if let Some(adaptation) = adaptation {
            for (at, place) in layout.places.iter_mut().enumerate() {
                place.adapted = task.adapted_at(adaptation, at);
            }
        }
        layout
    }

    /// A workspace in which nothing lies.
    pub fn empty() -> Self {
        let places = Vec::new();
        Self {
            places,
            ..in_rows(&[0])
        }
    }

    /// One stimulus with room for a guided movement.
    pub fn to_practise(stimulus: usize) -> Self {
        in_rows(&[stimulus])
    }

    /// Whether what lies here is felt in turn at one place.
    pub fn is_stacked(&self) -> bool {
        let [first, others @ ..] = self.places.as_slice() else {
            return false;
        };
        let is_there = |other: &Place| other.origin_mm == first.origin_mm;
        !others.is_empty() && others.iter().all(is_there)
    }

    /// The scene of what lies here: textiles alone, each in its full size. `level_db` is the level
    /// of a textile of the library, which an adapted compression goes by.
    pub fn scene(
        &self,
        design: &Design,
        (display, tuning): (&Display, Tuning),
        level_db: impl Fn(&str) -> Option<f64>,
    ) -> Scene {
        let placed = self.places.iter().filter_map(|place| {
            let stimulus = design.stimuli.get(place.stimulus)?;
            let Source::Textile { id, variant } = &stimulus.source else {
                return None;
            };
            let adapted = place.adapted.zip(design.composition.adaptation.as_ref());
            let variant = adapted.map_or(*variant, |(value, adaptation)| {
                let parameter = adaptation.parameter;
                let compressed_db = match parameter {
                    Tunable::Compression => compressed_db(value, &tuning, level_db(id)),
                    _ => 0.0,
                };
                let varied = variant.with(parameter, value);
                varied.with(Tunable::Gain, compressed_db)
            });
            Some(PlacedTextile {
                id: id.clone(),
                label: place.number.map_or_else(String::new, |n| n.to_string()),
                ..place.lay(&variant)
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

    /// A textile that lies here. One that is turned is a larger piece, about the same middle, of
    /// which nothing but the place is felt: no edge tells how it is turned.
    fn lay(&self, variant: &Variant) -> PlacedTextile {
        let flat = PlacedTextile {
            origin_mm: self.origin_mm,
            size_mm: Self::SIZE_MM,
            gain_db: variant.gain_db,
            gain_40_db: variant.gain_40_db,
            gain_320_db: variant.gain_320_db,
            ..PlacedTextile::default()
        };
        if variant.rotation_deg.abs() <= 0.0 {
            return flat;
        }
        let rotation = Rotation::from_degrees(variant.rotation_deg);
        let (cos, sin) = rotation.cos_sin();
        let half_mm = 0.5 * SIDE_MM;
        let reach_mm = half_mm * (cos.abs() + sin.abs()) + HEM_MM;
        let to_middle = Displacement::new(half_mm, half_mm);
        let from_middle = Displacement::new(-reach_mm, -reach_mm);
        PlacedTextile {
            origin_mm: self.origin_mm + to_middle + rotation.turn(from_middle),
            size_mm: [2.0 * reach_mm; 2],
            rotation_deg: variant.rotation_deg,
            within_mm: Some([self.origin_mm, self.origin_mm + to_middle + to_middle]),
            ..flat
        }
    }
}

/// What a place's own compression adds to its gain, dB: the tuning is that of the whole workspace.
fn compressed_db(compression: f64, tuning: &Tuning, level_db: Option<f64>) -> f64 {
    let own = Tuning {
        compression,
        ..*tuning
    };
    tuning.compression_reference_db.map_or(0.0, |reference_db| {
        let gain_db = |tuning: &Tuning| tuning.compression_gain_db(level_db, reference_db);
        gain_db(&own) - gain_db(tuning)
    })
}

/// Positions 1 and 2 above, 3 and 4 below; a reference in the middle takes as much room as a gap.
fn four(items: &[usize], reference: Option<usize>) -> Layout {
    let gap_mm = if reference.is_some() {
        SIDE_MM + 2.0 * MARGIN_MM
    } else {
        GAP_MM
    };
    let mut layout = grid(items, 2, gap_mm);
    let middle_mm = 0.5 * (layout.size_mm[0] - SIDE_MM);
    layout.places.extend(reference.map(|stimulus| Place {
        stimulus,
        origin_mm: Point::new(middle_mm, middle_mm),
        number: None,
        adapted: None,
    }));
    layout
}

fn in_rows(items: &[usize]) -> Layout {
    let n_columns = match items.len() {
        0..4 => items.len(),
        n => (1..n).find(|columns| columns * columns >= n).unwrap_or(n),
    };
    let mut layout = grid(items, n_columns, GAP_MM);
    if let [alone] = layout.places.as_mut_slice() {
        alone.number = None;
    }
    layout
}

/// The others in a row, and the reference behind them.
fn beside(items: &[usize], reference: usize) -> Layout {
    let all: Vec<usize> = items.iter().copied().chain([reference]).collect();
    let mut layout = grid(&all, all.len(), GAP_MM);
    if let Some(last) = layout.places.last_mut() {
        last.number = None;
    }
    layout
}

/// All at the place of one that lies alone, the reference on top.
fn upon_each_other(items: &[usize], reference: Option<usize>) -> Layout {
    let numbers = (1..=items.len()).map(Some).chain([None]);
    let stimuli = items.iter().copied().chain(reference);
    let place = |(stimulus, number)| Place {
        stimulus,
        origin_mm: Point::new(MARGIN_MM, MARGIN_MM),
        number,
        adapted: None,
    };
    Layout {
        size_mm: [SIDE_MM + 2.0 * MARGIN_MM; 2],
        places: stimuli.zip(numbers).map(place).collect(),
    }
}

/// Row by row from above, each from the left.
fn grid(items: &[usize], n_columns: usize, gap_mm: f64) -> Layout {
    let n_rows = items.len().div_ceil(n_columns.max(1));
    let pitch_mm = SIDE_MM + gap_mm;
    let across_mm = |n: usize| 2.0 * MARGIN_MM + n as f64 * pitch_mm - gap_mm;
    let place = |(at, stimulus): (usize, &usize)| {
        let (row, column) = (at / n_columns, at % n_columns);
        let x_mm = MARGIN_MM + column as f64 * pitch_mm;
        let y_mm = MARGIN_MM + (n_rows - 1 - row) as f64 * pitch_mm;
        Place {
            stimulus: *stimulus,
            origin_mm: Point::new(x_mm, y_mm),
            number: Some(at + 1),
            adapted: None,
        }
    };
    Layout {
        size_mm: [across_mm(n_columns), across_mm(n_rows)],
        places: items.iter().enumerate().map(place).collect(),
    }
}

impl Layout {
    /// What the experimenter lays on the table for a task: the position, `None` for what is
    /// compared with, and the cloth.
    pub fn on_the_table(design: &Design, task: &Task) -> Vec<(Option<usize>, String)> {
        let composition = &design.composition;
        let is_adjusted = matches!(composition.response.form, Form::Adjustment(_));
        let compared = task
            .reference
            .or_else(|| task.item().filter(|_| is_adjusted));
        let is_real = composition.presentation.reference == Standard::RealCloth;
        let standard = compared.filter(|_| is_real).map(|item| {
            let found = design.stimuli.get(item);
            found.map_or_else(String::new, |stimulus| stimulus.material.clone())
        });
        let mut cloths: Vec<(Option<usize>, String)> =
            standard.into_iter().map(|cloth| (None, cloth)).collect();
        for place in Self::of(design, task).places {
            let found = design.stimuli.get(place.stimulus);
            if let Some(Source::RealCloth(name)) = found.map(|stimulus| &stimulus.source) {
                cloths.push((place.number, name.clone()));
            }
        }
        cloths
    }
}

impl Layout {
    /// The textile that hangs in a task, if one does: cloth on the table lies there.
    pub fn hanging<'a>(design: &'a Design, task: &Task) -> Option<&'a str> {
        let hangs = design.composition.presentation.hangs;
        let stimulus = design.stimuli.get(task.item().filter(|_| hangs)?)?;
        match &stimulus.source {
            Source::Textile { id, .. } => Some(id),
            Source::RealCloth(_) | Source::Vibration { .. } => None,
        }
    }
}

/// The tuning of a trial: what is felt alone has the adapted value, and an adjustment the values
/// that its parameters are turned to.
pub fn tuned(design: &Design, task: &Task, mut tuning: Tuning, values: &[f64]) -> Tuning {
    let composition = &design.composition;
    for (parameter, value) in composition.parameters().iter().zip(values) {
        parameter.what.set(&mut tuning, *value);
    }
    let alone = task.adapted.filter(|_| composition.presentation.n == 1);
    if let (Some(adapted), Some(adaptation)) = (alone, &composition.adaptation) {
        adaptation.parameter.set(&mut tuning, adapted.value);
    }
    tuning
}

#[cfg(test)]
mod tests;
