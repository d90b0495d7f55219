//! The pane under the hands of a simulated user: limits, gains, and the walk over the channels.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;

use crate::bench::arrays::wizard::{Wizard, WizardCommand};
use crate::bench::command::array::ArrayCommand;
use crate::bench::command::device::DeviceCommand;
use crate::bench::command::{Command, Commands, ShowCommand};
use crate::bench::sources::{SourcesView, SurfaceView};
use crate::bench::view::{BridgePhase, BridgeView, Dot, EngineView};
use crate::kit::theme;
use crate::tools::bridge::view::{ArrayView, BridgePane, SecondDevice};
use crate::tools::bridge::{Bridge, show_device};
use selvedge_device::wiring::Answer;
use selvedge_device::{
    ArrayProfile, BridgeEvent, Calibration, DeviceUid, FaultWords, LimiterState, Wiring,
};

const UID: DeviceUid = DeviceUid(*b"selvedge-emu");

/// Everything that the pane is drawn from.
pub(crate) struct Stage {
    live: EngineView,
    profile: ArrayProfile,
    wizard: Option<Wizard>,
    waits: bool,
    pub(crate) bridge: Bridge,
    pub(crate) sources: SourcesView,
    pub(crate) faults: Option<FaultWords>,
    /// That of a second display.
    second: Option<SecondDevice<'static>>,
}

impl Stage {
    pub(crate) fn new(phase: BridgePhase) -> Self {
        let bridge = BridgeView {
            state: if phase == BridgePhase::Armed {
                "armed"
            } else {
                "ready"
            },
            phase,
            uid: Some(UID),
            can_identify: true,
            depth: 1,
            ..BridgeView::default()
        };
        let held = Dot {
            limiter: LimiterState {
                limited: [true, false],
                ..LimiterState::default()
            },
            ..Dot::default()
        };
        let mut dots = vec![Dot::default(); 24];
        dots[3] = held;
        Self {
            live: EngineView {
                bridge: Some(bridge),
                dots,
                ..EngineView::default()
            },
            profile: ArrayProfile::default(),
            wizard: None,
            waits: false,
            bridge: Bridge::default(),
            sources: SourcesView::default(),
            faults: Some(FaultWords::default()),
            second: None,
        }
    }

    pub(crate) fn show(&mut self, ui: &mut eframe::egui::Ui, commands: &mut Commands) {
        let view = BridgePane {
            live: &self.live,
            target: Some("Emulator"),
            second: self.second,
            array: ArrayView {
                profile: &self.profile,
                places_mm: self.profile.places_mm(),
                is_own: false,
                choices: vec![("exeter-24".to_owned(), false), ("rig 2".to_owned(), true)],
                waits: self.waits,
                contactor: Some(9),
                wizard: self.wizard.as_ref(),
                folder: None,
            },
            sources: &self.sources,
            has_actuator_model: false,
            faults: self.faults.as_ref(),
            trouble: None,
            has_developer_tools: true,
            stops_on_focus_loss: false,
        };
        show_device(ui, &view, commands);
        self.bridge.show(ui, &view, commands);
    }
}

pub(crate) fn window(mut stage: Stage) -> Harness<'static, Commands> {
    let mut is_styled = false;
    let mut harness = Harness::builder()
        .with_size(vec2(340.0, 1000.0))
        .build_ui_state(
            move |ui, commands: &mut Commands| {
                if !is_styled {
                    theme::install(ui.ctx());
                    is_styled = true;
                }
                stage.show(ui, commands);
                commands.retain(|wish| !matches!(wish, Command::Show(ShowCommand::Hover(_))));
            },
            Commands::new(),
        );
    harness.run();
    harness
}

pub(crate) fn click(harness: &mut Harness<'_, Commands>, role: Role, name: &str) -> Vec<Command> {
    harness.state_mut().clear();
    harness.get_by_role_and_label(role, name).click();
    harness.run();
    std::mem::take(harness.state_mut())
}

fn array(wish: &Command) -> Option<&ArrayCommand> {
    match wish {
        Command::Device(DeviceCommand::Array(command)) => Some(command),
        _ => None,
    }
}

#[test]
fn a_second_display_has_a_device_of_its_own() {
    let harness = window(Stage::new(BridgePhase::Ready));
    assert!(harness.query_by_label_contains("Second display").is_none());
    let stage = Stage {
        second: Some(SecondDevice::default()),
        ..Stage::new(BridgePhase::Ready)
    };
    let mut harness = window(stage);
    let emulated = click(&mut harness, Role::Button, "Emulator");
    assert_eq!(emulated, [DeviceCommand::ConnectSecond(None).into()]);
    let field = harness.get_by_role_and_label(Role::TextInput, "Port of the second display");
    field.focus();
    harness.run();
    harness.event(eframe::egui::Event::Text("/dev/ttyACM1".to_owned()));
    harness.run();
    harness.state_mut().clear();
    harness.key_press(Key::Enter);
    harness.run();
    let expected = DeviceCommand::ConnectSecond(Some("/dev/ttyACM1".into()));
    assert_eq!(*harness.state(), [expected.into()]);
}

