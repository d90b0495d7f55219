//! A staircase: steps down after right answers, up after wrong ones.

use super::{Procedure, Reached, Rule, Stop, Trial, over};
use crate::summary::{centred, sum_of_squares};
use crate::{Computed, Undefined, undefined};

/// Steps of one size, in the unit of the stimulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// How far up.
    pub up: f64,
    /// How far down.
    pub down: f64,
    /// Reversals that end the stage; of the last stage of a plan it says nothing.
    pub n_reversals: u32,
}

/// What a staircase does.
#[derive(Debug, Clone, PartialEq)]
pub struct StaircasePlan {
    /// When it moves.
    pub rule: Rule,
    /// Its first stimulus.
    pub start: f64,
    /// Its steps, stage after stage.
    pub stages: Vec<Stage>,
    /// The weakest and the strongest stimulus.
    pub limits: [f64; 2],
    /// When it is over.
    pub stop: Stop,
}

impl StaircasePlan {
    /// Equal steps throughout.
    pub fn steady(rule: Rule, start: f64, [up, down]: [f64; 2]) -> Self {
        Self {
            rule,
            start,
            stages: vec![Stage {
                up,
                down,
                n_reversals: 0,
            }],
            limits: [f64::MIN, f64::MAX],
            stop: Stop::Any(vec![Stop::Trials(200), Stop::Reversals(12)]),
        }
    }

    /// The share right at which the steps of the last stage balance.
    ///
    /// # Errors
    /// No stage, steps that are not above zero.
    pub fn target(&self) -> Computed {
        let last = self
            .stages
            .last()
            .ok_or_else(|| Undefined::because("no steps"))?;
        self.rule.target(last.up, last.down)
    }

    fn check(&self) -> Computed<()> {
        self.target()?;
        for (number, stage) in (1..).zip(&self.stages) {
            let is_stepping = stage.up > 0.0 && stage.down > 0.0;
            if !(is_stepping && (stage.up + stage.down).is_finite()) {
                let Stage { up, down, .. } = stage;
                let reason = format!("stage {number} has steps of {up} up and {down} down");
                return undefined(reason);
            }
        }
        let [low, high] = self.limits;
        let is_placed = [low, self.start, high].into_iter().all(f64::is_finite);
        if !(low < high && (low..=high).contains(&self.start) && is_placed) {
            let start = self.start;
            let reason = format!("a start of {start} between limits of {low} and {high}");
            return undefined(reason);
        }
        self.stop.check(&Reached {
            n_reversals: Some(0),
            ..Reached::default()
        })
    }
}

/// Where a staircase turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reversal {
    /// The trial after which it turned, from 0.
    pub trial: usize,
    /// The stimulus from which it turned.
    pub stimulus: f64,
    /// The stage it was in.
    pub stage: usize,
}

/// A limit of the stimulus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Limit {
    /// The weakest.
    Low,
    /// The strongest.
    High,
}

/// A threshold from reversals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReversalMean {
    /// The mean of the stimuli: geometric where steps are of logarithms.
    pub threshold: f64,
    /// Standard deviation of the reversals by n − 1, in the unit of the scale.
    pub sd: f64,
    /// Reversals that entered, an even number.
    pub n_reversals: usize,
    /// The share right that they are the threshold of.
    pub target: f64,
}

/// A staircase as far as it came.
#[derive(Debug, Clone, PartialEq)]
pub struct Staircase {
    plan: StaircasePlan,
    place: f64,
    stage: usize,
    n_turns_of_stage: u32,
    n_right: u32,
    n_wrong: u32,
    /// Whether the last move was down.
    went_down: Option<bool>,
    trials: Vec<Trial>,
    reversals: Vec<Reversal>,
    n_clamped: [u32; 2],
}

impl Staircase {
    /// At its start.
    ///
    /// # Errors
    /// No rule, no steps or steps that are not above zero, a start outside the limits, limits
    /// without a logarithm where steps are of one, a rule to stop that cannot come true.
    pub fn new(plan: StaircasePlan) -> Computed<Self> {
        plan.check()?;
        Ok(Self {
            place: plan.start,
            plan,
            stage: 0,
            n_turns_of_stage: 0,
            n_right: 0,
            n_wrong: 0,
            went_down: None,
            trials: Vec::new(),
            reversals: Vec::new(),
            n_clamped: [0; 2],
        })
    }

    /// What it does.
    pub fn plan(&self) -> &StaircasePlan {
        &self.plan
    }

