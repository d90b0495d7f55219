//! What was called real, stimulus by stimulus.

use crate::{Answer, Record, Task};

/// Whether one stimulus was called real. A pair says it of both of its own.
pub(crate) struct Judgement {
    pub item: usize,
    pub is_real: bool,
    pub called_real: bool,
    pub confidence: Option<u8>,
}

/// The judgements of a trial; none of another task or without an answer.
pub(crate) fn judgements(record: &Record) -> Vec<Judgement> {
    match (&record.trial.task, record.answer()) {
        (
            Task::Judge { item, is_real },
            Some(Answer::Judged {
                is_real: called,
                confidence,
            }),
        ) => {
            vec![Judgement {
                item: *item,
                is_real: *is_real,
                called_real: *called,
                confidence: *confidence,
            }]
        }
        (
            Task::JudgePair { items, real },
            Some(Answer::Chosen {
                position,
                confidence,
            }),
        ) => {
            let of = |at: usize| Judgement {
                item: items[at],
                is_real: at == *real,
                called_real: at == *position,
                confidence: *confidence,
            };
            vec![of(0), of(1)]
        }
        _ => Vec::new(),
    }
}
