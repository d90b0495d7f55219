//! The columns of each method: what was presented, and answers of several numbers.

use super::{Method, flag, number, position};
use crate::design::{Adjusting, Design, JudgingProtocol, Rating, Stimulus};
use crate::trial::{Adjustment, Answer, Task};

type Column = (String, String);

const ITEM: [(&str, &str); 2] = [
    ("item", "the stimulus"),
    ("condition", "the stimulus's condition"),
];
const RANKED: [(&str, &str); 10] = [
    ("target", "the target"),
    ("alt1", "alternative 1"),
    ("alt2", "alternative 2"),
    ("alt3", "alternative 3"),
    ("alt4", "alternative 4"),
    ("position_correct", "where the target was, from 1"),
    ("rank1", "rank of alternative 1, 1 most alike"),
    ("rank2", "rank of alternative 2, 1 most alike"),
    ("rank3", "rank of alternative 3, 1 most alike"),
    ("rank4", "rank of alternative 4, 1 most alike"),
];
const TRIAD: [(&str, &str); 5] = [
    ("item1", "stimulus 1"),
    ("item2", "stimulus 2"),
    ("item3", "stimulus 3"),
    ("position_odd", "where the odd one was, from 1"),
    ("grade", "easy, normal or hard"),
];
const JUDGED: [(&str, &str); 3] = [
    ITEM[0],
    ITEM[1],
    ("is_real", "1 for a real one, 0 for a generated one"),
];
const PAIR: [(&str, &str); 3] = [
    ("item1", "stimulus 1"),
    ("item2", "stimulus 2"),
    ("position_real", "where the real one was, from 1"),
];
const LEVEL: [(&str, &str); 3] = [
    ("track", "which of the interleaved series, from 1"),
    ("level_db", "level of the signal, dB re 1 µm"),
    ("interval_signal", "which interval held it, from 1"),
];

/// The columns of a method, each with what it holds.
pub(super) fn columns(method: &Method) -> Vec<Column> {
    match method {
        Method::Ranking(_) => owned(&RANKED),
        Method::OddOneOut(_) => owned(&TRIAD),
        Method::Adjustment(adjusting) => adjusted_columns(adjusting),
        Method::Judgement(judging) => match judging.protocol {
            JudgingProtocol::Single => owned(&JUDGED),
            JudgingProtocol::Pair => owned(&PAIR),
        },
        Method::Levels(_) => owned(&LEVEL),
        Method::Magnitude { .. } => owned(&ITEM),
        Method::Rating(rating) => rating_columns(rating),
    }
}

fn owned(columns: &[(&str, &str)]) -> Vec<Column> {
    let owned = |&(name, what): &(&str, &str)| (name.to_owned(), what.to_owned());
    columns.iter().map(owned).collect()
}

fn adjusted_columns(adjusting: &Adjusting) -> Vec<Column> {
    let mut columns = owned(&ITEM);
    for parameter in &adjusting.parameters {
        let key = parameter.what.name();
        columns.push((format!("start_{key}"), format!("{key} at the beginning")));
        columns.push((format!("value_{key}"), format!("{key} as it was left")));
    }
    let steps = "every change: ms since the beginning:key=value; …";
    columns.extend(owned(&[("steps", steps)]));
    columns
}

fn rating_columns(rating: &Rating) -> Vec<Column> {
    let mut columns = owned(&ITEM);
    columns.extend(rating.scales.iter().map(|scale| {
        let [low, high] = scale.bounds();
        let what = format!("{} ({low}) to {} ({high})", scale.low, scale.high);
        (format!("rating_{}", scale.key), what)
    }));
    columns
}

/// The cells of a trial, in the order of [`columns`].
pub(super) fn cells(design: &Design, task: &Task, answer: Option<&Answer>) -> Vec<String> {
    let stimulus = |item: usize| design.stimuli.get(item);
    let id = |item: usize| stimulus(item).map_or_else(String::new, |s: &Stimulus| s.id.clone());
    let item = |item: usize| {
        let condition = stimulus(item).map_or_else(String::new, |s| s.condition.clone());
        vec![id(item), condition]
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
            cells.extend(ranks(answer));
            cells
        }
        Task::OddOne { items, odd } => {
            let mut cells: Vec<String> = items.iter().copied().map(id).collect();
            cells.extend([position(*odd), grade(answer)]);
            cells
        }
        Task::Adjust { item: at, starts } => {
            let mut cells = item(*at);
            cells.extend(adjusted(design, starts, answer));
            cells
        }
        Task::Judge { item: at, is_real } => {
            let mut cells = item(*at);
            cells.push(flag(*is_real));
            cells
        }
        Task::JudgePair { items, real } => vec![id(items[0]), id(items[1]), position(*real)],
        Task::Interval {
            track,
            level_db,
            signal,
        } => vec![position(*track), number(*level_db), position(*signal)],
        Task::Estimate { item: at } => item(*at),
        Task::Rate { item: at } => {
            let mut cells = item(*at);
            cells.extend(ratings(design, answer));
            cells
        }
    }
}

fn ranks(answer: Option<&Answer>) -> [String; 4] {
    match answer {
        Some(Answer::Ranks(ranks)) => ranks.map(|rank| rank.to_string()),
        _ => Default::default(),
    }
}

fn grade(answer: Option<&Answer>) -> String {
    match answer {
        Some(Answer::Odd { grade, .. }) => grade.name().to_owned(),
        _ => String::new(),
    }
}

fn ratings(design: &Design, answer: Option<&Answer>) -> Vec<String> {
    let Method::Rating(rating) = &design.method else {
        return Vec::new();
    };
    let ratings = match answer {
        Some(Answer::Ratings(ratings)) => ratings.as_slice(),
        _ => &[],
    };
    let cell = |at| cell(ratings, at);
    (0..rating.scales.len()).map(cell).collect()
}

fn cell(values: &[f64], at: usize) -> String {
    values
        .get(at)
        .map_or_else(String::new, |&value| number(value))
}

/// Where each parameter began and was left, then every change.
fn adjusted(design: &Design, starts: &[f64], answer: Option<&Answer>) -> Vec<String> {
    let (values, steps) = match answer {
        Some(Answer::Adjusted { values, steps }) => (values.as_slice(), steps.as_slice()),
        _ => Default::default(),
    };
    let both = |at| [cell(starts, at), cell(values, at)];
    let mut cells: Vec<String> = (0..starts.len()).flat_map(both).collect();
    cells.push(told_steps(design, steps));
    cells
}

fn told_steps(design: &Design, steps: &[Adjustment]) -> String {
    let Method::Adjustment(adjusting) = &design.method else {
        return String::new();
    };
    let told = steps.iter().filter_map(|step| {
        let key = adjusting.parameters.get(step.parameter)?.what.name();
        let (at_ms, value) = (number(step.at_ms), number(step.value));
        Some(format!("{at_ms}:{key}={value}"))
    });
    told.collect::<Vec<_>>().join("; ")
}
