//! The tables that say what is asked, as a file spells them.

use serde::Deserialize;

use super::file::{band, named, standard};
use super::{
    Adjusting, Choosing, Judging, JudgingProtocol, Levels, Method, QuestPlusTrack, Ranking, Rating,
    Scale, StaircaseTrack, Stopping, Track, Tunable, TunedParameter,
};
use selvedge_foundation::files::Flaw;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RankingKeys {
    target: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChoosingKeys {
    #[serde(default = "grade_weights")]
    weights: [f64; 3],
}

fn grade_weights() -> [f64; 3] {
    [1.0, 0.5, 0.1]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AdjustingKeys {
    standard: String,
    #[serde(default = "two")]
    repeats: usize,
    #[serde(rename = "parameter")]
    parameters: Vec<ParameterKeys>,
}

fn one() -> usize {
    1
}

fn two() -> usize {
    2
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterKeys {
    key: String,
    from: f64,
    to: f64,
    step: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JudgingKeys {
    real: String,
    protocol: String,
    #[serde(default = "one")]
    repeats: usize,
    #[serde(default)]
    confidence_grades: u8,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LevelsKeys {
    band_hz: f64,
    #[serde(default = "two")]
    intervals: usize,
    reference_db: Option<f64>,
    #[serde(default = "interval_ms")]
    interval_ms: u32,
    range_db: [f64; 2],
    staircase: Option<StaircaseKeys>,
    quest_plus: Option<QuestPlusKeys>,
    constant: Option<ConstantKeys>,
    #[serde(default)]
    stop: StopKeys,
}

fn interval_ms() -> u32 {
    500
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StaircaseKeys {
    up: u32,
    down: u32,
    steps_db: Vec<f64>,
    #[serde(default = "unity")]
    up_over_down: f64,
    starts_db: Vec<f64>,
    #[serde(default = "six")]
    reversals_averaged: usize,
}

fn unity() -> f64 {
    1.0
}

fn six() -> usize {
    6
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuestPlusKeys {
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
pub(super) struct ConstantKeys {
    levels_db: Vec<f64>,
    repeats: usize,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub(super) struct StopKeys {
    trials: usize,
    reversals: usize,
    posterior_sd_db: f64,
    needs: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MagnitudeKeys {
    #[serde(default = "two")]
    repeats: usize,
    modulus: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RatingKeys {
    #[serde(default = "one")]
    repeats: usize,
    #[serde(rename = "scale")]
    scales: Vec<ScaleKeys>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScaleKeys {
    key: String,
    low: String,
    high: String,
    #[serde(default)]
    points: u8,
}

impl RankingKeys {
    pub(super) fn method(self) -> Result<Method, Flaw> {
        let target = standard(("ranking", 0, "target"), &self.target)?;
        Ok(Method::Ranking(Ranking { target }))
    }
}

impl ChoosingKeys {
    pub(super) fn method(self) -> Method {
        let weights = self.weights;
        Method::OddOneOut(Choosing { weights })
    }
}

impl MagnitudeKeys {
    pub(super) fn method(self) -> Method {
        Method::Magnitude {
            repeats: self.repeats,
            modulus: self.modulus,
        }
    }
}

impl AdjustingKeys {
    pub(super) fn method(self) -> Result<Method, Flaw> {
        let parameter = |(nth, keys): (usize, &ParameterKeys)| {
            let place = ("adjustment.parameter", nth, "key");
            Ok(TunedParameter {
                what: named(
                    place.0,
                    nth,
                    place.2,
                    &keys.key,
                    &Tunable::ALL,
                    Tunable::name,
                )?,
                from: keys.from,
                to: keys.to,
                step: keys.step,
            })
        };
        let parameters: Result<Vec<_>, Flaw> =
            self.parameters.iter().enumerate().map(parameter).collect();
        Ok(Method::Adjustment(Adjusting {
            parameters: parameters?,
            standard: standard(("adjustment", 0, "standard"), &self.standard)?,
            repeats: self.repeats,
        }))
    }
}

impl JudgingKeys {
    pub(super) fn method(self) -> Result<Method, Flaw> {
        let protocols = [JudgingProtocol::Single, JudgingProtocol::Pair];
        let name = |protocol| match protocol {
            JudgingProtocol::Single => "single",
            JudgingProtocol::Pair => "pair",
        };
        let protocol = named("judgement", 0, "protocol", &self.protocol, &protocols, name)?;
        Ok(Method::Judgement(Judging {
            real: self.real,
            protocol,
            repeats: self.repeats,
            confidence_grades: self.confidence_grades,
        }))
    }
}

impl LevelsKeys {
    pub(super) fn method(self) -> Result<Method, Flaw> {
        let mut tracks: Vec<Track> = Vec::new();
        tracks.extend(self.staircase.map(|keys| {
            Track::Staircase(StaircaseTrack {
                up: keys.up,
                down: keys.down,
                steps_db: keys.steps_db,
                up_over_down: keys.up_over_down,
                starts_db: keys.starts_db,
                reversals_averaged: keys.reversals_averaged,
            })
        }));
        let is_difference = self.reference_db.is_some();
        if let Some(keys) = self.quest_plus {
            tracks.push(keys.track(is_difference)?);
        }
        tracks.extend(self.constant.map(|keys| Track::Constant {
            levels_db: keys.levels_db,
            repeats: keys.repeats,
        }));
        let n = tracks.len();
        let track = tracks.pop().filter(|_| n == 1).ok_or_else(|| {
            let what = format!("{n} tables say how the next level is found");
            let mend = "keep one of [levels.staircase], [levels.quest_plus], [levels.constant]";
            Flaw::new(("levels", 0, "band_hz"), what, mend)
        })?;
        let is_all = |&all: &bool| if all { "all" } else { "any" };
        let needs = match self.stop.needs.as_str() {
            "" => "any",
            needs => needs,
        };
        let needs_all = named("levels.stop", 0, "needs", needs, &[false, true], |all| {
            is_all(&all)
        })?;
        Ok(Method::Levels(Levels {
            band: band(("levels", 0, "band_hz"), self.band_hz)?,
            intervals: self.intervals,
            reference_db: self.reference_db,
            interval_ms: self.interval_ms,
            range_db: self.range_db,
            track,
            stopping: Stopping {
                trials: self.stop.trials,
                reversals: self.stop.reversals,
                posterior_sd_db: self.stop.posterior_sd_db,
                needs_all,
            },
        }))
    }
}

impl QuestPlusKeys {
    pub(super) fn track(self, is_difference: bool) -> Result<Track, Flaw> {
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

impl RatingKeys {
    pub(super) fn method(self) -> Method {
        let scales = self.scales.into_iter().map(|keys| Scale {
            key: keys.key,
            low: keys.low,
            high: keys.high,
            points: keys.points,
        });
        Method::Rating(Rating {
            scales: scales.collect(),
            repeats: self.repeats,
        })
    }
}
