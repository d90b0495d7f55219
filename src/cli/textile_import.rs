//! `selvedge textile import` and `convert`: measured heights into a textile, or into another
//! format.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use super::output::{InFile, OutFile};
use super::picture::numbers;
use super::textile_words::{WordsArgs, construction};
use super::usage::one_of;
use super::{CliError, output, terminal};
use selvedge_textile::LengthUnit;
use selvedge_textile::metrology::{self, HeightOptions};
use selvedge_textile::surface::{Levelling, Preparation, Representation};
use selvedge_textile::{
    BuiltFile, Construction, Description, HeightImport, HeightPlace, ImportOptions, TextileError,
};

/// What a file may leave open.
#[derive(Debug, Args)]
pub(super) struct AskedArgs {
    /// Unit of the heights, where the file does not state it: m, mm, um, nm
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    height_unit: Option<LengthUnit>,
    /// Unit of places along and across, where the file does not state it
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    length_unit: Option<LengthUnit>,
    /// Distance of points in mm, where the file does not state it
    #[arg(long, value_name = "MM")]
    step_mm: Option<f64>,
    /// Height of white above black of a picture without a scale, in µm
    #[arg(long, value_name = "UM")]
    range_um: Option<f64>,
    /// The column of a table that holds the heights: its name, or its number from 1
    #[arg(long, value_name = "COLUMN")]
    column: Option<String>,
    /// Which of several fields of heights, from 1
    #[arg(long, value_name = "N")]
    layer: Option<usize>,
    /// Bring points that are not even to even steps, along straight lines
    #[arg(long)]
    resample: bool,
}

impl AskedArgs {
    /// The same for the reader of files.
    pub(super) fn asked(&self) -> HeightOptions {
        HeightOptions {
            height_unit: self.height_unit,
            length_unit: self.length_unit,
            step_mm: self.step_mm,
            range_um: self.range_um,
            column: self.column.clone(),
            layer: self.layer,
            resample: self.resample,
        }
    }
}

/// A file of heights, and the textiles to make of it.
#[derive(Debug, Args)]
pub(super) struct ImportArgs {
    /// The file
    file: InFile,
    /// The textile's folder; several places make DIR-1, DIR-2 …
    #[arg(long, value_name = "DIR")]
    out: OutFile,
    #[command(flatten)]
    asked: AskedArgs,
    /// The part that is taken: from U, W to U, W, mm from the lower left corner
    #[arg(long, value_name = "U,W,U,W", value_parser = part)]
    crop: Option<Corners>,
    /// Take heights for missing that lie so many robust spreads from those around them, 2 to 1000
    #[arg(long, value_name = "SPREADS", value_parser = spreads)]
    despike: Option<f64>,
    /// What is taken off: the best plane if not said, nothing with --periodic
    #[arg(long, value_name = "WHAT", value_parser = one_of(levels()))]
    level: Option<Levelling>,
    /// Where the strokes cross, mm from the lower left corner (the middle if not said); once for
    /// every textile
    #[arg(long, alias = "at", value_name = "U,W", value_parser = place)]
    place: Vec<[f64; 2]>,
    /// The map is one repeat of the cloth: strokes go on at its other side
    #[arg(long)]
    periodic: bool,
    /// Feel it at every point of the map, not along the strokes: the map becomes a part of the
    /// textile
    #[arg(long)]
    areal: bool,
    /// What people call it (the title of the data or the file's name if not said)
    #[arg(long, default_value = "")]
    name: String,
    /// How it is made
    #[arg(long, value_parser = construction(), default_value = "other")]
    construction: Construction,
    #[command(flatten)]
    words: WordsArgs,
}

/// A file of heights, and the file to write.
#[derive(Debug, Args)]
pub(super) struct ConvertArgs {
    /// The file
    file: InFile,
    /// The file to write: .x3p, .gsf, .npy, .png or .tif
    #[arg(long, value_name = "FILE")]
    out: OutFile,
    #[command(flatten)]
    asked: AskedArgs,
    /// Fill missing points between the nearest heights
    #[arg(long)]
    fill: bool,
}

fn unit(word: &str) -> Result<LengthUnit, String> {
    LengthUnit::of(word).ok_or_else(|| "give m, cm, mm, um, nm, pm or angstrom".to_owned())
}

