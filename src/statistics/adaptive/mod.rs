//! Which stimulus comes next: staircases, QUEST+ and constant stimuli as pure state machines.
//!
//! ```text
//! stimulus() ─▶ present ─▶ answer(presented, right?) ─▶ stimulus() … None when the rule stops it
//! ```
//!
//! # Invariants
//! - no clock and no chance but a seed: the same answers lead to the same stimuli
//! - what was presented is kept beside what was asked for, and estimates use the former
//! - when to stop is one expression that anybody can read, checked to come true at last

mod constant;
mod interleaved;
mod quest_plus;
mod rule;
mod staircase;
mod stop;
#[cfg(test)]
mod tests;

pub use constant::ConstantStimuli;
pub use interleaved::Interleaved;
pub use quest_plus::QuestSummary;
pub use quest_plus::Reckoned;
pub use quest_plus::{QuestGrid, QuestPlus};
pub use rule::Rule;
#[cfg(test)]
pub(crate) use staircase::Limit;
pub use staircase::Reversal;
pub use staircase::{ReversalMean, Stage, Staircase, StaircasePlan};
pub(crate) use stop::Reached;
pub use stop::Stop;

use super::Computed;
use super::psychometric::Block;
use crate::Undefined;

/// One trial of an adaptive procedure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// The stimulus that was asked for.
    pub asked: f64,
    /// The stimulus that was presented.
    pub presented: f64,
    /// Whether the answer was right, or yes.
    pub is_right: bool,
}

/// What chooses stimuli.
pub trait Procedure {
    /// The stimulus of the next trial; `None` when the procedure is over.
    fn stimulus(&self) -> Option<f64>;

    /// Takes the answer to the next trial, with the stimulus that was in fact presented.
    ///
    /// # Errors
    /// The procedure is over, or the stimulus is not one that it could have meant.
    fn answer(&mut self, presented: f64, is_right: bool) -> Computed<()>;

    /// The trials so far.
    fn trials(&self) -> &[Trial];

    /// The trials so far by presented stimulus, for a fit.
    fn blocks(&self) -> Vec<Block> {
        Block::of_trials(
            self.trials()
                .iter()
                .map(|trial| (trial.presented, trial.is_right)),
        )
    }
}

impl<P: Procedure + ?Sized> Procedure for Box<P> {
    fn stimulus(&self) -> Option<f64> {
        (**self).stimulus()
    }

    fn answer(&mut self, presented: f64, is_right: bool) -> Computed<()> {
        (**self).answer(presented, is_right)
    }

    fn trials(&self) -> &[Trial] {
        (**self).trials()
    }
}

fn over() -> Undefined {
    Undefined::because("the procedure is over: no answer is waited for")
}
