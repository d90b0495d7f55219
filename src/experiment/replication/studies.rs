//! Many studies of one kind, each by itself, and how what they found is spread.

use super::comparison::{DesignWithStimuli, Options};
use crate::design::Design;
use crate::observer::Observer;
use crate::session::Found;
use crate::{ExperimentError, Record, Simulation, simulated_subject};
use selvedge_foundation::numerics::{Random, in_pieces, n_threads};
use selvedge_foundation::progress::Progress;

/// Observers in a design, study after study.
#[derive(Clone, Copy)]
pub(super) struct Studies<'a> {
    laid: &'a DesignWithStimuli,
    observer: Observer,
    /// Subjects and sessions of each.
    size: (usize, u32),
    seed: u64,
}

/// A study's rows that count, subject by subject, sessions joined.
pub(super) type Subjects = Vec<Vec<Record>>;

impl<'a> Studies<'a> {
    /// As many subjects as the design plans, eight where it does not, each in so many sessions.
    pub(super) fn of(
        laid: &'a DesignWithStimuli,
        observer: Observer,
        n_sessions: u32,
        options: &Options,
    ) -> Self {
        Self {
            laid,
            observer,
            size: (planned(&laid.design), n_sessions),
            seed: options.seed,
        }
    }

    /// What `found` makes of the rows of each of `n` studies.
    ///
    /// # Errors
    /// A study cannot be held, or it was cancelled.
    pub(super) fn each<T: Send>(
        &self,
        (n, doing): (usize, &str),
        progress: &mut Progress<'_>,
        found: impl Fn(&Subjects) -> T + Sync,
    ) -> Result<Vec<T>, ExperimentError> {
        let n_together = 8 * n_threads();
        let mut all = Vec::with_capacity(n);
        while all.len() < n {
            let first = all.len();
            progress.step(first as f64 / n as f64, doing)?;
            let mut some: Vec<Option<Result<T, ExperimentError>>> = Vec::new();
            some.resize_with(n_together.min(n - first), || None);
            in_pieces(
                &mut some,
                1,
                n_threads(),
                || (),
                |(), nth, study| study[0] = Some(self.subjects(first + nth).map(|s| found(&s))),
            );
            for study in some.into_iter().flatten() {
                all.push(study?);
            }
        }
        Ok(all)
    }

    /// The subjects of the `nth` study, its schedules and its chance its own.
    fn subjects(&self, nth: usize) -> Result<Subjects, ExperimentError> {
        let study = Random::new(self.seed).branch(&format!("study {nth}"));
        let design = Design {
            seed: study.branch("schedules").seed(),
            ..self.laid.design.clone()
        };
        let simulation = Simulation {
            design: &design,
            stimuli: &self.laid.stimuli,
            observer: &self.observer,
            seed: study.branch("observers").seed(),
        };
        let (n_subjects, n_sessions) = self.size;
        let mut subjects = Vec::with_capacity(n_subjects);
        for nth in 0..n_subjects {
            let mut rows = Vec::new();
            for session in 1..=n_sessions {
                rows.extend(simulation.records(&simulated_subject(nth, session))?);
            }
            rows.retain(|row| !row.trial.is_practice);
            subjects.push(rows);
        }
        Ok(subjects)
    }
}

/// How many take part: as the design plans, eight where it does not.
pub(super) fn planned(design: &Design) -> usize {
    match design.rules.subjects {
        0 => 8,
        n => n,
    }
}

/// A study of a design's planned size as its logs would be found, without writing them.
pub(super) fn simulate_study(
    laid: &DesignWithStimuli,
    observer: Observer,
    n_sessions: u32,
    options: &Options,
) -> Result<Vec<Found>, ExperimentError> {
    let simulation = Simulation {
        design: &laid.design,
        stimuli: &laid.stimuli,
        observer: &observer,
        seed: options.seed,
    };
    simulation.sessions(planned(&laid.design), n_sessions)
}

/// What is right of a subject's rows, %.
pub(super) fn percent_right(rows: &[Record]) -> f64 {
    let n_right = rows.iter().filter(|r| r.is_correct == Some(true)).count();
    100.0 * n_right as f64 / rows.len() as f64
}