fn levels() -> [(&'static str, Levelling); Levelling::ALL.len()] {
    Levelling::ALL.map(|level| (level.word(), level))
}

/// Two corners of a part, mm.
#[derive(Debug, Clone, Copy)]
struct Corners([f64; 4]);

fn part(text: &str) -> Result<Corners, String> {
    let all = numbers(text).filter(|all: &[f64; 4]| all.iter().all(|mm| mm.is_finite()));
    let wrong = || "give four numbers in mm, such as 1,1,21,16".to_owned();
    all.map(Corners).ok_or_else(wrong)
}

fn spreads(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    let number = number.filter(|spreads: &f64| (2.0..=1000.0).contains(spreads));
    number.ok_or_else(|| "give a number from 2 to 1000, such as 8".to_owned())
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let both = numbers(text).filter(|both: &[f64; 2]| both.iter().all(|mm| mm.is_finite()));
    both.ok_or_else(|| "give two numbers in mm, such as 10,5".to_owned())
}

/// Makes the textiles.
pub(crate) fn import(args: &ImportArgs) -> Result<(), CliError> {
    let bytes = selvedge_textile::read_measurement(&args.file)?;
    let options = ImportOptions {
        asked: args.asked.asked(),
        preparation: Preparation {
            crop_mm: args.crop.map(|corners| corners.0),
            despike: args.despike,
            level: args.level,
        },
        is_periodic: args.periodic,
        representation: if args.areal {
            Representation::Areal
        } else {
            Representation::Economical
        },
    };
    let n = args.place.len().max(1);
    if args.areal && n > 1 {
        let what = format!("--place is said {n} times, and --areal feels the whole map");
        return Err(CliError::Input(format!("{what}; leave one of them out")));
    }
    let import = HeightImport::of(&bytes, &args.file, &options)?;
    let said: Vec<Option<[f64; 2]>> = if args.place.is_empty() {
        vec![None]
    } else {
        args.place.iter().copied().map(Some).collect()
    };
    // Nothing is written before every place is known to lie on the map.
    let places: Vec<HeightPlace> = said
        .into_iter()
        .map(|place_mm| import.place(place_mm))
        .collect::<Result<_, _>>()?;
    for note in import.notes() {
        terminal::notice(&format!("{}: {note}", args.file.display()));
    }
    let words = args.words.words(&args.name, args.construction)?;
    for (nth, place) in places.iter().enumerate() {
        let mut words = words.nth(nth, n);
        if words.name.trim().is_empty() {
            words.name = Description::of(&import.own_name()).nth(nth, n).name;
        }
        let files = import.files(place, &words, &bytes)?;
        let folder = nth_folder(&args.out, nth, n);
        selvedge_textile::write(&files, &folder)?;
        output::print(&format!("{}: {}\n", folder.display(), words.name))?;
    }
    Ok(())
}

/// A textile to be made again.
#[derive(Debug, Args)]
pub(super) struct RebuildArgs {
    /// The textile's folder
    folder: PathBuf,
    /// Its file of heights, where that is not in the folder
    #[arg(long, value_name = "FILE")]
    file: Option<InFile>,
}

/// Makes a textile again, and says how many of its files are other ones now.
pub(super) fn rebuild(args: &RebuildArgs) -> Result<(), CliError> {
    let files = selvedge_textile::rebuilt(&args.folder, args.file.as_deref())?;
    let is_other = |file: &&BuiltFile| {
        fs::read(args.folder.join(&file.name)).ok().as_ref() != Some(&file.bytes)
    };
    let (n, n_other) = (files.len(), files.iter().filter(is_other).count());
    selvedge_textile::write(&files, &args.folder)?;
    let folder = args.folder.display();
    output::print(&format!(
        "{folder}: {n} files made again, {n_other} of them changed\n"
    ))
}

/// The folder of one of several textiles.
fn nth_folder(out: &Path, nth: usize, n: usize) -> PathBuf {
    let name = out.file_name().unwrap_or_default().to_string_lossy();
    if n > 1 {
        out.with_file_name(selvedge_textile::nth_id(&name, nth, n))
    } else {
        out.to_owned()
    }
}

/// Writes the file.
pub(super) fn convert(args: &ConvertArgs) -> Result<(), CliError> {
    let bytes = selvedge_textile::read_measurement(&args.file)?;
    let mut measured = metrology::Measured::open(&bytes, &args.file, &args.asked.asked())?;
    for warning in &measured.warnings {
        terminal::notice(&format!("{}: {warning}", args.file.display()));
    }
    let n_missing = measured.n_missing();
    if args.fill && n_missing > 0 {
        measured = measured.filled().map_err(|source| TextileError::Surface {
            path: args.file.to_path_buf(),
            source,
        })?;
        let file = args.file.display();
        terminal::notice(&format!("{file}: {n_missing} missing points were filled"));
    }
    output::write_bytes(&args.out, &metrology::write(&measured, &args.out)?)?;
    output::print(&summary(&measured, &args.out))
}

fn summary(measured: &metrology::Measured, path: &Path) -> String {
    let grid = &measured.heights_um;
    let (width, height, path) = (grid.width(), grid.height(), path.display());
    format!("{path}: {width} × {height} points\n")
}
