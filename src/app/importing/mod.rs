//! Importing measurements: what was chosen and typed, what the readers found of it, and the
//! textiles that come of it.
//!
//! ```text
//! files, fields ─▶ Draft ─▶ Inputs ─▶ work (a thread, the newest words only) ─▶ Found ─▶ pane
//!                    └▶ words ──────────────────────────────────────▶ keeping ─▶ NewTextile
//! ```
//!
//! Everything is read by what the command line reads with (`textile::kes`, `textile::metrology`);
//! here is only what is asked for, when, and how far it is. Nothing is read while the pane is
//! hidden, and nothing is written here.

mod draft;
mod envelope;
mod failure;
mod keeping;
mod work;

pub(crate) use draft::{
    Draft, DraftFile, HeightsDraft, Looked, SourceFile, StrokesDraft, WordsDraft,
};
pub(crate) use envelope::Envelope;
pub(crate) use failure::{Failure, Step};
pub(crate) use work::{Body, Found, Heights, Inputs, Strokes};

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui;

use super::job::{Job, Polled};
use super::keep::NewTextile;
use super::task::Watch;
use super::widgets::ReliefPicture;
use super::window::Workbench;
use crate::progress::Cancelled;

/// More files than these are no import.
const MOST_FILES: usize = 8;
/// How often progress is shown.
const PROGRESS: Duration = Duration::from_millis(100);

/// What can be wanted of an import. Never undoable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ImportCommand {
    /// Take these files to those that are there.
    Add(Vec<PathBuf>),
    /// Choose and type this.
    Draft(Box<Draft>),
    /// Read the files anew from the disk.
    ReadAgain,
    /// Stop reading.
    Cancel,
    /// Begin anew, with nothing.
    Clear,
    /// Keep what was read as textiles of the library, or feel it at once.
    Keep {
        /// Whether it is placed under the display.
        is_felt: bool,
    },
}

/// How what was read stands to what is chosen now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Standing {
    /// No file was chosen.
    Empty,
    /// It is of what is chosen.
    Fresh,
    /// It is being read: the share that is done, 0…1.
    Reading(f32),
    /// It was stopped.
    Stopped,
}

/// A reading under way.
struct Running {
    inputs: Inputs,
    job: Job<Result<Found, Cancelled>>,
    watch: Watch,
}

/// Textiles on their way to the library.
struct Keeping {
    job: Job<Result<Vec<NewTextile>, Failure>>,
    is_felt: bool,
}

/// An import: what is wanted of it and what was found.
#[derive(Default)]
pub(crate) struct Importing {
    /// What was chosen and typed.
    pub(crate) draft: Draft,
    /// The relief as a texture.
    pub(crate) picture: ReliefPicture,
    found: Option<Arc<Found>>,
    running: Option<Running>,
    stopped: Option<Inputs>,
    keeping: Option<Keeping>,
    /// What was kept last, or why nothing was.
    kept: Option<Result<String, Failure>>,
    n_read: u64,
}

impl Importing {
    /// What was found last, whatever has changed since.
    pub(crate) fn found(&self) -> Option<&Arc<Found>> {
        self.found.as_ref()
    }

    /// Readings that were begun.
    pub(crate) fn n_read(&self) -> u64 {
        self.n_read
    }

    /// What was kept last, or why nothing was.
    pub(crate) fn kept(&self) -> Option<Result<&str, &Failure>> {
        self.kept.as_ref().map(|kept| kept.as_deref())
    }

    /// Whether textiles are on their way to the library.
    pub(crate) fn is_keeping(&self) -> bool {
        self.keeping.is_some()
    }

    fn inputs(&self) -> Inputs {
        Inputs {
            told: self.draft.told.clone(),
            looked: self.draft.looked.clone(),
        }
    }

    /// How what was found stands to what is chosen.
    pub(crate) fn standing(&self) -> Standing {
        if self.draft.told.files.is_empty() {
            return Standing::Empty;
        }
        let inputs = self.inputs();
        if self
            .found
            .as_ref()
            .is_some_and(|found| found.inputs == inputs)
        {
            return Standing::Fresh;
        }
        if self.stopped.as_ref() == Some(&inputs) {
            return Standing::Stopped;
        }
        let running = self.running.as_ref();
        Standing::Reading(running.map_or(0.0, |running| running.watch.share()))
    }

