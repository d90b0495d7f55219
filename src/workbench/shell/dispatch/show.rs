//! What is shown how: kept per user where that makes sense, never undone.

use clap::ValueEnum as _;
use eframe::egui::ViewportCommand;

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::shell::arrangement;
use crate::shell::guide::{Reading, page_of};
use crate::shell::help::KeyList;
use crate::shell::palette::Palette;
use crate::shell::perspective::arrangement_for;
use crate::shell::state::Cover;
use crate::shell::tour;
use crate::shell::window::Workbench;
use selvedge_render::scene::Arrangement;

impl Workbench {
    /// Shows something, or shows it otherwise.
    pub(crate) fn dispatch_show(&mut self, command: &ShowCommand) {
        if let ShowCommand::Pane(pane) | ShowCommand::Reveal(pane) = *command {
            self.bench.pointer.pane_in_use = Some(pane);
        }
        match *command {
            ShowCommand::Pane(pane) => {
                self.shell.restore_panes();
                arrangement::toggle(&mut self.shell.tree, pane);
                self.keep_arrangement();
            }
            ShowCommand::Reveal(pane) => self.reveal(pane),
            ShowCommand::Perspective(perspective) => self.arrange_for(perspective),
            ShowCommand::DefaultArrangement => {
                self.shell.restore_panes();
                let perspective = self.bench.settings.preferences.perspective;
                self.shell.tree = arrangement_for(perspective, self.shell.size);
                if self.scene_keeps_arrangement() {
                    self.keep_arrangement();
                } else {
                    let kept = &mut self.bench.settings.preferences.arrangements;
                    kept[perspective.index()] = None;
                }
            }
            ShowCommand::ToggleSceneArrangement => self.toggle_scene_arrangement(),
            ShowCommand::WalkPanes(by) => self.walk_panes(by),
            ShowCommand::Maximise(pane) => self.maximise(pane),
            ShowCommand::FullScreen => self.fill_screen(),
            ShowCommand::Help | ShowCommand::Palette | ShowCommand::Guide(_) => {
                self.cover(command);
            }
            ShowCommand::About => self.explain_pane(),
            ShowCommand::Tour => tour::begin(&mut self.bench, &mut self.shell),
            _ => self.bench.dispatch_show(command),
        }
        self.bench.send_gains();
    }

    /// Brings a pane to the front if it is not in sight.
    fn reveal(&mut self, pane: Pane) {
        if self.shell.shows(pane) {
            return;
        }
        self.shell.restore_panes();
        if !self.shell.shows(pane) {
            arrangement::toggle(&mut self.shell.tree, pane);
            self.keep_arrangement();
        }
    }

    /// Shows keys, palette or guide in the place of whatever lies over the panes; the same again
    /// puts it away.
    fn cover(&mut self, command: &ShowCommand) {
        let was = self.shell.cover.take();
        self.shell.uncover();
        self.shell.cover = match (command, was) {
            (ShowCommand::Help, Some(Cover::Keys(_)))
            | (ShowCommand::Palette, Some(Cover::Palette(_)))
            | (ShowCommand::Guide(None), Some(Cover::Guide(_))) => None,
            (ShowCommand::Help, _) => Some(Cover::Keys(KeyList::default())),
            (ShowCommand::Palette, _) => Some(Cover::Palette(Palette::default())),
            (ShowCommand::Guide(page), _) => Some(Cover::Guide(Reading::of(page.as_deref()))),
            (_, was) => was,
        };
    }

    /// Opens the guide at what is said of the pane in use.
    fn explain_pane(&mut self) {
        let pane = self.shell.focus.pane.or(self.bench.pointer.pane_in_use);
        let page = page_of(pane.unwrap_or(Pane::Workspace));
        self.cover(&ShowCommand::Guide(Some(page)));
    }

    fn fill_screen(&mut self) {
        let ctx = &self.bench.ctx;
        let is_full = ctx.input(|input| input.viewport().fullscreen);
        let is_full = is_full.unwrap_or(self.shell.fills_screen);
        self.shell.fills_screen = !is_full;
        ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
    }

    /// Keeps the arrangement as it is now, of all panes: with the scene if that has one.
    pub(crate) fn keep_arrangement(&mut self) {
        if self.scene_keeps_arrangement() {
            self.keep_with_scene(self.arrangement());
        } else {
            let perspective = self.bench.settings.preferences.perspective;
            let panes = self.arrangement().map(|now| now.panes);
            self.bench.settings.preferences.arrangements[perspective.index()] = panes;
        }
    }

    fn scene_keeps_arrangement(&self) -> bool {
        let perspective = self.bench.settings.preferences.perspective;
        let own = self.bench.document.arrangement();
        own.is_some_and(|own| Perspective::from_str(&own.perspective, true) == Ok(perspective))
    }

    /// The arrangement as it is now, of all panes.
    fn arrangement(&self) -> Option<Arrangement> {
        let tree = self.shell.whole.as_ref().unwrap_or(&self.shell.tree);
        let perspective = self.bench.settings.preferences.perspective;
        Some(Arrangement {
            perspective: perspective.title().to_lowercase(),
            panes: arrangement::to_text(tree)?,
        })
    }

    fn keep_with_scene(&mut self, arrangement: Option<Arrangement>) {
        self.shell.resting.of_scene.clone_from(&arrangement);
        self.bench.document.arrange(arrangement);
    }

    fn toggle_scene_arrangement(&mut self) {
        let is_kept = self.bench.document.arrangement().is_some();
        self.keep_with_scene(self.arrangement().filter(|_| !is_kept));
        let words = if is_kept {
            "The scene no longer keeps how its window stands"
        } else {
            "The scene keeps how its window stands, from now on and once it is saved"
        };
        self.bench.notices.give(words);
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
            ShowCommand::SelectDisplay(display) => self.choose_display(display),
            ShowCommand::NextDisplay => self.choose_next_display(),
            ShowCommand::Mute(part) => self.selection.mute_solo.toggle_mute(part),
            ShowCommand::Solo(part) => self.selection.mute_solo.toggle_solo(part),
            ShowCommand::ToggleSound => {
                let sound = &mut self.settings.preferences.sound;
                sound.is_on = !sound.is_on;
            }
            ShowCommand::Loudness(loudness) => self.settings.preferences.sound.loudness = loudness,
            ShowCommand::ToggleAsDriven => {
                let sound = &mut self.settings.preferences.sound;
                sound.as_driven = !sound.as_driven;
            }
            ShowCommand::HearAll => self.selection.mute_solo = MuteSolo::default(),
            _ => {}
        }
    }
}
