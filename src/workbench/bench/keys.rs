//! The keyboard: which acts were asked for by their keys, and how keys are written.

use std::sync::LazyLock;

use eframe::egui::{self, Id, Key, KeyboardShortcut, Modifiers};

use crate::bench::acts::{self, Act};
use crate::bench::command::Command;
use crate::bench::pane::Pane;

/// Every key with its act; of two that share a key the one with more modifiers comes first, since
/// the other would take it.
fn table() -> &'static [(KeyboardShortcut, &'static Act)] {
    static TABLE: LazyLock<Vec<(KeyboardShortcut, &'static Act)>> = LazyLock::new(|| {
        let keys = |act: &'static Act| act.keys.iter().map(move |key| (*key, act));
        let mut table: Vec<_> = acts::all().iter().flat_map(keys).collect();
        table.sort_by_key(|(key, _)| std::cmp::Reverse(n_modifiers(key.modifiers)));
        table
    });
    &TABLE
}

fn n_modifiers(modifiers: Modifiers) -> usize {
    let held = [modifiers.shift, modifiers.command, modifiers.alt];
    held.into_iter().filter(|is_held| *is_held).count()
}

/// The commands whose keys were pressed since the last frame; the keys are used up.
///
/// Esc works whatever has the focus and with any modifier held; most others wait while text is
/// being typed, and Space while a widget has the focus, since there it presses that widget. A pane
/// that has the focus is none.
pub(crate) fn pressed(ctx: &egui::Context) -> Vec<Command> {
    let is_typing = ctx.text_edit_focused();
    let focused = ctx.memory(egui::Memory::focused);
    let is_panes = |id| Pane::ALL.into_iter().any(|pane| pane_focus(pane) == id);
    let has_focus = focused.is_some_and(|id| !is_panes(id));
    // Alt with a letter holds a slot of tunings; the toolkit would take it for the letter alone.
    let is_alt = ctx.input(|input| input.modifiers.alt);
    let mut commands: Vec<Command> = escape(ctx).into_iter().collect();
    for (key, act) in table() {
        let is_for_widget = has_focus && key.logical_key == Key::Space;
        let waits = (is_typing && !act.while_typing) || is_for_widget;
        if waits || key.logical_key == Key::Escape || is_alt != key.modifiers.alt {
            continue;
        }
        if ctx.input_mut(|input| input.consume_shortcut(key)) {
            commands.push(act.command.clone());
        }
    }
    commands
}

/// Esc, if it was pressed. It is not used up: a field that is being typed in also ends on it.
pub(crate) fn escape(ctx: &egui::Context) -> Option<Command> {
    let is_pressed = ctx.input(|input| input.key_pressed(Key::Escape));
    is_pressed.then_some(Command::Escape)
}

/// How the first key of a command is written, for tips; empty when it has none.
pub(crate) fn hint(ctx: &egui::Context, command: &Command) -> String {
    let key = acts::of(command).and_then(|act| act.keys.first());
    key.map(|key| written(ctx, *key)).unwrap_or_default()
}

/// The keys of an act as they are written; empty if it has none.
pub(crate) fn all_written(ctx: &egui::Context, act: &Act) -> String {
    let keys = act.keys.iter().map(|key| written(ctx, *key));
    keys.collect::<Vec<_>>().join(" or ")
}

/// What has the focus while a pane has it, rather than something in it.
pub(crate) fn pane_focus(pane: Pane) -> Id {
    Id::unique(("focus", pane.title()))
}

/// How a key is written, everywhere.
fn written(ctx: &egui::Context, key: KeyboardShortcut) -> String {
    let is_mac = ctx.os().is_mac();
    let modifiers = key.modifiers;
    let mut words = String::new();
    for (is_held, word) in [
        (modifiers.command, if is_mac { "Cmd+" } else { "Ctrl+" }),
        (modifiers.alt, "Alt+"),
        (modifiers.shift, "Shift+"),
    ] {
        if is_held {
            words.push_str(word);
        }
    }
    words
        + match key.logical_key {
            Key::Escape => "Esc",
            Key::Period => ".",
            Key::Plus => "+",
            Key::Minus => "−",
            Key::PageUp => "Page up",
            other => other.name(),
        }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_does_two_things() {
        for (i, (key, act)) in table().iter().enumerate() {
            for (other, by) in &table()[i + 1..] {
                assert_ne!(key, other, "{} and {}", act.what, by.what);
            }
        }
    }

    #[test]
    fn the_longer_of_two_keys_comes_first() {
        // Consuming Ctrl+Z would otherwise swallow Ctrl+Shift+Z.
        for (i, (key, act)) in table().iter().enumerate() {
            for (later, by) in &table()[i + 1..] {
                let same_key = key.logical_key == later.logical_key
                    && key.modifiers.command == later.modifiers.command;
                let hides = same_key && !key.modifiers.shift && later.modifiers.shift;
                assert!(!hides, "{} hides {}", act.what, by.what);
            }
        }
    }

    #[test]
    fn keys_are_written_as_they_stand_on_the_keyboard() {
        let ctx = egui::Context::default();
        let shift = Modifiers::COMMAND.plus(Modifiers::SHIFT);
        let keys = [
            (Modifiers::NONE, Key::Escape, "Esc"),
            (Modifiers::NONE, Key::Period, "."),
            (Modifiers::NONE, Key::Num0, "0"),
            (Modifiers::SHIFT, Key::F6, "Shift+F6"),
        ];
        for (modifiers, key, expected) in keys {
            assert_eq!(
                written(&ctx, KeyboardShortcut::new(modifiers, key)),
                expected
            );
        }
        let redo = written(&ctx, KeyboardShortcut::new(shift, Key::Z));
        assert!(redo.ends_with("+Shift+Z"), "{redo}");
    }
}
