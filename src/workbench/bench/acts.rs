//! Everything that a user can do by name, declared once: menus, the list of keys, tips, the palette
//! and the keyboard all read it here.

use std::sync::LazyLock;

use eframe::egui::{Key, KeyboardShortcut, Modifiers, ThemePreference};

use crate::bench::clips::CLIPS;
use crate::bench::command::{
    Chosen, Command, DeviceCommand, DotStyle, FileCommand, Look, PlayCommand, PlaySource, Purpose,
    ShowCommand, Tool,
};
use crate::bench::overlays::{Overlay, Overlays};
use crate::bench::pane::Pane;
use crate::bench::perspective::Perspective;
use crate::bench::query;
use crate::bench::settings::preferences::Loudness;
use crate::kit::theme::colour_map::ColourMap;
use selvedge_textile::tactile::Band;

/// How much closer a key looks.
const ZOOM: f64 = 1.25;
/// How far a key turns the display, degrees.
const TURN_DEG: f64 = 5.0;
/// Sizes of everything that are offered, %.
const SIZES: [u8; 5] = [100, 125, 150, 175, 200];

const NONE: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// How the names of acts begin of which one is chosen, or that belong together.
pub(crate) const THEME: &str = "Theme: ";
pub(crate) const COLOURS: &str = "Colours of numbers: ";
pub(crate) const SIZE: &str = "Size of everything: ";
pub(crate) const CONTACTORS: &str = "Contactors: ";
pub(crate) const SOUND: &str = "Sound: ";
pub(crate) const CLIP: &str = "Export the recording: ";

/// What an act concerns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Concern {
    Anywhere,
    Scene,
    Files,
    Play,
    Device,
    Workspace,
    Panes,
    View,
    Help,
}

impl Concern {
    /// What people call it.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Anywhere => "From anywhere",
            Self::Scene => "Scene",
            Self::Files => "Files",
            Self::Play => "Play and record",
            Self::Device => "Device",
            Self::Workspace => "Workspace",
            Self::Panes => "Panes",
            Self::View => "View",
            Self::Help => "Help",
        }
    }
}

/// Something that a user can do.
#[derive(Debug, Clone)]
pub(crate) struct Act {
    /// What it does, for people.
    pub(crate) what: String,
    /// What it concerns.
    pub(crate) concern: Concern,
    /// What it sends.
    pub(crate) command: Command,
    /// The keys that do it, if any do.
    pub(crate) keys: Vec<KeyboardShortcut>,
    /// Whether they also work while text is being typed.
    pub(crate) while_typing: bool,
}

impl Act {
    fn on(mut self, modifiers: Modifiers, key: Key) -> Self {
        self.keys.push(KeyboardShortcut::new(modifiers, key));
        self
    }

    fn also_while_typing(self) -> Self {
        Self {
            while_typing: true,
            ..self
        }
    }
}

fn act(concern: Concern, what: impl Into<String>, command: impl Into<Command>) -> Act {
    Act {
        what: what.into(),
        concern,
        command: command.into(),
        keys: Vec::new(),
        while_typing: false,
    }
}

/// Every act. Esc stands first: nothing may come before it.
pub(crate) fn all() -> &'static [Act] {
    static ALL: LazyLock<Vec<Act>> = LazyLock::new(|| {
        let mut acts = scene_acts();
        acts.extend(file_acts());
        acts.extend(play_acts());
        acts.extend(device_acts());
        acts.extend(workspace_acts());
        acts.extend(pane_acts());
        acts.extend(view_acts());
        acts.extend(help_acts());
        acts
    });
    &ALL
}

/// The acts whose names begin so, with the rest of their names.
pub(crate) fn group(prefix: &str) -> impl Iterator<Item = (String, &'static Act)> {
    let rest = move |act: &'static Act| {
        let rest = act.what.strip_prefix(prefix)?;
        Some((query::capitalised(rest), act))
    };
    all().iter().filter_map(rest)
}

/// What the act is called that sends this command; empty if none does.
pub(crate) fn label(command: &Command) -> &'static str {
    of(command).map_or("", |act| act.what.as_str())
}

/// The act that sends this command.
pub(crate) fn of(command: &Command) -> Option<&'static Act> {
    all().iter().find(|act| act.command == *command)
}

fn scene_acts() -> Vec<Act> {
    let scene = |what, command: Command| act(Concern::Scene, what, command);
    let chosen = |what, key, chosen| scene(what, Command::Chosen(chosen)).on(NONE, key);
    let escape = "Everything off while armed; else close, or pause";
    vec![
        act(Concern::Anywhere, escape, Command::Escape)
            .on(NONE, Key::Escape)
            .also_while_typing(),
        act(Concern::Anywhere, "Everything off", Command::AllOff),
        act(
            Concern::Anywhere,
            "Find an act, a textile or a recording",
            ShowCommand::Palette,
        )
        .on(CTRL, Key::K)
        .on(CTRL, Key::P)
        .also_while_typing(),
        scene("Redo", Command::Redo)
            .on(CTRL_SHIFT, Key::Z)
            .on(CTRL, Key::Y),
        scene("Undo", Command::Undo).on(CTRL, Key::Z),
        chosen("Remove the chosen textile", Key::Delete, Chosen::Remove),
        chosen("Mute the chosen textile", Key::M, Chosen::Mute),
        chosen("Feel the chosen textile alone", Key::S, Chosen::Solo),
        chosen("Lay the chosen textile on top", Key::PageUp, Chosen::Raise),
        scene("Feel everything again", ShowCommand::HearAll.into()).on(NONE, Key::H),
    ]
}

