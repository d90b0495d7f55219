//! What a textile made of measured heights consists of: profile files, and a picture of the relief.

use std::path::Path;

use crate::build::BuiltFile;
use crate::error::TextileError;
use crate::metrology::Measured;
use crate::profile_file;
use crate::recipe::ProfileFiles;
use crate::surface::{Direction, HeightMap, ProfileSet, SurfaceError};
use crate::yarns::PX_PER_MM;
use selvedge_foundation::files::Rgb8Image;
use selvedge_foundation::numerics::{Grid, to_byte, to_index};

/// The strokes as profile files, those that are there.
pub(crate) fn profile_files(profiles: &ProfileSet) -> Result<Vec<BuiltFile>, TextileError> {
    let mut files = Vec::new();
    for direction in Direction::ALL {
        if let Some(profile) = &profiles[direction.index()] {
            let name = ProfileFiles::name(direction);
            let (heights_um, step_mm) = (profile.heights_um(), profile.step_mm());
            let text = profile_file::write(heights_um, step_mm, Path::new(&name))?;
            files.push(BuiltFile::new(name, text));
        }
    }
    Ok(files)
}

/// Grey of what lies level, and how much a slope of one rms is lighter or darker.
const LEVEL_GREY: f64 = 150.0;
const SLOPE_GREY: f64 = 45.0;
/// Grey of what is missing.
const MISSING_GREY: u8 = 40;
/// Longest side of a picture, pixels.
const MAX_PIXELS: f64 = 2000.0;

/// The map lit from the upper left, from the top row on; what is mostly missing is plain and dark.
pub(super) fn shaded(measured: &Measured) -> Result<Rgb8Image, SurfaceError> {
    let map = HeightMap::new(measured.heights_um.clone(), measured.step_mm)?;
    let holes = map.heights_um();
    let holes = holes.map(|height| f64::from(u8::from(height.is_nan())));
    let missing = pooled(&holes, map.size_mm());
    let pixels = pooled(map.filled().heights_um(), map.size_mm());
    let (width, height) = (pixels.width(), pixels.height());
    let slope = |row: usize, column: usize| {
        let at = |row: usize, column: usize| pixels.row(row.min(height - 1))[column.min(width - 1)];
        at(row, column + 1) - at(row, column.saturating_sub(1)) + at(row.saturating_sub(1), column)
            - at(row + 1, column)
    };
    let places = (0..height).rev();
    let places = places.flat_map(|row| (0..width).map(move |column| (row, column)));
    let lit: Vec<Option<f64>> = places
        .map(|(row, column)| (missing.row(row)[column] < 0.5).then(|| slope(row, column)))
        .collect();
    let n_lit = lit.iter().flatten().count().max(1) as f64;
    let rms = (lit.iter().flatten().map(|s| s * s).sum::<f64>() / n_lit).sqrt();
    Ok(Rgb8Image {
        width,
        height,
        pixels: lit.into_iter().map(|slope| grey(slope, rms)).collect(),
    })
}

/// A picture of red, green and blue, 0…1, row 0 the lowest, from the top row on.
pub(super) fn coloured(channels: &[Grid<f64>; 3], size_mm: [f64; 2]) -> Rgb8Image {
    let [red, green, blue] = channels.each_ref().map(|values| {
        pooled(values, size_mm)
            .turned_over()
            .map(|x| to_byte(255.0 * x + 0.5))
    });
    let others = green.values().iter().zip(blue.values());
    let pixels = red.values().iter().zip(others);
    Rgb8Image {
        width: red.width(),
        height: red.height(),
        pixels: pixels.map(|(r, (g, b))| [*r, *g, *b]).collect(),
    }
}

/// The grey of a slope; `None`: missing.
fn grey(slope: Option<f64>, rms: f64) -> [u8; 3] {
    let Some(slope) = slope else {
        return [MISSING_GREY; 3];
    };
    let lit = if rms > 0.0 { slope / rms } else { 0.0 };
    [to_byte(LEVEL_GREY + SLOPE_GREY * lit); 3]
}

/// Means over the pixels of a picture with 10 pixels a mm.
fn pooled(values: &Grid<f64>, size_mm: [f64; 2]) -> Grid<f64> {
    let n_points = [values.width(), values.height()];
    let n_pixels = size_mm.map(|mm| to_index((mm * PX_PER_MM).round().clamp(1.0, MAX_PIXELS)));
    let [width, height] = n_pixels;
    let span = |pixel: usize, axis: usize| {
        let first = pixel * n_points[axis] / n_pixels[axis];
        let end = (pixel + 1) * n_points[axis] / n_pixels[axis];
        first..end.max(first + 1)
    };
    Grid::from_fn(width, height, |column, row| {
        let rows = span(row, 1);
        let n = (rows.len() * span(column, 0).len()) as f64;
        let sums = rows.map(|r| values.row(r)[span(column, 0)].iter().sum::<f64>());
        sums.sum::<f64>() / n
    })
}
