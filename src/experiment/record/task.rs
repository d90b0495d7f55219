//! The columns of each method: what was presented, and answers of several numbers.

use super::{Method, number, position};
use crate::experiment::design::{Design, JudgingProtocol};
use crate::experiment::trial::{Adjustment, Answer, Task};

/// The columns of a method, each with what it holds.
pub(super) fn columns(method: &Method) -> Vec<(String, String)> {
    let owned = |(name, what): (&str, &str)| (name.to_owned(), what.to_owned());
    let item = [
        ("item", "the stimulus"),
        ("condition", "the stimulus's condition"),
    ];
    match method {
        Method::Ranking(_) => {
            let mut columns = vec![owned(("target", "the target"))];
            columns.extend((1..=4).map(|n| (format!("alt{n}"), format!("alternative {n}"))));
            columns.push(owned(("position_correct", "where the target was, from 1")));
            columns.extend((1..=4).map(|n| {
                (
                    format!("rank{n}"),
                    format!("rank of alternative {n}, 1 most alike"),
                )
            }));
            columns
        }
        Method::OddOneOut(_) => {
            let mut columns: Vec<_> = (1..=3)
                .map(|n| (format!("item{n}"), format!("stimulus {n}")))
                .collect();
            columns.push(owned(("position_odd", "where the odd one was, from 1")));
            columns.push(owned(("grade", "easy, normal or hard")));
            columns
        }
        Method::Adjustment(adjusting) => {
            let mut columns: Vec<_> = item.into_iter().map(owned).collect();
            for parameter in &adjusting.parameters {
                let key = parameter.what.name();
                columns.push((format!("start_{key}"), format!("{key} at the beginning")));
                columns.push((format!("value_{key}"), format!("{key} as it was left")));
            }
            columns.push(owned((
                "steps",
                "every change: ms since the beginning:key=value; …",
            )));
            columns
        }
        Method::Judgement(judging) => match judging.protocol {
            JudgingProtocol::Single => {
                let mut columns: Vec<_> = item.into_iter().map(owned).collect();
                columns.push(owned((
                    "is_real",
                    "1 for a real one, 0 for a generated one",
                )));
                columns
            }
            JudgingProtocol::Pair => [
                ("item1", "stimulus 1"),
                ("item2", "stimulus 2"),
                ("position_real", "where the real one was, from 1"),
            ]
            .map(owned)
            .to_vec(),
        },
        Method::Levels(_) => [
            ("track", "which of the interleaved series, from 1"),
            ("level_db", "level of the signal, dB re 1 µm"),
            ("interval_signal", "which interval held it, from 1"),
        ]
        .map(owned)
        .to_vec(),
        Method::Magnitude { .. } => item.into_iter().map(owned).collect(),
        Method::Rating(rating) => {
            let mut columns: Vec<_> = item.into_iter().map(owned).collect();
            columns.extend(rating.scales.iter().map(|scale| {
                let what = format!(
                    "from {} ({}) to {}",
                    scale.low,
                    scale.bounds()[0],
                    scale.high
                );
                (format!("rating_{}", scale.key), what)
            }));
            columns
        }
    }
}

/// The cells of a trial, in the order of [`columns`].
pub(super) fn cells(design: &Design, task: &Task, answer: Option<&Answer>) -> Vec<String> {
    let id = |item: usize| {
        let stimulus = design.stimuli.get(item);
        stimulus.map_or_else(String::new, |stimulus| stimulus.id.clone())
    };
    let condition = |item: usize| {
        let stimulus = design.stimuli.get(item);
        stimulus.map_or_else(String::new, |stimulus| stimulus.condition.clone())
    };
    match task {
        Task::Rank {
            target,
            alternatives,
        } => {
            let mut cells = vec![id(*target)];
            cells.extend(alternatives.iter().copied().map(id));
            let correct = alternatives.iter().position(|at| at == target);
            cells.push(correct.map_or_else(String::new, position));
            let ranks = match answer {
                Some(Answer::Ranks(ranks)) => ranks.map(|rank| rank.to_string()),
                _ => Default::default(),
            };
            cells.extend(ranks);
            cells
        }
        Task::OddOne { items, odd } => {
            let mut cells: Vec<String> = items.iter().copied().map(id).collect();
            cells.push(position(*odd));
            cells.push(match answer {
                Some(Answer::Odd { grade, .. }) => grade.name().to_owned(),
                _ => String::new(),
            });
            cells
        }
        Task::Adjust { item, starts } => {
            let mut cells = vec![id(*item), condition(*item)];
            let (values, steps) = match answer {
                Some(Answer::Adjusted { values, steps }) => (values.as_slice(), steps.as_slice()),
                _ => Default::default(),
            };
            for (at, start) in starts.iter().enumerate() {
                cells.push(number(*start));
                cells.push(
                    values
                        .get(at)
                        .map_or_else(String::new, |value| number(*value)),
                );
            }
            cells.push(told_steps(design, steps));
            cells
        }
        Task::Judge { item, is_real } => vec![id(*item), condition(*item), super::flag(*is_real)],
        Task::JudgePair { items, real } => vec![id(items[0]), id(items[1]), position(*real)],
        Task::Interval {
            track,
            level_db,
            signal,
        } => vec![position(*track), number(*level_db), position(*signal)],
        Task::Estimate { item } => vec![id(*item), condition(*item)],
        Task::Rate { item } => {
            let mut cells = vec![id(*item), condition(*item)];
            let Method::Rating(rating) = &design.method else {
                return cells;
            };
            let ratings = match answer {
                Some(Answer::Ratings(ratings)) => ratings.as_slice(),
                _ => &[],
            };
            let cell = |at: usize| {
                ratings
                    .get(at)
                    .map_or_else(String::new, |&value| number(value))
            };
            cells.extend((0..rating.scales.len()).map(cell));
            cells
        }
    }
}

fn told_steps(design: &Design, steps: &[Adjustment]) -> String {
    let Method::Adjustment(adjusting) = &design.method else {
        return String::new();
    };
    let told = steps.iter().filter_map(|step| {
        let key = adjusting.parameters.get(step.parameter)?.what.name();
        Some(format!(
            "{}:{key}={}",
            number(step.at_ms),
            number(step.value)
        ))
    });
    told.collect::<Vec<_>>().join("; ")
}
