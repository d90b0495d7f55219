//! Sessions of simulated observers, by a clock of their own: nobody waits.
//!
//! Rows are those of a session with a person, from the same course; how each trial was explored is
//! not simulated, so no paths lie beside them.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::ExperimentError;
use super::course::{Course, Step};
use super::design::{Design, Subject};
use super::observer::{Observer, Participant, Stimuli};
use super::presentation::{Presentation, Proof};
use super::record::{Apparatus, Outcome, Record, Timing};
use super::session::{Found, Opening, unwritten, write_whole};
use super::trial::Trial;
use selvedge_foundation::progress::Progress;

/// What a log names as the device.
pub(crate) const SIMULATED: &str = "simulated";

/// 2000-01-03 09:00 UTC, a Monday: when the first session of the first observer begins.
const EPOCH_S: u64 = 946_890_000;
const DAY_S: u64 = 86_400;
/// A session of the same observer comes a week after the last.
const WEEK_S: u64 = 7 * DAY_S;
/// Reading what the participant reads first.
const READING_S: f64 = 60.0;
/// From an answer to the next trial.
const BETWEEN_S: f64 = 2.0;

/// Observers in a design.
#[derive(Debug, Clone, Copy)]
pub struct Simulation<'a> {
    /// The design.
    pub design: &'a Design,
    /// Its stimuli as they are measured.
    pub stimuli: &'a Stimuli,
    /// How every observer feels and answers.
    pub observer: &'a Observer,
    /// What all chance of observers begins with; that of schedules begins with the design's.
    pub seed: u64,
}

/// The `nth` simulated subject of a study, from 0, in a session from 1.
pub(crate) fn simulated_subject(nth: usize, session: u32) -> Subject {
    Subject {
        pseudonym: format!("o{:02}", nth + 1),
        nth,
        session,
    }
}

impl Simulation<'_> {
    /// A study as its logs would be found, without writing them: `n_subjects` in `n_sessions` each.
    ///
    /// # Errors
    /// The observer cannot be, or the design has no schedule.
    pub fn sessions(
        &self,
        n_subjects: usize,
        n_sessions: u32,
    ) -> Result<Vec<Found>, ExperimentError> {
        let mut found = Vec::new();
        for nth in 0..n_subjects {
            for session in 1..=n_sessions {
                let subject = simulated_subject(nth, session);
                let log = PathBuf::from(format!("{}.csv", subject.pseudonym));
                let records = self.records(&subject)?;
                found.push(Found::of_records(log, (self.design, subject), records));
            }
        }
        Ok(found)
    }

    /// The rows of a session, from its first trial to its last.
    ///
    /// # Errors
    /// The observer cannot be, or the design has no schedule.
    pub fn records(&self, subject: &Subject) -> Result<Vec<Record>, ExperimentError> {
        self.observer.check()?;
        let participant = Participant::new(
            (self.design, self.stimuli),
            self.observer,
            self.seed,
            subject,
        );
        let mut course = Course::begin(self.design, subject)?;
        let mut clock = Clock::of(subject);
        let mut records = Vec::new();
        loop {
            match course.step() {
                Step::Finished => return Ok(records),
                Step::Instructions(_) => clock.pass(READING_S),
                Step::Familiarisation(movement) => clock.pass(movement.for_s),
                Step::Break { least_s, .. } => clock.pass(least_s),
                Step::Trial(trial) => {
                    let trial = trial.clone();
                    let attempt = course.attempt();
                    let reply = participant.answer(&trial, attempt);
                    let start = clock.clone();
                    clock.pass(reply.response_s);
                    let is_correct = course.answer(&reply.answer)?;
                    let apparatus = self.apparatus(&trial);
                    records.push(Record {
                        trial,
                        attempt,
                        outcome: Outcome::Answered(reply.answer),
                        is_correct,
                        timing: start.until(&clock),
                        apparatus,
                        presentation: Presentation::confirmed(Proof::Simulated),
                        note: String::new(),
                    });
                    clock.pass(BETWEEN_S);
                }
            }
            course.pass();
        }
    }

    fn apparatus(&self, trial: &Trial) -> Apparatus {
        Apparatus {
            device: SIMULATED.to_owned(),
            tuning: self.stimuli.tuning(),
            stimulus_hash: self.stimuli.hashes().of_task(self.design, &trial.task),
        }
    }

    /// Writes the sessions of `n_observers` observers into a folder, as those of people are
    /// written: their logs. Bytes depend on what is simulated alone.
    ///
    /// # Errors
    /// A log is there already (nothing is written then), it cannot be written, it was cancelled,
    /// or what [`records`](Self::records) refuses.
    pub fn write(
        &self,
        folder: &Path,
        (n_observers, n_sessions): (usize, u32),
        progress: &mut Progress<'_>,
    ) -> Result<Vec<PathBuf>, ExperimentError> {
        let sessions = |nth| (1..=n_sessions).map(move |session| simulated_subject(nth, session));
        let subjects: Vec<Subject> = (0..n_observers).flat_map(sessions).collect();
        for subject in &subjects {
            unwritten(folder, self.design, subject)?;
        }
        let mut logs = Vec::new();
        for (nth, subject) in subjects.iter().enumerate() {
            let share = nth as f64 / subjects.len() as f64;
            progress.step(share, &subject.pseudonym)?;
            let records = self.records(subject)?;
            let device = format!(
                "{SIMULATED}: {}, seed {}",
                self.observer.describe(),
                self.seed
            );
            let opening = Opening::at(Clock::of(subject).at(), &device, 0);
            let held = (self.design, subject);
            logs.push(write_whole(folder, held, &opening, &records)?);
        }
        Ok(logs)
    }
}

/// A clock that goes on when it is told to.
#[derive(Debug, Clone)]
struct Clock {
    opened: SystemTime,
    since: Duration,
}

impl Clock {
    fn of(subject: &Subject) -> Self {
        let nth = u64::try_from(subject.nth).unwrap_or(0) % 100_000;
        let weeks = u64::from(subject.session.saturating_sub(1)) % 10_000;
        let since_s = EPOCH_S + nth * DAY_S + weeks * WEEK_S;
        Self {
            opened: UNIX_EPOCH + Duration::from_secs(since_s),
            since: Duration::ZERO,
        }
    }

    /// Whole microseconds, as logs tell moments.
    fn pass(&mut self, seconds: f64) {
        let passed = Duration::try_from_secs_f64(seconds).unwrap_or_default();
        let us = u64::try_from(passed.as_micros()).unwrap_or(0);
        self.since += Duration::from_micros(us);
    }

    fn at(&self) -> SystemTime {
        self.opened + self.since
    }

    fn until(&self, end: &Self) -> Timing {
        let ns = |clock: &Self| u64::try_from(clock.since.as_nanos()).unwrap_or(u64::MAX);
        Timing::between([self.at(), end.at()], [ns(self), ns(end)])
    }
}

#[cfg(test)]
mod tests;
