//! A subject that an observer is in a session, and its answers.

use super::percept::{distance, look};
use super::scale::NOISE_JND;
use super::{Observer, Stimuli, Strategy};
use crate::design::{Design, Form, Sets, Standard, Subject};
use crate::trial::{Answer, AnswerValue, Task, Trial};
use selvedge_foundation::numerics::Random;

/// What came of a trial.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Reply {
    /// The answer.
    pub answer: Answer,
    /// How long it took, s.
    pub(crate) response_s: f64,
}

/// An observer as a subject of a session.
#[derive(Debug, Clone)]
pub(crate) struct Participant<'a> {
    pub(super) design: &'a Design,
    pub(super) stimuli: &'a Stimuli,
    pub(super) observer: &'a Observer,
    /// The subject's own generator: what it is like.
    pub(super) person: Random,
    /// The generator of its session.
    session: Random,
    /// Of the noise of one look, relative to everybody's.
    pub(super) noise: f64,
    /// Of the noise of what was explored.
    pub(super) explored: f64,
    /// By coordinate.
    pub(super) weights: Vec<f64>,
    /// By stimulus, as it is presented.
    pub(super) places: Vec<Vec<f64>>,
    /// By stimulus, as the standard that it is compared with.
    pub(super) standards: Vec<Vec<f64>>,
}

impl<'a> Participant<'a> {
    /// The subject that this observer is. Subjects of one seed share the errors of the model.
    pub(crate) fn new(
        (design, stimuli): (&'a Design, &'a Stimuli),
        observer: &'a Observer,
        seed: u64,
        subject: &Subject,
    ) -> Self {
        let random = Random::new(seed).branch("observers");
        let person = random.branch(&subject.pseudonym);
        let session = person
            .branch(&design.experiment)
            .branch(&format!("session {}", subject.session));
        let noise = (observer.jnd_spread * person.branch("noise").normal()).exp();
        let errors = random.branch("real cloth");
        let cloth = |item: usize| {
            let mut error = errors.branch(stimuli.name(item));
            let gains_db = stimuli.cloth_gains_db(item);
            let gains_db = gains_db.map(|db| db + observer.real_error_db * error.normal());
            place(observer, stimuli, item, gains_db)
        };
        let presented = |item: usize| {
            if stimuli.is_cloth(item) {
                return cloth(item);
            }
            let gains_db = stimuli.gains_db(item, &stimuli.tuning());
            place(observer, stimuli, item, gains_db)
        };
        let items = 0..design.stimuli.len();
        let places: Vec<Vec<f64>> = items.clone().map(presented).collect();
        let is_adjusted = matches!(design.composition.response.form, Form::Adjustment(_));
        let standards = match design.composition.presentation.reference {
            Standard::RealCloth => items.map(cloth).collect(),
            // A mind of one's own: what the library's tuning is for.
            Standard::None if is_adjusted => items
                .map(|item| place(observer, stimuli, item, stimuli.cloth_gains_db(item)))
                .collect(),
            _ => places.clone(),
        };
        let explored = noise / f64::from(observer.looks.max(1)).sqrt();
        Self {
            design,
            stimuli,
            observer,
            person,
            session,
            noise,
            explored,
            weights: observer.weighting.weights(&places, explored),
            places,
            standards,
        }
    }

    /// Answers a trial, whatever was answered before.
    pub(crate) fn answer(&self, trial: &Trial, attempt: u32) -> Reply {
        let kind = if trial.is_practice {
            "practice"
        } else {
            "trial"
        };
        let random = self
            .session
            .branch(&format!("{kind} {} attempt {attempt}", trial.number));
        let response_s = response_s(self, &random);
        let is_lapse = random.branch("lapse").uniform() < self.observer.lapse;
        let answer = if is_lapse || self.observer.strategy == Strategy::None {
            self.guess(&trial.task, &mut random.branch("guess"))
        } else {
            self.considered(&trial.task, response_s, &random)
        };
        Reply { answer, response_s }
    }

    fn considered(&self, task: &Task, response_s: f64, random: &Random) -> Answer {
        let composition = &self.design.composition;
        let sets = composition.order.sets;
        match &composition.response.form {
            _ if sets == Sets::Adapted => self.more(task, random),
            Form::Choice => match sets {
                Sets::Triads => self.odd_one(&task.items, random),
                Sets::Opposed => self.judged_pair(&task.items, random),
                Sets::Targets => {
                    let order = self.by_likeness(task, random);
                    Answer::chosen(order.first().copied().unwrap_or(0), self.confidence(0.0))
                }
                _ => self.most(&task.items, random),
            },
            Form::Words(_) => self.judged(task.item().unwrap_or(0), random),
            Form::SameDifferent => self.same_or_different(&task.items, random),
            Form::Rank if sets == Sets::Targets => {
                Answer::in_order(&self.by_likeness(task, random))
            }
            Form::Rank => Answer::in_order(&self.by_amount(&task.items, random)),
            Form::BestWorst(_) => {
                let order = self.by_amount(&task.items, random);
                let ends = [order.first(), order.last()];
                AnswerValue::BestWorst(ends.map(|at| at.copied().unwrap_or(0))).into()
            }
            Form::Scales(scales) if task.items.len() > 1 => {
                let unlike = self.unlikeness(&task.items, random);
                AnswerValue::Ratings(scales.iter().map(|s| s.at_share(unlike)).collect()).into()
            }
            Form::Scales(_) => {
                AnswerValue::Ratings(self.ratings(task.item().unwrap_or(0), random)).into()
            }
            Form::Number { .. } if task.items.len() > 1 => {
                let unlike = self.unlikeness(&task.items, random);
                AnswerValue::Number(self.modulus() * unlike.max(1e-3)).into()
            }
            Form::Number { .. } => AnswerValue::Number(self.magnitude(task, random)).into(),
            Form::Piles => self.piles(&task.items, random),
            Form::Adjustment(_) => {
                let item = task.item().unwrap_or(0);
                self.adjusted(item, &task.starts, response_s, random)
            }
        }
    }

