//! What the public may do with pointer, fingers and keys: everything else never reaches the stage.

use eframe::egui::{
    Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, TouchId, TouchPhase, Ui,
};

use crate::kit::fingers::FingerRings;
use crate::tools::stage::pin::Access;

/// The cursor is seen for so long after the mouse moved, s.
const CURSOR_S: f64 = 3.0;

/// Keys of the public, and those of the operator and of a line of text beside them.
const KEYS: [Key; 12] = [
    Key::Tab,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
    Key::Enter,
    Key::Space,
    Key::Escape,
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
];
const MORE: [Key; 7] = [
    Key::Backspace,
    Key::Num0,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
];

/// Takes out what is not for the public. `types`: a comment is being typed.
pub(crate) fn filter(input: &mut RawInput, access: Access, types: bool) {
    input.dropped_files.clear();
    input.hovered_files.clear();
    input.events.retain(|event| match event {
        Event::Key { key, modifiers, .. } => may_press(*key, *modifiers, access, types),
        Event::Text(_) => types,
        Event::PointerButton { button, .. } => *button == PointerButton::Primary,
        Event::PointerMoved(_)
        | Event::MouseMoved(_)
        | Event::PointerGone
        | Event::Touch { .. }
        | Event::WindowFocused(_)
        | Event::AccessKitActionRequest(_) => true,
        _ => false,
    });
}

/// Whether these keys ask for the operator's page.
fn is_operator(key: Key, modifiers: Modifiers) -> bool {
    key == Key::F12 && modifiers.ctrl && modifiers.shift
}

fn may_press(key: Key, modifiers: Modifiers, access: Access, types: bool) -> bool {
    if is_operator(key, modifiers) {
        return true;
    }
    let is_plain = !modifiers.ctrl && !modifiers.alt && !modifiers.command;
    let is_more = (types || access != Access::Closed) && MORE.contains(&key);
    is_plain && (KEYS.contains(&key) || is_more)
}

/// Fingers and keys as they were seen last.
#[derive(Debug, Default)]
pub(crate) struct Senses {
    /// Rings at fingers that hold no display.
    pub(crate) rings: FingerRings,
    /// What was used last.
    input: Option<&'static str>,
    pub(crate) has_keyboard: bool,
    moved_s: f64,
    /// Fingers that are down.
    fingers: Vec<Finger>,
}

/// A finger that is down.
#[derive(Debug, Clone, Copy)]
struct Finger {
    id: TouchId,
    at: Pos2,
    /// Whether it came down on what is felt.
    feels: bool,
}

/// What the events of a frame say beside pointer and buttons.
#[derive(Debug, Default)]
pub(crate) struct Heard {
    /// Where fingers came down, the first or others.
    pub(crate) touched: Vec<Pos2>,
    /// Whether one of them came down on what is felt.
    pub(crate) feels: bool,
    /// Whether the operator's page is asked for.
    pub(crate) asks_operator: bool,
    pub(crate) escapes: bool,
    /// The number from 0 that was pressed.
    pub(crate) number: Option<usize>,
}

impl Senses {
    /// Takes in the events of a frame, where fingers are that hold no display, and the part of the
    /// screen that is felt.
    pub(crate) fn take(
        &mut self,
        ui: &Ui,
        (strays, ground): (&[Pos2], Option<Rect>),
        now_s: f64,
    ) -> Heard {
        let mut heard = Heard::default();
        self.rings.take(strays, now_s);
        ui.input(|input| {
            for event in &input.events {
                match event {
                    Event::Touch { id, phase, pos, .. } => {
                        self.finger((*id, *phase, *pos), ground, &mut heard);
                    }
                    Event::Key {
                        key,
                        modifiers,
                        pressed: true,
                        ..
                    } => {
                        self.input = Some("keys");
                        self.has_keyboard = true;
                        heard.asks_operator |= is_operator(*key, *modifiers);
                        heard.escapes |= *key == Key::Escape;
                        let numbers = [Key::Num1, Key::Num2, Key::Num3, Key::Num4];
                        let number = numbers.iter().position(|number| number == key);
                        heard.number = heard.number.or(number);
                    }
                    Event::PointerMoved(_) => self.moved_s = now_s,
                    Event::PointerButton { pressed: true, .. }
                        if heard.touched.is_empty() && !input.any_touches() =>
                    {
                        self.input = Some("mouse");
                    }
                    _ => {}
                }
            }
        });
        heard
    }

