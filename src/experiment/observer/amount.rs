//! Answers that say of which there is more, and answers that are guesses.

use super::answer::{Participant, ordered};
use super::scale::NOISE_JND;
use crate::design::{Form, Scale, Sets};
use crate::trial::{Answer, AnswerValue, Task};
use selvedge_foundation::numerics::Random;

impl Participant<'_> {
    /// Positions in the order of what is asked of them, the most first: along the way from the
    /// first to the last stimulus of the design.
    pub(super) fn by_amount(&self, items: &[usize], random: &Random) -> Vec<usize> {
        let mut looks = random.branch("percepts");
        let amounts: Vec<f64> = items
            .iter()
            .map(|&item| -self.along(&self.seen(item, &mut looks)))
            .collect();
        ordered(&amounts, random)
    }

    /// The position with the most of what is asked.
    pub(super) fn most(&self, items: &[usize], random: &Random) -> Answer {
        let order = self.by_amount(items, random);
        Answer::chosen(order.first().copied().unwrap_or(0), self.confidence(0.0))
    }

    /// How far a percept lies on the way from the first to the last stimulus of the design, in
    /// just noticeable differences.
    fn along(&self, percept: &[f64]) -> f64 {
        let (Some(first), Some(last)) = (self.places.first(), self.places.last()) else {
            return 0.0;
        };
        let way = last.iter().zip(first).map(|(to, from)| to - from);
        let way: Vec<f64> = way.collect();
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-12);
        percept
            .iter()
            .zip(&way)
            .map(|(x, way)| x * way)
            .sum::<f64>()
            / length
    }

    /// The position that has most of what is adapted; of one alone, whether it has more than the
    /// reference.
    pub(super) fn more(&self, task: &Task, random: &Random) -> Answer {
        let composition = &self.design.composition;
        let (Some(adaptation), Some(adapted)) = (&composition.adaptation, task.adapted) else {
            return self.guess_chosen(composition.n_choices(), random);
        };
        let mut looks = random.branch("percepts");
        let noise = self.noise * NOISE_JND;
        let mut felt =
            |value: Option<f64>| self.adapted_jnd(adaptation, value) + noise * looks.normal();
        if composition.presentation.n == 1 {
            let [low, high] = adaptation.range;
            let middle = adaptation.reference.unwrap_or(0.5 * (low + high));
            let criterion = self.adapted_jnd(adaptation, Some(middle));
            let margin = felt(Some(adapted.value)) - criterion;
            return Answer::chosen(usize::from(margin <= 0.0), self.confidence(margin));
        }
        let felt: Vec<f64> = (0..composition.presentation.n)
            .map(|at| felt(task.adapted_at(adaptation, at)))
            .collect();
        let mut order: Vec<usize> = (0..felt.len()).collect();
        random.branch("ties").shuffle(&mut order);
        let most = order
            .into_iter()
            .max_by(|&a, &b| felt[a].total_cmp(&felt[b]));
        let is_told = composition.response.confidence.n_grades() > 0;
        let sure = is_told.then(|| self.confidence(0.0)).flatten();
        Answer::chosen(most.unwrap_or(0), sure)
    }

    pub(super) fn guess_chosen(&self, n: usize, random: &Random) -> Answer {
        let position = random.branch("guess").index(n);
        let confidence = self.guessed_confidence(&mut random.branch("guessed confidence"));
        Answer::chosen(position, confidence)
    }

    fn guessed_confidence(&self, random: &mut Random) -> Option<u8> {
        let grades: Vec<u8> = (1..=self.n_grades()?).collect();
        grades.get(random.index(grades.len())).copied()
    }

    /// An answer that has nothing to do with the stimuli.
    pub(super) fn guess(&self, task: &Task, random: &mut Random) -> Answer {
        let composition = &self.design.composition;
        let n = composition.presentation.n;
        let mut shuffled = |n: usize| {
            let mut order: Vec<usize> = (0..n).collect();
            random.shuffle(&mut order);
            order
        };
        match &composition.response.form {
            Form::Choice if composition.order.sets == Sets::Triads => {
                let position = random.index(n);
                Answer::chosen(position, self.guessed_confidence(random))
            }
            Form::Words(_) => {
                let position = random.index(2);
                Answer::chosen(position, self.guessed_confidence(random))
            }
            Form::Choice | Form::SameDifferent => {
                self.guess_chosen(composition.n_choices(), random)
            }
            Form::Rank => {
                let ranks = shuffled(n)
                    .into_iter()
                    .map(|at| u8::try_from(at + 1).unwrap_or(1));
                AnswerValue::Ranks(ranks.collect()).into()
            }
            Form::BestWorst(_) => {
                let order = shuffled(n);
                AnswerValue::BestWorst([order[0], order[n - 1]]).into()
            }
            Form::Number { .. } => {
                let noise = self.observer.habits.magnitude_noise * random.normal();
                AnswerValue::Number(self.modulus() * noise.exp()).into()
            }
            Form::Scales(scales) => {
                let anywhere = |scale: &Scale| {
                    let [low, high] = scale.bounds();
                    scale.placed(random.uniform_in(low, high))
                };
                AnswerValue::Ratings(scales.iter().map(anywhere).collect()).into()
            }
            Form::Piles => {
                let piles: Vec<usize> = (0..n).map(|_| random.index(n.div_ceil(3))).collect();
                Answer::in_piles(&piles)
            }
            Form::Adjustment(_) => self.left_anywhere(task.starts.len(), random),
        }
    }
}
