//! The library as a whole: what of it is shown and selected. Neither saved nor undone.

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::pane::Pane;
use crate::shell::arrangement;
use crate::tools::collection::CollectionCommand;

impl Bench {
    pub(crate) fn dispatch_collection(&mut self, ctx: &egui::Context, command: CollectionCommand) {
        let collection = &mut self.transient.collection;
        match command {
            CollectionCommand::Choose(choice) => collection.choose(choice),
            CollectionCommand::Select(ids, joining) => collection.select(ids, joining),
            CollectionCommand::Carry => {
                if !arrangement::is_shown(&self.tree, Pane::Workspace) {
                    self.dispatch_show(ctx, &ShowCommand::Pane(Pane::Workspace));
                }
            }
            CollectionCommand::Stop => collection.measurements.halt(),
            CollectionCommand::GoOn => collection.measurements.go_on(),
        }
    }
}
