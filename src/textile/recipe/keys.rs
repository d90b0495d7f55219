//! The keys of a source in a manifest, declared once: a struct that serde reads and writes, and a
//! table of its numbers with their bounds, from which the reader checks and a window offers them.

use crate::surface::Direction;

/// Profile files by [`Direction::index`], beside the manifest.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct ProfileFiles(pub [Option<String>; 4]);

impl ProfileFiles {
    /// The four files of a textile that is built.
    pub(crate) fn all() -> Self {
        Self(Direction::ALL.map(|direction| Some(Self::name(direction))))
    }

    /// What the file of a direction is called.
    pub(crate) fn name(direction: Direction) -> String {
        format!("{}.csv", direction.key())
    }

    /// Whether no file is named.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// The file of a direction.
    pub(crate) fn of(&self, direction: Direction) -> Option<&str> {
        self.0[direction.index()].as_deref()
    }
}

/// The keys that every source has alike.
pub(crate) trait SourceKeys {
    /// The kind of source, as the file spells it.
    fn kind(&self) -> &str;

    /// The profile files that are named; a recipe may name none.
    fn files(&self) -> ProfileFiles;

    /// Hash of the recipe that the profile files were made from; `None` if they are the source.
    fn recipe_hash(&self) -> Option<&str> {
        None
    }

    /// Names the profile files, and the recipe that they were made from.
    fn set_files(&mut self, files: ProfileFiles, recipe_hash: Option<String>);
}

/// Declares the keys of a `source`, with those that all sources have alike before its own, or of a
/// `table` within one.
///
/// A key is a field. One that can be set by itself states `=> "name": "what it does"`, a number
/// `=> "name" min..=max "unit" "what it does"`: a line of the table `KEYS`, by which the reader
/// checks and which a window offers.
macro_rules! keys {
    ($(#[$meta:meta])* source $keys:ident { $($fields:tt)* }) => {
        crate::recipe::keys! {
            $(#[$meta])* table pub $keys {
                /// The kind of source.
                pub(crate) kind: String,
                /// Hash of the recipe that the profiles came from.
                #[serde(skip_serializing_if = "Option::is_none")]
                pub(crate) recipe_hash: Option<String>,
                /// See [`crate::recipe::ProfileFiles`].
                #[serde(skip_serializing_if = "Option::is_none")]
                pub(crate) warp_forward: Option<String>,
                /// See [`crate::recipe::ProfileFiles`].
                #[serde(skip_serializing_if = "Option::is_none")]
                pub(crate) warp_reverse: Option<String>,
                /// See [`crate::recipe::ProfileFiles`].
                #[serde(skip_serializing_if = "Option::is_none")]
                pub(crate) weft_forward: Option<String>,
                /// See [`crate::recipe::ProfileFiles`].
                #[serde(skip_serializing_if = "Option::is_none")]
                pub(crate) weft_reverse: Option<String>,
                $($fields)*
            }
        }

        impl crate::recipe::SourceKeys for $keys {
            fn kind(&self) -> &str {
                &self.kind
            }

            fn files(&self) -> crate::recipe::ProfileFiles {
                crate::recipe::ProfileFiles([
                    self.warp_forward.clone(),
                    self.warp_reverse.clone(),
                    self.weft_forward.clone(),
                    self.weft_reverse.clone(),
                ])
            }

            fn recipe_hash(&self) -> Option<&str> {
                self.recipe_hash.as_deref()
            }

            fn set_files(
                &mut self,
                files: crate::recipe::ProfileFiles,
                recipe_hash: Option<String>,
            ) {
                [
                    self.warp_forward,
                    self.warp_reverse,
                    self.weft_forward,
                    self.weft_reverse,
                ] = files.0;
                self.recipe_hash = recipe_hash;
            }
        }
    };
    ($(#[$meta:meta])* table $struct_vis:vis $keys:ident {
        $(
            $(#[$field_meta:meta])* $vis:vis $field:ident: $type:ty
            $(=> $name:literal
                $($min:literal ..= $max:literal $unit:literal $what:literal)? $(: $text:literal)?
            )?,
        )*
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        $struct_vis struct $keys {
            $(
                $(#[$field_meta])* $($(#[doc = $what])? $(#[doc = $text])?)?
                $vis $field: $type,
            )*
        }

        impl $keys {
            /// Those that can be set by themselves, in their order.
            pub(crate) const KEYS: &'static [crate::recipe::KeySpec<Self>] = &[
                $($(
                    crate::recipe::KeySpec {
                        key: stringify!($field),
                        name: $name,
                        what: concat!($($what)? $($text)?),
                        unit: concat!($($unit)?),
                        bounds: &[$($min, $max)?],
                        kind: <$type as crate::recipe::KeyType>::kind,
                        numbers: |keys| crate::recipe::KeyType::numbers(&keys.$field),
                    },
                )?)*
            ];
        }
    };
}
pub(crate) use keys;

/// A source with these keys of its own, and no file made from it yet.
macro_rules! source {
    ($keys:ident = $kind:literal { $($own:tt)* }) => {
        $keys {
            kind: $kind.to_owned(),
            recipe_hash: None,
            warp_forward: None,
            warp_reverse: None,
            weft_forward: None,
            weft_reverse: None,
            $($own)*
        }
    };
}
pub(crate) use source;

/// Declares what keys are where a file leaves them out, as functions that serde calls.
macro_rules! defaults {
    ($($(#[$meta:meta])* $name:ident: $type:ty = $value:expr;)+) => {
        $($(#[$meta])* pub(crate) fn $name() -> $type {
            $value
        })+
    };
}
pub(crate) use defaults;