fn file_acts() -> Vec<Act> {
    let file = |what, command: FileCommand| act(Concern::Files, what, command);
    let ask = FileCommand::Ask;
    let mut acts = vec![
        file("New scene", FileCommand::New).on(CTRL, Key::N),
        file("Open a scene…", ask(Purpose::OpenScene)).on(CTRL, Key::O),
        file("Open the shipped scene", FileCommand::OpenShipped),
        file("Save the scene as…", ask(Purpose::SaveScene)).on(CTRL_SHIFT, Key::S),
        file("Save the scene", FileCommand::Save).on(CTRL, Key::S),
        file("Import measurements…", ask(Purpose::ImportFiles)),
        file(
            "Cloth from a picture…",
            ask(Purpose::OpenPicture(Pane::Picture)),
        ),
        #[cfg(feature = "friction")]
        file(
            "Friction from a picture…",
            ask(Purpose::OpenPicture(Pane::Friction)),
        ),
        file("Open a drape scene…", ask(Purpose::OpenDrape)),
        file("Add a library…", ask(Purpose::AddLibrary)),
        file("Analyse sessions…", ask(Purpose::OpenLogs)),
        file("Open a path to replay…", ask(Purpose::OpenRecording)).on(CTRL, Key::R),
        file(
            "Export the path of the recording…",
            ask(Purpose::SaveRecording),
        )
        .on(CTRL, Key::E),
        file("Close the window", FileCommand::Close).on(CTRL, Key::W),
    ];
    acts.extend(CLIPS.map(|(kind, what)| {
        let what = format!("{CLIP}{what}");
        act(Concern::Files, what, ask(Purpose::Clip(kind)))
    }));
    acts
}

fn play_acts() -> Vec<Act> {
    let play = |what, key, command: PlayCommand| act(Concern::Play, what, command).on(NONE, key);
    let from = PlayCommand::Source;
    vec![
        play("Play or hold", Key::Space, PlayCommand::Toggle),
        play("Play one tick", Key::Period, PlayCommand::Step),
        play("Back to the first tick", Key::Home, PlayCommand::Rewind),
        play("Loop or not", Key::L, PlayCommand::ToggleLoop),
        play(
            "Record, or end recording",
            Key::R,
            PlayCommand::ToggleRecording,
        ),
        act(
            Concern::Play,
            "Mark this place of the recording",
            PlayCommand::Mark,
        )
        .on(SHIFT, Key::M),
        play("Follow the pointer", Key::P, from(PlaySource::Pointer)),
        act(
            Concern::Play,
            "Replay the recording at hand",
            from(PlaySource::Recording),
        ),
        play("Turn the display left", Key::Q, PlayCommand::Turn(TURN_DEG)),
        play(
            "Turn the display right",
            Key::E,
            PlayCommand::Turn(-TURN_DEG),
        ),
        play(
            "Turn the display straight",
            Key::Num0,
            PlayCommand::TurnBack,
        ),
    ]
}

fn device_acts() -> Vec<Act> {
    let device = |what, command: DeviceCommand| act(Concern::Device, what, command);
    vec![
        device("Arm the device", DeviceCommand::Arm),
        device("Disarm the device", DeviceCommand::Disarm),
        device("Go on after all off", DeviceCommand::GoOn),
        device("Connect to the emulator", DeviceCommand::ConnectEmulator),
        device("Let go of the device", DeviceCommand::Disconnect),
        device("Clear the device’s faults", DeviceCommand::ClearFaults),
        device(
            "Open the folder of the session log",
            DeviceCommand::OpenLogFolder,
        ),
    ]
}

fn workspace_acts() -> Vec<Act> {
    let show = |what, command: ShowCommand| act(Concern::Workspace, what, command);
    let closer = |factor| ShowCommand::Look(Look::ZoomBy(factor));
    let mut acts = vec![
        show("Feel with the pointer", ShowCommand::Tool(Tool::Feel)).on(NONE, Key::X),
        show("Arrange textiles", ShowCommand::Tool(Tool::Arrange)).on(NONE, Key::A),
        show("Show the whole workspace", ShowCommand::Look(Look::Fit)).on(NONE, Key::F),
        show("Show the true size", ShowCommand::Look(Look::TrueSize)).on(NONE, Key::T),
        show("Closer", closer(ZOOM)).on(NONE, Key::Plus),
        show("Farther", closer(1.0 / ZOOM)).on(NONE, Key::Minus),
        show("Calibrate to true size…", ShowCommand::Calibrate),
        show("Look at the next display", ShowCommand::NextDisplay).on(NONE, Key::D),
    ];
    acts.extend(Overlays::ALL.map(|(overlay, what)| {
        let over = show(what, ShowCommand::Overlay(overlay));
        match overlay {
            Overlay::Points => over.on(NONE, Key::G),
            Overlay::ChosenPoints => over.on(NONE, Key::C),
            Overlay::Motion => over.on(NONE, Key::V),
            Overlay::Map(Band::High) => over.on(SHIFT, Key::K),
            Overlay::Map(Band::Low) => over.on(NONE, Key::K),
        }
    }));
    acts
}

