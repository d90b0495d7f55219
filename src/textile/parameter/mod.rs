//! The parameters of recipes as tables: what can be set, within which bounds, and what it does.
//!
//! The reader of manifests checks numbers by the same tables that a window offers them from, so
//! there is one list of bounds.

mod draft;
mod groups;
#[cfg(test)]
mod tests;

pub use draft::{Draft, Fault, example, restored};
pub use groups::{Group, groups};

use super::TextileError;
use super::manifest::Checker;

/// The kinds of recipe, as files spell them, with what people call them.
pub const RECIPES: [(&str, &str); 5] = [
    ("weave", "Weave"),
    ("knit", "Knit"),
    ("fourier", "Fourier template"),
    ("brownian", "Brownian surface"),
    ("restoration", "Restoration"),
];

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
    pub least: f64,
    /// The largest that is taken.
    pub most: f64,
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
                checker.within(table, number.key, value, number.least..=number.most)?;
            }
        }
        Ok(())
    }
}

/// A table of numbers: a line each, `key "name" least..=most "unit" "what it does";`.
macro_rules! numbers {
    ($recipe:ty;
        $($key:ident $name:literal $least:literal ..= $most:literal $unit:literal $what:literal;)+
    ) => {
        &[$(crate::parameter::Number::<$recipe> {
            key: stringify!($key),
            name: $name,
            unit: $unit,
            least: $least,
            most: $most,
            what: $what,
            get: |recipe| crate::parameter::Figure::figure(&recipe.$key),
        }),+]
    };
}
pub(crate) use numbers;

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
        least: f64,
        /// The largest that is taken.
        most: f64,
        /// Its unit; empty for plain numbers.
        unit: &'static str,
        /// Whether only whole numbers are taken.
        is_whole: bool,
    },
    /// A number that may be left out, or stands in the place of another one that is then left out.
    Optional {
        /// The smallest that is taken.
        least: f64,
        /// The largest that is taken.
        most: f64,
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
