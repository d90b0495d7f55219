//! The hanging cloth in a window without a screen: time is simulated, and every press is one.

mod told;

use std::path::Path;

use eframe::egui::{Event, Id, Key, Modifiers, PointerButton, Pos2, Rect};

use super::*;
use crate::bench::command::PlayCommand;
use crate::bench::export::Exportable;
use crate::shell::headless::Headless;
use crate::tools::drape::hung::{ClothFrame, Second};
use selvedge_drape::{Drape, DrapeScene, HandPath};
use selvedge_scratch::ScratchFolder;

/// A window with the pane in sight, and the cloth at rest.
fn window() -> Headless {
    let mut desk = Headless::shipped();
    desk.dispatch(ShowCommand::Reveal(Pane::Drape));
    desk.pass(40);
    desk
}

fn tool(desk: &mut Headless) -> &mut Draping {
    desk.workbench.tools.get_mut().unwrap()
}

fn t_s(desk: &mut Headless) -> f64 {
    tool(desk)
        .motion
        .frames
        .back()
        .map_or(0.0, |frame| frame.t_s)
}

fn cloth(desk: &mut Headless) -> ClothFrame {
    tool(desk).motion.frames.back().unwrap().cloths[0].clone()
}

/// Where the cloth is drawn.
fn place(desk: &Headless) -> Rect {
    desk.ctx
        .read_response(Id::unique(view::CLOTH))
        .unwrap()
        .rect
}

fn go_to(desk: &mut Headless, at: Pos2) {
    desk.events.push(Event::PointerMoved(at));
    desk.pass(1);
}

fn button(desk: &mut Headless, pos: Pos2, pressed: bool, modifiers: Modifiers) {
    desk.events.push(Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers,
    });
    desk.pass(1);
}

/// Closes on the middle of the cloth's view, and waits.
fn pinched() -> (Headless, Pos2) {
    let mut desk = window();
    let at = place(&desk).center();
    go_to(&mut desk, at);
    desk.pass(20);
    button(&mut desk, at, true, Modifiers::NONE);
    desk.pass(30);
    (desk, at)
}

#[test]
fn nothing_is_stepped_before_it_is_looked_at_nor_while_it_rests() {
    let mut desk = Headless::shipped();
    desk.pass(4);
    assert!(tool(&mut desk).motion.frames.is_empty());
    let empty = desk.workbench.exported(Exportable::Pane(Pane::Drape));
    assert!(empty.unwrap_err().contains("touch the cloth"));
    let mut desk = window();
    let rest_s = t_s(&mut desk);
    assert!(rest_s > 0.4, "it falls asleep by itself: {rest_s}");
    let mut output = desk.run();
    let delays = output.viewport_output.values();
    assert!(
        delays
            .min_by_key(|view| view.repaint_delay)
            .unwrap()
            .repaint_delay
            .as_secs()
            > 0
    );
    output.textures_delta.clear();
    desk.pass(40);
    assert_eq!(t_s(&mut desk), rest_s, "asleep");
    desk.dispatch(ShowCommand::Reveal(Pane::Workspace));
    tool(&mut desk).motion.restart();
    desk.pass(10);
    assert_eq!(t_s(&mut desk), rest_s, "nobody looks");
}

#[test]
fn a_press_pinches_a_drag_slips_and_letting_go_leaves_nothing() {
    let (mut desk, at) = pinched();
    let held = cloth(&mut desk);
    for felt in &held.fingers {
        assert!(felt.n_contacts >= 12 && felt.press_n > 0.1, "{felt:?}");
    }
    let pushed = [0, 1].map(|nth| held.fingers[nth].force_n[2]);
    assert!(pushed[0] > 0.05 && pushed[1] < -0.05, "{pushed:?}");
    assert_eq!(held.mean_um(0), [0.0; 2], "held still it is silent");
    let mut most = 0.0_f64;
    for step in 1..24_u8 {
        let by = eframe::egui::vec2(3.0 * f32::from(step), 0.0);
        desk.events.push(Event::PointerMoved(at + by));
        desk.pass(1);
        most = most.max(cloth(&mut desk).mean_um(0)[1]);
    }
    assert!(most > 0.0, "what slips is felt");
    button(&mut desk, at, false, Modifiers::NONE);
    desk.pass(60);
    for felt in cloth(&mut desk).fingers {
        assert_eq!((felt.n_contacts, felt.press_n), (0, 0.0));
    }
}

