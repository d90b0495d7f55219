//! The one place where commands are done: every tool hears of them, then bench and window act.

pub(crate) mod file;
pub(crate) mod show;

use crate::bench::Bench;
use crate::bench::command::device::DeviceCommand;
use crate::bench::command::edit::Edit;
use crate::bench::command::{
    Chosen, Command, FileCommand, Left, Part, PlayCommand, PlaySource, Purpose, ShowCommand,
};
use crate::bench::notices::Until;
use crate::shell::window::Workbench;

impl Workbench {
    /// Does what the user wants, and what comes of it.
    pub(crate) fn dispatch(&mut self, command: Command) {
        self.bench.commands.push(command);
        self.settle();
    }

    /// Does what waits.
    pub(crate) fn settle(&mut self) {
        while !self.bench.commands.is_empty() {
            let command = self.bench.commands.remove(0);
            self.act(command);
        }
        self.leave_scene();
    }

    /// Lets tools forget a scene that was left for another.
    fn leave_scene(&mut self) {
        let n_scenes = self.bench.inspection.n_scenes;
        if std::mem::replace(&mut self.shell.n_scenes, n_scenes) != n_scenes {
            for tool in self.tools.iter_mut() {
                tool.leave_scene(&mut self.bench);
            }
        }
    }

    fn act(&mut self, command: Command) {
        if command == Command::AllOff {
            // At once: before any tool hears of it, whatever waits in the engine's queue.
            self.bench.engine.stop_switch().press();
        }
        if self.bench.has_session() && !leaves_session(&command) {
            return self.bench.refuse_in_session();
        }
        self.leave_start_motion(&command);
        if is_risky(&command) {
            self.keep_unsaved_now();
        }
        for tool in self.tools.iter_mut() {
            tool.command(&command, &mut self.bench);
        }
        match command {
            Command::Escape => self.escape(),
            Command::AllOff | Command::Dismiss => self.shell.uncover(),
            Command::File(command) => self.dispatch_file(command),
            Command::Show(command) => self.dispatch_show(&command),
            Command::Undo => self.undo(),
            Command::Redo => self.step_to(self.steps().n_done + 1),
            Command::StepTo(n_done) => self.step_to(n_done),
            command => self.bench.act(command),
        }
    }
}

/// Whether unsaved work is kept before a command is done: what reads foreign files or drives a
/// device may go wrong.
fn is_risky(command: &Command) -> bool {
    match command {
        Command::Device(command) => *command == DeviceCommand::Arm,
        Command::File(FileCommand::Use(purpose, _)) => matches!(
            purpose,
            Purpose::ImportFiles
                | Purpose::OpenPicture(_)
                | Purpose::AddTurned
                | Purpose::OpenDrape
                | Purpose::OpenDesign
        ),
        _ => false,
    }
}

/// Whether a command leaves what is felt to the session.
fn leaves_session(command: &Command) -> bool {
    match command {
        Command::Escape
        | Command::AllOff
        | Command::Device(_)
        | Command::Dismiss
        | Command::DismissNotice(_)
        | Command::File(FileCommand::Left(Left::PutOff)) => true,
        Command::File(FileCommand::Ask(purpose) | FileCommand::Use(purpose, _)) => {
            matches!(purpose, Purpose::OpenLogs | Purpose::WriteReport)
        }
        Command::Show(command) => matches!(
            command,
            ShowCommand::Theme(_)
                | ShowCommand::ColourMap(_)
                | ShowCommand::Zoom(_)
                | ShowCommand::Pane(_)
                | ShowCommand::Reveal(_)
                | ShowCommand::Perspective(_)
                | ShowCommand::DefaultArrangement
                | ShowCommand::Hover(_)
                | ShowCommand::Help
                | ShowCommand::Guide(_)
                | ShowCommand::About
                | ShowCommand::Maximise(_)
                | ShowCommand::FullScreen
        ),
        _ => false,
    }
}

impl Bench {
    /// Does what concerns the document, the device and what is felt.
    fn act(&mut self, command: Command) {
        match command {
            Command::Edit(edit) => self.edit(&edit),
            Command::Device(command) => self.dispatch_device(command),
            Command::Play(PlayCommand::Source(PlaySource::Input)) => self.choose_input(),
            Command::Play(command) => self.dispatch_play(command),
            Command::Recording(command) => self.dispatch_recording(command),
            Command::Source(command) => self.dispatch_source(command),
            Command::Render(rendering) => {
                self.settings.preferences.rendering = rendering.in_bounds();
                self.render_as_chosen();
            }
            Command::Library(command) => self.dispatch_library(command),
            Command::Chosen(act) => self.act_on_chosen(act),
            Command::DismissNotice(Some(number)) => self.notices.dismiss(number),
            Command::DismissNotice(None) => self.notices.dismiss_all(),
            // Windows and tools have done these.
            Command::Escape
            | Command::AllOff
            | Command::Undo
            | Command::Redo
            | Command::StepTo(_)
            | Command::Dismiss
            | Command::File(_)
            | Command::Show(_)
            | Command::Lab(_) => {}
            #[cfg(feature = "friction")]
            Command::Friction(_) => {}
        }
    }

    fn act_on_chosen(&mut self, act: Chosen) {
        let Some(index) = self.selection.cloth else {
            return;
        };
        let part = Part::Cloth(index);
        self.commands.push(match act {
            Chosen::Remove => Edit::RemoveCloth(index).into(),
            Chosen::Raise => Edit::RaiseCloth(index).into(),
            Chosen::Mute => ShowCommand::Mute(part).into(),
            Chosen::Solo => ShowCommand::Solo(part).into(),
        });
    }

    /// Says that what is shown and felt is the session's alone.
    pub(crate) fn refuse_in_session(&mut self) {
        let words = "A session is held: end it first, in the Experimenter pane";
        self.notices.give_until(Until::SessionOver, words);
    }

    /// Tells the engine what is wanted of it.
    pub(crate) fn send(&mut self, command: selvedge_engine::Command) {
        if let Err(error) = self.engine.send(command) {
            self.notices.give(error.to_string());
        }
    }
}
