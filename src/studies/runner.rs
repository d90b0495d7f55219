//! The runner: studies one by one, each kept as soon as it is done; then their times once more in
//! further processes.
//!
//! A study that fails or panics is noted and the next one runs; cancelling keeps what is finished.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::machine::{self, Machine};
use super::record::{self, Record};
use super::rounds;
use super::since::Since;
use super::{Bench, Effort, Findings, ReportError, Row, Study, index, write};
use selvedge_foundation::numerics::n_threads;
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
    /// An earlier `report.json` to compare with.
    pub against: Option<PathBuf>,
}

/// Runs a further process that measures studies of these names once more for their
/// [times alone](super::times_alone), and hands back what it printed.
pub type Again<'a> = dyn FnMut(&[&str]) -> Result<String, ReportError> + 'a;

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
    /// Why times are of fewer processes than they should be.
    pub(crate) trouble: Option<String>,
    /// What changed since an earlier report.
    pub(crate) since: Option<Since>,
}

impl Report {
    fn begun(studies: &[Study]) -> Self {
        let stopped = |study: &Study| (study.name, Outcome::Stopped);
        Self {
            outcomes: studies.iter().map(stopped).collect(),
            is_cancelled: false,
            trouble: None,
            since: None,
        }
    }

    /// The studies whose times further processes may measure: that are done, and whose work is not
    /// so long that it is timed once.
    fn timed(&self, studies: &[Study]) -> Vec<Study> {
        let is_repeated = |row: &Row| row.cost.is_some_and(|cost| cost.n_repeats > 1);
        let is_timed = |outcome: &Outcome| match outcome {
            Outcome::Done { findings, .. } => findings.rows.iter().any(is_repeated),
            _ => false,
        };
        let all = studies.iter().zip(&self.outcomes);
        let timed = all.filter(|(_, (_, outcome))| is_timed(outcome));
        timed.map(|(study, _)| *study).collect()
    }

    /// Writes the tables and plots of these studies, as far as they are done.
    fn write_findings(&self, studies: &[Study], options: &Options) -> Result<(), ReportError> {
        for study in studies {
            let own = self.outcomes.iter().find(|(name, _)| *name == study.name);
            if let Some((_, Outcome::Done { findings, .. })) = own {
                write::findings(study, findings, &options.out)?;
            }
        }
        Ok(())
    }

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

/// The studies that are asked for by their name or their chapter's, all of them if none is; in
/// their own order.
///
/// # Errors
/// A name that is not known.
pub fn choose(studies: Vec<Study>, only: &[String]) -> Result<Vec<Study>, ReportError> {
    let mut names: Vec<&str> = studies.iter().map(|study| study.name).collect();
    for study in &studies {
        if !names.contains(&study.chapter) {
            names.push(study.chapter);
        }
    }
    if let Some(name) = only.iter().find(|name| !names.contains(&name.as_str())) {
        return Err(ReportError::Unknown {
            name: name.clone(),
            known: names.join(", "),
        });
    }
    let is_wanted = |study: &Study| {
        let is_named = |wanted: &String| wanted == study.name || wanted == study.chapter;
        only.is_empty() || only.iter().any(is_named)
    };
    Ok(studies.into_iter().filter(is_wanted).collect())
}

/// Studies at work at a time: two cores work where there are two, each study timed by its own
/// thread.
pub(super) fn n_at_a_time() -> usize {
    n_threads().min(2)
}

/// Hands out studies, so many at a time, each with its place, until they are all done or one breaks
/// off: from the last, since short ones stand first and fill what is left of the time.
pub(super) fn side_by_side(
    n_at_a_time: usize,
    studies: &[Study],
    one: impl Fn(usize, &Study) -> ControlFlow<()> + Sync,
) {
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            let n_begun = 1 + next.fetch_add(1, Ordering::Relaxed);
            let Some(nth) = studies.len().checked_sub(n_begun) else {
                break;
            };
            if one(nth, &studies[nth]).is_break() {
                next.store(studies.len(), Ordering::Relaxed);
            }
        }
    };
    thread::scope(|scope| {
        for _ in 1..n_at_a_time {
            scope.spawn(work);
        }
        work();
    });
}

/// Goes on, unless it is over.
pub(super) fn unless(is_over: bool) -> ControlFlow<()> {
    if is_over {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(())
    }
}

/// What is behind a lock: nothing that is kept there is half done when a thread ends.
pub(super) fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Hears how far a report is.
pub type Heard<'a> = dyn FnMut(&Standing<'_>) + Send + 'a;

/// A report on its way: what is done, and who hears of it.
struct Making<'a> {
    report: Report,
    heard: &'a mut Heard<'a>,
    started: Instant,
    /// How much of each study is done.
    shares: Vec<f64>,
    /// Share of the whole that the first process does.
    of_first: f64,
    /// Why its files cannot be written.
    failed: Option<ReportError>,
}

impl Making<'_> {
    /// Says that a study of the first process is so far.
    fn hear(&mut self, nth: usize, share: f64, doing: &str) {
        self.shares[nth] = share;
        let done = self.shares.iter().sum::<f64>() / self.shares.len() as f64;
        self.tell(self.of_first * done, self.report.outcomes[nth].0, doing);
    }

    fn tell(&mut self, share: f64, study: &str, doing: &str) {
        (self.heard)(&Standing {
            share,
            study,
            doing,
            left: time_left(self.started.elapsed(), share),
        });
    }
}

