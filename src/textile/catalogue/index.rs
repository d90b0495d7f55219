//! The index of a catalogue: a line a textile, each with its sheet.

use crate::tactile::{Filters, Levels};
use crate::{Library, Textile};
use selvedge_foundation::quantity::fixed;

const HEADER: &str = "| textile | name | construction | fibre | source | SMD, µm | A40, µm | \
    A320, µm | level, dB |\n|---|---|---|---|---|---:|---:|---:|---:|\n";

/// The line of a textile.
pub(super) fn line(textile: &Textile) -> String {
    let manifest = textile.manifest();
    let levels = Levels::of(textile.surface(), &Filters::default());
    let [a40, a320] = levels.mean_um.map(|um| fixed(um, 2));
    let level = levels
        .level_db()
        .map_or_else(|| "none".to_owned(), |db| fixed(db, 1));
    let cells = [
        format!("[{0}]({0}.svg)", textile.id()),
        cell(&manifest.name),
        manifest.construction.word().to_owned(),
        cell(&manifest.fibre),
        manifest.source.kind().to_owned(),
        fixed(textile.surface().smd_um(), 2),
        a40,
        a320,
        level,
    ];
    format!("| {} |\n", cells.join(" | "))
}

/// A text within a table.
fn cell(text: &str) -> String {
    text.split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .replace('|', "\\|")
}

/// The whole index.
pub(super) fn text(library: &Library, lines: &[String]) -> String {
    let n = lines.len();
    let root = library.root();
    // The last part alone: where a library lies is no part of what it is.
    let root = root
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let table = lines.concat();
    format!(
        "# Catalogue of {}\n\n{n} textiles. SMD: mean absolute deviation of height. A40 and A320: \
         mean amplitudes over all points and the four directions at 100 mm/s, default filters, no \
         gain; level: the mean of both in dB re 1 µm.\n\n{HEADER}{table}",
        cell(&root)
    )
}
