//! `library.toml`: the order of a library's textiles, how strong each is, and its default tuning.
//!
//! It saves a program from reading every textile to know what compression to apply.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::recipe::Checker;
use crate::tactile::{Tuning, level_of_means};
use selvedge_foundation::files::{keys_from_str, keys_to_string};

/// The name of the index in a library's folder.
pub(crate) const INDEX: &str = "library.toml";

/// What `library.toml` holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Index {
    /// SHA-256 of what the figures were made from: ids, manifests and profiles in order.
    pub content_hash: String,
    /// The mean level of the textiles, dB re 1 µm.
    pub compression_reference_db: f64,
    /// The tuning of a new scene; its reference level stands above.
    pub tuning: Tuning,
    /// The textiles in the order in which they are listed.
    #[serde(rename = "textile", default)]
    pub textiles: Vec<IndexEntry>,
}

/// A textile's place in a library.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IndexEntry {
    /// The name of its folder.
    pub id: String,
    /// Mean amplitude at 40 Hz, 100 mm/s, default filters, no gain, µm.
    pub a40_um: f64,
    /// The same at 320 Hz.
    pub a320_um: f64,
}

impl IndexEntry {
    /// `½(20 log₁₀ Ā40 + 20 log₁₀ Ā320)`, dB re 1 µm; `None` when either is silent.
    pub fn level_db(&self) -> Option<f64> {
        level_of_means([self.a40_um, self.a320_um])
    }
}

impl Index {
    /// Reads an index. `path` only names it in errors.
    pub(crate) fn from_toml(text: &str, path: &Path) -> Result<Self, TextileError> {
        let index: Self = keys_from_str(text, path)?;
        let checker = Checker { text, path, nth: 0 };
        let reference = index.compression_reference_db;
        checker.within("", "compression_reference_db", reference, -1000.0..=1000.0)?;
        if let Err(error) = index.tuning.check() {
            let what = error.to_string().replace(';', ",");
            return Err(checker.wrong("tuning", error.key(), what, "correct the key"));
        }
        for (nth, entry) in index.textiles.iter().enumerate() {
            let checker = Checker { nth, ..checker };
            let is_twice = index.textiles[..nth]
                .iter()
                .any(|other| other.id == entry.id);
            if is_twice {
                let what = format!("textile \"{}\" twice", entry.id);
                return Err(checker.wrong("textile", "id", what, "remove one of them"));
            }
            checker.within("textile", "a40_um", entry.a40_um, 0.0..=1e12)?;
            checker.within("textile", "a320_um", entry.a320_um, 0.0..=1e12)?;
        }
        Ok(index)
    }

    /// The index as TOML. `path` only names it in errors.
    pub fn to_toml(&self, path: &Path) -> Result<String, TextileError> {
        Ok(keys_to_string(self, path)?)
    }

    /// The entry of a textile.
    pub fn entry(&self, id: &str) -> Option<&IndexEntry> {
        self.textiles.iter().find(|entry| entry.id == id)
    }

    /// The tuning of a new scene, with the library's reference level.
    pub fn default_tuning(&self) -> Tuning {
        let reference = self.tuning.compression_reference_db;
        let reference = reference.unwrap_or(self.compression_reference_db);
        Tuning {
            compression_reference_db: Some(reference),
            ..self.tuning
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::shipped;

    proptest! {
        #[test]
        fn no_damage_makes_the_reader_panic(
            at in 0..shipped::INDEX.len(),
            length in 0..200_usize,
            put in "[-0-9.a-z\"\n= \\[\\]]{0,12}",
        ) {
            let path = Path::new("library.toml");
            let end = (at + length).min(shipped::INDEX.len());
            let mut text = shipped::INDEX.to_owned();
            if text.is_char_boundary(at) && text.is_char_boundary(end) {
                text.replace_range(at..end, &put);
            }
            if let Ok(index) = Index::from_toml(&text, path) {
                let written = index.to_toml(path).unwrap();
                prop_assert_eq!(Index::from_toml(&written, path).unwrap(), index);
            }
        }
    }
}
