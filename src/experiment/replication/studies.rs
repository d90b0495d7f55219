//! Many studies of one kind, each by itself, and how what they found is spread.

use super::comparison::{DesignWithStimuli, Kind, Options};
use crate::design::Design;
use crate::observer::Observer;
use crate::session::Found;
use crate::{ExperimentError, Record, Simulation, simulated_subject};
use selvedge_foundation::numerics::{Random, in_pieces, n_threads};
use selvedge_foundation::progress::Progress;

/// A study's rows that count, subject by subject.
pub(super) type Subjects = Vec<Vec<Record>>;

/// A design, and a kind of observer in it.
pub(super) type Case<'a> = (&'a DesignWithStimuli, Kind);

/// What `found` makes of every study of every case, of as many subjects as the design plans.
///
/// # Errors
/// A study cannot be held, or it was cancelled.
pub(super) fn each_study<T: Send>(
    cases: &[Case<'_>],
    doing: &str,
    options: &Options,
    progress: &mut Progress<'_>,
    found: impl Fn(&Subjects, &DesignWithStimuli) -> T + Sync,
) -> Result<Vec<Vec<T>>, ExperimentError> {
    let share = 1.0 / cases.len().max(1) as f64;
    let mut all = Vec::with_capacity(cases.len());
    for (nth, (laid, kind)) in cases.iter().enumerate() {
        let part = [nth, nth + 1].map(|at| share * at as f64);
        let observer = differing(kind.observer, options);
        let studies = Studies {
            laid,
            observer,
            seed: options.seed,
        };
        let n = options.n_studies;
        all.push(progress.within(part, |part| {
            studies.each((n, doing), part, |subjects| found(subjects, laid))
        })?);
    }
    Ok(all)
}

/// An observer that stands for many who differ.
fn differing(observer: Observer, options: &Options) -> Observer {
    Observer {
        jnd_spread: options.spread,
        ..observer
    }
}

/// Observers in a design, study after study.
struct Studies<'a> {
    laid: &'a DesignWithStimuli,
    observer: Observer,
    seed: u64,
}

impl Studies<'_> {
    fn each<T: Send>(
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
        let of_subject = |nth: usize| {
            let mut rows = simulation.records(&simulated_subject(nth, 1))?;
            rows.retain(|row| !row.trial.is_practice);
            Ok(rows)
        };
        (0..planned(&design)).map(of_subject).collect()
    }
}

/// How many take part: as the design plans, eight where it does not.
fn planned(design: &Design) -> usize {
    match design.rules.subjects {
        0 => 8,
        n => n,
    }
}

/// A study of a design's planned size as its logs would be found, without writing them.
pub(super) fn simulate_study(
    laid: &DesignWithStimuli,
    observer: Observer,
    options: &Options,
) -> Result<Vec<Found>, ExperimentError> {
    let observer = differing(observer, options);
    let simulation = Simulation {
        design: &laid.design,
        stimuli: &laid.stimuli,
        observer: &observer,
        seed: options.seed,
    };
    simulation.sessions(planned(&laid.design), 1)
}

/// What is right of a subject's rows, %.
fn percent_right(rows: &[Record]) -> f64 {
    let n_right = rows.iter().filter(|r| r.is_correct == Some(true)).count();
    100.0 * n_right as f64 / rows.len() as f64
}

/// What is right of every subject's rows, %.
pub(super) fn percents_right(subjects: &Subjects) -> Vec<f64> {
    subjects.iter().map(|rows| percent_right(rows)).collect()
}
