//! The design's file: TOML, whose tables `presentation`, `question`, `response`, `order` and
//! `adaptation` compose what is asked. What earlier versions wrote is read by [`super::old`].

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde::de::IgnoredAny;

use super::adapting::{AdaptationKeys, band};
use super::check::check;
use super::composing::{Keys, OrderKeys, PresentationKeys, ResponseKeys};
use super::old::OldTables;
use super::{CourseSettings, Design, Medium, Question, Rules, Source, Stimulus, Variant};
use crate::ExperimentError;
use selvedge_foundation::files::{self, Flaw};
use selvedge_textile::tactile::Tuning;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DesignKeys {
    study: String,
    experiment: String,
    #[serde(default)]
    title: String,
    medium: Medium,
    seed: u64,
    library: Option<PathBuf>,
    #[serde(default)]
    textiles: Vec<String>,
    #[serde(default, rename = "stimulus")]
    stimuli: Vec<StimulusKeys>,
    presentation: Option<PresentationKeys>,
    #[serde(default)]
    question: Question,
    response: Option<ResponseKeys>,
    #[serde(default)]
    order: OrderKeys,
    adaptation: Option<AdaptationKeys>,
    #[serde(default)]
    course: CourseSettings,
    #[serde(default)]
    rules: Rules,
    tuning: Option<Tuning>,
    #[serde(
        rename = "ranking",
        alias = "odd_one_out",
        alias = "adjustment",
        alias = "judgement",
        alias = "levels",
        alias = "magnitude",
        alias = "rating"
    )]
    old: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StimulusKeys {
    id: String,
    textile: Option<String>,
    cloth: Option<String>,
    material: Option<String>,
    #[serde(default)]
    condition: String,
    #[serde(default)]
    group: String,
    #[serde(default)]
    gain_db: f64,
    #[serde(default)]
    gain_40_db: f64,
    #[serde(default)]
    gain_320_db: f64,
    #[serde(default)]
    rotation_deg: f64,
    #[serde(default)]
    force_alone: bool,
    band_hz: Option<f64>,
    level_db: Option<f64>,
}

impl Design {
    /// Reads a design's file.
    ///
    /// # Errors
    /// It cannot be read, or a key or value is wrong.
    pub fn read(path: &Path) -> Result<Self, ExperimentError> {
        Self::from_toml(&files::read_text(path)?, path)
    }

    /// Reads the text of a design's file. `path` only names it in errors.
    ///
    /// # Errors
    /// A key or value is wrong.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, ExperimentError> {
        let in_file = |flaw: Flaw| flaw.in_file(text, path);
        let keys: DesignKeys = files::keys_from_str(text, path)?;
        let is_old = keys.old.is_some();
        let old: Option<OldTables> = is_old
            .then(|| files::keys_from_str(text, path))
            .transpose()?;
        let n_named = keys.textiles.len();
        let mut design = Self::from_keys(keys, old).map_err(in_file)?;
        check(&design, n_named).map_err(in_file)?;
        design.hash = files::sha256_hex([text.as_bytes()]);
        text.clone_into(&mut design.text);
        Ok(design)
    }

    fn from_keys(mut keys: DesignKeys, old: Option<OldTables>) -> Result<Self, Flaw> {
        let medium = keys.medium;
        let asked = (keys.presentation.take(), keys.response.take());
        let named = keys.textiles.iter().map(|id| Stimulus {
            id: id.clone(),
            material: id.clone(),
            condition: String::new(),
            group: String::new(),
            source: match medium {
                Medium::Array => Source::Textile {
                    id: id.clone(),
                    variant: Variant::default(),
                },
                Medium::RealCloth => Source::RealCloth(id.clone()),
            },
        });
        let mut stimuli: Vec<Stimulus> = named.collect();
        for (nth, keys) in keys.stimuli.into_iter().enumerate() {
            stimuli.push(keys.stimulus(nth, medium)?);
        }
        let composition = match old {
            Some(old) => old.composition()?,
            None => Keys {
                presentation: asked.0,
                question: keys.question,
                response: asked.1,
                order: keys.order,
                adaptation: keys.adaptation,
            }
            .composition(&stimuli)?,
        };
        Ok(Self {
            study: keys.study,
            experiment: keys.experiment,
            title: keys.title,
            medium,
            seed: keys.seed,
            library: keys.library,
            stimuli,
            composition,
            course: keys.course,
            rules: keys.rules,
            tuning: keys.tuning,
            hash: String::new(),
            text: String::new(),
        })
    }
}

impl StimulusKeys {
    fn stimulus(self, nth: usize, medium: Medium) -> Result<Stimulus, Flaw> {
        let place = |key| ("stimulus", nth, key);
        let vibration = match (self.band_hz, self.level_db) {
            (Some(hz), Some(level_db)) => Some((band(place("band_hz"), hz)?, level_db)),
            (None, None) => None,
            (Some(_), None) => {
                let mend = "add level_db, dB re 1 µm";
                return Err(Flaw::new(
                    place("band_hz"),
                    "a vibration without level",
                    mend,
                ));
            }
            (None, Some(_)) => {
                let mend = "add band_hz = 40 or 320";
                return Err(Flaw::new(place("level_db"), "a level without a band", mend));
            }
        };
        let source = match (vibration, self.textile, self.cloth) {
            (Some((band, level_db)), None, None) => Source::Vibration { band, level_db },
            (None, None, Some(cloth)) => Source::RealCloth(cloth),
            (None, None, None) if medium == Medium::RealCloth => Source::RealCloth(self.id.clone()),
            (None, textile, None) => Source::Textile {
                id: textile.unwrap_or_else(|| self.id.clone()),
                variant: Variant {
                    gain_db: self.gain_db,
                    gain_40_db: self.gain_40_db,
                    gain_320_db: self.gain_320_db,
                    rotation_deg: self.rotation_deg,
                    is_force_alone: self.force_alone,
                },
            },
            _ => {
                let what = format!("{:?} comes from several sources", self.id);
                let mend = "keep one: textile, cloth, or band_hz with level_db";
                return Err(Flaw::new(place("id"), what, mend));
            }
        };
        Ok(Stimulus {
            material: self.material.unwrap_or_else(|| self.id.clone()),
            id: self.id,
            condition: self.condition,
            group: self.group,
            source,
        })
    }
}
