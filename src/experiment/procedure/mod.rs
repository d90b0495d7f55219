//! Procedures: pure state machines that say what is asked next, given all that was answered.
//!
//! A procedure is a function of design, subject and answers alone. It draws no chance from
//! anywhere else and knows no clock, so a session is resumed by answering again what its log
//! holds.

mod adaptive;
mod listed;

use adaptive::Adaptive;
pub(super) use adaptive::quest_plus;

use super::ExperimentError;
use super::design::{Composition, Design, Subject};
use super::schedule::subject_random;
use super::trial::{Answer, AnswerError, Trial};
use selvedge_foundation::numerics::Random;

/// What a subject is asked in a session.
#[derive(Debug, Clone)]
pub struct Procedure(Kind);

#[derive(Debug, Clone)]
enum Kind {
    /// All is known before the first answer.
    Listed {
        trials: Vec<Trial>,
        n_answered: usize,
        /// What is asked.
        composition: Box<Composition>,
    },
    /// The next trial depends on the answers.
    Adaptive(Box<Adaptive>),
}

impl Procedure {
    /// The procedure of a subject, practice first.
    ///
    /// # Errors
    /// The design has no schedule.
    pub fn of(design: &Design, subject: &Subject) -> Result<Self, ExperimentError> {
        let random = session_random(design, subject);
        if let Some(adaptation) = &design.composition.adaptation
            && let Some(adaptive) = Adaptive::of(design, adaptation, &random)?
        {
            return Ok(Self(Kind::Adaptive(Box::new(adaptive))));
        }
        Ok(Self(Kind::Listed {
            trials: listed::trials(design, subject, &random)?,
            n_answered: 0,
            composition: Box::new(design.composition.clone()),
        }))
    }

    /// The trial that waits for an answer; `None` when all is answered.
    pub fn trial(&self) -> Option<&Trial> {
        match &self.0 {
            Kind::Listed {
                trials, n_answered, ..
            } => trials.get(*n_answered),
            Kind::Adaptive(adaptive) => adaptive.trial(),
        }
    }

    /// Every trial in order, where all is known before the first answer.
    pub fn listed(&self) -> &[Trial] {
        match &self.0 {
            Kind::Listed { trials, .. } => trials,
            Kind::Adaptive(_) => &[],
        }
    }

    /// How many trials were answered, practice included.
    pub fn n_answered(&self) -> usize {
        match &self.0 {
            Kind::Listed { n_answered, .. } => *n_answered,
            Kind::Adaptive(adaptive) => adaptive.n_answered(),
        }
    }

    /// How many there will be at most, practice included.
    pub fn n_trials(&self) -> usize {
        match &self.0 {
            Kind::Listed { trials, .. } => trials.len(),
            Kind::Adaptive(adaptive) => adaptive.n_trials(),
        }
    }

    /// Takes the answer to the trial that waits: whether it is right, where that can be said.
    ///
    /// # Errors
    /// It is no answer to it; the trial still waits.
    pub(crate) fn answer(&mut self, answer: &Answer) -> Result<Option<bool>, AnswerError> {
        match &mut self.0 {
            Kind::Listed {
                trials,
                n_answered,
                composition,
            } => {
                let Some(trial) = trials.get(*n_answered) else {
                    return Err(AnswerError::value("all is answered", "end the session"));
                };
                let verdict = composition.verdict(&trial.task, answer)?;
                *n_answered += 1;
                Ok(verdict)
            }
            Kind::Adaptive(adaptive) => adaptive.answer(answer),
        }
    }
}

/// The generator of a subject's session. The first session is that of the subject alone.
fn session_random(design: &Design, subject: &Subject) -> Random {
    let random = subject_random(design.seed, &design.experiment, &subject.pseudonym);
    match subject.session {
        0 | 1 => random,
        nth => random.branch(&format!("session {nth}")),
    }
}