#[test]
fn parts_fold_away_and_show_what_matters() {
    let mut harness = window(Stage::new(BridgePhase::Ready));
    assert!(
        harness.query_by_label("Profile").is_none(),
        "folded at first"
    );
    click(&mut harness, Role::Button, "Array");
    harness.get_by_label("Profile");
    click(&mut harness, Role::Button, "Array");
    assert!(harness.query_by_label("Profile").is_none(), "folded again");
    harness.get_by_label("Frames sent");
}

#[test]
fn a_gain_is_changed_by_the_keyboard_and_its_contactor_chosen_everywhere() {
    let mut harness = window(Stage::new(BridgePhase::Ready));
    click(&mut harness, Role::Button, "Array");
    click(&mut harness, Role::Button, "Calibration");
    click(&mut harness, Role::SpinButton, "Drive gain of contactor 7");
    harness.key_press(Key::A);
    harness.state_mut().clear();
    harness.event(eframe::egui::Event::Text("1.25".to_owned()));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    let changes: Vec<&ArrayCommand> = harness.state().iter().filter_map(array).collect();
    let is_of_7 = |change: &&ArrayCommand| {
        matches!(change, ArrayCommand::Calibrate(7, calibration)
            if calibration.drive_gain[0] > 1.2 && !calibration.is_off)
    };
    assert!(
        changes.iter().copied().any(|change| is_of_7(&change)),
        "{changes:?}"
    );
    let off = click(
        &mut harness,
        Role::CheckBox,
        "Never drive this contactor: dead, or better left alone",
    );
    let expected = Calibration {
        is_off: true,
        ..Calibration::default()
    };
    assert_eq!(off, [ArrayCommand::Calibrate(9, expected).into()]);
}

#[test]
fn the_wiring_of_another_device_is_doubted() {
    let mut stage = Stage::new(BridgePhase::Ready);
    stage.profile.wiring = Some(Wiring {
        device_uid: DeviceUid([1; 12]),
        channels: (0..24).collect(),
    });
    let mut harness = window(stage);
    click(&mut harness, Role::Button, "Array");
    click(&mut harness, Role::Button, "Wiring");
    harness.get_by_label_contains("is another one");
    let begun = click(&mut harness, Role::Button, "Identify channels…");
    assert_eq!(begun, [ArrayCommand::Identify(WizardCommand::Begin).into()]);
}

#[test]
fn the_walk_waits_for_arming_and_takes_clicks_on_the_array() {
    let mut stage = Stage::new(BridgePhase::Ready);
    stage.wizard = Some(Wizard::new(24, UID));
    let mut harness = window(stage);
    harness.get_by_label_contains("Arm the device to begin");
    assert_eq!(click(&mut harness, Role::Button, "It was contactor 5"), []);

    let mut stage = Stage::new(BridgePhase::Armed);
    let mut wizard = Wizard::new(24, UID);
    wizard.hear(&BridgeEvent::Identified { channel: 0 });
    stage.wizard = Some(wizard);
    let mut harness = window(stage);
    harness.get_by_label_contains("Channel 0 moved. Which contactor was it?");
    let answered = click(&mut harness, Role::Button, "It was contactor 5");
    let answer = WizardCommand::Answer(Answer::Contactor(5));
    assert_eq!(answered, [ArrayCommand::Identify(answer).into()]);
    let nothing = click(&mut harness, Role::Button, "Nothing");
    let answer = WizardCommand::Answer(Answer::Nothing);
    assert_eq!(nothing, [ArrayCommand::Identify(answer).into()]);
}

/// Writes pictures of the pane where `SELVEDGE_PICTURES` says, for people to look at.
#[test]
fn the_pane_is_drawn_in_every_state() {
    let mut calibrated = Stage::new(BridgePhase::Ready);
    for (contactor, gain) in [(2, 1.25), (9, 0.8), (14, 2.0)] {
        let calibration = Calibration {
            drive_gain: [gain, 1.1],
            is_off: contactor == 14,
        };
        calibrated.profile.set_calibration(contactor, calibration);
    }
    calibrated.profile.limit_um = [30.0, 20.0];
    let mut channels: Vec<u16> = (0..24).collect();
    channels.swap(3, 4);
    calibrated.profile.wiring = Some(Wiring {
        device_uid: DeviceUid([1; 12]),
        channels,
    });
    calibrated.waits = true;
    let mut walking = Stage::new(BridgePhase::Armed);
    let mut wizard = Wizard::new(24, UID);
    for contactor in [0, 1, 2, 4, 3, 5, 6, 8, 8] {
        wizard.walk.answer(Answer::Contactor(contactor));
    }
    wizard.hear(&BridgeEvent::Identified { channel: 9 });
    walking.wizard = Some(wizard);
    let mut found = Stage::new(BridgePhase::Armed);
    let mut wizard = Wizard::new(24, UID);
    while let Some(channel) = wizard.walk.channel() {
        wizard.walk.answer(match channel {
            3 => Answer::Contactor(4),
            4 => Answer::Contactor(3),
            17 => Answer::Nothing,
            channel => Answer::Contactor(channel),
        });
    }
    found.wizard = Some(wizard);
    let stages = vec![
        ("folded", Stage::new(BridgePhase::Ready)),
        ("open", calibrated),
        ("walking", walking),
        ("found", found),
        ("faults", faulty(true)),
        ("faults-light", faulty(true)),
        ("faults-none", faulty(false)),
        ("surface", tablet()),
    ];
    for (name, mut stage) in stages {
        let pixels = picture(name, &mut stage);
        let ground = pixels[0..4].to_vec();
        let n_inked = pixels.chunks(4).filter(|pixel| *pixel != ground).count();
        assert!(n_inked > 2_000, "{name}: {n_inked} pixels are not ground");
    }
}

