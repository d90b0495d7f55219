//! The emulator's contactors in the window: modelled while somebody looks, on a link in real time.

use egui_kittest::kittest::NodeT as _;

use super::*;

/// What the section says to those who do not see it; empty while it shows nothing.
fn words(harness: &Harness<'_, Workbench>) -> String {
    let found = harness.query_by_label_contains("Displacement of 24 contactors");
    found
        .and_then(|node| node.accesskit_node().label())
        .unwrap_or_default()
}

#[test]
fn contactors_move_while_armed_and_a_firm_finger_is_a_click_away() {
    let folder = Folder::new("contactors");
    let mut harness = window(&folder.scene());
    if std::env::var("BPH_PNG").is_ok() {
        harness.set_size(vec2(1500.0, 1700.0));
    }
    harness.state_mut().connect_emulator();
    wait(&mut harness, Workbench::is_ready);
    assert_eq!(words(&harness), "", "the section is closed");
    harness
        .get_by_label("Displacement by a model")
        .click_accesskit();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, "Arm").click();
    wait(&mut harness, Workbench::is_armed);
    let mut is_moving = false;
    for _ in 0..400 {
        stroke(&mut harness, 2);
        thread::sleep(Duration::from_millis(5));
        let words = words(&harness);
        is_moving |= words.contains("µm moved") && !words.contains("up to 0.0 µm moved");
        if is_moving {
            break;
        }
    }
    if let Ok(path) = std::env::var("BPH_PNG") {
        for _ in 0..10 {
            stroke(&mut harness, 1);
            thread::sleep(Duration::from_millis(20));
        }
        harness.render().unwrap().save(path).unwrap();
    }
    assert!(is_moving, "{}", words(&harness));
    harness.get_by_label("Firm").click_accesskit();
    harness.run_steps(2);
    assert!(
        harness
            .query_by_label_contains("skin firm (1000 N/m")
            .is_some()
    );
}
