//! `selvedge textile import` and `convert`: measured heights into a textile, or into another
//! format.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{CliError, output, terminal};
use crate::files;
use crate::textile::TextileError;
use crate::textile::metrology::{self, Asked, ImportOptions, LengthUnit};

/// What a file may leave open.
#[derive(Debug, Args)]
struct AskedArgs {
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
}

impl AskedArgs {
    fn asked(&self) -> Asked {
        Asked {
            height_unit: self.height_unit,
            length_unit: self.length_unit,
            step_mm: self.step_mm,
            range_um: self.range_um,
            column: self.column.clone(),
        }
    }
}

/// A file of heights, and the textile to make of it.
#[derive(Debug, Args)]
pub(super) struct ImportArgs {
    /// The file
    file: PathBuf,
    /// The textile's folder
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    #[command(flatten)]
    asked: AskedArgs,
    /// Where the strokes cross, mm from the lower left corner (the middle if not said)
    #[arg(long, value_name = "U,W", value_parser = place)]
    at: Option<[f64; 2]>,
    /// The map is one repeat of the cloth: strokes go on at its other side
    #[arg(long)]
    periodic: bool,
    /// What people call it
    #[arg(long)]
    name: Option<String>,
}

/// A file of heights, and the file to write.
#[derive(Debug, Args)]
pub(super) struct ConvertArgs {
    /// The file
    file: PathBuf,
    /// The file to write: .x3p, .gsf, .npy, .png or .tif
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    asked: AskedArgs,
    /// Fill missing points between the nearest heights
    #[arg(long)]
    fill: bool,
}

fn unit(word: &str) -> Result<LengthUnit, String> {
    LengthUnit::of(word).ok_or_else(|| "give m, cm, mm, um, nm, pm or angstrom".to_owned())
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let both = text.split_once(',');
    let number = |text: &str| text.trim().parse().ok().filter(|mm: &f64| mm.is_finite());
    both.and_then(|(u, w)| Some([number(u)?, number(w)?]))
        .ok_or_else(|| "give two numbers in mm, such as 10,5".to_owned())
}

/// Makes the textile.
pub(super) fn import(args: &ImportArgs) -> Result<(), CliError> {
    let bytes = files::read(&args.file)?;
    let options = ImportOptions {
        asked: args.asked.asked(),
        place_mm: args.at,
        is_periodic: args.periodic,
        name: args.name.clone(),
    };
    let imported = metrology::import(&bytes, &args.file, &options, &args.out)?;
    for note in &imported.notes {
        terminal::notice(&format!("{}: {note}", args.file.display()));
    }
    let name = &imported.manifest.name;
    output::print(&format!("{}: {name}\n", args.out.display()))
}

/// Writes the file.
pub(super) fn convert(args: &ConvertArgs) -> Result<(), CliError> {
    let bytes = files::read(&args.file)?;
    let mut measured = metrology::open(&bytes, &args.file, &args.asked.asked())?;
    for warning in &measured.warnings {
        terminal::notice(&format!("{}: {warning}", args.file.display()));
    }
    let n_missing = measured.n_missing();
    if args.fill && n_missing > 0 {
        measured = measured.filled().map_err(|source| TextileError::Surface {
            path: args.file.clone(),
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
