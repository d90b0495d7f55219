//! The textile lab: a recipe is edited, what becomes of it is seen, kept and felt.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use selvedge_textile::{Library, Manifest, build};

use super::*;

/// A window in which cloth is made, with the example of a Brownian surface.
fn in_front(folder: &Folder) -> Harness<'static, Workbench> {
    let mut harness = window(&folder.scene());
    harness.run();
    harness.get_by_label("Cloth perspective").click();
    harness.run_steps(4);
    harness.get_by_label("Begin with").click();
    harness.run_steps(3);
    harness.get_by_label("Example: Brownian surface").click();
    harness.run_steps(4);
    harness
}

/// Clicks a number and types another.
fn type_number(harness: &mut Harness<'_, Workbench>, name: &str, text: &str) {
    harness.get_by_label(&format!("{name} value")).click();
    type_over(harness, text);
    press(harness, Modifiers::NONE, Key::Enter);
}

fn shows(harness: &Harness<'_, Workbench>, words: &str) -> bool {
    harness.query_all_by_label_contains(words).next().is_some()
}

#[test]
fn a_parameter_is_edited_and_the_figures_follow_and_go_back() {
    let folder = Folder::new("lab-edit");
    let mut harness = in_front(&folder);
    assert!(shows(&harness, "SMD 6.00 µm"));
    type_number(&mut harness, "Roughness SMD", "12");
    assert!(shows(&harness, "SMD 12.00 µm"));
    harness.get_by_label("Undo in the lab").click();
    harness.run_steps(4);
    assert!(shows(&harness, "SMD 6.00 µm"));
    harness.get_by_label("Redo in the lab").click();
    harness.run_steps(4);
    harness.get_by_label("Back to the start").click();
    harness.run_steps(4);
    assert!(shows(&harness, "SMD 6.00 µm"));
    assert!(!harness.state().is_edited(), "the scene has no part in it");
}

#[test]
fn a_wrong_value_is_said_in_the_readers_words_and_the_last_preview_stays() {
    let folder = Folder::new("lab-wrong");
    let mut harness = in_front(&folder);
    let before = harness.state().previews_computed();
    type_number(&mut harness, "Hurst exponent", "7");
    assert!(shows(
        &harness,
        "hurst is 7; give a number from 0.01 to 0.99"
    ));
    assert!(shows(&harness, "SMD 6.00 µm"));
    assert_eq!(harness.state().previews_computed(), before);
    type_number(&mut harness, "Hurst exponent", "0.8");
    assert!(!shows(&harness, "hurst is 7"));
    assert_eq!(harness.state().previews_computed(), before + 1);
}

#[test]
fn nothing_is_computed_while_the_lab_is_hidden_and_each_perspective_keeps_its_panes() {
    let folder = Folder::new("lab-hidden");
    let mut harness = window(&folder.scene());
    harness.run();
    harness.run_steps(5);
    let drawn = |harness: &Harness<'_, Workbench>, title: &str| {
        let all = harness.state().panes_drawn();
        all.into_iter().find(|(pane, _)| *pane == title).unwrap().1
    };
    assert_eq!(harness.state().previews_computed(), 0);
    assert_eq!(drawn(&harness, "Textile lab"), 0);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    assert_eq!(harness.state().previews_computed(), 1);
    let felt = drawn(&harness, "Workspace");
    harness.run_steps(5);
    assert_eq!(
        drawn(&harness, "Workspace"),
        felt,
        "it stands behind the lab"
    );
    click_tab(&mut harness, "Workspace");
    press(&mut harness, Modifiers::COMMAND, Key::Num1);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    let before = drawn(&harness, "Textile lab");
    harness.run_steps(5);
    assert_eq!(drawn(&harness, "Textile lab"), before, "as it was left");
    assert_eq!(harness.state().previews_computed(), 1);
}

#[test]
fn what_is_kept_reads_back_as_the_textile_that_its_recipe_makes() {
    let folder = Folder::new("lab-keep");
    let mut harness = in_front(&folder);
    harness.get_by_label("Keep page").click();
    harness.run_steps(3);
    keep(&mut harness, "Keep…", "Keep");
    let root = folder.path("library");
    let library = Library::open(&root).unwrap();
    let kept = library.load("brownian-surface").unwrap();
    let provenance = kept.manifest().provenance.as_ref().unwrap();
    assert!(
        provenance.made_by.starts_with("selvedge "),
        "{provenance:?}"
    );
    let recipe = Manifest {
        source: kept.manifest().source.recipe(),
        ..kept.manifest().clone()
    };
    for file in build(&recipe, &root).unwrap() {
        let path = root.join("brownian-surface").join(&file.name);
        assert_eq!(fs::read(&path).unwrap(), file.bytes, "{}", file.name);
    }
    harness.run_steps(4);
    // It is on the shelf now, and its name is taken.
    assert!(shows(&harness, "Add Brownian surface"));
    keep(&mut harness, "Keep…", "Keep");
    assert!(shows(
        &harness,
        "“Brownian surface” (id brownian-surface) already"
    ));
    harness.get_by_label("Keep both").click();
    harness.run_steps(6);
    let second = root.join("brownian-surface-2").join("textile.toml");
    let manifest = fs::read_to_string(second).unwrap();
    assert!(
        manifest.contains("name = \"Brownian surface 2\""),
        "{manifest}"
    );
}

#[test]
fn a_family_is_tried_and_all_of_it_is_kept() {
    let folder = Folder::new("lab-family");
    let mut harness = in_front(&folder);
    type_number(&mut harness, "Step", "0.1");
    harness.get_by_label("Family page").click();
    harness.run_steps(3);
    harness.get_by_label("Parameter that varies").click();
    harness.run_steps(3);
    harness.get_by_label("Surface: Hurst exponent").click();
    harness.run_steps(3);
    harness.get_by_label("Try").click();
    harness.run_steps(4);
    harness.render().unwrap();
    keep(&mut harness, "Keep all 5…", "Keep");
    let library = Library::open(&folder.path("library")).unwrap();
    let kept = (1..=5).map(|n| library.manifest(&format!("brownian-surface-{n}")).unwrap());
    let names: Vec<String> = kept.map(|manifest| manifest.name).collect();
    assert_eq!(names[0], "Brownian surface, Hurst exponent 0.1");
    assert_eq!(names.len(), 5);
}

#[test]
fn a_copy_is_compared_with_its_parent_and_a_cloth_without_recipe_is_restored() {
    let folder = Folder::new("lab-copy");
    let mut harness = in_front(&folder);
    harness.get_by_label("Begin with").click();
    harness.run_steps(3);
    harness.get_by_label("Restored from").click();
    harness.run_steps(3);
    harness.get_by_label("Ripple").click();
    harness.run_steps(4);
    assert!(shows(&harness, "Ripple, restored"));
    harness.get_by_role_and_label(Role::ComboBox, "Compared with");
    harness.render().unwrap();
}
