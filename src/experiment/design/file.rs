//! The design's file: TOML, where exactly one table of those in [`METHOD_TABLES`] says what is
//! asked.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::check::flaw;
use super::tables::{
    AdjustingKeys, ChoosingKeys, JudgingKeys, LevelsKeys, MagnitudeKeys, RankingKeys, RatingKeys,
};
use super::{
    CourseSettings, Design, Familiarisation, Medium, Method, Movement, Rules, Source, Standard,
    Stimulus,
};
use crate::ExperimentError;
use selvedge_foundation::files::{self, Flaw, Place};
use selvedge_textile::tactile::{Band, Tuning};

/// The tables that say what is asked.
const METHOD_TABLES: [&str; 7] = [
    "ranking",
    "odd_one_out",
    "adjustment",
    "judgement",
    "levels",
    "magnitude",
    "rating",
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DesignKeys {
    study: String,
    experiment: String,
    #[serde(default)]
    title: String,
    medium: String,
    seed: u64,
    library: Option<PathBuf>,
    #[serde(default)]
    textiles: Vec<String>,
    #[serde(default, rename = "stimulus")]
    stimuli: Vec<StimulusKeys>,
    ranking: Option<RankingKeys>,
    odd_one_out: Option<ChoosingKeys>,
    adjustment: Option<AdjustingKeys>,
    judgement: Option<JudgingKeys>,
    levels: Option<LevelsKeys>,
    magnitude: Option<MagnitudeKeys>,
    rating: Option<RatingKeys>,
    #[serde(default)]
    course: CourseKeys,
    #[serde(default)]
    rules: RulesKeys,
    tuning: Option<Tuning>,
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
    gain_db: f64,
    band_hz: Option<f64>,
    level_db: Option<f64>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
struct CourseKeys {
    instructions: String,
    practice_trials: usize,
    break_after_blocks: usize,
    break_s: f64,
    masking_noise: bool,
    familiarisation: Vec<FamiliarisationKeys>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FamiliarisationKeys {
    movement: String,
    for_s: f64,
    #[serde(default = "speed")]
    speed_mm_per_s: f64,
}

fn speed() -> f64 {
    100.0
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
struct RulesKeys {
    subjects: usize,
    least_trials: usize,
    least_response_s: f64,
    least_share_correct: f64,
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
        let keys: DesignKeys = files::keys_from_str(text, path)?;
        let in_file = |flaw: Flaw| flaw.in_file(text, path);
        let n_named = keys.textiles.len();
        let mut design = Self::from_keys(keys).map_err(in_file)?;
        flaw(&design, n_named).map_or(Ok(()), |flaw| Err(in_file(flaw)))?;
        design.hash = files::sha256_hex([text.as_bytes()]);
        text.clone_into(&mut design.text);
        Ok(design)
    }

    fn from_keys(mut keys: DesignKeys) -> Result<Self, Flaw> {
        let medium = named("", 0, "medium", &keys.medium, &Medium::ALL, Medium::name)?;
        let method = keys.take_method()?;
        let named = keys.textiles.iter().map(|id| Stimulus {
            id: id.clone(),
            material: id.clone(),
            condition: String::new(),
            source: match medium {
                Medium::Array => Source::Textile {
                    id: id.clone(),
                    gain_db: 0.0,
                },
                Medium::RealCloth => Source::RealCloth(id.clone()),
            },
        });
        let mut stimuli: Vec<Stimulus> = named.collect();
        for (nth, keys) in keys.stimuli.into_iter().enumerate() {
            stimuli.push(keys.stimulus(nth, medium)?);
        }
        Ok(Self {
            study: keys.study,
            experiment: keys.experiment,
            title: keys.title,
            medium,
            seed: keys.seed,
            library: keys.library,
            stimuli,
            method,
            course: keys.course.settings()?,
            rules: keys.rules.rules(),
            tuning: keys.tuning,
            hash: String::new(),
            text: String::new(),
        })
    }
}

impl DesignKeys {
    fn take_method(&mut self) -> Result<Method, Flaw> {
        let mut found: Vec<Result<Method, Flaw>> = Vec::new();
        found.extend(self.ranking.take().map(RankingKeys::method));
        found.extend(self.odd_one_out.take().map(|keys| Ok(keys.method())));
        found.extend(self.adjustment.take().map(AdjustingKeys::method));
        found.extend(self.judgement.take().map(JudgingKeys::method));
        found.extend(self.levels.take().map(LevelsKeys::method));
        found.extend(self.magnitude.take().map(|keys| Ok(keys.method())));
        found.extend(self.rating.take().map(|keys| Ok(keys.method())));
        let n = found.len();
        match found.pop() {
            Some(method) if n == 1 => method,
            _ => {
                let what = match n {
                    0 => "nothing is asked".to_owned(),
                    n => format!("{n} tables say what is asked"),
                };
                let mend = format!("keep one of [{}]", METHOD_TABLES.join("], ["));
                Err(Flaw::new(("", 0, "experiment"), what, mend))
            }
        }
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
                gain_db: self.gain_db,
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
            source,
        })
    }
}

impl CourseKeys {
    fn settings(self) -> Result<CourseSettings, Flaw> {
        let movements = [Movement::Circular, Movement::Linear];
        let name = |movement| match movement {
            Movement::Circular => "circular",
            Movement::Linear => "linear",
        };
        let familiarisation = self.familiarisation.iter().enumerate().map(|(nth, keys)| {
            let table = "course.familiarisation";
            Ok(Familiarisation {
                movement: named(table, nth, "movement", &keys.movement, &movements, name)?,
                for_s: keys.for_s,
                speed_mm_per_s: keys.speed_mm_per_s,
            })
        });
        let familiarisation: Result<Vec<_>, Flaw> = familiarisation.collect();
        Ok(CourseSettings {
            familiarisation: familiarisation?,
            practice_trials: self.practice_trials,
            break_after_blocks: self.break_after_blocks,
            break_s: self.break_s,
            masking_noise: self.masking_noise,
            instructions: self.instructions,
        })
    }
}

impl RulesKeys {
    fn rules(self) -> Rules {
        Rules {
            subjects: self.subjects,
            least_trials: self.least_trials,
            least_response_s: self.least_response_s,
            least_share_correct: self.least_share_correct,
        }
    }
}

/// The one of `all` that goes by a name.
pub(super) fn named<T: Copy>(
    table: &'static str,
    nth: usize,
    key: &'static str,
    text: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
) -> Result<T, Flaw> {
    let found = all.iter().copied().find(|&one| name(one) == text);
    found.ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|&one| format!("{:?}", name(one))).collect();
        let what = format!("{key} is {text:?}, which is not known");
        Flaw::new(
            (table, nth, key),
            what,
            format!("give {}", names.join(" or ")),
        )
    })
}

pub(super) fn standard((table, nth, key): Place, text: &str) -> Result<Standard, Flaw> {
    let all = [Standard::RealCloth, Standard::Virtual, Standard::None];
    named(table, nth, key, text, &all, |standard| match standard {
        Standard::RealCloth => "real-cloth",
        Standard::Virtual => "virtual",
        Standard::None => "none",
    })
}

pub(super) fn band(place: Place, hz: f64) -> Result<Band, Flaw> {
    let found = Band::ALL
        .into_iter()
        .find(|band| (band.carrier_hz() - hz).abs() < 1e-9);
    found.ok_or_else(|| {
        Flaw::new(
            place,
            format!("there is no band at {hz} Hz"),
            "give 40 or 320",
        )
    })
}
