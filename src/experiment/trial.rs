//! One trial: what is presented, and what may be answered. Stimuli are numbers into the design's.

use thiserror::Error;

use super::design::{Adaptation, Composition, Form, Scale, Seeks};
pub use selvedge_statistics::ranking::Grade;

/// One trial of a session.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The block, from 0.
    pub block: usize,
    /// Its number among the trials that count, or among those of practice, from 0.
    pub number: usize,
    /// Practice does not count.
    pub is_practice: bool,
    /// What is presented.
    pub task: Task,
}

/// What is presented in a trial; what is asked of it, the design's composition says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Task {
    /// The stimuli by position; none where a vibration is adapted.
    pub items: Vec<usize>,
    /// What they are compared with.
    pub reference: Option<usize>,
    /// The position, or the word, that is right; where no answer is wrong, the position of what is
    /// adapted.
    pub right: Option<usize>,
    /// The number that is adapted.
    pub(crate) adapted: Option<Adapted>,
    /// Where the parameters of an adjustment begin, in the design's order.
    pub starts: Vec<f64>,
    /// Whether all stimuli are the same, to catch who does not attend.
    pub is_catch: bool,
}

/// A number that is adapted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Adapted {
    /// Which of the interleaved series, from 0.
    pub track: usize,
    /// Its value.
    pub value: f64,
}

impl Task {
    /// What is adapted is at this value at a position; `None` is nothing.
    pub(crate) fn adapted_at(&self, adaptation: &Adaptation, position: usize) -> Option<f64> {
        let is_adapted = adaptation.alternatives == 1 || Some(position) == self.right;
        let adapted = self.adapted.filter(|_| is_adapted);
        adapted
            .map(|adapted| adapted.value)
            .or(adaptation.reference)
    }

    /// The first stimulus, which is the only one where one is felt alone.
    pub fn item(&self) -> Option<usize> {
        self.items.first().copied()
    }
}

/// A change of a parameter on the way to an adjustment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adjustment {
    /// Since the trial began, ms.
    pub at_ms: f64,
    /// Which of the design's parameters, from 0.
    pub parameter: usize,
    /// What it was turned to.
    pub value: f64,
}

/// What a person answered.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The answer itself.
    pub value: AnswerValue,
    /// How sure it is, from 1; `None` where it was not asked for.
    pub confidence: Option<u8>,
}

/// An answer without how sure it is.
#[derive(Debug, Clone, PartialEq)]
pub enum AnswerValue {
    /// The position or word that was chosen, from 0.
    Chosen(usize),
    /// The rank of each position, 1 for the first; each rank once.
    Ranks(Vec<u8>),
    /// The positions at both ends of what is asked.
    BestWorst([usize; 2]),
    /// A number above 0.
    Number(f64),
    /// The place on each scale, in the design's order.
    Ratings(Vec<f64>),
    /// The pile of each position, from 0 in the order of their first positions.
    Piles(Vec<usize>),
    /// What the parameters were left at, and how they came there.
    Adjusted {
        /// In the design's order.
        values: Vec<f64>,
        /// Every change in order of time.
        steps: Vec<Adjustment>,
    },
}

impl From<AnswerValue> for Answer {
    fn from(value: AnswerValue) -> Self {
        let confidence = None;
        Self { value, confidence }
    }
}

impl Answer {
    /// A choice, and how sure it is.
    pub fn chosen(position: usize, confidence: Option<u8>) -> Self {
        let value = AnswerValue::Chosen(position);
        Self { value, confidence }
    }

    /// The ranks that positions have which are given in order, the first first.
    pub fn in_order(positions: &[usize]) -> Self {
        let mut ranks = vec![0; positions.len()];
        for (rank, &position) in (1..).zip(positions) {
            if let Some(slot) = ranks.get_mut(position) {
                *slot = rank;
            }
        }
        AnswerValue::Ranks(ranks).into()
    }

    /// Piles numbered in the order of their first positions.
    pub fn in_piles<T: PartialEq>(piles: &[T]) -> Self {
        let mut known: Vec<&T> = Vec::new();
        let number = |pile| {
            known
                .iter()
                .position(|one| *one == pile)
                .unwrap_or_else(|| {
                    known.push(pile);
                    known.len() - 1
                })
        };
        AnswerValue::Piles(piles.iter().map(number).collect()).into()
    }
}

