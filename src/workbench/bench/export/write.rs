//! An export as bytes of a file: CSV, SVG or PNG by the ending of its name.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::bench::export::Exported;
use selvedge_chart::FigureError;
use selvedge_foundation::files::{self, FileError};

/// Width of a picture, px: two for each of the figure's own, sharp at 145 mm and 300 per inch.
const WIDTH_PX: u32 = 1720;

/// Why nothing was exported.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ExportError {
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// Nobody knows what kind of file is meant.
    #[error("{} is not exported: end its name in .png, .svg or .csv", .0.display())]
    Ending(PathBuf),
}

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Kind {
    /// A picture of pixels.
    #[default]
    Png,
    /// A drawing of lines and letters.
    Svg,
    /// A table.
    Csv,
}

impl Kind {
    /// Every kind, in the order in which they are offered.
    pub(crate) const ALL: [Self; 3] = [Self::Png, Self::Svg, Self::Csv];

    /// The kind that a file's name ends in.
    ///
    /// # Errors
    /// It ends in none that is known.
    pub(crate) fn of(path: &Path) -> Result<Self, ExportError> {
        let ending = path.extension().map(OsStr::to_ascii_lowercase);
        let is_meant = |kind: &Self| ending.as_deref() == Some(kind.ending().as_ref());
        let known = Self::ALL.into_iter().find(is_meant);
        known.ok_or_else(|| ExportError::Ending(path.to_owned()))
    }

    /// How names of such files end, without the dot.
    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Csv => "csv",
        }
    }
}

impl Exported {
    /// The bytes of a file of this kind. `path` only names it in errors.
    ///
    /// # Errors
    /// The figure cannot be drawn.
    pub(crate) fn bytes(&self, kind: Kind, path: &Path) -> Result<Vec<u8>, ExportError> {
        Ok(match kind {
            Kind::Csv => self.sheet.to_csv(&self.origin.pairs(), path)?,
            Kind::Svg => self.figure.to_svg()?.into_bytes(),
            Kind::Png => {
                let pixels = self.figure.to_pixels(WIDTH_PX)?;
                files::encode_png_rgba(&pixels.rgba, pixels.width, pixels.height, path)?
            }
        })
    }

    /// Writes a file of the kind that its name ends in; a crash leaves the old one or the new one.
    ///
    /// # Errors
    /// The figure cannot be drawn, or the file cannot be written.
    pub(crate) fn write(&self, path: &Path) -> Result<(), ExportError> {
        let bytes = self.bytes(Kind::of(path)?, path)?;
        Ok(files::write_atomic(path, &bytes)?)
    }

    /// The table as text.
    ///
    /// # Errors
    /// None that a text in memory could have.
    pub(crate) fn to_csv(&self) -> Result<String, ExportError> {
        let bytes = self
            .sheet
            .to_csv(&self.origin.pairs(), Path::new("table"))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}
