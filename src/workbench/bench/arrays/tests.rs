//! The walk over the channels in a window with an emulated device, from its beginning to a profile.

use std::time::Duration;

use eframe::egui::vec2;

use crate::bench::arrays::wizard::WizardCommand;
use crate::bench::command::array::ArrayCommand;
use crate::bench::command::device::DeviceCommand;
use crate::bench::view::BridgePhase;
use crate::shell::headless::Headless;
use selvedge_device::DeviceUid;
use selvedge_device::wiring::Answer;
use selvedge_textile::tactile::Band;

/// Runs frames until the window shows what must come, for as long as a busy machine may take.
fn wait(window: &mut Headless, what: &str, is_there: impl Fn(&Headless) -> bool) {
    for _ in 0..2000 {
        window.pass(1);
        if is_there(window) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!(
        "{what} did not come: {:?}",
        window.workbench.bench.live.bridge
    );
}

fn wait_for(window: &mut Headless, phase: BridgePhase) {
    wait(window, &format!("{phase:?}"), |window| {
        let bridge = window.workbench.bench.live.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.phase == phase)
    });
}

fn do_array(window: &mut Headless, command: WizardCommand) {
    window.dispatch(ArrayCommand::Identify(command));
}

#[test]
fn the_walk_over_a_connected_device_ends_in_a_profile() {
    let mut window = Headless::new(None, vec2(960.0, 600.0), 1.0).unwrap();
    window.pass(1);
    do_array(&mut window, WizardCommand::Begin);
    assert!(
        window.workbench.bench.device.arrays.wizard.is_none(),
        "no device"
    );
    assert!(window.workbench.notices()[0].contains("ready and not armed"));
    window.dispatch(DeviceCommand::ConnectEmulator);
    wait_for(&mut window, BridgePhase::Ready);
    do_array(&mut window, WizardCommand::Begin);
    window.dispatch(DeviceCommand::Arm);
    // From here on the device takes IDENT; while it is being armed it would be refused.
    wait(&mut window, "arming", |window| {
        window.workbench.bench.live.takes_ident()
    });
    do_array(&mut window, WizardCommand::Drive(None));
    while let Some(channel) = walked(&window) {
        wait(&mut window, "the channel", |window| {
            let wizard = window.workbench.bench.device.arrays.wizard.as_ref();
            wizard.is_some_and(|wizard| wizard.driven == Some(channel))
        });
        let answer = match channel {
            3 => Answer::Contactor(4),
            4 => Answer::Contactor(3),
            17 => Answer::Nothing,
            channel => Answer::Contactor(channel),
        };
        do_array(&mut window, WizardCommand::Answer(answer));
    }
    let bridge = window.workbench.bench.live.bridge.as_ref().unwrap();
    assert_eq!(bridge.frames_sent, 0, "nothing else was played");
    // A limit that rises waits for the end of the walk, which disarms.
    window.dispatch(ArrayCommand::Limit(Band::Low, 20.0));
    window.dispatch(ArrayCommand::Limit(Band::Low, 10.0));
    window.pass(1);
    window.dispatch(ArrayCommand::Limit(Band::Low, 30.0));
    window.pass(2);
    assert!(window.workbench.bench.device.arrays.waits);
    assert_eq!(window.workbench.bench.engine.profile().limit_um[0], 10.0);
    do_array(&mut window, WizardCommand::Keep);
    wait_for(&mut window, BridgePhase::Ready);
    window.pass(3);
    let profile = window.workbench.bench.engine.profile();
    let wiring = profile.wiring.as_ref().unwrap();
    assert_eq!(wiring.device_uid, DeviceUid(*b"selvedge-emu"));
    assert_eq!(wiring.channels[2..6], [2, 4, 3, 5]);
    assert!(profile.calibration_of(17).is_off);
    assert_eq!(profile.limit_um[0], 30.0, "what waited");
    assert!(
        window.workbench.bench.device.arrays.wizard.is_none()
            && !window.workbench.bench.device.arrays.waits
    );
}

fn walked(window: &Headless) -> Option<usize> {
    window
        .workbench
        .bench
        .device
        .arrays
        .wizard
        .as_ref()?
        .walk
        .channel()
}
