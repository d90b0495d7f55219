//! How scenes are rendered, and how accurate that is.

use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::tools::accuracy::AccuracyCommand;
use crate::tools::accuracy::measuring::{Measuring, Wanted};
use selvedge_studies::Effort;

impl Bench {
    pub(crate) fn dispatch_accuracy(&mut self, ctx: &egui::Context, command: AccuracyCommand) {
        match command {
            AccuracyCommand::Method(method) => {
                self.settings.preferences.rendering.method = method;
                self.render_as_chosen();
            }
            AccuracyCommand::Budget(budget_db) => {
                let rendering = &mut self.settings.preferences.rendering;
                rendering.budget_db = budget_db;
                *rendering = rendering.in_bounds();
                self.render_as_chosen();
            }
            AccuracyCommand::Reset => self.transient.accuracy.reset(),
            AccuracyCommand::Measure => self.measure(ctx),
            AccuracyCommand::StopMeasuring => {
                if let Some(measuring) = &self.transient.accuracy.measuring {
                    measuring.stop();
                }
            }
            AccuracyCommand::ToggleMethods => {
                let shows_methods = &mut self.transient.accuracy.shows_methods;
                *shows_methods = !*shows_methods;
            }
            AccuracyCommand::Choose(row) => self.transient.accuracy.chosen = row,
        }
    }

    /// Measures every method on the scene as it is felt now.
    fn measure(&mut self, ctx: &egui::Context) {
        let wanted = Wanted {
            name: self.document.scene().name.clone(),
            scene: self.inspection.scene.clone(),
            path: self.take.as_ref().map(|take| Arc::clone(take.path())),
            rendering: self.rendering,
            n_edits: self.inspection.n_edits,
        };
        let effort = if self.is_stepped {
            Effort::Quick
        } else {
            Effort::Full
        };
        match Measuring::start(wanted, effort, ctx) {
            Ok(measuring) => self.transient.accuracy.measuring = Some(measuring),
            Err(error) => {
                let words = format!("The scene was not measured: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }
}
