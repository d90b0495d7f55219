//! Textiles: their manifests, the sources that surfaces come from, and libraries of them.
//!
//! A textile is a folder with a manifest; its source is measured profiles, a measured height map, a
//! seeded model of a woven or knitted cloth that a virtual probe was drawn over, or of a surface
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

mod brought;
mod brownian;
mod build;
mod cache;
mod catalogue;
mod cloth;
mod curve;
mod drawn;
mod error;
mod fourier;
mod index;
mod keeping;
mod kes;
mod knit;
mod library;
mod loaded;
mod manifest;
mod measured;
pub mod metrology;
mod model;
mod parameter;
pub mod picture;
mod profile_file;
mod recipes;
mod restoration;
mod selection;
mod shipped;
pub mod surface;
pub mod tactile;
mod trial;
mod weave;
mod words;
mod workers;

pub use brought::{Measurement, read_measurement};
pub use brownian::Tip;
pub use brownian::{Brownian, Generator, Hurst};
pub use build::{BuiltFile, build, build_library, make, write};
pub use cache::BuildCache;
pub use catalogue::{sheet, write_catalogue, write_figure};
pub use cloth::Cloth;
pub use cloth::Side;
pub use cloth::Yarn;
pub use drawn::Drawn;
pub use drawn::lit;
pub use error::{KesAsk, TextileError};
pub use fourier::Imported;
pub use fourier::{
    Fourier, FourierSeries, FourierTemplate, Reading, Readings, example_templates, import,
    templates_from_toml, templates_to_toml,
};
pub use index::Index;
pub use index::IndexEntry;
pub use kes::{
    ClothAxis, ColumnRole, DecimalSign, HeightUnit, KesColumn, KesFile, KesImport, KesKnown,
    KesLook, KesOptions, KesPlace, KesReading, KesSection, KesStroke, Mark, MarkKind, PlaceUnit,
    ReturnOrder, StrokeSide,
};
pub use kes::{EVALUATED_MM, KesFigures, KesFriction, KesLine, KesOrigin};
pub use knit::{Knit, Structure};
pub use library::{Library, is_of_the_program};
pub use loaded::{Appearance, Textile};
pub use manifest::AppearanceKeys;
pub use manifest::Checker;
pub use manifest::Profiles;
pub use manifest::{Construction, Manifest, Parent, Provenance, Source};
pub use measured::KnownFigure;
pub use measured::{
    Figure as MeasuredFigure, all_known as known_figures, figures as measured_figures,
};
pub use parameter::{
    Draft, Fault, Group, Parameter, ParameterKind, Place, RECIPES, example, groups, restored,
};
pub use profile_file::read as read_profile;
pub use restoration::{Reduced, Restoration, Rule};
pub use selection::{kind_of, most_typical};
pub use trial::Trial;
pub use weave::Repeat;
pub use weave::{Interlacing, NAMES as INTERLACINGS, Weave};
pub use words::{Words, id_of, nth_id};
pub use workers::n_threads;

#[cfg(test)]
mod tests;
