//! What has been answered so far of a trial, before it is handed in.

use selvedge_experiment::design::{Composition, Design, Form, Scale, Sets, Shown, TunedParameter};
use selvedge_experiment::{Adjustment, Answer, AnswerValue, Trial};
use selvedge_foundation::quantity;

/// A part of an answer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    /// This position is the next in order, or is chosen; of two words, this one.
    Place(usize),
    /// This position has this place in the order, from 0.
    Rank(usize, usize),
    /// What was placed last is taken back.
    TakeBack,
    /// How sure, from 1.
    Confidence(u8),
    /// This position goes to the next pile.
    NextPile(usize),
    /// Turn this parameter by so many of its steps.
    Turn(usize, i32),
    /// Turn this parameter to this value.
    Set(usize, f64),
    /// The place on this scale.
    Rate(usize, f64),
    /// The number as it is typed.
    Type(String),
}

/// What a participant does in the view, or an experimenter who types for one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Act {
    /// Go on from instructions, a movement or a break.
    Pass,
    /// A part of an answer.
    Mark(Mark),
    /// Hand the answer in.
    Answer,
    /// Play what this trial plays again, where that is allowed.
    Play,
}

/// An answer on its way.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) enum Draft {
    /// Nothing is asked.
    #[default]
    Nothing,
    /// Positions in order.
    Order(Order),
    /// Parameters as they are now.
    Adjust {
        /// What they are, in the design's order.
        values: Vec<f64>,
        /// How they came there.
        steps: Vec<Adjustment>,
        /// What may be turned.
        parameters: Vec<TunedParameter>,
    },
    /// One of several positions or words.
    Choose {
        /// How many there are.
        n: usize,
        /// What they are called; numbers where they have no words.
        words: Vec<String>,
        /// Which.
        position: Option<usize>,
        /// How sure.
        sure: Sure,
    },
    /// The pile of each position, from 0.
    Piles(Vec<Option<usize>>),
    /// A number.
    Magnitude(String),
    /// A place on each scale.
    Ratings {
        /// The places.
        values: Vec<Option<f64>>,
        /// The scales.
        scales: Vec<Scale>,
    },
}

/// Positions in order: all of them, or the ones at both ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Order {
    /// How many positions there are.
    pub n: usize,
    /// The positions that were put in order so far.
    pub slots: Vec<Option<usize>>,
    /// What the first and the last are.
    pub ends: [String; 2],
    /// Whether the slots are the two ends alone.
    pub has_ends_alone: bool,
}

impl Order {
    /// Nothing in order yet.
    pub(crate) fn of(composition: &Composition) -> Self {
        let n = composition.presentation.n;
        let (n_slots, ends) = match &composition.response.form {
            Form::BestWorst(words) => (2, words.clone()),
            _ if composition.order.sets == Sets::Targets => {
                (n, ["most alike", "least alike"].map(str::to_owned))
            }
            _ => (n, ["first", "last"].map(str::to_owned)),
        };
        Self {
            n,
            slots: vec![None; n_slots],
            ends,
            has_ends_alone: matches!(composition.response.form, Form::BestWorst(_)),
        }
    }

    fn take(&mut self, mark: &Mark) {
        match *mark {
            Mark::Place(position) if position < self.n => {
                if self.slots.contains(&Some(position)) {
                    return;
                }
                if let Some(free) = self.slots.iter_mut().find(|slot| slot.is_none()) {
                    *free = Some(position);
                }
            }
            Mark::Rank(position, rank) if position < self.n && rank < self.slots.len() => {
                let from = self.slots.iter().position(|slot| *slot == Some(position));
                // Who stood there takes the place that becomes free, if one does.
                let displaced = self.slots[rank].replace(position);
                if let Some(from) = from
                    && from != rank
                {
                    self.slots[from] = displaced;
                }
            }
            Mark::TakeBack => {
                if let Some(last) = self.slots.iter_mut().rev().find(|slot| slot.is_some()) {
                    *last = None;
                }
            }
            _ => {}
        }
    }

    fn answer(&self) -> Result<Answer, &'static str> {
        let all: Option<Vec<usize>> = self.slots.iter().copied().collect();
        match (all.as_deref(), self.has_ends_alone) {
            (Some(&[best, worst]), true) => Ok(AnswerValue::BestWorst([best, worst]).into()),
            (Some(all), false) => Ok(Answer::in_order(all)),
            (_, true) => Err("Choose both first"),
            (None, false) => Err("Put all in order first"),
        }
    }
}

