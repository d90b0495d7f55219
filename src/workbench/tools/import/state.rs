//! An import: what is wanted of it and what was found.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::background::{Executor, Task};
use crate::bench::command::ShowCommand;
use crate::bench::keep::{NewTextile, NewTextiles};
use crate::bench::latest::{Latest, Standing};
use crate::bench::pane::Pane;
use crate::kit::widgets::relief::ReliefPicture;
use crate::tools::import::draft::{Draft, DraftFile, EvaluationDraft, HeightsDraft, StrokesDraft};
use crate::tools::import::failure::Failure;
use crate::tools::import::work::{Found, Inputs};

/// More files than these are no import.
const MOST_FILES: usize = 8;

/// Textiles that were made for the library.
type Made = Result<Vec<NewTextile>, Failure>;

/// An import: what is wanted of it and what was found.
#[derive(Default)]
pub(crate) struct Import {
    /// What was chosen and typed.
    pub draft: Draft,
    /// The relief as a texture.
    pub picture: ReliefPicture,
    pub(super) reading: Latest<Inputs, Found>,
    pub(super) keeping: Option<Task<Made>>,
    /// Textiles that are listened to, or were.
    pub(super) offered: Option<NewTextiles>,
    /// What was kept last, or why nothing was.
    pub(super) kept: Option<Result<String, Failure>>,
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

    pub(super) fn inputs(&self) -> Inputs {
        Inputs {
            described: self.draft.described.clone(),
            looked: self.draft.looked.clone(),
        }
    }

    /// How what was found stands to what is chosen.
    pub(crate) fn standing(&self) -> Standing {
        if self.draft.described.files.is_empty() {
            return Standing::Empty;
        }
        self.reading.standing(&self.inputs())
    }

    /// Takes files to those that are there; says why not, in one line.
    pub(crate) fn add(&mut self, paths: Vec<PathBuf>) -> Result<(), String> {
        let mut draft = self.draft.clone();
        let is_first = draft.described.files.is_empty();
        for path in paths {
            let is_there = |file: &DraftFile| file.source.path() == path;
            if !draft.described.files.iter().any(is_there) {
                draft.described.files.push(DraftFile {
                    source: path.into(),
                    place: None,
                    is_friction: false,
                });
            }
        }
        let n = draft.described.files.len();
        if n > MOST_FILES {
            return Err(format!(
                "{n} files where an import takes {MOST_FILES}; leave some out"
            ));
        }
        if is_first {
            // What was typed for other files does not hold for these.
            draft.described.strokes = StrokesDraft::default();
            draft.described.heights = HeightsDraft::default();
        }
        draft.looked = EvaluationDraft {
            is_official: draft.looked.is_official,
            ..EvaluationDraft::default()
        };
        self.take_draft(draft);
        Ok(())
    }

    /// Takes files that were chosen or dropped, and shows them.
    pub(super) fn take_file(&mut self, path: &Path, bench: &mut Bench) {
        if let Err(line) = self.add(vec![path.to_owned()]) {
            bench.notices.give(line);
        }
        bench
            .commands
            .push(ShowCommand::Reveal(Pane::Import).into());
    }

    /// Takes what was chosen and typed.
    pub(super) fn take_draft(&mut self, draft: Draft) {
        let before = std::mem::replace(&mut self.draft, draft);
        self.forget_after(&before);
    }

    /// Forgets what came of a draft that reads otherwise.
    pub(super) fn forget_after(&mut self, before: &Draft) {
        if before.described != self.draft.described {
            (self.kept, self.offered) = (None, None);
        }
    }

    /// Reads the files anew from the disk.
    pub(crate) fn read_again(&mut self) {
        for file in &mut self.draft.described.files {
            file.source = file.source.path().to_owned().into();
        }
        self.reading.go_on();
    }

    /// Stops reading until something else is chosen.
    pub(crate) fn cancel(&mut self) {
        self.reading.stop();
    }

    /// Takes what a thread has read, if it is done.
    pub(crate) fn poll(&mut self) {
        self.reading.poll();
    }

    /// Lets the reading follow what was chosen.
    pub(crate) fn follow(&mut self, ctx: &egui::Context, executor: &Executor) {
        if self.standing() != Standing::Empty {
            let inputs = self.inputs();
            self.reading.follow(ctx, executor, &inputs);
        }
    }
}
