//! SUR and PRO, the files of Digital Surf: a header of 512 bytes, a comment, a private zone, and
//! points of 16 or 32 bits, plain or packed.
//!
//! Every axis has its own units. Heights are `raw · dz + offset` in the unit of the height step.

use std::path::Path;

use super::reading::{About, Stated};
use super::{Reading, n_points};
use selvedge_foundation::files::{ByteReader, FileError, Number, inflate, latin1};

/// What the header says that matters here.
struct Header {
    is_packed: bool,
    n_objects: u16,
    kind: u16,
    has_special_points: bool,
    number: Number,
    z_range: [f64; 2],
    size: [usize; 2],
    steps: [f64; 3],
    units: [String; 3],
    is_inverted: bool,
    offset_z: f64,
    n_comment: usize,
    n_private: usize,
    about: About,
}

/// Reads one surface or profile.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Reading, FileError> {
    let header = Header::read(bytes, path)?;
    let mut warnings = Vec::new();
    check_kind(&header, path, &mut warnings)?;
    let [width, height] = header.size;
    let n = n_points(width, height, path)?;
    let mut reader = ByteReader::new(bytes, path);
    reader.seek(512)?;
    let comment = latin1(reader.take(header.n_comment)?);
    reader.take(header.n_private)?;
    let n_bytes = n * header.number.size();
    let values = if header.is_packed {
        header.number.decode(&unpacked(&mut reader, n_bytes, path)?)
    } else {
        header.number.decode(reader.take(n_bytes)?)
    };
    let mut n_saturated = 0;
    let [lowest, highest] = header.z_range;
    let height_of = |raw: f64| {
        let is_missing = header.has_special_points && raw <= lowest - 2.0;
        let is_saturated = header.has_special_points && raw >= highest + 2.0;
        n_saturated += usize::from(is_saturated);
        if is_missing || is_saturated {
            return f64::NAN;
        }
        raw * header.steps[2] + header.offset_z
    };
    let heights = values.into_iter().map(height_of).collect();
    if n_saturated > 0 {
        warnings.push(format!("{n_saturated} saturated points count as missing"));
    }
    let mut reading = Reading::of_rows(width, heights, "SUR", path)?.turned_over();
    reading.steps = Some([header.steps[0], header.steps[usize::from(height > 1)]]);
    let [unit_x, unit_y, unit_z] = &header.units;
    reading.length_unit = Stated::of(unit_x);
    reading.height_unit = Stated::of(unit_z);
    if let (true, Some(x), Some(y)) = (
        height > 1,
        reading.length_unit.length(),
        Stated::of(unit_y).length(),
    ) {
        // Both steps in the unit of the first.
        reading.steps = Some([header.steps[0], header.steps[1] * y.um() / x.um()]);
    }
    reading.about = header.about;
    comment
        .trim_matches(['\0', ' '])
        .clone_into(&mut reading.about.comment);
    reading.warnings = warnings;
    Ok(reading)
}

impl Header {
    fn read(bytes: &[u8], path: &Path) -> Result<Self, FileError> {
        let mut reader = ByteReader::new(bytes, path);
        let is_packed = reader.take(12)? == b"DSCOMPRESSED";
        reader.take(2)?;
        let n_objects = reader.u16()?;
        reader.take(2)?;
        let kind = reader.u16()?;
        let title = reader.latin1(30)?;
        let instrument = reader.latin1(30)?;
        reader.take(6)?;
        let has_special_points = reader.u16()? == 1;
        reader.take(10)?;
        let number = match reader.u16()? {
            16 => Number::I16,
            32 => Number::I32,
            bits => {
                let what = format!("{bits} bits a point where 16 or 32 are read");
                return Err(FileError::whole(path, what, "get an intact copy"));
            }
        };
        let z_range = [reader.i32()?, reader.i32()?].map(f64::from);
        let size = [reader.i32()?, reader.i32()?].map(|n| usize::try_from(n).unwrap_or(0));
        reader.take(4)?;
        let steps = [reader.f32()?, reader.f32()?, reader.f32()?].map(f64::from);
        reader.take(48)?;
        let units = [reader.latin1(16)?, reader.latin1(16)?, reader.latin1(16)?];
        reader.seek(290)?;
        let is_inverted = reader.u16()? != 0;
        reader.seek(306)?;
        let date = date(&mut reader)?;
        reader.seek(334)?;
        let [n_comment, n_private] = [reader.u16()?, reader.u16()?].map(usize::from);
        reader.seek(474)?;
        let offset_z = f64::from(reader.f32()?);
        Ok(Self {
            is_packed,
            n_objects,
            kind,
            has_special_points,
            number,
            z_range,
            size,
            steps,
            units,
            is_inverted,
            offset_z: if offset_z.is_finite() { offset_z } else { 0.0 },
            n_comment,
            n_private,
            about: About {
                format: "SUR",
                title,
                instrument,
                date,
                comment: String::new(),
            },
        })
    }
}

/// Second, minute, hour, day, month and year as a date; empty if there is none.
fn date(reader: &mut ByteReader<'_>) -> Result<String, FileError> {
    let mut parts = [0; 6];
    for part in &mut parts {
        *part = reader.u16()?;
    }
    let [second, minute, hour, day, month, year] = parts;
    let is_date = (1..=12).contains(&month) && (1..=31).contains(&day);
    let date = format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}");
    Ok(if is_date { date } else { String::new() })
}

/// Refuses what is neither a surface nor a profile.
fn check_kind(header: &Header, path: &Path, warnings: &mut Vec<String>) -> Result<(), FileError> {
    match header.kind {
        1 | 2 => {}
        4 | 5 => {
            let n = header.n_objects;
            warnings.push(format!("the first of a series of {n} was read"));
        }
        kind => {
            let what = format!("an object of kind {kind}, neither a surface nor a profile");
            return Err(FileError::whole(
                path,
                what,
                "save the surface alone as SUR",
            ));
        }
    }
    if header.kind <= 2 && header.n_objects > 1 {
        let n = header.n_objects;
        warnings.push(format!("the first of {n} objects was read"));
    }
    if header.is_inverted {
        let line = "the file says that its heights were inverted; they are taken as stored";
        warnings.push(line.to_owned());
    }
    Ok(())
}

/// The points of a packed file: streams one after the other, after a table of their lengths.
fn unpacked(
    reader: &mut ByteReader<'_>,
    n_bytes: usize,
    path: &Path,
) -> Result<Vec<u8>, FileError> {
    let wrong = || {
        let what = "the lengths of the packed streams are wrong";
        FileError::whole(path, what, "get an intact copy")
    };
    let n_streams = usize::try_from(reader.u32()?).unwrap_or(usize::MAX);
    // The table must be there before anything is kept for it.
    let table = reader.take(n_streams.saturating_mul(8))?;
    let mut table = ByteReader::new(table, path);
    let mut points = Vec::new();
    for _ in 0..n_streams {
        let [raw, packed] = [table.u32()?, table.u32()?];
        let [raw, packed] = [raw, packed].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        if raw > n_bytes - points.len() {
            return Err(wrong());
        }
        points.extend(inflate(reader.take(packed)?, raw, path)?);
    }
    if points.len() == n_bytes {
        Ok(points)
    } else {
        Err(wrong())
    }
}