    /// Where it turned.
    pub fn reversals(&self) -> &[Reversal] {
        &self.reversals
    }

    /// How often a step was cut short at a limit.
    pub(crate) fn n_clamped(&self, limit: Limit) -> u32 {
        self.n_clamped[usize::from(limit == Limit::High)]
    }

    /// What a reader has to know: steps that a limit cut short.
    pub fn warnings(&self) -> Vec<String> {
        let warning = |limit: Limit| {
            let n = self.n_clamped(limit);
            let (name, stimulus) = match limit {
                Limit::Low => ("lower", self.plan.limits[0]),
                Limit::High => ("upper", self.plan.limits[1]),
            };
            (n > 0).then(|| {
                let of = if n == 1 { "a step was" } else { "steps were" };
                format!(
                    "{n} {of} cut short at the {name} limit {stimulus}: the threshold is biased"
                )
            })
        };
        [Limit::Low, Limit::High]
            .into_iter()
            .filter_map(warning)
            .collect()
    }

    /// The threshold from the last reversals, at most `n_last` and an even number of them, those
    /// of the last stage alone.
    ///
    /// # Errors
    /// Fewer than two.
    pub fn reversal_mean(&self, n_last: usize) -> Computed<ReversalMean> {
        let last_stage = self.plan.stages.len() - 1;
        let kept = self.reversals.iter().filter(|r| r.stage == last_stage);
        let mut places: Vec<f64> = kept.map(|r| r.stimulus).collect();
        let n_reversals = places.len().min(n_last) / 2 * 2;
        if n_reversals < 2 {
            let found = places.len();
            let reason = format!("{found} reversals with the last steps, two or more are needed");
            return undefined(reason);
        }
        let (mean, deviations) = centred(&places.split_off(places.len() - n_reversals));
        let variance = sum_of_squares(&deviations) / (n_reversals as f64 - 1.0);
        Ok(ReversalMean {
            threshold: mean,
            sd: variance.sqrt(),
            n_reversals,
            target: self.plan.target()?,
        })
    }

    /// How far it is.
    pub(crate) fn reached(&self) -> Reached {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Reached {
            n_trials: count(self.trials.len()),
            n_reversals: Some(count(self.reversals.len())),
            posterior_sd: None,
        }
    }

    fn step(&mut self, is_down: bool) {
        (self.n_right, self.n_wrong) = (0, 0);
        if self.went_down.is_some_and(|before| before != is_down) {
            self.turn();
        }
        self.went_down = Some(is_down);
        let stage = &self.plan.stages[self.stage];
        let wanted = self.place + if is_down { -stage.down } else { stage.up };
        let limits = self.plan.limits;
        self.place = wanted.clamp(limits[0], limits[1]);
        let is_cut = [wanted < limits[0], wanted > limits[1]];
        for (n, is_cut) in self.n_clamped.iter_mut().zip(is_cut) {
            *n += u32::from(is_cut);
        }
    }

    fn turn(&mut self) {
        self.reversals.push(Reversal {
            trial: self.trials.len() - 1,
            stimulus: self.asked(),
            stage: self.stage,
        });
        self.n_turns_of_stage += 1;
        let is_last = self.stage + 1 == self.plan.stages.len();
        if !is_last && self.n_turns_of_stage >= self.plan.stages[self.stage].n_reversals {
            self.stage += 1;
            self.n_turns_of_stage = 0;
        }
    }

    fn asked(&self) -> f64 {
        let [low, high] = self.plan.limits;
        self.place.clamp(low, high)
    }
}

impl Procedure for Staircase {
    fn stimulus(&self) -> Option<f64> {
        (!self.plan.stop.is_met(&self.reached())).then(|| self.asked())
    }

    fn answer(&mut self, presented: f64, is_right: bool) -> Computed<()> {
        let asked = self.stimulus().ok_or_else(over)?;
        if !presented.is_finite() {
            let reason = format!("a stimulus of {presented} has no place among steps");
            return undefined(reason);
        }
        self.trials.push(Trial {
            asked,
            presented,
            is_right,
        });
        if is_right {
            (self.n_right, self.n_wrong) = (self.n_right + 1, 0);
        } else {
            (self.n_right, self.n_wrong) = (0, self.n_wrong + 1);
        }
        if self.n_right >= self.plan.rule.m_down {
            self.step(true);
        } else if self.n_wrong >= self.plan.rule.n_up {
            self.step(false);
        }
        Ok(())
    }

    fn trials(&self) -> &[Trial] {
        &self.trials
    }
}
