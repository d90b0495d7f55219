//! `selvedge picture` of a folder: every picture in it, and a table of what was found.

use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use super::output::{self, TableOut};
use super::picture::{PictureArgs, Told, analysed};
use super::{CliError, signals, terminal};
use selvedge_foundation::files::TableWriter;
use selvedge_textile::picture::Lattice;

/// How files of pictures end.
const ENDS: [&str; 6] = ["png", "jpg", "jpeg", "tif", "tiff", "bmp"];
/// The table.
const TABLE: &str = "pictures.csv";
const COLUMNS: [&str; 12] = [
    "image",
    "width_px",
    "height_px",
    "p1_x_px",
    "p1_y_px",
    "p2_x_px",
    "p2_y_px",
    "confidence",
    "false_alarm_rate",
    "explained_variance",
    "weave",
    "reason",
];

/// Analyses every picture of a folder, each into a folder of its own. One that cannot be read is
/// told, and in the table, and the others go on.
pub(super) fn run(args: &PictureArgs) -> Result<(), CliError> {
    let pictures = pictures_in(&args.image)?;
    args.check()?;
    output::make_folder(&args.out, "name another with --out")?;
    let stop = signals::stop_flag()?;
    let mut table = TableOut::new(Some(&args.out.join(TABLE)), &COLUMNS)?;
    let mut n_refused = 0_usize;
    for path in &pictures {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let one = args.of_folder(path, name_among(path, &pictures));
        let told = match analysed(&one) {
            Err(error) if stop.load(Ordering::Relaxed) => return Err(error),
            told => told,
        };
        let told = told.map_err(|error| error.to_string());
        add(table.rows().text(&file), told.as_ref());
        table.rows().end_row()?;
        match told {
            Ok(told) => told.say(path)?,
            Err(line) => {
                n_refused += 1;
                terminal::notice(&line);
            }
        }
    }
    table.finish()?;
    let (n, table) = (pictures.len(), args.out.join(TABLE));
    let table = table.display();
    if n_refused > 0 {
        let line = format!("{n_refused} of {n} pictures could not be analysed: {table} says why");
        return Err(CliError::Input(line));
    }
    output::print(&format!("{table}: {n} pictures\n"))
}

/// Adds what was found of a picture: its size, its lattice, and why there is none of either.
fn add<W: Write>(row: &mut TableWriter<W>, told: Result<&Told, &String>) {
    for axis in 0..2 {
        row.optional(told.ok().map(|told| told.size_px[axis]));
    }
    let found = told.and_then(|told| told.found.as_ref());
    let lattice = found.ok().map(|(lattice, _)| lattice);
    for vector in [lattice.map(|l| l.p1_px), lattice.map(|l| l.p2_px)] {
        let [x_px, y_px] = [0, 1].map(|axis| vector.map(|vector| vector[axis]));
        row.optional(x_px).optional(y_px);
    }
    row.optional(lattice.map(|lattice| lattice.confidence))
        .optional(lattice.map(|lattice| lattice.false_alarm_rate));
    row.optional(found.ok().map(|(_, explained)| explained));
    let weave = lattice.and_then(Lattice::weave_name).unwrap_or_default();
    row.text(&weave)
        .text(found.err().map_or("", String::as_str));
}

/// The pictures of a folder, by name.
fn pictures_in(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let refused = |what: String| {
        let folder = folder.display();
        let mend = "name a picture, or a folder with PNG, JPEG, TIFF or BMP files";
        CliError::Input(format!("{folder}: {what}; {mend}"))
    };
    let entries = fs::read_dir(folder).map_err(|error| refused(error.to_string()))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let is_picture = |path: &PathBuf| {
        let end = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        path.is_file() && ENDS.iter().any(|known| end.eq_ignore_ascii_case(known))
    };
    let mut pictures: Vec<PathBuf> = paths.filter(is_picture).collect();
    pictures.sort();
    if pictures.is_empty() {
        return Err(refused("there is no picture in it".to_owned()));
    }
    Ok(pictures)
}

/// What the folder of a picture is called: its name without its end, unless another shares that.
fn name_among<'a>(path: &'a Path, pictures: &[PathBuf]) -> &'a OsStr {
    let stem = path.file_stem();
    let n_alike = pictures.iter().filter(|other| other.file_stem() == stem);
    let name = if n_alike.count() > 1 {
        path.file_name()
    } else {
        stem
    };
    name.unwrap_or_default()
}
