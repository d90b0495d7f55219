//! What a design's stimuli are physically: amplitudes of both bands, how they vary from place to
//! place and differ from direction to direction.
//!
//! Textiles are measured at 100 mm/s ([`Levels::of`]), under a stylus where the design has one, and
//! felt through the tuning of the session. What is given as force alone is silent.
//! A cloth on the table is taken to feel as its namesake of the library does through the library's
//! own tuning, which is what that tuning is for, but for an error of the model.

use std::collections::BTreeMap;

use super::led;
use crate::ExperimentError;
use crate::design::{Design, Source, Stimulus};
use crate::stimulus_hash::StimulusHashes;
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_textile::Library;
use selvedge_textile::tactile::{Band, Filters, Levels, Tuning};

/// What presents a stimulus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Presented {
    /// The array, through the tuning.
    Textile,
    /// The array, as it is.
    Vibration,
    /// The table.
    Cloth,
}

/// A stimulus as it is measured.
#[derive(Debug, Clone, PartialEq)]
struct Measure {
    presented: Presented,
    /// The textile, or the stimulus where it is none.
    name: String,
    levels: Levels,
    /// Gains of its own at 40 and 320 Hz, dB.
    gains_db: [f64; 2],
}

/// A design's stimuli as they are measured, and the tunings that they are felt through.
#[derive(Debug, Clone, PartialEq)]
pub struct Stimuli {
    measures: Vec<Measure>,
    tuning: Tuning,
    library_tuning: Tuning,
    reference_db: f64,
    hashes: StimulusHashes,
}

impl Stimuli {
    /// Measures the textiles of a design in its library.
    ///
    /// # Errors
    /// A textile is not in the library or cannot be read, or the work was cancelled.
    pub fn of(
        design: &Design,
        library: &Library,
        progress: &mut Progress<'_>,
    ) -> Result<Self, ExperimentError> {
        let mut ids: Vec<String> = design.stimuli.iter().filter_map(textile_of).collect();
        ids.sort();
        ids.dedup();
        // What is missing is said before minutes are spent on what is not.
        for id in &ids {
            drop(library.manifest(id)?);
        }
        let mut known = BTreeMap::new();
        let mut hashes = Vec::new();
        for textile in library.load_all(&ids, progress)? {
            let levels = match &design.composition.presentation.stylus {
                Some(stylus) => led::levels(&textile, stylus)?,
                None => Levels::of(textile.surface(), &Filters::default()),
            };
            hashes.push((textile.id().to_owned(), textile.content_hash()?));
            let gain_db = textile.manifest().gain_db;
            known.insert(textile.id().to_owned(), (levels, gain_db));
        }
        let of_textile = |id: &str| known.get(id).copied();
        let mut stimuli = Self::from_levels(design, library.default_tuning(), of_textile)?;
        stimuli.hashes = StimulusHashes::of(hashes);
        Ok(stimuli)
    }

    /// Stimuli of textiles whose levels and gains of their own in dB are at hand: at other speeds,
    /// or without a library.
    ///
    /// # Errors
    /// `of_textile` does not know a textile.
    pub(crate) fn from_levels(
        design: &Design,
        library_tuning: Tuning,
        of_textile: impl Fn(&str) -> Option<(Levels, f64)>,
    ) -> Result<Self, ExperimentError> {
        let measure = |stimulus: &Stimulus| measure(stimulus, &of_textile);
        let measures: Result<Vec<Measure>, _> = design.stimuli.iter().map(measure).collect();
        let measures = measures?;
        let is_known = |measure: &&Measure| measure.presented != Presented::Vibration;
        let levels = measures.iter().filter(is_known);
        let levels: Vec<f64> = levels.filter_map(|one| one.levels.level_db()).collect();
        let mean_db = levels.iter().sum::<f64>() / levels.len().max(1) as f64;
        Ok(Self {
            measures,
            tuning: design.tuning.unwrap_or(library_tuning),
            library_tuning,
            reference_db: library_tuning.compression_reference_db.unwrap_or(mean_db),
            hashes: StimulusHashes::default(),
        })
    }

