//! What is shown how: kept per user where that makes sense, never undone.

use eframe::egui;

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::mute_solo::MuteSolo;
use crate::shell::arrangement;
use crate::shell::perspective::arrangement_for;
use crate::tools::why::text::to_text;
use crate::tools::workspace::state::Place;

impl Bench {
    pub(crate) fn dispatch_show(&mut self, ctx: &egui::Context, command: &ShowCommand) {
        let place = Place {
            pane: self.transient.ground.unwrap_or(egui::Rect::ZERO),
            size_mm: self.document.scene().size_mm,
            pixels_per_point: ctx.pixels_per_point(),
        };
        self.workspace.take(command, place);
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
            ShowCommand::Pane(pane) => {
                arrangement::toggle(&mut self.tree, pane);
                self.keep_arrangement();
            }
            ShowCommand::Perspective(perspective) => self.arrange_for(perspective),
            ShowCommand::DefaultArrangement => {
                let perspective = self.settings.preferences.perspective;
                self.tree = arrangement_for(perspective, self.transient.desk_size);
                self.settings.preferences.arrangements[perspective.index()] = None;
            }
            ShowCommand::SelectContactor(contactor) => {
                self.send(selvedge_engine::Command::Watch(contactor));
            }
            ShowCommand::Mute(part) => self.transient.mute_solo.toggle_mute(part),
            ShowCommand::Solo(part) => self.transient.mute_solo.toggle_solo(part),
            ShowCommand::HearAll => self.transient.mute_solo = MuteSolo::default(),
            ShowCommand::ToggleNumbers => {
                self.settings.preferences.has_numbers = !self.settings.preferences.has_numbers;
            }
            ShowCommand::FreezeWhy => self.transient.why.1 = !self.transient.why.1,
            ShowCommand::CopyWhy => {
                if let Some(why) = &self.transient.why.0 {
                    ctx.copy_text(to_text(why));
                }
            }
            ShowCommand::Help => {
                self.transient.is_help_shown = !self.transient.is_help_shown;
            }
            _ => {}
        }
        self.tell_gains();
    }

    /// Keeps the arrangement as it is now.
    pub(crate) fn keep_arrangement(&mut self) {
        let perspective = self.settings.preferences.perspective;
        self.settings.preferences.arrangements[perspective.index()] =
            arrangement::to_text(&self.tree);
    }
}
