//! `selvedge friction generate`: a trace of friction from a picture of cloth.

use std::path::PathBuf;

use clap::Args;

use super::data::brightness;
use crate::CliError;
use crate::output::{TableOut, write_bytes};
use crate::picture::positive;
use crate::terminal;
use selvedge_foundation::files::{Rgb8Image, encode_png};
use selvedge_foundation::numerics::{extent, to_byte};
use selvedge_foundation::quantity::fixed;
use selvedge_friction::{PredictedFriction, Predictor};

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
    out: Option<PathBuf>,
    /// A picture of the spectrogram: a column a centimetre, rows up to 6.4 cycles/mm
    #[arg(long, value_name = "S.png")]
    spectrogram: Option<PathBuf>,
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
    let mut table = TableOut::new(args.out.as_deref(), &["x_mm", "mu"])?;
    for (at, mu) in found.mu.iter().enumerate() {
        let x_mm = at as f64 / PredictedFriction::PER_MM;
        table.rows().number(x_mm).number(mu).end_row()?;
    }
    table.finish()?;
    if let Some(path) = &args.spectrogram {
        write_bytes(path, &encode_png(&spectrogram(&found), path)?)?;
    }
    terminal::notice(&describe(&found));
    Ok(())
}

fn share(text: &str) -> Result<f64, String> {
    let share = text
        .parse()
        .ok()
        .filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "give a share from 0 to 1".to_owned())
}

/// How sure this is.
fn describe(found: &PredictedFriction) -> String {
    let worst = found.bands.iter().map(|[.., db]| *db).fold(0.0, f64::max);
    format!(
        "mean friction {} ± {} (95 % of cloths like those that were learnt: procedural ones), \
         spectrum within {} dB a bin; a picture tells little of an unseen material's friction",
        fixed(found.level(), 3),
        fixed(found.level_within, 3),
        fixed(worst, 1)
    )
}

/// Pixels of a frame in a picture.
const WIDE: usize = 16;

/// Log magnitudes, dark to light, lowest row at the bottom.
fn spectrogram(found: &PredictedFriction) -> Rgb8Image {
    let log = found.log_magnitudes();
    let [low, high] = extent(log.values().iter().map(|&log| f64::from(log)));
    let shade = |value: f32| to_byte(255.0 * (f64::from(value) - low) / (high - low).max(1e-9));
    let (n_bins, n_frames) = (log.width(), log.height());
    let row = |bin: usize| (0..n_frames * WIDE).map(move |column| (bin, column / WIDE));
    let pixels = (0..n_bins).rev().flat_map(row);
    Rgb8Image {
        width: n_frames * WIDE,
        height: n_bins,
        pixels: pixels
            .map(|(bin, frame)| [shade(log.row(frame)[bin]); 3])
            .collect(),
    }
}
