//! What has been answered so far of a trial, before it is handed in.

use selvedge_experiment::design::{Design, Scale, TunedParameter};
use selvedge_experiment::{Adjustment, Answer, Grade, N_RANKED, N_TRIAD, Task, Trial};
use selvedge_foundation::quantity;

/// A part of an answer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    /// This position is the next in rank, or is chosen.
    Place(usize),
    /// This position has this rank, from 0.
    Rank(usize, usize),
    /// What was placed last is taken back.
    TakeBack,
    /// How hard it was.
    Grade(Grade),
    /// Real or not.
    Real(bool),
    /// How sure, from 1.
    Confidence(u8),
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
    /// Play the vibration of this trial again, where that is allowed.
    Play,
}

/// An answer on its way.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) enum Draft {
    /// Nothing is asked.
    #[default]
    Nothing,
    /// The positions by rank.
    Ranks([Option<usize>; N_RANKED]),
    /// The odd one.
    Odd {
        /// Its position.
        position: Option<usize>,
        /// How hard it was.
        grade: Option<Grade>,
    },
    /// Parameters as they are now.
    Adjust {
        /// What they are, in the design's order.
        values: Vec<f64>,
        /// How they came there.
        steps: Vec<Adjustment>,
        /// What may be turned.
        parameters: Vec<TunedParameter>,
    },
    /// Real or generated.
    Judge {
        /// What was said.
        is_real: Option<bool>,
        /// How sure.
        sure: Sure,
    },
    /// One of several.
    Choose {
        /// How many there are.
        n: usize,
        /// Which.
        position: Option<usize>,
        /// How sure.
        sure: Sure,
    },
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

/// How sure somebody is, where that is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Sure {
    /// Grades that are offered; 0 asks for none.
    pub n_grades: u8,
    /// What was said, from 1.
    pub grade: Option<u8>,
}

impl Sure {
    fn of(n_grades: u8) -> Self {
        Self {
            n_grades,
            grade: None,
        }
    }

    fn is_said(self) -> bool {
        self.n_grades == 0 || self.grade.is_some()
    }

    fn take(&mut self, grade: u8) {
        if (1..=self.n_grades).contains(&grade) {
            self.grade = Some(grade);
        }
    }
}

impl Draft {
    /// An answer to a trial in which nothing was said yet.
    pub(crate) fn of(design: &Design, trial: &Trial) -> Self {
        let method = &design.method;
        let grades = method.confidence_grades();
        match &trial.task {
            Task::Rank { .. } => Self::Ranks([None; N_RANKED]),
            Task::OddOne { .. } => Self::Odd {
                position: None,
                grade: None,
            },
            Task::Adjust { starts, .. } => Self::Adjust {
                values: starts.clone(),
                steps: Vec::new(),
                parameters: method.parameters().to_vec(),
            },
            Task::Judge { .. } => Self::Judge {
                is_real: None,
                sure: Sure::of(grades),
            },
            Task::JudgePair { .. } | Task::Interval { .. } => Self::Choose {
                n: method.levels().map_or(2, |levels| levels.intervals),
                position: None,
                sure: Sure::of(grades),
            },
            Task::Estimate { .. } => Self::Magnitude(String::new()),
            Task::Rate { .. } => Self::Ratings {
                values: vec![None; method.scales().len()],
                scales: method.scales().to_vec(),
            },
        }
    }

    /// Takes a part of the answer, given so many ms after the trial began; what does not belong to
    /// it is ignored.
    pub(crate) fn take(&mut self, mark: &Mark, at_ms: f64) {
        match (self, mark) {
            (Self::Ranks(order), mark) => take_rank(order, mark),
            (Self::Odd { position, .. }, Mark::Place(at)) if *at < N_TRIAD => *position = Some(*at),
            (Self::Odd { grade, .. }, Mark::Grade(said)) => *grade = Some(*said),
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
            (Self::Judge { is_real, .. }, Mark::Real(said)) => *is_real = Some(*said),
            (Self::Choose { n, position, .. }, Mark::Place(at)) if at < n => *position = Some(*at),
            (Self::Judge { sure, .. } | Self::Choose { sure, .. }, Mark::Confidence(grade)) => {
                sure.take(*grade);
            }
            (Self::Magnitude(text), Mark::Type(typed)) => text.clone_from(typed),
            (Self::Ratings { values, scales }, Mark::Rate(at, to)) => {
                if let (Some(value), Some(scale)) = (values.get_mut(*at), scales.get(*at)) {
                    let [low, high] = scale.bounds();
                    *value = Some(to.clamp(low, high)).filter(|value| value.is_finite());
                }
            }
            _ => {}
        }
    }

