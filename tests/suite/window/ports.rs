//! Ports that are busy and devices that vanish: a notice with the mend, and the last state stays.

use eframe::egui::Event;
use eframe::egui::accesskit::Role;
use serialport::{SerialPort as _, TTYPort};

use super::*;
use crate::bridge_device::Device;

/// Types a port into the bridge pane and asks to connect.
fn connect(harness: &mut Harness<'_, Workbench>, port: &str) {
    harness.get_by_label("Port").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text(port.to_owned()));
    harness.step();
    press(harness, Modifiers::NONE, Key::Enter);
}

fn has_notice(harness: &Harness<'_, Workbench>, words: &[&str]) -> bool {
    let notices = harness.state().notices();
    let says = |notice: &String| words.iter().all(|word| notice.contains(word));
    notices.iter().any(says)
}

#[test]
fn a_port_that_another_program_holds_is_a_notice_and_the_last_state_stays() {
    let folder = Folder::new("busy");
    let mut harness = window(&folder.scene());
    harness.run();
    let (_master, mut held) = TTYPort::pair().unwrap();
    // A shared lock on the terminal: nobody else gets one of their own.
    held.set_exclusive(false).unwrap();
    let port = held.name().unwrap();
    connect(&mut harness, &port);
    wait(&mut harness, |bench| !bench.notices().is_empty());
    assert!(
        has_notice(&harness, &[&port, "another program"]),
        "{:?}",
        harness.state().notices()
    );
    assert!(!harness.state().is_ready() && !harness.state().is_stopped());
    stroke(&mut harness, 20);
    assert!(loudest_um(&harness) > 0.1, "the scene is still felt");
    harness.state_mut().connect_emulator();
    wait(&mut harness, Workbench::is_ready);
}

#[test]
fn a_device_that_vanishes_while_armed_is_a_notice_and_can_be_connected_again() {
    let folder = Folder::new("vanishing");
    let link = folder.path("array");
    let port = link.to_str().unwrap();
    let mut device = Device::behind(&link);
    let mut harness = window(&folder.scene());
    harness.run();
    connect(&mut harness, port);
    wait(&mut harness, Workbench::is_ready);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
    device.vanish();
    wait(&mut harness, |bench| !bench.is_armed());
    wait(&mut harness, |bench| {
        bench.notices().iter().any(|notice| notice.contains("gone"))
    });
    assert!(
        has_notice(&harness, &[port, "gone"]),
        "{:?}",
        harness.state().notices()
    );
    stroke(&mut harness, 20);
    assert!(loudest_um(&harness) > 0.1, "the scene is still felt");
    assert!(!harness.state().is_ready(), "and arming is refused");
    let _again = Device::behind(&link);
    connect(&mut harness, port);
    wait(&mut harness, Workbench::is_ready);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
}

#[test]
fn a_device_that_comes_back_under_another_name_is_told_and_connects_with_one_click() {
    let folder = Folder::new("replugged");
    let (link, other) = (folder.path("array"), folder.path("array-2"));
    let mut device = Device::behind(&link);
    let mut harness = window(&folder.scene());
    harness.run();
    connect(&mut harness, link.to_str().unwrap());
    wait(&mut harness, Workbench::is_ready);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
    device.vanish();
    // A killed emulator leaves its link, which would lead to whatever terminal comes next.
    fs::remove_file(&link).unwrap();
    wait(&mut harness, |bench| {
        bench.notices().iter().any(|notice| notice.contains("gone"))
    });
    let again = harness.query_by_role_and_label(Role::Button, "Connect again");
    assert!(again.is_none(), "it is away");
    let _back = Device::behind(&other);
    wait(&mut harness, |bench| {
        let is_back = |notice: &String| notice.contains("The array is back as");
        bench.notices().iter().any(is_back)
    });
    assert!(has_notice(&harness, &["array-2", "connect again"]));
    assert!(!harness.state().is_ready(), "nothing connects by itself");
    harness
        .get_by_role_and_label(Role::Button, "Connect again")
        .click();
    wait(&mut harness, Workbench::is_ready);
    harness.run_steps(20);
    assert!(!harness.state().is_armed(), "and nothing arms by itself");
}
