//! Simulated observers: answers to trials from what the stimuli are physically.
//!
//! ```text
//! levels of a stimulus ─▶ place in just noticeable differences ─▶ a noisy look ─▶ an answer
//! ```
//!
//! What sets the noise is published ([`Jnd::Published`]) and is not tuned to any outcome. All else
//! that an observer needs in order to answer is assumed, and stands in [`Habits`] and in
//! [`Strategy`] with that word. Nobody tires, and nothing changes from trial to trial.
//! How a hand moves is not simulated: levels are those at one speed.
//!
//! # Invariants
//! - an answer is a function of observer, seed, design, stimuli, subject and trial: neither the
//!   order of trials nor threads change it
//! - the same percepts, lapses and times of response come from branches of their own

mod adjust;
mod amount;
mod answer;
mod led;
mod measure;
mod percept;
mod scale;
mod strength;

pub(crate) use answer::Participant;
pub use measure::Stimuli;
pub use percept::{Strategy, Weighting};
pub use scale::Jnd;

use super::ExperimentError;

/// How an observer feels and answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// What is gone by.
    pub strategy: Strategy,
    /// What each coordinate of that counts.
    pub weighting: Weighting,
    /// How small a difference of level is noticed.
    pub jnd: Jnd,
    /// Independent looks that exploring a stimulus is worth, averaged; an interval of a threshold
    /// is always one. Published differences are those of one.
    pub looks: u32,
    /// How much subjects differ in that: standard deviation of the logarithm of their noise.
    pub jnd_spread: f64,
    /// The share of trials that are answered by a guess.
    pub lapse: f64,
    /// Noise on each distance that is ranked, in just noticeable differences.
    pub rank_noise_jnd: f64,
    /// Noise that keeping a target in mind adds to each of its coordinates, in just noticeable
    /// differences.
    pub memory_noise_jnd: f64,
    /// Standard deviation of the difference of level between a real cloth and its virtual one, dB
    /// in each band; drawn once a textile, the same for all subjects of a seed.
    pub real_error_db: f64,
    /// What is assumed beyond this.
    pub habits: Habits,
}

impl Default for Observer {
    /// Levels alone, published differences, one look, and nothing else: no lapses, no further
    /// noise, no error of the model.
    fn default() -> Self {
        Self {
            strategy: Strategy::LevelOnly,
            weighting: Weighting::Equal,
            jnd: Jnd::Published,
            looks: 1,
            jnd_spread: 0.0,
            lapse: 0.0,
            rank_noise_jnd: 0.0,
            memory_noise_jnd: 0.0,
            real_error_db: 0.0,
            habits: Habits::default(),
        }
    }
}

/// How an observer turns percepts into answers where a task leaves that open. All assumed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Habits {
    /// The odd one was hard to find below the first and easy from the second on: how much farther
    /// it is from the others than they are from each other, in just noticeable differences a
    /// coordinate (root mean square).
    pub(crate) grade_criteria_jnd: [f64; 2],
    /// What lies nearer than this to what the material should feel like is called real, in just
    /// noticeable differences a coordinate (root mean square).
    pub(crate) real_criterion_jnd: f64,
    /// How much farther from the criterion makes one grade of confidence more, likewise.
    pub(crate) confidence_jnd: f64,
    /// Two that lie nearer than this are called the same, in just noticeable differences a
    /// coordinate (root mean square).
    pub(crate) same_criterion_jnd: f64,
    /// Two so far apart are called unlike by 63 % of a scale, likewise.
    pub(crate) unlike_jnd: f64,
    /// What lies nearer than this to the middle of a pile is laid there, likewise.
    pub(crate) pile_jnd: f64,
    /// Turning ends once the difference to the standard is below this, in just noticeable
    /// differences a coordinate: where it began shows in where it ends.
    pub(crate) satisfied_jnd: f64,
    /// Standard deviation of the logarithm of subjects' own moduli of numbers.
    pub(crate) modulus_spread: f64,
    /// Standard deviation of the logarithm of subjects' exponents of strength.
    pub(crate) exponent_spread: f64,
    /// Standard deviation of the logarithm of a number that is given again.
    pub(crate) magnitude_noise: f64,
    /// Standard deviation of a rating that is given again, as a share of its scale.
    pub(crate) rating_noise: f64,
    /// The difference of two turns that is just noticed, degrees, wherever it is.
    pub(crate) turn_jnd_deg: f64,
    /// The difference of two lengths of time that is just noticed, as a share of the shorter.
    pub(crate) duration_weber: f64,
    /// Standard deviation of the logarithm of times of response.
    pub(crate) time_spread: f64,
}

impl Default for Habits {
    fn default() -> Self {
        Self {
            grade_criteria_jnd: [1.0, 2.0],
            real_criterion_jnd: 1.5,
            confidence_jnd: 0.5,
            same_criterion_jnd: 1.5,
            unlike_jnd: 5.0,
            pile_jnd: 3.0,
            satisfied_jnd: 0.5,
            modulus_spread: 1.0,
            exponent_spread: 0.1,
            magnitude_noise: 0.2,
            rating_noise: 0.05,
            turn_jnd_deg: 10.0,
            duration_weber: 0.2,
            time_spread: 0.35,
        }
    }
}

impl Observer {
    /// Refuses what no observer can have.
    ///
    /// # Errors
    /// A share outside 0…1, a difference that is not above 0, a noise below 0.
    pub fn check(&self) -> Result<(), ExperimentError> {
        let wrong = |what: String, mend: &str| Err(ExperimentError::value(what, mend));
        if !(0.0..=1.0).contains(&self.lapse) {
            let what = format!("the share of lapses is {}", self.lapse);
            return wrong(what, "give 0 to 1");
        }
        if let Jnd::Fixed(jnd_db) = self.jnd {
            let is_jnd = |db: &f64| (1e-6..=1e6).contains(db);
            if !jnd_db.iter().all(is_jnd) {
                let what = format!("just noticeable differences are {jnd_db:?} dB");
                return wrong(what, "give two numbers above 0, such as 2.4,2.4");
            }
        }
        if self.looks == 0 {
            return wrong("nothing is looked at".to_owned(), "give 1 look or more");
        }
        let noises = [
            ("the spread of noise between subjects", self.jnd_spread),
            ("the noise of ranks", self.rank_noise_jnd),
            ("the noise of memory", self.memory_noise_jnd),
            (
                "the error between real and virtual cloth",
                self.real_error_db,
            ),
        ];
        let is_noise = |noise: f64| (0.0..=1e6).contains(&noise);
        match noises.iter().find(|(_, noise)| !is_noise(*noise)) {
            None => Ok(()),
            Some((name, noise)) => wrong(format!("{name} is {noise}"), "give 0 or more"),
        }
    }

    /// In a line, as logs hold it.
    pub fn describe(&self) -> String {
        let jnd = match self.jnd {
            Jnd::Published => "published".to_owned(),
            Jnd::Fixed([low, high]) => format!("{low} and {high} dB"),
        };
        let Self {
            looks,
            jnd_spread,
            lapse,
            rank_noise_jnd,
            memory_noise_jnd,
            real_error_db,
            ..
        } = self;
        format!(
            "strategy {}, weights {}, just noticeable differences {jnd}, looks {looks}, spread \
             {jnd_spread}, lapse {lapse}, rank noise {rank_noise_jnd}, memory noise \
             {memory_noise_jnd}, real error {real_error_db} dB",
            self.strategy.name(),
            self.weighting.name()
        )
    }
}

#[cfg(test)]
pub(super) mod tests;
