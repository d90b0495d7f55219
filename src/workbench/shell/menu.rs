//! The two menus of the header: what can be done with scenes, and what is shown how.

use std::path::PathBuf;

use eframe::egui::{Button, RichText, ScrollArea, ThemePreference, Ui};

use crate::bench::clips::{CLIPS, ClipsView};
use crate::bench::command::{Command, Commands, DotStyle, FileCommand, Purpose, ShowCommand};
use crate::bench::history::StepList;
use crate::bench::keys::hint;
use crate::bench::overlays::Overlays;
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::view::SceneView;
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::text::tick_box;
use selvedge_foundation::quantity;

/// Sizes that are offered, %.
const ZOOMS: [u8; 5] = [100, 125, 150, 175, 200];
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
        entry(ui, "New", FileCommand::New.into(), None, commands);
        let open = FileCommand::Ask(Purpose::OpenScene);
        entry(ui, "Open…", open.into(), None, commands);
        show_recent(ui, &appearance.recent, commands);
        let shipped = FileCommand::OpenShipped;
        entry(ui, "Open the shipped scene", shipped.into(), None, commands);
        ui.separator();
        let unchanged = !scene.is_edited && scene.path.is_some();
        let why = unchanged.then_some("Nothing has changed");
        entry(ui, "Save", FileCommand::Save.into(), why, commands);
        let save_as = FileCommand::Ask(Purpose::SaveScene);
        entry(ui, "Save as…", save_as.into(), None, commands);
        ui.separator();
        let import = FileCommand::Ask(Purpose::ImportFiles);
        entry(ui, "Import measurements…", import.into(), None, commands);
        let picture = FileCommand::Ask(Purpose::OpenPicture);
        entry(ui, "Cloth from a picture…", picture.into(), None, commands);
        let experiment = ShowCommand::Perspective(Perspective::Experiment);
        entry(ui, "Run an experiment…", experiment.into(), None, commands);
        let analyse = FileCommand::Ask(Purpose::OpenLogs);
        entry(ui, "Analyse sessions…", analyse.into(), None, commands);
        let open = FileCommand::Ask(Purpose::OpenRecording);
        entry(ui, "Open a path to replay…", open.into(), None, commands);
        show_clips(ui, appearance.clips, commands);
        ui.separator();
        entry(ui, "Close", FileCommand::Close.into(), None, commands);
    });
}

