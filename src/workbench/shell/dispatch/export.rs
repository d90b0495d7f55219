//! Exporting what a pane shows: asking where, writing, copying.

use std::path::{Path, PathBuf};

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::Purpose;
use crate::bench::export::write::{ExportError, Kind};
use crate::bench::export::{Exportable, Exported};
use crate::bench::job::{Job, Polled};

/// What a job ends with: a table to be copied, or nothing where a file was written.
type Outcome = Result<Option<String>, ExportError>;

impl Bench {
    /// Keeps what is seen and asks where it goes; says what to do when there is nothing.
    pub(crate) fn ask_export(&mut self, ctx: &egui::Context, what: Exportable) {
        match self.exported(what) {
            Ok(exported) => {
                self.transient.exports.seen = Some((what, exported));
                let purpose = Purpose::Export(what);
                let known = self.export_path(what);
                self.transient.dialogs.ask(purpose, Some(&known), ctx);
            }
            Err(words) => self.transient.notices.give(words),
        }
    }

    /// Where an export is expected to go: as the last one did, else beside the scene.
    pub(crate) fn export_path(&self, what: Exportable) -> PathBuf {
        let last = self.transient.exports.last.clone();
        let beside = || {
            let scene = self.document.path().and_then(|path| path.parent());
            (
                scene.map(Path::to_owned).unwrap_or_default(),
                Kind::default(),
            )
        };
        let (folder, kind) = last.unwrap_or_else(beside);
        let figure = self.transient.analysing.figure();
        match figure.filter(|_| what == Exportable::Analysed) {
            Some((section, drawn)) => {
                let ending = kind.ending();
                folder.join(format!("{}-{}.{ending}", section.key, drawn.key))
            }
            None => folder.join(what.file_name(kind)),
        }
    }

    /// Writes what was seen when it was asked for.
    pub(crate) fn export_to(&mut self, ctx: &egui::Context, what: Exportable, path: PathBuf) {
        let kind = match Kind::of(&path) {
            Ok(kind) => kind,
            // The field stays, so that the name can be mended.
            Err(error) => return self.transient.notices.give(error.to_string()),
        };
        self.transient.ask = None;
        let Some(exported) = self.take_seen(what) else {
            return;
        };
        let folder = path.parent().map(Path::to_owned).unwrap_or_default();
        self.transient.exports.last = Some((folder, kind));
        self.begin_export(ctx, move || exported.write(&path).map(|()| None));
    }

    /// Copies a table as text.
    pub(crate) fn copy_table(&mut self, ctx: &egui::Context, what: Exportable) {
        match self.exported(what) {
            Ok(exported) => self.begin_export(ctx, move || exported.to_csv().map(Some)),
            Err(words) => self.transient.notices.give(words),
        }
    }

    /// What was kept of this when it was asked for; else what is seen now.
    fn take_seen(&mut self, what: Exportable) -> Option<Exported> {
        match self.transient.exports.seen.take() {
            Some((seen, exported)) if seen == what => Some(exported),
            _ => match self.exported(what) {
                Ok(exported) => Some(exported),
                Err(words) => {
                    self.transient.notices.give(words);
                    None
                }
            },
        }
    }

    fn begin_export(
        &mut self,
        ctx: &egui::Context,
        work: impl FnOnce() -> Outcome + Send + 'static,
    ) {
        if self.is_stepped {
            return self.take_exported(ctx, work());
        }
        match Job::start("selvedge-export", ctx, work) {
            Ok(job) => self.transient.exports.jobs.push(job),
            Err(error) => {
                let words = format!("Nothing was exported: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }

    /// Takes the news of exports that have ended. To be called every frame.
    pub(crate) fn poll_exports(&mut self, ctx: &egui::Context) {
        for job in std::mem::take(&mut self.transient.exports.jobs) {
            match job.poll() {
                Polled::Working => self.transient.exports.jobs.push(job),
                Polled::Done(outcome) => self.take_exported(ctx, outcome),
                Polled::BrokeOff => {
                    let words = "Nothing was exported: the work broke off; try again";
                    self.transient.notices.give(words);
                }
            }
        }
    }

    fn take_exported(&mut self, ctx: &egui::Context, outcome: Outcome) {
        match outcome {
            Ok(Some(table)) => ctx.copy_text(table),
            Ok(None) => {}
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }
}
