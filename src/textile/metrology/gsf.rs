//! GSF, Gwyddion's simple field: a text header, then float32. Read and written.

use std::path::Path;

use super::field::{FieldKeys, field_reading};
use super::{Measured, Reading, n_points};
use selvedge_foundation::files::{ByteReader, FileError, Number};

/// How such a file begins.
pub(super) const MAGIC: &[u8] = b"Gwyddion Simple Field 1.0\n";

/// Reads one field.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Reading, FileError> {
    let mend = "get an intact copy";
    let end = bytes.iter().position(|&byte| byte == 0);
    let end = end.ok_or_else(|| FileError::whole(path, "the header does not end", mend))?;
    let header = String::from_utf8_lossy(&bytes[MAGIC.len()..end.max(MAGIC.len())]).into_owned();
    let mut keys = FieldKeys::default();
    let mut sizes = [0; 2];
    for (index, line) in header.lines().enumerate() {
        let Some((key, value)) = line.split_once('=') else {
            continue;
        };
        let (key, value) = (key.trim(), value.trim());
        let size = match key {
            "XRes" => &mut sizes[0],
            "YRes" => &mut sizes[1],
            _ => {
                keys.set(key, value);
                continue;
            }
        };
        *size = value.parse().map_err(|_error| {
            let what = format!("{key} is \"{value}\"");
            FileError::content(path, index + 2, what, "write a whole number")
        })?;
    }
    let [width, height] = sizes;
    let n = n_points(width, height, path)?;
    let mut reader = ByteReader::new(bytes, path);
    // One to four NULs, up to a multiple of four.
    reader.seek(4 * (end / 4 + 1))?;
    let values = Number::F32.decode(reader.take(n * 4)?);
    field_reading([width, height], values, &keys, "GSF", path)
}

/// Writes a map; heights as float32, metres.
pub(super) fn write(measured: &Measured) -> Vec<u8> {
    let grid = &measured.heights_um;
    let (width, height) = (grid.width(), grid.height());
    let mut bytes = MAGIC.to_vec();
    bytes.extend(format!("XRes = {width}\nYRes = {height}\n").bytes());
    for (key, value) in FieldKeys::of(measured).pairs() {
        bytes.extend(format!("{key} = {value}\n").bytes());
    }
    let padded = 4 * (bytes.len() / 4 + 1);
    bytes.resize(padded, 0);
    let rows = (0..height).rev();
    let heights = rows.flat_map(|row| grid.row(row).iter().map(|height| height * 1e-6));
    bytes.extend(Number::F32.encode(heights));
    bytes
}
