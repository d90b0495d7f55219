//! Rankings against a target as they were given, subject by subject.

use super::included_trials::{Experiment, Subject};
use crate::{Answer, Record, Task};
use selvedge_statistics::ranking::RankTrial;

/// The share of guesses that rank the target first, %.
pub(super) const CHANCE_PERCENT: f64 = 25.0;

/// A subject's rankings.
pub(super) struct Rankings<'a> {
    pub(super) subject: &'a str,
    pub(super) trials: Vec<RankTrial>,
}

impl Rankings<'_> {
    pub(super) fn n_first(&self) -> u64 {
        self.trials
            .iter()
            .filter(|t| rank_of_target(t) == Some(1))
            .count() as u64
    }

    /// Targets ranked first, %.
    pub(super) fn percent(&self) -> f64 {
        100.0 * self.n_first() as f64 / self.trials.len() as f64
    }

    pub(super) fn mean_rank(&self) -> f64 {
        let sum: usize = self.trials.iter().filter_map(rank_of_target).sum();
        sum as f64 / self.trials.len() as f64
    }
}

fn rank_of_target(trial: &RankTrial) -> Option<usize> {
    let at = trial.alternatives.iter().position(|a| *a == trial.target)?;
    trial.ranks.get(at).copied()
}

/// The rankings of every subject.
pub(super) fn rankings<'a>(experiment: &Experiment<'a>) -> Vec<Rankings<'a>> {
    let of = |subject: &Subject<'a>| Rankings {
        subject: subject.name,
        trials: subject.trials().filter_map(rank_trial).collect(),
    };
    experiment.subjects.iter().map(of).collect()
}

/// A ranking as it was given; `None` of another task or without an answer.
pub(crate) fn rank_trial(record: &Record) -> Option<RankTrial> {
    let (
        Task::Rank {
            target,
            alternatives,
        },
        Some(Answer::Ranks(ranks)),
    ) = (&record.trial.task, record.answer())
    else {
        return None;
    };
    Some(RankTrial {
        target: *target,
        alternatives: alternatives.to_vec(),
        ranks: ranks.iter().map(|rank| usize::from(*rank)).collect(),
    })
}
