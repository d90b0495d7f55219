//! Enumerations whose variants have words.

/// An enumeration, each of whose variants has a word or two, with a constant `ALL` of its variants
/// in order and a method for each column of words.
///
/// ```
/// selvedge_foundation::named! {
///     /// A side.
///     #[derive(Debug, Clone, Copy, PartialEq)]
///     pub enum Side {
///         /// What is worn outside.
///         Face = "face",
///         /// The other one.
///         Back = "back",
///     }
///     /// Its word in files.
///     pub fn word;
/// }
/// assert_eq!(Side::ALL.map(Side::word), ["face", "back"]);
/// ```
#[macro_export]
macro_rules! named {
    (
        $(#[$meta:meta])* $vis:vis enum $name:ident {
            $($(#[$of_variant:meta])* $variant:ident = $word:literal,)+
        }
        $(#[$of_fn:meta])* $fn_vis:vis fn $fn:ident;
    ) => {
        $(#[$meta])*
        $vis enum $name {
            $($(#[$of_variant])* $variant,)+
        }

        impl $name {
            /// All of them, in order.
            $vis const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

            $(#[$of_fn])*
            $fn_vis fn $fn(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }
        }
    };
    (
        $(#[$meta:meta])* $vis:vis enum $name:ident {
            $($(#[$of_variant:meta])* $variant:ident = $word:literal, $other_word:literal,)+
        }
        $(#[$of_fn:meta])* $fn_vis:vis fn $fn:ident;
        $(#[$of_other:meta])* $other_vis:vis fn $other:ident;
    ) => {
        $crate::named! {
            $(#[$meta])* $vis enum $name {
                $($(#[$of_variant])* $variant = $word,)+
            }
            $(#[$of_fn])* $fn_vis fn $fn;
        }

        impl $name {
            $(#[$of_other])*
            $other_vis fn $other(self) -> &'static str {
                match self {
                    $(Self::$variant => $other_word,)+
                }
            }
        }
    };
}
