//! The stage in a window: what is drawn, what reaches the engine, what is armed when.

use std::any::Any;
use std::thread;
use std::time::{Duration, Instant};

use eframe::egui::{
    Event, Key, Modifiers, PointerButton, Pos2, TouchDeviceId, TouchId, TouchPhase, Vec2, vec2,
};

use crate::bench::command::DeviceCommand;
use crate::bench::stage::{StageOptions, StagePicture};
use crate::bench::view::Source;
use crate::shell::headless::Headless;
use crate::tools::stage::Stage;
use crate::tools::stage::machine::Phase;
use crate::tools::stage::pin::Access;
use selvedge_scratch::ScratchFolder;

pub(super) const FULL_HD: Vec2 = vec2(1920.0, 1080.0);
const STATES: [StagePicture; 10] = [
    StagePicture::Watching,
    StagePicture::Touching,
    StagePicture::Offered,
    StagePicture::Armed,
    StagePicture::Guessing,
    StagePicture::Told,
    StagePicture::StillHere,
    StagePicture::Ended,
    StagePicture::Pin,
    StagePicture::Operator,
];

pub(super) fn with_pin() -> StageOptions {
    let path = std::path::Path::new("stage.toml");
    StageOptions::from_text("pin = \"271828\"\nceiling_percent = 30\n", path).unwrap()
}

pub(super) fn opened(options: StageOptions, size: Vec2, scale: f32) -> Headless {
    let mut window = Headless::on_stage(options, size / scale, scale).unwrap();
    window.pass(2);
    window
}

pub(super) fn stage(window: &mut Headless) -> &mut Stage {
    let face: &mut dyn Any = &mut **window.workbench.face.as_mut().unwrap();
    face.downcast_mut().unwrap()
}

fn button(at: Pos2, pressed: bool) -> Event {
    Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

pub(super) fn finger(id: u64, phase: TouchPhase, pos: Pos2) -> Event {
    Event::Touch {
        device_id: TouchDeviceId(1),
        id: TouchId(id),
        phase,
        pos,
        force: None,
    }
}

/// Strokes to and fro around a place; the pointer stays down if `stays`.
pub(super) fn stroke(window: &mut Headless, at: Pos2, n_frames: u8, stays: bool) {
    window.events.push(Event::PointerMoved(at));
    window.events.push(button(at, true));
    for frame in 0..n_frames {
        let off = 40.0 * (f32::from(frame) / 5.0).sin();
        window.events.push(Event::PointerMoved(at + vec2(off, 0.0)));
        window.pass(1);
    }
    if !stays {
        window.events.push(button(at, false));
        window.pass(1);
    }
}

fn click(window: &mut Headless, at: Pos2) {
    window.events.push(Event::PointerMoved(at));
    window.pass(1);
    window.events.push(button(at, true));
    window.pass(1);
    window.events.push(button(at, false));
    window.pass(2);
}

/// Where these words stand.
fn find(window: &mut Headless, words: &str) -> Pos2 {
    let lines = &stage(window).drawn.lines;
    let found = lines.iter().find(|(line, _)| line == words);
    found
        .unwrap_or_else(|| panic!("{words} among {lines:?}"))
        .1
        .center()
}

pub(super) fn square(window: &mut Headless) -> eframe::egui::Rect {
    let whole = window.ctx.content_rect();
    stage(window).layout(whole).square
}

#[test]
fn every_state_has_few_words_large_targets_and_nothing_cut_off() {
    for (size, scale) in [
        (vec2(1280.0, 720.0), 1.0),
        (FULL_HD, 1.0),
        (FULL_HD, 1.5),
        (vec2(3840.0, 2160.0), 2.0),
        (vec2(1080.0, 1920.0), 1.0),
    ] {
        for state in STATES {
            let mut window = opened(with_pin(), size, scale);
            window.dispatch(DeviceCommand::ConnectEmulator);
            window.pass(20);
            window.go_to(state);
            window.pass(4);
            let whole = window.ctx.content_rect().expand(0.5);
            let mm = stage(&mut window).layout(whole).mm;
            let unit = stage(&mut window).layout(whole).unit;
            let drawn = &stage(&mut window).drawn;
            let why = format!("{state:?} on {size:?} at {scale}: {drawn:?}");
            for (words, place) in &drawn.lines {
                assert!(whole.contains_rect(*place), "{words} is cut off: {why}");
            }
            if matches!(state, StagePicture::Pin | StagePicture::Operator) {
                continue;
            }
            let word = |word: &&str| word.chars().any(char::is_alphabetic) && *word != "Aa";
            let n_words = drawn.lines.iter().flat_map(|(line, _)| line.split(' '));
            let n_words = n_words.filter(word).count();
            assert!(n_words <= 12, "{n_words} words: {why}");
            for target in &drawn.targets {
                assert!(whole.contains_rect(*target), "{target:?}: {why}");
                let least = 19.9 * mm;
                assert!(
                    target.width() >= least && target.height() >= least,
                    "{target:?}: {why}"
                );
            }
            let heights = drawn.lines.iter().filter(|(line, _)| line.len() > 3);
            for (words, place) in heights {
                assert!(place.height() >= 23.0 * unit, "{words} is small: {why}");
            }
            assert_eq!(drawn.stop.is_some(), state == StagePicture::Armed, "{why}");
        }
    }
}

#[test]
fn a_touch_is_answered_in_its_frame_and_felt_while_it_is_down() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    window.pass(60);
    assert_eq!(window.workbench.bench.live.play.source, Source::Recording);
    let at = square(&mut window).center() + vec2(-150.0, -150.0);
    window.events.push(Event::PointerMoved(at));
    window.pass(3);
    assert!(
        matches!(stage(&mut window).machine.phase(), Phase::Watching),
        "a hand above is none"
    );
    window.events.push(button(at, true));
    window.pass(1);
    assert!(matches!(
        stage(&mut window).machine.phase(),
        Phase::Touching
    ));
    stroke(&mut window, at, 40, true);
    let live = &window.workbench.bench.live;
    assert_eq!(live.play.source, Source::Pointer);
    assert_eq!(
        live.cloth_under_display(),
        Some(0),
        "the first cloth is above on the left"
    );
    assert!(live.dots.iter().any(|dot| dot.amplitude_um[0] > 0.1));
}

