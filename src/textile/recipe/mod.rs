//! What a source of surfaces is to everything that is not a source: a [`Recipe`].
//!
//! A source declares its keys once ([`keys!`]); reading a manifest, checking, building, the
//! controls of a window and their help follow from them. Knows no source.

mod checker;
mod keys;
mod model;
mod parameter;
mod surface_sample;

pub(crate) use checker::Checker;
pub(crate) use keys::{ProfileFiles, SourceKeys, defaults, keys, source};
pub(crate) use model::{Model, profiles_of_files};
pub use parameter::{Group, Parameter, ParameterKind, Place};
pub(crate) use parameter::{KeySpec, KeyType, choice, parameter, parameters_of, seed};
pub use surface_sample::lit;
pub(crate) use surface_sample::{SurfaceSample, thinned};

use std::path::Path;

use crate::error::TextileError;
use crate::surface::{HeightMap, ProfileSet, Representation};

choice! {
    /// The side of a textile that is touched.
    #[derive(Default)]
    pub(crate) enum Side {
        /// The side that the recipe describes.
        #[default]
        Face = "face",
        /// The other side of the same textile.
        Back = "back",
    }
}

impl Side {
    /// Whether it is the side that a recipe describes.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    pub(crate) fn is_face(&self) -> bool {
        *self == Self::Face
    }
}

/// A source of a surface: what a manifest's `[source]` may be.
pub(crate) trait Recipe: SourceKeys {
    /// Refuses values that make no surface.
    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError>;

    /// The model that it describes; `None` if the surface was measured.
    fn model(&self) -> Result<Option<Box<dyn Model>>, TextileError> {
        Ok(None)
    }

    /// How its surface is laid out.
    fn representation(&self) -> Representation {
        Representation::Economical
    }

    /// The file of heights that it was read from, if it was.
    fn heights_file(&self) -> Option<Box<dyn HeightsFile>> {
        None
    }

    /// The file of the friction trace, if one was measured.
    fn friction(&self) -> Option<&str> {
        None
    }

    /// Units that were assumed because nothing stated them.
    fn assumed(&self) -> &[String] {
        &[]
    }

    /// Chooses the side that is touched; whether it has two.
    fn set_side(&mut self, _side: Side) -> bool {
        false
    }

    /// The kind of textile in words; `None` for what is not made of yarns.
    fn textile_kind(&self, _fibre: &str) -> Option<&'static str> {
        None
    }

    /// Its parameters, in the groups in which they are shown; none of what is no recipe.
    fn groups() -> Vec<Group>
    where
        Self: Sized,
    {
        Vec::new()
    }

    /// An example to begin with; `None` of what is no recipe.
    fn example() -> Result<Option<Example<Self>>, TextileError>
    where
        Self: Sized,
    {
        Ok(None)
    }
}

/// A file of heights beside a manifest, and how it is read.
pub(crate) trait HeightsFile {
    /// Its name.
    fn name(&self) -> &str;

    /// Its heights as a map. `path` names the file in errors.
    fn height_map(&self, bytes: &[u8], path: &Path) -> Result<HeightMap, TextileError>;

    /// The strokes over it.
    fn profiles(&self, bytes: &[u8], path: &Path) -> Result<ProfileSet, TextileError>;
}

/// An example of a recipe.
pub(crate) enum Example<R> {
    /// A textile of the shipped library.
    Shipped(&'static str),
    /// A recipe of its own.
    Own {
        /// What it is called.
        name: &'static str,
        /// The shipped textile whose construction and fibre it has, if any.
        like: Option<&'static str>,
        /// The recipe.
        recipe: R,
    },
}

impl<R> Example<R> {
    /// The same with another recipe.
    pub(crate) fn map<T>(self, wrap: impl FnOnce(R) -> T) -> Example<T> {
        match self {
            Self::Shipped(id) => Example::Shipped(id),
            Self::Own { name, like, recipe } => Example::Own {
                name,
                like,
                recipe: wrap(recipe),
            },
        }
    }
}
