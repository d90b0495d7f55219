//! The library as a whole: what of it is shown and selected. Neither saved nor undone.

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::pane::Pane;
use crate::tools::collection::CollectionCommand;

impl Bench {
    pub(crate) fn dispatch_collection(&mut self, command: CollectionCommand) {
        let collection = &mut self.transient.collection;
        match command {
            CollectionCommand::Choose(choice) => collection.choose(choice),
            CollectionCommand::Select(ids, joining) => collection.select(ids, joining),
            CollectionCommand::Carry => {
                if !self.shows(Pane::Workspace) {
                    self.commands
                        .push(ShowCommand::Pane(Pane::Workspace).into());
                }
            }
            CollectionCommand::Stop => collection.measurements.halt(),
            CollectionCommand::GoOn => collection.measurements.go_on(),
        }
    }
}
