//! Thousands of keys, words, clicks, drags and turns of the wheel, drawn by chance from a seed:
//! nothing breaks, nothing grows without bound, no tick is missed.

use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, TouchPhase, pos2,
    vec2,
};
use egui_kittest::Harness;
use selvedge_foundation::numerics::Random;
use selvedge_workbench::Workbench;

use super::{Folder, window};
use crate::watched::{is_alone, memory_bytes};

const N_EVENTS: usize = 4000;
/// After so many all that is made once has been made.
const N_UNTIL_WARM: usize = N_EVENTS / 2;
const MAX_GROWTH_BYTES: u64 = 100_000_000;

const MODIFIERS: [Modifiers; 6] = [
    Modifiers::NONE,
    Modifiers::NONE,
    Modifiers::SHIFT,
    Modifiers::COMMAND,
    Modifiers::COMMAND.plus(Modifiers::SHIFT),
    Modifiers::ALT,
];
const BUTTONS: [PointerButton; 4] = [
    PointerButton::Primary,
    PointerButton::Primary,
    PointerButton::Secondary,
    PointerButton::Middle,
];
/// What is typed: numbers, names of acts, nonsense.
const TEXTS: [&str; 8] = [
    "7",
    "-12.5 dB",
    "1e308",
    "wool",
    "record",
    "µ–\u{202e}\u{0}ß",
    "../../x",
    "",
];

/// What presses keys and moves the pointer.
struct Hand {
    chance: Random,
    /// Where the pointer is.
    at: Pos2,
}

impl Hand {
    /// Does one thing, and lets a tick pass.
    fn act(&mut self, harness: &mut Harness<'_, Workbench>) {
        match self.chance.index(11) {
            0..=3 => self.press_key(harness),
            4 => harness.event(Event::Text(self.one_of(&TEXTS).to_owned())),
            5 | 6 => self.drag(harness, 0),
            7 => self.drag(harness, 8),
            8 => self.turn_wheel(harness),
            // Else what asks for an answer would get all the rest.
            9 => harness.key_press(Key::Escape),
            _ => self.move_to_somewhere(harness),
        }
        harness.step();
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.chance.index(all.len())]
    }

    fn below(&mut self, n: u16) -> f32 {
        let drawn = self.chance.index(usize::from(n));
        f32::from(u16::try_from(drawn).unwrap())
    }

    fn press_key(&mut self, harness: &Harness<'_, Workbench>) {
        let modifiers = self.one_of(&MODIFIERS);
        let key = self.one_of(Key::ALL);
        harness.key_press_modifiers(modifiers, key);
    }

    fn move_to_somewhere(&mut self, harness: &mut Harness<'_, Workbench>) {
        self.at = pos2(self.below(1400), self.below(900));
        harness.event(Event::PointerMoved(self.at));
        harness.step();
    }

    /// Presses, moves so often and lets go: without a move it is a click.
    fn drag(&mut self, harness: &mut Harness<'_, Workbench>, n_moves: usize) {
        self.move_to_somewhere(harness);
        let button = self.one_of(&BUTTONS);
        let modifiers = self.one_of(&MODIFIERS);
        self.press_button(harness, (button, modifiers), true);
        for _ in 0..n_moves {
            let by = vec2(self.below(80), self.below(80)) - vec2(40.0, 40.0);
            self.at += by;
            harness.event(Event::PointerMoved(self.at));
            harness.step();
        }
        self.press_button(harness, (button, modifiers), false);
    }

    fn press_button(
        &self,
        harness: &mut Harness<'_, Workbench>,
        (button, modifiers): (PointerButton, Modifiers),
        pressed: bool,
    ) {
        harness.event(Event::PointerButton {
            pos: self.at,
            button,
            pressed,
            modifiers,
        });
        harness.step();
    }

    fn turn_wheel(&mut self, harness: &Harness<'_, Workbench>) {
        let delta = vec2(self.below(400), self.below(400)) - vec2(200.0, 200.0);
        harness.event(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta,
            source: MouseWheelSource::Unknown,
            phase: TouchPhase::Move,
            modifiers: self.one_of(&MODIFIERS),
        });
    }
}

#[test]
fn random_input_breaks_nothing_and_nothing_grows() {
    // Keys save, export and keep: in a process of its own, with a folder and a user of its own.
    if !is_alone("window::random_input::random_input_breaks_nothing_and_nothing_grows") {
        return;
    }
    let folder = Folder::new("random");
    let mut harness = window(&folder.scene());
    harness.state_mut().connect_emulator();
    let mut hand = Hand {
        chance: Random::new(19),
        at: Pos2::ZERO,
    };
    let (mut warm_bytes, mut most_steps) = (0, 0);
    for nth in 0..N_EVENTS {
        hand.act(&mut harness);
        let bench = harness.state();
        assert!(bench.notices().len() <= 20, "{:?}", bench.notices());
        assert_eq!(bench.n_ticks_missed(), 0, "event {nth}");
        most_steps = most_steps.max(bench.n_undo_steps());
        if nth == N_UNTIL_WARM {
            warm_bytes = memory_bytes(std::process::id(), "VmRSS");
        }
    }
    let grown_bytes = memory_bytes(std::process::id(), "VmRSS").saturating_sub(warm_bytes);
    let panes = harness.state().panes_drawn();
    let seen = panes.iter().filter(|(_, n_drawn)| *n_drawn > 0);
    let told = format!(
        "{} of {} panes seen, {most_steps} steps at most, {grown_bytes} bytes after {warm_bytes}",
        seen.clone().count(),
        panes.len(),
    );
    assert!((3..=200).contains(&most_steps), "{told}");
    assert!(2 * seen.count() > panes.len(), "{told}");
    assert!(grown_bytes < MAX_GROWTH_BYTES, "{told}");
}
