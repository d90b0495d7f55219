//! The columns of what a design's composition asks: what was presented, and what was answered.

use super::columns::{Column, Kind, Visit, columns};
use super::values::{
    Count, First, Grade, If, Steps, Stimulus, Value, Word, derived, derived_if, position,
};
use crate::design::{Confidence, Design, Scale, Sets, Shown};
use crate::trial::{Adjustment, Answer, AnswerValue, Task};

/// What an answer chose, and how sure that was.
pub(super) fn chosen<V: Visit>(
    design: &Design,
    (answer, is_answered): (&mut Answer, bool),
    to: &mut V,
) -> Result<(), V::Error> {
    let words = design.composition.words();
    let (kind, value): (Kind, &mut dyn Value) = match (&mut answer.value, &words) {
        (AnswerValue::Ranks(ranks), _) => {
            let first = ranks.iter().position(|&rank| rank == 1);
            (Kind::Count, &mut derived_if(first.map(position)))
        }
        (AnswerValue::Chosen(at), Some(words)) => (Kind::Level, &mut Word(at, words)),
        (AnswerValue::Chosen(at), None) => (Kind::Count, &mut Count(at)),
        (AnswerValue::Number(value), _) => (Kind::Number, value),
        _ => (Kind::Text, &mut derived("")),
    };
    let meaning = "what was chosen; empty where several numbers were given";
    let column = Column::of("response".to_owned(), kind, meaning.to_owned());
    to.column(column, &mut If(is_answered, value))?;
    let confidence: &mut dyn Value = match design.composition.response.confidence {
        Confidence::Grades(_) => &mut answer.confidence,
        _ => &mut derived(""),
    };
    columns! { to;
        confidence: Grade, "how sure that was, from 1; empty where not asked" =>
            &mut If(is_answered, confidence);
    }
    Ok(())
}

/// What was presented, and answers of several numbers.
pub(super) fn asked<V: Visit>(
    design: &Design,
    task: &mut Task,
    (answer, is_answered): (&mut Answer, bool),
    to: &mut V,
) -> Result<(), V::Error> {
    shown(design, task, to)?;
    let composition = &design.composition;
    match &mut answer.value {
        AnswerValue::Ranks(ranks) => {
            let meaning = match composition.order.sets {
                Sets::Targets => "rank of alternative",
                _ => "rank of stimulus",
            };
            let end = match composition.order.sets {
                Sets::Targets => "1 most alike; answered as an order of positions",
                _ => "1 the first; answered as an order of positions",
            };
            for (rank, n) in ranks.iter_mut().zip(1..) {
                let meaning = format!("{meaning} {n}, {end}");
                let column = Column::of(format!("rank{n}"), Kind::Rank, meaning);
                to.column(column, &mut If(is_answered, rank))?;
            }
        }
        AnswerValue::BestWorst([best, worst]) => {
            columns! { to;
                best: Count, "position at the first end of what is asked, from 1" =>
                    &mut If(is_answered, &mut Count(best));
                worst: Count, "position at the other end, from 1" =>
                    &mut If(is_answered, &mut Count(worst));
            }
        }
        AnswerValue::Adjusted { values, steps } => {
            set(design, &mut task.starts, (values, steps, is_answered), to)?;
        }
        AnswerValue::Ratings(places) => {
            rated(composition.scales(), (places, is_answered), to)?;
        }
        AnswerValue::Piles(piles) => {
            for (pile, n) in piles.iter_mut().zip(1..) {
                let column = Column::of(
                    format!("pile{n}"),
                    Kind::Count,
                    format!("pile of stimulus {n}"),
                );
                to.column(column, &mut If(is_answered, &mut Count(pile)))?;
            }
        }
        AnswerValue::Chosen(_) | AnswerValue::Number(_) => {}
    }
    let words = composition.response.confidence.words();
    if !words.is_empty() {
        let column = Column::of("grade".to_owned(), Kind::Level, listed(&words));
        let grade = &mut Grade(&mut answer.confidence, &words);
        to.column(column, &mut If(is_answered, grade))?;
    }
    Ok(())
}

/// Words as a sentence has them: `easy, normal or hard`.
fn listed(words: &[&str]) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        words => words.concat(),
    }
}

