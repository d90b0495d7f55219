//! The parameters of recipes as tables: what can be set, within which bounds, and what it does.
//!
//! The reader of manifests checks by the same tables that a window offers parameters from, so there
//! is one list of bounds.

use super::Checker;
use crate::error::TextileError;

/// A key of a recipe that can be set by itself: what the reader checks and a window offers.
#[derive(Debug)]
pub(crate) struct KeySpec<R: 'static> {
    /// The key in its table.
    pub key: &'static str,
    /// What people call it.
    pub name: &'static str,
    /// What it does, in a few words.
    pub what: &'static str,
    /// The unit of a number; empty for plain ones.
    pub unit: &'static str,
    /// The smallest and the largest number that is taken; empty of what is no number.
    pub bounds: &'static [f64],
    /// What it is.
    pub kind: fn([f64; 2], &'static str) -> ParameterKind,
    /// Its numbers in a recipe; none where it is left out, or is no number.
    pub numbers: fn(&R) -> Vec<f64>,
}

impl<R> KeySpec<R> {
    fn ends(&self) -> [f64; 2] {
        self.bounds.try_into().unwrap_or([0.0; 2])
    }

    /// The first number of a recipe that is out of its bounds: its key, itself, its bounds.
    pub(crate) fn outside(keys: &[Self], recipe: &R) -> Option<(&'static str, f64, [f64; 2])> {
        keys.iter().find_map(|key| {
            let [min, max] = key.ends();
            let is_wrong = |number: &f64| !(min..=max).contains(number);
            let wrong = (key.numbers)(recipe).into_iter().find(is_wrong)?;
            Some((key.key, wrong, [min, max]))
        })
    }

    /// Refuses the first number of a recipe that is out of its bounds; `table` is where they stand.
    pub(crate) fn check(
        keys: &[Self],
        recipe: &R,
        (checker, table): (&Checker<'_>, &str),
    ) -> Result<(), TextileError> {
        match Self::outside(keys, recipe) {
            Some((key, value, [min, max])) => checker.within(table, key, value, min..=max),
            None => Ok(()),
        }
    }
}

/// What a key of a recipe may hold.
pub(crate) trait KeyType {
    /// What a window offers; bounds and unit of numbers.
    fn kind(bounds: [f64; 2], unit: &'static str) -> ParameterKind;

    /// Its numbers, which the reader checks.
    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// Says of types what parameter they are, and the numbers in them.
macro_rules! key_types {
    ($(
        $type:ty, |$bounds:pat_param, $unit:pat_param| $kind:expr, |$value:ident| $numbers:expr;
    )+) => {
        $(impl KeyType for $type {
            fn kind($bounds: [f64; 2], $unit: &'static str) -> ParameterKind {
                $kind
            }

            fn numbers(&self) -> Vec<f64> {
                let $value = self;
                $numbers
            }
        })+
    };
}

const fn number([min, max]: [f64; 2], unit: &'static str, is_whole: bool) -> ParameterKind {
    ParameterKind::Number {
        min,
        max,
        unit,
        is_whole,
    }
}

key_types! {
    f64, |bounds, unit| number(bounds, unit, false), |number| vec![*number];
    u32, |bounds, unit| number(bounds, unit, true), |number| vec![f64::from(*number)];
    u8, |bounds, unit| number(bounds, unit, true), |number| vec![f64::from(*number)];
    Option<f64>, |[min, max], unit| ParameterKind::Optional { min, max, unit, instead_of: "" },
        |number| number.iter().copied().collect();
    Vec<f64>, |_, unit| ParameterKind::Numbers(unit), |numbers| numbers.clone();
    Vec<u32>, |_, _| ParameterKind::Counts,
        |counts| counts.iter().copied().map(f64::from).collect();
    bool, |_, _| ParameterKind::Flag, |_flag| Vec::new();
    String, |_, _| ParameterKind::Colour, |_colour| Vec::new();
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

impl Group {
    pub(crate) fn new(title: &'static str, parameters: Vec<Parameter>) -> Self {
        Self { title, parameters }
    }
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

/// The keys of a table as parameters: those in `first`, then the others in their order.
pub(crate) fn parameters_of<R>(
    table: &'static str,
    keys: &[KeySpec<R>],
    first: &[&str],
) -> Vec<Parameter> {
    let place = |key: &&KeySpec<R>| {
        let place = first.iter().position(|first| *first == key.key);
        place.unwrap_or(first.len())
    };
    let mut ordered: Vec<&KeySpec<R>> = keys.iter().collect();
    ordered.sort_by_key(place);
    let parameter = |key: &KeySpec<R>| Parameter {
        place: Place {
            table,
            key: key.key,
        },
        name: key.name,
        what: key.what,
        kind: (key.kind)(key.ends(), key.unit),
    };
    ordered.into_iter().map(parameter).collect()
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

        impl crate::recipe::KeyType for $name {
            fn kind(_: [f64; 2], _: &'static str) -> crate::recipe::ParameterKind {
                crate::recipe::ParameterKind::Choice(Self::WORDS)
            }
        }
    };
}
pub(crate) use choice;
