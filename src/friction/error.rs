//! What can go wrong.

use thiserror::Error;

use selvedge_foundation::files::FileError;

/// Why there is no friction from a picture.
#[derive(Debug, Error)]
pub enum FrictionError {
    /// Weights that are none.
    #[error("the weights cannot be used: {what}; train anew or take the shipped ones")]
    Weights {
        /// What is wrong.
        what: String,
    },
    /// A checkpoint that is none.
    #[error("the checkpoint cannot be used: {what}; remove it to begin anew")]
    Checkpoint {
        /// What is wrong.
        what: String,
    },
    /// A picture without room for a finger's path, or with far too much.
    #[error(
        "the picture shows {:.1} mm x {:.1} mm of cloth; give one of at least 40 mm x 10 mm and \
         at most 500 mm, or its true scale",
        size_mm[0], size_mm[1]
    )]
    Size {
        /// Its width and height, mm.
        size_mm: [f64; 2],
    },
    /// A fabric that cannot be learnt from.
    #[error("{name}: {what}")]
    Fabric {
        /// What it is called.
        name: String,
        /// What is wrong, and how to mend it.
        what: String,
    },
    /// Too few fabrics.
    #[error("{n} fabrics are too few: give at least 3, each with a picture and its friction")]
    Few {
        /// How many there are.
        n: usize,
    },
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// Stopped by its user.
    #[error("cancelled")]
    Cancelled,
}