/// What was presented: the reference, the stimuli by position, what was adapted, what is right.
fn shown<V: Visit>(design: &Design, task: &mut Task, to: &mut V) -> Result<(), V::Error> {
    let composition = &design.composition;
    let (sets, how) = (composition.order.sets, composition.presentation.shown);
    let is_target = sets == Sets::Targets;
    if let Some(reference) = &mut task.reference {
        let (name, meaning) = if is_target {
            ("target", "the target")
        } else {
            ("standard", "what it is compared with")
        };
        let column = Column::of(name.to_owned(), Kind::Stimulus, meaning.to_owned());
        to.column(column, &mut Stimulus(reference))?;
    }
    match task.items.as_mut_slice() {
        [] => {}
        [item] => item_and_condition(item, design, to)?,
        [item, ..] if sets == Sets::Adapted => {
            columns! { to; item: Stimulus, "the stimulus" => &mut Stimulus(item); }
        }
        items if is_target => stimuli("alt", "alternative", items, to)?,
        items => stimuli("item", "stimulus", items, to)?,
    }
    if let (Some(adapted), Some(adaptation)) = (&mut task.adapted, &composition.adaptation) {
        columns! { to;
            track: Count, "which of the interleaved series, from 1" =>
                &mut Count(&mut adapted.track);
        }
        let parameter = adaptation.parameter;
        let column = Column {
            unit: parameter.unit(),
            ..Column::of(
                parameter.column(),
                Kind::Number,
                parameter.meaning().to_owned(),
            )
        };
        to.column(column, &mut adapted.value)?;
    }
    if composition.order.catch_trials > 0 {
        columns! { to;
            catch: Flag, "1 where all stimuli are the same, to catch who does not attend" =>
                &mut task.is_catch;
        }
    }
    let Some(right) = &mut task.right else {
        return Ok(());
    };
    if let Some([yes, no]) = composition.words() {
        let meaning = format!("1 for a {yes} one, 0 for a {no} one");
        let column = Column::of(format!("is_{}", plain(yes)), Kind::Flag, meaning);
        return to.column(column, &mut First(right));
    }
    let (name, meaning) = match (sets, how) {
        (Sets::Targets, _) => ("position_correct", "where the target was, from 1"),
        (Sets::Triads, _) => ("position_odd", "where the odd one was, from 1"),
        (Sets::Opposed, _) => ("position_real", "where the real one was, from 1"),
        (_, Shown::Intervals) => ("interval_signal", "which interval held it, from 1"),
        _ => ("position_right", "where the right one was, from 1"),
    };
    let column = Column::of(name.to_owned(), Kind::Count, meaning.to_owned());
    to.column(column, &mut Count(right))
}

/// A word as a part of a column's name.
fn plain(word: &str) -> String {
    let letter = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_lowercase()
        } else {
            '_'
        }
    };
    word.chars().map(letter).collect()
}

/// Every parameter as it began and as it was left, and how it came there.
fn set<V: Visit>(
    design: &Design,
    starts: &mut [f64],
    (values, steps, is_answered): (&mut [f64], &mut Vec<Adjustment>, bool),
    to: &mut V,
) -> Result<(), V::Error> {
    let parameters = design.composition.parameters().iter();
    let keys: Vec<&str> = parameters.map(|turned| turned.what.name()).collect();
    for ((key, start), value) in keys.iter().zip(starts).zip(values) {
        let meaning = format!("{key} at the beginning");
        let column = Column::of(format!("start_{key}"), Kind::Number, meaning);
        to.column(column, start)?;
        let meaning = format!("{key} as it was left");
        let column = Column::of(format!("value_{key}"), Kind::Number, meaning);
        to.column(column, &mut If(is_answered, value))?;
    }
    columns! { to;
        steps: Text, "every change: ms since the beginning:key=value; …" =>
            &mut If(is_answered, &mut Steps(steps, &keys));
    }
    Ok(())
}

/// The place on every scale.
fn rated<V: Visit>(
    scales: &[Scale],
    (places, is_answered): (&mut [f64], bool),
    to: &mut V,
) -> Result<(), V::Error> {
    for (scale, place) in scales.iter().zip(places) {
        let [low, high] = scale.bounds();
        let meaning = format!("{} ({low}) to {} ({high})", scale.low, scale.high);
        let column = Column::of(format!("rating_{}", scale.key), Kind::Number, meaning);
        to.column(column, &mut If(is_answered, place))?;
    }
    Ok(())
}

/// Several stimuli of a trial.
fn stimuli<V: Visit>(
    name: &str,
    meaning: &str,
    items: &mut [usize],
    to: &mut V,
) -> Result<(), V::Error> {
    for (item, n) in items.iter_mut().zip(1..) {
        let (name, meaning) = (format!("{name}{n}"), format!("{meaning} {n}"));
        let column = Column::of(name, Kind::Stimulus, meaning);
        to.column(column, &mut Stimulus(item))?;
    }
    Ok(())
}

/// The only stimulus of a trial.
fn item_and_condition<V: Visit>(
    item: &mut usize,
    design: &Design,
    to: &mut V,
) -> Result<(), V::Error> {
    let condition = design
        .stimuli
        .get(*item)
        .map(|stimulus| &stimulus.condition);
    columns! { to;
        item: Stimulus, "the stimulus" => &mut Stimulus(item);
        condition: Text, "the stimulus's condition" => &mut derived_if(condition);
    }
    Ok(())
}