#[test]
fn keys_do_all_that_the_pointer_does() {
    let mut desk = window();
    let at = place(&desk).center();
    button(&mut desk, at, true, Modifiers::NONE);
    button(&mut desk, at, false, Modifiers::NONE);
    desk.events.push(Event::PointerGone);
    desk.pass(2);
    let before = tool(&mut desk).hands.grasp.clone().unwrap();
    desk.press(Modifiers::NONE, Key::ArrowRight);
    desk.press(Modifiers::NONE, Key::ArrowUp);
    desk.press(Modifiers::SHIFT, Key::ArrowRight);
    desk.press(Modifiers::COMMAND, Key::ArrowDown);
    desk.press(Modifiers::NONE, Key::OpenBracket);
    let after = tool(&mut desk).hands.grasp.clone().unwrap();
    let moved = [0, 1, 2].map(|axis| after.centre_mm[axis] - before.centre_mm[axis]);
    assert!(moved.iter().all(|mm| (mm - 2.0).abs() < 1e-9), "{moved:?}");
    assert_eq!(after.shift_mm, [2.0, 0.0]);
    assert_eq!(after.open_mm, before.open_mm - 2.0);
    let camera = tool(&mut desk).look.camera;
    desk.press(Modifiers::ALT, Key::ArrowLeft);
    assert_ne!(tool(&mut desk).look.camera, camera);
    desk.press(Modifiers::NONE, Key::Enter);
    desk.pass(40);
    assert!(tool(&mut desk).hands.grasp.as_ref().unwrap().is_held);
    assert!(cloth(&mut desk).fingers[0].press_n > 0.05);
}

#[test]
fn figures_change_the_cloth_where_it_hangs_and_every_choice_is_a_step() {
    let (mut desk, _) = pinched();
    let moment = |press| Moment {
        press,
        ..Moment::default()
    };
    let before = cloth(&mut desk);
    let time_s = t_s(&mut desk);
    let key = "b_gf_cm2_per_cm";
    tool(&mut desk).change(moment(1), |draping| {
        draping.chosen.cloths[0].changes.push((key, 1.5));
    });
    desk.pass(2);
    let facts = Arc::clone(&tool(&mut desk).motion.facts);
    assert_eq!(
        (facts.cloths[0].scene.figure(key), &facts.refused),
        (Some(1.5), &None)
    );
    assert!(t_s(&mut desk) > time_s, "it goes on");
    let after = cloth(&mut desk);
    assert!(after.fingers[0].n_contacts > 8, "still held");
    let off = before.places_mm.iter().zip(&after.places_mm);
    let off = off.map(|(a, b)| (a[2] - b[2]).abs()).fold(0.0, f32::max);
    assert!(off < 3.0, "{off} mm: nothing leaps");
    tool(&mut desk).change(moment(2), |draping| draping.chosen.second = Second::Beside);
    tool(&mut desk).change(moment(3), |draping| {
        draping.chosen.cloths.push(ClothChoice::default());
    });
    desk.pass(2);
    let steps = desk.workbench.steps();
    assert_eq!(
        steps.names,
        [
            "figures of the cloth",
            "second finger",
            "cloths side by side"
        ]
    );
    assert_eq!(
        tool(&mut desk).motion.frames.back().unwrap().cloths.len(),
        2
    );
    desk.dispatch(Command::StepTo(0));
    desk.pass(2);
    let facts = Arc::clone(&tool(&mut desk).motion.facts);
    assert_eq!((facts.cloths.len(), tool(&mut desk).look.cloth), (1, 0));
    assert_ne!(facts.cloths[0].scene.figure(key), Some(1.5));
}

