//! The keyboard: which acts were asked for by their keys, and how keys are written.

use std::sync::{Arc, LazyLock};

use eframe::egui::{self, Id, Key, KeyboardShortcut, Modifiers};

use crate::bench::acts::{self, Act};
use crate::bench::chosen_keys::{ChosenKeys, Keys, OR, modifiers_before};
use crate::bench::command::Command;
use crate::bench::pane::Pane;

/// Keys that walk and press what is on the screen, unless a modifier is held.
const OF_WIDGETS: [Key; 7] = [
    Key::Tab,
    Key::Enter,
    Key::ArrowLeft,
    Key::ArrowRight,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::Backspace,
];
/// Keys that hold a slot of tunings with Alt, in the order of the letters.
pub(crate) const OF_SLOTS: [Key; 8] = [
    Key::A,
    Key::B,
    Key::C,
    Key::D,
    Key::E,
    Key::F,
    Key::G,
    Key::H,
];

/// The keys of every act, as they are in force.
#[derive(Debug)]
struct KeyMap {
    /// Those of each act, in the order of [`acts::all`].
    of_acts: Vec<Vec<KeyboardShortcut>>,
    /// Every key with its act; of two that share a key the one with more modifiers comes first,
    /// since the other would take it.
    table: Vec<(KeyboardShortcut, &'static Act)>,
}

impl KeyMap {
    fn with(chosen: &ChosenKeys) -> Self {
        let keys_of = |act: &Act| match chosen.get(&act.what) {
            Some(Keys(keys)) if act.command != Command::Escape => keys.clone(),
            _ => act.keys.clone(),
        };
        let of_acts: Vec<Vec<KeyboardShortcut>> = acts::all().iter().map(keys_of).collect();
        let mut table: Vec<_> = (acts::all().iter().zip(&of_acts))
            .flat_map(|(act, keys)| keys.iter().map(move |key| (*key, act)))
            .collect();
        table.sort_by_key(|(key, _)| std::cmp::Reverse(n_modifiers(key.modifiers)));
        Self { of_acts, table }
    }
}

fn map_place() -> Id {
    Id::unique("keys of acts")
}

/// Puts the keys in force that the user chose.
pub(crate) fn install(ctx: &egui::Context, chosen: &ChosenKeys) {
    let map = Arc::new(KeyMap::with(chosen));
    ctx.data_mut(|data| data.insert_temp(map_place(), map));
}

fn map(ctx: &egui::Context) -> Arc<KeyMap> {
    static AT_FIRST: LazyLock<Arc<KeyMap>> =
        LazyLock::new(|| Arc::new(KeyMap::with(&ChosenKeys::new())));
    let installed = ctx.data(|data| data.get_temp(map_place()));
    installed.unwrap_or_else(|| Arc::clone(&AT_FIRST))
}

/// The keys of an act that are in force.
pub(crate) fn of(ctx: &egui::Context, act: &Act) -> Vec<KeyboardShortcut> {
    let place = acts::all().iter().position(|one| std::ptr::eq(one, act));
    place.map_or_else(Vec::new, |place| map(ctx).of_acts[place].clone())
}

/// Why an act cannot have a key, in a sentence.
pub(crate) fn refusal(ctx: &egui::Context, act: &Act, key: KeyboardShortcut) -> Option<String> {
    let name = written(ctx, key);
    let KeyboardShortcut {
        modifiers,
        logical_key,
    } = key;
    let is_bare = !modifiers.command && !modifiers.alt;
    if logical_key == Key::Escape {
        return Some("Esc switches everything off, and does nothing else".to_owned());
    }
    if modifiers.alt && OF_SLOTS.contains(&logical_key) {
        return Some(format!("{name} holds a slot of tunings: choose another"));
    }
    if is_bare && OF_WIDGETS.contains(&logical_key) {
        let words = "walks and presses what is on the screen: add Ctrl or Alt";
        return Some(format!("{name} {words}"));
    }
    // F1 to F35 type nothing.
    let types = logical_key.name().len() == 1 || !logical_key.name().starts_with('F');
    if act.while_typing && is_bare && types {
        return Some(format!(
            "{name} is needed while typing: add Ctrl or Alt, or choose F1 to F12"
        ));
    }
    let map = map(ctx);
    let (_, other) = map.table.iter().find(|(taken, _)| *taken == key)?;
    (!std::ptr::eq(*other, act)).then(|| {
        let what = &other.what;
        format!("{name} is the key of “{what}”: give that one another first")
    })
}

fn n_modifiers(modifiers: Modifiers) -> usize {
    let held = [modifiers.shift, modifiers.command, modifiers.alt];
    held.into_iter().filter(|is_held| *is_held).count()
}

/// Whether a key only changes what others do.
fn is_modifier(key: Key) -> bool {
    let kinds = ["Alt", "Control", "Shift", "Super", "Meta", "Fn"];
    kinds.into_iter().any(|kind| key.name().starts_with(kind))
}

/// The key that was pressed in this frame, to be given to an act; it is used up.
pub(crate) fn captured(ctx: &egui::Context) -> Option<KeyboardShortcut> {
    ctx.input_mut(|input| {
        let is_pressed = |event: &egui::Event| match event {
            egui::Event::Key {
                key,
                pressed: true,
                repeat: false,
                ..
            } => !is_modifier(*key),
            _ => false,
        };
        let place = input.events.iter().position(is_pressed)?;
        let egui::Event::Key { key, modifiers, .. } = input.events.remove(place) else {
            return None;
        };
        let modifiers = Modifiers {
            alt: modifiers.alt,
            shift: modifiers.shift,
            command: modifiers.command,
            ..Modifiers::NONE
        };
        Some(KeyboardShortcut::new(modifiers, key))
    })
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
    for (key, act) in &map(ctx).table {
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
    let keys = acts::of(command)
        .map(|act| of(ctx, act))
        .unwrap_or_default();
    keys.first()
        .map(|key| written(ctx, *key))
        .unwrap_or_default()
}

/// The keys of an act as they are written; empty if it has none.
pub(crate) fn all_written(ctx: &egui::Context, act: &Act) -> String {
    let keys = of(ctx, act);
    let keys = keys.iter().map(|key| written(ctx, *key));
    keys.collect::<Vec<_>>().join(OR)
}

/// What has the focus while a pane has it, rather than something in it.
pub(crate) fn pane_focus(pane: Pane) -> Id {
    Id::unique(("focus", pane.title()))
}

/// How a key is written, everywhere.
fn written(ctx: &egui::Context, key: KeyboardShortcut) -> String {
    let name = match key.logical_key {
        Key::Escape => "Esc",
        Key::Period => ".",
        Key::Plus => "+",
        Key::Minus => "−",
        Key::PageUp => "Page up",
        other => other.name(),
    };
    modifiers_before(key.modifiers, ctx.os().is_mac()) + name
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::chosen_keys::read;

    #[test]
    fn no_key_does_two_things() {
        let KeyMap { table, .. } = KeyMap::with(&ChosenKeys::new());
        for (i, (key, act)) in table.iter().enumerate() {
            for (other, by) in &table[i + 1..] {
                assert_ne!(key, other, "{} and {}", act.what, by.what);
            }
        }
    }

    #[test]
    fn the_longer_of_two_keys_comes_first() {
        // Consuming Ctrl+Z would otherwise swallow Ctrl+Shift+Z.
        let KeyMap { table, .. } = KeyMap::with(&ChosenKeys::new());
        for (i, (key, act)) in table.iter().enumerate() {
            for (later, by) in &table[i + 1..] {
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

    fn chosen(what: &str, keys: &str) -> ChosenKeys {
        ChosenKeys::from([(what.to_owned(), Keys::try_from(keys.to_owned()).unwrap())])
    }

    #[test]
    fn a_chosen_key_takes_the_place_of_the_shipped_one_but_never_of_esc() {
        let ctx = egui::Context::default();
        let undo = acts::of(&Command::Undo).unwrap();
        install(&ctx, &chosen("Undo", "Alt+U or F3"));
        assert_eq!(all_written(&ctx, undo), "Alt+U or F3");
        assert_eq!(hint(&ctx, &Command::Undo), "Alt+U");
        install(&ctx, &chosen("Undo", ""));
        assert_eq!(hint(&ctx, &Command::Undo), "");
        install(&ctx, &chosen(&acts::all()[0].what, ""));
        assert_eq!(hint(&ctx, &Command::Escape), "Esc");
    }

    #[test]
    fn a_key_that_is_another_acts_or_needed_elsewhere_is_refused_with_the_reason() {
        let ctx = egui::Context::default();
        let undo = acts::of(&Command::Undo).unwrap();
        let why = |act, key: &str| {
            let key = read(key).unwrap();
            refusal(&ctx, act, key).unwrap_or_default()
        };
        assert!(why(undo, "Ctrl+Y").contains("“Redo”"));
        assert!(why(undo, "Alt+C").contains("slot"));
        assert!(why(undo, "Enter").contains("add Ctrl"));
        assert!(why(undo, "Escape").contains("everything off"));
        assert_eq!(why(undo, "Ctrl+Z"), "", "its own");
        assert_eq!(why(undo, "U"), "");
        let palette = acts::of(&crate::bench::command::ShowCommand::Palette.into()).unwrap();
        assert!(why(palette, "U").contains("while typing"));
        assert_eq!(why(palette, "F12"), "");
    }
}
