//! Answers as they were given: rankings, odd ones of triads, what was called real.

use super::included_trials::{Experiment, Subject};
use crate::{AnswerValue, Record, Task};
use selvedge_statistics::ranking::{Grade, RankTrial, TriadAnswer};

/// The share of guesses that rank the target first, %.
pub(super) const CHANCE_PERCENT: f64 = 25.0;

/// A subject's rankings.
pub(super) struct Rankings<'a> {
    pub(super) subject: &'a str,
    pub(super) trials: Vec<RankTrial>,
}

impl Rankings<'_> {
    pub(super) fn n_first(&self) -> u64 {
        let is_first = |trial: &&RankTrial| rank_of_target(trial) == Some(1);
        self.trials.iter().filter(is_first).count() as u64
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
    let Some(AnswerValue::Ranks(ranks)) = record.value() else {
        return None;
    };
    Some(RankTrial {
        target: record.trial.task.reference?,
        alternatives: record.trial.task.items.clone(),
        ranks: ranks.iter().map(|rank| usize::from(*rank)).collect(),
    })
}

/// The answer to a triad.
pub(crate) fn triad_answer(record: &Record) -> Option<TriadAnswer> {
    let Task { items, right, .. } = &record.trial.task;
    let odd = (*right)?;
    let grade = usize::from(record.answer()?.confidence?).checked_sub(1)?;
    Some(TriadAnswer {
        pair: [*items.get(odd)?, *items.get((odd + 1) % items.len())?],
        is_correct: record.is_correct?,
        grade: *Grade::ALL.get(grade)?,
    })
}

pub(super) fn triads(subject: &Subject<'_>) -> Vec<TriadAnswer> {
    subject.trials().filter_map(triad_answer).collect()
}

pub(super) fn n_right(answers: &[TriadAnswer]) -> u64 {
    answers.iter().filter(|a| a.is_correct).count() as u64
}

pub(super) fn percent(answers: &[TriadAnswer]) -> f64 {
    100.0 * n_right(answers) as f64 / answers.len() as f64
}

/// Whether one stimulus was called real. A pair says it of both of its own.
pub(super) struct Judgement {
    pub(super) item: usize,
    pub(super) is_real: bool,
    pub(super) called_real: bool,
    pub(super) confidence: Option<u8>,
}

/// The judgements of a trial; none of another task or without an answer.
pub(super) fn judgements(record: &Record) -> Vec<Judgement> {
    let Task { items, right, .. } = &record.trial.task;
    let (Some(right), Some(AnswerValue::Chosen(chosen))) = (right, record.value()) else {
        return Vec::new();
    };
    let confidence = record.answer().and_then(|answer| answer.confidence);
    // Of one alone the first word is the one that calls it real.
    let of = |(at, item): (usize, &usize)| Judgement {
        item: *item,
        is_real: at == *right,
        called_real: at == *chosen,
        confidence,
    };
    items.iter().enumerate().map(of).collect()
}