    /// Takes files to those that are there; says why not, in one line.
    pub(crate) fn add(&mut self, paths: Vec<PathBuf>) -> Result<(), String> {
        let mut draft = self.draft.clone();
        let is_first = draft.told.files.is_empty();
        for path in paths {
            let is_there = |file: &DraftFile| file.source.path() == path;
            if !draft.told.files.iter().any(is_there) {
                draft.told.files.push(DraftFile {
                    source: Arc::new(SourceFile::new(path)),
                    place: None,
                    is_friction: false,
                });
            }
        }
        let n = draft.told.files.len();
        if n > MOST_FILES {
            return Err(format!(
                "{n} files where an import takes {MOST_FILES}; leave some out"
            ));
        }
        if is_first {
            // What was typed for other files does not hold for these.
            draft.told.strokes = StrokesDraft::default();
            draft.told.heights = HeightsDraft::default();
        }
        draft.looked = Looked {
            is_official: draft.looked.is_official,
            ..Looked::default()
        };
        self.take_draft(draft);
        Ok(())
    }

    /// Takes what was chosen and typed.
    pub(crate) fn take_draft(&mut self, draft: Draft) {
        if draft.told != self.draft.told {
            self.kept = None;
            self.picture = ReliefPicture::default();
        }
        self.draft = draft;
    }

    /// Reads the files anew from the disk.
    pub(crate) fn read_again(&mut self) {
        for file in &mut self.draft.told.files {
            file.source = Arc::new(SourceFile::new(file.source.path().to_owned()));
        }
        self.stopped = None;
        self.picture = ReliefPicture::default();
    }

    /// Stops reading until something else is chosen.
    pub(crate) fn cancel(&mut self) {
        if let Some(running) = &self.running {
            running.watch.stop();
            self.stopped = Some(running.inputs.clone());
        }
    }

    /// Takes what a thread has read, if it is done.
    pub(crate) fn poll(&mut self) {
        let Some(running) = self.running.take() else {
            return;
        };
        match running.job.poll() {
            Polled::Working => self.running = Some(running),
            Polled::Done(Ok(found)) => self.take_found(found),
            Polled::Done(Err(Cancelled)) => {}
            Polled::BrokeOff => {
                let line = "reading broke off; press “read again”, and report the file";
                self.take_found(Found {
                    inputs: running.inputs,
                    kind: crate::textile::Measurement::Heights,
                    body: Body::Nothing,
                    failure: Some(Failure::at(Step::Files, line)),
                });
            }
        }
    }

    fn take_found(&mut self, found: Found) {
        let before = self.found.as_ref().and_then(|found| found.heights());
        let relief = |heights: &Heights| heights.relief.clone();
        let is_same = match (before.and_then(relief), found.heights().and_then(relief)) {
            (Some(before), Some(now)) => Arc::ptr_eq(&before, &now),
            _ => false,
        };
        if !is_same {
            self.picture = ReliefPicture::default();
        }
        self.found = Some(Arc::new(found));
    }

    /// Lets the reading follow what was chosen: one at a time, the newest words only.
    fn follow(&mut self, ctx: &egui::Context, is_at_once: bool) {
        let inputs = self.inputs();
        if !matches!(self.standing(), Standing::Reading(_)) {
            return;
        }
        if let Some(running) = &self.running {
            if running.inputs.told != inputs.told {
                running.watch.stop();
            }
            ctx.request_repaint_after(PROGRESS);
            return;
        }
        self.begin(inputs, ctx, is_at_once);
    }

    fn begin(&mut self, inputs: Inputs, ctx: &egui::Context, is_at_once: bool) {
        self.n_read += 1;
        let watch = Watch::default();
        let (own, waker) = (watch.clone(), ctx.clone());
        let (asked, prior) = (inputs.clone(), self.found.clone());
        let read = move || {
            own.over(&waker, |progress| {
                work::read(asked, prior.as_deref(), progress)
            })
        };
        if is_at_once {
            if let Ok(found) = read() {
                self.take_found(found);
            }
            return;
        }
        match Job::start("selvedge-import", ctx, read) {
            Ok(job) => {
                self.running = Some(Running { inputs, job, watch });
            }
            Err(error) => {
                let line = format!("nothing was read: {error}; press “read again”");
                self.stopped = Some(inputs);
                self.kept = Some(Err(Failure::at(Step::Files, line)));
            }
        }
    }
}

impl Workbench {
    /// Lets the import follow what was chosen: to be called while its pane is in sight.
    pub(crate) fn follow_import(&mut self, ctx: &egui::Context) {
        let is_stepped = self.is_stepped;
        self.transient.importing.follow(ctx, is_stepped);
    }
}

impl std::fmt::Debug for Importing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Importing")
            .field("draft", &self.draft)
            .field("n_read", &self.n_read)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
pub(crate) mod tests;
