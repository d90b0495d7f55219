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
fn contactors_are_shown_while_the_section_is_open_and_a_finger_is_a_click_away() {
    let folder = Folder::new("contactors");
    let mut harness = window(&folder.scene());
    harness.state_mut().connect_emulator();
    wait(&mut harness, Workbench::is_ready);
    assert_eq!(words(&harness), "", "the section is closed");
    harness.get_by_label("Developer tools").click_accesskit();
    harness.run_steps(2);
    let title = "Displacement by a model";
    harness.get_by_label(title).click_accesskit();
    for _ in 0..400 {
        harness.run_steps(1);
        if !words(&harness).is_empty() {
            break;
        }
        thread::sleep(Duration::from_millis(5));
    }
    assert!(
        words(&harness).contains("at 40 Hz up to 0.0 µm moved"),
        "at rest"
    );
    let has =
        |harness: &Harness<'_, Workbench>, words| harness.query_by_label_contains(words).is_some();
    assert!(has(&harness, "skin light (200 N/m"));
    harness.get_by_label("Firm").click_accesskit();
    harness.run_steps(2);
    assert!(has(&harness, "skin firm (1000 N/m"), "another finger");
    harness.get_by_label(title).click_accesskit();
    harness.run_steps(20);
    assert_eq!(words(&harness), "", "closed again");
}
