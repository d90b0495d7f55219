//! Enums whose values files and people call by names: each name is declared once, and reading,
//! writing and what is said of a wrong one follow.

use serde::de::{Deserialize as _, Deserializer, Error as _};

/// An enum of [`named!`].
pub(crate) trait Named: Copy + 'static {
    /// All of them with their names, in order.
    fn named() -> Vec<(&'static str, Self)>;
}

/// Reads the name that a key of a file holds.
pub(crate) fn read_name<'de, T: Named, D: Deserializer<'de>>(
    key: &str,
    from: D,
) -> Result<T, D::Error> {
    let text = String::deserialize(from)?;
    let all = T::named();
    let found = all.iter().find(|(name, _)| *name == text);
    found.map(|(_, one)| *one).ok_or_else(|| {
        let names = all.iter().map(|(name, _)| format!("{name:?}"));
        let names = names.collect::<Vec<String>>().join(" or ");
        D::Error::custom(format!(
            "{key} is {text:?}, which is not known; give {names}"
        ))
    })
}

/// Declares an enum with the names of its variants, and the key that holds one in a file.
macro_rules! named {
    ($key:literal, $(#[$meta:meta])* $vis:vis enum $enum:ident {
        $($(#[$doc:meta])* $variant:ident = $name:literal,)+
    }) => {
        selvedge_foundation::named! {
            $(#[$meta])*
            #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
            $vis enum $enum {
                $($(#[$doc])* $variant = $name,)+
            }
            /// As files and people call it.
            $vis fn name;
        }

        impl $crate::named::Named for $enum {
            fn named() -> Vec<(&'static str, Self)> {
                Self::ALL.map(|one| (one.name(), one)).into()
            }
        }

        impl<'de> serde::Deserialize<'de> for $enum {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                $crate::named::read_name($key, from)
            }
        }
    };
}
pub(crate) use named;
