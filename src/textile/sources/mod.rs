//! Where surfaces come from: the list of all sources.
//!
//! A source is a file or a folder here and a line in the list below: its keys, its surface, and
//! what it is to a window, behind the trait [`Recipe`]. Sources know nothing of manifests or
//! libraries.

pub(crate) mod brownian;
pub(crate) mod fourier;
pub(crate) mod heightmap;
pub(crate) mod knit;
pub(crate) mod picture;
pub(crate) mod profiles;
pub(crate) mod restoration;
pub(crate) mod weave;

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::TextileError;
use crate::recipe::{Checker, Example, Group, Model, ProfileFiles, Recipe};
use crate::surface::{Direction, HeightMap, Representation, SurfaceError};
use brownian::Brownian;
use fourier::Fourier;
use heightmap::Heightmap;
use knit::Knit;
use picture::PictureSource;
use profiles::Profiles;
use restoration::Restoration;
use selvedge_foundation::files::{keys_to_string, sha256_hex};
use weave::Weave;

/// The list: a variant, its keys, how files spell its kind, and what people call it if it is a
/// recipe.
macro_rules! sources {
    ($( $(#[$doc:meta])* $variant:ident($keys:ty)
        = $kind:literal $(or $other:literal)? $(recipe $label:literal)?; )+) => {
        /// Where a surface comes from: exactly one kind.
        #[derive(Debug, Clone, PartialEq, Serialize)]
        #[serde(untagged)]
        pub enum Source {
            $( $(#[$doc])* $variant(Box<$keys>), )+
        }

        /// The kinds of source, as files spell them.
        pub(crate) const KINDS: &[&str] = &[$($kind, $($other,)?)+];

        /// The kinds of recipe, as files spell them, with what people call them.
        pub const RECIPES: &[(&str, &str)] = &[$($(($kind, $label),)?)+];

        impl Source {
            /// What every source can say of itself.
            pub(crate) fn keys(&self) -> &dyn Recipe {
                match self {
                    $( Self::$variant(keys) => &**keys, )+
                }
            }

            /// The same, to be changed.
            pub(crate) fn keys_mut(&mut self) -> &mut dyn Recipe {
                match self {
                    $( Self::$variant(keys) => &mut **keys, )+
                }
            }
        }

        /// Reads something with the keys of a kind; `None` if there is no such kind.
        pub(crate) fn read_kind<R: ReadKind>(kind: &str, reader: R) -> Option<R::Read> {
            match kind {
                $( $kind $(| $other)? => {
                    Some(reader.read(|keys: $keys| Source::$variant(Box::new(keys))))
                } )+
                _ => None,
            }
        }

        /// The parameters of a kind of recipe; none of what is no recipe.
        pub fn groups(kind: &str) -> Vec<Group> {
            match kind {
                $( $kind => <$keys>::groups(), )+
                _ => Vec::new(),
            }
        }

        /// An example of a kind of recipe; `None` of what is no recipe.
        pub(crate) fn example_of(kind: &str) -> Result<Option<Example<Source>>, TextileError> {
            Ok(match kind {
                $( $kind => <$keys>::example()?.map(|example| {
                    example.map(|keys| Source::$variant(Box::new(keys)))
                }), )+
                _ => None,
            })
        }
    };
}

sources! {
    /// Measured profiles.
    Profiles(Profiles) = "profiles";
    /// A model of a woven textile.
    Weave(Weave) = "weave" recipe "Weave";
    /// A model of a knitted textile.
    Knit(Knit) = "knit" recipe "Knit";
    /// A surface drawn from a template of harmonics.
    Fourier(Fourier) = "fourier" recipe "Fourier template";
    /// A Brownian surface.
    Brownian(Brownian) = "brownian" recipe "Brownian surface";
    /// A surface restored from what repeats in two profiles.
    Restoration(Restoration) = "restoration" recipe "Restoration";
    /// A file of measured heights.
    Heightmap(Heightmap) = "heightmap" or "x3p";
    /// Heights found on a picture.
    Picture(PictureSource) = "picture";
}

/// What is read of a file once the kind of its source is known.
pub(crate) trait ReadKind {
    /// What it becomes.
    type Read;

    /// Reads it with these keys.
    fn read<K: DeserializeOwned>(self, source: impl FnOnce(K) -> Source) -> Self::Read;
}

impl Source {
    /// The kind, as files spell it.
    pub fn kind(&self) -> &str {
        self.keys().kind()
    }

    /// Whether a surface can be built from it: it was not measured.
    pub(crate) fn is_recipe(&self) -> bool {
        RECIPES.iter().any(|(kind, _)| *kind == self.kind())
    }

    /// Units that were assumed because nothing stated them, in words.
    pub fn assumed(&self) -> Option<String> {
        let all = self.keys().assumed();
        (!all.is_empty()).then(|| format!("{} (no unit is stated)", all.join(", ")))
    }

    /// How its surface is laid out.
    pub fn representation(&self) -> Representation {
        self.keys().representation()
    }

    /// The recipe alone: a model without the files that were made from it.
    #[must_use]
    pub fn recipe(&self) -> Self {
        let mut recipe = self.clone();
        recipe.set_files(ProfileFiles::default(), None);
        recipe
    }

    /// Names a model's profile files and the recipe that they came from.
    pub(crate) fn set_files(&mut self, files: ProfileFiles, recipe_hash: Option<String>) {
        self.keys_mut().set_files(files, recipe_hash);
    }

    /// SHA-256 of the recipe as this program writes it.
    pub fn recipe_hash(&self, path: &Path) -> Result<String, TextileError> {
        let text = keys_to_string(&self.recipe(), path)?;
        Ok(sha256_hex([text.as_bytes()]))
    }

    /// Refuses values that make no surface.
    pub(crate) fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        let keys = self.keys();
        keys.check(checker)?;
        let files = keys.files();
        for direction in Direction::ALL {
            checker.file_name("source", direction.key(), files.of(direction))?;
        }
        Ok(())
    }

    /// The model that it describes. `path` names it in errors.
    ///
    /// # Errors
    /// A source that is no recipe.
    pub(crate) fn model(&self, path: &Path) -> Result<Box<dyn Model>, TextileError> {
        let model = self.keys().model()?;
        model.ok_or_else(|| self.no_recipe(path))
    }

    /// The heights over an area that the source knows; `None` if it knows profiles only. A model's
    /// relief takes a second or so.
    pub fn height_map(&self) -> Option<Result<HeightMap, SurfaceError>> {
        self.keys().model().ok().flatten()?.height_map()
    }

    /// The relief of a model with points about so far apart, mm; `None` for what is no recipe.
    pub fn relief(&self, step_mm: f64) -> Option<Result<HeightMap, SurfaceError>> {
        Some(self.keys().model().ok().flatten()?.relief(step_mm))
    }

    /// This is no recipe: what would be.
    pub(crate) fn no_recipe(&self, path: &Path) -> TextileError {
        let mut kinds: Vec<String> = RECIPES
            .iter()
            .map(|(kind, _)| format!("\"{kind}\""))
            .collect();
        let last = kinds.pop().unwrap_or_default();
        TextileError::NoRecipe {
            path: PathBuf::from(path),
            kind: self.kind().to_owned(),
            recipes: format!("{} or {last}", kinds.join(", ")),
        }
    }
}
