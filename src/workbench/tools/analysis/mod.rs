//! Logs of experiments that are analysed in the window: a folder, a few choices, what was found.
//!
//! ```text
//! folder, choices ─▶ Asked ─▶ find_out (a thread) ─▶ Findings ─┬▶ view ─▶ Wanted ─▶ Pictures
//!                                                              └▶ files (a thread)
//! ```
//!
//! # Invariants
//! - the numbers are those of `experiment::analysis`: here is only what is asked for, and when
//! - nothing begins by itself, and a result stays until another one is there
//! - who takes part in a session that is being held is left out unless that is asked for

pub(crate) mod asked;
pub(crate) mod findings;
pub(crate) mod pictures;
pub(crate) mod state;
#[cfg(test)]
mod tests;
pub(crate) mod view;

pub(crate) use crate::tools::analysis::state::Analysis;

use std::path::PathBuf;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::{Command, FileCommand, Purpose};
use crate::bench::export::Exported;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;

impl Tool for Analysis {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Analysis]
    }

    fn logic(&mut self, _bench: &mut Bench) {
        self.poll();
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.follow_session(context.bench);
        self.look(context.bench);
        framed(ui, 10, |ui| {
            if let Some(wanted) = view::show(ui, self, context) {
                self.draw(context.bench, &wanted);
            }
        });
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        match command {
            Command::File(FileCommand::Use(Purpose::OpenLogs, folder)) => self.open(folder, bench),
            Command::File(FileCommand::Use(Purpose::WriteReport, folder)) => {
                self.write(folder.clone(), bench);
            }
            _ => {}
        }
    }

    fn export(&mut self, _pane: Pane, _bench: &mut Bench) -> Result<Exported, &'static str> {
        let found = self.found.as_ref().zip(self.figure());
        let exported = found.map(|(found, (_, drawn))| found.exported(drawn));
        exported.ok_or("There is nothing to export yet: analyse sessions in the Analysis pane")
    }

    fn export_name(&self) -> Option<String> {
        let (section, drawn) = self.figure()?;
        Some(format!("{}-{}", section.key, drawn.key))
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        match purpose {
            Purpose::OpenLogs => self.fields.folder(),
            Purpose::WriteReport => Some(self.found.as_ref()?.report_folder()),
            _ => None,
        }
    }
}
