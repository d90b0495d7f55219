//! The one place where something changes: commands in, document, engine and transient state out.

pub(crate) mod edit;
pub(crate) mod export;
pub(crate) mod file;
pub(crate) mod keep;
pub(crate) mod play;
pub(crate) mod show;

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::edit::Edit;
use crate::bench::command::{Chosen, Command, Part, PlayCommand, PlaySource, ShowCommand};
use crate::bench::document::Document;

impl Bench {
    /// Does what the user wants.
    pub(crate) fn dispatch(&mut self, ctx: &egui::Context, command: Command) {
        if !self.transient.experiment.allows(&command) {
            let words = "A session is held: end it first, in the Experimenter pane";
            return self.transient.notices.give(words);
        }
        match command {
            Command::AllOff => self.all_off(),
            Command::Edit(edit) => self.edit(ctx, &edit),
            Command::Undo => self.step_history(ctx, Document::undo),
            Command::Redo => self.step_history(ctx, Document::redo),
            Command::Device(command) => self.dispatch_device(ctx, command),
            Command::File(command) => self.dispatch_file(ctx, command),
            Command::Play(PlayCommand::Source(PlaySource::Input)) => self.choose_input(ctx),
            Command::Play(command) => self.dispatch_play(command),
            Command::Source(command) => self.dispatch_source(ctx, command),
            Command::Compare(command) => self.dispatch_compare(ctx, command),
            Command::Accuracy(command) => self.dispatch_accuracy(ctx, command),
            Command::Collection(command) => self.dispatch_collection(ctx, command),
            Command::Import(command) => self.dispatch_import(ctx, command),
            Command::Picture(command) => self.dispatch_picture(ctx, command),
            Command::Keep(keep) => self.keep(ctx, keep),
            Command::Lab(command) => self.dispatch_lab(ctx, command),
            Command::Experiment(command) => self.dispatch_experiment(ctx, command),
            Command::Analysis(command) => self.dispatch_analysis(ctx, command),
            Command::Show(command) => self.dispatch_show(ctx, &command),
            Command::Chosen(act) => self.act_on_chosen(ctx, act),
            Command::Dismiss => self.dismiss(),
            Command::DismissNotice(number) => self.transient.notices.dismiss(number),
        }
    }

    /// Everything off. The switch works at once, whatever waits in the engine's queue.
    fn all_off(&mut self) {
        self.switch.press();
        self.dismiss();
    }

    fn act_on_chosen(&mut self, ctx: &egui::Context, act: Chosen) {
        let Some(index) = self.workspace.cloth else {
            return;
        };
        let part = Part::Cloth(index);
        let command = match act {
            Chosen::Remove => Edit::RemoveCloth(index).into(),
            Chosen::Raise => Edit::RaiseCloth(index).into(),
            Chosen::Mute => ShowCommand::Mute(part).into(),
            Chosen::Solo => ShowCommand::Solo(part).into(),
        };
        self.dispatch(ctx, command);
    }

    fn dismiss(&mut self) {
        self.transient.ask = None;
        self.transient.exports.seen = None;
        self.transient.question = None;
        self.workspace.is_calibrating = false;
        self.transient.is_help_shown = false;
    }

    pub(crate) fn send(&mut self, command: selvedge_engine::Command) {
        if let Err(error) = self.engine.send(command) {
            self.transient.notices.give(error.to_string());
        }
    }
}