/// The recording for other programs; while one is written, how far it is.
fn show_clips(ui: &mut Ui, clips: ClipsView, commands: &mut Commands) {
    if let Some(share) = clips.share {
        let percent = quantity::with_unit(f64::from(share) * 100.0, 0, "%");
        let words = format!("Stop the export ({percent})");
        return entry(ui, &words, FileCommand::StopClip.into(), None, commands);
    }
    ui.add_enabled_ui(clips.has_take, |ui| {
        let menu = ui.menu_button("Export the recording", |ui| {
            for (kind, words) in CLIPS {
                let ask = FileCommand::Ask(Purpose::Clip(kind));
                entry(ui, words, ask.into(), None, commands);
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
pub(crate) fn show_edit_menu(ui: &mut Ui, steps: &StepList, commands: &mut Commands) {
    ui.menu_button("Edit", |ui| {
        ui.set_min_width(220.0);
        for (act, step, command) in [
            ("Undo", steps.undo(), Command::Undo),
            ("Redo", steps.redo(), Command::Redo),
        ] {
            let named = step.map(|step| format!("{act}: {step}"));
            let why = format!("Nothing to {}", act.to_lowercase());
            let refusal = step.is_none().then_some(why.as_str());
            entry(
                ui,
                named.as_deref().unwrap_or(act),
                command,
                refusal,
                commands,
            );
        }
        ui.separator();
        ui.add_enabled_ui(!steps.names.is_empty(), |ui| {
            let menu = ui.menu_button("History", |ui| show_history(ui, steps, commands));
            menu.response.on_disabled_hover_text("Nothing was done yet");
        });
    });
}

/// Every step, newest last; a click goes to where it had just been done.
fn show_history(ui: &mut Ui, steps: &StepList, commands: &mut Commands) {
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
            let line = ui.selectable_label(is_now, RichText::new(name).color(ink));
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
            choice(ui, perspective.title(), is_shown, command, commands);
        }
        ui.separator();
        ui.menu_button("Panes", |ui| {
            for (pane, is_shown) in &appearance.panes {
                let command = ShowCommand::Pane(*pane);
                choice(ui, pane.title(), *is_shown, command, commands);
            }
        });
        let default = ShowCommand::DefaultArrangement;
        entry(ui, "Default arrangement", default.into(), None, commands);
        ui.separator();
        ui.menu_button("Theme", |ui| show_themes(ui, commands));
        ui.menu_button("Colours of numbers", |ui| {
            for map in ColourMap::ALL {
                let command = ShowCommand::ColourMap(map);
                choice(ui, map.label(), map == appearance.map, command, commands);
            }
        });
        ui.menu_button("Size of everything", |ui| {
            for percent in ZOOMS {
                let zoom = f32::from(percent) / 100.0;
                let is_chosen = (zoom - appearance.zoom).abs() < 0.01;
                let label = quantity::with_unit(f64::from(percent), 0, "%");
                choice(ui, &label, is_chosen, ShowCommand::Zoom(zoom), commands);
            }
        });
        ui.menu_button("Contactors", |ui| {
            show_dot_styles(ui, appearance.dots, commands);
        });
        let command = ShowCommand::ToggleThreshold;
        let label = "Grey below threshold (a model)";
        choice(ui, label, appearance.greys_below, command, commands);
        ui.menu_button("Over the cloth", |ui| {
            for (overlay, label) in Overlays::ALL {
                let command = ShowCommand::Overlay(overlay);
                let is_shown = appearance.overlays.shows(overlay);
                choice(ui, label, is_shown, command, commands);
            }
        });
        ui.separator();
        let calibrate = ShowCommand::Calibrate;
        entry(
            ui,
            "Calibrate to true size…",
            calibrate.into(),
            None,
            commands,
        );
        entry(ui, "Keys", ShowCommand::Help.into(), None, commands);
    });
}

fn show_themes(ui: &mut Ui, commands: &mut Commands) {
    let theme = ui.ctx().options(|options| options.theme_preference);
    let themes = [
        (ThemePreference::System, "As the system"),
        (ThemePreference::Dark, "Dark"),
        (ThemePreference::Light, "Light"),
    ];
    for (preference, label) in themes {
        let command = ShowCommand::Theme(preference);
        choice(ui, label, theme == preference, command, commands);
    }
}

fn show_dot_styles(ui: &mut Ui, chosen: DotStyle, commands: &mut Commands) {
    let styles = [
        (DotStyle::SizeAndGlow, "40 Hz by size, 320 Hz by glow"),
        (DotStyle::Size, "Both by size"),
        (DotStyle::Brightness, "Both by brightness"),
    ];
    for (style, label) in styles {
        let command = ShowCommand::DotStyle(style);
        choice(ui, label, style == chosen, command, commands);
    }
}

/// A line that does something, with its key; grey, with the reason, when it does nothing.
fn entry(
    ui: &mut Ui,
    label: &str,
    command: Command,
    refusal: Option<&str>,
    commands: &mut Commands,
) {
    let key = hint(ui.ctx(), &command);
    let button = Button::new(label).shortcut_text(key);
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
fn choice(
    ui: &mut Ui,
    label: &str,
    is_chosen: bool,
    command: ShowCommand,
    commands: &mut Commands,
) {
    let command = command.into();
    if tick_box(ui, label, is_chosen, hint(ui.ctx(), &command)) {
        commands.push(command);
    }
}
