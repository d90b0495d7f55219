//! FRT, the files of `MicroProf` profilers: tagged blocks. Heights stand in block 0x000B, their
//! grid in 0x0066, extents in 0x0067 (m) and the scale in 0x006C (m a count); 1 is missing.

use std::path::Path;

use super::reading::Stated;
use super::{LengthUnit, Reading, n_points};
use selvedge_foundation::files::{ByteReader, FileError, Number};

/// How such a file begins.
pub(super) const MAGIC: &[u8] = b"FRTM_GLIDERV1.0";
/// The count that stands for a missing point.
const MISSING: f64 = 1.0;

/// The blocks that matter.
#[derive(Default)]
struct Blocks<'a> {
    grid: Option<[u32; 3]>,
    extent_m: Option<[f64; 2]>,
    scale_m: Option<f64>,
    heights: Option<&'a [u8]>,
    comment: String,
}

/// Reads the topography.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<Reading, FileError> {
    let missing = |what: &str| {
        let what = format!("no block with the {what}");
        FileError::whole(path, what, "export a single topography, or X3P")
    };
    let blocks = blocks(bytes, path)?;
    let [width, height, bits] = blocks.grid.ok_or_else(|| missing("grid"))?;
    let size = [width, height].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    let n = n_points(size[0], size[1], path)?;
    let number = match bits {
        16 => Number::U16,
        32 => Number::I32,
        _ => {
            let what = format!("{bits} bits a point");
            return Err(FileError::whole(
                path,
                what,
                "16 and 32 are read; export X3P",
            ));
        }
    };
    let heights = blocks.heights.ok_or_else(|| missing("heights"))?;
    let data = ByteReader::new(heights, path).take(n * number.size())?;
    let scale_m = blocks.scale_m.ok_or_else(|| missing("height scale"))?;
    let scaled = number.decode(data).into_iter().map(|count| {
        if (count - MISSING).abs() < 0.5 {
            f64::NAN
        } else {
            count * scale_m
        }
    });
    let mut reading = Reading::of_rows(size[0], scaled.collect(), "FRT", path)?;
    let extent_m = blocks.extent_m;
    reading.steps = extent_m.map(|[x, y]| [x / f64::from(width), y / f64::from(height)]);
    reading.length_unit = Stated::Length(LengthUnit::Metre);
    reading.height_unit = Stated::Length(LengthUnit::Metre);
    reading.about.comment = blocks.comment;
    Ok(reading)
}

fn blocks<'a>(bytes: &'a [u8], path: &Path) -> Result<Blocks<'a>, FileError> {
    let mut reader = ByteReader::new(bytes, path);
    // The magic word with its version, and the number of blocks, which is not needed.
    reader.seek(18)?;
    let mut blocks = Blocks::default();
    while reader.n_left() >= 6 {
        let (tag, n_bytes) = (reader.u16()?, reader.u32()?);
        let data = reader.take(usize::try_from(n_bytes).unwrap_or(usize::MAX))?;
        let mut block = ByteReader::new(data, path);
        match tag {
            0x0065 => blocks.comment = block.latin1(data.len())?,
            0x0066 => blocks.grid = Some([block.u32()?, block.u32()?, block.u32()?]),
            0x0067 => blocks.extent_m = Some([block.f64()?, block.f64()?]),
            0x006C => {
                block.take(4)?;
                blocks.scale_m = Some(block.f64()?);
            }
            0x000B => blocks.heights = Some(data),
            _ => {}
        }
    }
    Ok(blocks)
}
