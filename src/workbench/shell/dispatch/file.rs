//! Files: scenes and recordings, opened and saved; and closing the window without losing any.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::{FileCommand, Purpose};
use crate::bench::job::Job;
use crate::bench::opening::{Opened, Opening, Origin, open};
use crate::bench::recording::Take;
use crate::shell::ask::Ask;
use crate::shell::error::AppError;
use crate::shell::state::After;
use crate::tools::analysis::command::AnalysisCommand;
use crate::tools::experiment::command::ExperimentCommand;
use crate::tools::experiment::form::Chosen;
use crate::tools::import::ImportCommand;
use crate::tools::picture::PictureCommand;

use selvedge_render::scene::{ExplorationPath, SceneError};

impl Bench {
    pub(crate) fn dispatch_file(&mut self, ctx: &egui::Context, command: FileCommand) {
        match command {
            FileCommand::Ask(Purpose::Export(what)) => self.ask_export(ctx, what),
            FileCommand::Ask(purpose) => self.ask(ctx, purpose),
            FileCommand::Use(Purpose::OpenScene, path) => {
                self.unless_unsaved(ctx, After::Open(Origin::File(path)));
            }
            FileCommand::New => self.unless_unsaved(ctx, After::Open(Origin::New)),
            FileCommand::OpenShipped => self.unless_unsaved(ctx, After::Open(Origin::Shipped)),
            FileCommand::Use(Purpose::SaveScene, path) => self.save_scene(ctx, &path),
            FileCommand::Use(Purpose::OpenRecording, path) => self.open_recording(ctx, path),
            FileCommand::Use(Purpose::SaveRecording, path) => self.save_recording(ctx, path),
            FileCommand::Use(Purpose::Clip(kind), path) => self.write_clip_to(ctx, kind, &path),
            FileCommand::StopClip => self.stop_clip(),
            FileCommand::Use(Purpose::Export(what), path) => self.export_to(ctx, what, path),
            FileCommand::Use(Purpose::ImportFiles, path) => {
                self.transient.ask = None;
                self.dispatch(ctx, ImportCommand::Add(vec![path]).into());
            }
            FileCommand::Use(Purpose::OpenPicture, path) => {
                self.transient.ask = None;
                self.dispatch(ctx, PictureCommand::Open(path).into());
            }
            FileCommand::Use(Purpose::OpenDesign, path) => {
                self.transient.ask = None;
                self.dispatch(ctx, ExperimentCommand::Open(path).into());
            }
            FileCommand::Use(Purpose::OpenLogs, path) => {
                self.transient.ask = None;
                self.dispatch(ctx, AnalysisCommand::Open(path).into());
            }
            FileCommand::Use(Purpose::WriteReport, path) => {
                self.transient.ask = None;
                self.dispatch(ctx, AnalysisCommand::Write(path).into());
            }
            FileCommand::CopyTable(what) => self.copy_table(ctx, what),
            FileCommand::Save => match self.document.path().cloned() {
                Some(path) => self.save_scene(ctx, &path),
                None => self.ask(ctx, Purpose::SaveScene),
            },
            FileCommand::Close => self.unless_unsaved(ctx, After::Close),
            FileCommand::LetGo => {
                if let Some(after) = self.transient.question.take() {
                    self.go_on(ctx, after);
                }
            }
        }
    }

    /// Asks for a path: by the desktop's dialog where there is one, else by a field.
    fn ask(&mut self, ctx: &egui::Context, purpose: Purpose) {
        let known = self.known_path(purpose);
        self.transient.dialogs.ask(purpose, known.as_deref(), ctx);
    }

    /// Shows the field that asks for a path.
    pub(crate) fn show_field(&mut self, purpose: Purpose) {
        let known = self.known_path(purpose);
        self.transient.ask = Some(Ask::new(purpose, known.as_ref()));
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        match purpose {
            Purpose::OpenScene | Purpose::SaveScene => self.document.path().cloned(),
            Purpose::Export(what) => Some(self.export_path(what)),
            Purpose::Clip(kind) => Some(self.clip_path(kind)),
            Purpose::ImportFiles => {
                let files = &self.transient.importing.draft.told.files;
                files.last().map(|file| file.source.path().to_owned())
            }
            Purpose::OpenPicture => {
                let chosen = self.transient.picturing.draft.source.as_ref();
                chosen.map(|chosen| chosen.file().path().to_owned())
            }
            Purpose::OpenDesign => match &self.transient.experiment.form.chosen {
                Chosen::File(path) => Some(path.clone()),
                Chosen::Shipped(_) => None,
            },
            Purpose::OpenLogs => self.transient.analysing.fields.folder(),
            Purpose::WriteReport => self.transient.analysing.report_folder(),
            Purpose::OpenRecording | Purpose::SaveRecording => {
                let take = self.take.as_ref()?;
                take.file().map(Path::to_owned)
            }
        }
    }

