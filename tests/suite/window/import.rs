//! The import pane: from files of a tester or of a profilometer to textiles in the library.

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

use super::*;

/// Both ways over 30 mm, by place, and the friction.
fn export() -> String {
    let mut text = String::from("KES-FB4\n\ndistance mm;forward um;return um;mu\n");
    for i in 0..1500_u16 {
        let x_mm = f64::from(i) * 0.02;
        let calm = if (8.0..28.0).contains(&x_mm) {
            1.0
        } else {
            1.6
        };
        let z = calm * 6.0 * (15.0 * x_mm).sin() + 3.0 * (0.7 * x_mm * x_mm).sin();
        let mu = 0.21 + 0.02 * (9.0 * x_mm).sin();
        writeln!(text, "{x_mm:.2};{z:.3};{:.3};{mu:.4}", z + 0.5).unwrap();
    }
    text
}

/// 300 × 200 heights, rougher from row to row, without a word about units.
fn matrix() -> String {
    let mut text = String::new();
    for row in 0..200_u16 {
        let height = |column: u16| {
            (5.0 + 0.05 * f64::from(row)) * (f64::from(column) * 0.3).sin()
                + f64::from(row % 40) * 0.1
        };
        let cells: Vec<String> = (0..300)
            .map(|column| format!("{:.4}", height(column)))
            .collect();
        text.push_str(&cells.join("\t"));
        text.push('\n');
    }
    text
}

fn with_file(folder: &Folder, name: &str, content: &str) -> (Harness<'static, Workbench>, PathBuf) {
    let path = folder.path(name);
    fs::write(&path, content).unwrap();
    let mut harness = window(&folder.scene());
    harness.run();
    click_tab(&mut harness, "Import");
    harness.state_mut().import_file(path.clone());
    harness.run_steps(4);
    (harness, path)
}

fn choose(harness: &mut Harness<'_, Workbench>, list: &str, entry: &str) {
    harness.get_by_role_and_label(Role::ComboBox, list).click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Button, entry).click();
    harness.run_steps(4);
}

#[test]
fn an_empty_pane_says_what_to_do_and_asks_for_files() {
    let folder = Folder::new("import-empty");
    let mut harness = window(&folder.scene());
    harness.run();
    click_tab(&mut harness, "Import");
    harness.render().unwrap();
    assert!(harness.query_by_label_contains("Kawabata").is_some());
    assert!(harness.query_by_label_contains("X3P").is_some());
    let path = folder.path("twill.txt");
    fs::write(&path, export()).unwrap();
    harness
        .get_by_role_and_label(Role::Button, "Choose files…")
        .click();
    harness.run_steps(3);
    type_path(&mut harness, &path.display().to_string());
    assert_eq!(harness.state().imported_figures().len(), 2);
}

#[test]
fn strokes_go_through_all_steps_into_the_library() {
    let folder = Folder::new("import-strokes");
    let (mut harness, path) = with_file(&folder, "twill.txt", &export());
    let suggested = harness.state().imported_figures();
    assert!(
        suggested[0].starts_with("warp forward SMD "),
        "{suggested:?}"
    );
    harness.render().unwrap();
    // The end of the section is dragged towards its start.
    let grip = harness.get_by_role_and_label(Role::Slider, "warp forward section end");
    let at = grip.rect().center();
    harness.drag_at(at);
    harness.step();
    for share in 1..=8_u8 {
        harness.hover_at(at - vec2(10.0 * f32::from(share), 0.0));
        harness.step();
    }
    harness.drop_at(at - vec2(80.0, 0.0));
    harness.run_steps(4);
    assert_ne!(
        harness.state().imported_figures(),
        suggested,
        "SMD follows the section"
    );
    harness
        .get_by_label("Take the most stationary 20 mm along the warp")
        .click();
    harness.run_steps(4);
    assert_eq!(harness.state().imported_figures(), suggested);
    type_into(&mut harness, "name", "Wool twill");
    keep(&mut harness, "Keep…", "Keep");
    let made = folder.path("library/wool-twill");
    let manifest = fs::read_to_string(made.join("textile.toml")).unwrap();
    for part in [
        "name = \"Wool twill\"",
        "importer = \"kes-f\"",
        "files = [\"twill.txt\"]",
    ] {
        assert!(manifest.contains(part), "{part} in {manifest}");
    }
    assert_eq!(made_by_the_command_line(&path), folder_bytes(&made));
}

