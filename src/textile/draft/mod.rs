//! A recipe while it is edited: its keys, of which any may be wrong for the moment.

#[cfg(test)]
mod tests;

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::library::{Library, Textile};
use crate::manifest::Manifest;
use crate::recipe::{Example, ParameterKind, Place};
use crate::sources::restoration::Restoration;
use crate::sources::{Source, example_of, groups};
use selvedge_foundation::files::{
    FileError, KeyValue, Keys, keys_from_str, keys_to_string, line_of_key, set_value, value_at,
};

/// What a draft is called where an error names a file.
const DRAFT: &str = "the recipe";

/// A recipe while it is edited: a manifest's keys. Reading it checks them all, as the reader of
/// files does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Draft {
    keys: Keys,
}

/// What is wrong with a draft.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The parameter that is wrong; `None` if it is none that can be set by itself.
    pub place: Option<Place>,
    /// What is wrong and how to mend it, one line.
    pub message: String,
}

impl Draft {
    /// The recipe of a manifest, without files, picture and figures made from it.
    ///
    /// # Errors
    /// A source that is no recipe.
    pub fn of(manifest: &Manifest) -> Result<Self, TextileError> {
        let path = Path::new(DRAFT);
        if groups(manifest.source.kind()).is_empty() {
            return Err(manifest.source.no_recipe(path));
        }
        let recipe = Manifest {
            source: manifest.source.recipe(),
            appearance: None,
            measured: std::collections::BTreeMap::new(),
            uncertainty: None,
            friction: None,
            provenance: None,
            ..manifest.clone()
        };
        let mut keys: Keys = keys_from_str(&recipe.to_toml(path)?, path)?;
        for parameter in groups(manifest.source.kind())
            .iter()
            .flat_map(|group| &group.parameters)
        {
            let Place { table, key } = parameter.place;
            let first = match parameter.kind {
                ParameterKind::Choice(words) => words.first().copied(),
                _ => None,
            };
            // Files leave out the usual words; a draft states them.
            if let (Some(word), None) = (first, value_at(&keys, table, key)) {
                set_value(&mut keys, table, key, Some(word.into()));
            }
        }
        Ok(Self { keys })
    }

    /// The kind of recipe, as files spell it.
    pub fn kind(&self) -> &str {
        let kind = value_at(&self.keys, "source", "kind");
        kind.and_then(KeyValue::as_str).unwrap_or_default()
    }

    /// The value of a parameter; `None` if it is left out.
    pub fn value(&self, place: Place) -> Option<&KeyValue> {
        value_at(&self.keys, place.table, place.key)
    }

    /// The value of a parameter as a number; `None` if it is left out or no number.
    pub fn number(&self, place: Place) -> Option<f64> {
        let value = self.value(place)?;
        let whole = || value.as_integer().and_then(|n| i32::try_from(n).ok());
        value.as_float().or_else(|| whole().map(f64::from))
    }

    /// Sets a parameter, or leaves it out.
    pub fn set(&mut self, place: Place, value: Option<KeyValue>) {
        set_value(&mut self.keys, place.table, place.key, value);
    }

    /// Whether a table of the recipe is there: the weft profile may be left out.
    pub fn has_table(&self, table: &str) -> bool {
        let (outer, inner) = table.rsplit_once('.').unwrap_or(("", table));
        value_at(&self.keys, outer, inner).is_some()
    }

    /// The manifest, checked as one that is read from a file.
    ///
    /// # Errors
    /// What is wrong, and where.
    pub fn read(&self) -> Result<Manifest, Fault> {
        let path = Path::new(DRAFT);
        let text = keys_to_string(&self.keys, path).map_err(|error| self.fault("", &error))?;
        Manifest::from_toml(&text, path).map_err(|error| match &error {
            TextileError::File(file) => self.fault(&text, file),
            other => Fault {
                place: None,
                message: other.to_string(),
            },
        })
    }

    /// What is wrong with a file, said of the parameter on its line.
    fn fault(&self, text: &str, error: &FileError) -> Fault {
        let FileError::Content {
            line, what, mend, ..
        } = error
        else {
            return Fault {
                place: None,
                message: error.to_string(),
            };
        };
        let groups = groups(self.kind());
        let mut places = groups
            .iter()
            .flat_map(|group| &group.parameters)
            .map(|parameter| parameter.place);
        let place = places.find(|&place| {
            self.value(place).is_some() && line_of_key(text, place.table, 0, place.key) == *line
        });
        Fault {
            place,
            message: format!("{what}; {mend}"),
        }
    }
}

impl Manifest {
    /// An example of a kind of recipe, to begin with.
    ///
    /// # Errors
    /// A kind that is no recipe.
    pub fn example(kind: &str) -> Result<Self, TextileError> {
        let example = example_of(kind)?.ok_or_else(|| {
            let what = format!("a source of kind \"{kind}\" is not a recipe");
            TextileError::Model(what)
        })?;
        match example {
            Example::Shipped(id) => Library::shipped()?.manifest(id),
            Example::Own { name, like, recipe } => {
                let mut manifest = Self::new(name, recipe);
                "none".clone_into(&mut manifest.fibre);
                if let Some(id) = like {
                    let like = Library::shipped()?.manifest(id)?;
                    (manifest.construction, manifest.fibre) = (like.construction, like.fibre);
                }
                Ok(manifest)
            }
        }
    }

    /// The recipe that restores a textile from its warp and its weft profile: what repeats in them
    /// and the spectrum of the rest.
    ///
    /// # Errors
    /// A textile whose profiles are too short.
    pub fn restored(textile: &Textile) -> Result<Self, TextileError> {
        use crate::surface::Direction::{WarpForward, WarpReverse, WeftForward, WeftReverse};

        let surface = textile.surface();
        let profile = |forward, reverse| {
            surface
                .profile(forward)
                .or_else(|| surface.profile(reverse))
        };
        let none = || TextileError::Model(format!("{} has no warp profile", textile.id()));
        let warp = profile(WarpForward, WarpReverse).ok_or_else(none)?;
        let recipe = Restoration::of_profiles(warp, profile(WeftForward, WeftReverse))?;
        let own = textile.manifest();
        Ok(Self {
            construction: own.construction,
            fibre: own.fibre.clone(),
            ..Self::new(
                &format!("{}, restored", own.name),
                Source::Restoration(Box::new(recipe)),
            )
        })
    }
}
