//! The odd ones that were chosen, as they were given.

use super::included_trials::Subject;
use crate::{Answer, Record, Task};
use selvedge_statistics::ranking::{Grade, GradeWeights, TriadAnswer};

/// The answer to a triad.
pub(crate) fn triad_answer(record: &Record) -> Option<TriadAnswer> {
    let (Task::OddOne { items, odd }, Some(Answer::Odd { grade, .. })) =
        (&record.trial.task, record.answer())
    else {
        return None;
    };
    Some(TriadAnswer {
        pair: [items[*odd], items[(*odd + 1) % items.len()]],
        is_correct: record.is_correct?,
        grade: match grade {
            crate::Grade::Easy => Grade::Easy,
            crate::Grade::Normal => Grade::Normal,
            crate::Grade::Hard => Grade::Hard,
        },
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

pub(crate) fn grade_weights([easy, normal, hard]: [f64; 3]) -> GradeWeights {
    GradeWeights { easy, normal, hard }
}
