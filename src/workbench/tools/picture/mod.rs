//! From a picture of a cloth to a textile: what was chosen and typed, and what the stages made.
//!
//! ```text
//! Draft ─▶ work (a thread, the newest words only; earlier stages are kept) ─▶ Found ─▶ pane
//! ```
//!
//! The stages are those of the command line (`textile::picture`). Nothing is worked out while the
//! pane is hidden, and nothing is written here.

pub(crate) mod draft;
pub(crate) mod export;
pub(crate) mod found;
pub(crate) mod images;
pub(crate) mod region;
pub(crate) mod state;
pub(crate) mod textile;
pub(crate) mod textures;
pub(crate) mod turned;
pub(crate) mod view;
pub(crate) mod work;

pub(crate) use crate::tools::picture::state::Picture;

use std::path::PathBuf;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::{Command, FileCommand, Purpose, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::library_acts::LibraryCommand;
use crate::bench::pane::Pane;
use crate::bench::recovery::Unsaved;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;

impl Tool for Picture {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Picture]
    }

    fn logic(&mut self, _bench: &mut Bench) {
        self.poll();
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.follow(ui.ctx(), &context.bench.executor);
        framed(ui, 10, |ui| view::show(ui, self, context.commands));
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        match command {
            Command::File(FileCommand::Use(Purpose::OpenPicture(Pane::Picture), path)) => {
                self.open(path.clone());
                let reveal = ShowCommand::Reveal(Pane::Picture);
                bench.commands.push(reveal.into());
            }
            Command::File(FileCommand::Use(Purpose::AddTurned, path)) => {
                self.add_turned(path.clone());
            }
            Command::Library(LibraryCommand::Keep(keep)) => self.note_kept(keep),
            _ => {}
        }
    }

    fn unsaved(&self) -> Option<Unsaved> {
        let source = self.draft.source.as_ref().filter(|_| self.is_begun())?;
        let name = format!("Textile from {}", source.name());
        let what = "what was chosen and typed, not kept as a textile yet";
        Some(Unsaved::new(name, what, &self.draft))
    }

    fn restore(&mut self, unsaved: &Unsaved, _bench: &mut Bench) -> Result<(), String> {
        self.take_draft(unsaved.read()?);
        Ok(())
    }

    fn export(&mut self, _pane: Pane, _bench: &mut Bench) -> Result<Exported, &'static str> {
        let exported = self.found().and_then(|found| export::directions(found));
        exported.ok_or("There is nothing to export yet: open a picture in the Picture pane")
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        let source = self.draft.source.as_ref();
        let source = source.filter(|_| purpose == Purpose::OpenPicture(Pane::Picture));
        source.map(|file| file.path().to_owned())
    }
}