#[test]
fn a_hand_that_rests_beside_the_cloths_keeps_nobody_from_feeling() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    let ground = square(&mut window);
    let (beside, at) = (
        Pos2::new(20.0, ground.center().y),
        ground.center() + vec2(-150.0, -150.0),
    );
    // The first finger is the toolkit's pointer too.
    window.events.extend([
        finger(1, TouchPhase::Start, beside),
        Event::PointerMoved(beside),
        button(beside, true),
    ]);
    window.pass(3);
    assert!(matches!(
        stage(&mut window).machine.phase(),
        Phase::Watching
    ));
    window.events.push(finger(2, TouchPhase::Start, at));
    window.pass(1);
    assert!(matches!(
        stage(&mut window).machine.phase(),
        Phase::Touching
    ));
    window
        .events
        .push(finger(2, TouchPhase::Move, at + vec2(30.0, 0.0)));
    window.pass(1);
    let stage_of = stage(&mut window);
    assert!(stage_of.hand.is_down && stage_of.hand.moved_mm > 1.0);
    // The one lifts, and the other still rests.
    window.events.push(finger(2, TouchPhase::Cancel, at));
    window.pass(1);
    assert!(!stage(&mut window).hand.is_down);
}

#[test]
fn visits_by_pointer_and_by_keys_are_on_disk_with_what_was_guessed() {
    let folder = ScratchFolder::made("stage-visits");
    let mut options = with_pin();
    options.log = Some(folder.to_owned());
    let mut window = opened(options, FULL_HD, 1.0);
    let middle = square(&mut window).center();
    for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]] {
        stroke(&mut window, middle + vec2(200.0 * x, 200.0 * y), 60, false);
    }
    let guess = find(&mut window, "Guess");
    click(&mut window, guess);
    for _ in 0..3 {
        let centre = window.ctx.content_rect().center();
        stroke(&mut window, centre - vec2(0.0, 100.0), 30, false);
        window.press(Modifiers::NONE, Key::Num1);
        window.pass_ticks(110);
    }
    // The last in the row below faces and words.
    let whole = window.ctx.content_rect();
    let layout = stage(&mut window).layout(whole);
    let [_, _, done] = layout.places::<3>(layout.row, [60.0, 25.0]);
    click(&mut window, done.center());
    window.press(Modifiers::NONE, Key::Num3);
    window.pass_ticks(45 * 40);
    let visits = std::fs::read_to_string(folder.join("visits.csv")).unwrap();
    let rows: Vec<Vec<&str>> = visits
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 2, "{visits}");
    assert!(rows[0][12] == "3" && rows[0][14] == "done", "{visits}");
    assert!(rows[1][4] == "keys" && rows[1][14] == "idle", "{visits}");
    let guesses = std::fs::read_to_string(folder.join("guesses.csv")).unwrap();
    assert_eq!(guesses.lines().count(), 4, "{guesses}");
    window.press(Modifiers::NONE, Key::Num1);
    window.workbench.end_stage();
    let visits = std::fs::read_to_string(folder.join("visits.csv")).unwrap();
    assert!(
        visits.ends_with("stop\n"),
        "a visit that the end of the program ends: {visits}"
    );
}

