//! `selvedge friction generate`: a trace of friction from a picture of cloth.

use std::path::{Path, PathBuf};

use clap::Args;

use super::super::output::OutFile;
use super::data::brightness;
use crate::CliError;
use crate::output::{TableOut, write_bytes};
use crate::picture::positive;
use crate::terminal;
use selvedge_foundation::files::{EditedKeys, KeyValue, Rgb8Image, read_text, write_atomic};
use selvedge_foundation::numerics::{Grid, extent, to_byte};
use selvedge_friction::{PredictedFriction, Predictor};
use selvedge_textile::Manifest;

/// A picture, and where its friction goes.
#[derive(Debug, Args)]
pub(crate) struct GenerateArgs {
    /// The picture: PNG, JPEG, TIFF or BMP, at least 40 mm wide and 10 mm high
    image: PathBuf,
    /// Pixels to a millimetre
    #[arg(long, value_name = "P", value_parser = positive)]
    px_per_mm: f64,
    /// Another picture of the same scale: friction of a cloth between both
    #[arg(long, value_name = "IMAGE")]
    towards: Option<PathBuf>,
    /// How far towards it, 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, requires = "towards",
        value_parser = share)]
    share: f64,
    /// The table `x_mm,mu` (standard output if none is named)
    #[arg(long, value_name = "F.csv")]
    out: Option<OutFile>,
    /// A folder of a textile that feels like it from now on: friction.csv is written there, and how
    /// far it may be off into textile.toml
    #[arg(long, value_name = "DIR")]
    textile: Option<PathBuf>,
    /// A picture of the spectrogram: a column a centimetre, rows up to 6.4 cycles/mm
    #[arg(long, value_name = "S.png")]
    spectrogram: Option<OutFile>,
}

pub(super) fn run(args: &GenerateArgs) -> Result<(), CliError> {
    let predictor = Predictor::shipped()?;
    let picture = brightness(&args.image)?;
    let found = match &args.towards {
        None => predictor.of_picture(&picture, args.px_per_mm)?,
        Some(other) => {
            let other = brightness(other)?;
            let pictures = [&picture, &other].map(|one| (one, args.px_per_mm));
            predictor.between(pictures, args.share)?
        }
    };
    if let Some(folder) = &args.textile {
        keep(&found, folder)?;
    }
    if args.textile.is_none() || args.out.is_some() {
        write_trace(&found, args.out.as_deref())?;
    }
    if let Some(path) = &args.spectrogram {
        write_bytes(path, &spectrogram(&found).to_png(path)?)?;
    }
    terminal::notice(&format!("mean friction {}", found.certainty()));
    Ok(())
}

fn write_trace(found: &PredictedFriction, out: Option<&Path>) -> Result<(), CliError> {
    let mut table = TableOut::new(out, &["x_mm", "mu"])?;
    for (at, mu) in found.mu.iter().enumerate() {
        let x_mm = at as f64 / PredictedFriction::PER_MM;
        table.rows().number(x_mm).number(mu).end_row()?;
    }
    table.finish()
}

/// Gives it to a textile. What is wrong with its manifest is told before anything is written; what
/// nobody touches there stays as it was.
fn keep(found: &PredictedFriction, folder: &Path) -> Result<(), CliError> {
    const FRICTION: &str = "friction.csv";
    let path = folder.join("textile.toml");
    let mut keys = EditedKeys::parse(&read_text(&path)?, &path)?;
    let number = |value: f64| KeyValue::Float((1e4 * value).round() / 1e4);
    let band = |band: &[f64; 3]| KeyValue::Array(band.map(number).to_vec());
    let bands = found.bands.iter().map(band).collect();
    keys.set(("", 0, "friction"), Some(&FRICTION.into()));
    let mut state = |key, value| keys.set(("uncertainty", 0, key), Some(&value));
    state("friction_level", number(found.level_within));
    state("friction_bands_db", KeyValue::Array(bands));
    Manifest::from_toml(&keys.text(), &path)?;
    write_trace(found, Some(&folder.join(FRICTION)))?;
    Ok(write_atomic(&path, keys.text().as_bytes())?)
}

fn share(text: &str) -> Result<f64, String> {
    let share = text
        .parse()
        .ok()
        .filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "give a share from 0 to 1".to_owned())
}

/// Pixels of a frame in a picture.
const WIDE: usize = 16;

/// Log magnitudes, dark to light, lowest row at the bottom.
fn spectrogram(found: &PredictedFriction) -> Rgb8Image {
    let log = found.log_magnitudes();
    let ends = extent(log.values().iter().map(|&log| f64::from(log)));
    let shades = PredictedFriction::shades(log, log.width(), ends);
    let wide = Grid::from_fn(shades.width() * WIDE, shades.height(), |column, row| {
        [to_byte(255.0 * shades.row(row)[column / WIDE]); 3]
    });
    Rgb8Image {
        width: wide.width(),
        height: wide.height(),
        pixels: wide.values().to_vec(),
    }
}
