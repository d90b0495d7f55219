//! X3P (ISO 25178-72, earlier ISO 5436-2): a ZIP of `main.xml`, a checksum, and points either
//! as binary members or as a list in the XML. Read and written; all lengths are in metres.
//!
//! A wrong checksum is a warning: such files are common and their data mostly intact. Rows rise
//! with y.

mod header;
mod write;

pub use write::{Coding, write};

use std::path::Path;

use super::reading::{Stated, UNEVEN_MEND};
use super::{HeightOptions, LengthUnit, Reading, n_points};
use crate::surface::MAX_POINTS;
use header::{Axis, Header};
use selvedge_foundation::files::{Archive, FileError, Number, md5_hex};

/// Largest `main.xml`, bytes: a list of about a million points.
const MAX_XML: usize = 64 << 20;
/// The checksum of the XML, where the XML names no other.
const CHECKSUM: &str = "md5checksum.hex";

/// The points of a grid, row by row.
struct Points {
    /// Places along and across, m, where the axis is absolute.
    places_m: [Option<Vec<f64>>; 2],
    heights_m: Vec<f64>,
}

/// Reads one surface or profile.
pub(super) fn read(bytes: &[u8], path: &Path, asked: &HeightOptions) -> Result<Reading, FileError> {
    let mut archive = Archive::open(bytes, path)?;
    let main = archive.find("main.xml").ok_or_else(|| {
        let mend = "give an X3P file (ISO 25178-72)";
        FileError::whole(path, "a ZIP archive without main.xml", mend)
    })?;
    let folder = main.strip_suffix("main.xml").unwrap_or_default().to_owned();
    let xml = archive.member(&main, MAX_XML)?;
    let header = Header::read(&xml, &path.join("main.xml"))?;
    let mut warnings = Vec::new();
    check_xml(&mut archive, &folder, (&header, &xml), &mut warnings);
    let [width, height] = header.size(path, &mut warnings)?;
    let n = n_points(width, height, path)?;
    let points = if header.link.is_empty() {
        listed(&header, n, path)?
    } else {
        linked(&mut archive, &folder, &header, n, &mut warnings)?
    };
    let mut reading = Reading::of_rows(width, points.heights_m, "X3P", path)?;
    let mut steps = [0, 1].map(|axis: usize| header.axes[axis].increment.abs());
    for axis in [0, 1] {
        if let Some(places_m) = points.places_m[axis]
            .as_ref()
            .filter(|_| [width, height][axis] > 1)
        {
            let step = take_places(&mut reading, (places_m, axis), asked.resample);
            steps[axis] = step.map_err(|what| {
                let what = format!("{} axis: {what}", ["x", "y"][axis]);
                FileError::whole(path, what, UNEVEN_MEND)
            })?;
        }
    }
    if height == 1 {
        steps[1] = steps[0];
    }
    reading.steps = Some(steps);
    reading.length_unit = Stated::Length(LengthUnit::Metre);
    reading.height_unit = Stated::Length(LengthUnit::Metre);
    reading.about = header.about;
    reading.warnings.extend(warnings);
    Ok(reading)
}

/// The step along an axis of places that are stored point by point, m; brought to even ones where
/// that is wanted.
fn take_places(
    reading: &mut Reading,
    (places_m, axis): (&[f64], usize),
    is_resampled: bool,
) -> Result<f64, String> {
    let along = places_along(places_m, reading.values.width(), axis)?;
    let rises = along.windows(2).all(|pair| pair[0] <= pair[1]);
    let step = reading.even_step((&along, axis), 0.0, is_resampled && rises)?;
    if step > 0.0 {
        Ok(step)
    } else {
        Err("places fall".to_owned())
    }
}

/// Warns of a checksum of the XML that is wrong.
fn check_xml(
    archive: &mut Archive<'_>,
    folder: &str,
    (header, xml): (&Header, &[u8]),
    warnings: &mut Vec<String>,
) {
    let name = if header.checksum.is_empty() {
        CHECKSUM
    } else {
        &header.checksum
    };
    let stated = archive.member(&format!("{folder}{name}"), 4096);
    let Ok(stated) = stated else {
        warnings.push(format!(
            "no {name}: whether main.xml is intact is not known"
        ));
        return;
    };
    let stated = String::from_utf8_lossy(&stated).to_lowercase();
    if stated.split_whitespace().next() != Some(md5_hex(xml).as_str()) {
        warnings.push(format!(
            "{name} does not fit main.xml: one of them was changed"
        ));
    }
}

/// Warns of a checksum of a member that is wrong; none is stated where the text is empty.
fn check_member(stated: &str, bytes: &[u8], name: &str, warnings: &mut Vec<String>) {
    if !stated.is_empty() && !stated.eq_ignore_ascii_case(&md5_hex(bytes)) {
        warnings.push(format!(
            "the checksum does not fit {name}: its data may be damaged"
        ));
    }
}

