//! Import measurements: what was chosen and typed, what the readers found of it, and the
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

pub(crate) mod draft;
pub(crate) mod envelope;
pub(crate) mod export;
pub(crate) mod failure;
pub(crate) mod keeping;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod view;
pub(crate) mod work;

pub(crate) use crate::tools::import::draft::Draft;
pub(crate) use crate::tools::import::draft::DraftFile;
pub(crate) use crate::tools::import::draft::HeightsDraft;
pub(crate) use crate::tools::import::draft::Looked;
pub(crate) use crate::tools::import::draft::StrokesDraft;
pub(crate) use crate::tools::import::failure::Failure;
#[cfg(test)]
pub(crate) use crate::tools::import::failure::Step;
pub(crate) use crate::tools::import::work::Found;
pub(crate) use crate::tools::import::work::Inputs;

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::{self, Ui};

use crate::bench::Bench;
use crate::bench::background::{Executor, Task};
use crate::bench::command::{Command, FileCommand, Purpose, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::keep::NewTextile;
use crate::bench::latest::{Latest, Standing};
use crate::bench::pane::Pane;
use crate::bench::source_file::SourceFile;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::widgets::relief::{Relief, ReliefPicture};

/// More files than these are no import.
const MOST_FILES: usize = 8;

/// Textiles that were made for the library, and whether they are to be felt.
type Made = (Result<Vec<NewTextile>, Failure>, bool);

/// An import: what is wanted of it and what was found.
#[derive(Default)]
pub(crate) struct Import {
    /// What was chosen and typed.
    pub draft: Draft,
    /// The relief as a texture.
    pub picture: ReliefPicture,
    reading: Latest<Inputs, Found>,
    keeping: Option<Task<Made>>,
    /// What was kept last, or why nothing was.
    kept: Option<Result<String, Failure>>,
}

impl Import {
    /// What was found last, whatever has changed since.
    pub(crate) fn found(&self) -> Option<&Arc<Found>> {
        self.reading.value()
    }

    /// Readings that were begun.
    pub(crate) fn n_read(&self) -> u64 {
        self.reading.n_begun()
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
        self.reading.standing(&self.inputs())
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

    /// Takes files that were chosen or dropped, and shows them.
    fn take_files(&mut self, paths: Vec<PathBuf>, bench: &mut Bench) {
        if let Err(line) = self.add(paths) {
            bench.notices.give(line);
        }
        bench
            .commands
            .push(ShowCommand::Reveal(Pane::Import).into());
    }

    /// Takes what was chosen and typed.
    fn take_draft(&mut self, draft: Draft) {
        let before = std::mem::replace(&mut self.draft, draft);
        self.forget_after(&before);
    }

    /// Forgets what came of a draft that reads otherwise.
    fn forget_after(&mut self, before: &Draft) {
        if before.told != self.draft.told {
            self.kept = None;
            self.picture = ReliefPicture::default();
        }
    }

    /// Reads the files anew from the disk.
    pub(crate) fn read_again(&mut self) {
        for file in &mut self.draft.told.files {
            file.source = Arc::new(SourceFile::new(file.source.path().to_owned()));
        }
        self.reading.go_on();
        self.picture = ReliefPicture::default();
    }

    /// Stops reading until something else is chosen.
    pub(crate) fn cancel(&mut self) {
        self.reading.stop();
    }

    /// Takes what a thread has read, if it is done.
    pub(crate) fn poll(&mut self) {
        let before = self.relief();
        self.reading.poll();
        self.renew_picture(before.as_ref());
    }

    /// Lets the reading follow what was chosen.
    pub(crate) fn follow(&mut self, ctx: &egui::Context, executor: &Executor) {
        if self.standing() == Standing::Empty {
            return;
        }
        let before = self.relief();
        let inputs = self.inputs();
        self.reading.follow(ctx, executor, &inputs);
        self.renew_picture(before.as_ref());
    }

    fn relief(&self) -> Option<Arc<Relief>> {
        self.found()?.heights()?.relief.clone()
    }

    /// Forgets the picture of another relief.
    fn renew_picture(&mut self, before: Option<&Arc<Relief>>) {
        let now = self.relief();
        let is_same = match (before, &now) {
            (Some(before), Some(now)) => Arc::ptr_eq(before, now),
            _ => before.is_none() && now.is_none(),
        };
        if !is_same {
            self.picture = ReliefPicture::default();
        }
    }
}

impl Tool for Import {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Import]
    }

    fn logic(&mut self, bench: &mut Bench) {
        self.poll();
        self.poll_keeping(bench);
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.follow(ui.ctx(), &context.bench.executor);
        framed(ui, 10, |ui| view::show(ui, self, context));
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        if let Command::File(FileCommand::Use(Purpose::ImportFiles, path)) = command {
            self.take_files(vec![path.clone()], bench);
        }
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let map = bench.settings.preferences.colour_map;
        let exported = self
            .found()
            .and_then(|found| export::measurement(found, map));
        exported.ok_or("There is nothing to export yet: choose files in the Import pane")
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        let last = self.draft.told.files.last();
        let last = last.filter(|_| purpose == Purpose::ImportFiles);
        last.map(|file| file.source.path().to_owned())
    }
}

impl std::fmt::Debug for Import {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Import")
            .field("draft", &self.draft)
            .field("n_read", &self.n_read())
            .finish_non_exhaustive()
    }
}
