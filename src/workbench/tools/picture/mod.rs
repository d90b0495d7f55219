//! From a picture of a cloth to a textile: what was chosen and typed, and what the stages made.
//!
//! ```text
//! Draft ─▶ work (a thread, the newest words only; earlier stages are kept) ─▶ Found ─▶ pane
//! ```
//!
//! The stages are those of the command line (`textile::picture`). Nothing is worked out while the
//! pane is hidden, and nothing is written here.

pub(crate) mod dispatch;
pub(crate) mod draft;
pub(crate) mod export;
pub(crate) mod found;
pub(crate) mod images;
pub(crate) mod view;
pub(crate) mod work;

pub(crate) use crate::tools::picture::draft::Chosen;
pub(crate) use crate::tools::picture::draft::Draft;
pub(crate) use crate::tools::picture::draft::Part;
pub(crate) use crate::tools::picture::found::Found;
pub(crate) use crate::tools::picture::found::Made;

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::follower::{Follower, Standing};
use crate::tools::import::draft::SourceFile;

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

/// A picture, what is wanted of it and what was made.
#[derive(Default)]
pub(crate) struct Picturing {
    /// What was chosen and typed.
    pub draft: Draft,
    work: Follower<Found>,
    /// The id that was handed to the library last.
    kept: Option<String>,
}

impl Picturing {
    /// What was made last, whatever has changed since.
    pub(crate) fn found(&self) -> Option<&Arc<Found>> {
        self.work.found()
    }

    /// Runs that were begun.
    pub(crate) fn n_begun(&self) -> u64 {
        self.work.n_begun()
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
        self.work.standing(&self.draft)
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
        self.work.stop();
    }

    /// The textile of what is chosen now, which is kept next.
    pub(crate) fn take_textile(&mut self) -> Option<Arc<Made>> {
        if self.refusal().is_some() {
            return None;
        }
        let made = self.found()?.made.clone()?;
        self.kept = made.textile.first().map(|textile| textile.id.clone());
        Some(made)
    }

    /// Takes what a thread has made, if it is done.
    pub(crate) fn poll(&mut self) {
        self.work.poll();
    }

    /// Lets the stages follow what was chosen.
    fn follow(&mut self, ctx: &egui::Context, is_at_once: bool) {
        if self.standing() != Standing::Empty {
            self.work.follow(ctx, is_at_once, self.draft.clone());
        }
    }
}

impl Bench {
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
            .field("n_begun", &self.n_begun())
            .finish_non_exhaustive()
    }
}
