//! What is shown how: kept per user where that makes sense, never undone.

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::mute_solo::MuteSolo;
use crate::shell::arrangement;
use crate::shell::perspective::arrangement_for;
use crate::shell::window::Workbench;

impl Workbench {
    /// Shows something, or shows it otherwise.
    pub(crate) fn dispatch_show(&mut self, command: &ShowCommand) {
        if let ShowCommand::Pane(pane) | ShowCommand::Reveal(pane) = *command {
            self.bench.pointer.pane_in_use = Some(pane);
        }
        match *command {
            ShowCommand::Pane(pane) => {
                arrangement::toggle(&mut self.shell.tree, pane);
                self.keep_arrangement();
            }
            ShowCommand::Reveal(pane) if !self.shell.shows(pane) => {
                arrangement::toggle(&mut self.shell.tree, pane);
                self.keep_arrangement();
            }
            ShowCommand::Perspective(perspective) => self.arrange_for(perspective),
            ShowCommand::DefaultArrangement => {
                let preferences = &mut self.bench.settings.preferences;
                let perspective = preferences.perspective;
                self.shell.tree = arrangement_for(perspective, self.shell.size);
                preferences.arrangements[perspective.index()] = None;
            }
            ShowCommand::Help => self.shell.is_help_shown = !self.shell.is_help_shown,
            _ => self.bench.dispatch_show(command),
        }
        self.bench.send_gains();
    }

    /// Keeps the arrangement as it is now.
    pub(crate) fn keep_arrangement(&mut self) {
        let preferences = &mut self.bench.settings.preferences;
        preferences.arrangements[preferences.perspective.index()] =
            arrangement::to_text(&self.shell.tree);
    }
}

impl Bench {
    fn dispatch_show(&mut self, command: &ShowCommand) {
        let ctx = self.ctx.clone();
        self.selection.take(command);
        match *command {
            ShowCommand::Theme(preference) => {
                ctx.set_theme(preference);
                self.settings.preferences.theme = preference;
            }
            ShowCommand::ColourMap(map) => self.settings.preferences.colour_map = map,
            ShowCommand::Zoom(zoom) => {
                self.settings.preferences.zoom = zoom;
                self.settings.preferences = self.settings.preferences.clone().in_bounds();
                ctx.set_zoom_factor(self.settings.preferences.zoom);
            }
            ShowCommand::SelectContactor(contactor) => {
                self.send(selvedge_engine::Command::Watch(contactor));
            }
            ShowCommand::Mute(part) => self.selection.mute_solo.toggle_mute(part),
            ShowCommand::Solo(part) => self.selection.mute_solo.toggle_solo(part),
            ShowCommand::HearAll => self.selection.mute_solo = MuteSolo::default(),
            _ => {}
        }
    }
}
