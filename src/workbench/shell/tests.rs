//! Cards and menus under the hands of a simulated user.

use std::path::PathBuf;
use std::{fs, thread};

use eframe::egui::accesskit::Role;
use eframe::egui::epaint::{ClippedShape, Shape};
use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, Rect, TouchPhase, Ui, vec2,
};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::bench::command::device::DeviceCommand;
use crate::bench::command::{Command, Commands, FileCommand, Purpose};
use crate::bench::recovery::{Part, Unsaved};
use crate::bench::sources::SourcesView;
use crate::bench::view::EngineView;
use crate::kit::theme;
use crate::shell::ask::{Ask, show as show_ask};
use crate::shell::headless::Headless;
use crate::shell::help::show as show_help;
use crate::shell::question::show as show_question;
use crate::shell::state::{After, Question};
use crate::tools::bridge::Bridge;
use crate::tools::bridge::ports::PortsView;
use crate::tools::bridge::view::{ArrayView, BridgePane};
use selvedge_device::{ArrayProfile, FoundPort, RecognisedBy};
use selvedge_scratch::ScratchFolder;

/// A window with nothing in it but `content`, and what is wished for in it.
fn window<'a>(mut content: impl FnMut(&mut Ui, &mut Commands) + 'a) -> Harness<'a, Commands> {
    let mut is_styled = false;
    Harness::builder()
        .with_size(vec2(700.0, 500.0))
        .build_ui_state(
            move |ui, commands| {
                if !is_styled {
                    theme::install(ui.ctx());
                    is_styled = true;
                }
                content(ui, commands);
            },
            Commands::new(),
        )
}

fn click(harness: &mut Harness<'_, Commands>, name: &str) -> Vec<Command> {
    harness.state_mut().clear();
    harness.get_by_role_and_label(Role::Button, name).click();
    harness.run();
    std::mem::take(harness.state_mut())
}

#[test]
fn tab_completes_the_path_and_enter_opens_it() {
    let folder = ScratchFolder::made("ask");
    let scene = folder.join("silk.scene.toml");
    fs::write(&scene, "").unwrap();
    let mut ask = Ask::new(Purpose::OpenScene, Some(&folder.join("si")));
    let mut harness = window(|ui, commands| {
        let over = ui.max_rect();
        show_ask(ui, over, &mut ask, &[], commands);
    });
    harness.run();
    harness.key_press(Key::End);
    harness.run();
    harness.key_press(Key::Tab);
    let path = scene.display().to_string();
    for _ in 0..2_000 {
        harness.run();
        let field = harness.get_by_role_and_label(Role::TextInput, "Open scene");
        if field.value().as_deref() == Some(path.as_str()) {
            break;
        }
        thread::yield_now();
    }
    harness.key_press(Key::Enter);
    harness.run();
    let wanted = FileCommand::Use(Purpose::OpenScene, scene);
    assert_eq!(harness.state(), &[wanted.into()]);
    drop(harness);
}

#[test]
fn a_recent_scene_is_opened_by_a_click() {
    let recent = ["/a/silk.scene.toml", "/b/wool.scene.toml"].map(PathBuf::from);
    let mut ask = Ask::new(Purpose::OpenScene, None);
    let mut harness = window(|ui, commands| {
        let over = ui.max_rect();
        show_ask(ui, over, &mut ask, &recent, commands);
    });
    harness.run();
    let wool = harness.get_by_label_contains("wool.scene.toml");
    wool.click();
    harness.run();
    let wanted = FileCommand::Use(Purpose::OpenScene, recent[1].clone());
    assert_eq!(harness.state(), &[wanted.into()]);
}

#[test]
fn the_question_on_closing_has_three_answers_and_enter_saves() {
    let mut harness = window(|ui, commands| {
        let over = ui.max_rect();
        let unsaved = Unsaved::new("Scene “silk”".to_owned(), "1 step", &());
        let part = Part {
            owner: "Scene".to_owned(),
            unsaved,
        };
        let question = Question {
            after: After::Close,
            parts: vec![part],
        };
        show_question(ui, over, &question, commands);
    });
    harness.run();
    harness.get_by_label("Scene “silk”");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state(), &[FileCommand::SaveAll.into()]);
    assert_eq!(click(&mut harness, "Save"), [FileCommand::SaveAll.into()]);
    let unsaved = click(&mut harness, "Discard");
    assert_eq!(unsaved, [FileCommand::LetGo.into()]);
    assert_eq!(click(&mut harness, "Cancel"), [Command::Dismiss]);
}

