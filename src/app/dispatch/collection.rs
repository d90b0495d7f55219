//! The library as a whole: what of it is shown and selected. Neither saved nor undone.

use crate::app::collection::CollectionCommand;
use crate::app::window::Workbench;

impl Workbench {
    pub(super) fn dispatch_collection(&mut self, command: CollectionCommand) {
        let collection = &mut self.transient.collection;
        match command {
            CollectionCommand::Choose(choice) => collection.choose(choice),
            CollectionCommand::Select(ids, joining) => collection.select(ids, joining),
            CollectionCommand::Stop => collection.measurements.halt(),
            CollectionCommand::GoOn => collection.measurements.go_on(),
        }
    }
}
