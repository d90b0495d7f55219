//! A catalogue of a library: a sheet for every textile and an index, as a monograph's appendix
//! prints its fabrics.
//!
//! The same library gives the same bytes.

mod sheet;

use sheet::sheet;

use std::fs;
use std::path::Path;

use crate::error::TextileError;
use crate::tactile::{Filters, Levels};
use crate::{Library, Textile};
use selvedge_chart::Figure;
use selvedge_foundation::files::{FileError, encode_png_rgba, write_atomic};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::fixed;

/// Pixels across a PNG.
const PNG_WIDTH: u32 = 1720;

/// Writes `ID.svg` and `ID.png` for every textile of a library into a folder, and `index.md` last;
/// returns how many textiles there are.
///
/// # Errors
/// A textile that cannot be loaded, a folder that cannot be written, the work was stopped.
pub fn write_catalogue(
    library: &Library,
    out: &Path,
    progress: &mut Progress<'_>,
) -> Result<usize, TextileError> {
    fs::create_dir_all(out).map_err(FileError::write(out))?;
    let mut lines = Vec::new();
    let n = library.ids().len();
    for (done, id) in library.ids().iter().enumerate() {
        progress.step(done as f64 / n.max(1) as f64, id)?;
        let textile = library.load(id)?;
        write_figure(&sheet(&textile)?, out, id)?;
        lines.push(index_line(&textile));
    }
    let text = index_text(library, &lines);
    write_atomic(&out.join("index.md"), text.as_bytes())?;
    progress.step(1.0, "index.md")?;
    Ok(n)
}

/// Writes a figure as `NAME.svg` and `NAME.png` into a folder.
pub fn write_figure(figure: &Figure, out: &Path, name: &str) -> Result<(), TextileError> {
    let svg = figure.to_svg()?;
    write_atomic(&out.join(format!("{name}.svg")), svg.as_bytes())?;
    let pixels = figure.to_pixels(PNG_WIDTH)?;
    let path = out.join(format!("{name}.png"));
    let png = encode_png_rgba(&pixels.rgba, pixels.width, pixels.height, &path)?;
    Ok(write_atomic(&path, &png)?)
}

/// The head of the index: a line a textile, each with its sheet.
const HEADER: &str = "| textile | name | construction | fibre | source | SMD, µm | A40, µm | \
    A320, µm | level, dB |\n|---|---|---|---|---|---:|---:|---:|---:|\n";

/// The line of a textile.
fn index_line(textile: &Textile) -> String {
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
fn index_text(library: &Library, lines: &[String]) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::progress::{CancelFlag, Progress};
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn a_sheet_shows_everything_and_is_the_same_twice() {
        let textile = Library::shipped().unwrap().load("silk-crepe").unwrap();
        let svg = sheet(&textile).unwrap().to_svg().unwrap();
        for part in [
            "Silk crêpe de chine: woven, silk",
            "amplitude against speed",
            "weft reverse",
            "power, dB re 1 µm²",
            "Measured: SMD",
            "model of kind",
        ] {
            assert!(svg.contains(part), "{part}");
        }
        assert!(
            svg == sheet(&textile).unwrap().to_svg().unwrap(),
            "the same bytes"
        );
    }

    #[test]
    fn a_catalogue_has_a_sheet_for_every_textile_and_stops_when_asked() {
        let store = Library::shipped().unwrap().store_of("silk-crepe").unwrap();
        let root = ScratchFolder::new("sheets");
        let folder = root.join("cloths").join("silk");
        for name in [
            "textile.toml",
            "appearance.png",
            "warp_forward.csv",
            "warp_reverse.csv",
        ] {
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join(name), store.read("silk-crepe", name).unwrap()).unwrap();
        }
        let manifest = fs::read_to_string(folder.join("textile.toml")).unwrap();
        let manifest = manifest
            .replace("weft_forward = \"weft_forward.csv\"\n", "")
            .replace("weft_reverse = \"weft_reverse.csv\"\n", "");
        fs::write(folder.join("textile.toml"), manifest).unwrap();
        let library = Library::open(&root.join("cloths")).unwrap();
        let out = root.join("sheets");
        let n = Progress::unheard(|progress| write_catalogue(&library, &out, progress)).unwrap();
        assert_eq!(n, 1);
        let index = fs::read_to_string(out.join("index.md")).unwrap();
        assert!(index.contains("# Catalogue of cloths") && index.contains("[silk](silk.svg)"));
        let svg = fs::read_to_string(out.join("silk.svg")).unwrap();
        assert!(
            svg.contains("weft forward: not measured"),
            "what is missing is said"
        );
        assert!(
            out.join("silk.png").metadata().unwrap().len() > 10_000,
            "a picture"
        );
        let stop = CancelFlag::new();
        stop.cancel();
        let stopped = write_catalogue(&library, &out, &mut Progress::new(&mut |_, _| {}, stop));
        assert!(
            matches!(stopped, Err(TextileError::Cancelled(_))),
            "{stopped:?}"
        );
    }
}
