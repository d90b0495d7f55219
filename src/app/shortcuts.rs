//! The keys: one table, from which input is read, tips are written and doubles are found.

use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};

use super::command::{Command, FileCommand, PlayCommand, Purpose};

/// A key and what it does.
#[derive(Debug, Clone)]
pub(crate) struct Shortcut {
    /// The key with its modifiers.
    pub(crate) key: KeyboardShortcut,
    /// What it does.
    pub(crate) command: Command,
    /// Whether it also works while text is being typed.
    pub(crate) while_typing: bool,
}

/// Every key of the window. Esc stands first: nothing may come before it.
pub(crate) fn table() -> Vec<Shortcut> {
    let key = |modifiers, key, command| Shortcut {
        key: KeyboardShortcut::new(modifiers, key),
        command,
        while_typing: false,
    };
    let ctrl = Modifiers::COMMAND;
    let ctrl_shift = Modifiers::COMMAND.plus(Modifiers::SHIFT);
    let all_off = key(Modifiers::NONE, Key::Escape, Command::AllOff);
    vec![
        Shortcut {
            while_typing: true,
            ..all_off
        },
        key(ctrl_shift, Key::Z, Command::Redo),
        key(ctrl, Key::Z, Command::Undo),
        key(ctrl, Key::Y, Command::Redo),
        key(
            ctrl_shift,
            Key::S,
            FileCommand::Ask(Purpose::SaveScene).into(),
        ),
        key(ctrl, Key::S, FileCommand::Save.into()),
        key(ctrl, Key::O, FileCommand::Ask(Purpose::OpenScene).into()),
        key(Modifiers::NONE, Key::Space, PlayCommand::Toggle.into()),
    ]
}

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
    fn escape_is_all_off_whatever_is_typed() {
        let first = &table()[0];
        assert!(is_escape(first.key) && first.while_typing, "{first:?}");
        assert_eq!(first.command, Command::AllOff);
    }
}
