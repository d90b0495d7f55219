//! The menus of the header: what can be done with scenes, what was done, what is shown how, help.
//! Acts have the names and keys that they have everywhere.

use std::path::PathBuf;

use eframe::egui::{Button, RichText, ScrollArea, Ui};

use crate::bench::acts::{self, CLIP, COLOURS, CONTACTORS, SIZE, SOUND, THEME, group};
use crate::bench::clips::ClipsView;
use crate::bench::command::{Command, Commands, DotStyle, FileCommand, Purpose, ShowCommand};
use crate::bench::document::Document;
use crate::bench::history::StepList;
use crate::bench::keys::hint;
use crate::bench::overlays::Overlays;
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::settings::preferences::SoundPreferences;
use crate::bench::view::SceneView;
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::slider::tell;
use crate::kit::widgets::text::tick_box;
use selvedge_foundation::quantity;

/// Height of the list of steps, points.
const LIST: f32 = 360.0;

/// What is shown how, as the menu ticks it.
#[derive(Debug, Clone)]
pub(crate) struct Appearance {
    /// What the window is arranged for.
    pub perspective: Perspective,
    /// The colours that stand for numbers.
    pub map: ColourMap,
    /// Size of everything: 1 is 100 %.
    pub(crate) zoom: f32,
    /// How contactors are drawn.
    pub dots: DotStyle,
    /// What is heard of what is felt.
    pub(crate) sound: SoundPreferences,
    /// Whether what is below the threshold of detection is greyed.
    pub(crate) greys_below: bool,
    /// What is drawn over the cloth.
    pub overlays: Overlays,
    /// The panes with whether each is in sight.
    pub panes: Vec<(Pane, bool)>,
    /// The recording on its way to other programs.
    pub clips: ClipsView,
    /// The scenes that were opened or saved last, newest first.
    pub recent: Vec<PathBuf>,
}

/// What can be done with scenes.
pub(crate) fn show_scene_menu(
    ui: &mut Ui,
    scene: &SceneView,
    appearance: &Appearance,
    commands: &mut Commands,
) {
    ui.menu_button("Scene", |ui| {
        ui.set_min_width(220.0);
        let ask = |purpose| -> Command { FileCommand::Ask(purpose).into() };
        entry(ui, FileCommand::New.into(), None, commands);
        entry(ui, ask(Purpose::OpenScene), None, commands);
        show_recent(ui, &appearance.recent, commands);
        entry(ui, FileCommand::OpenShipped.into(), None, commands);
        ui.separator();
        let unchanged = !scene.is_edited && scene.path.is_some();
        let why = unchanged.then_some("Nothing has changed");
        entry(ui, FileCommand::Save.into(), why, commands);
        entry(ui, ask(Purpose::SaveScene), None, commands);
        ui.separator();
        for purpose in [
            Purpose::ImportFiles,
            Purpose::OpenPicture(Pane::Picture),
            Purpose::AddLibrary,
            Purpose::OpenLogs,
            Purpose::OpenRecording,
        ] {
            entry(ui, ask(purpose), None, commands);
        }
        show_clips(ui, appearance.clips, commands);
        ui.separator();
        entry(ui, FileCommand::Close.into(), None, commands);
    });
}

/// The recording for other programs; while one is written, how far it is.
fn show_clips(ui: &mut Ui, clips: ClipsView, commands: &mut Commands) {
    if let Some(share) = clips.share {
        let percent = quantity::with_unit(f64::from(share) * 100.0, 0, "%");
        let words = format!("Stop the export ({percent})");
        return line(ui, &words, FileCommand::StopClip.into(), None, commands);
    }
    ui.add_enabled_ui(clips.has_take, |ui| {
        let menu = ui.menu_button("Export the recording", |ui| {
            for (label, act) in group(CLIP) {
                line(ui, &label, act.command.clone(), None, commands);
            }
        });
        menu.response
            .on_disabled_hover_text("There is no recording: record one or open one");
    });
}

fn show_recent(ui: &mut Ui, recent: &[PathBuf], commands: &mut Commands) {
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        let menu = ui.menu_button("Open recent", |ui| {
            for path in recent {
                let name = path.file_name().unwrap_or(path.as_os_str());
                let response = ui.button(name.to_string_lossy());
                if response.on_hover_text(path.display().to_string()).clicked() {
                    let command = FileCommand::Use(Purpose::OpenScene, path.clone());
                    commands.push(command.into());
                    ui.close();
                }
            }
        });
        menu.response
            .on_disabled_hover_text("No scene was opened or saved yet");
    });
}

/// What can be taken back and brought again, step by step.
pub(crate) fn show_edit_menu(
    ui: &mut Ui,
    steps: &StepList,
    document: &Document,
    commands: &mut Commands,
) {
    ui.menu_button("Edit", |ui| {
        ui.set_min_width(220.0);
        for (act, step, command) in [
            ("Undo", steps.undo(), Command::Undo),
            ("Redo", steps.redo(), Command::Redo),
        ] {
            let named = step.map(|step| format!("{act}: {step}"));
            let why = format!("Nothing to {}", act.to_lowercase());
            let refusal = step.is_none().then_some(why.as_str());
            let label = named.as_deref().unwrap_or(act);
            line(ui, label, command, refusal, commands);
        }
        ui.separator();
        ui.add_enabled_ui(!steps.names.is_empty(), |ui| {
            let menu = ui.menu_button("History", |ui| {
                // A tool may have steps of its own.
                let document = Some(document).filter(|document| document.steps() == *steps);
                show_history(ui, steps, document, commands);
            });
            menu.response.on_disabled_hover_text("Nothing was done yet");
        });
    });
}

