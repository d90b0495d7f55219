//! The runner: studies one by one, each kept as soon as it is done.
//!
//! A study that fails or panics is noted and the next one runs; cancelling keeps what is finished.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::machine::{self, Machine};
use super::{Bench, Effort, Findings, ReportError, Study, index, write};
use selvedge_foundation::progress::{CancelFlag, Progress};

/// What a report is to hold, and where it goes.
#[derive(Debug, Clone)]
pub struct Options {
    /// The folder for its files; it must be there.
    pub out: PathBuf,
    /// How much work it may take.
    pub effort: Effort,
    /// What random numbers begin with.
    pub seed: u64,
    /// The command that makes it again.
    pub command: String,
}

/// How far a report is.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing<'a> {
    /// The share done, 0…1.
    pub share: f64,
    /// The study that runs.
    pub study: &'a str,
    /// What it is doing.
    pub doing: &'a str,
    /// About how long the rest will take, once that can be told.
    pub left: Option<Duration>,
}

/// What became of one study.
#[derive(Debug)]
pub enum Outcome {
    /// It is done; its files are written.
    Done {
        /// What it found.
        findings: Findings,
        /// How long it took.
        took: Duration,
    },
    /// It failed, with the reason.
    Failed(String),
    /// The report was stopped before it was done.
    Stopped,
}

/// What became of all.
#[derive(Debug)]
pub struct Report {
    /// The studies by name, in the order in which they were asked for.
    pub(crate) outcomes: Vec<(&'static str, Outcome)>,
    /// Whether it was stopped.
    pub is_cancelled: bool,
}

impl Report {
    /// The studies that failed, with the reasons.
    pub fn failures(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.outcomes
            .iter()
            .filter_map(|(name, outcome)| match outcome {
                Outcome::Failed(why) => Some((*name, why.as_str())),
                _ => None,
            })
    }

    /// How many promises were broken.
    pub fn n_broken(&self) -> usize {
        let of = |(_, outcome): &(_, Outcome)| match outcome {
            Outcome::Done { findings, .. } => findings.n_broken(),
            _ => 0,
        };
        self.outcomes.iter().map(of).sum()
    }
}

/// The studies that are asked for by name, all of them if none is; in their own order.
///
/// # Errors
/// A name that is not known.
pub fn choose(studies: Vec<Study>, only: &[String]) -> Result<Vec<Study>, ReportError> {
    let names: Vec<&str> = studies.iter().map(|study| study.name).collect();
    if let Some(name) = only.iter().find(|name| !names.contains(&name.as_str())) {
        return Err(ReportError::Unknown {
            name: name.clone(),
            known: names.join(", "),
        });
    }
    let is_wanted = |name: &str| only.is_empty() || only.iter().any(|wanted| wanted == name);
    Ok(studies
        .into_iter()
        .filter(|study| is_wanted(study.name))
        .collect())
}

/// Runs studies one by one and writes the files of each when it is done, and the index each time.
///
/// # Errors
/// A file cannot be written. That a study fails, or that the report is stopped, is no error here:
/// the report says so.
pub fn run(
    studies: &[Study],
    options: &Options,
    cancel: &CancelFlag,
    heard: &mut dyn FnMut(&Standing<'_>),
) -> Result<Report, ReportError> {
    let date = machine::now_utc();
    let (machine, started) = (Machine::here(), Instant::now());
    let mut report = Report {
        outcomes: studies
            .iter()
            .map(|study| (study.name, Outcome::Stopped))
            .collect(),
        is_cancelled: false,
    };
    for (nth, study) in studies.iter().enumerate() {
        let mut hear = |share: f64, doing: &str| {
            let share = (nth as f64 + share) / studies.len() as f64;
            heard(&Standing {
                share,
                study: study.name,
                doing,
                left: time_left(started.elapsed(), share),
            });
        };
        hear(0.0, "");
        let outcome = one(
            study,
            options,
            &mut Progress::new(&mut hear, cancel.clone()),
        );
        report.is_cancelled |= matches!(outcome, Outcome::Stopped) || cancel.is_cancelled();
        if let Outcome::Done { findings, .. } = &outcome {
            write::findings(study, findings, &options.out)?;
        }
        report.outcomes[nth].1 = outcome;
        let about = index::About {
            machine: &machine,
            options,
            date: &date,
        };
        write::text(
            "index.md",
            &options.out,
            &index::text(studies, &report, &about),
        )?;
        if report.is_cancelled {
            break;
        }
    }
    Ok(report)
}

fn one(study: &Study, options: &Options, progress: &mut Progress<'_>) -> Outcome {
    let started = Instant::now();
    let mut bench = Bench::new(options.effort, options.seed, progress);
    match catch_unwind(AssertUnwindSafe(|| (study.run)(&mut bench))) {
        Ok(Ok(findings)) => Outcome::Done {
            findings,
            took: started.elapsed(),
        },
        Ok(Err(ReportError::Cancelled)) => Outcome::Stopped,
        Ok(Err(error)) => Outcome::Failed(error.to_string()),
        Err(panic) => Outcome::Failed(format!("it panicked: {}", message_of(panic.as_ref()))),
    }
}

/// What a panic said.
pub(super) fn message_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "without a word".to_owned())
}

/// About how long the rest takes: as long as what is done took, by its share. Too little done
/// tells nothing.
fn time_left(elapsed: Duration, share: f64) -> Option<Duration> {
    let left_s = elapsed.as_secs_f64() * (1.0 - share) / share;
    let is_known = share >= 0.02 && left_s.is_finite();
    is_known.then(|| Duration::from_secs_f64(left_s.clamp(0.0, 1e6)))
}