#[test]
fn a_recorded_hand_is_replayed_as_the_command_follows_it() {
    let mut desk = window();
    let draping = tool(&mut desk);
    draping.hands.toggle_recording(&draping.motion);
    let at = place(&desk).center();
    button(&mut desk, at, true, Modifiers::NONE);
    desk.pass(30);
    button(&mut desk, at, false, Modifiers::NONE);
    desk.pass(10);
    let draping = tool(&mut desk);
    draping.hands.toggle_recording(&draping.motion);
    let (name, length_s) = draping.hands.about_path().unwrap();
    assert!(name == "recorded" && length_s > 0.9, "{name} {length_s}");
    let folder = ScratchFolder::made("hands");
    let path = folder.join("fingers.csv");
    desk.dispatch(FileCommand::Use(Purpose::SaveHands, path.clone()));
    desk.dispatch(FileCommand::Use(Purpose::OpenHands, path.clone()));
    desk.pass(2);
    let draping = tool(&mut desk);
    assert_eq!(draping.hands.about_path().unwrap().0, "fingers.csv");
    draping.hands.replay(&mut draping.motion);
    desk.pass(80);
    assert!(tool(&mut desk).motion.is_over, "it ends");
    let scene = DrapeScene::shipped().unwrap();
    let hands = HandPath::read(&path, &scene).unwrap();
    let mut drape = Drape::new(&scene, None, None).unwrap();
    let mut now = drape.start_hands();
    hands.at(0.0, &mut now);
    drape.place(&now);
    let samples = &tool(&mut desk).motion.samples;
    let mut most = 0.0_f64;
    for (nth, sample) in samples.iter().enumerate() {
        hands.at(Drape::after_s(nth as u64 + 1, drape.step_s()), &mut now);
        drape.step(&now).unwrap();
        let [energy_j, _] = drape.energy_j();
        for (finger, row) in sample.rows.iter().enumerate() {
            let expected = drape.force_row(finger, energy_j);
            for (value, expected) in row.iter().zip(expected) {
                let off = (value - expected).abs();
                assert!(
                    off <= 1e-9 * expected.abs().max(1.0),
                    "{row:?} {expected:?}"
                );
            }
            most = most.max(row[5]);
        }
    }
    assert!(
        most > 8.0 && samples.len() > 400,
        "{most} {}",
        samples.len()
    );
    let exported = desk
        .workbench
        .exported(Exportable::Pane(Pane::Drape))
        .unwrap();
    let csv = exported.to_csv().unwrap();
    let header = csv.lines().find(|line| !line.starts_with('#')).unwrap();
    assert_eq!(header, Drape::FORCE_COLUMNS.join(","));
    assert_eq!(exported.figure.rows.len(), 4);
}

#[test]
fn a_closed_hand_finds_its_sides_of_a_cloth_that_is_hung_anew() {
    let (mut desk, _) = pinched();
    tool(&mut desk).motion.restart();
    desk.pass(30);
    assert!(t_s(&mut desk) < 1.0, "from the start");
    let held = cloth(&mut desk);
    let pushed = [0, 1].map(|nth| held.fingers[nth].force_n[2]);
    assert!(pushed[0] > 0.05 && pushed[1] < -0.05, "{pushed:?}");
}

#[test]
fn what_was_is_looked_back_at_while_the_cloth_waits() {
    let (mut desk, _) = pinched();
    let now_s = t_s(&mut desk);
    tool(&mut desk).look.looked_at_s = Some(0.1);
    desk.pass(10);
    assert_eq!(t_s(&mut desk), now_s);
    let looked_at = Arc::clone(tool(&mut desk).motion.frame_at(Some(0.1)).unwrap());
    assert!((looked_at.t_s - 0.1).abs() < 0.03);
    assert_eq!(
        looked_at.cloths[0].fingers[0].n_contacts, 0,
        "before the press"
    );
    tool(&mut desk).look.looked_at_s = None;
    desk.pass(4);
    assert!(t_s(&mut desk) > now_s);
}

