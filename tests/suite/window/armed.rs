//! What shows that a device is armed, and what stops it.

use super::*;

/// An armed emulator in a window.
fn armed<'a>(folder: &Folder) -> Harness<'a, Workbench> {
    let mut harness = window(&folder.scene());
    harness.state_mut().connect_emulator();
    wait(&mut harness, Workbench::is_ready);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
    harness.step();
    harness
}

/// Whether the window's edge is red all around.
fn is_framed_in_red(harness: &mut Harness<'_, Workbench>) -> bool {
    let picture = harness.render().unwrap();
    let (right, bottom) = (picture.width() - 2, picture.height() - 2);
    let middle = [right / 2, bottom / 2];
    let places = [
        [2, 2],
        [right, bottom],
        [middle[0], 2],
        [2, middle[1]],
        [right, middle[1]],
    ];
    places.into_iter().all(|[x, y]| {
        let [red, green, blue, _] = picture.get_pixel(x, y).0;
        red > 150 && green < 100 && blue < 100
    })
}

#[test]
fn an_armed_window_is_framed_in_red_and_a_stopped_one_is_not() {
    let folder = Folder::new("armed-frame");
    let mut harness = armed(&folder);
    assert!(harness.query_by_label("ARMED").is_some());
    assert!(is_framed_in_red(&mut harness));
    harness.key_press(Key::Escape);
    wait(&mut harness, |bench| {
        bench.is_stopped() && !bench.is_armed()
    });
    harness.step();
    assert!(harness.query_by_label("ARMED").is_none());
    assert!(!is_framed_in_red(&mut harness));
}

#[test]
fn a_window_that_loses_the_focus_stops_the_device_only_if_it_is_asked_to() {
    let folder = Folder::new("armed-focus");
    let mut harness = armed(&folder);
    harness.input_mut().focused = false;
    harness.step();
    harness.input_mut().focused = true;
    harness.step();
    assert!(harness.state().is_armed() && !harness.state().is_stopped());
    let words = "All off when the focus is lost";
    harness.get_by_label(words).click_accesskit();
    harness.step();
    harness.step();
    harness.input_mut().focused = false;
    wait(&mut harness, |bench| {
        bench.is_stopped() && !bench.is_armed()
    });
}
