//! Which number of a stimulus follows the answers, and how its next value is found.

use serde::Deserialize;

use super::parameter::Tunable;
use crate::named::named;
use selvedge_statistics::adaptive::{Rule, Stage, StaircasePlan, Stop};
use selvedge_statistics::psychometric::Family;
use selvedge_textile::tactile::Band;

/// A number of a stimulus that follows the answers, or takes stated values.
#[derive(Debug, Clone, PartialEq)]
pub struct Adaptation {
    /// Which.
    pub(crate) parameter: Tunable,
    /// The carrier of a vibration; low where cloth is felt.
    pub band: Band,
    /// Places or intervals of a trial, one of which has the value.
    pub(crate) alternatives: usize,
    /// What the others of a trial are at; `None` is nothing, which asks for a threshold.
    pub reference: Option<f64>,
    /// The lowest and the highest value that may come.
    pub range: [f64; 2],
    /// What is sought.
    pub seeks: Seeks,
    /// How the next value is found.
    pub(crate) track: Track,
    /// When a series ends.
    pub stopping: Stopping,
}

named! { "seeks",
    /// What an adaptation seeks.
    #[derive(Default)]
    pub enum Seeks {
        /// The least that is told from the reference, or from nothing: answers are right or wrong.
        #[default]
        Difference = "difference",
        /// What is called more as often as less, or yes as often as no: no answer is wrong.
        Equality = "equality",
    }
}

impl Adaptation {
    /// The number that the psychometric function is of: the value, or its difference from the
    /// reference.
    pub fn stimulus(&self, value: f64) -> f64 {
        value - self.reference.unwrap_or(0.0)
    }

    /// The value of that number.
    pub fn value(&self, stimulus: f64) -> f64 {
        stimulus + self.reference.unwrap_or(0.0)
    }

    /// The psychometric function's shape: Weibull of amplitude for a threshold, which is Gumbel in
    /// dB; Weibull of the difference where there is a reference, since no difference is not felt;
    /// normal where more is told from less.
    pub fn family(&self) -> Family {
        match (self.seeks, self.reference) {
            (Seeks::Equality, _) => Family::Normal,
            (Seeks::Difference, None) => Family::Gumbel,
            (Seeks::Difference, Some(_)) => Family::Weibull,
        }
    }

    /// Whether it is the level of a vibration.
    pub(crate) fn is_vibration(&self) -> bool {
        self.parameter == Tunable::Level
    }
}

/// How the next value is found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Track {
    /// Down after so many right answers, up after so many wrong ones.
    Staircase(StaircaseTrack),
    /// The value that is expected to teach most.
    QuestPlus(QuestPlusTrack),
    /// The same values for everybody, each as often.
    Constant {
        /// The values.
        values: Vec<f64>,
        /// How often each comes.
        repeats: usize,
    },
}

/// QUEST+ over a grid of thresholds, widths and lapses.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct QuestPlusTrack {
    /// Step of values and thresholds over the range.
    pub(crate) grid: f64,
    /// Widths of the psychometric function, from 5 to 95 %: of the value for a threshold, natural
    /// logarithms of the difference for one from a reference.
    pub widths: Vec<f64>,
    /// Shares of lapses.
    pub lapses: Vec<f64>,
}

/// Interleaved staircases.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StaircaseTrack {
    /// Wrong answers before it goes up.
    pub up: u32,
    /// Right answers before it goes down.
    pub down: u32,
    /// Steps downwards: the first until the first reversal, then the next; the last stays.
    #[serde(alias = "steps_db")]
    pub(crate) steps: Vec<f64>,
    /// Steps upwards over steps downwards.
    #[serde(default = "unity")]
    pub(crate) up_over_down: f64,
    /// Where each of the interleaved series begins.
    #[serde(alias = "starts_db")]
    pub(crate) starts: Vec<f64>,
    /// The last reversals that the threshold is the mean of; an even number.
    #[serde(default = "count::<6>")]
    pub(crate) reversals_averaged: usize,
}

impl StaircaseTrack {
    /// The rule of steps.
    pub(crate) fn rule(&self) -> Rule {
        Rule {
            n_up: self.up,
            m_down: self.down,
        }
    }

    /// A series that begins at a value and stays between limits.
    pub(crate) fn plan(&self, start: f64, limits: [f64; 2], stop: Stop) -> StaircasePlan {
        let stage = |&down: &f64| Stage {
            up: down * self.up_over_down,
            down,
            n_reversals: 1,
        };
        StaircasePlan {
            rule: self.rule(),
            start,
            stages: self.steps.iter().map(stage).collect(),
            limits,
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
    /// Once the threshold's posterior standard deviation is below this.
    #[serde(alias = "posterior_sd_db")]
    pub(crate) posterior_sd: f64,
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

pub(super) fn count<const N: usize>() -> usize {
    N
}

pub(super) fn unity() -> f64 {
    1.0
}
