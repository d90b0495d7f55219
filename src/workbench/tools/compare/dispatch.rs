//! What is compared. Neither saved nor undone.

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::CompareCommand;
use crate::tools::compare::choice::{HeldTuning, TuningChoice, What};

impl Bench {
    pub(crate) fn dispatch_compare(&mut self, ctx: &egui::Context, command: CompareCommand) {
        match command {
            CompareCommand::Choose(choice) => self.transient.comparison.choice = choice,
            CompareCommand::Hold => {
                let held = HeldTuning::of(self.document.scene(), self.document.tuning());
                let comparison = &mut self.transient.comparison;
                comparison.held = Some(held);
                comparison.choice.what = What::Tunings;
                comparison.choice.tunings = [TuningChoice::Held, TuningChoice::Live];
            }
            CompareCommand::Run => self.compare_now(ctx),
            CompareCommand::Cancel => self.transient.comparison.cancel(),
            CompareCommand::Seek(tick) => self.seek_in_take(tick),
        }
    }
}
