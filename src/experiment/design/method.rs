//! What is asked, and how the next question is found.

use serde::{Deserialize, Deserializer};

use crate::named::{named, read_name};
use selvedge_statistics::adaptive::{Rule, Stage, StaircasePlan, StepScale, Stop};
use selvedge_statistics::psychometric::Family;
use selvedge_textile::tactile::{Band, Tuning};

/// What a session asks.
#[derive(Debug, Clone, PartialEq)]
pub enum Method {
    /// Rank four alternatives by their likeness to a target (Philpott & Summers 2012).
    Ranking(Ranking),
    /// Find the odd one of three (Allerkamp et al.).
    OddOneOut(Choosing),
    /// Turn parameters until a stimulus is as asked.
    Adjustment(Adjusting),
    /// Say what is real and what is generated (Cai et al. 2021).
    Judgement(Judging),
    /// Find the interval with the (stronger) vibration: thresholds and just noticeable differences.
    Levels(Levels),
    /// Give numbers for strengths.
    Magnitude {
        /// How often every stimulus comes.
        repeats: usize,
        /// The number that the first stimulus is said to have, if one is said.
        modulus: Option<f64>,
    },
    /// Place stimuli on scales.
    Rating(Rating),
}

impl Method {
    /// As files and logs call it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Ranking(_) => "ranking",
            Self::OddOneOut(_) => "odd_one_out",
            Self::Adjustment(_) => "adjustment",
            Self::Judgement(_) => "judgement",
            Self::Levels(_) => "levels",
            Self::Magnitude { .. } => "magnitude",
            Self::Rating(_) => "rating",
        }
    }

    /// What is turned; nothing unless that is asked.
    pub fn parameters(&self) -> &[TunedParameter] {
        match self {
            Self::Adjustment(adjusting) => &adjusting.parameters,
            _ => &[],
        }
    }

    /// The scales that are asked for.
    pub fn scales(&self) -> &[Scale] {
        match self {
            Self::Rating(rating) => &rating.scales,
            _ => &[],
        }
    }

    /// Intervals, where one of them is to be found.
    pub fn levels(&self) -> Option<&Levels> {
        match self {
            Self::Levels(levels) => Some(levels),
            _ => None,
        }
    }

    /// Grades of confidence that are asked for; 0 asks for none.
    pub fn confidence_grades(&self) -> u8 {
        match self {
            Self::Judgement(judging) => judging.confidence_grades,
            _ => 0,
        }
    }

    /// What the stimuli are compared with; `None` where a method knows no such thing.
    pub(crate) fn standard(&self) -> Option<Standard> {
        match self {
            Self::Ranking(ranking) => Some(ranking.target),
            Self::Adjustment(adjusting) => Some(adjusting.standard),
            _ => None,
        }
    }
}

/// Ranking against a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ranking {
    /// Where the target lies.
    #[serde(deserialize_with = "target")]
    pub target: Standard,
}

named! { "standard",
    /// What a trial is compared with.
    pub enum Standard {
        /// The real cloth on the table.
        RealCloth = "real-cloth",
        /// A virtual one in the middle of the others.
        Virtual = "virtual",
        /// Nothing: what is asked is the participant's own.
        None = "none",
    }
}

fn target<'de, D: Deserializer<'de>>(from: D) -> Result<Standard, D::Error> {
    read_name("target", from)
}

/// The odd one out.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choosing {
    /// What a right answer is worth by grade, from easy to hard; a wrong one is worth 0.
    #[serde(default = "grade_weights")]
    pub weights: [f64; 3],
}

/// Adjustment of parameters.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adjusting {
    /// What it is compared with.
    pub standard: Standard,
    /// How often every stimulus comes, half of them begun high, half low.
    #[serde(default = "count::<2>")]
    pub repeats: usize,
    /// What is turned, one or two at once.
    #[serde(rename = "parameter")]
    pub parameters: Vec<TunedParameter>,
}

/// A parameter that participants turn.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TunedParameter {
    /// Which.
    #[serde(rename = "key")]
    pub(crate) what: Tunable,
    /// The lowest value.
    pub from: f64,
    /// The highest value.
    pub to: f64,
    /// What one press of a key turns it by.
    pub step: f64,
}

named! { "key",
    /// What can be turned: parts of a [`Tuning`].
    pub(crate) enum Tunable {
        /// The gain of everything, dB.
        Gain = "gain_db",
        /// The gain of the 40 Hz band, dB.
        Gain40 = "gain_40_db",
        /// The gain of the 320 Hz band, dB.
        Gain320 = "gain_320_db",
        /// Compression, 0 to 1.
        Compression = "compression",
    }
}

impl Tunable {
    /// Sets it in a tuning.
    pub(crate) fn set(self, tuning: &mut Tuning, value: f64) {
        match self {
            Self::Gain => tuning.gain_db = value,
            Self::Gain40 => tuning.gain_40_db = value,
            Self::Gain320 => tuning.gain_320_db = value,
            Self::Compression => tuning.compression = value,
        }
    }
}

/// Real or generated.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Judging {
    /// The condition of stimuli that count as real.
    pub real: String,
    /// One at a time, or two side by side.
    pub protocol: JudgingProtocol,
    /// How often every stimulus comes.
    #[serde(default = "count::<1>")]
    pub repeats: usize,
    /// Grades of confidence that are asked for; 0 asks for none.
    #[serde(default)]
    pub confidence_grades: u8,
}

