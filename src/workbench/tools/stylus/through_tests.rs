//! The stylus through the device, in a window without a screen: what is felt, what says so, what is
//! recorded with it, and what is kept.

use super::tests::{FINE_MM, explored, fine, stylus};
use super::*;
use crate::bench::command::{FileCommand, PlayCommand, PlaySource, ShowCommand};
use crate::bench::recording::Recordings;
use crate::shell::headless::Headless;
use crate::tools::why::Why;
use crate::tools::why::text::to_text;
use selvedge_render::contact::Stepper;
use selvedge_render::stylus::{StylusSettings, StylusState};
use selvedge_scratch::ScratchFolder;

/// A window whose display explores by itself, felt by the stylus.
fn felt() -> Headless {
    let mut desk = explored(40);
    stylus(&mut desk).through.is_on = true;
    // A textile a frame is prepared.
    desk.pass_ticks(40);
    desk
}

/// The amplitudes of all contactors, µm.
fn felt_um(desk: &Headless) -> Vec<[f64; 2]> {
    let dots = desk.workbench.bench.live.dots.iter();
    dots.map(|dot| dot.amplitude_um).collect()
}

/// Whether all contactors do the same, and something.
fn is_of_stylus(desk: &Headless) -> bool {
    let um = felt_um(desk);
    um[0][0] > 0.0 && um.iter().all(|one| *one == um[0])
}

/// Goes on until the stylus is led over a textile.
fn led(desk: &mut Headless) {
    for _ in 0..80 {
        desk.pass_ticks(1);
        let is_led = desk.workbench.bench.live.stylus == Some(StylusState::Led);
        if is_led && is_of_stylus(desk) {
            return;
        }
    }
    panic!("{:?} {:?}", desk.workbench.bench.live.stylus, felt_um(desk));
}

/// Lets what was switched reach the engine, and be seen.
fn settle(desk: &mut Headless) {
    for _ in 0..4 {
        desk.pass_ticks(1);
    }
}

fn notes(desk: &mut Headless) -> String {
    let state = desk.workbench.bench.live.stylus;
    let notes: Vec<_> = stylus(desk)
        .through
        .notes(state)
        .map(str::to_owned)
        .collect();
    notes.join("\n")
}

#[test]
fn the_switch_lets_the_display_vibrate_as_the_stylus_and_gives_the_array_back() {
    let mut desk = explored(40);
    assert_eq!(desk.workbench.bench.live.stylus, None);
    let bench = &mut desk.workbench.bench;
    assert_eq!(bench.engine.snapshot().counters.stylus_steps, 0, "unasked");
    let mut desk = felt();
    led(&mut desk);
    assert!(
        notes(&mut desk).contains("Felt now"),
        "{}",
        notes(&mut desk)
    );
    stylus(&mut desk).through.is_on = false;
    settle(&mut desk);
    assert_eq!(desk.workbench.bench.live.stylus, None);
    assert!(!is_of_stylus(&desk), "the array is felt");
    assert_eq!(notes(&mut desk), "");
}

#[test]
fn another_scene_switches_it_off() {
    let mut desk = felt();
    desk.dispatch(FileCommand::OpenShipped);
    settle(&mut desk);
    assert!(!stylus(&mut desk).through.is_on && desk.workbench.bench.live.stylus.is_none());
}

#[test]
fn what_cannot_be_held_reaches_no_device_and_a_rate_too_high_is_lowered() {
    let mut desk = felt();
    led(&mut desk);
    let loose = StylusSettings {
        stiffness_n_per_m: 50_000.0,
        damping_n_s_per_m: 0.0,
        is_sampled: true,
        ..fine()
    };
    let chosen = &mut stylus(&mut desk).chosen;
    chosen.ask(loose);
    chosen.confirm();
    assert_eq!(chosen.applied, loose);
    settle(&mut desk);
    assert_eq!(desk.workbench.bench.live.stylus, None);
    assert!(
        notes(&mut desk).contains("cannot be held"),
        "{}",
        notes(&mut desk)
    );
    stylus(&mut desk).chosen.ask(StylusSettings {
        rate_hz: 20_000.0,
        ..fine()
    });
    settle(&mut desk);
    led(&mut desk);
    let told = notes(&mut desk);
    assert!(told.contains("Driven at 10000 Hz"), "{told}");
}