/// Every step with what it turned, newest last; a click goes to where it had just been done.
fn show_history(
    ui: &mut Ui,
    steps: &StepList,
    document: Option<&Document>,
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let area = ScrollArea::vertical()
        .max_height(LIST)
        .stick_to_bottom(true);
    area.show(ui, |ui| {
        ui.set_min_width(200.0);
        let begun = "As it began".to_owned();
        for (n_done, name) in std::iter::once(&begun).chain(&steps.names).enumerate() {
            let ink = if n_done > steps.n_done {
                palette.dim
            } else {
                palette.text
            };
            let is_now = n_done == steps.n_done;
            let [own, from_now] = document
                .map(|document| document.turned_by(n_done))
                .unwrap_or_default();
            // The change itself says more than that it was one of gains.
            let words = if own.is_empty() { name } else { &own };
            let line = ui.selectable_label(is_now, RichText::new(words).color(ink));
            if line.hovered() && !from_now.is_empty() {
                tell(&line, format!("{name}. From now: {from_now}"));
            }
            if line.clicked() && !is_now {
                commands.push(Command::StepTo(n_done));
                ui.close();
            }
        }
    });
}

/// What is shown how.
pub(crate) fn show_view_menu(ui: &mut Ui, appearance: &Appearance, commands: &mut Commands) {
    ui.menu_button("View", |ui| {
        ui.set_min_width(220.0);
        for perspective in Perspective::ALL {
            let command = ShowCommand::Perspective(perspective);
            let is_shown = perspective == appearance.perspective;
            choice(ui, perspective.title(), is_shown, command.into(), commands);
        }
        ui.separator();
        ui.menu_button("Panes", |ui| {
            for (pane, is_shown) in &appearance.panes {
                let command = ShowCommand::Pane(*pane);
                choice(ui, pane.title(), *is_shown, command.into(), commands);
            }
        });
        for command in [
            ShowCommand::WalkPanes(1),
            ShowCommand::Maximise(None),
            ShowCommand::DefaultArrangement,
            ShowCommand::ToggleSceneArrangement,
            ShowCommand::FullScreen,
        ] {
            entry(ui, command.into(), None, commands);
        }
        ui.separator();
        for (title, prefix) in [
            ("Theme", THEME),
            ("Colours of numbers", COLOURS),
            ("Size of everything", SIZE),
            ("Contactors", CONTACTORS),
            ("Sound", SOUND),
        ] {
            ui.menu_button(title, |ui| {
                for (label, act) in group(prefix) {
                    let is_chosen = appearance.has_chosen(ui, &act.command);
                    choice(ui, &label, is_chosen, act.command.clone(), commands);
                }
            });
        }
        let greys: Command = ShowCommand::ToggleThreshold.into();
        let label = acts::label(&greys);
        choice(ui, label, appearance.greys_below, greys, commands);
        ui.menu_button("Over the cloth", |ui| {
            for (overlay, label) in Overlays::ALL {
                let command = ShowCommand::Overlay(overlay);
                let is_shown = appearance.overlays.shows(overlay);
                choice(ui, label, is_shown, command.into(), commands);
            }
        });
        ui.separator();
        entry(ui, ShowCommand::Calibrate.into(), None, commands);
    });
}

/// What tells more.
pub(crate) fn show_help_menu(ui: &mut Ui, commands: &mut Commands) {
    ui.menu_button("Help", |ui| {
        ui.set_min_width(220.0);
        for command in [
            ShowCommand::Guide(None),
            ShowCommand::About,
            ShowCommand::Help,
            ShowCommand::Palette,
            ShowCommand::Tour,
        ] {
            entry(ui, command.into(), None, commands);
        }
    });
}

impl Appearance {
    /// Whether this is what was chosen of its kind.
    fn has_chosen(&self, ui: &Ui, command: &Command) -> bool {
        match command {
            Command::Show(ShowCommand::Theme(theme)) => {
                ui.ctx().options(|options| options.theme_preference) == *theme
            }
            Command::Show(ShowCommand::ColourMap(map)) => *map == self.map,
            Command::Show(ShowCommand::Zoom(zoom)) => (zoom - self.zoom).abs() < 0.01,
            Command::Show(ShowCommand::DotStyle(style)) => *style == self.dots,
            Command::Show(ShowCommand::ToggleSound) => self.sound.is_on,
            Command::Show(ShowCommand::Loudness(loudness)) => *loudness == self.sound.loudness,
            Command::Show(ShowCommand::ToggleAsDriven) => self.sound.as_driven,
            _ => false,
        }
    }
}

/// An act, by the name and key that it has everywhere; grey, with the reason, when it does nothing.
fn entry(ui: &mut Ui, command: Command, refusal: Option<&str>, commands: &mut Commands) {
    let label = acts::label(&command);
    line(ui, label, command, refusal, commands);
}

/// A line that does something, with its key; grey, with the reason, when it does nothing.
fn line(
    ui: &mut Ui,
    label: &str,
    command: Command,
    refusal: Option<&str>,
    commands: &mut Commands,
) {
    let button = Button::new(label).shortcut_text(hint(ui.ctx(), &command));
    let response = ui.add_enabled(refusal.is_none(), button);
    let response = match refusal {
        Some(why) => response.on_disabled_hover_text(why),
        None => response,
    };
    if response.clicked() {
        commands.push(command);
        ui.close();
    }
}

/// A line that is ticked or not; the menu stays open.
fn choice(ui: &mut Ui, label: &str, is_chosen: bool, command: Command, commands: &mut Commands) {
    if tick_box(ui, label, is_chosen, hint(ui.ctx(), &command)) {
        commands.push(command);
    }
}