    /// The tuning of the session.
    pub fn tuning(&self) -> Tuning {
        self.tuning
    }

    /// What the stimuli were made from; of no textile where levels were given.
    pub(crate) fn hashes(&self) -> &StimulusHashes {
        &self.hashes
    }

    /// What a stimulus goes by: its textile's id, or its own.
    pub(super) fn name(&self, item: usize) -> &str {
        &self.measures[item].name
    }

    /// Whether it is cloth on the table.
    pub(super) fn is_cloth(&self, item: usize) -> bool {
        self.measures[item].presented == Presented::Cloth
    }

    /// Levels before any gain.
    pub(super) fn levels(&self, item: usize) -> &Levels {
        &self.measures[item].levels
    }

    /// What is added to both bands of a stimulus by a tuning, dB.
    pub(super) fn gains_db(&self, item: usize, tuning: &Tuning) -> [f64; 2] {
        let measure = &self.measures[item];
        if measure.presented == Presented::Vibration {
            return [0.0; 2];
        }
        let reference_db = tuning.compression_reference_db.unwrap_or(self.reference_db);
        let level_db = measure.levels.level_db();
        let compression_db = tuning.compression_gain_db(level_db, reference_db);
        let own_db = |band: Band| measure.gains_db[band.index()] + compression_db;
        Band::ALL.map(|band| own_db(band) + tuning.band_gain_db(band))
    }

    /// What is added to both bands where a stimulus lies on the table, without the model's error,
    /// dB.
    pub(super) fn cloth_gains_db(&self, item: usize) -> [f64; 2] {
        self.gains_db(item, &self.library_tuning)
    }

    /// The mean amplitudes of a stimulus [A40, A320] through the tuning of the session, µm.
    pub fn felt_um(&self, item: usize) -> [f64; 2] {
        let gains_db = self.gains_db(item, &self.tuning);
        Band::ALL.map(Band::index).map(|b| {
            let plain_um = self.levels(item).mean_um[b];
            plain_um * factor_of_gain(gains_db[b])
        })
    }
}

/// The textile of the library that a stimulus stands for.
fn textile_of(stimulus: &Stimulus) -> Option<String> {
    match &stimulus.source {
        Source::Textile { id, .. } | Source::RealCloth(id) => Some(id.clone()),
        Source::Vibration { .. } => None,
    }
}

fn measure(
    stimulus: &Stimulus,
    of_textile: &impl Fn(&str) -> Option<(Levels, f64)>,
) -> Result<Measure, ExperimentError> {
    let textile = |id: &str| {
        of_textile(id).ok_or_else(|| {
            let what = format!("the levels of textile {id:?} are not known");
            ExperimentError::value(what, "name a textile of the library")
        })
    };
    Ok(match &stimulus.source {
        Source::Textile { id, variant } => {
            let (levels, own_db) = textile(id)?;
            Measure {
                presented: Presented::Textile,
                name: id.clone(),
                levels: if variant.is_force_alone {
                    steady([0.0; 2])
                } else {
                    levels
                },
                gains_db: variant.gains_db().map(|db| own_db + db),
            }
        }
        Source::RealCloth(id) => {
            let (levels, own_db) = textile(id)?;
            Measure {
                presented: Presented::Cloth,
                name: id.clone(),
                levels,
                gains_db: [own_db; 2],
            }
        }
        Source::Vibration { band, level_db } => {
            let mut mean_um = [0.0; 2];
            mean_um[band.index()] = factor_of_gain(*level_db);
            Measure {
                presented: Presented::Vibration,
                name: stimulus.id.clone(),
                levels: steady(mean_um),
                gains_db: [0.0; 2],
            }
        }
    })
}

/// Amplitudes in µm that are the same everywhere.
fn steady(mean_um: [f64; 2]) -> Levels {
    Levels {
        mean_um,
        cv: [0.0; 2],
        anisotropy_db: [0.0; 2],
        direction_mean_um: [mean_um; 4],
    }
}
