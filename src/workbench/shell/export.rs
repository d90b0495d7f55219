//! Exporting what a pane shows: asking where, writing, copying.

use std::path::{Path, PathBuf};

use crate::bench::command::Purpose;
use crate::bench::export::write::{ExportError, Kind};
use crate::bench::export::{Exportable, Exported};
use crate::bench::notices::Until;
use crate::bench::tool::Tool;
use crate::shell::state::Done;
use crate::shell::window::Workbench;

type Outcome = Result<Done, ExportError>;

impl Workbench {
    /// What a pane shows now.
    ///
    /// # Errors
    /// There is nothing, and what to do about it.
    pub(crate) fn exported(&mut self, what: Exportable) -> Result<Exported, &'static str> {
        match what {
            Exportable::Timeline => self.shell.bar.export(&mut self.bench),
            Exportable::Pane(pane) => match self.tools.showing(pane) {
                Some(tool) => tool.export(pane, &mut self.bench),
                None => Err("This pane shows no numbers to export"),
            },
        }
    }

    /// Keeps what is seen and asks where it goes; says what to do when there is nothing.
    pub(crate) fn ask_export(&mut self, what: Exportable) {
        match self.exported(what) {
            Ok(exported) => {
                self.shell.exports.seen = Some((what, exported));
                let purpose = Purpose::Export(what);
                let known = self.export_path(what);
                self.shell
                    .dialogs
                    .ask(purpose, Some(&known), &self.bench.ctx);
            }
            Err(words) => self.bench.notices.give(words),
        }
    }

    /// Where an export is expected to go: as the last one did, else beside the scene.
    pub(crate) fn export_path(&self, what: Exportable) -> PathBuf {
        let last = self.shell.exports.last.clone();
        let beside = || (self.bench.export_folder(), Kind::default());
        let (folder, kind) = last.unwrap_or_else(beside);
        let own = match what {
            Exportable::Pane(pane) => {
                let mut tools = self.tools.iter();
                let tool = tools.find(|tool| tool.panes().contains(&pane));
                tool.and_then(Tool::export_name)
            }
            Exportable::Timeline => None,
        };
        match own {
            Some(name) => folder.join(format!("{name}.{}", kind.ending())),
            None => folder.join(what.file_name(kind.ending())),
        }
    }

    /// Writes what was seen when it was asked for.
    pub(crate) fn export_to(&mut self, what: Exportable, path: PathBuf) {
        let kind = match Kind::of(&path) {
            Ok(kind) => kind,
            // The field stays, so that the name can be mended.
            Err(error) => return self.bench.notices.give(error.to_string()),
        };
        self.shell.ask = None;
        let Some(exported) = self.take_seen(what) else {
            return;
        };
        let folder = path.parent().map(Path::to_owned).unwrap_or_default();
        self.shell.exports.last = Some((folder, kind));
        self.begin_export(move || {
            exported.write(&path)?;
            Ok(Done::Written(format!("{} is written", path.display())))
        });
    }

    /// Copies a table as text.
    pub(crate) fn copy_table(&mut self, what: Exportable) {
        match self.exported(what) {
            Ok(exported) => self.begin_export(move || exported.to_csv().map(Done::Table)),
            Err(words) => self.bench.notices.give(words),
        }
    }

    /// What was kept of this when it was asked for; else what is seen now.
    fn take_seen(&mut self, what: Exportable) -> Option<Exported> {
        match self.shell.exports.seen.take() {
            Some((seen, exported)) if seen == what => Some(exported),
            _ => match self.exported(what) {
                Ok(exported) => Some(exported),
                Err(words) => {
                    self.bench.notices.give(words);
                    None
                }
            },
        }
    }

    fn begin_export(&mut self, work: impl FnOnce() -> Outcome + Send + 'static) {
        let executor = &self.bench.executor;
        let task = executor.start("selvedge-export", |_| {
            work().map_err(|error| error.to_string())
        });
        self.shell.exports.tasks.push(task);
        self.poll_exports();
    }

    /// Takes the news of exports that have ended. To be called every frame.
    pub(crate) fn poll_exports(&mut self) {
        for task in std::mem::take(&mut self.shell.exports.tasks) {
            match task.poll() {
                None => self.shell.exports.tasks.push(task),
                Some(Ok(Done::Table(table))) => self.bench.ctx.copy_text(table),
                Some(Ok(Done::Written(line))) => {
                    self.bench.notices.give_until(Until::Read, line);
                }
                Some(Err(line)) => self.bench.notices.give(line),
            }
        }
    }
}