    /// A fresh look at a stimulus as it is presented.
    pub(super) fn seen(&self, item: usize, random: &mut Random) -> Vec<f64> {
        look(&self.places[item], self.explored, random)
    }

    /// A percept that was kept in mind.
    pub(super) fn kept(&self, percept: &[f64], random: &mut Random) -> Vec<f64> {
        look(percept, self.observer.memory_noise_jnd / NOISE_JND, random)
    }

    pub(super) fn apart(&self, one: &[f64], other: &[f64]) -> f64 {
        distance(one, other, &self.weights)
    }

    /// The root of all weights: distances over it are a coordinate's.
    pub(super) fn root_n(&self) -> f64 {
        let n: f64 = self.weights.iter().sum();
        n.max(1e-12).sqrt()
    }

    /// Positions in the order of their distances from the target.
    fn by_likeness(&self, task: &Task, random: &Random) -> Vec<usize> {
        let mut looks = random.branch("percepts");
        let target = task.reference.unwrap_or(0);
        let target = look(&self.standards[target], self.explored, &mut looks);
        let target = self.kept(&target, &mut random.branch("memory"));
        let mut rank_noise = random.branch("rank noise");
        let distances: Vec<f64> = task
            .items
            .iter()
            .map(|&item| {
                let noise = self.observer.rank_noise_jnd * rank_noise.normal();
                self.apart(&target, &self.seen(item, &mut looks)) + noise
            })
            .collect();
        ordered(&distances, random)
    }

    /// The one that is not of the closest pair: the farthest from the other two.
    fn odd_one(&self, items: &[usize], random: &Random) -> Answer {
        let mut looks = random.branch("percepts");
        let percepts: Vec<Vec<f64>> = items
            .iter()
            .map(|item| self.seen(*item, &mut looks))
            .collect();
        let [first, second, third] = percepts.as_slice() else {
            return self.guess_chosen(items.len(), random);
        };
        // By the position that each pair leaves out.
        let across = [[second, third], [first, third], [first, second]];
        let across = across.map(|[a, b]| self.apart(a, b));
        let order = ordered(&across, random);
        let others = 0.5 * (across[order[1]] + across[order[2]]);
        let margin = (others - across[order[0]]) / self.root_n();
        let grade = match self.design.composition.response.confidence.words().len() {
            0 => self.confidence(margin),
            n => Some(self.grade(margin, n)),
        };
        Answer::chosen(order[0], grade)
    }

    /// How hard it was by the margin: the last word where it was hardest.
    fn grade(&self, margin: f64, n_words: usize) -> u8 {
        let criteria = self.observer.habits.grade_criteria_jnd;
        let n_reached = criteria
            .iter()
            .filter(|criterion| margin >= **criterion)
            .count();
        u8::try_from(n_words.saturating_sub(n_reached).max(1)).unwrap_or(1)
    }

    /// The same where the two lie nearer than the criterion.
    fn same_or_different(&self, items: &[usize], random: &Random) -> Answer {
        let mut looks = random.branch("percepts");
        let mut percept = |at: usize| self.seen(items.get(at).copied().unwrap_or(0), &mut looks);
        let (first, second) = (percept(0), percept(1));
        let away = self.apart(&first, &second) / self.root_n();
        let margin = self.observer.habits.same_criterion_jnd - away;
        Answer::chosen(usize::from(margin < 0.0), self.confidence(margin))
    }

    /// How unlike two are as a share: nothing for the same percept, one for what has nothing in
    /// common.
    fn unlikeness(&self, items: &[usize], random: &Random) -> f64 {
        let mut looks = random.branch("percepts");
        let mut percept = |at: usize| self.seen(items.get(at).copied().unwrap_or(0), &mut looks);
        let (first, second) = (percept(0), percept(1));
        let away = self.apart(&first, &second) / self.root_n();
        let noise = self.observer.habits.rating_noise * random.branch("rating").normal();
        1.0 - (-away / self.observer.habits.unlike_jnd).exp() + noise
    }

