//! From a picture of a cloth to a textile: what was chosen and typed, and what the stages made.
//!
//! ```text
//! Draft ─▶ work (a thread, the newest words only; earlier stages are kept) ─▶ Found ─▶ pane
//! ```
//!
//! The stages are those of the command line (`textile::picture`). Nothing is worked out while the
//! pane is hidden, and nothing is written here.

mod draft;
mod found;
mod images;
mod work;

pub(crate) use draft::{Chosen, Draft, Known, Part, ScaleUnit};
pub(crate) use found::{Cloth, Found, Made, Shaped, Step};
pub(crate) use images::Image;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use eframe::egui;

use super::importing::SourceFile;
use super::job::{Job, Polled};
use super::task::Watch;
use super::window::Workbench;
use crate::progress::Cancelled;

/// How often progress is shown.
const PROGRESS: Duration = Duration::from_millis(100);

/// What can be wanted of a picture. Never undoable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum PictureCommand {
    /// Take this picture.
    Open(PathBuf),
    /// Choose and type this.
    Draft(Box<Draft>),
    /// Stop working it out.
    Cancel,
    /// Begin anew, with nothing.
    Clear,
    /// Keep the textile in the library, or feel it at once.
    Keep {
        /// Whether it is placed under the display.
        is_felt: bool,
    },
}

/// How what was made stands to what is chosen now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Standing {
    /// No picture was chosen.
    Empty,
    /// It is of what is chosen.
    Fresh,
    /// It is being made: the share that is done, 0…1.
    Working(f32),
    /// It was stopped.
    Stopped,
}

/// Work under way.
struct Running {
    inputs: Draft,
    job: Job<Result<Found, Cancelled>>,
    watch: Watch,
}

/// A picture, what is wanted of it and what was made.
#[derive(Default)]
pub(crate) struct Picturing {
    /// What was chosen and typed.
    pub(crate) draft: Draft,
    found: Option<Arc<Found>>,
    running: Option<Running>,
    stopped: Option<Draft>,
    /// The id that was handed to the library last.
    kept: Option<String>,
    n_begun: u64,
}

impl Picturing {
    /// What was made last, whatever has changed since.
    pub(crate) fn found(&self) -> Option<&Arc<Found>> {
        self.found.as_ref()
    }

    /// Runs that were begun.
    pub(crate) fn n_begun(&self) -> u64 {
        self.n_begun
    }

    /// The id that was handed to the library last, of what is chosen now.
    pub(crate) fn kept(&self) -> Option<&str> {
        self.kept.as_deref()
    }

    /// How what was made stands to what is chosen.
    pub(crate) fn standing(&self) -> Standing {
        if self.draft.source.is_none() {
            return Standing::Empty;
        }
        let is_of_draft = |found: &Arc<Found>| found.inputs == self.draft;
        if self.found.as_ref().is_some_and(is_of_draft) {
            return Standing::Fresh;
        }
        if self.stopped.as_ref() == Some(&self.draft) {
            return Standing::Stopped;
        }
        let running = self.running.as_ref();
        Standing::Working(running.map_or(0.0, |running| running.watch.share()))
    }

    /// Why nothing can be kept now; `None` if it can.
    pub(crate) fn refusal(&self) -> Option<String> {
        match self.standing() {
            Standing::Empty => return Some("Open a picture first".to_owned()),
            Standing::Working(_) => return Some("It is being worked out".to_owned()),
            Standing::Stopped => return Some("It was stopped; change something".to_owned()),
            Standing::Fresh => {}
        }
        let found = self.found()?;
        if let Some((step, _)) = &found.failure {
            return Some(format!("Step {} has something to mend", *step as u8));
        }
        if found
            .cloth
            .as_ref()
            .is_some_and(|cloth| cloth.found.is_err())
        {
            return Some("There is no lattice; step 4 says why".to_owned());
        }
        if found.made.is_none() {
            return self.draft.missing().map(str::to_owned);
        }
        None
    }

    /// Takes another picture; how it was lit and its scale stay, for the next may be like it.
    pub(crate) fn open(&mut self, path: PathBuf) {
        let draft = Draft {
            source: Some(Chosen::new(SourceFile::new(path))),
            part: Part::Whole,
            lambda: None,
            name: String::new(),
            ..self.draft.clone()
        };
        self.take_draft(draft);
    }

    /// Takes what was chosen and typed.
    pub(crate) fn take_draft(&mut self, draft: Draft) {
        if draft != self.draft {
            self.kept = None;
        }
        self.draft = draft;
    }

    /// Stops until something else is chosen.
    pub(crate) fn cancel(&mut self) {
        if let Some(running) = &self.running {
            running.watch.stop();
            self.stopped = Some(running.inputs.clone());
        }
    }

    /// The textile of what is chosen now, which is kept next.
    pub(crate) fn take_textile(&mut self) -> Option<Arc<Made>> {
        if self.refusal().is_some() {
            return None;
        }
        let made = self.found.as_ref()?.made.clone()?;
        self.kept = made.textile.first().map(|textile| textile.id.clone());
        Some(made)
    }

    /// Takes what a thread has made, if it is done.
    pub(crate) fn poll(&mut self) {
        let Some(running) = self.running.take() else {
            return;
        };
        match running.job.poll() {
            Polled::Working => self.running = Some(running),
            Polled::Done(Ok(found)) => self.found = Some(Arc::new(found)),
            Polled::Done(Err(Cancelled)) => {}
            Polled::BrokeOff => {
                let line = "the work broke off; open the picture again, and report it";
                let failed = Found::failed(running.inputs, Step::Picture, line.to_owned());
                self.found = Some(Arc::new(failed));
            }
        }
    }

    /// Lets the stages follow what was chosen: one run at a time, the newest words only.
    fn follow(&mut self, ctx: &egui::Context, is_at_once: bool) {
        if !matches!(self.standing(), Standing::Working(_)) {
            return;
        }
        if let Some(running) = &self.running {
            // What was made so far of a file is kept only when the run ends.
            if running.inputs.source != self.draft.source {
                running.watch.stop();
            }
            ctx.request_repaint_after(PROGRESS);
            return;
        }
        self.begin(ctx, is_at_once);
    }

    fn begin(&mut self, ctx: &egui::Context, is_at_once: bool) {
        self.n_begun += 1;
        let inputs = self.draft.clone();
        let watch = Watch::default();
        let (own, waker) = (watch.clone(), ctx.clone());
        let (asked, prior) = (inputs.clone(), self.found.clone());
        let make = move || {
            own.over(&waker, |progress| {
                work::read(asked, prior.as_deref(), progress)
            })
        };
        if is_at_once {
            if let Ok(found) = make() {
                self.found = Some(Arc::new(found));
            }
            return;
        }
        match Job::start("selvedge-picture", ctx, make) {
            Ok(job) => {
                self.running = Some(Running { inputs, job, watch });
            }
            Err(error) => {
                let line = format!("nothing was worked out: {error}; change something");
                self.found = Some(Arc::new(Found::failed(inputs, Step::Picture, line)));
            }
        }
    }
}

impl Workbench {
    /// Lets the stages follow what was chosen: to be called while the pane is in sight.
    pub(crate) fn follow_picture(&mut self, ctx: &egui::Context) {
        let is_stepped = self.is_stepped;
        self.transient.picturing.follow(ctx, is_stepped);
    }
}

impl std::fmt::Debug for Picturing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Picturing")
            .field("draft", &self.draft)
            .field("n_begun", &self.n_begun)
            .finish_non_exhaustive()
    }
}
