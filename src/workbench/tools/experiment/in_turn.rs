//! What a trial plays one after the other: vibrations, or textiles at one place; and which of them
//! is felt now.

use crate::tools::experiment::active_session::ActiveSession;
use selvedge_engine::{Played, SequenceStep};
use selvedge_experiment::Task;
use selvedge_experiment::design::Design;
use selvedge_experiment::layout;

/// Silence before the first interval of a trial, ticks.
const LEAD_TICKS: u32 = 24;
/// Steps of a sequence before those of the task: that silence.
pub(crate) const LEAD_STEPS: u16 = 1;

/// The intervals of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Intervals {
    /// How many there are.
    pub(crate) n: usize,
    /// Whether the first is what the others are compared with, and has no number.
    pub(crate) is_compared: bool,
    /// Which is felt now, from 0.
    pub(crate) played: Option<usize>,
}

impl Intervals {
    /// Those of a task, before any; `None` where all is felt at once.
    pub(crate) fn of(design: &Design, task: &Task) -> Option<Self> {
        // A pause lies between each two.
        let n_steps = layout::sequence(design, task).len();
        (n_steps > 0).then_some(Self {
            n: n_steps.div_ceil(2),
            is_compared: task.reference.is_some(),
            played: None,
        })
    }

    /// The number of an interval; `None` for one that has none or is alone.
    pub(crate) fn number(&self, interval: usize) -> Option<usize> {
        let n_before = usize::from(self.is_compared);
        let number = (interval + 1).checked_sub(n_before)?;
        Some(number).filter(|number| *number > 0 && self.n - n_before > 1)
    }
}

impl ActiveSession {
    /// What is played at the beginning of this trial: silence first. Textiles are covered again
    /// until the next trial.
    pub(crate) fn sequence(&self) -> Vec<SequenceStep> {
        let Some(trial) = self.trial() else {
            return Vec::new();
        };
        let steps = layout::sequence(&self.design, &trial.task);
        if steps.is_empty() {
            return steps;
        }
        let lead = SequenceStep::silence(LEAD_TICKS);
        let played = std::iter::once(lead).chain(steps);
        played.chain(self.after_sequence()).collect()
    }

    /// What is played once a trial is over and nothing else lies there yet: silence, where
    /// textiles lie upon each other.
    pub(crate) fn after_sequence(&self) -> Option<SequenceStep> {
        let is_stacked = self.layout.is_stacked();
        is_stacked.then(|| SequenceStep::silence(SequenceStep::UNTIL_NEXT))
    }

    /// The intervals of the trial that is shown, and which is felt now.
    pub(crate) fn intervals(&self) -> Option<Intervals> {
        let intervals = Intervals::of(&self.design, &self.trial()?.task)?;
        let step = self
            .sequence_step
            .and_then(|step| step.checked_sub(LEAD_STEPS));
        let is_interval =
            |step: &u16| step.is_multiple_of(2) && usize::from(*step) < 2 * intervals.n;
        let played = step.filter(is_interval).map(|step| usize::from(step / 2));
        Some(Intervals {
            played,
            ..intervals
        })
    }

    /// Whether vibrations may be played again: where their strength is asked, once they are over.
    /// Textiles are felt once: a trial in which one was not is presented again.
    pub(crate) fn may_play_again(&self) -> bool {
        let is_vibration = |step: &SequenceStep| matches!(step.played, Played::Vibration(_));
        let steps = self.sequence();
        let is_adapted = self.design.composition.adaptation.is_some();
        let is_over = self.sequence_step.is_none();
        !steps.is_empty() && steps.iter().all(is_vibration) && is_over && !is_adapted
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_others_are_compared_with_has_no_number_nor_has_one_alone() {
        let numbers = |n, is_compared| {
            let intervals = Intervals {
                n,
                is_compared,
                played: None,
            };
            (0..n).map(|at| intervals.number(at)).collect::<Vec<_>>()
        };
        assert_eq!(numbers(2, false), [Some(1), Some(2)]);
        assert_eq!(numbers(3, true), [None, Some(1), Some(2)]);
        assert_eq!(numbers(1, false), [None]);
        assert_eq!(numbers(2, true), [None, None]);
    }
}