#[test]
fn why_and_what_is_exported_say_what_is_felt() {
    let mut desk = felt();
    led(&mut desk);
    desk.dispatch(ShowCommand::Reveal(Pane::Why));
    desk.pass(2);
    let felt = felt_um(&desk)[0];
    let why = desk.workbench.tools.get::<Why>().unwrap();
    let shown = why.shown.as_ref().unwrap();
    assert_eq!(shown.trace.amplitudes_um, felt);
    let text = to_text(shown);
    assert!(
        text.contains("the stylus’ vibration, not the array’s"),
        "{text}"
    );
    assert!(!text.contains("Without gain"), "{text}");
    let origin = format!("{:?}", desk.workbench.bench.rendered_origin());
    assert!(origin.contains("felt_in_place_of_array"), "{origin}");
}

#[test]
fn a_recording_says_so_shows_it_when_it_is_looked_at_and_replays_the_same() {
    let root = ScratchFolder::made("stylus");
    let mut desk = felt();
    desk.workbench.bench.exploration.recordings = Recordings::in_folder(root.to_owned());
    led(&mut desk);
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass_ticks(120);
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass_ticks(2);
    desk.pass(3);
    let recording = desk.workbench.bench.exploration.at_hand.clone().unwrap();
    let words = recording.about().stylus.clone().unwrap();
    assert_eq!(words, fine().words());
    let page = std::fs::read_to_string(recording.folder.as_ref().unwrap().join("recording.toml"));
    assert!(
        page.unwrap().contains("stylus = \"K 1000 N/m"),
        "on its page"
    );
    desk.dispatch(PlayCommand::Source(PlaySource::Recording));
    settle(&mut desk);
    if !desk.workbench.bench.live.play.is_playing {
        desk.dispatch(PlayCommand::Toggle);
    }
    let mut n_felt = 0;
    for _ in 0..100 {
        desk.pass_ticks(1);
        let tick = desk.workbench.bench.live.play.tick;
        let recorded = recording.amplitudes_um(tick).unwrap();
        let replayed = felt_um(&desk);
        for (recorded, replayed) in recorded.iter().zip(&replayed) {
            assert_eq!(recorded.map(f64::from), *replayed, "tick {tick}");
        }
        n_felt += u32::from(is_of_stylus(&desk));
    }
    assert!(n_felt > 30, "{n_felt}");
    assert_eq!(stylus(&mut desk).recorded, Some(words));
}

#[test]
fn settings_are_there_in_the_next_run_and_what_cannot_be_held_waits() {
    let held = StylusSettings {
        stiffness_n_per_m: 700.0,
        radius_mm: FINE_MM,
        method: Stepper::RungeKutta4,
        is_sampled: true,
        damping_n_s_per_m: 0.0,
        press_n: 1.0,
        ..StylusSettings::default()
    };
    let loose = StylusSettings {
        stiffness_n_per_m: 90_000.0,
        ..held
    };
    let mut before = Chosen::default();
    before.ask(held);
    assert_eq!(before.applied, held);
    before.ask(loose);
    let tool = Stylus {
        chosen: before,
        ..Stylus::default()
    };
    let mut kept = Preferences::default();
    tool.keep_preferences(&mut kept);
    let path = std::path::Path::new("settings.toml");
    let text = kept.to_text(path).unwrap();
    let again = |text: &str| {
        let (kept, odd) = Preferences::from_text(text, path).unwrap();
        let mut chosen = Chosen::default();
        chosen.take_up(kept.hand.stylus, kept.hand.stylus_waiting);
        (chosen, odd)
    };
    let (chosen, odd) = again(&text);
    assert_eq!((chosen.applied, chosen.shown(), odd), (held, loose, None));

    // What was confirmed although it cannot be held waits, too.
    let mut confirmed = chosen;
    confirmed.confirm();
    let tool = Stylus {
        chosen: confirmed,
        ..Stylus::default()
    };
    tool.keep_preferences(&mut kept);
    let (chosen, _) = again(&kept.to_text(path).unwrap());
    assert_eq!(chosen.shown(), loose);
    assert_eq!(chosen.applied, StylusSettings::default());

    // A bad field costs that field; one out of bounds goes to the nearest.
    let odd = "[stylus]\nstiffness_n_per_m = \"soft\"\nmass_kg = 99.0\nmethod = \"guess\"\n\
               press_n = nan\nradius_mm = 0.25\n";
    let (chosen, line) = again(odd);
    let expected = StylusSettings {
        mass_kg: 1.0,
        radius_mm: 0.25,
        ..StylusSettings::default()
    };
    assert_eq!((chosen.applied, line), (expected, Some(1)));
}
