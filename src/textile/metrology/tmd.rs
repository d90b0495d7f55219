//! TMD, the binary files of `TrueMap`: lengths and heights in mm, float32.

use std::path::Path;

use super::reading::Stated;
use super::{LengthUnit, Reading, n_points};
use selvedge_foundation::files::{ByteReader, FileError, Number};

/// How such a file begins.
pub(super) const MAGIC: &[u8] = b"Binary TrueMap Data File v2.0";

/// Reads one map.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Reading, FileError> {
    let mut reader = ByteReader::new(bytes, path);
    // The magic line stands in 32 bytes, a comment up to its NUL follows.
    reader.seek(32)?;
    let comment = reader.text()?;
    let [width, height] = [reader.u32()?, reader.u32()?];
    let [x, y] = [reader.f32()?, reader.f32()?].map(f64::from);
    reader.take(8)?;
    let size = [width, height].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    let n = n_points(size[0], size[1], path)?;
    let values = Number::F32.decode(reader.take(4 * n)?);
    let mut reading = Reading::of_rows(size[0], values, "TMD", path)?.turned_over();
    reading.steps = Some([x / f64::from(width), y / f64::from(height)]);
    reading.length_unit = Stated::Length(LengthUnit::Millimetre);
    reading.height_unit = Stated::Length(LengthUnit::Millimetre);
    comment.trim().clone_into(&mut reading.about.comment);
    Ok(reading)
}
