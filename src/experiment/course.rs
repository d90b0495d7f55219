//! The course of a session: instructions, familiarisation, practice, trials, breaks, the end.
//!
//! A pure state machine over a [`Procedure`]. A trial that is aborted comes again as another
//! attempt; a session is resumed by giving its course the records of its log.

use super::ExperimentError;
use super::design::{CourseSettings, Design, Familiarisation, Subject};
use super::procedure::Procedure;
use super::record::{Outcome, Record};
use super::trial::{Answer, AnswerError, Trial};

/// What happens now.
#[derive(Debug, Clone, PartialEq)]
pub enum Step<'a> {
    /// The participant reads.
    Instructions(&'a str),
    /// The participant practises a movement.
    Familiarisation(Familiarisation),
    /// A trial waits for its answer.
    Trial(&'a Trial),
    /// A break of at least so many seconds.
    Break {
        /// The block that was ended, from 0.
        after_block: usize,
        /// Its least length, s.
        least_s: f64,
    },
    /// All is answered.
    Finished,
}

/// The course of a session.
#[derive(Debug, Clone)]
pub struct Course {
    settings: CourseSettings,
    procedure: Procedure,
    /// Steps before the first trial that are over: instructions, then each familiarisation.
    n_begun: usize,
    attempt: u32,
    /// The block after which a break is due.
    break_after: Option<usize>,
}

impl Course {
    /// The course of a subject's session from its beginning.
    ///
    /// # Errors
    /// The design has no schedule.
    pub fn begin(design: &Design, subject: &Subject) -> Result<Self, ExperimentError> {
        Ok(Self {
            settings: design.course.clone(),
            procedure: Procedure::of(design, subject)?,
            n_begun: 0,
            attempt: 1,
            break_after: None,
        })
    }

    /// The course after what a log holds. Instructions and familiarisation come again: who sits
    /// down later has forgotten them; [`pass`](Self::pass) goes over them.
    ///
    /// # Errors
    /// A record is none of this design and subject: its number, from 0, is in the message.
    pub fn resume(
        design: &Design,
        subject: &Subject,
        records: &[Record],
    ) -> Result<Self, ExperimentError> {
        let mut course = Self::begin(design, subject)?;
        for (nth, record) in records.iter().enumerate() {
            course.take(record).map_err(|what| {
                let what = format!("row {} of the log is not of this design: {what}", nth + 1);
                let mend = "resume with the design and the program that it was begun with";
                ExperimentError::value(what, mend)
            })?;
        }
        course.break_after = None;
        Ok(course)
    }

    fn take(&mut self, record: &Record) -> Result<(), String> {
        let Some(trial) = self.procedure.trial() else {
            return Err("no trial is left".to_owned());
        };
        if *trial != record.trial || record.attempt != self.attempt {
            return Err(format!(
                "trial {} was expected, at attempt {}",
                trial.number + 1,
                self.attempt
            ));
        }
        match &record.outcome {
            Outcome::Aborted => self.abort(),
            Outcome::Answered(answer) => {
                self.answered(answer).map_err(|error| error.to_string())?;
            }
        }
        Ok(())
    }

    /// What happens now.
    pub fn step(&self) -> Step<'_> {
        let has_text = usize::from(!self.settings.instructions.is_empty());
        if self.n_begun < has_text {
            return Step::Instructions(&self.settings.instructions);
        }
        if let Some(movement) = self.settings.familiarisation.get(self.n_begun - has_text) {
            return Step::Familiarisation(*movement);
        }
        if let Some(after_block) = self.break_after {
            let least_s = self.settings.break_s;
            return Step::Break {
                after_block,
                least_s,
            };
        }
        self.procedure.trial().map_or(Step::Finished, Step::Trial)
    }

    /// What is asked in which order.
    pub(crate) fn procedure(&self) -> &Procedure {
        &self.procedure
    }

    /// Whether every trial was answered.
    pub fn is_over(&self) -> bool {
        self.procedure.trial().is_none()
    }

    /// Which attempt at the trial that waits this is, from 1.
    pub fn attempt(&self) -> u32 {
        self.attempt
    }

    /// Trials answered and trials there will be at most, practice included.
    pub fn progress(&self) -> (usize, usize) {
        (self.procedure.n_answered(), self.procedure.n_trials())
    }

    /// Goes on from instructions, a movement or a break; a trial waits for its answer.
    pub fn pass(&mut self) {
        match self.step() {
            Step::Instructions(_) | Step::Familiarisation(_) => self.n_begun += 1,
            Step::Break { .. } => self.break_after = None,
            Step::Trial(_) | Step::Finished => {}
        }
    }

    /// Answers the trial that waits: whether it is right, where that can be said.
    ///
    /// # Errors
    /// It is no answer to it, or no trial waits.
    pub(crate) fn answer(&mut self, answer: &Answer) -> Result<Option<bool>, AnswerError> {
        if !matches!(self.step(), Step::Trial(_)) {
            return Err(AnswerError::value(
                "no trial waits",
                "go on to the trial first",
            ));
        }
        self.answered(answer)
    }

    fn answered(&mut self, answer: &Answer) -> Result<Option<bool>, AnswerError> {
        let block = self
            .procedure
            .trial()
            .map(|trial| (trial.is_practice, trial.block));
        let verdict = self.procedure.answer(answer)?;
        self.attempt = 1;
        let next = self
            .procedure
            .trial()
            .map(|trial| (trial.is_practice, trial.block));
        self.break_after = match (block, next) {
            (Some((false, ended)), Some((_, begun))) if ended != begun => {
                let after = self.settings.break_after_blocks;
                let is_due = after > 0 && (ended + 1).is_multiple_of(after);
                is_due.then_some(ended)
            }
            _ => None,
        };
        Ok(verdict)
    }

    /// Gives the trial that waits up; it comes again.
    pub fn abort(&mut self) {
        if self.procedure.trial().is_some() {
            self.attempt += 1;
        }
    }
}
