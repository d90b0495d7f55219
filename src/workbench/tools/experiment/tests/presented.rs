//! Trials that count: what was not felt is not answered, what stops counting is presented again.

use super::*;
use crate::bench::view::BridgePhase;
use selvedge_experiment::{Proof, Validity};

/// Runs frames until something is so, for as long as a busy machine may take.
fn wait(window: &mut Headless, what: &str, is_so: impl Fn(&Headless) -> bool) {
    for _ in 0..2000 {
        window.pass(1);
        if is_so(window) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("{what} did not come");
}

/// Connects the emulator and arms it, until it is at full strength.
fn arm(window: &mut Headless) {
    if window.workbench.bench.live.bridge.is_none() {
        window.dispatch(DeviceCommand::ConnectEmulator);
    }
    wait(window, "a device", |window| {
        let bridge = window.workbench.bench.live.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.phase == BridgePhase::Ready)
    });
    window.dispatch(DeviceCommand::Arm);
    wait(window, "full strength", |window| {
        ArrayNow::of(&window.workbench.bench).why_not.is_none()
    });
}

/// A window with an armed emulator and a session on it that counts.
fn begun_on_array(folder: &Folder) -> Headless {
    let mut window = Headless::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
    window.pass(2);
    let form = &mut experiment_mut(&mut window).form;
    form.choose(small(folder, "odd-one-out"));
    form.folder = folder.0.display().to_string();
    form.who.pseudonym = "p01".to_owned();
    act(&mut window, Experiment::begin_session);
    window.pass(3);
    for _ in 0..4 {
        pass(&mut window);
        window.pass(2);
    }
    window
}

#[test]
fn an_answer_waits_until_everything_was_felt() {
    let folder = Folder::new("unfelt");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    let say = |window: &mut Headless| {
        mark(window, Mark::Place(1));
        mark(window, Mark::Confidence(1));
        answer(window);
        window.pass(4);
    };
    say(&mut window);
    assert_eq!(session(&window).progress.0, 0);
    window.pass(25);
    assert!(session(&window).missing().unwrap().contains("number 1"));
    feel(&mut window);
    say(&mut window);
    assert_eq!(session(&window).progress.0, 1);
    let found = find_sessions(&folder.0).unwrap().0;
    let presentation = &found[0].records[0].presentation;
    assert_eq!(
        (presentation.validity(), presentation.proof),
        (Validity::Valid, Some(Proof::Screen))
    );
    let felt_s = &presentation.explored_s;
    assert!(
        felt_s.len() == 3 && felt_s.iter().all(|s| *s >= 1.0),
        "{felt_s:?}"
    );
    assert_eq!(found[0].breaks, []);
}

#[test]
fn a_trial_waits_for_an_armed_array_and_is_voided_with_it_and_three_times_stop() {
    let folder = Folder::new("void");
    let mut window = begun_on_array(&folder);
    let waiting = session(&window);
    assert!(waiting.trial().is_some() && waiting.is_waiting());
    let trial = waiting.trial().unwrap().clone();
    let seen = experiment(&window).participant(&EngineView::default(), 0.0);
    assert!(
        matches!(seen, ParticipantView::Words { left_s: None, .. }),
        "{seen:?}"
    );
    mark(&mut window, Mark::Place(1));
    assert!(
        matches!(session(&window).draft, Draft::Choose { position: None, .. }),
        "nothing is answered before it begins"
    );
    for nth in 1..=3 {
        arm(&mut window);
        // A busy machine may void one that nobody disarms.
        wait(&mut window, "a presentation", |window| {
            !session(window).is_waiting() || session(window).attempt() > nth
        });
        window.dispatch(DeviceCommand::Disarm);
        wait(&mut window, "its void", |window| {
            session(window).is_waiting() || session(window).pause == Pause::On
        });
        let voided = session(&window);
        assert!(voided.progress.0 == 0 && voided.attempt() > nth);
        let trouble = voided.presented.trouble.clone().unwrap();
        assert!(trouble.contains("does not count"), "{trouble}");
        if voided.pause == Pause::On {
            break;
        }
    }
    assert_eq!(session(&window).pause, Pause::On);
    let trouble = session(&window).presented.trouble.clone().unwrap();
    assert!(trouble.contains("times"), "{trouble}");
    let found = find_sessions(&folder.0).unwrap().0;
    let rows = &found[0].records;
    assert_eq!(rows.len(), 3);
    for row in rows {
        assert_eq!((&row.trial, row.answer()), (&trial, None));
        let presentation = &row.presentation;
        assert_eq!(presentation.validity(), Validity::Void, "{presentation:?}");
        assert_eq!(presentation.proof, Some(Proof::Emulator));
    }
    assert_eq!(found[0].breaks, []);
    arm(&mut window);
    act(&mut window, |one, bench| one.pause(false, bench));
    wait(&mut window, "the fourth", |window| {
        !session(window).is_waiting()
    });
}

#[test]
fn a_beginning_is_taken_back_without_a_trace_but_a_line() {
    let folder = Folder::new("undone");
    let mut window = begun_on_array(&folder);
    let log = log_of(&window);
    assert!(log.exists());
    act(&mut window, Experiment::undo_beginning);
    window.pass(3);
    assert!(experiment(&window).session.is_none());
    assert!(!log.exists() && !log.with_extension("json").exists());
    let undone = fs::read_to_string(folder.0.join("undone-sessions.csv")).unwrap();
    assert!(
        undone.lines().nth(1).unwrap().ends_with(",p01,1"),
        "{undone}"
    );
}

#[test]
fn the_keys_that_a_trial_names_answer_it_in_the_main_window() {
    let is_chosen = |draft: &Draft, at: usize, said: Option<u8>| match draft {
        Draft::Choose { position, sure, .. } => *position == Some(at) && sure.grade == said,
        _ => false,
    };
    let is_odd = |draft: &Draft| is_chosen(draft, 1, Some(3));
    let is_real = |draft: &Draft| is_chosen(draft, 0, None);
    press_in_trial("odd-one-out", &[Key::Num2, Key::H], is_odd);
    press_in_trial("real-or-generated", &[Key::R], is_real);
}

fn press_in_trial(design: &'static str, keys: &[Key], is_expected: impl Fn(&Draft) -> bool) {
    let folder = Folder::new("keys");
    let mut window = begun(&folder, design, "p01");
    to_trial(&mut window);
    window.pass(3);
    for key in keys {
        window.press(Modifiers::NONE, *key);
    }
    let draft = &session(&window).draft;
    assert!(is_expected(draft), "{design}: {draft:?}");
}