/// What the command line makes of the file.
fn made_by_the_command_line(path: &Path) -> Vec<(String, Vec<u8>)> {
    let out = path.with_file_name("by-the-command-line");
    let args = ["textile", "import-kes", "--name", "Wool twill", "--out"];
    let program = std::process::Command::new(env!("CARGO_BIN_EXE_selvedge"))
        .args(args)
        .arg(&out)
        .arg(path)
        .output()
        .unwrap();
    assert!(program.status.success(), "{program:?}");
    let mut files = folder_bytes(&out);
    // The picture of the strokes is for those who see no window.
    files.retain(|(name, _)| !name.starts_with("import."));
    files
}

fn folder_bytes(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<(String, Vec<u8>)> = entries
        .map(|path| {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            (name, fs::read(&path).unwrap())
        })
        .collect();
    files.sort();
    files
}

#[test]
fn what_the_file_does_not_say_is_a_field_and_its_answer_is_enough() {
    let folder = Folder::new("import-asks");
    let bare = "1.5\n2.5\n1.0\n".repeat(400);
    let (mut harness, _) = with_file(&folder, "bare_warp.txt", &bare);
    assert!(harness.state().imported_figures().is_empty());
    let asked = harness.query_by_label_contains("bare_warp.txt:1: no column of distance; type the");
    assert!(asked.is_some(), "the reader's line");
    type_into(&mut harness, "step", "0.02");
    assert_eq!(harness.state().imported_figures().len(), 1);
    harness.render().unwrap();
}

#[test]
fn a_map_gives_a_textile_for_every_place() {
    let folder = Folder::new("import-map");
    let (mut harness, _) = with_file(&folder, "ripples.txt", &matrix());
    assert!(
        harness
            .query_by_label_contains("the unit of the heights is not stated")
            .is_some()
    );
    choose(&mut harness, "Unit of heights", "µm");
    type_into(&mut harness, "step", "0.05");
    assert_eq!(harness.state().imported_figures().len(), 1);
    let before = harness.state().imported_figures();
    let cross = harness
        .get_by_role_and_label(Role::Slider, "Place 1")
        .rect()
        .center();
    harness.drag_at(cross);
    harness.step();
    harness.hover_at(cross + vec2(4.0, -9.0));
    harness.step();
    harness.drop_at(cross + vec2(9.0, -17.0));
    harness.run_steps(4);
    assert_ne!(
        harness.state().imported_figures(),
        before,
        "the cross was dragged"
    );
    harness
        .get_by_role_and_label(Role::Button, "Add a place")
        .click();
    harness.run_steps(4);
    assert_eq!(harness.state().imported_figures().len(), 2);
    harness.render().unwrap();
    keep(&mut harness, "Keep…", "Keep and lay out");
    for id in ["ripples-1", "ripples-2"] {
        let manifest = folder.path("library").join(id).join("textile.toml");
        let manifest = fs::read_to_string(manifest).unwrap();
        assert!(manifest.contains("place_mm = "), "{id}: {manifest}");
    }
    let placed: Vec<String> = harness
        .state()
        .scene()
        .textiles
        .iter()
        .map(|one| one.id.clone())
        .collect();
    assert!(placed.iter().any(|id| id == "ripples-1"), "{placed:?}");
}

#[test]
fn nonsense_is_one_line_and_nothing_can_be_kept() {
    for (nth, content) in ["", "there is nothing\nto measure here\n"]
        .into_iter()
        .enumerate()
    {
        let folder = Folder::new(&format!("import-nonsense-{nth}"));
        let (harness, _) = with_file(&folder, "nothing.txt", content);
        // The file's own row has no colon.
        let line = harness.query_by_label_contains("nothing.txt:");
        assert!(line.is_some(), "one line about the file");
        let refused = harness.query_by_label_contains("Step 1 has something to mend");
        assert!(refused.is_some());
    }
}

#[test]
fn a_hidden_pane_reads_nothing() {
    let folder = Folder::new("import-hidden");
    let (mut harness, path) = with_file(&folder, "twill.txt", &export());
    let n_read = harness.state().n_measurements_read();
    assert!(n_read > 0);
    harness.run_steps(10);
    assert_eq!(
        harness.state().n_measurements_read(),
        n_read,
        "nothing has changed"
    );
    click_tab(&mut harness, "Workspace");
    fs::write(&path, export().replace("um", "V")).unwrap();
    harness.run_steps(10);
    assert_eq!(
        harness.state().n_measurements_read(),
        n_read,
        "nobody looks"
    );
}
