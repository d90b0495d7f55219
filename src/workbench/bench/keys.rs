//! The keys: one table, from which input is read, tips are written and doubles are found.

use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};

use crate::bench::command::{
    Chosen, Command, FileCommand, Look, PlayCommand, PlaySource, Purpose, ShowCommand, Tool,
};
use crate::bench::overlays::Overlay;
use crate::bench::perspective::Perspective;
use selvedge_textile::tactile::Band;

/// A key and what it does.
#[derive(Debug, Clone)]
pub(crate) struct Shortcut {
    /// The key with its modifiers.
    pub key: KeyboardShortcut,
    /// What it does.
    pub command: Command,
    /// The same for people; keys that do the same say the same.
    pub what: &'static str,
    /// Whether it also works while text is being typed.
    pub(crate) while_typing: bool,
}

/// Every key of the window. Esc stands first: nothing may come before it.
pub(crate) fn table() -> Vec<Shortcut> {
    let mut table = scene_keys();
    table.extend(file_keys());
    table.extend(play_keys());
    table.extend(show_keys());
    table.extend(overlay_keys());
    table.extend(perspective_keys());
    table.extend(chosen_keys());
    table
}

fn key(modifiers: Modifiers, key: Key, what: &'static str, command: Command) -> Shortcut {
    Shortcut {
        key: KeyboardShortcut::new(modifiers, key),
        command,
        what,
        while_typing: false,
    }
}