    /// A finger comes, moves or leaves.
    fn finger(
        &mut self,
        (id, phase, at): (TouchId, TouchPhase, Pos2),
        ground: Option<Rect>,
        heard: &mut Heard,
    ) {
        let known = self.fingers.iter().position(|finger| finger.id == id);
        match (phase, known) {
            (TouchPhase::Start, _) => {
                self.input = Some("touch");
                heard.touched.push(at);
                let feels = ground.is_some_and(|ground| ground.contains(at));
                heard.feels |= feels;
                self.fingers.retain(|finger| finger.id != id);
                self.fingers.push(Finger { id, at, feels });
            }
            (TouchPhase::Move, Some(nth)) => {
                self.fingers[nth].at = at;
            }
            (TouchPhase::End | TouchPhase::Cancel, Some(nth)) => drop(self.fingers.remove(nth)),
            _ => {}
        }
    }

    /// Whether a finger is down.
    pub(crate) fn has_fingers(&self) -> bool {
        !self.fingers.is_empty()
    }

    /// Whether one came down on what is felt.
    pub(crate) fn feels(&self) -> bool {
        self.fingers.iter().any(|finger| finger.feels)
    }

    /// Where the first finger that feels is.
    pub(crate) fn felt_at(&self) -> Option<Pos2> {
        let felt = self.fingers.iter().find(|finger| finger.feels);
        felt.map(|finger| finger.at)
    }

    /// What was used last.
    pub(crate) fn input(&self) -> &'static str {
        self.input.unwrap_or("mouse")
    }

    /// Whether a cursor is in the way.
    pub(crate) fn hides_cursor(&self, now_s: f64) -> bool {
        self.input == Some("touch") || now_s - self.moved_s > CURSOR_S
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(key: Key, modifiers: Modifiers) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        }
    }

    #[test]
    fn the_public_passes_a_few_keys_and_one_button_and_drops_no_files() {
        let ctrl_shift = Modifiers::CTRL | Modifiers::SHIFT;
        let cases = [
            (key(Key::Tab, Modifiers::NONE), true),
            (key(Key::Tab, Modifiers::SHIFT), true),
            (key(Key::Num4, Modifiers::NONE), true),
            (key(Key::Escape, Modifiers::NONE), true),
            (key(Key::F12, ctrl_shift), true),
            (key(Key::F12, Modifiers::CTRL), false),
            (key(Key::F11, Modifiers::NONE), false),
            (key(Key::Num5, Modifiers::NONE), false),
            (key(Key::Enter, Modifiers::CTRL), false),
            (key(Key::F4, Modifiers::ALT), false),
            (key(Key::Q, Modifiers::COMMAND), false),
            (Event::Text("a".to_owned()), false),
            (Event::Paste("a".to_owned()), false),
            (Event::Copy, false),
            (Event::Zoom(2.0), false),
            (Event::PointerMoved(Pos2::ZERO), true),
        ];
        for (event, expected) in cases {
            let mut input = RawInput::default();
            input.events.push(event.clone());
            input
                .hovered_files
                .push(eframe::egui::HoveredFile::default());
            filter(&mut input, Access::Closed, false);
            assert_eq!(!input.events.is_empty(), expected, "{event:?}");
            assert!(input.hovered_files.is_empty() && input.dropped_files.is_empty());
        }
        let mut input = RawInput {
            events: vec![key(Key::Num7, Modifiers::NONE), Event::Text("7".to_owned())],
            ..RawInput::default()
        };
        filter(&mut input, Access::Asked, false);
        assert_eq!(input.events.len(), 1, "digits of the PIN");
        input.events.push(Event::Text("ä".to_owned()));
        filter(&mut input, Access::Closed, true);
        assert_eq!(input.events.len(), 2, "words of a comment");
    }
}
