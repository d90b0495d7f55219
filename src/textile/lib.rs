//! Textiles: their manifests, the sources that surfaces come from, and libraries of them.
//!
//! A textile is a folder with a manifest; its source is measured profiles, a measured height map, a
//! seeded model of a woven or knitted textile that a virtual probe was drawn over, or of a surface
//! known by its harmonics, its Hurst exponent or what repeats in it. Knows nothing of scenes or of
//! rendering.
//!
//! # Invariants
//! - loading is lazy: a library reads a textile's profiles only when it is asked for that textile
//! - a model is a function of its recipe: same recipe, same bytes
//! - every error is one line: what, where, how to mend it
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

mod build;
mod catalogue;
mod curve;
mod draft;
mod error;
mod import;
mod kes;
mod library;
mod manifest;
pub mod metrology;
mod number_table;
pub mod picture;
mod profile_file;
mod recipe;
mod shipped;
mod sources;
pub mod surface;
pub mod tactile;
mod unit;
mod yarns;

pub use build::{BuiltFile, RecipePreview, build, make, write};
pub use catalogue::{write_catalogue, write_figure};
pub use draft::{Draft, Fault};
pub use error::{KesAsk, TextileError};
pub use import::{
    Description, Ensemble, HeightImport, HeightPlace, HeightScale, ImportOptions, KesFigures,
    KesImport, Lamp, MadeOfPicture, Measurement, PictureTextile, ScaledRelief, read_measurement,
    rebuilt,
};
pub use kes::{
    ColumnRole, DecimalSign, KesColumn, KesFile, KesFriction, KesKnown, KesLine, KesLook,
    KesOptions, KesPlace, KesReading, KesSection, KesStroke, Mark, MarkKind, ReturnOrder,
    StrokeSide, TextileAxis,
};
pub use library::{
    Appearance, BuildCache, Change, Index, IndexEntry, Library, LibraryFolder, Textile, Version,
    called, elsewhere, id_in, id_of, is_of_the_program, kind_of, n_threads, nth_id,
};
pub use manifest::{
    AppearanceKeys, Construction, Figure as MeasuredFigure, KnownFigure, Manifest, Parent,
    Provenance, Uncertainty,
};
pub use recipe::{Group, Parameter, ParameterKind, Place, lit};
pub use sources::brownian::{Brownian, Generator, Hurst};
pub use sources::fourier::{
    Fourier, FourierSeries, FourierTemplate, ImportedProfile, Reading, Readings, import,
};
pub use sources::heightmap::Heightmap;
pub use sources::knit::Knit;
pub use sources::picture::PictureSource;
pub use sources::profiles::Profiles;
pub use sources::restoration::{Reduced, Restoration};
pub use sources::weave::Weave;
pub use sources::{RECIPES, Source, groups};
pub use surface::smd_um;
pub use unit::{LengthUnit, Unit};

#[cfg(test)]
mod tests;
