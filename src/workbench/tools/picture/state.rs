//! What was chosen and typed of a picture, and what was made of it.

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui;

use crate::bench::background::Executor;
use crate::bench::command::Commands;
use crate::bench::keep::Keep;
use crate::bench::latest::{Latest, Standing};
use crate::bench::library_acts::LibraryCommand;
use crate::bench::pane::Pane;
use crate::tools::picture::draft::{Draft, Part};
use crate::tools::picture::found::Found;
use crate::tools::picture::textures::Textures;
use selvedge_textile::picture::Turned;

/// A picture, what is wanted of it and what was made.
#[derive(Default)]
pub(crate) struct Picture {
    /// What was chosen and typed.
    pub draft: Draft,
    /// The lattice's vectors while one is being dragged, px.
    pub(crate) dragged: Option<[[f64; 2]; 2]>,
    /// Whether the expert's plots are shown too.
    pub(crate) is_expert: bool,
    /// The stages as textures.
    pub(crate) textures: Textures,
    work: Latest<Draft, Found>,
    /// The id that was handed to the library last.
    kept: Option<String>,
}

impl Picture {
    /// What was made last, whatever has changed since.
    pub(crate) fn found(&self) -> Option<&Arc<Found>> {
        self.work.value()
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
        if found.made.is_none() {
            return self.draft.missing().map(str::to_owned);
        }
        None
    }

    /// Takes another picture; how it was lit and its scale stay, for the next may be like it.
    pub(crate) fn open(&mut self, path: PathBuf) {
        let draft = Draft {
            source: Some(path.into()),
            part: Part::Whole,
            turn_deg: 0.0,
            turned: Vec::new(),
            ruler: None,
            lambda: None,
            lattice: None,
            name: String::new(),
            ..self.draft.clone()
        };
        self.take_draft(draft);
    }

    /// Takes a further picture of the cloth, turned; no more than can be used.
    pub(super) fn add_turned(&mut self, path: PathBuf) {
        let mut draft = self.draft.clone();
        if draft.source.is_some() && draft.turned.len() < Turned::MAX {
            draft.turned.push(path.into());
            self.take_draft(draft);
        }
    }

    /// Whether more was chosen and typed than which picture it is, and not kept since.
    pub(crate) fn is_begun(&self) -> bool {
        let fresh = Draft {
            source: self.draft.source.clone(),
            ..Draft::default()
        };
        self.draft.source.is_some() && self.draft != fresh && self.kept.is_none()
    }

    /// Takes what was chosen and typed.
    pub(super) fn take_draft(&mut self, draft: Draft) {
        let before = std::mem::replace(&mut self.draft, draft);
        self.forget_after(&before);
    }

    /// Forgets what came of another draft; says whether it is another.
    pub(crate) fn forget_after(&mut self, before: &Draft) -> bool {
        let is_other = self.draft != *before;
        if is_other {
            self.kept = None;
        }
        is_other
    }

    /// Stops until something else is chosen.
    pub(crate) fn cancel(&mut self) {
        self.work.stop();
    }

    /// Begins anew, with nothing.
    pub(crate) fn clear(&mut self) {
        self.cancel();
        *self = Self {
            is_expert: self.is_expert,
            textures: std::mem::take(&mut self.textures),
            ..Self::default()
        };
    }

    /// Lets the textile of what is chosen now be listened to, to keep it then.
    pub(crate) fn keep(&self, commands: &mut Commands) {
        let made = self.found().and_then(|found| found.made.as_ref());
        if let Some(made) = made.filter(|_| self.refusal().is_none()) {
            let textiles = Arc::clone(&made.textile);
            commands.push(LibraryCommand::Listen(textiles, Pane::Picture).into());
        }
    }

    /// Notes that textiles are kept, if they are those of what is chosen now.
    pub(super) fn note_kept(&mut self, keep: &Keep) {
        let made = self.found().and_then(|found| found.made.as_ref());
        if made.is_some_and(|made| Arc::ptr_eq(&made.textile, &keep.textiles)) {
            self.kept = keep.textiles.first().map(|textile| textile.id.clone());
        }
    }

    /// Takes what a thread has made, if it is done.
    pub(crate) fn poll(&mut self) {
        self.work.poll();
    }

    /// Lets the stages follow what was chosen: to be called while the pane is in sight.
    pub(crate) fn follow(&mut self, ctx: &egui::Context, executor: &Executor) {
        if self.standing() != Standing::Empty {
            self.work.follow(ctx, executor, &self.draft);
        }
    }
}
