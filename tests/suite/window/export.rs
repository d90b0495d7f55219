//! Exporting from the window: the button of a pane, its menu, the field, the file.

use std::fs;

use eframe::egui::OutputCommand;
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

use super::*;

fn choose(harness: &mut Harness<'_, Workbench>, button: &str, entry: &str) {
    harness
        .get_by_role_and_label(Role::Button, button)
        .click_accesskit();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, entry).click();
    harness.run_steps(5);
}

#[test]
fn a_pane_is_saved_from_its_button_as_the_kind_that_was_typed() {
    let folder = Folder::new("export");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 30);
    for (button, name, begins) in [
        ("Export Contact spectrum", "a.png", b"\x89PNG".as_slice()),
        ("Export Contactors", "b.svg", b"<svg xmlns"),
        ("Export Spatial spectra", "c.csv", b"# program = selvedge"),
        ("Export Timeline", "d.csv", b"# program = selvedge"),
        ("Export Drive waveform", "e.svg", b"<svg xmlns"),
        ("Export Compression curve", "f.png", b"\x89PNG"),
    ] {
        choose(&mut harness, button, "Save as PNG, SVG or CSV…");
        let field = harness.get_by_role_and_label(Role::TextInput, "Export as PNG, SVG or CSV");
        let suggested = field.value().unwrap_or_default();
        assert!(
            suggested.starts_with(&folder.path("").display().to_string()),
            "{suggested}"
        );
        let path = folder.path(name);
        type_path(&mut harness, &path.display().to_string());
        let bytes = fs::read(&path).unwrap_or_default();
        assert!(
            bytes.starts_with(begins),
            "{button}: {:?}",
            harness.state().notices()
        );
    }
    let notices = harness.state().notices();
    let is_done = |notice: &String| notice.ends_with(" is written");
    assert!(
        !notices.is_empty() && notices.iter().all(is_done),
        "{notices:?}"
    );
}

#[test]
fn a_map_over_the_cloth_is_exported_and_without_one_it_is_said_how_to_show_it() {
    let folder = Folder::with_size("map", [40.0, 30.0]);
    let mut harness = window(&folder.scene());
    harness.run();
    let button = "Export Map over the cloth";
    choose(&mut harness, button, "Save as PNG, SVG or CSV…");
    let notices = harness.state().notices().join("\n");
    assert!(
        notices.contains("show a map over the cloth first"),
        "{notices}"
    );
    press(&mut harness, Modifiers::NONE, Key::K);
    choose(&mut harness, button, "Save as PNG, SVG or CSV…");
    let path = folder.path("map.csv");
    type_path(&mut harness, &path.display().to_string());
    let table = fs::read_to_string(&path).unwrap();
    let rows: Vec<&str> = table
        .lines()
        .filter(|line| !line.starts_with('#'))
        .collect();
    assert!(
        rows[0].starts_with("textile,u_mm,w_mm,amplitude_um,"),
        "{}",
        rows[0]
    );
    assert_eq!(rows.len() - 1, 41 * 31, "a point every millimetre");
    assert!(rows.iter().skip(1).all(|row| row.starts_with("ripple,")));
}

#[test]
fn a_table_is_copied_from_its_button() {
    let folder = Folder::new("copy");
    let mut harness = window(&folder.scene());
    harness.run();
    stroke(&mut harness, 10);
    harness
        .get_by_role_and_label(Role::Button, "Export Contactors")
        .click();
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::Button, "Copy as CSV")
        .click();
    let mut copied = String::new();
    for _ in 0..4 {
        harness.step();
        for command in &harness.output().platform_output.commands {
            if let OutputCommand::CopyText(text) = command {
                copied.clone_from(text);
            }
        }
    }
    assert!(copied.contains("\ncontactor,row,column,x_mm,"), "{copied}");
}

#[test]
fn before_anything_is_felt_the_button_says_what_to_do() {
    let folder = Folder::new("nothing");
    let mut harness = window(&folder.scene());
    harness.run();
    for name in ["Export Contact spectrum", "Save as PNG, SVG or CSV…"] {
        // By its name alone: no pointer moves over the window.
        let button = harness.get_by_role_and_label(Role::Button, name);
        button.click_accesskit();
        harness.run_steps(4);
    }
    let notices = harness.state().notices().join("\n");
    assert!(notices.contains("move over a textile"), "{notices}");
}