/// How sure somebody is, where that is asked.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Sure {
    /// Grades that are offered; 0 asks for none.
    pub n_grades: u8,
    /// What they are called; numbers where they have no words.
    pub words: Vec<String>,
    /// What was said, from 1.
    pub grade: Option<u8>,
}

impl Sure {
    fn of(composition: &Composition) -> Self {
        let confidence = &composition.response.confidence;
        let words = confidence.words().into_iter();
        Self {
            n_grades: confidence.n_grades(),
            words: words.map(str::to_owned).collect(),
            grade: None,
        }
    }

    fn is_said(&self) -> bool {
        self.n_grades == 0 || self.grade.is_some()
    }

    fn take(&mut self, grade: u8) {
        if (1..=self.n_grades).contains(&grade) {
            self.grade = Some(grade);
        }
    }

    fn missing(&self) -> &'static str {
        if self.words.is_empty() {
            "Say how sure you are"
        } else {
            "Say how hard that was"
        }
    }
}

impl Draft {
    /// An answer to a trial in which nothing was said yet.
    pub(crate) fn of(design: &Design, trial: &Trial) -> Self {
        let composition = &design.composition;
        let n = composition.presentation.n;
        match &composition.response.form {
            Form::Choice | Form::Words(_) | Form::SameDifferent => {
                let words = composition.words().into_iter().flatten();
                Self::Choose {
                    n: composition.n_choices(),
                    words: words.map(str::to_owned).collect(),
                    position: None,
                    sure: Sure::of(composition),
                }
            }
            Form::Rank | Form::BestWorst(_) => Self::Order(Order::of(composition)),
            Form::Adjustment(parameters) => Self::Adjust {
                values: trial.task.starts.clone(),
                steps: Vec::new(),
                parameters: parameters.clone(),
            },
            Form::Number { .. } => Self::Magnitude(String::new()),
            Form::Scales(scales) => Self::Ratings {
                values: vec![None; scales.len()],
                scales: scales.clone(),
            },
            Form::Piles => Self::Piles(vec![None; n]),
        }
    }

    /// Takes a part of the answer, given so many ms after the trial began; what does not belong to
    /// it is ignored.
    pub(crate) fn take(&mut self, mark: &Mark, at_ms: f64) {
        match (self, mark) {
            (Self::Order(order), mark) => order.take(mark),
            (Self::Piles(piles), Mark::NextPile(at)) => next_pile(piles, *at),
            (
                Self::Adjust {
                    values,
                    steps,
                    parameters,
                },
                Mark::Turn(at, by),
            ) => {
                if let (Some(parameter), Some(&value)) = (parameters.get(*at), values.get(*at)) {
                    let to = value + f64::from(*by) * parameter.step;
                    turn((values, steps), (*at, parameter), (to, at_ms));
                }
            }
            (
                Self::Adjust {
                    values,
                    steps,
                    parameters,
                },
                Mark::Set(at, to),
            ) => {
                if let Some(parameter) = parameters.get(*at) {
                    turn((values, steps), (*at, parameter), (*to, at_ms));
                }
            }
            (Self::Choose { n, position, .. }, Mark::Place(at)) if at < n => *position = Some(*at),
            (Self::Choose { sure, .. }, Mark::Confidence(grade)) => sure.take(*grade),
            (Self::Magnitude(text), Mark::Type(typed)) => text.clone_from(typed),
            (Self::Ratings { values, scales }, Mark::Rate(at, to)) => {
                if let (Some(value), Some(scale)) = (values.get_mut(*at), scales.get(*at)) {
                    let [low, high] = scale.bounds();
                    // A pixel is coarser than a hundredth.
                    let to = (100.0 * to.clamp(low, high)).round() / 100.0;
                    *value = Some(to).filter(|value| value.is_finite());
                }
            }
            _ => {}
        }
    }