/// Points of binary members: a record a point, of the absolute axes and the height.
fn linked(
    archive: &mut Archive<'_>,
    folder: &str,
    header: &Header,
    n: usize,
    warnings: &mut Vec<String>,
) -> Result<Points, FileError> {
    let axes = &header.axes;
    let sizes = [0, 1, 2].map(|i| {
        let is_stored = i == 2 || axes[i].is_absolute;
        if is_stored { axes[i].number.size() } else { 0 }
    });
    let record: usize = sizes.iter().sum();
    if (sizes[0] > 0 || sizes[1] > 0) && n > MAX_POINTS / 3 {
        let what = format!("{n} points with places of their own are too many");
        let mend = "save with incremental axes";
        return Err(FileError::whole(archive.path(), what, mend));
    }
    // The layers of a stack lie one behind the other; the first is read.
    let n_bytes = n * record;
    let max = n_bytes.saturating_mul(header.n_layers.max(1));
    let data = archive.member(&format!("{folder}{}", header.link), max)?;
    if data.len() < n_bytes {
        let what = format!("{} holds {} bytes for {n} points", header.link, data.len());
        let mend = format!("{n_bytes} are needed; get an intact copy");
        return Err(FileError::whole(archive.path(), what, mend));
    }
    check_member(&header.link_md5, &data, &header.link, warnings);
    let data = &data[..n_bytes];
    let [x, y, z] = [0, 1, 2].map(|i| {
        let (start, size) = (sizes[..i].iter().sum::<usize>(), sizes[i]);
        (size > 0).then(|| axes[i].decode(data, record, start))
    });
    let mut heights_m = z.unwrap_or_default();
    if !header.valid_link.is_empty() {
        let n_valid = n.div_ceil(8);
        let max = n_valid
            .saturating_mul(header.n_layers.max(1))
            .saturating_add(8);
        let valid = archive.member(&format!("{folder}{}", header.valid_link), max)?;
        if valid.len() < n_valid {
            let what = format!(
                "{} holds {} bytes for {n} points",
                header.valid_link,
                valid.len()
            );
            return Err(FileError::whole(archive.path(), what, "get an intact copy"));
        }
        check_member(&header.valid_md5, &valid, &header.valid_link, warnings);
        for (i, height) in heights_m.iter_mut().enumerate() {
            if valid[i / 8] >> (i % 8) & 1 == 0 {
                *height = f64::NAN;
            }
        }
    }
    Ok(Points {
        places_m: [x, y],
        heights_m,
    })
}

/// Points of the list in the XML: an empty one is missing.
fn listed(header: &Header, n: usize, path: &Path) -> Result<Points, FileError> {
    let n_listed = header.data.len();
    if n_listed < n {
        let what = format!("{n_listed} points in the list where {n} are promised");
        return Err(FileError::whole(path, what, "get an intact copy"));
    }
    let axes = &header.axes;
    let data = &header.data[..n];
    let column = |axis: usize| {
        data.iter()
            .map(|datum| axes[axis].metres(datum[axis]))
            .collect()
    };
    Ok(Points {
        places_m: [0, 1].map(|axis| axes[axis].is_absolute.then(|| column(axis))),
        heights_m: column(2),
    })
}

impl Axis {
    /// The lengths in records of a member, m.
    fn decode(&self, data: &[u8], record: usize, start: usize) -> Vec<f64> {
        let size = self.number.size();
        let values = if record == size {
            self.number.decode(data)
        } else {
            let fields = data.chunks_exact(record);
            let packed: Vec<u8> = fields
                .flat_map(|r| r[start..start + size].to_vec())
                .collect();
            self.number.decode(&packed)
        };
        values.into_iter().map(|value| self.metres(value)).collect()
    }

    /// The length that a stored number means, m.
    fn metres(&self, value: f64) -> f64 {
        let is_whole = matches!(self.number, Number::I16 | Number::I32);
        if self.is_absolute && !is_whole {
            value
        } else {
            value * self.increment + self.offset
        }
    }
}

/// Places that are stored point by point, m: the same in every row or column. Those of missing
/// points are not looked at.
fn places_along(places_m: &[f64], width: usize, axis: usize) -> Result<Vec<f64>, String> {
    let n = if axis == 0 {
        width
    } else {
        places_m.len() / width
    };
    let mut along = vec![f64::NAN; n];
    for (i, &place) in places_m.iter().enumerate() {
        let index = if axis == 0 { i % width } else { i / width };
        if along[index].is_nan() {
            along[index] = place;
        }
    }
    if along.iter().any(|place| !place.is_finite()) {
        return Err("a whole line has no place".to_owned());
    }
    let step = (along[n - 1] - along[0]).abs() / (n - 1) as f64;
    let differs = places_m.iter().enumerate().any(|(i, &place)| {
        let index = if axis == 0 { i % width } else { i / width };
        (place - along[index]).abs() > 0.01 * step
    });
    if differs {
        return Err("places differ from line to line".to_owned());
    }
    Ok(along)
}