#[test]
fn the_list_of_keys_names_a_key_and_can_be_put_away() {
    let mut list = crate::shell::help::KeyList::default();
    let mut chosen = crate::bench::chosen_keys::ChosenKeys::new();
    let mut harness = window(|ui, commands| {
        let over = ui.max_rect();
        show_help(ui, over, &mut list, &mut chosen, commands);
    });
    harness.run();
    harness.get_by_label("Ctrl+O, the key of “Open a scene…”");
    assert_eq!(click(&mut harness, "Close"), [Command::Dismiss]);
}

/// The pane of the device, with nothing connected.
fn bridge_window(ports: PortsView) -> Harness<'static, Commands> {
    let mut bridge = Bridge::with_ports(ports);
    window(move |ui, commands| {
        let profile = ArrayProfile::default();
        let view = BridgePane {
            live: &EngineView::default(),
            target: None,
            second: None,
            array: ArrayView {
                profile: &profile,
                places_mm: profile.places_mm(),
                is_own: false,
                choices: Vec::new(),
                waits: false,
                contactor: None,
                wizard: None,
                folder: None,
            },
            sources: &SourcesView::default(),
            has_actuator_model: false,
            faults: None,
            trouble: None,
            has_developer_tools: false,
            stops_on_focus_loss: false,
        };
        bridge.show(ui, &view, commands);
    })
}

#[test]
fn opening_the_menu_lists_ports_and_choosing_one_connects() {
    let ports = PortsView {
        is_known: true,
        ports: vec![("/dev/ttyACM0".to_owned(), "Array bridge".to_owned())],
        ..PortsView::default()
    };
    let mut harness = bridge_window(ports);
    harness.run();
    let listed = click(&mut harness, "Choose a port");
    assert_eq!(listed, [], "they are listed by the pane itself");
    harness.get_by_label_contains("Array bridge").click();
    harness.run();
    let path = PathBuf::from("/dev/ttyACM0");
    let connected = DeviceCommand::ConnectPort(path.clone());
    assert_eq!(harness.state(), &[connected.into()]);
    assert!(
        harness.query_by_label_contains("Array bridge").is_none(),
        "it closed"
    );
    let again = click(&mut harness, "Connect");
    assert_eq!(again, [DeviceCommand::ConnectPort(path).into()]);
}

#[test]
fn a_device_that_is_back_is_connected_with_one_click_and_not_armed() {
    let path = PathBuf::from("/dev/ttyACM1");
    let ports = PortsView {
        back: Some(FoundPort {
            path: path.clone(),
            by: RecognisedBy::UsbSerial,
        }),
        ..PortsView::default()
    };
    let mut harness = bridge_window(ports);
    harness.run();
    harness.get_by_label("The array is back as /dev/ttyACM1");
    let asked = click(&mut harness, "Connect again");
    assert_eq!(asked, [DeviceCommand::ConnectPort(path).into()]);
}

/// Where a text is drawn, if all of it is in sight.
fn place_of(shape: &ClippedShape, text: &str) -> Option<Rect> {
    let Shape::Text(letters) = &shape.shape else {
        return None;
    };
    let place = letters.galley.rect.translate(letters.pos.to_vec2());
    let is_it = letters.galley.text() == text && shape.clip_rect.contains_rect(place);
    is_it.then_some(place)
}

#[test]
fn arming_stays_in_sight_however_far_the_pane_of_the_device_is_scrolled() {
    let mut window = Headless::shipped();
    window.pass(5);
    let places = |window: &mut Headless| {
        let output = window.run();
        let found = ["Arm", "Connect"]
            .map(|text| output.shapes.iter().find_map(|shape| place_of(shape, text)));
        output.drop_without_applying_deltas();
        found
    };
    let [arm, scrolled] = places(&mut window);
    let (arm, below) = (arm.unwrap(), scrolled.unwrap());
    for _ in 0..10 {
        window.events.push(Event::PointerMoved(below.center()));
        window.events.push(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, -200.0),
            source: MouseWheelSource::Unknown,
            phase: TouchPhase::Move,
            modifiers: Modifiers::NONE,
        });
        window.pass(4);
    }
    let [still, away] = places(&mut window);
    assert_eq!(still, Some(arm));
    assert_ne!(away, Some(below), "the rest was scrolled");
}
