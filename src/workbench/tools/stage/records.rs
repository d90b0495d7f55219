//! Visits on their way to disk: one after the other, on a thread, so that no frame waits for it.

use std::collections::VecDeque;
use std::path::Path;
use std::time::SystemTime;

use crate::bench::background::{Executor, Task, finished};
use selvedge_experiment::visits::{Tally, Visit, VisitLog};

/// The log, and what waits for it.
#[derive(Debug, Default)]
pub(crate) struct Records {
    log: Option<VisitLog>,
    writing: Option<Task<VisitLog>>,
    waiting: VecDeque<(Visit, SystemTime)>,
    tally: Tally,
    /// Why visits are only counted, and how many could not be written.
    failure: Option<(u64, String)>,
}

impl Records {
    /// Opens the log in a folder.
    pub(crate) fn in_folder(folder: Option<&Path>) -> Self {
        let mut records = Self::default();
        match folder.map(VisitLog::in_folder) {
            Some(Ok(log)) => {
                records.tally = log.tally();
                records.log = Some(log);
            }
            Some(Err(error)) => records.failure = Some((0, error.to_string())),
            None => {}
        }
        records
    }

    /// Takes visits that are over, and begins to write.
    pub(crate) fn take(&mut self, visits: Vec<Visit>, executor: &Executor) {
        for visit in visits {
            self.tally.take(&visit);
            self.waiting.push_back((visit, SystemTime::now()));
        }
        match finished(&mut self.writing) {
            Some(Ok(log)) => self.keep(log),
            Some(Err(why)) => self.failure = Some((self.n_unwritten(), why)),
            None => {}
        }
        if self.waiting.is_empty() || self.writing.is_some() {
            return;
        }
        let waiting = std::mem::take(&mut self.waiting);
        let Some(mut log) = self.log.take() else {
            if let Some((n, _)) = &mut self.failure {
                *n += waiting.len() as u64;
            }
            return;
        };
        self.writing = Some(executor.start("selvedge-visits", move |_progress| {
            for (visit, now) in &waiting {
                log.write(visit, *now);
            }
            Ok(log)
        }));
        if let Some(Ok(log)) = finished(&mut self.writing) {
            self.keep(log);
        }
    }

    /// Writes what is left, and waits for it: the program ends.
    pub(crate) fn finish(&mut self, visits: Vec<Visit>) {
        self.take(visits, &Executor::InLine);
        for _ in 0..100 {
            if self.writing.is_none() && self.waiting.is_empty() {
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
            self.take(Vec::new(), &Executor::InLine);
        }
    }

    /// What visitors guessed so far.
    pub(crate) fn tally(&self) -> Tally {
        self.tally
    }

    /// What the operator ought to know of the log.
    pub(crate) fn describe(&self) -> String {
        match (&self.failure, &self.log) {
            (Some((n, why)), _) => format!("{n} visits are not on disk: {why}"),
            (None, Some(log)) => format!("The log is in {}", log.folder().display()),
            (None, None) => "The log is being written".to_owned(),
        }
    }

    fn keep(&mut self, log: VisitLog) {
        self.failure = log.unwritten().map(|(n, why)| (n, why.to_owned()));
        self.log = Some(log);
    }

    fn n_unwritten(&self) -> u64 {
        self.failure.as_ref().map_or(0, |(n, _)| *n)
    }
}
