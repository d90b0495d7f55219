//! The chart and the table that every pane exports.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};

use super::compare::Golden;
use super::condense::condensed;
use super::samples::export;
use super::stage::Stage;
use crate::program::Lab;

/// Ticks that the stroke takes to go round the scene; this many after it began every contactor is
/// on a textile.
const ROUND: u32 = 137;
const ON_CLOTH: u32 = 430;

/// The title of a pane's tab, what its button exports, and what the files are called.
const CHARTS: [(&str, &str, &str); 13] = [
    ("Contactors", "Contactors", "contactors"),
    ("Contact", "Contact spectrum", "contact-spectrum"),
    ("Drive", "Drive spectrum", "drive-spectrum"),
    ("Wave", "Drive waveform", "drive-waveform"),
    ("Spatial", "Spatial spectra", "spatial-spectra"),
    ("Why", "Why", "why"),
    ("Response", "Response", "response"),
    ("Compare", "Compare", "compare"),
    ("Tuning", "Compression curve", "compression-curve"),
    ("Workspace", "Map over the cloth", "map-over-the-cloth"),
    ("Workspace", "Timeline", "timeline"),
    ("Lab", "Textile lab", "textile-lab"),
    // Measured by other threads, for as many ticks as they take: nothing comes after it.
    ("Collection", "Collection", "collection"),
];

#[test]
fn golden_charts() {
    let mut golden = Golden::of("charts/panes");
    let lab = Lab::named("charts");
    let mut stage = Stage::alone(None);
    stage.press(Modifiers::NONE, Key::Space);
    stage.press(Modifiers::NONE, Key::K);
    for (nth, (tab, what, name)) in (0..).zip(CHARTS) {
        stage.front(tab, [620, 480]);
        if tab == "Compare" {
            stage.click_named("Compare how amplitudes are computed");
        }
        if tab == "Collection" {
            stage.wait(|bench| bench.n_textiles_measured() == 16);
        }
        for (nth, ending) in (2 * nth..).zip(["svg", "csv"]) {
            stage.until(ON_CLOTH + nth * ROUND / 2);
            let path = lab.path(&format!("{name}.{ending}"));
            stage.click(Role::Button, &format!("Export {what}"));
            stage.click(Role::Button, "Save as PNG, SVG or CSV…");
            stage.type_path(&path);
            let notices = stage.harness.state().notices();
            let text = fs::read_to_string(&path);
            let text = text.unwrap_or_else(|error| panic!("{name}: {error}, {notices:?}"));
            let text = text.replace(env!("CARGO_PKG_VERSION"), "VERSION");
            match ending {
                "svg" => golden.text_as(name, ending, &text),
                _ => golden.text_as(name, ending, &condensed(&text)),
            }
        }
    }
    golden.finish();
}

#[test]
fn golden_sheets() {
    let mut golden = Golden::of("charts/sheets");
    let lab = Lab::with_scene();
    lab.write("twill.txt", export());
    let line = "textile import-kes twill.txt --out textiles/twill --name Twill";
    let words: Vec<&str> = line.split(' ').collect();
    let outcome = lab.run(&words);
    assert_eq!(outcome.code, 0, "{outcome:?}");
    let line = "textile catalogue --library textiles --out sheets";
    lab.print(&line.split(' ').collect::<Vec<_>>());
    lab.print(&["figure", "a.scene.toml", "--path", "a.csv", "--out", "page"]);
    for (name, file) in [
        ("exploration", "page.svg"),
        ("catalogue-twill", "sheets/twill.svg"),
        ("catalogue-fine", "sheets/fine.svg"),
        ("import-twill", "textiles/twill/import.svg"),
    ] {
        let text = lab.read(file).replace(env!("CARGO_PKG_VERSION"), "VERSION");
        golden.text_as(name, "svg", &text);
    }
    golden.finish();
}
