//! Procedures: pure state machines that say what is asked next, given all that was answered.
//!
//! A procedure is a function of design, subject and answers alone. It draws no chance from
//! anywhere else and knows no clock, so a session is resumed by answering again what its log
//! holds.

mod listed;

use super::ExperimentError;
use super::design::{Design, Method, Subject, Track};
use super::schedule::subject_random;
use super::trial::{Answer, AnswerError, Trial};
use crate::numerics::Random;

/// What a subject is asked in a session.
#[derive(Debug, Clone)]
pub struct Procedure {
    trials: Vec<Trial>,
    n_answered: usize,
}

impl Procedure {
    /// The procedure of a subject, practice first.
    ///
    /// # Errors
    /// The design has no schedule.
    pub fn of(design: &Design, subject: &Subject) -> Result<Self, ExperimentError> {
        let random = session_random(design, subject);
        let trials = listed::trials(design, subject, &random)?;
        Ok(Self {
            trials,
            n_answered: 0,
        })
    }

    /// The trial that waits for an answer; `None` when all is answered.
    pub fn trial(&self) -> Option<&Trial> {
        self.trials.get(self.n_answered)
    }

    /// How many trials were answered, practice included.
    pub fn n_answered(&self) -> usize {
        self.n_answered
    }

    /// How many there will be at most, practice included.
    pub fn n_trials(&self) -> usize {
        self.trials.len()
    }

    /// Takes the answer to the trial that waits: whether it is right, where that can be said.
    ///
    /// # Errors
    /// It is no answer to it; the trial still waits.
    pub fn answer(&mut self, answer: &Answer) -> Result<Option<bool>, AnswerError> {
        let Some(trial) = self.trial() else {
            return Err(AnswerError::value("all is answered", "end the session"));
        };
        let verdict = trial.task.verdict(answer)?;
        self.n_answered += 1;
        Ok(verdict)
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
