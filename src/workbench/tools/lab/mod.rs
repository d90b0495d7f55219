//! The textile lab: a recipe is edited and what becomes of it is seen at once.
//!
//! ```text
//! parameter ─▶ Steps (drafts, read as a file would be) ─▶ Task: Preview
//!          ─▶ Task: files of a textile ─▶ LibraryCommand::Listen, then Keep
//! ```
//!
//! Nothing is computed for a hidden pane. While one preview is computed the parameters may change:
//! the newest are computed next, and the last preview stays until then.

pub(crate) mod export;
pub(crate) mod family;
pub(crate) mod fields;
pub(crate) mod pictures;
pub(crate) mod preview;
pub(crate) mod state;
pub(crate) mod steps;
#[cfg(test)]
mod tests;
pub(crate) mod view;
pub(crate) mod work;

pub(crate) use crate::tools::lab::state::Lab;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::{Command, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::export::origin::Origin;
use crate::bench::history::StepList;
use crate::bench::library_acts::LibraryCommand;
use crate::bench::pane::Pane;
use crate::bench::recovery::Unsaved;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::tools::lab::steps::Steps;

impl Tool for Lab {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Lab]
    }

    fn logic(&mut self, bench: &mut Bench) {
        self.poll_keeping(bench);
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 10, |ui| {
            self.follow(context.bench);
            view::show(ui, self, context.bench);
        });
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        match command {
            Command::Lab(beginning) => {
                bench.commands.push(ShowCommand::Reveal(Pane::Lab).into());
                self.begin_with(bench, beginning.clone());
            }
            Command::Library(LibraryCommand::Keep(keep)) => self.note_kept(keep),
            _ => {}
        }
    }

    fn steps(&self, _bench: &Bench) -> Option<StepList> {
        Some(self.steps.as_ref().map(Steps::list).unwrap_or_default())
    }

    fn step_to(&mut self, n_done: usize, _bench: &mut Bench) {
        self.go_to(n_done);
    }

    fn unsaved(&self) -> Option<Unsaved> {
        self.steps.as_ref()?.unsaved()
    }

    fn restore(&mut self, unsaved: &Unsaved, _bench: &mut Bench) -> Result<(), String> {
        self.steps = Some(Steps::of(unsaved.read()?));
        self.has_changed();
        Ok(())
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let preview = self.preview().ok_or(
            "There is nothing to export yet: the surface is being made in the textile lab",
        )?;
        let scene = bench.document.scene();
        let origin = Origin::of(scene, &bench.document.tuning(), None);
        let scale = bench.selection.scale;
        Ok(export::curves(self, preview, scale, origin))
    }
}