/// Share of the work that the first process does, if there are others.
const FIRST: f64 = 0.5;

/// Runs studies and writes the files of each when it is done, and the index each time; then has
/// their times measured in further processes, if it can, and writes all again.
///
/// # Errors
/// A file cannot be written, or the earlier report not be read. That a study fails, or that the
/// report is stopped, is no error here: the report says so.
pub fn run<'a>(
    studies: &[Study],
    options: &Options,
    cancel: &CancelFlag,
    again: Option<&mut Again<'_>>,
    heard: &'a mut Heard<'a>,
) -> Result<Report, ReportError> {
    let old = options.against.as_deref().map(Record::read).transpose()?;
    let mut machine = Machine::here();
    let date = machine::now_utc();
    let making = Mutex::new(Making {
        report: Report::begun(studies),
        heard,
        started: Instant::now(),
        shares: vec![0.0; studies.len()],
        of_first: if again.is_some() { FIRST } else { 1.0 },
        failed: None,
    });
    side_by_side(n_at_a_time(), studies, |nth, study| {
        let mut hear = |share: f64, doing: &str| lock(&making).hear(nth, share, doing);
        hear(0.0, "");
        let mut progress = Progress::new(&mut hear, cancel.clone());
        let outcome = one(study, options, &mut progress);
        let making = &mut *lock(&making);
        making.shares[nth] = 1.0;
        let report = &mut making.report;
        report.is_cancelled |= matches!(outcome, Outcome::Stopped) || cancel.is_cancelled();
        report.outcomes[nth].1 = outcome;
        let written = (report.write_findings(&studies[nth..=nth], options))
            .and_then(|()| index::write(studies, report, (&machine, options, &date)));
        let is_over = report.is_cancelled || written.is_err();
        if let Err(error) = written {
            making.failed.get_or_insert(error);
        }
        unless(is_over)
    });
    let mut making = making.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(error) = making.failed {
        return Err(error);
    }
    if let Some(again) = again.filter(|_| !making.report.is_cancelled) {
        let timed = making.report.timed(studies);
        measure_again(&timed, options.effort, &mut making, again);
        making.report.is_cancelled |= cancel.is_cancelled();
        making.report.write_findings(&timed, options)?;
    }
    let mut report = making.report;
    machine.look_again();
    let record = record_of(&report, &machine.program, &date, options);
    report.since = old.map(|old| Since::between(&old, &record));
    write::text(record::NAME, &options.out, &record.to_json()?)?;
    index::write(studies, &report, (&machine, options, &date))?;
    Ok(report)
}

/// Has the times of studies measured by further processes, one after the other, and joins what they
/// found. A process that fails ends it, and is told.
fn measure_again(timed: &[Study], effort: Effort, making: &mut Making<'_>, again: &mut Again<'_>) {
    if timed.is_empty() {
        return;
    }
    let n_processes = rounds::n_processes(effort);
    let names: Vec<&str> = timed.iter().map(|study| study.name).collect();
    let mut records = Vec::new();
    for nth in 1..n_processes {
        let which = format!("process {} of {n_processes}", nth + 1);
        let share = FIRST + (1.0 - FIRST) * nth as f64 / n_processes as f64;
        making.tell(share, "times", &which);
        match again(&names).and_then(|text| Record::parse(&text)) {
            Ok(record) => records.push(record),
            Err(error) => {
                making.report.trouble = Some(format!("{which}: {error}"));
                break;
            }
        }
    }
    for (name, outcome) in &mut making.report.outcomes {
        if let Outcome::Done { findings, .. } = outcome
            && names.contains(name)
        {
            let n_missing = rounds::join(name, findings, &records);
            findings.judge_times();
            if n_missing > 0 {
                let words = format!("{n_missing} rows were not timed by every process.");
                findings.notes.push(words);
            }
        }
    }
}

fn record_of(report: &Report, program: &str, date: &str, options: &Options) -> Record {
    let mut record = Record {
        program: program.to_owned(),
        date: date.to_owned(),
        effort: options.effort.word().to_owned(),
        seed: options.seed,
        rows: Vec::new(),
    };
    for (name, outcome) in &report.outcomes {
        if let Outcome::Done { findings, .. } = outcome {
            record.add(name, findings);
        }
    }
    record
}

fn one(study: &Study, options: &Options, progress: &mut Progress<'_>) -> Outcome {
    let started = Instant::now();
    let mut bench = Bench::new(options.effort, options.seed, progress);
    match guarded(study, &mut bench) {
        Ok(findings) => Outcome::Done {
            findings,
            took: started.elapsed(),
        },
        Err(ReportError::Cancelled) => Outcome::Stopped,
        Err(error) => Outcome::Failed(error.to_string()),
    }
}

/// Runs a study; one that panics has failed.
pub(super) fn guarded(study: &Study, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    catch_unwind(AssertUnwindSafe(|| (study.run)(bench))).unwrap_or_else(|panic| {
        let why = format!("it panicked: {}", message_of(panic.as_ref()));
        Err(ReportError::Study(why))
    })
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
