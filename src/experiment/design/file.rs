//! The design's file: TOML, where exactly one table of those in [`METHOD_TABLES`] says what is
//! asked.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::check::check;
use super::method::{count, unity};
use super::{
    Adjusting, Choosing, CourseSettings, Design, Judging, Levels, Medium, Method, QuestPlusTrack,
    Ranking, Rating, Rules, Source, StaircaseTrack, Stimulus, Stopping, Track,
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
    medium: Medium,
    seed: u64,
    library: Option<PathBuf>,
    #[serde(default)]
    textiles: Vec<String>,
    #[serde(default, rename = "stimulus")]
    stimuli: Vec<StimulusKeys>,
    ranking: Option<Ranking>,
    odd_one_out: Option<Choosing>,
    adjustment: Option<Adjusting>,
    judgement: Option<Judging>,
    levels: Option<LevelsKeys>,
    magnitude: Option<MagnitudeKeys>,
    rating: Option<Rating>,
    #[serde(default)]
    course: CourseSettings,
    #[serde(default)]
    rules: Rules,
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
        check(&design, n_named).map_err(in_file)?;
        design.hash = files::sha256_hex([text.as_bytes()]);
        text.clone_into(&mut design.text);
        Ok(design)
    }

    fn from_keys(mut keys: DesignKeys) -> Result<Self, Flaw> {
        let medium = keys.medium;
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
            course: keys.course,
            rules: keys.rules,
            tuning: keys.tuning,
            hash: String::new(),
            text: String::new(),
        })
    }
}

impl DesignKeys {
    fn take_method(&mut self) -> Result<Method, Flaw> {
        let levels = self.levels.take().map(LevelsKeys::levels);
        let magnitude = self.magnitude.take().map(|keys| Method::Magnitude {
            repeats: keys.repeats,
            modulus: keys.modulus,
        });
        let found = [
            self.ranking.take().map(Method::Ranking),
            self.odd_one_out.take().map(Method::OddOneOut),
            self.adjustment.take().map(Method::Adjustment),
            self.judgement.take().map(Method::Judgement),
            levels.transpose()?.map(Method::Levels),
            magnitude,
            self.rating.take().map(Method::Rating),
        ];
        let mut found: Vec<Method> = found.into_iter().flatten().collect();
        let n = found.len();
        match found.pop() {
            Some(method) if n == 1 => Ok(method),
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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LevelsKeys {
    band_hz: f64,
    #[serde(default = "count::<2>")]
    intervals: usize,
    reference_db: Option<f64>,
    #[serde(default = "interval_ms")]
    interval_ms: u32,
    range_db: [f64; 2],
    staircase: Option<StaircaseTrack>,
    quest_plus: Option<QuestPlusKeys>,
    constant: Option<ConstantKeys>,
    #[serde(default)]
    stop: Stopping,
}

fn interval_ms() -> u32 {
    500
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct QuestPlusKeys {
    #[serde(default = "unity")]
    grid_db: f64,
    widths_db: Option<Vec<f64>>,
    widths_ln: Option<Vec<f64>>,
    #[serde(default = "lapses")]
    lapses: Vec<f64>,
}

fn lapses() -> Vec<f64> {
    vec![0.0, 0.02, 0.04]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ConstantKeys {
    levels_db: Vec<f64>,
    repeats: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MagnitudeKeys {
    #[serde(default = "count::<2>")]
    repeats: usize,
    modulus: Option<f64>,
}

impl LevelsKeys {
    fn levels(self) -> Result<Levels, Flaw> {
        let is_difference = self.reference_db.is_some();
        let quest_plus = self.quest_plus.map(|keys| keys.track(is_difference));
        let constant = self.constant.map(|keys| Track::Constant {
            levels_db: keys.levels_db,
            repeats: keys.repeats,
        });
        let staircase = self.staircase.map(Track::Staircase);
        let tracks = [staircase, quest_plus.transpose()?, constant];
        let mut tracks: Vec<Track> = tracks.into_iter().flatten().collect();
        let n = tracks.len();
        let track = tracks.pop().filter(|_| n == 1).ok_or_else(|| {
            let what = format!("{n} tables say how the next level is found");
            let mend = "keep one of [levels.staircase], [levels.quest_plus], [levels.constant]";
            Flaw::new(("levels", 0, "band_hz"), what, mend)
        })?;
        Ok(Levels {
            band: band(("levels", 0, "band_hz"), self.band_hz)?,
            intervals: self.intervals,
            reference_db: self.reference_db,
            interval_ms: self.interval_ms,
            range_db: self.range_db,
            track,
            stopping: self.stop,
        })
    }
}

impl QuestPlusKeys {
    fn track(self, is_difference: bool) -> Result<Track, Flaw> {
        let (stated, other, usual) = if is_difference {
            (self.widths_ln, self.widths_db, vec![1.5, 2.0, 3.0, 4.0])
        } else {
            (self.widths_db, self.widths_ln, vec![2.0, 4.0, 8.0, 16.0])
        };
        if other.is_some() {
            let (key, mend) = if is_difference {
                (
                    "widths_db",
                    "with reference_db give widths_ln: logarithms of dB",
                )
            } else {
                ("widths_ln", "without reference_db give widths_db")
            };
            let place = ("levels.quest_plus", 0, key);
            return Err(Flaw::new(place, format!("{key} has no meaning here"), mend));
        }
        Ok(Track::QuestPlus(QuestPlusTrack {
            grid_db: self.grid_db,
            widths: stated.unwrap_or(usual),
            lapses: self.lapses,
        }))
    }
}

fn band(place: Place, hz: f64) -> Result<Band, Flaw> {
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
