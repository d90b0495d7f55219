//! Textile from a picture: the lattice of its repeats and the cell that repeats (Allerkamp et al.,
//! "Generating tactile textures using periodicity analysis").
//!
//! A pipeline of stages: [`Picture::load`] a picture, perhaps a [`Picture::part`] of it or
//! [`Picture::rectified`]; [`even_light`]; the [`Autocorrelation`]; its [`Maxima`]; the
//! [`Directions`] they lie in; the [`Lattice`]; the [`Tile`]. Each takes what the one before made.
//! [`Analysis::of`] runs them all. *No lattice* is an answer, with its reason. Physical scale is
//! never guessed: everything here is in pixels.

mod analysis;
mod appearance;
mod autocorrelation;
mod basis;
pub mod brightness;
mod calibration;
mod candidates;
mod colour;
mod directions;
mod held_out;
mod lattice;
mod light;
mod maxima;
mod multiples;
mod offered;
mod output;
mod overlay;
mod part;
mod refine;
mod relief;
mod scale;
pub mod shading;
mod significant;
mod source;
mod synthesis;
mod tile;
mod turned;
mod unwarp;
mod weave_name;

#[cfg(test)]
mod tests;

pub use analysis::{Analysis, AnalysisOptions, Found, Measurements};
pub use autocorrelation::Autocorrelation;
pub use basis::{Basis, Place};
pub use candidates::Method;
pub use colour::PeriodicColour;
pub use directions::{DirectionOptions, Directions, Measured};
pub use lattice::{Lattice, NoLattice};
pub use light::{EvenLight, even_light};
pub use maxima::Maxima;
pub use output::{About, FILE_NAMES, write_files};
pub use overlay::{overlay, range};
pub use relief::{Relief, ReliefOf};
pub use scale::PictureScale;
pub use shading::ShadingError;
pub use significant::{Significant, SignificantMaxima};
pub use source::Picture;
pub(crate) use synthesis::synthesized;
pub use tile::{Rectangle, Tile};
pub use turned::{Similarity, Turned, TurnedPicture};
pub use unwarp::Unwarped;

use selvedge_foundation::files::FileError;
use selvedge_foundation::progress::Cancelled;

/// What can be wrong with a picture of a textile, or with what is asked of it.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A region, corners or a number that cannot be: what, and how to mend it.
    #[error("{0}")]
    Input(String),
    /// The work was stopped.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