fn bare<C: Into<Command>>((at, what, command): (Key, &'static str, C)) -> Shortcut {
    key(Modifiers::NONE, at, what, command.into())
}

/// What Esc does.
const ESCAPE: &str = "Everything off while armed; else close, or pause";

const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

fn scene_keys() -> Vec<Shortcut> {
    let escape = bare((Key::Escape, ESCAPE, Command::Escape));
    vec![
        Shortcut {
            while_typing: true,
            ..escape
        },
        key(CTRL_SHIFT, Key::Z, "Redo", Command::Redo),
        key(CTRL, Key::Z, "Undo", Command::Undo),
        key(CTRL, Key::Y, "Redo", Command::Redo),
    ]
}

fn chosen_keys() -> Vec<Shortcut> {
    let chosen = |at, what, act| bare((at, what, Command::Chosen(act)));
    vec![
        chosen(Key::Delete, "Remove the chosen textile", Chosen::Remove),
        chosen(Key::M, "Mute the chosen textile", Chosen::Mute),
        chosen(Key::S, "Feel the chosen textile alone", Chosen::Solo),
        chosen(Key::PageUp, "Lay the chosen textile on top", Chosen::Raise),
    ]
}

fn file_keys() -> Vec<Shortcut> {
    let file = |modifiers, at, what, command: FileCommand| key(modifiers, at, what, command.into());
    let ask = FileCommand::Ask;
    vec![
        file(CTRL, Key::N, "New scene", FileCommand::New),
        file(CTRL, Key::O, "Open a scene…", ask(Purpose::OpenScene)),
        file(
            CTRL_SHIFT,
            Key::S,
            "Save the scene as…",
            ask(Purpose::SaveScene),
        ),
        file(CTRL, Key::S, "Save the scene", FileCommand::Save),
        file(
            CTRL,
            Key::R,
            "Open a path to replay…",
            ask(Purpose::OpenRecording),
        ),
        file(
            CTRL,
            Key::E,
            "Export the path of the recording…",
            ask(Purpose::SaveRecording),
        ),
        file(CTRL, Key::W, "Close the window", FileCommand::Close),
    ]
}

fn play_keys() -> Vec<Shortcut> {
    let pointer = PlayCommand::Source(PlaySource::Pointer);
    let keys: [(Key, &str, PlayCommand); 9] = [
        (Key::Space, "Play or hold", PlayCommand::Toggle),
        (Key::Period, "Play one tick", PlayCommand::Step),
        (Key::Home, "Back to the first tick", PlayCommand::Rewind),
        (Key::L, "Loop or not", PlayCommand::ToggleLoop),
        (
            Key::R,
            "Record, or end recording",
            PlayCommand::ToggleRecording,
        ),
        (Key::P, "Follow the pointer", pointer),
        (Key::Q, "Turn the display left", PlayCommand::Turn(TURN_DEG)),
        (
            Key::E,
            "Turn the display right",
            PlayCommand::Turn(-TURN_DEG),
        ),
        (
            Key::Num0,
            "Turn the display straight",
            PlayCommand::TurnBack,
        ),
    ];
    let mark = key(
        Modifiers::SHIFT,
        Key::M,
        "Mark this place of the recording",
        PlayCommand::Mark.into(),
    );
    keys.into_iter().map(bare).chain([mark]).collect()
}

fn show_keys() -> Vec<Shortcut> {
    let closer = |factor| ShowCommand::Look(Look::ZoomBy(factor));
    let keys: [(Key, &str, ShowCommand); 10] = [
        (
            Key::X,
            "Feel with the pointer",
            ShowCommand::Tool(Tool::Feel),
        ),
        (Key::A, "Arrange textiles", ShowCommand::Tool(Tool::Arrange)),
        (
            Key::F,
            "Show the whole workspace",
            ShowCommand::Look(Look::Fit),
        ),
        (
            Key::T,
            "Show the true size",
            ShowCommand::Look(Look::TrueSize),
        ),
        (Key::Plus, "Closer", closer(ZOOM)),
        (Key::Minus, "Farther", closer(1.0 / ZOOM)),
        (
            Key::N,
            "Numbers in the heatmaps",
            ShowCommand::ToggleNumbers,
        ),
        (Key::H, "Feel everything again", ShowCommand::HearAll),
        (Key::F1, "Keys", ShowCommand::Help),
        (
            Key::F9,
            "Default arrangement",
            ShowCommand::DefaultArrangement,
        ),
    ];
    keys.into_iter().map(bare).collect()
}

fn perspective_keys() -> Vec<Shortcut> {
    let keys = [Key::Num1, Key::Num2, Key::Num3];
    let pairs = keys.into_iter().zip(Perspective::ALL);
    let arrange = |(at, perspective): (Key, Perspective)| {
        let command = ShowCommand::Perspective(perspective);
        key(CTRL, at, perspective.what(), command.into())
    };
    pairs.map(arrange).collect()
}

fn overlay_keys() -> Vec<Shortcut> {
    let over = |modifiers, at, what, overlay| {
        key(modifiers, at, what, ShowCommand::Overlay(overlay).into())
    };
    let (bare, shift) = (Modifiers::NONE, Modifiers::SHIFT);
    let (low, high) = (Overlay::Map(Band::Low), Overlay::Map(Band::High));
    vec![
        over(bare, Key::G, "Points of the textiles", Overlay::Points),
        over(
            bare,
            Key::C,
            "Points that contactors read",
            Overlay::ChosenPoints,
        ),
        over(
            bare,
            Key::V,
            "Velocities of the contactors",
            Overlay::Motion,
        ),
        over(shift, Key::K, "Map of 320 Hz", high),
        over(bare, Key::K, "Map of 40 Hz", low),
    ]
}

/// How much closer a key looks.
const ZOOM: f64 = 1.25;
/// How far a key turns the display, degrees.
const TURN_DEG: f64 = 5.0;

/// The commands whose keys were pressed since the last frame; the keys are used up.
///
/// Esc works whatever has the focus and with any modifier held; the others wait while text is
/// being typed, and Space while a widget has the focus, since there it presses that widget.
pub(crate) fn pressed(ctx: &egui::Context) -> Vec<Command> {
    let is_typing = ctx.text_edit_focused();
    let has_focus = ctx.memory(|memory| memory.focused().is_some());
    let mut commands = Vec::new();
    for Shortcut {
        key,
        command,
        while_typing,
        ..
    } in table()
    {
        if is_escape(key) {
            // Not used up: a field that is being typed in also ends on Esc.
            if ctx.input(|input| input.key_pressed(Key::Escape)) {
                commands.push(command);
            }
            continue;
        }
        let is_for_widget = has_focus && key.logical_key == Key::Space;
        if (is_typing && !while_typing) || is_for_widget {
            continue;
        }
        if ctx.input_mut(|input| input.consume_shortcut(&key)) {
            commands.push(command);
        }
    }
    commands
}

/// How the key of a command is written, for tips; empty when it has none.
pub(crate) fn hint(ctx: &egui::Context, command: &Command) -> String {
    let found = table()
        .into_iter()
        .find(|shortcut| shortcut.command == *command);
    found
        .map(|shortcut| ctx.format_shortcut(&shortcut.key))
        .unwrap_or_default()
}

fn is_escape(key: KeyboardShortcut) -> bool {
    key.logical_key == Key::Escape
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_does_two_things() {
        let table = table();
        for (i, one) in table.iter().enumerate() {
            for other in &table[i + 1..] {
                assert_ne!(
                    one.key, other.key,
                    "{:?} and {:?}",
                    one.command, other.command
                );
            }
        }
    }

    #[test]
    fn the_longer_of_two_keys_comes_first() {
        // Consuming Ctrl+Z would otherwise swallow Ctrl+Shift+Z.
        let table = table();
        for (i, one) in table.iter().enumerate() {
            for later in &table[i + 1..] {
                let same_key = one.key.logical_key == later.key.logical_key;
                let hides = same_key && !one.key.modifiers.shift && later.key.modifiers.shift;
                assert!(!hides, "{:?} hides {:?}", one.command, later.command);
            }
        }
    }

    #[test]
    fn keys_say_what_they_do_and_the_same_when_they_do_the_same() {
        let table = table();
        for one in &table {
            assert!(!one.what.is_empty(), "{:?}", one.command);
            for other in &table {
                let does_same = one.command == other.command;
                assert_eq!(does_same, one.what == other.what, "{one:?} and {other:?}");
            }
        }
    }

    #[test]
    fn escape_comes_first_whatever_is_typed() {
        let first = &table()[0];
        assert!(is_escape(first.key) && first.while_typing, "{first:?}");
        assert_eq!(first.command, Command::Escape);
    }
}