#[test]
fn closing_asks_for_the_pin_and_escape_closes_nothing() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    window.press(Modifiers::NONE, Key::Escape);
    assert_eq!(stage(&mut window).lock.access(), Access::Closed);
    let bench = &mut window.workbench.bench;
    let closes = window
        .workbench
        .face
        .as_mut()
        .unwrap()
        .is_closed_by(true, bench);
    assert!(!closes && stage(&mut window).lock.access() == Access::Asked);
    window.press(Modifiers::NONE, Key::Escape);
    assert_eq!(stage(&mut window).lock.access(), Access::Closed);
    window.press(Modifiers::CTRL | Modifiers::SHIFT, Key::F12);
    for key in [
        Key::Num2,
        Key::Num7,
        Key::Num1,
        Key::Num8,
        Key::Num2,
        Key::Num8,
        Key::Enter,
    ] {
        window.press(Modifiers::NONE, key);
    }
    assert_eq!(stage(&mut window).lock.access(), Access::Open);
    let end = find(&mut window, "End program");
    click(&mut window, end);
    let bench = &mut window.workbench.bench;
    assert!(
        window
            .workbench
            .face
            .as_mut()
            .unwrap()
            .is_closed_by(true, bench)
    );
}

#[test]
fn nothing_exceeds_the_ceiling_whatever_the_profile_allows() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    for at in [0.0_f32, 30.0, -60.0] {
        let middle = square(&mut window).center();
        stroke(&mut window, middle + vec2(200.0, at - 100.0), 30, false);
        let profile = window.workbench.bench.engine.profile();
        for (limit_um, full_um) in profile.limit_um.into_iter().zip(profile.full_scale_um) {
            assert!(limit_um <= 0.3 * full_um + 1e-9, "{limit_um} of {full_um}");
        }
    }
}

/// Runs frames, as fast as the emulator lives, until something is so.
pub(super) fn wait(
    window: &mut Headless,
    mut is_so: impl FnMut(&mut Headless) -> bool,
    what: &str,
) {
    let patience = Instant::now() + Duration::from_secs(90);
    while !is_so(window) {
        assert!(Instant::now() < patience, "never {what}");
        window.pass(1);
        thread::sleep(Duration::from_millis(3));
    }
}

fn is_armed(window: &mut Headless) -> bool {
    window.workbench.bench.live.is_armed()
}

/// Presses a place and holds it until something is so.
fn hold(window: &mut Headless, at: Pos2, n_frames: u32) {
    window.events.push(Event::PointerMoved(at));
    window.pass(1);
    window.events.push(button(at, true));
    for _ in 0..n_frames {
        window.pass(1);
        thread::sleep(Duration::from_millis(3));
    }
    window.events.push(button(at, false));
    window.pass(1);
}

