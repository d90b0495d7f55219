//! The library that is part of the program: every file of it, by textile and name.
//!
//! The bytes are embedded as they lie in `textiles/`; nothing is decoded before it is asked for.

use std::path::Path;

use crate::error::TextileError;
use crate::surface::{Direction, Profile};

/// `library.toml`.
pub(crate) const INDEX: &str = include_str!("../../textiles/library.toml");

/// The recipes of the seventy-four.
pub(crate) const RECIPES: &str = include_str!("../../textiles/seventy-four.toml");

/// The recipes of the materials of Wall & Harwin (1999).
pub(crate) const WALL_HARWIN: &str = include_str!("../../textiles/wall-harwin.toml");

/// What was measured on the seventy-four, as a `library.toml`.
pub(crate) const RECIPES_INDEX: &str = include_str!("../../textiles/seventy-four.library.toml");

/// A profile of a shipped textile.
pub(crate) fn profile(id: &str, direction: Direction) -> Result<Profile, TextileError> {
    let name = format!("{}.csv", direction.key());
    let bytes = file(id, &name).unwrap_or_default();
    Profile::read(&String::from_utf8_lossy(bytes), &Path::new(id).join(&name))
}

/// One embedded file of a textile.
macro_rules! embedded {
    ($id:literal, $name:literal) => {
        Some(include_bytes!(concat!("../../textiles/", $id, "/", $name)))
    };
}

/// The table of all textiles; each has the same six files.
macro_rules! textiles {
    ($($id:literal),+ $(,)?) => {
        /// A file of a shipped textile.
        pub(crate) fn file(id: &str, name: &str) -> Option<&'static [u8]> {
            match (id, name) {
                $(
                    ($id, "textile.toml") => embedded!($id, "textile.toml"),
                    ($id, "warp_forward.csv") => embedded!($id, "warp_forward.csv"),
                    ($id, "warp_reverse.csv") => embedded!($id, "warp_reverse.csv"),
                    ($id, "weft_forward.csv") => embedded!($id, "weft_forward.csv"),
                    ($id, "weft_reverse.csv") => embedded!($id, "weft_reverse.csv"),
                    ($id, "appearance.png") => embedded!($id, "appearance.png"),
                )+
                _ => None,
            }
        }
    };
}

textiles![
    "silk-crepe",
    "wool-twill",
    "jute-plain",
    "denim",
    "polyester-satin",
    "polyamide-taffeta",
    "polyester-panama",
    "polyester-honeycomb",
    "polyamide-jersey",
    "polyester-slub-jersey",
    "polyester-interlock",
    "polyester-pique",
    "polyamide-rib",
    "wool-rib",
    "polyester-fleece",
    "polyester-terry",
];
