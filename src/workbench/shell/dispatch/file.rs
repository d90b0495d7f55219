//! Files: paths that are asked for, and closing the window without losing anything.

use std::path::{Path, PathBuf};

use eframe::egui;

use crate::bench::command::{FileCommand, Purpose};
use crate::bench::library_acts::LibraryCommand;
use crate::bench::opening::Origin;
use crate::shell::ask::Ask;
use crate::shell::state::{After, Question};
use crate::shell::window::Workbench;

impl Workbench {
    /// Does something with files.
    pub(crate) fn dispatch_file(&mut self, command: FileCommand) {
        match command {
            FileCommand::Ask(Purpose::Export(what)) => self.ask_export(what),
            FileCommand::Ask(purpose) => self.ask(purpose),
            FileCommand::Use(Purpose::SaveScene, path) => self.save_scene(&path),
            FileCommand::Use(Purpose::Export(what), path) => self.export_to(what, path),
            FileCommand::Use(purpose, path) => {
                self.shell.ask = None;
                self.use_path(purpose, path);
            }
            FileCommand::New => self.unless_unsaved(After::Open(Origin::New)),
            FileCommand::OpenShipped => self.unless_unsaved(After::Open(Origin::Shipped)),
            FileCommand::StopClip => self.bench.stop_clip(),
            FileCommand::CopyTable(what) => self.copy_table(what),
            FileCommand::Save => match self.bench.document.path().cloned() {
                Some(path) => self.save_scene(&path),
                None => self.ask(Purpose::SaveScene),
            },
            FileCommand::Close => self.unless_unsaved(After::Close),
            FileCommand::LetGo => self.answer_question(),
            FileCommand::SaveAll => {
                let question = self.shell.question.as_ref();
                self.bench.files.recovery.keeps =
                    question.is_some_and(|question| question.after == After::Close);
                if self.bench.document.is_edited() {
                    self.dispatch_file(FileCommand::Save);
                } else {
                    self.answer_question();
                }
            }
            FileCommand::Left(what) => self.answer_offer(what),
        }
    }

    /// Uses a path that was chosen; tools have used theirs.
    fn use_path(&mut self, purpose: Purpose, path: PathBuf) {
        let bench = &mut self.bench;
        match purpose {
            Purpose::OpenScene => self.unless_unsaved(After::Open(Origin::File(path))),
            Purpose::OpenRecording => bench.open_recording(path),
            Purpose::SaveRecording => bench.save_recording(path),
            Purpose::Clip(kind) => bench.write_clip_to(kind, &path),
            Purpose::AddLibrary => bench.dispatch_library(LibraryCommand::AddFolder(path)),
            _ => {}
        }
    }

    /// Asks for a path: by the desktop's dialog where there is one, else by a field.
    fn ask(&mut self, purpose: Purpose) {
        let known = self.known_path(purpose);
        let ctx = &self.bench.ctx;
        self.shell.dialogs.ask(purpose, known.as_deref(), ctx);
    }

    /// Shows the field that asks for a path.
    pub(crate) fn show_field(&mut self, purpose: Purpose) {
        let known = self.known_path(purpose);
        self.shell.ask = Some(Ask::new(purpose, known.as_ref()));
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        let of_tool = self.tools.iter().find_map(|tool| tool.known_path(purpose));
        if of_tool.is_some() {
            return of_tool;
        }
        let bench = &self.bench;
        match purpose {
            Purpose::OpenScene | Purpose::SaveScene => bench.document.path().cloned(),
            Purpose::Export(what) => Some(self.export_path(what)),
            Purpose::Clip(kind) => Some(bench.clip_path(kind)),
            Purpose::OpenRecording => {
                let take = bench.exploration.at_hand.as_ref()?;
                take.file().map(Path::to_owned)
            }
            Purpose::SaveRecording => Some(bench.path_file()),
            _ => None,
        }
    }

    /// Goes on at once when nothing would be lost; otherwise asks first. Drafts outlive a scene,
    /// but not the window.
    fn unless_unsaved(&mut self, after: After) {
        self.shell.ask = None;
        self.bench.files.recovery.keeps = false;
        let mut parts = self.unsaved();
        if after != After::Close {
            parts.truncate(usize::from(self.bench.document.is_edited()));
        }
        if parts.is_empty() {
            self.go_on(after);
        } else {
            self.keep_unsaved_now();
            self.shell.question = Some(Question { after, parts });
        }
    }

    /// Goes on with what waits for an answer.
    fn answer_question(&mut self) {
        if let Some(question) = self.shell.question.take() {
            self.go_on(question.after);
        }
    }

    fn go_on(&mut self, after: After) {
        match after {
            After::Close => {
                self.shell.may_close = true;
                let close = egui::ViewportCommand::Close;
                self.bench.ctx.send_viewport_cmd(close);
            }
            After::Open(origin) => {
                self.shell.ask = None;
                self.bench.open(origin);
            }
        }
    }

    fn save_scene(&mut self, path: &Path) {
        // While another textile is listened to, its own are not at hand: what was stated stays.
        let contents = if self.bench.library.acts.listening.is_some() {
            self.bench.document.scene().contents.clone()
        } else {
            self.bench.engine_scene.loaded.contents()
        };
        match self.bench.document.save_as(path, contents) {
            Ok(()) => {
                self.shell.ask = None;
                self.bench.settings.preferences.remember_scene(path);
                self.answer_question();
            }
            Err(error) => self.bench.notices.give(error.to_string()),
        }
    }
}
