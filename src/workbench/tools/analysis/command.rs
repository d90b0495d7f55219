//! What can be done with an analysis.

use std::path::PathBuf;

use crate::bench::command::Command;
use crate::tools::analysis::asked::Choice;

/// Something to do with the analysis of logs. Never undone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum AnalysisCommand {
    /// Analyse the logs in this folder; its pane comes in sight.
    Open(PathBuf),
    /// Choose this.
    Choose(Choice),
    /// Analyse what is asked for.
    Begin,
    /// Stop; the last result stays.
    Stop,
    /// Show this section.
    Select(usize),
    /// Show results although a session is held, or cover them again.
    Uncover(bool),
    /// Copy this table of the section at hand as CSV.
    CopyTable(usize),
    /// Save this figure of the section at hand.
    SaveFigure(usize),
    /// Write the report into this folder.
    Write(PathBuf),
    /// Show the report that was written in the desktop's file manager.
    ShowReport,
}

impl From<AnalysisCommand> for Command {
    fn from(command: AnalysisCommand) -> Self {
        Self::Analysis(command)
    }
}