    /// The answer; in its place, what is missing.
    pub(crate) fn answer(&self) -> Result<Answer, &'static str> {
        match self {
            Self::Nothing => Err("Nothing is asked now"),
            Self::Order(order) => order.answer(),
            Self::Piles(piles) => {
                let all: Option<Vec<usize>> = piles.iter().copied().collect();
                let all = all.ok_or("Put each into a pile first")?;
                Ok(Answer::in_piles(&all))
            }
            Self::Adjust { values, steps, .. } => {
                let (values, steps) = (values.clone(), steps.clone());
                Ok(AnswerValue::Adjusted { values, steps }.into())
            }
            Self::Choose { position, sure, .. } => {
                let position = position.ok_or("Choose one first")?;
                if !sure.is_said() {
                    return Err(sure.missing());
                }
                Ok(Answer::chosen(position, sure.grade))
            }
            Self::Magnitude(text) => {
                let number = text.trim().replace(',', ".").parse::<f64>();
                let is_strength = |value: &f64| *value > 0.0 && value.is_finite();
                let number = number.ok().filter(is_strength);
                let number = number.map(|number| AnswerValue::Number(number).into());
                number.ok_or("Type a number above 0")
            }
            Self::Ratings { values, .. } => {
                let all: Option<Vec<f64>> = values.iter().copied().collect();
                all.map(|all| AnswerValue::Ratings(all).into())
                    .ok_or("Place it on every scale first")
            }
        }
    }

    /// Whether what was said is handed in at once: where something is played, one of several is
    /// chosen, and nothing else is asked.
    pub(crate) fn is_handed_in_at_once(&self, design: &Design) -> bool {
        let is_choice = matches!(self, Self::Choose { sure, .. } if sure.n_grades == 0);
        let is_in_time = design.composition.presentation.shown == Shown::Intervals;
        let is_played = is_in_time || design.plays_vibrations();
        is_played && is_choice && self.answer().is_ok()
    }

    /// What was said so far, for the experimenter.
    pub(crate) fn describe(&self) -> String {
        match self {
            Self::Order(order) => {
                let name = |at: &Option<usize>| {
                    at.map_or_else(|| "·".to_owned(), |at| (at + 1).to_string())
                };
                order.slots.iter().map(name).collect::<Vec<_>>().join(" ")
            }
            Self::Choose {
                position, words, ..
            } => position.map_or_else(String::new, |at| {
                words
                    .get(at)
                    .cloned()
                    .unwrap_or_else(|| (at + 1).to_string())
            }),
            Self::Piles(piles) => {
                let n_said = piles.iter().flatten().count();
                format!("{n_said} of {} in piles", piles.len())
            }
            Self::Adjust { values, .. } => {
                let described = values.iter().map(|value| quantity::fixed(*value, 2));
                described.collect::<Vec<_>>().join(", ")
            }
            Self::Magnitude(text) => text.clone(),
            Self::Ratings { values, .. } => {
                let n_said = values.iter().flatten().count();
                format!("{n_said} of {} scales", values.len())
            }
            Self::Nothing => String::new(),
        }
    }
}

/// Moves a position on: through the piles of the others to a new one, and back to the first.
fn next_pile(piles: &mut [Option<usize>], at: usize) {
    let others = piles.iter().enumerate().filter(|(other, _)| *other != at);
    let n_piles = others
        .filter_map(|(_, pile)| *pile)
        .max()
        .map_or(1, |last| last + 2);
    if let Some(pile) = piles.get_mut(at) {
        *pile = Some(pile.map_or(0, |pile| (pile + 1) % n_piles));
    }
}