#[test]
fn what_cannot_hang_is_one_line_and_what_hangs_stays() {
    let mut desk = window();
    let folder = ScratchFolder::made("drape-pane");
    let path = folder.write("odd.drape.toml", "name = \"odd\"\ntextile = \"velvet\"\n");
    desk.dispatch(FileCommand::Use(Purpose::OpenDrape, path));
    desk.pass(4);
    let facts = Arc::clone(&tool(&mut desk).motion.facts);
    let why = facts.refused.clone().unwrap();
    assert!(
        why.contains("odd.drape.toml:2") && !why.contains('\n'),
        "{why}"
    );
    assert_eq!(facts.cloths[0].title, "Denim under two fingers");
    let bare = "name = \"bare\"\ntextile = \"silk-crepe\"\nsize_mm = [80, 80]\n";
    let path = folder.write("bare.drape.toml", bare);
    desk.dispatch(FileCommand::Use(Purpose::OpenDrape, path));
    desk.pass(40);
    let facts = Arc::clone(&tool(&mut desk).motion.facts);
    assert_eq!(
        (facts.cloths[0].title.as_str(), &facts.refused),
        ("bare", &None)
    );
    assert!(facts.hands.is_empty(), "a cloth without fingers hangs too");
    let hands = folder.write("hands.csv", "t_s,x_mm\n0,0\n1,0\n");
    tool(&mut desk).chosen = Chosen::default();
    desk.pass(4);
    desk.dispatch(FileCommand::Use(Purpose::OpenHands, hands));
    desk.pass(2);
    let trouble = tool(&mut desk).hands.trouble.clone().unwrap();
    assert!(trouble.contains("no column"), "{trouble}");
    let unwritten = folder.join("missing").join("a.csv");
    desk.dispatch(FileCommand::Use(Purpose::SaveHands, unwritten));
    assert!(
        desk.workbench
            .notices()
            .join("")
            .contains("record them first")
    );
}

#[test]
fn a_textile_of_the_library_hangs_in_its_own_laws_beside_others() {
    let mut desk = window();
    let bench = &desk.workbench.bench;
    let textile = Draping::textile(bench, "silk-crepe");
    assert_eq!(
        (textile.id.as_str(), &textile.library),
        ("silk-crepe", &None)
    );
    tool(&mut desk).chosen.cloths.push(ClothChoice {
        textile: Some(textile),
        changes: Vec::new(),
    });
    desk.pass(60);
    let draping = tool(&mut desk);
    let facts = Arc::clone(&draping.motion.facts);
    let weights = [0, 1].map(|nth| facts.cloths[nth].scene.figure("weight_mg_per_cm2").unwrap());
    assert!(weights[0] > 3.0 * weights[1], "{weights:?}");
    let exported = desk
        .workbench
        .exported(Exportable::Pane(Pane::Drape))
        .unwrap();
    let csv = exported.to_csv().unwrap();
    let header = csv.lines().find(|line| !line.starts_with('#')).unwrap();
    assert!(header.starts_with("cloth,t_s,finger"), "{header}");
    assert!(Path::new(&exported.origin.pairs()[1].1).ends_with("denim.drape.toml"));
}

/// The loudest contactor of the first display as the engine plays it, µm.
fn played_um(desk: &mut Headless) -> f32 {
    let snapshot = desk.workbench.bench.engine.snapshot();
    let contactors = snapshot.displays[0].contactors.iter();
    let both = contactors.flat_map(|contactor| contactor.amplitude_um);
    both.fold(0.0, f32::max)
}

#[test]
fn the_device_feels_the_cloth_that_slips_and_the_scene_when_it_is_switched_off() {
    let (mut desk, at) = pinched();
    tool(&mut desk).through.is_on = true;
    desk.pass(4);
    assert!(desk.workbench.bench.engine.snapshot().rendering.is_cloth);
    assert_eq!(played_um(&mut desk), 0.0, "held still it is silent");
    let mut most = 0.0_f32;
    for step in 1..24_u8 {
        let by = eframe::egui::vec2(3.0 * f32::from(step), 0.0);
        desk.events.push(Event::PointerMoved(at + by));
        desk.pass(1);
        most = most.max(played_um(&mut desk));
    }
    assert!(most > 0.0, "what slips is played");
    let words = desk.workbench.bench.device.cloth.clone();
    assert!(words.is_some_and(|words| words.starts_with("a hanging cloth: ")));
    // Out of sight nothing is stepped, and nothing is felt.
    desk.dispatch(ShowCommand::Reveal(Pane::Workspace));
    desk.pass(12);
    assert_eq!(played_um(&mut desk), 0.0);
    tool(&mut desk).through.is_on = false;
    desk.pass(4);
    assert!(!desk.workbench.bench.engine.snapshot().rendering.is_cloth);
    assert_eq!(desk.workbench.bench.device.cloth, None);
}

#[test]
fn a_recording_is_felt_on_the_scene() {
    let (mut desk, _) = pinched();
    tool(&mut desk).through.is_on = true;
    desk.pass(4);
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass(4);
    assert!(desk.workbench.bench.live.play.is_recording);
    assert!(!tool(&mut desk).through.is_on);
    assert!(!desk.workbench.bench.engine.snapshot().rendering.is_cloth);
}
