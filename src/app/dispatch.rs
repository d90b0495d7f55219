//! The one place where something changes: commands in, document, engine and transient state out.

use std::path::PathBuf;

use eframe::egui;

use super::command::{
    Command, DeviceCommand, Edit, FileCommand, PlayCommand, PlaySource, Purpose, ShowCommand,
};
use super::opening::{Opened, Opening, open};
use super::panes::Ask;
use super::query;
use super::view::Source;
use super::window::Workbench;
use crate::bridge::Target;
use crate::engine::{self, InputSource};
use crate::geometry::Point;
use crate::scene::{Scene, Stroke};

/// How fast the display explores by itself, mm/s.
const STROKE_MM_PER_S: f64 = 120.0;

impl Workbench {
    /// Does what the user wants.
    pub(crate) fn dispatch(&mut self, ctx: &egui::Context, command: Command) {
        match command {
            Command::AllOff => self.all_off(),
            Command::Edit(edit) => self.edit(&edit),
            Command::Undo => self.step_history(super::document::Document::undo),
            Command::Redo => self.step_history(super::document::Document::redo),
            Command::Device(command) => self.dispatch_device(command),
            Command::File(command) => self.dispatch_file(ctx, command),
            Command::Play(command) => self.dispatch_play(command),
            Command::Show(command) => self.dispatch_show(ctx, command),
            Command::Dismiss => self.transient.ask = None,
            Command::DismissNotice(number) => self.transient.notices.dismiss(number),
        }
    }

    fn dispatch_device(&mut self, command: DeviceCommand) {
        match command {
            DeviceCommand::Arm => self.send(engine::Command::Arm),
            DeviceCommand::GoOn => {
                // The engine goes on and refuses to arm what is not there: no news to anybody.
                self.transient.is_going_on = true;
                self.send(engine::Command::Arm);
            }
            DeviceCommand::Disarm => self.send(engine::Command::Disarm),
            DeviceCommand::ConnectEmulator => self.connect(Target::Emulator),
            DeviceCommand::ConnectPort(path) => self.connect(Target::Port(path)),
            DeviceCommand::Disconnect => {
                self.transient.target = None;
                self.send(engine::Command::Disconnect);
            }
            DeviceCommand::ListPorts => {}
        }
    }

    fn dispatch_file(&mut self, ctx: &egui::Context, command: FileCommand) {
        match command {
            FileCommand::Ask(purpose) => {
                let is_save = purpose == Purpose::SaveScene;
                self.transient.ask = Some(Ask::new(is_save, self.document.path()));
            }
            FileCommand::Use(Purpose::OpenScene, path) => self.open(ctx, path),
            FileCommand::Use(Purpose::SaveScene, path) => self.save_as(&path),
            FileCommand::Save => match self.document.path().cloned() {
                Some(path) => self.save_as(&path),
                None => self.transient.ask = Some(Ask::new(true, None)),
            },
            _ => {}
        }
    }

    fn dispatch_play(&mut self, command: PlayCommand) {
        match command {
            PlayCommand::Toggle | PlayCommand::Source(PlaySource::Stroke) => self.toggle_stroke(),
            _ => {}
        }
    }

    fn dispatch_show(&mut self, ctx: &egui::Context, command: ShowCommand) {
        match command {
            ShowCommand::Theme(preference) => ctx.set_theme(preference),
            ShowCommand::ColourMap(map) => self.layout.colour_map = map,
            _ => {}
        }
    }

    /// Everything off. The switch works at once, whatever waits in the engine's queue.
    fn all_off(&mut self) {
        self.switch.press();
        self.transient.ask = None;
    }

    fn send(&mut self, command: engine::Command) {
        if let Err(error) = self.engine.send(command) {
            self.transient.notices.give(error.to_string());
        }
    }

    fn connect(&mut self, target: Target) {
        self.transient.target = Some(query::device_name(&target));
        self.send(engine::Command::Connect(target));
    }

    fn toggle_stroke(&mut self) {
        match self.transient.live.source {
            Source::Pointer | Source::Other => {
                let stroke = resting_stroke(self.document.scene());
                self.send(engine::Command::SetSource(InputSource::Stroke(stroke)));
                self.send(engine::Command::SetLoop(true));
                self.send(engine::Command::Play);
            }
            Source::Stroke { is_playing: false } => self.send(engine::Command::Play),
            Source::Stroke { is_playing: true } => {
                self.send(engine::Command::SetSource(InputSource::Pointer));
            }
        }
    }

    fn edit(&mut self, edit: &Edit) {
        let before = self.document.scene().clone();
        let now = self.transient.moment;
        if let Err(error) = self.document.edit(edit, now) {
            self.transient.notices.give(error.to_string());
        }
        self.let_engine_follow(&before);
    }

    fn step_history(&mut self, step: fn(&mut super::document::Document) -> Option<&'static str>) {
        let before = self.document.scene().clone();
        step(&mut self.document);
        self.let_engine_follow(&before);
    }

    /// Tells the engine what changed in the document since `before`.
    fn let_engine_follow(&mut self, before: &Scene) {
        let after = self.document.scene().clone();
        if before.tuning != after.tuning {
            self.send(engine::Command::SetTuning(self.document.tuning()));
        }
        for (textile, gain_db) in query::changed_gains(before, &after) {
            self.send(engine::Command::SetTextileGain { textile, gain_db });
        }
    }

    fn open(&mut self, ctx: &egui::Context, path: PathBuf) {
        self.transient.ask = None;
        if self.is_stepped {
            let outcome = open(Some(&path)).map(Box::new);
            return self.take_opened(outcome);
        }
        match Opening::start(path, ctx) {
            Ok(opening) => self.transient.opening = Some(opening),
            Err(error) => {
                self.transient
                    .notices
                    .give(format!("The scene was not opened: {error}; try again"));
            }
        }
    }

    /// Takes a scene that was opened; when it was not, says why and keeps the last one.
    pub(crate) fn take_opened(&mut self, outcome: Result<Box<Opened>, super::error::AppError>) {
        match outcome {
            Ok(opened) => {
                let Opened {
                    path,
                    loaded,
                    prepared,
                    pictures,
                    flaws,
                } = *opened;
                self.send(engine::Command::SetScene(Box::new(prepared)));
                for flaw in flaws {
                    self.transient.notices.give(flaw);
                }
                self.show_scene(path, loaded, pictures);
            }
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }

    fn save_as(&mut self, path: &std::path::Path) {
        match self.document.save_as(path) {
            Ok(()) => self.transient.ask = None,
            Err(error) => self.transient.notices.give(error.to_string()),
        }
    }
}

/// The stroke that the display explores a scene with: a circle around its middle.
pub(crate) fn resting_stroke(scene: &Scene) -> Stroke {
    let [width_mm, height_mm] = scene.size_mm;
    Stroke::Circle {
        centre: Point::new(width_mm / 2.0, height_mm / 2.0),
        radius_mm: 0.25 * width_mm.min(height_mm),
        speed_mm_per_s: STROKE_MM_PER_S,
    }
}