named! { "protocol",
    /// How stimuli are judged.
    pub enum JudgingProtocol {
        /// One at a time: real or generated?
        Single = "single",
        /// The real and a generated one of a material: which is real?
        Pair = "pair",
    }
}

/// Thresholds and just noticeable differences at one carrier.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// The carrier.
    pub band: Band,
    /// Intervals of a trial, 2 to 8; one of them holds the signal.
    pub intervals: usize,
    /// What the other intervals hold, dB re 1 µm; `None` is nothing, which asks for a threshold.
    pub reference_db: Option<f64>,
    /// Length of an interval, ms.
    pub(crate) interval_ms: u32,
    /// The lowest and the highest level that may come, dB re 1 µm.
    pub range_db: [f64; 2],
    /// How the next level is found.
    pub track: Track,
    /// When a series ends.
    pub stopping: Stopping,
}

impl Levels {
    /// The number that the psychometric function is of: the level, dB re 1 µm, or its difference
    /// from the reference, dB.
    pub fn stimulus(&self, level_db: f64) -> f64 {
        level_db - self.reference_db.unwrap_or(0.0)
    }

    /// The level of that number, dB re 1 µm.
    pub fn level_db(&self, stimulus: f64) -> f64 {
        stimulus + self.reference_db.unwrap_or(0.0)
    }

    /// The psychometric function's shape: Weibull of amplitude for a threshold, which is Gumbel in
    /// dB; Weibull of the difference where there is a reference, since no difference is not felt.
    pub fn family(&self) -> Family {
        match self.reference_db {
            None => Family::Gumbel,
            Some(_) => Family::Weibull,
        }
    }
}

/// How the next level is found.
#[derive(Debug, Clone, PartialEq)]
pub enum Track {
    /// Down after so many right answers, up after so many wrong ones.
    Staircase(StaircaseTrack),
    /// The level that is expected to teach most.
    QuestPlus(QuestPlusTrack),
    /// The same levels for everybody, each as often.
    Constant {
        /// The levels, dB re 1 µm.
        levels_db: Vec<f64>,
        /// How often each comes.
        repeats: usize,
    },
}

/// QUEST+ over a grid of thresholds, widths and lapses.
#[derive(Debug, Clone, PartialEq)]
pub struct QuestPlusTrack {
    /// Step of levels and thresholds over the range, dB.
    pub(crate) grid_db: f64,
    /// Widths of the psychometric function, from 5 to 95 %: dB for a threshold, natural logarithms
    /// of the difference for one from a reference.
    pub widths: Vec<f64>,
    /// Shares of lapses.
    pub lapses: Vec<f64>,
}

/// Interleaved staircases.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaircaseTrack {
    /// Wrong answers before it goes up.
    pub up: u32,
    /// Right answers before it goes down.
    pub down: u32,
    /// Steps downwards, dB: the first until the first reversal, then the next; the last stays.
    pub(crate) steps_db: Vec<f64>,
    /// Steps upwards over steps downwards.
    #[serde(default = "unity")]
    pub(crate) up_over_down: f64,
    /// Where each of the interleaved series begins, dB re 1 µm.
    pub(crate) starts_db: Vec<f64>,
    /// The last reversals that the threshold is the mean of; an even number.
    #[serde(default = "count::<6>")]
    pub(crate) reversals_averaged: usize,
}

impl StaircaseTrack {
    /// The rule of steps.
    pub fn rule(&self) -> Rule {
        Rule {
            n_up: self.up,
            m_down: self.down,
        }
    }

    /// A series that begins at a level, dB re 1 µm, and stays between limits.
    pub fn plan(&self, start_db: f64, limits_db: [f64; 2], stop: Stop) -> StaircasePlan {
        let stage = |&down: &f64| Stage {
            up: down * self.up_over_down,
            down,
            n_reversals: 1,
        };
        StaircasePlan {
            rule: self.rule(),
            scale: StepScale::Linear,
            start: start_db,
            stages: self.steps_db.iter().map(stage).collect(),
            limits: limits_db,
            stop,
        }
    }
}

/// When a series ends; what is 0 does not end it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Stopping {
    /// After so many trials.
    pub trials: usize,
    /// After so many reversals.
    pub reversals: usize,
    /// Once the threshold's posterior standard deviation is below this, dB.
    pub(crate) posterior_sd_db: f64,
    /// Which of those that are stated have to hold.
    pub(crate) needs: Needs,
}

named! { "needs",
    /// Which of several conditions have to hold.
    #[derive(Default)]
    pub(crate) enum Needs {
        /// One of them.
        #[default]
        Any = "any",
        /// All of them.
        All = "all",
    }
}

/// Rating scales.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rating {
    /// How often every stimulus comes.
    #[serde(default = "count::<1>")]
    pub repeats: usize,
    /// The scales, asked together.
    #[serde(rename = "scale")]
    pub scales: Vec<Scale>,
}

/// One scale.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// Its name in logs: letters, digits and `_`.
    pub key: String,
    /// What stands at its low end.
    pub low: String,
    /// What stands at its high end.
    pub high: String,
    /// Its points from 1; 0 is a line from 0 to 100 without points.
    #[serde(default)]
    pub points: u8,
}

impl Scale {
    /// The lowest and the highest answer.
    pub fn bounds(&self) -> [f64; 2] {
        match self.points {
            0 => [0.0, 100.0],
            points => [1.0, f64::from(points)],
        }
    }
}

pub(super) fn count<const N: usize>() -> usize {
    N
}

pub(super) fn unity() -> f64 {
    1.0
}

fn grade_weights() -> [f64; 3] {
    [1.0, 0.5, 0.1]
}
