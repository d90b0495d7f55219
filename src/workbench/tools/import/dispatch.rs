//! What is imported. Neither saved nor undone.

use eframe::egui;

use crate::bench::Bench;
use crate::bench::pane::Pane;
use crate::shell::arrangement;
use crate::tools::import::{ImportCommand, Importing};

impl Bench {
    pub(crate) fn dispatch_import(&mut self, ctx: &egui::Context, command: ImportCommand) {
        let importing = &mut self.transient.importing;
        match command {
            ImportCommand::Add(paths) => {
                if let Err(line) = importing.add(paths) {
                    self.transient.notices.give(line);
                }
                if !arrangement::is_shown(&self.tree, Pane::Import) {
                    arrangement::toggle(&mut self.tree, Pane::Import);
                }
            }
            ImportCommand::Draft(draft) => importing.take_draft(*draft),
            ImportCommand::ReadAgain => importing.read_again(),
            ImportCommand::Cancel => importing.cancel(),
            ImportCommand::Clear => {
                importing.cancel();
                *importing = Importing::default();
            }
            ImportCommand::Keep { is_felt } => self.keep_import(ctx, is_felt),
        }
    }
}