    /// Goes on at once when everything is saved; otherwise asks first.
    fn unless_unsaved(&mut self, ctx: &egui::Context, after: After) {
        self.transient.ask = None;
        if self.document.is_edited() {
            self.transient.question = Some(after);
        } else {
            self.go_on(ctx, after);
        }
    }

    fn go_on(&mut self, ctx: &egui::Context, after: After) {
        match after {
            After::Close => {
                self.transient.may_close = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
            After::Open(origin) => self.open(ctx, origin),
        }
    }

    fn open(&mut self, ctx: &egui::Context, origin: Origin) {
        self.transient.ask = None;
        if self.is_stepped {
            let outcome = open(origin, self.settings.preferences.rendering).map(Box::new);
            return self.take_opened(outcome);
        }
        match Opening::start(origin, self.settings.preferences.rendering, ctx) {
            Ok(opening) => self.transient.opening = Some(opening),
            Err(error) => {
                let words = format!("The scene was not opened: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }

    /// Takes a scene that was opened; when it was not, says why and keeps the last one.
    pub(crate) fn take_opened(&mut self, outcome: Result<Box<Opened>, AppError>) {
        match outcome {
            Ok(opened) => {
                if let Some(path) = &opened.path {
                    self.settings.preferences.remember_scene(path);
                }
                self.show_scene(*opened);
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    fn save_scene(&mut self, ctx: &egui::Context, path: &Path) {
        match self.document.save_as(path) {
            Ok(()) => {
                self.transient.ask = None;
                self.settings.preferences.remember_scene(path);
                if let Some(after) = self.transient.question.take() {
                    self.go_on(ctx, after);
                }
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    fn open_recording(&mut self, ctx: &egui::Context, path: PathBuf) {
        self.transient.ask = None;
        let read = move || {
            let found = ExplorationPath::read(&path);
            found.map(|found| Take::from_path(path, found))
        };
        if self.is_stepped {
            return self.take_take(read());
        }
        match Job::start("selvedge-recording", ctx, read) {
            Ok(job) => self.transient.reading = Some(job),
            Err(error) => {
                let words = format!("The recording was not opened: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }

    /// Takes an exploration that was read: it is replayed next.
    pub(crate) fn take_take(&mut self, outcome: Result<Take, SceneError>) {
        match outcome {
            Ok(take) => {
                self.take = Some(take);
                self.replay();
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    fn save_recording(&mut self, ctx: &egui::Context, path: PathBuf) {
        self.transient.ask = None;
        let Some(take) = self.take.clone() else {
            let words = "There is no recording to save; record one first";
            return self.transient.notices.give(words);
        };
        let write = move || match take.path().write(&path) {
            Ok(()) => Ok(take.saved_as(path)),
            Err(error) => Err(error),
        };
        if self.is_stepped {
            return self.take_saved(write());
        }
        match Job::start("selvedge-save", ctx, write) {
            Ok(job) => self.transient.saving = Some(job),
            Err(error) => {
                let words = format!("The recording was not saved: {error}; try again");
                self.transient.notices.give(words);
            }
        }
    }

    /// Takes the news that a recording was saved.
    pub(crate) fn take_saved(&mut self, outcome: Result<Take, SceneError>) {
        match outcome {
            Ok(saved) => {
                // Another exploration may have been recorded meanwhile.
                let is_same = |take: &Take| Arc::ptr_eq(take.path(), saved.path());
                if self.take.as_ref().is_some_and(is_same) {
                    self.take = Some(saved);
                }
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    /// Lets the recording at hand move the display; it waits at its first tick.
    pub(crate) fn replay(&mut self) {
        let Some(take) = self.take.clone() else {
            return;
        };
        let source = selvedge_engine::InputSource::Replay(Arc::clone(take.path()));
        self.send(selvedge_engine::Command::SetSource(source));
        self.send(selvedge_engine::Command::SetLoop(self.transient.does_loop));
        self.send(selvedge_engine::Command::Seek(0));
    }
}
