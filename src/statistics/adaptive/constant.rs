//! Constant stimuli: every stimulus as often, in an order by chance.

use super::{Procedure, Trial, over};
use crate::{Computed, undefined};
use selvedge_foundation::numerics::Random;

/// The method of constant stimuli.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstantStimuli {
    order: Vec<f64>,
    trials: Vec<Trial>,
}

impl ConstantStimuli {
    /// Every stimulus once in each of `n_repeats` rounds, each round in an order of its own.
    ///
    /// # Errors
    /// No stimuli or rounds, a stimulus that is not finite.
    pub fn new(stimuli: &[f64], n_repeats: usize, seed: u64) -> Computed<Self> {
        if stimuli.is_empty() || n_repeats == 0 || stimuli.iter().any(|x| !x.is_finite()) {
            let n = stimuli.len();
            return undefined(format!("{n} stimuli {n_repeats} times, all of them finite"));
        }
        let mut random = Random::new(seed).branch("constant stimuli");
        let mut order = Vec::with_capacity(stimuli.len() * n_repeats);
        for _ in 0..n_repeats {
            let mut round = stimuli.to_vec();
            random.shuffle(&mut round);
            order.extend(round);
        }
        Ok(Self {
            order,
            trials: Vec::new(),
        })
    }
}

impl Procedure for ConstantStimuli {
    fn stimulus(&self) -> Option<f64> {
        self.order.get(self.trials.len()).copied()
    }

    fn answer(&mut self, presented: f64, is_right: bool) -> Computed<()> {
        let asked = self.stimulus().ok_or_else(over)?;
        if !presented.is_finite() {
            return undefined("the presented stimulus is not finite");
        }
        self.trials.push(Trial {
            asked,
            presented,
            is_right,
        });
        Ok(())
    }

    fn trials(&self) -> &[Trial] {
        &self.trials
    }
}
