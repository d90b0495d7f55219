//! Every pane alone, in both themes.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};

use super::compare::Golden;
use super::samples::{export, lit_cloth};
use super::stage::Stage;
use crate::program::Lab;

/// Ticks from one picture to the next.
const SLOT: u32 = 60;
/// Ticks that the stroke takes to go round the scene; this many after it began, or half of it
/// later, every contactor is on a textile.
const ROUND: u32 = 137;
const ON_CLOTH: u32 = 430;

/// What is looked at while a stroke goes round the shipped scene, and the size of the pane, points.
const FELT: [(&str, &str, [u16; 2]); 11] = [
    ("workspace", "Workspace", [640, 520]),
    ("library", "Library", [240, 480]),
    ("tuning", "Tuning", [360, 420]),
    ("contactors", "Contactors", [480, 300]),
    ("contact-spectrum", "Contact", [480, 300]),
    ("drive-spectrum", "Drive", [480, 300]),
    ("drive-waveform", "Wave", [480, 240]),
    ("spatial-spectra", "Spatial", [480, 300]),
    ("why", "Why", [560, 420]),
    ("response", "Response", [560, 420]),
    ("accuracy", "Accuracy", [560, 420]),
];

#[test]
fn golden_panes_that_are_felt() {
    let mut golden = Golden::of("pictures/felt");
    let mut stage = Stage::alone(None);
    stage.press(Modifiers::NONE, Key::Space);
    let slot = |nth: u32| ON_CLOTH + nth * ROUND / 2;
    for (nth, (name, title, size)) in (0..).zip(FELT) {
        stage.front(title, size);
        stage.compare(&mut golden, name, slot(nth));
    }
    stage.front("Compare", [640, 420]);
    stage.click_named("Compare how amplitudes are computed");
    stage.compare(&mut golden, "compare-methods", slot(11));
    stage.front("Bridge", [360, 900]);
    for part in ["Array", "Calibration", "Wiring", "Timing", "Input"] {
        stage.click(Role::Button, part);
    }
    stage.compare(&mut golden, "bridge", slot(12));
    stage.front("Workspace", [640, 520]);
    for key in [Key::K, Key::G, Key::V] {
        stage.press(Modifiers::NONE, key);
    }
    stage.compare_dark(&mut golden, "workspace-overlays", slot(13));
    golden.finish();
}

#[test]
fn golden_panes_in_which_textiles_are_made() {
    let mut golden = Golden::of("pictures/made");
    let lab = Lab::named("made");
    let mut stage = Stage::alone(None);
    stage.front("Collection", [900, 560]);
    stage.wait(|bench| bench.n_textiles_measured() == 16);
    stage.compare(&mut golden, "collection", SLOT);
    stage.click_named("The library as pieces of cloth");
    stage.front("Collection", [560, 300]);
    stage.compare_dark(&mut golden, "collection-cloths", 2 * SLOT);

    stage.front("Lab", [1000, 620]);
    stage.choose("Begin with", "Example: Brownian surface");
    stage.compare(&mut golden, "lab-brownian", 3 * SLOT);
    stage.front("Lab", [480, 620]);
    stage.click_named("Family page");
    stage.choose("Parameter that varies", "Surface: Hurst exponent");
    stage.click_named("Try");
    stage.compare_dark(&mut golden, "lab-family", 4 * SLOT);
    stage.click_named("Keep page");
    stage.compare_dark(&mut golden, "lab-keep", 5 * SLOT);

    stage.front("Import", [760, 620]);
    stage.compare_dark(&mut golden, "import-empty", 6 * SLOT);
    let strokes = lab.write("twill.txt", export());
    stage.harness.state_mut().import_file(strokes);
    stage.compare(&mut golden, "import-strokes", 7 * SLOT);

    stage.front("Picture", [1000, 640]);
    stage.compare_dark(&mut golden, "picture-empty", 8 * SLOT);
    let path = lab.path("Blue twill.png");
    lit_cloth().save(&path).unwrap();
    stage.harness.state_mut().open_picture(path);
    stage.harness.run_steps(4);
    stage.type_into("scale", "600");
    stage.type_into("height", "80");
    stage.compare(&mut golden, "picture-cloth", 9 * SLOT);
    golden.finish();
}

#[cfg(feature = "friction")]
#[test]
fn golden_friction() {
    let mut golden = Golden::of("pictures/friction");
    let lab = Lab::named("friction");
    let mut stage = Stage::alone(None);
    stage.front("Friction", [1000, 480]);
    stage.compare_dark(&mut golden, "empty", SLOT);
    stage.press(Modifiers::NONE, Key::Space);
    let path = lab.path("Blue twill.png");
    lit_cloth().save(&path).unwrap();
    stage.click(Role::Button, "Choose a picture…");
    stage.type_path(&path);
    stage.type_into("scale", "5");
    stage.compare(&mut golden, "felt", ON_CLOTH);
    stage.front("Friction", [480, 620]);
    stage.compare_dark(&mut golden, "narrow", ON_CLOTH + SLOT);
    golden.finish();
}

#[test]
fn golden_drape() {
    let mut golden = Golden::of("pictures/drape");
    let lab = Lab::named("drape");
    let hand = "t_s,x_mm,y_mm,z_mm,opening_mm\n0,90,70,0,40\n0.3,90,70,0,-5\n\
                0.6,120,80,30,-5\n0.9,132,62,42,-5\n";
    let path = lab.write("fingers.csv", hand);
    let mut stage = Stage::alone(None);
    stage.front("Drape", [1000, 480]);
    stage.click(Role::Button, "Open a hand…");
    stage.type_path(&path);
    stage.click(Role::Button, "Replay");
    stage.compare(&mut golden, "pulled", 2 * SLOT);
    for name in ["+", "How far yarns are stretched, beside a scale"] {
        stage.click_named(name);
    }
    // Both begin at rest and follow the path.
    stage.compare_dark(&mut golden, "two-under-one-hand", 4 * SLOT);
    stage.click_named("−");
    stage.front("Drape", [480, 620]);
    stage.compare_dark(&mut golden, "narrow", 5 * SLOT);
    golden.finish();
}

#[test]
fn golden_analysis() {
    let mut golden = Golden::of("pictures/analysis");
    let lab = Lab::named("analysed");
    let simulate = "experiment simulate odd-one-out --observers 2 --seed 3 --out logs";
    lab.print(&simulate.split(' ').collect::<Vec<_>>());
    let mut stage = Stage::alone(None);
    stage.front("Analysis", [900, 620]);
    stage.compare_dark(&mut golden, "empty", SLOT);
    stage.type_into("folder", &lab.path("logs").display().to_string());
    stage.click_about("For a look");
    stage.click(Role::Button, "Analyse");
    stage.hide_field("folder");
    stage.compare(&mut golden, "overview", 2 * SLOT);
    stage.click(Role::Button, "Odd one out of three: accuracy");
    stage.compare(&mut golden, "section", 3 * SLOT);
    golden.finish();
}
