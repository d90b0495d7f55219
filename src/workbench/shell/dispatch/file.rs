//! Files: paths that are asked for, and closing the window without losing anything.

use std::path::{Path, PathBuf};

use eframe::egui;

use crate::bench::command::{FileCommand, Purpose};
use crate::bench::opening::Origin;
use crate::shell::ask::Ask;
use crate::shell::state::After;
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
            FileCommand::LetGo => {
                if let Some(after) = self.shell.question.take() {
                    self.go_on(after);
                }
            }
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
            Purpose::OpenRecording | Purpose::SaveRecording => {
                let take = bench.exploration.at_hand.as_ref()?;
                take.file().map(Path::to_owned)
            }
            _ => None,
        }
    }

    /// Goes on at once when everything is saved; otherwise asks first.
    fn unless_unsaved(&mut self, after: After) {
        self.shell.ask = None;
        if self.bench.document.is_edited() {
            self.shell.question = Some(after);
        } else {
            self.go_on(after);
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
        match self.bench.document.save_as(path) {
            Ok(()) => {
                self.shell.ask = None;
                self.bench.settings.preferences.remember_scene(path);
                if let Some(after) = self.shell.question.take() {
                    self.go_on(after);
                }
            }
            Err(error) => self.bench.notices.give(error.to_string()),
        }
    }
}
