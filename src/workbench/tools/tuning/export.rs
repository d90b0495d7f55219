//! What compression does to the library: level in, level out.

use crate::bench::export::Exported;
use crate::bench::export::origin::Origin;
use crate::bench::export::sheet::Sheet;
use crate::bench::view::{LibraryDot, SceneView};
use crate::tools::tuning::curve::ends_db as compression_ends_db;
use selvedge_chart::{Axis, Ink, Panel, Row, Series, Style, Tone, Words};
use selvedge_foundation::quantity;

/// The curve with the library's textiles as dots on it.
pub(crate) fn curve(scene: &SceneView, reference_db: f64, origin: Origin) -> Exported {
    let library = &scene.library;
    let gain_db = |level_db: f64| {
        scene
            .tuning
            .compression_gain_db(Some(level_db), reference_db)
    };
    let at = |level_db: f64| [level_db, level_db + gain_db(level_db)];
    let ends = compression_ends_db(library, reference_db);
    let line = |name: &str, points: [[f64; 2]; 2], ink, style| Series {
        name: name.to_owned(),
        points: points.to_vec(),
        style,
        ink,
        ..Series::default()
    };
    let dots = |name: &str, is_placed: bool, ink| Series {
        name: name.to_owned(),
        points: library
            .iter()
            .filter(|dot| dot.is_placed == is_placed)
            .map(|dot| at(dot.level_db))
            .collect(),
        ink,
        ..Series::default()
    };
    let percent = quantity::with_unit(100.0 * scene.tuning.compression, 0, "%");
    let compressed = format!("compression {percent}");
    let unchanged = ends.map(|level_db| [level_db; 2]);
    let named = |dot: &LibraryDot| Words {
        at: at(dot.level_db),
        text: dot.name.clone(),
        tone: Tone::Aside,
    };
    let panel = Panel {
        x: Axis::linear("level in, dB re 1 µm").within(ends),
        y: Axis::linear("level out, dB re 1 µm").within(ends),
        series: vec![
            line("uncompressed", unchanged, Ink::Grey, Style::Dashed),
            line(&compressed, ends.map(at), Ink::Black, Style::Line),
            dots("library", false, Ink::Grey),
            dots("in the scene", true, Ink::Black),
        ],
        words: library
            .iter()
            .filter(|dot| dot.is_placed)
            .map(named)
            .collect(),
        ..Panel::default()
    };
    let row = Row {
        panels: vec![panel],
        height_px: 420.0,
        bar: None,
    };
    let note = "Level of a textile: mean over both bands of its mean amplitudes at 100 mm/s, \
                without other gains.";
    let title = "Compression of the library".to_owned();
    Exported::new(title, sheet(library, gain_db), vec![row], note, origin)
}

fn sheet(library: &[LibraryDot], gain_db: impl Fn(f64) -> f64) -> Sheet {
    let number = |of: &dyn Fn(&LibraryDot) -> f64| -> Vec<f64> { library.iter().map(of).collect() };
    let names: Vec<String> = library.iter().map(|dot| dot.name.clone()).collect();
    let is_placed = library.iter().map(|dot| u64::from(dot.is_placed));
    Sheet::default()
        .with("textile", names)
        .with("mean_a40_um", number(&|dot| dot.mean_um[0]))
        .with("mean_a320_um", number(&|dot| dot.mean_um[1]))
        .with("level_in_db", number(&|dot| dot.level_db))
        .with("compression_gain_db", number(&|dot| gain_db(dot.level_db)))
        .with(
            "level_out_db",
            number(&|dot| dot.level_db + gain_db(dot.level_db)),
        )
        .with("is_in_scene", is_placed.collect::<Vec<u64>>())
}