/// An answer that does not answer the question.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AnswerError {
    /// The answer belongs to another kind of trial.
    #[error("this answers another question; {mend}")]
    OtherKind {
        /// What is asked.
        mend: String,
    },
    /// A value that cannot be.
    #[error("{what}; {mend}")]
    Value {
        /// What is wrong.
        what: String,
        /// What to answer.
        mend: String,
    },
}

impl AnswerError {
    pub(super) fn value(what: impl Into<String>, mend: impl Into<String>) -> Self {
        Self::Value {
            what: what.into(),
            mend: mend.into(),
        }
    }
}

impl Composition {
    /// Whether an answer is right; `None` where nothing is right or wrong.
    ///
    /// # Errors
    /// The answer is none to this question.
    pub(crate) fn verdict(
        &self,
        task: &Task,
        answer: &Answer,
    ) -> Result<Option<bool>, AnswerError> {
        self.check_answer(answer)?;
        let seeks = self.adaptation.as_ref().map(|adaptation| adaptation.seeks);
        let right = task.right.filter(|_| seeks != Some(Seeks::Equality));
        Ok(right.and_then(|right| match &answer.value {
            AnswerValue::Chosen(chosen) => Some(*chosen == right),
            AnswerValue::Ranks(ranks) => Some(ranks.get(right) == Some(&1)),
            _ => None,
        }))
    }

    /// Whether an answer says more of what is adapted: right, or the adapted one, or the first
    /// word.
    pub(crate) fn says_more(&self, task: &Task, answer: &Answer) -> bool {
        let more = if self.words().is_some() {
            Some(0)
        } else {
            task.right
        };
        matches!(answer.value, AnswerValue::Chosen(chosen) if Some(chosen) == more)
    }

    fn check_answer(&self, answer: &Answer) -> Result<(), AnswerError> {
        let n = self.presentation.n;
        check_confidence(answer.confidence, self.response.confidence.n_grades())?;
        match (&self.response.form, &answer.value) {
            (
                Form::Choice | Form::Words(_) | Form::SameDifferent,
                AnswerValue::Chosen(position),
            ) => check_position(*position, self.n_choices()),
            (Form::Rank, AnswerValue::Ranks(ranks)) => check_ranks(ranks, n),
            (Form::BestWorst(words), AnswerValue::BestWorst([best, worst])) => {
                check_position(*best, n)?;
                check_position(*worst, n)?;
                let is_one = best == worst;
                let what = format!("position {} is at both ends", best + 1);
                let mend = format!(
                    "give the {} one, then another as the {} one",
                    words[0], words[1]
                );
                if is_one {
                    Err(AnswerError::value(what, mend))
                } else {
                    Ok(())
                }
            }
            (Form::Scales(scales), AnswerValue::Ratings(values)) => check_ratings(scales, values),
            (Form::Number { .. }, AnswerValue::Number(value)) => check_strength(*value),
            (Form::Piles, AnswerValue::Piles(piles)) => check_piles(piles, n),
            (Form::Adjustment(parameters), AnswerValue::Adjusted { values, .. }) => {
                check_finite(values)?;
                check_count(values.len(), parameters.len(), "parameters")
            }
            _ => Err(AnswerError::OtherKind {
                mend: self.question(),
            }),
        }
    }
}

fn check_confidence(confidence: Option<u8>, n_grades: u8) -> Result<(), AnswerError> {
    match confidence {
        Some(grade) if !(1..=n_grades).contains(&grade) => {
            let what = format!("there is no grade {grade} of confidence");
            let mend = match n_grades {
                0 => "give none".to_owned(),
                n => format!("give 1 to {n}"),
            };
            Err(AnswerError::value(what, mend))
        }
        _ => Ok(()),
    }
}

fn check_position(position: usize, n: usize) -> Result<(), AnswerError> {
    if position < n {
        return Ok(());
    }
    let what = format!("there is no number {}", position.saturating_add(1));
    Err(AnswerError::value(what, format!("give 1 to {n}")))
}