/// A tablet that was laid over a part of the workspace, and a log.
fn tablet() -> Stage {
    let mut stage = Stage::new(BridgePhase::Ready);
    stage.sources.surface = Some(SurfaceView {
        name: "Wacom Intuos Pro M Pen".to_owned(),
        area_mm: [-22.0, 62.5, 216.0, 135.0],
        is_own: true,
    });
    if let Some(bridge) = &mut stage.live.bridge {
        bridge.timing.log = Some("/home/ada/.local/share/selvedge/logs/bridge.csv".to_owned());
    }
    stage
}

#[test]
fn the_folder_of_the_log_is_opened_by_a_button() {
    let mut harness = window(tablet());
    click(&mut harness, Role::Button, "Timing");
    let opened = click(&mut harness, Role::Button, "Open folder");
    assert_eq!(opened, [DeviceCommand::OpenLogFolder.into()]);
}

/// An emulator whose cable is bad, or whose faults are none.
fn faulty(is_bad: bool) -> Stage {
    let mut stage = Stage::new(BridgePhase::Ready);
    if is_bad {
        let bad = [
            ("seed", "7"),
            ("drop", "0.01%"),
            ("unplug-at", "soon"),
            ("chatter", "on"),
        ];
        stage.bridge.faults = FaultWords::of(&bad);
        stage.faults = Some(FaultWords::of(&bad[..2]));
    }
    stage
}

/// The pane, 340 × 900 points, in the dark theme unless it is called after the light one.
fn picture(name: &str, stage: &mut Stage) -> Vec<u8> {
    use eframe::egui::{self, Pos2, RawInput, Rect};
    let ctx = egui::Context::default();
    theme::install(&ctx);
    ctx.set_theme(if name.ends_with("light") {
        egui::Theme::Light
    } else {
        egui::Theme::Dark
    });
    let size = vec2(340.0, 900.0);
    let mut rasteriser = crate::shell::raster::Rasteriser::default();
    let mut run = |rasteriser: &mut crate::shell::raster::Rasteriser| {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            ..RawInput::default()
        };
        let mut output = ctx.run_ui(input, |ui| {
            let palette = theme::Palette::in_ui(ui);
            let frame = egui::Frame::new().fill(palette.panel).inner_margin(12);
            egui::CentralPanel::default().frame(frame).show(ui, |ui| {
                let folds: &[(&str, bool)] = match name {
                    "open" => &[("Array", true), ("Calibration", true), ("Wiring", true)],
                    "faults" | "faults-light" => &[
                        ("Link", false),
                        ("Faults", true),
                        ("Bytes", true),
                        ("Clock", true),
                        ("Stalls and cable", true),
                    ],
                    "faults-none" => &[("Faults", true)],
                    "surface" => &[("Link", false), ("Timing", true), ("Input", true)],
                    _ => &[],
                };
                for (title, is_open) in folds {
                    let id = ui.scope_id().with(("fold", *title));
                    ui.data_mut(|data| data.insert_temp(id, *is_open));
                }
                stage.show(ui, &mut Commands::new());
            });
        });
        rasteriser.apply(&mut output.textures_delta);
        output
    };
    run(&mut rasteriser).drop_without_applying_deltas();
    let last = run(&mut rasteriser);
    let primitives = ctx.tessellate(last.shapes, last.pixels_per_point);
    let picture = rasteriser.draw(&primitives, [340, 900], 1.0, egui::Color32::BLACK);
    if let Ok(folder) = std::env::var("SELVEDGE_PICTURES") {
        let path = std::path::Path::new(&folder).join(format!("bridge-{name}.png"));
        let png =
            selvedge_foundation::files::encode_png_rgba(&picture.rgba, 340, 900, &path).unwrap();
        std::fs::write(&path, png).unwrap();
    }
    picture.rgba
}