fn pane_acts() -> Vec<Act> {
    let show = |what, command: ShowCommand| act(Concern::Panes, what, command);
    let keys = [Key::Num1, Key::Num2, Key::Num3];
    let mut acts: Vec<Act> = keys
        .into_iter()
        .zip(Perspective::ALL)
        .map(|(key, perspective)| {
            let command = ShowCommand::Perspective(perspective);
            show(perspective.what(), command).on(CTRL, key)
        })
        .collect();
    acts.extend([
        show("Pane before", ShowCommand::WalkPanes(-1))
            .on(SHIFT, Key::F6)
            .also_while_typing(),
        show("Next pane", ShowCommand::WalkPanes(1))
            .on(NONE, Key::F6)
            .also_while_typing(),
        show(
            "The pane in use alone, or all again",
            ShowCommand::Maximise(None),
        )
        .on(SHIFT, Key::F11)
        .also_while_typing(),
        show("Default arrangement", ShowCommand::DefaultArrangement).on(NONE, Key::F9),
        show(
            "The scene keeps this arrangement, or no longer",
            ShowCommand::ToggleSceneArrangement,
        ),
    ]);
    acts
}

fn view_acts() -> Vec<Act> {
    let show = |what: String, command: ShowCommand| act(Concern::View, what, command);
    let mut acts = vec![
        show(
            "Full screen, or a window".to_owned(),
            ShowCommand::FullScreen,
        )
        .on(NONE, Key::F11)
        .also_while_typing(),
        show(
            "Numbers in the heatmaps".to_owned(),
            ShowCommand::ToggleNumbers,
        )
        .on(NONE, Key::N),
        show(
            "Grey below threshold (a model)".to_owned(),
            ShowCommand::ToggleThreshold,
        ),
    ];
    let themes = [
        (ThemePreference::System, "as the system"),
        (ThemePreference::Dark, "dark"),
        (ThemePreference::Light, "light"),
    ];
    acts.extend(
        themes.map(|(theme, name)| show(format!("{THEME}{name}"), ShowCommand::Theme(theme))),
    );
    acts.extend(ColourMap::ALL.map(|map| {
        let what = format!("{COLOURS}{}", map.label());
        show(what, ShowCommand::ColourMap(map))
    }));
    acts.extend(SIZES.map(|percent| {
        let what = format!("{SIZE}{percent} %");
        show(what, ShowCommand::Zoom(f32::from(percent) / 100.0))
    }));
    let styles = [
        (DotStyle::SizeAndGlow, "40 Hz by size, 320 Hz by glow"),
        (DotStyle::Size, "both by size"),
        (DotStyle::Brightness, "both by brightness"),
    ];
    acts.extend(
        styles
            .map(|(style, name)| show(format!("{CONTACTORS}{name}"), ShowCommand::DotStyle(style))),
    );
    let sound = |name: &str, command| show(format!("{SOUND}{name}"), command);
    acts.extend([
        sound("what is felt, on or off", ShowCommand::ToggleSound).on(CTRL, Key::M),
        sound("quiet", ShowCommand::Loudness(Loudness::Quiet)),
        sound("middle", ShowCommand::Loudness(Loudness::Middle)),
        sound("loud", ShowCommand::Loudness(Loudness::Loud)),
        sound(
            "as driven (40 Hz itself, no overtones)",
            ShowCommand::ToggleAsDriven,
        ),
    ]);
    acts
}

fn help_acts() -> Vec<Act> {
    vec![
        act(Concern::Help, "Guide", ShowCommand::Guide(None)),
        act(Concern::Help, "Keys", ShowCommand::Help)
            .on(NONE, Key::F1)
            .also_while_typing(),
        act(
            Concern::Help,
            "What the pane in use shows",
            ShowCommand::About,
        )
        .on(SHIFT, Key::F1)
        .also_while_typing(),
        act(Concern::Help, "Take the tour", ShowCommand::Tour),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_act_says_what_it_does_and_no_two_do_the_same() {
        for (i, one) in all().iter().enumerate() {
            assert!(!one.what.is_empty(), "{:?}", one.command);
            for other in &all()[i + 1..] {
                assert_ne!(one.what, other.what, "{:?}", other.command);
                assert_ne!(one.command, other.command, "{}", one.what);
            }
        }
    }

    #[test]
    fn escape_comes_first_whatever_is_typed() {
        let first = &all()[0];
        assert!(first.while_typing && first.keys[0].logical_key == Key::Escape);
        assert_eq!(first.command, Command::Escape);
    }
}
