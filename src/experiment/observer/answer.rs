//! A subject that an observer is in a session, and its answers.

use super::percept::{distance, look};
use super::scale::{Jnd, NOISE_JND};
use super::{Observer, Stimuli, Strategy};
use crate::design::{Design, Method, Scale, Standard, Subject};
use crate::trial::{Answer, Grade, N_RANKED, N_TRIAD, Task, Trial};
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
    noise: f64,
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
        let standards = match design.method.standard() {
            None | Some(Standard::Virtual) => places.clone(),
            Some(Standard::RealCloth) => items.map(cloth).collect(),
            // A mind of one's own: what the library's tuning is for.
            Some(Standard::None) => items
                .map(|item| place(observer, stimuli, item, stimuli.cloth_gains_db(item)))
                .collect(),
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
        let response_s = response_s(self, &trial.task, &random);
        let is_lapse = random.branch("lapse").uniform() < self.observer.lapse;
        let answer = if is_lapse || self.observer.strategy == Strategy::None {
            self.guess(&trial.task, &mut random.branch("guess"))
        } else {
            self.considered(&trial.task, response_s, &random)
        };
        Reply { answer, response_s }
    }

    fn considered(&self, task: &Task, response_s: f64, random: &Random) -> Answer {
        match task {
            Task::Rank {
                target,
                alternatives,
            } => self.rank(*target, *alternatives, random),
            Task::OddOne { items, .. } => self.odd_one(*items, random),
            Task::Adjust { item, starts } => self.adjusted(*item, starts, response_s, random),
            Task::Judge { item, .. } => self.judged(*item, random),
            Task::JudgePair { items, .. } => self.judged_pair(*items, random),
            Task::Interval {
                level_db, signal, ..
            } => self.interval(*level_db, *signal, random),
            Task::Estimate { item } => Answer::Magnitude(self.magnitude(*item, random)),
            Task::Rate { item } => Answer::Ratings(self.ratings(*item, random)),
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

    /// In the order of their distances from the target.
    fn rank(&self, target: usize, alternatives: [usize; N_RANKED], random: &Random) -> Answer {
        let mut looks = random.branch("percepts");
        let target = look(&self.standards[target], self.explored, &mut looks);
        let target = self.kept(&target, &mut random.branch("memory"));
        let mut rank_noise = random.branch("rank noise");
        let distances = alternatives.map(|item| {
            let noise = self.observer.rank_noise_jnd * rank_noise.normal();
            self.apart(&target, &self.seen(item, &mut looks)) + noise
        });
        let mut order = [0, 1, 2, 3];
        // Those that are equally far come in an order by chance.
        random.branch("ties").shuffle(&mut order);
        order.sort_by(|&a, &b| distances[a].total_cmp(&distances[b]));
        let mut ranks = [0; N_RANKED];
        for (rank, position) in (1..).zip(order) {
            ranks[position] = rank;
        }
        Answer::Ranks(ranks)
    }

    /// The one that is not of the closest pair: the farthest from the other two.
    fn odd_one(&self, items: [usize; N_TRIAD], random: &Random) -> Answer {
        let mut looks = random.branch("percepts");
        let percepts = items.map(|item| self.seen(item, &mut looks));
        // By the position that each pair leaves out.
        let across = [[1, 2], [0, 2], [0, 1]].map(|[a, b]| self.apart(&percepts[a], &percepts[b]));
        let mut order = [0, 1, 2];
        random.branch("ties").shuffle(&mut order);
        order.sort_by(|&a, &b| across[a].total_cmp(&across[b]));
        let [odd, second, third] = order;
        let margin = (0.5 * (across[second] + across[third]) - across[odd]) / self.root_n();
        let [hard, easy] = self.observer.habits.grade_criteria_jnd;
        let grade = if margin < hard {
            Grade::Hard
        } else if margin < easy {
            Grade::Normal
        } else {
            Grade::Easy
        };
        Answer::Odd {
            position: odd,
            grade,
        }
    }

    /// Real where it lies near what the material should feel like.
    fn judged(&self, item: usize, random: &Random) -> Answer {
        let away = self.away(item, &mut random.branch("percepts"), random);
        let margin = self.observer.habits.real_criterion_jnd - away;
        Answer::Judged {
            is_real: margin > 0.0,
            confidence: self.confidence(margin),
        }
    }

    fn judged_pair(&self, items: [usize; 2], random: &Random) -> Answer {
        let mut looks = random.branch("percepts");
        let [first, second] = items.map(|item| self.away(item, &mut looks, random));
        let position = match first.total_cmp(&second) {
            std::cmp::Ordering::Less => 0,
            std::cmp::Ordering::Equal => random.branch("ties").index(2),
            std::cmp::Ordering::Greater => 1,
        };
        Answer::Chosen {
            position,
            confidence: self.confidence(first - second),
        }
    }

    /// How far a look at a stimulus is from what its material should feel like: the middle of the
    /// real ones of the material (of all, where it has none), as it is kept in mind.
    fn away(&self, item: usize, looks: &mut Random, random: &Random) -> f64 {
        let Method::Judgement(judging) = &self.design.method else {
            return 0.0;
        };
        let stimuli = &self.design.stimuli;
        let real: Vec<usize> = (0..stimuli.len())
            .filter(|&at| stimuli[at].condition == judging.real)
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
    fn confidence(&self, margin: f64) -> Option<u8> {
        let n_grades = self.n_grades()?;
        let reached = |grade: &u8| {
            let needed = self.observer.habits.confidence_jnd * f64::from(*grade - 1);
            margin.abs() >= needed
        };
        (1..=n_grades).rev().find(reached)
    }

    fn n_grades(&self) -> Option<u8> {
        Some(self.design.method.confidence_grades()).filter(|&n| n > 0)
    }

    /// The interval that feels strongest.
    fn interval(&self, level_db: f64, signal: usize, random: &Random) -> Answer {
        let Some(levels) = self.design.method.levels() else {
            return self.guess_chosen(2, random);
        };
        let jnd: Jnd = self.observer.jnd;
        let others_db = levels.reference_db.unwrap_or(f64::NEG_INFINITY);
        let mut looks = random.branch("percepts");
        let felt: Vec<f64> = (0..levels.intervals)
            .map(|at| {
                let db = if at == signal { level_db } else { others_db };
                let steps = jnd.steps(levels.band, db);
                steps + self.noise * NOISE_JND * looks.normal()
            })
            .collect();
        let mut order: Vec<usize> = (0..felt.len()).collect();
        random.branch("ties").shuffle(&mut order);
        let strongest = order
            .into_iter()
            .max_by(|&a, &b| felt[a].total_cmp(&felt[b]));
        Answer::Chosen {
            position: strongest.unwrap_or(0),
            confidence: None,
        }
    }

    fn guess_chosen(&self, n: usize, random: &Random) -> Answer {
        Answer::Chosen {
            position: random.branch("guess").index(n),
            confidence: self.guessed_confidence(&mut random.branch("guessed confidence")),
        }
    }

    fn guessed_confidence(&self, random: &mut Random) -> Option<u8> {
        let grades: Vec<u8> = (1..=self.n_grades()?).collect();
        grades.get(random.index(grades.len())).copied()
    }

    /// An answer that has nothing to do with the stimuli.
    fn guess(&self, task: &Task, random: &mut Random) -> Answer {
        match task {
            Task::Rank { .. } => {
                let mut ranks = [1, 2, 3, 4];
                random.shuffle(&mut ranks);
                Answer::Ranks(ranks)
            }
            Task::OddOne { .. } => Answer::Odd {
                position: random.index(N_TRIAD),
                grade: Grade::ALL[random.index(Grade::ALL.len())],
            },
            Task::Adjust { starts, .. } => self.left_anywhere(starts.len(), random),
            Task::Judge { .. } => Answer::Judged {
                is_real: random.index(2) == 0,
                confidence: self.guessed_confidence(random),
            },
            Task::JudgePair { .. } => self.guess_chosen(2, random),
            Task::Interval { .. } => {
                let n = self
                    .design
                    .method
                    .levels()
                    .map_or(2, |levels| levels.intervals);
                self.guess_chosen(n, random)
            }
            Task::Estimate { .. } => {
                let noise = self.observer.habits.magnitude_noise * random.normal();
                Answer::Magnitude(self.modulus() * noise.exp())
            }
            Task::Rate { .. } => {
                let mut anywhere = |scale: &Scale| {
                    let [low, high] = scale.bounds();
                    scale.placed(random.uniform_in(low, high))
                };
                Answer::Ratings(
                    self.design
                        .method
                        .scales()
                        .iter()
                        .map(&mut anywhere)
                        .collect(),
                )
            }
        }
    }
}

fn place(observer: &Observer, stimuli: &Stimuli, item: usize, gains_db: [f64; 2]) -> Vec<f64> {
    let levels = stimuli.levels(item);
    observer.strategy.place(observer.jnd, levels, gains_db)
}

/// Median time of a task, s; intervals come on top. All assumed, but that a ranking takes 30 to
/// 90 s.
fn median_s(task: &Task) -> f64 {
    match task {
        Task::Rank { .. } => 50.0,
        Task::OddOne { .. } | Task::Rate { .. } => 20.0,
        Task::Adjust { .. } => 30.0,
        Task::Judge { .. } => 8.0,
        Task::JudgePair { .. } => 12.0,
        Task::Interval { .. } => 1.0,
        Task::Estimate { .. } => 5.0,
    }
}

/// How long a subject takes for a trial, s, log-normal about the median. A subject that is quick is
/// quick in all.
fn response_s(participant: &Participant<'_>, task: &Task, random: &Random) -> f64 {
    let spread = participant.observer.habits.time_spread;
    let own = participant.person.branch("quickness").normal();
    let now = random.branch("time").normal();
    // As much between subjects as within one.
    let share = std::f64::consts::FRAC_1_SQRT_2 * (own + now);
    let shown_s = participant.design.method.levels().map_or(0.0, |levels| {
        f64::from(levels.interval_ms) * levels.intervals as f64 / 1000.0
    });
    shown_s + median_s(task) * (spread * share).exp()
}