/// Turns a parameter within its range, in whole steps from its lower end.
fn turn(
    (values, steps): (&mut [f64], &mut Vec<Adjustment>),
    (at, parameter): (usize, &TunedParameter),
    (to, at_ms): (f64, f64),
) {
    let n_steps = ((to - parameter.from) / parameter.step).round();
    let value = (parameter.from + n_steps * parameter.step).clamp(parameter.from, parameter.to);
    let Some(now) = values.get_mut(at) else {
        return;
    };
    if !value.is_finite() || (value - *now).abs() < 1e-9 {
        return;
    }
    *now = value;
    steps.push(Adjustment {
        at_ms,
        parameter: at,
        value,
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_experiment::Procedure;
    use selvedge_experiment::design::Subject;

    fn draft(name: &str) -> Draft {
        let design = Design::shipped(name).unwrap();
        let subject = Subject {
            pseudonym: "p01".to_owned(),
            nth: 0,
            session: 1,
        };
        let procedure = Procedure::of(&design, &subject).unwrap();
        Draft::of(&design, procedure.trial().unwrap())
    }

    #[test]
    fn digits_give_ranks_in_the_order_in_which_they_come() {
        let mut draft = draft("ranking-virtual-target");
        for position in [2, 0, 2, 9, 3] {
            draft.take(&Mark::Place(position), 0.0);
        }
        assert_eq!(draft.describe(), "3 1 4 ·");
        assert!(draft.answer().is_err(), "one is missing");
        draft.take(&Mark::TakeBack, 0.0);
        draft.take(&Mark::Place(1), 0.0);
        draft.take(&Mark::Place(3), 0.0);
        assert_eq!(draft.answer(), Ok(Answer::in_order(&[2, 0, 1, 3])));
        draft.take(&Mark::Rank(3, 0), 0.0);
        let exchanged = Answer::in_order(&[3, 0, 1, 2]);
        assert_eq!(draft.answer(), Ok(exchanged), "exchanged");
    }

    #[test]
    fn a_parameter_stays_in_its_range_and_remembers_how_it_came_there() {
        let mut draft = draft("gain-matching");
        let Draft::Adjust { values, .. } = &draft else {
            panic!("an adjustment")
        };
        let start = values[0];
        draft.take(&Mark::Set(0, 19.6), 10.0);
        draft.take(&Mark::Turn(0, 3), 20.0);
        draft.take(&Mark::Turn(0, 1), 30.0);
        let Ok(AnswerValue::Adjusted { values, steps }) = draft.answer().map(|a| a.value) else {
            panic!("it is always an answer")
        };
        assert!(
            (values[0] - 20.0).abs() < 1e-9 && start < 20.0,
            "{values:?}"
        );
        assert!(!steps.is_empty() && steps.len() <= 2, "{steps:?}");
    }

    #[test]
    fn a_position_goes_through_the_piles_to_a_new_one_and_back() {
        let mut draft = Draft::Piles(vec![None; 3]);
        for (at, piles) in [
            (0, [Some(0), None, None]),
            (1, [Some(0), Some(0), None]),
            (1, [Some(0), Some(1), None]),
            (2, [Some(0), Some(1), Some(0)]),
            (1, [Some(0), Some(0), Some(0)]),
            (1, [Some(0), Some(1), Some(0)]),
        ] {
            draft.take(&Mark::NextPile(at), 0.0);
            assert_eq!(draft, Draft::Piles(piles.to_vec()));
        }
        assert_eq!(draft.answer(), Ok(Answer::in_piles(&[0, 1, 0])));
    }

    #[test]
    fn what_is_missing_is_said_until_all_is_there() {
        let mut odd = draft("odd-one-out");
        assert_eq!(odd.answer(), Err("Choose one first"));
        odd.take(&Mark::Place(3), 0.0);
        assert!(odd.answer().is_err(), "there are three");
        odd.take(&Mark::Place(2), 0.0);
        assert_eq!(odd.answer(), Err("Say how hard that was"));
        odd.take(&Mark::Confidence(3), 0.0);
        assert!(odd.answer().is_ok());
        let mut judged = draft("real-or-generated");
        judged.take(&Mark::Place(1), 0.0);
        judged.take(&Mark::Confidence(4), 0.0);
        assert_eq!(judged.answer(), Err("Say how sure you are"));
        judged.take(&Mark::Confidence(3), 0.0);
        assert!(judged.answer().is_ok());
        let mut strength = draft("magnitude");
        for (typed, is_number) in [("", false), ("0", false), ("2,5", true), ("1e999", false)] {
            strength.take(&Mark::Type(typed.to_owned()), 0.0);
            assert_eq!(strength.answer().is_ok(), is_number, "{typed}");
        }
        let mut rated = draft("rating");
        rated.take(&Mark::Rate(0, 170.0), 0.0);
        assert!(rated.answer().is_err());
        for scale in 0..4 {
            rated.take(&Mark::Rate(scale, 25.0), 0.0);
        }
        assert_eq!(
            rated.answer(),
            Ok(AnswerValue::Ratings(vec![25.0; 4]).into())
        );
    }
}