#[test]
fn high_voltage_is_on_only_by_permission_and_a_second_of_holding_and_off_in_time() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    window.dispatch(DeviceCommand::ConnectEmulator);
    wait(&mut window, |window| window.workbench.is_ready(), "ready");
    window.press(Modifiers::NONE, Key::Num1);
    window.pass(10);
    assert!(
        !stage(&mut window).machine.offers_feeling(),
        "nobody permits it"
    );
    stage(&mut window).machine.voltage.permit(true);
    window.pass(2);
    let feel = find(&mut window, "Press to feel");
    hold(&mut window, feel, 20);
    assert!(!is_armed(&mut window), "half a second");
    hold(&mut window, feel, 44);
    wait(&mut window, is_armed, "armed");
    let middle = square(&mut window).center();
    stroke(&mut window, middle + vec2(150.0, 150.0), 30, false);
    assert!(is_armed(&mut window), "it is felt");
    for _ in 0..19 * 40 {
        window.pass(1);
    }
    assert!(
        stage(&mut window).machine.is_armed(),
        "19 s after the finger"
    );
    for _ in 0..2 * 40 {
        window.pass(1);
    }
    wait(&mut window, |window| !is_armed(window), "off after 20 s");
    // A fresh command each time; STOP ends the visit and the screen goes on.
    wait(
        &mut window,
        |window| window.workbench.is_ready(),
        "ready again",
    );
    window.press(Modifiers::NONE, Key::Num1);
    let feel = find(&mut window, "Press to feel");
    hold(&mut window, feel, 44);
    wait(&mut window, is_armed, "armed again");
    window.pass(1);
    let stop = stage(&mut window).drawn.stop.unwrap().center();
    window.events.push(finger(2, TouchPhase::Start, stop));
    window.pass(2);
    assert!(matches!(
        stage(&mut window).machine.phase(),
        Phase::Watching
    ));
    wait(&mut window, |window| !is_armed(window), "off by STOP");
    wait(
        &mut window,
        |window| !window.workbench.is_stopped() && window.workbench.bench.live.play.is_playing,
        "the ghost again",
    );
}

#[test]
fn what_is_armed_is_off_in_time_where_the_window_is_not_shown_any_more() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    window.dispatch(DeviceCommand::ConnectEmulator);
    wait(&mut window, |window| window.workbench.is_ready(), "ready");
    stage(&mut window).machine.voltage.permit(true);
    window.press(Modifiers::NONE, Key::Num1);
    window.pass(2);
    let feel = find(&mut window, "Press to feel");
    hold(&mut window, feel, 44);
    wait(&mut window, is_armed, "armed");
    // A window that is not shown thinks, but draws no frame, and its clock stands still.
    let ctx = window.ctx.clone();
    let think = |window: &mut Headless| {
        window.workbench.bench.clock.look(&ctx);
        window.workbench.stage_logic(&ctx);
    };
    // The look after a frame, and the first without one.
    think(&mut window);
    think(&mut window);
    assert!(stage(&mut window).machine.is_armed());
    (window.workbench.bench.clock).unseen_for(Duration::from_secs(21));
    think(&mut window);
    // The engine is stepped by frames here: far fewer of them than 20 s.
    for _ in 0..200 {
        window.pass(1);
        thread::sleep(Duration::from_millis(3));
    }
    assert!(!is_armed(&mut window), "off before it is seen again");
}

#[test]
fn a_device_that_fails_takes_the_permission_along() {
    let mut window = opened(with_pin(), FULL_HD, 1.0);
    stage(&mut window).machine.voltage.permit(true);
    window.pass(4);
    assert!(stage(&mut window).machine.voltage.is_permitted());
    window.dispatch(DeviceCommand::ConnectPort("/dev/null".into()));
    let is_forbidden = |window: &mut Headless| !stage(window).machine.voltage.is_permitted();
    wait(&mut window, is_forbidden, "forbidden by a failure");
}
