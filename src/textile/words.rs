//! What people say of a textile that they bring: its name, what it is made of, whose it is.

use std::collections::BTreeMap;
use std::path::Path;

use super::TextileError;
use super::build::BuiltFile;
use super::loaded::MANIFEST;
use super::manifest::{Construction, Manifest};

/// Letters that an id may have at most.
const MOST_LETTERS: usize = 64;

/// What people say of a textile.
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    /// What it is called.
    pub name: String,
    /// How it is made.
    pub construction: Construction,
    /// What it is made of.
    pub fibre: String,
    /// The licence of its files.
    pub licence: String,
    /// One line of description.
    pub notes: String,
    /// Figures that were measured elsewhere, by the keys of a manifest's `[measured]`; they stand
    /// in place of what an import finds.
    pub figures: BTreeMap<String, f64>,
}

impl Words {
    /// A name alone.
    pub fn of(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            construction: Construction::Other,
            fibre: String::new(),
            licence: String::new(),
            notes: String::new(),
            figures: BTreeMap::new(),
        }
    }

    /// Figures that were found, with those that are said in their place.
    pub(super) fn over(&self, found: BTreeMap<String, f64>) -> BTreeMap<String, f64> {
        let mut all = found;
        all.extend(self.figures.clone());
        all
    }

    /// The same for one of several textiles of an import: "Name 2", or as it is if it is alone.
    #[must_use]
    pub fn nth(&self, nth: usize, n: usize) -> Self {
        let mut words = self.clone();
        if n > 1 && !words.name.trim().is_empty() {
            words.name = format!("{} {}", words.name.trim(), nth + 1);
        }
        words
    }
}

/// The id of one of several textiles of an import: `id-2`, or as it is if it is alone.
pub fn nth_id(id: &str, nth: usize, n: usize) -> String {
    if n > 1 {
        format!("{id}-{}", nth + 1)
    } else {
        id.to_owned()
    }
}

/// Letters of western European languages and what stands for them in an id.
const PLAIN: [(&str, &str); 12] = [
    ("àáâãäå", "a"),
    ("èéêë", "e"),
    ("ìíîï", "i"),
    ("òóôõöø", "o"),
    ("ùúûü", "u"),
    ("ýÿ", "y"),
    ("ç", "c"),
    ("ñ", "n"),
    ("ß", "ss"),
    ("æ", "ae"),
    ("œ", "oe"),
    ("ð", "d"),
];

/// The id that a name makes: lower-case letters without accents and digits, joined by hyphens.
/// Empty when nothing of the name is left.
pub fn id_of(name: &str) -> String {
    let mut plain = name.to_lowercase();
    for (letters, letter) in PLAIN {
        plain = plain.replace(|found| letters.contains(found), letter);
    }
    let words = plain.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let id: String = words.join("-").chars().take(MOST_LETTERS).collect();
    id.trim_end_matches('-').to_owned()
}

/// The manifest as a file. What would be refused when it is read is refused before it is written.
pub(super) fn manifest_file(manifest: &Manifest, path: &Path) -> Result<BuiltFile, TextileError> {
    let text = manifest.to_toml(path)?;
    Manifest::from_toml(&text, path)?;
    Ok(BuiltFile {
        name: MANIFEST.to_owned(),
        bytes: text.into_bytes(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_words_with_hyphens() {
        for (name, id) in [
            ("Wool twill (2/2), É.", "wool-twill-2-2-e"),
            ("Silk crêpe 2", "silk-crepe-2"),
            ("Öl & Straße", "ol-strasse"),
            ("../etc", "etc"),
            (" ../.. ", ""),
            ("…", ""),
        ] {
            assert_eq!(id_of(name), id, "{name}");
        }
        assert_eq!(id_of(&"x".repeat(99)).len(), MOST_LETTERS);
    }

    #[test]
    fn one_alone_keeps_its_name_and_several_are_numbered() {
        let words = Words::of("Twill");
        assert_eq!(words.nth(0, 1), words);
        assert_eq!(words.nth(1, 3).name, "Twill 2");
        assert_eq!(
            (nth_id("twill", 0, 1), nth_id("twill", 2, 3)),
            ("twill".into(), "twill-3".into())
        );
    }
}
