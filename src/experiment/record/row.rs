//! What of a record goes into the cells of its row.

use std::slice::from_ref;

use super::Record;
use crate::design::{Design, Method, Subject};
use crate::trial::{Adjustment, Answer, Grade, Task};
use selvedge_foundation::files::push_number;

/// A row and what it belongs to.
pub(super) struct Row<'a> {
    pub(super) record: &'a Record,
    pub(super) design: &'a Design,
    pub(super) subject: &'a Subject,
    pub(super) presented: Presented<'a>,
    pub(super) answered: Answered<'a>,
}

/// What of a trial goes into columns.
#[derive(Default)]
pub(super) struct Presented<'a> {
    /// Stimuli by their numbers.
    pub(super) items: &'a [usize],
    pub(super) target: Option<usize>,
    /// Where the right answer is.
    pub(super) right: Option<usize>,
    pub(super) is_real: Option<bool>,
    pub(super) track: Option<usize>,
    pub(super) level_db: Option<f64>,
    pub(super) starts: &'a [f64],
}

fn presented(task: &Task) -> Presented<'_> {
    let none = Presented::default();
    match task {
        Task::Rank {
            target,
            alternatives,
        } => Presented {
            items: alternatives,
            target: Some(*target),
            right: alternatives.iter().position(|at| at == target),
            ..none
        },
        Task::OddOne { items, odd } => Presented {
            items,
            right: Some(*odd),
            ..none
        },
        Task::JudgePair { items, real } => Presented {
            items,
            right: Some(*real),
            ..none
        },
        Task::Adjust { item, starts } => Presented {
            items: from_ref(item),
            starts,
            ..none
        },
        Task::Judge { item, is_real } => Presented {
            items: from_ref(item),
            is_real: Some(*is_real),
            ..none
        },
        Task::Interval {
            track,
            level_db,
            signal,
        } => Presented {
            track: Some(*track),
            level_db: Some(*level_db),
            right: Some(*signal),
            ..none
        },
        Task::Estimate { item } | Task::Rate { item } => Presented {
            items: from_ref(item),
            ..none
        },
    }
}

/// What of an answer goes into columns.
#[derive(Default)]
pub(super) struct Answered<'a> {
    pub(super) response: String,
    pub(super) confidence: Option<u8>,
    pub(super) ranks: &'a [u8],
    pub(super) grade: Option<Grade>,
    /// Settings of parameters, or places on scales.
    pub(super) values: &'a [f64],
    pub(super) steps: &'a [Adjustment],
}

fn answered(answer: &Answer) -> Answered<'_> {
    let mut found = Answered::default();
    match answer {
        Answer::Ranks(ranks) => {
            found.ranks = ranks;
            let first = ranks.iter().position(|&rank| rank == 1);
            found.response = first.map_or_else(String::new, position);
        }
        Answer::Odd {
            position: at,
            grade,
        } => {
            found.response = position(*at);
            found.grade = Some(*grade);
        }
        Answer::Judged {
            is_real,
            confidence,
        } => {
            (if *is_real { "real" } else { "generated" }).clone_into(&mut found.response);
            found.confidence = *confidence;
        }
        Answer::Chosen {
            position: at,
            confidence,
        } => {
            found.response = position(*at);
            found.confidence = *confidence;
        }
        Answer::Magnitude(value) => found.response = number(*value),
        Answer::Adjusted { values, steps } => (found.values, found.steps) = (values, steps),
        Answer::Ratings(values) => found.values = values,
    }
    found
}

pub(super) fn id(row: &Row<'_>, nth: usize) -> String {
    row.id_of(row.presented.items.get(nth).copied())
}

pub(super) fn right(row: &Row<'_>, _: usize) -> String {
    row.presented.right.map_or_else(String::new, position)
}

pub(super) fn value(row: &Row<'_>, nth: usize) -> String {
    number_at(row.answered.values, nth)
}

impl<'a> Row<'a> {
    pub(super) fn of(record: &'a Record, design: &'a Design, subject: &'a Subject) -> Self {
        Self {
            record,
            design,
            subject,
            presented: presented(&record.trial.task),
            answered: record.answer().map(answered).unwrap_or_default(),
        }
    }

    pub(super) fn id_of(&self, item: Option<usize>) -> String {
        let found = item.and_then(|item| self.design.stimuli.get(item));
        text(found.map(|stimulus| &stimulus.id))
    }

    pub(super) fn steps(&self) -> String {
        let Method::Adjustment(adjusting) = &self.design.method else {
            return String::new();
        };
        let texts = self.answered.steps.iter().filter_map(|step| {
            let key = adjusting.parameters.get(step.parameter)?.what.name();
            let (at_ms, value) = (number(step.at_ms), number(step.value));
            Some(format!("{at_ms}:{key}={value}"))
        });
        texts.collect::<Vec<_>>().join("; ")
    }
}

pub(super) fn text(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

pub(super) fn flag(is_so: bool) -> String {
    u8::from(is_so).to_string()
}

pub(super) fn position(at: usize) -> String {
    (at + 1).to_string()
}

pub(super) fn number(value: f64) -> String {
    let mut text = String::new();
    push_number(&mut text, value);
    text
}

pub(super) fn number_at(values: &[f64], nth: usize) -> String {
    values
        .get(nth)
        .map_or_else(String::new, |&value| number(value))
}
