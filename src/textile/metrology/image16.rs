//! Heights in grey pictures of 16 bits, with the scale keys that Gwyddion writes into PNG
//! (`Gwy::XReal`, `Gwy::ZMin` …; black is `ZMin`, white `ZMax`). Read and written, TIFF likewise.

use std::path::Path;

use super::field::{FieldKeys, field_reading};
use super::reading::Stated;
use super::{HeightOptions, LengthUnit, Measured, Reading};
use crate::surface::MAX_POINTS;
use selvedge_foundation::files::{FileError, GrayImage};

pub(super) const PNG_MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";
const PREFIX: &str = "Gwy::";

/// Reads a PNG or a TIFF.
pub(super) fn read(bytes: &[u8], path: &Path, asked: &HeightOptions) -> Result<Reading, FileError> {
    let (picture, format) = if bytes.starts_with(PNG_MAGIC) {
        (GrayImage::from_png(bytes, path, MAX_POINTS)?, "PNG")
    } else {
        (GrayImage::from_tiff(bytes, path, MAX_POINTS)?, "TIFF")
    };
    let mut keys = FieldKeys::default();
    for (key, value) in &picture.texts {
        keys.set(key.strip_prefix(PREFIX).unwrap_or(""), value);
    }
    let number = |key: &str| picture.text(key)?.trim().parse::<f64>().ok();
    let stated = number("Gwy::ZMin").zip(number("Gwy::ZMax"));
    let in_um = picture
        .text("Gwy::ZUnit")
        .and_then(LengthUnit::of)
        .map(LengthUnit::um);
    if let (Some(asked), Some((low, high)), Some(um)) = (asked.range_um, stated, in_um)
        && ((high - low) * um / asked - 1.0).abs() > 0.01
    {
        let found = (high - low) * um;
        let what = format!("the picture states {found} µm from black to white, not {asked} µm");
        let mend = "leave range_um (--range-um) out, or correct the file";
        return Err(FileError::whole(path, what, mend));
    }
    let scale = match (asked.range_um, stated) {
        (Some(range_um), _) if range_um > 0.0 && range_um.is_finite() => (0.0, range_um),
        (None, Some((low, high))) if high >= low => (low, high),
        _ => {
            let what = "the picture does not state the heights of black and white";
            let mend = "give range_um (--range-um), the height of white above black";
            return Err(FileError::whole(path, what, mend));
        }
    };
    let a_step = (scale.1 - scale.0) / f64::from(picture.white);
    let heights = picture
        .values
        .iter()
        .map(|&value| scale.0 + a_step * f64::from(value));
    let size = [picture.width, picture.height];
    let mut reading = field_reading(size, heights.collect(), &keys, format, path)?;
    if asked.range_um.is_some() {
        reading.height_unit = Stated::Length(LengthUnit::Micrometre);
    }
    if picture.white == 255 {
        let line = "8 bits: heights come in 256 steps";
        reading.warnings.push(line.to_owned());
    }
    Ok(reading)
}

/// A map as a picture.
pub(super) fn picture(measured: &Measured, path: &Path) -> Result<GrayImage, FileError> {
    let n_missing = measured.n_missing();
    if n_missing > 0 {
        let what = format!("{n_missing} points are missing, which a picture cannot show");
        let mend = "fill them first (--fill), or write X3P";
        return Err(FileError::whole(path, what, mend));
    }
    let grid = &measured.heights_um;
    let [low, high] = measured.range_um();
    let share = |height: &f64| {
        if high > low {
            (height - low) / (high - low)
        } else {
            0.0
        }
    };
    let rows = (0..grid.height()).rev();
    let shares = rows.flat_map(|row| grid.row(row).iter().map(share));
    let mut texts = vec![
        (format!("{PREFIX}ZMin"), (low * 1e-6).to_string()),
        (format!("{PREFIX}ZMax"), (high * 1e-6).to_string()),
    ];
    for (key, value) in FieldKeys::of(measured).pairs() {
        // Pictures spell units in the singular.
        let key = key
            .strip_suffix("Units")
            .map_or_else(|| key.to_owned(), |k| format!("{k}Unit"));
        texts.push((format!("{PREFIX}{key}"), value.to_owned()));
    }
    Ok(GrayImage {
        texts,
        ..GrayImage::of_shares([grid.width(), grid.height()], shares)
    })
}
