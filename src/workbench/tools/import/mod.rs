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
pub(crate) mod state;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod view;
pub(crate) mod work;

pub(crate) use crate::tools::import::state::Import;

use std::path::PathBuf;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::{Command, FileCommand, Purpose};
use crate::bench::export::Exported;
use crate::bench::library_acts::LibraryCommand;
use crate::bench::pane::Pane;
use crate::bench::recovery::Unsaved;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;

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
        match command {
            Command::File(FileCommand::Use(Purpose::ImportFiles, path)) => {
                self.take_file(path, bench);
            }
            Command::Library(LibraryCommand::Keep(keep)) => self.note_kept(keep),
            _ => {}
        }
    }

    fn unsaved(&self) -> Option<Unsaved> {
        if !self.draft.is_begun() || matches!(self.kept, Some(Ok(_))) {
            return None;
        }
        let files = &self.draft.described.files;
        let names: Vec<String> = files.iter().map(|file| file.source.name()).collect();
        let name = format!("Import of {}", names.join(", "));
        let what = "what was chosen and typed, not kept as a textile yet";
        Some(Unsaved::new(name, what, &self.draft))
    }

    fn restore(&mut self, unsaved: &Unsaved, _bench: &mut Bench) -> Result<(), String> {
        self.take_draft(unsaved.read()?);
        Ok(())
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let map = bench.settings.preferences.colour_map;
        let exported = self
            .found()
            .and_then(|found| export::measurement(found, map));
        exported.ok_or("There is nothing to export yet: choose files in the Import pane")
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        let last = self.draft.described.files.last();
        let last = last.filter(|_| purpose == Purpose::ImportFiles);
        last.map(|file| file.source.path().to_owned())
    }
}
