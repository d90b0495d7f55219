//! Slots under the keys of a simulated user.

use eframe::egui::Event;

use super::*;
use crate::bench::applied_gains::AppliedGains;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::perceptual_level::mean_um;
use crate::shell::headless::Headless;
use crate::tools::tuning::Tuning;
use selvedge_textile::tactile::Perception;

fn window() -> Headless {
    let mut window = Headless::shipped();
    window.dispatch(Edit::MasterGain(-9.0));
    window.dispatch(Edit::TextileGain(1, 3.0));
    window.dispatch(Edit::KeepSlot(SlotLetter::B));
    window.dispatch(Edit::MasterGain(0.0));
    window.dispatch(Edit::TextileGain(1, 0.0));
    window.pass(3);
    window
}

fn hold(window: &mut Headless, key: Key, is_down: bool) {
    let modifiers = if is_down {
        Modifiers::ALT
    } else {
        Modifiers::NONE
    };
    window.events.push(Event::ModifiersChanged(modifiers));
    window.events.push(Event::Key {
        key,
        physical_key: None,
        pressed: is_down,
        repeat: false,
        modifiers,
    });
    window.pass(3);
}

fn is_felt(window: &Headless, gains: &GainSet) -> bool {
    let wanted = AppliedGains::of(gains, &MuteSolo::default(), 24);
    window.workbench.bench.engine_scene.applied_gains == wanted
}

#[test]
fn a_slot_is_felt_as_long_as_its_key_is_held_without_another_scene() {
    let mut window = window();
    let scene = window.workbench.bench.document.scene().clone();
    let kept = GainSet::of_slot(&scene, SlotLetter::B).unwrap();
    let now = window.workbench.bench.gain_set();
    let serial = window.workbench.bench.engine_scene.serial;
    assert!(is_felt(&window, &now) && kept.gains_db[1] == 3.0);
    let n_sent = |window: &Headless| window.workbench.bench.engine.commands_sent();
    let before = n_sent(&window);
    hold(&mut window, Key::B, true);
    assert!(is_felt(&window, &kept), "held");
    assert_eq!(
        n_sent(&window),
        before + 1,
        "tuning and textile in one tick"
    );
    hold(&mut window, Key::B, false);
    assert_eq!(n_sent(&window), before + 2);
    assert!(is_felt(&window, &now), "let go");
    hold(&mut window, Key::C, true);
    assert!(is_felt(&window, &now), "nothing is kept in C");
    let bench = &window.workbench.bench;
    assert_eq!(bench.engine_scene.serial, serial, "no scene was sent");
    assert_eq!(*bench.document.scene(), scene, "nothing was edited");
}

#[test]
fn a_matched_slot_is_as_strong_as_the_present_tuning() {
    let mut window = window();
    window
        .workbench
        .tools
        .get_mut::<Tuning>()
        .unwrap()
        .slots
        .is_matched = true;
    hold(&mut window, Key::B, true);
    let bench = &window.workbench.bench;
    let held = bench.selection.held_gains.clone().unwrap();
    let scene = bench.plain_scene_view();
    let intensity = |gains: &GainSet| -> f64 {
        let own = gains.gains_db.iter().enumerate();
        let um = own.map(|(index, gain_db)| {
            let felt_um = mean_um(&scene, index, (&gains.tuning, *gain_db));
            Perception::of(felt_um.unwrap(), 24).intensity()
        });
        um.sum()
    };
    let ratio = intensity(&held) / intensity(&bench.gain_set());
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    assert_eq!(held.gains_db[1], 3.0, "only the master gives way");
    assert!(held.tuning.gain_db > -9.0, "{:?}", held.tuning);
}

#[test]
fn a_blind_comparison_counts_for_what_was_felt_and_tells_only_when_asked() {
    let mut window = window();
    let tuning = window.workbench.tools.get_mut::<Tuning>().unwrap();
    tuning.slots.blind = Some(Blind::new(SlotLetter::B, true));
    let mut orders = Vec::new();
    for _ in 0..12 {
        // Whoever always prefers the slot finds it by what is felt.
        let held = [Key::Num1, Key::Num2].map(|key| {
            hold(&mut window, key, true);
            let is_slot = window.workbench.bench.selection.held_gains.is_some();
            hold(&mut window, key, false);
            is_slot
        });
        assert_ne!(held[0], held[1], "one of the two is the slot");
        let tuning = window.workbench.tools.get_mut::<Tuning>().unwrap();
        let blind = tuning.slots.blind.as_mut().unwrap();
        assert!(!blind.words().contains('B'), "{}", blind.words());
        let nth = usize::from(!held[0]);
        orders.push(nth);
        blind.answer(nth);
    }
    let tuning = window.workbench.tools.get_mut::<Tuning>().unwrap();
    let blind = tuning.slots.blind.as_mut().unwrap();
    blind.is_shown = true;
    assert_eq!(
        blind.words(),
        "B rather than now: 12 of 12 (76–100 %, p 0.000)"
    );
    assert!(orders.contains(&0) && orders.contains(&1), "{orders:?}");
}