fn check_ranks(ranks: &[u8], n: usize) -> Result<(), AnswerError> {
    let mut sorted: Vec<usize> = ranks.iter().map(|rank| usize::from(*rank)).collect();
    sorted.sort_unstable();
    if sorted.into_iter().eq(1..=n) {
        return Ok(());
    }
    let what = format!("the ranks are {ranks:?}");
    Err(AnswerError::value(
        what,
        format!("give each of 1 to {n} once"),
    ))
}

fn check_count(found: usize, expected: usize, of: &str) -> Result<(), AnswerError> {
    if found == expected {
        return Ok(());
    }
    let what = format!("{found} numbers for {expected} {of}");
    Err(AnswerError::value(what, "give one for each"))
}

fn check_piles(piles: &[usize], n: usize) -> Result<(), AnswerError> {
    check_count(piles.len(), n, "positions")?;
    if Answer::in_piles(piles).value == AnswerValue::Piles(piles.to_vec()) {
        return Ok(());
    }
    let what = format!("the piles are {piles:?}");
    Err(AnswerError::value(
        what,
        "number them in the order of their first positions",
    ))
}

fn check_ratings(scales: &[Scale], values: &[f64]) -> Result<(), AnswerError> {
    check_finite(values)?;
    check_count(values.len(), scales.len(), "scales")
}

fn check_finite(values: &[f64]) -> Result<(), AnswerError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(value) => Err(AnswerError::value(
            format!("{value} is no number"),
            "give a finite number",
        )),
    }
}

fn check_strength(value: f64) -> Result<(), AnswerError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    let what = format!("{value} is no strength");
    Err(AnswerError::value(what, "give a finite number above 0"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    fn ranking() -> (Composition, Task) {
        let design = Design::shipped("ranking-virtual-target").unwrap();
        let task = Task {
            items: vec![3, 7, 1, 2],
            reference: Some(7),
            right: Some(1),
            ..Task::default()
        };
        (design.composition, task)
    }

    fn verdict(value: AnswerValue) -> Result<Option<bool>, String> {
        let (composition, task) = ranking();
        let verdict = composition.verdict(&task, &value.into());
        verdict.map_err(|error| error.to_string())
    }

    #[test]
    fn a_ranking_is_right_where_the_target_is_first() {
        assert_eq!(
            verdict(AnswerValue::Ranks(vec![2, 1, 3, 4])),
            Ok(Some(true))
        );
        assert_eq!(
            verdict(AnswerValue::Ranks(vec![1, 2, 3, 4])),
            Ok(Some(false))
        );
        assert_eq!(
            verdict(Answer::in_order(&[1, 2, 3, 0]).value),
            Ok(Some(true))
        );
    }

    #[test]
    fn ranks_that_are_tied_are_refused_with_what_to_give() {
        let described = "the ranks are [1, 1, 3, 4]; give each of 1 to 4 once";
        let found = verdict(AnswerValue::Ranks(vec![1, 1, 3, 4]));
        assert_eq!(found, Err(described.to_owned()));
        assert!(verdict(AnswerValue::Ranks(vec![1, 2, 3])).is_err());
    }

    #[test]
    fn an_answer_to_another_question_is_refused_with_the_question() {
        let error = verdict(AnswerValue::Number(1.0)).unwrap_err();
        assert!(error.contains("put all 4 in order"), "{error}");
    }

    #[test]
    fn strengths_of_zero_and_none_are_refused() {
        let composition = Design::shipped("magnitude").unwrap().composition;
        let verdict =
            |value| composition.verdict(&Task::default(), &AnswerValue::Number(value).into());
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(verdict(value).is_err(), "{value}");
        }
        assert_eq!(verdict(0.5), Ok(None));
    }

    #[test]
    fn piles_are_numbered_as_they_are_met() {
        let piles = Answer::in_piles(&["b", "a", "b", "c"]);
        assert_eq!(piles.value, AnswerValue::Piles(vec![0, 1, 0, 2]));
        assert!(check_piles(&[0, 1, 0, 2], 4).is_ok());
        assert!(check_piles(&[1, 0, 1, 2], 4).is_err(), "the first is 0");
        assert!(check_piles(&[0, 2, 0, 1], 4).is_err(), "2 before 1");
        assert!(check_piles(&[0, 0], 4).is_err(), "two are missing");
    }
}