    /// Each joins the nearest pile whose middle is near enough, or begins one.
    fn piles(&self, items: &[usize], random: &Random) -> Answer {
        let mut looks = random.branch("percepts");
        let near = self.observer.habits.pile_jnd;
        let mut piles: Vec<Vec<Vec<f64>>> = Vec::new();
        let mut of = Vec::with_capacity(items.len());
        for &item in items {
            let percept = self.seen(item, &mut looks);
            let away = |pile: &Vec<Vec<f64>>| self.apart(&middle(pile), &percept) / self.root_n();
            let nearest = (0..piles.len())
                .map(|at| (at, away(&piles[at])))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let at = match nearest {
                Some((at, away)) if away < near => at,
                _ => {
                    piles.push(Vec::new());
                    piles.len() - 1
                }
            };
            piles[at].push(percept);
            of.push(at);
        }
        Answer::in_piles(&of)
    }

    /// Real where it lies near what the material should feel like.
    fn judged(&self, item: usize, random: &Random) -> Answer {
        let away = self.away(item, &mut random.branch("percepts"), random);
        let margin = self.observer.habits.real_criterion_jnd - away;
        Answer::chosen(usize::from(margin <= 0.0), self.confidence(margin))
    }

    fn judged_pair(&self, items: &[usize], random: &Random) -> Answer {
        let mut looks = random.branch("percepts");
        let mut away = |at: usize| {
            let item = items.get(at).copied().unwrap_or(0);
            self.away(item, &mut looks, random)
        };
        let (first, second) = (away(0), away(1));
        let position = match first.total_cmp(&second) {
            std::cmp::Ordering::Less => 0,
            std::cmp::Ordering::Equal => random.branch("ties").index(2),
            std::cmp::Ordering::Greater => 1,
        };
        Answer::chosen(position, self.confidence(first - second))
    }

    /// How far a look at a stimulus is from what its material should feel like: the middle of the
    /// real ones of the material (of all, where it has none), as it is kept in mind.
    fn away(&self, item: usize, looks: &mut Random, random: &Random) -> f64 {
        let Some(condition) = self.design.composition.right_condition() else {
            return 0.0;
        };
        let stimuli = &self.design.stimuli;
        let real: Vec<usize> = (0..stimuli.len())
            .filter(|&at| stimuli[at].condition == condition)
            .collect();
        let is_its = |at: &usize| stimuli[*at].material == stimuli[item].material;
        let own: Vec<usize> = real.iter().copied().filter(is_its).collect();
        let of = if own.is_empty() { real } else { own };
        let n = of.len().max(1) as f64;
        let mean = |axis: usize| of.iter().map(|&at| self.places[at][axis]).sum::<f64>() / n;
        let middle: Vec<f64> = (0..self.places[item].len()).map(mean).collect();
        let middle = self.kept(&middle, &mut random.branch("memory"));
        self.apart(&self.seen(item, looks), &middle) / self.root_n()
    }

    /// One grade more for every so much of a margin, where grades are asked for.
    pub(super) fn confidence(&self, margin: f64) -> Option<u8> {
        let n_grades = self.n_grades()?;
        let reached = |grade: &u8| {
            let needed = self.observer.habits.confidence_jnd * f64::from(*grade - 1);
            margin.abs() >= needed
        };
        (1..=n_grades).rev().find(reached)
    }

    pub(super) fn n_grades(&self) -> Option<u8> {
        Some(self.design.composition.response.confidence.n_grades()).filter(|&n| n > 0)
    }
}

/// Numbers from the least to the most, by their positions; those that are equal come in an order by
/// chance.
pub(super) fn ordered(numbers: &[f64], random: &Random) -> Vec<usize> {
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    random.branch("ties").shuffle(&mut order);
    order.sort_by(|&a, &b| numbers[a].total_cmp(&numbers[b]));
    order
}

/// The mean of several percepts.
fn middle(percepts: &[Vec<f64>]) -> Vec<f64> {
    let n_axes = percepts.first().map_or(0, Vec::len);
    let mean = |axis: usize| {
        percepts.iter().map(|percept| percept[axis]).sum::<f64>() / percepts.len() as f64
    };
    (0..n_axes).map(mean).collect()
}

fn place(observer: &Observer, stimuli: &Stimuli, item: usize, gains_db: [f64; 2]) -> Vec<f64> {
    let levels = stimuli.levels(item);
    observer.strategy.place(observer.jnd, levels, gains_db)
}

/// How long a subject takes for a trial, s, log-normal about the median. A subject that is quick is
/// quick in all.
fn response_s(participant: &Participant<'_>, random: &Random) -> f64 {
    let spread = participant.observer.habits.time_spread;
    let own = participant.person.branch("quickness").normal();
    let now = random.branch("time").normal();
    // As much between subjects as within one.
    let share = std::f64::consts::FRAC_1_SQRT_2 * (own + now);
    let [shown_s, median_s] = participant.design.composition.trial_s();
    shown_s + median_s * (spread * share).exp()
}