    /// The answer; in its place, what is missing.
    pub(crate) fn answer(&self) -> Result<Answer, &'static str> {
        match self {
            Self::Nothing => Err("Nothing is asked now"),
            Self::Ranks(order) => ranks(order),
            Self::Odd { position, grade } => Ok(Answer::Odd {
                position: position.ok_or("Choose the odd one first")?,
                grade: grade.ok_or("Say how hard that was")?,
            }),
            Self::Adjust { values, steps, .. } => Ok(Answer::Adjusted {
                values: values.clone(),
                steps: steps.clone(),
            }),
            Self::Judge { is_real, sure } => {
                let is_real = is_real.ok_or("Say which it is first")?;
                if !sure.is_said() {
                    return Err("Say how sure you are");
                }
                Ok(Answer::Judged {
                    is_real,
                    confidence: sure.grade,
                })
            }
            Self::Choose { position, sure, .. } => {
                let position = position.ok_or("Choose one first")?;
                if !sure.is_said() {
                    return Err("Say how sure you are");
                }
                Ok(Answer::Chosen {
                    position,
                    confidence: sure.grade,
                })
            }
            Self::Magnitude(text) => {
                let number = text.trim().replace(',', ".").parse::<f64>();
                let is_strength = |value: &f64| *value > 0.0 && value.is_finite();
                let number = number.ok().filter(is_strength);
                number.map(Answer::Magnitude).ok_or("Type a number above 0")
            }
            Self::Ratings { values, .. } => {
                let all: Option<Vec<f64>> = values.iter().copied().collect();
                all.map(Answer::Ratings)
                    .ok_or("Place it on every scale first")
            }
        }
    }

    /// Whether what was said is handed in at once: where one of several is chosen, and nothing
    /// else is asked.
    pub(crate) fn is_handed_in_at_once(&self, task: &Task) -> bool {
        let is_interval = matches!(task, Task::Interval { .. });
        is_interval && self.answer().is_ok()
    }

    /// What was said so far, for the experimenter.
    pub(crate) fn describe(&self) -> String {
        match self {
            Self::Ranks(order) => {
                let name = |at: &Option<usize>| {
                    at.map_or_else(|| "·".to_owned(), |at| (at + 1).to_string())
                };
                order.iter().map(name).collect::<Vec<_>>().join(" ")
            }
            Self::Odd { position, .. } | Self::Choose { position, .. } => {
                position.map_or_else(String::new, |at| (at + 1).to_string())
            }
            Self::Judge { is_real, .. } => match is_real {
                Some(true) => "real".to_owned(),
                Some(false) => "generated".to_owned(),
                None => String::new(),
            },
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

fn take_rank(order: &mut [Option<usize>; N_RANKED], mark: &Mark) {
    match *mark {
        Mark::Place(position) if position < N_RANKED => {
            if order.contains(&Some(position)) {
                return;
            }
            if let Some(free) = order.iter_mut().find(|slot| slot.is_none()) {
                *free = Some(position);
            }
        }
        Mark::Rank(position, rank) if position < N_RANKED && rank < N_RANKED => {
            let from = order.iter().position(|slot| *slot == Some(position));
            // Who stood there takes the place that becomes free, if one does.
            let displaced = order[rank].replace(position);
            if let Some(from) = from
                && from != rank
            {
                order[from] = displaced;
            }
        }
        Mark::TakeBack => {
            if let Some(last) = order.iter_mut().rev().find(|slot| slot.is_some()) {
                *last = None;
            }
        }
        _ => {}
    }
}

fn ranks(order: &[Option<usize>; N_RANKED]) -> Result<Answer, &'static str> {
    let mut ranks = [0; N_RANKED];
    for (rank, position) in (1_u8..).zip(order) {
        let position = position.ok_or("Rank all four first")?;
        ranks[position] = rank;
    }
    Ok(Answer::Ranks(ranks))
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
        assert_eq!(draft.answer(), Ok(Answer::Ranks([2, 3, 1, 4])));
        draft.take(&Mark::Rank(3, 0), 0.0);
        assert_eq!(draft.answer(), Ok(Answer::Ranks([2, 3, 4, 1])), "exchanged");
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
        let Ok(Answer::Adjusted { values, steps }) = draft.answer() else {
            panic!("it is always an answer")
        };
        assert!(
            (values[0] - 20.0).abs() < 1e-9 && start < 20.0,
            "{values:?}"
        );
        assert!(!steps.is_empty() && steps.len() <= 2, "{steps:?}");
    }

    #[test]
    fn what_is_missing_is_said_until_all_is_there() {
        let mut odd = draft("odd-one-out");
        assert_eq!(odd.answer(), Err("Choose the odd one first"));
        odd.take(&Mark::Place(3), 0.0);
        assert!(odd.answer().is_err(), "there are three");
        odd.take(&Mark::Place(2), 0.0);
        odd.take(&Mark::Grade(Grade::Hard), 0.0);
        assert!(odd.answer().is_ok());
        let mut judged = draft("real-or-generated");
        judged.take(&Mark::Real(false), 0.0);
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
        assert_eq!(rated.answer(), Ok(Answer::Ratings(vec![25.0; 4])));
    }
}
