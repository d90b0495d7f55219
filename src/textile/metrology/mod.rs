//! Measured heights from the files of instruments and of the programs around them.
//!
//! What a file is, its content says, never its name. Heights come out in µm with their steps in
//! mm, rows in the order of rising w; what was not measured is NaN and stays so here. A unit that
//! a file does not state is asked for, never guessed.
//!
//! Sizes are checked before anything of that size is held: against
//! [`MAX_POINTS`](crate::surface::MAX_POINTS) and against the bytes that are there.

mod field;
mod frt;
mod gsf;
mod gwy;
mod image16;
mod npy;
mod reading;
mod sur;
mod text;
mod tmd;
mod x3p;

#[cfg(test)]
mod mutations;
#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;

use crate::unit::LengthUnit;
pub use reading::{About, HeightOptions, Measured};
pub use x3p::{Coding, write as write_x3p};

use std::path::Path;

use crate::error::TextileError;
use reading::{Reading, n_points};
use selvedge_foundation::files::{FileError, NumberArray};

/// What can be read, for people.
const READABLE: &str =
    "give X3P, SUR or PRO, GWY, GSF, NPY, TMD, FRT, grey PNG or TIFF of 16 bits, or text";

/// Whether the beginning holds no bytes that texts do not hold, or is that of UTF-16.
pub(crate) fn is_text(bytes: &[u8]) -> bool {
    if let [0xff, 0xfe, ..] | [0xfe, 0xff, ..] = bytes {
        return true;
    }
    let head = &bytes[..bytes.len().min(4096)];
    let is_control = |byte: &u8| *byte < 32 && !b"\t\n\r\x0c".contains(byte);
    !head.is_empty() && !head.iter().any(is_control)
}

/// Reads the content of a file as it is meant, asking for what it does not state.
type Reader = fn(&[u8], &Path, &HeightOptions) -> Result<Reading, FileError>;

/// How files begin, and who reads them.
const FORMATS: [(&[u8], Reader); 11] = [
    (b"PK\x03\x04", x3p::read),
    (b"DIGITAL SURF", |bytes, path, _| sur::read(bytes, path)),
    (b"DSCOMPRESSED", |bytes, path, _| sur::read(bytes, path)),
    (b"GWYP", gwy::read),
    (gsf::MAGIC, |bytes, path, _| gsf::read(bytes, path)),
    (NumberArray::MAGIC, |bytes, path, _| npy::read(bytes, path)),
    (image16::PNG_MAGIC, image16::read),
    (b"II*\0", image16::read),
    (b"MM\0*", image16::read),
    (tmd::MAGIC, |bytes, path, _| tmd::read(bytes, path)),
    (frt::MAGIC, |bytes, path, _| frt::read(bytes, path)),
];

fn reader_of(bytes: &[u8]) -> Option<Reader> {
    let found = FORMATS.iter().find(|(magic, _)| bytes.starts_with(magic));
    found.map(|&(_, reader)| reader)
}

/// Whether a file begins as one of an instrument that is no text.
pub(crate) fn is_known(head: &[u8]) -> bool {
    reader_of(head).is_some()
}

impl Measured {
    /// Reads measured heights. `path` only names the file in errors.
    ///
    /// # Errors
    /// One line: a format that is not read, a damaged file, a size beyond
    /// [`MAX_POINTS`](crate::surface::MAX_POINTS), steps that are not even, a unit or step that
    /// must be given, no height at all.
    pub fn open(bytes: &[u8], path: &Path, asked: &HeightOptions) -> Result<Self, TextileError> {
        let of_text = || is_text(bytes).then_some(text::read as Reader);
        let Some(reader) = reader_of(bytes).or_else(of_text) else {
            let what = "this is no file of measured heights that is known here";
            return Err(FileError::whole(path, what, READABLE).into());
        };
        reader(bytes, path, asked)?.finish(path, asked)
    }
}

/// Writes a map in the format that the ending of `path` names: `.x3p`, `.gsf`, `.npy`, `.png` or
/// `.tif`. Pictures cannot hold missing points.
///
/// # Errors
/// Another ending; a picture of a map with missing points.
pub fn write(measured: &Measured, path: &Path) -> Result<Vec<u8>, TextileError> {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    Ok(match ending.to_str().unwrap_or_default() {
        "x3p" => x3p::write(measured, Coding::default(), path)?,
        "gsf" => gsf::write(measured),
        "npy" => npy::write(measured),
        "png" => image16::picture(measured, path)?.to_png(path)?,
        "tif" | "tiff" => image16::picture(measured, path)?.to_tiff(path)?,
        _ => {
            let what = "heights are not written in this format";
            let mend = "name a file that ends in .x3p, .gsf, .npy, .png or .tif";
            return Err(FileError::whole(path, what, mend).into());
        }
    })
}
