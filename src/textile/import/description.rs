//! What people say of a textile that they bring: its name, what it is made of, whose it is.

use std::collections::BTreeMap;
use std::path::Path;

use crate::build::BuiltFile;
use crate::error::TextileError;
use crate::manifest::{Construction, MANIFEST, Manifest, Provenance};
use crate::sources::Source;

/// What people say of a textile.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Description {
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

impl Description {
    /// A name alone.
    pub fn of(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    /// The manifest of what is imported now: from no other textile, by this program.
    pub(super) fn manifest(&self, source: Source, found: BTreeMap<String, f64>) -> Manifest {
        let mut measured = found;
        measured.extend(self.figures.clone());
        Manifest {
            construction: self.construction,
            fibre: self.fibre.clone(),
            licence: self.licence.clone(),
            notes: self.notes.clone(),
            measured,
            provenance: Some(Provenance::of(Vec::new())),
            ..Manifest::new(&self.name, source)
        }
    }

    /// The same for one of several textiles of an import: "Name 2", or as it is if it is alone.
    #[must_use]
    pub fn nth(&self, nth: usize, n: usize) -> Self {
        let mut description = self.clone();
        if n > 1 && !description.name.trim().is_empty() {
            description.name = format!("{} {}", description.name.trim(), nth + 1);
        }
        description
    }
}

/// The manifest as a file. What would be refused when it is read is refused before it is written.
pub(super) fn manifest_file(manifest: &Manifest, path: &Path) -> Result<BuiltFile, TextileError> {
    let text = manifest.to_toml(path)?;
    Manifest::from_toml(&text, path)?;
    Ok(BuiltFile::new(MANIFEST, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_alone_keeps_its_name_and_several_are_numbered() {
        let description = Description::of("Twill");
        assert_eq!(description.nth(0, 1), description);
        assert_eq!(description.nth(1, 3).name, "Twill 2");
    }
}
