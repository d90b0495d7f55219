//! Making textiles of what was brought: strokes of the surface tester, files of heights, pictures.
//!
//! An import is a value that a window shows before anything is written; its files are a textile.

mod description;
mod ensemble;
mod height_scale;
mod heights;
mod kes;
mod kes_chart;
mod picture;
mod profile_files;
mod rebuild;

pub use description::Description;
pub use ensemble::{Ensemble, Lamp};
pub use height_scale::{HeightScale, ScaledRelief};
pub use heights::{HeightImport, HeightPlace, ImportOptions};
pub use kes::{KesFigures, KesImport};
#[cfg(test)]
pub(crate) use picture::to_textile;
pub use picture::{MadeOfPicture, PictureTextile};
pub use rebuild::rebuilt;

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::{kes as tester, metrology};
use selvedge_foundation::files::{self, FileError};

/// The content of a file of measurements or of a picture.
///
/// # Errors
/// A file that cannot be read, is empty, or larger than its kind may be.
pub fn read_measurement(path: &Path) -> Result<Vec<u8>, FileError> {
    files::read_known(path, |head| {
        metrology::is_known(head) || files::is_picture(head)
    })
}

/// A kind of measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Measurement {
    /// Strokes of the Kawabata surface tester.
    Strokes,
    /// Heights of an instrument that looks at or feels a surface.
    Heights,
}

impl Measurement {
    /// The kind of a file's content. Files that are neither count as heights, whose reader says
    /// what it can read.
    pub fn of(bytes: &[u8]) -> Self {
        if metrology::is_text(bytes) && tester::is_export(bytes) {
            Self::Strokes
        } else {
            Self::Heights
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_strokes_are_told_from_matrices_and_pictures() {
        for text in [
            "Weg mm;forward um;return um\n0,02;1,5;2,5\n0,04;1,6;2,4\n",
            "0 1.5\n1 1.7\n2 1.1\n",
            "1.5\n2.5\n1.0\n",
            "KES-FB4\n0;1;2;3;4\n1;1;2;3;4\n",
        ] {
            assert_eq!(
                Measurement::of(text.as_bytes()),
                Measurement::Strokes,
                "{text}"
            );
        }
        let matrix = "1 2 3 4 5 6 7 8\n8 7 6 5 4 3 2 1\n1 2 3 4 5 6 7 8\n";
        let marked = "X;Y;valid\n0;1.5;1\n1;1.5;1\n2;1.5;1\n";
        let gwyddion = "# Channel: z\n# Width: 4 mm\n# Height: 4 mm\n1 2\n3 4\n";
        for bytes in [matrix, marked, gwyddion, "", "words\n"] {
            assert_eq!(
                Measurement::of(bytes.as_bytes()),
                Measurement::Heights,
                "{bytes}"
            );
        }
        assert_eq!(Measurement::of(b"PK\x03\x04abc"), Measurement::Heights);
    }
}
