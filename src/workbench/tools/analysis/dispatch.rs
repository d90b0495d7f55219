//! What is analysed, shown and written of the logs of experiments. Neither saved nor undone.

use std::path::Path;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::{FileCommand, Purpose, ShowCommand};
use crate::bench::export::Exportable;
use crate::bench::pane::Pane;
use crate::tools::analysis::command::AnalysisCommand;
use selvedge_experiment::analysis::Table;

impl Bench {
    pub(crate) fn dispatch_analysis(&mut self, ctx: &egui::Context, command: AnalysisCommand) {
        let is_stepped = self.is_stepped;
        let analysing = &mut self.transient.analysing;
        match command {
            AnalysisCommand::Open(folder) => {
                analysing.fields.folder = folder.display().to_string();
                if !self.shows(Pane::Analysis) {
                    self.commands.push(ShowCommand::Pane(Pane::Analysis).into());
                }
                self.begin_analysis(ctx);
            }
            AnalysisCommand::Choose(choice) => analysing.choice = choice,
            AnalysisCommand::Begin => self.begin_analysis(ctx),
            AnalysisCommand::Stop => analysing.stop(),
            AnalysisCommand::Select(section) => analysing.select(section),
            AnalysisCommand::Uncover(is_uncovered) => analysing.is_uncovered = is_uncovered,
            AnalysisCommand::CopyTable(nth) => match analysing.table(nth).map(Table::to_csv) {
                Some(Ok(text)) => ctx.copy_text(text),
                Some(Err(error)) => self.transient.notices.give(error.to_string()),
                None => {}
            },
            AnalysisCommand::SaveFigure(nth) => {
                analysing.saved_figure = nth;
                let purpose = Purpose::Export(Exportable::Analysed);
                self.commands.push(FileCommand::Ask(purpose).into());
            }
            AnalysisCommand::Write(folder) => analysing.write(ctx, is_stepped, folder),
            AnalysisCommand::ShowReport => {
                let written = analysing.view(None).written;
                let folder = written.and_then(Result::ok).map(Path::to_owned);
                if let Some(folder) = folder {
                    self.transient.folders.open(&self.executor, &folder);
                }
            }
        }
    }

    fn begin_analysis(&mut self, ctx: &egui::Context) {
        let held = self.transient.experiment.held.as_ref();
        let held = held.map(|held| held.log.clone());
        let is_stepped = self.is_stepped;
        self.transient.analysing.begin(ctx, is_stepped, held);
    }
}
