//! The parameters of recipes as tables: what can be set, within which bounds, and what it does.
//!
//! The reader of manifests checks numbers by the same tables that a window offers them from, so
//! there is one list of bounds.

use super::Checker;
use crate::error::TextileError;

/// A number of a recipe: what the reader checks and a window offers.
#[derive(Debug)]
pub(crate) struct Number<R: 'static> {
    /// The key in its table.
    pub key: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// Its unit; empty for plain numbers.
    pub unit: &'static str,
    /// The smallest that is taken.
    pub min: f64,
    /// The largest that is taken.
    pub max: f64,
    /// What it does, in a few words.
    pub what: &'static str,
    /// Its value in a recipe; `None` where it is left out.
    pub get: fn(&R) -> Option<f64>,
}

impl<R> Number<R> {
    /// Refuses the first number of a recipe that is out of its bounds; `table` is where they stand.
    pub(crate) fn check(
        numbers: &[Self],
        recipe: &R,
        (checker, table): (&Checker<'_>, &str),
    ) -> Result<(), TextileError> {
        for number in numbers {
            if let Some(value) = (number.get)(recipe) {
                checker.within(table, number.key, value, number.min..=number.max)?;
            }
        }
        Ok(())
    }
}

/// What a key of a recipe may hold a number as.
pub(crate) trait Figure {
    /// The number; `None` if it is left out.
    fn figure(&self) -> Option<f64>;
}

impl Figure for f64 {
    fn figure(&self) -> Option<f64> {
        Some(*self)
    }
}

impl Figure for u32 {
    fn figure(&self) -> Option<f64> {
        Some(f64::from(*self))
    }
}

impl Figure for u8 {
    fn figure(&self) -> Option<f64> {
        Some(f64::from(*self))
    }
}

impl Figure for Option<f64> {
    fn figure(&self) -> Option<f64> {
        *self
    }
}

/// Where a parameter stands in a manifest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    /// Its table, `source.warp` for one; empty for the top of the file.
    pub table: &'static str,
    /// Its key.
    pub key: &'static str,
}

/// What a parameter is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParameterKind {
    /// A number.
    Number {
        /// The smallest that is taken.
        min: f64,
        /// The largest that is taken.
        max: f64,
        /// Its unit; empty for plain numbers.
        unit: &'static str,
        /// Whether only whole numbers are taken.
        is_whole: bool,
    },
    /// A number that may be left out, or stands in the place of another one that is then left out.
    Optional {
        /// The smallest that is taken.
        min: f64,
        /// The largest that is taken.
        max: f64,
        /// Its unit.
        unit: &'static str,
        /// The key that it excludes; empty if none.
        instead_of: &'static str,
    },
    /// One of several words.
    Choice(&'static [&'static str]),
    /// Yes or no.
    Flag,
    /// The number that irregularities are drawn from.
    Seed,
    /// Several numbers, with their unit.
    Numbers(&'static str),
    /// Several whole numbers.
    Counts,
    /// A colour, `#rrggbb`.
    Colour,
    /// An interlacing: one of the names, or rows of crossings.
    Interlacing,
    /// A Fourier template, one of the examples or its own.
    Template {
        /// Whether it may be left out.
        is_optional: bool,
    },
}

/// A parameter of a recipe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Where it stands.
    pub place: Place,
    /// What people call it.
    pub name: &'static str,
    /// What it does, in a few words.
    pub what: &'static str,
    /// What it is.
    pub kind: ParameterKind,
}

/// Parameters that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Their title.
    pub title: &'static str,
    /// The parameters, in order.
    pub parameters: Vec<Parameter>,
}

/// A parameter of the source itself.
pub(crate) fn parameter(
    key: &'static str,
    (name, what): (&'static str, &'static str),
    kind: ParameterKind,
) -> Parameter {
    let table = "source";
    Parameter {
        place: Place { table, key },
        name,
        what,
        kind,
    }
}

/// The number that irregularities are drawn from.
pub(crate) fn seed() -> Parameter {
    parameter(
        "seed",
        (
            "Seed",
            "Chooses the irregularities: another seed, another piece",
        ),
        ParameterKind::Seed,
    )
}

/// The numbers of a table as parameters: those in `first`, then the others in their order.
pub(crate) fn numbers_of<R>(
    table: &'static str,
    numbers: &[Number<R>],
    first: &[&str],
) -> Vec<Parameter> {
    let place = |number: &&Number<R>| {
        let place = first.iter().position(|key| *key == number.key);
        place.unwrap_or(first.len())
    };
    let mut ordered: Vec<&Number<R>> = numbers.iter().collect();
    ordered.sort_by_key(place);
    let parameter = |number: &Number<R>| Parameter {
        place: Place {
            table,
            key: number.key,
        },
        name: number.name,
        what: number.what,
        kind: ParameterKind::Number {
            min: number.min,
            max: number.max,
            unit: number.unit,
            is_whole: false,
        },
    };
    ordered.into_iter().map(parameter).collect()
}

/// The same number where it may be left out.
pub(crate) fn optional(kind: ParameterKind, instead_of: &'static str) -> ParameterKind {
    match kind {
        ParameterKind::Number { min, max, unit, .. } => ParameterKind::Optional {
            min,
            max,
            unit,
            instead_of,
        },
        other => other,
    }
}

/// Declares an enum with the words that files use for its variants: `Variant = "word",`.
macro_rules! choice {
    ($(#[$meta:meta])* $vis:vis enum $name:ident {
        $( $(#[$variant_meta:meta])* $variant:ident = $word:literal, )+
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        $vis enum $name {
            $( $(#[$variant_meta])* #[serde(rename = $word)] $variant, )+
        }

        impl $name {
            /// The words of files, in order.
            pub(crate) const WORDS: &'static [&'static str] = &[$($word),+];
        }
    };
}
pub(crate) use choice;
