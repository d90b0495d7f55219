//! `textile.toml`: what a textile is called, what it is, and where its surface comes from.
//!
//! A source has exactly one kind; a kind is a struct of its own that owns its keys. Every value is
//! checked when the file is read, and errors name the line.

mod measured;
mod provenance;
mod uncertainty;

pub use measured::{Figure, KnownFigure};
pub use provenance::{Parent, Provenance};
pub use uncertainty::Uncertainty;

use std::collections::BTreeMap;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::error::TextileError;
use crate::recipe::Checker;
use crate::sources::{self, KINDS, ReadKind, Source};
use crate::tactile::Tuning;
use selvedge_foundation::files::{FileError, keys_from_str, keys_to_string};
use selvedge_foundation::named;

/// The name of a manifest in its textile's folder.
pub(crate) const MANIFEST: &str = "textile.toml";

/// A textile's manifest. `S` is the source: [`Source`], or one kind of it while reading.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest<S = Source> {
    /// What people call it.
    pub name: String,
    /// How it is made.
    pub construction: Construction,
    /// What it is made of.
    pub fibre: String,
    /// Gain of this textile wherever it is placed, dB.
    #[serde(default)]
    pub gain_db: f64,
    /// A constant power density that is taken off its spectra, µm² per cycle/mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise_floor_um2_mm: Option<f64>,
    /// The licence of the textile's files.
    #[serde(default)]
    pub licence: String,
    /// One line of description.
    #[serde(default)]
    pub notes: String,
    /// A CSV of `x_mm,mu` beside the manifest: friction that the source itself does not have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<String>,
    /// Where the surface comes from.
    pub source: S,
    /// What it looks like.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub appearance: Option<AppearanceKeys>,
    /// Figures with units in their names, such as `smd_um`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub measured: BTreeMap<String, f64>,
    /// How far values may be off that were not measured on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<Uncertainty>,
    /// The textiles that it was made from, and by which program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
}

named! {
    /// How a textile is made.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum Construction {
        /// Two sets of yarns that cross.
        Woven = "woven",
        /// Loops.
        Knitted = "knitted",
        /// Bonded fibres.
        Nonwoven = "nonwoven",
        /// Anything else.
        #[default]
        Other = "other",
    }
    /// The word that files use.
    pub fn word;
}

/// The picture of a textile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AppearanceKeys {
    /// A PNG beside the manifest; it is tiled from the textile's origin.
    pub image: String,
    /// Its scale.
    pub px_per_mm: f64,
}

impl Manifest {
    /// A manifest with a name and a source, and nothing else said.
    pub(crate) fn new(name: &str, source: Source) -> Self {
        Self {
            name: name.to_owned(),
            construction: Construction::Other,
            fibre: String::new(),
            gain_db: 0.0,
            noise_floor_um2_mm: None,
            licence: String::new(),
            notes: String::new(),
            friction: None,
            source,
            appearance: None,
            measured: BTreeMap::new(),
            uncertainty: None,
            provenance: None,
        }
    }

    /// Reads a manifest. `path` only names it in errors.
    ///
    /// # Errors
    /// Unknown or missing keys, values out of range: one line with file, line and mend.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, TextileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let checker = Checker { text, path, nth: 0 };
        let kind = kind_of(&checker)?;
        let manifest = sources::read_kind(&kind, Reader { text, path }).ok_or_else(|| {
            let mend = format!("the kinds are {}", KINDS.join(", "));
            let what = format!("unknown kind of source \"{kind}\"");
            checker.wrong("source", "kind", what, mend)
        })??;
        manifest.check(&checker)?;
        Ok(manifest)
    }

    /// The file of its friction, measured or not; `None` where it has none.
    pub(crate) fn friction_file(&self) -> Option<&str> {
        let own = self.source.keys().friction();
        own.or(self.friction.as_deref())
    }

    /// The manifest as TOML. `path` only names it in errors.
    pub fn to_toml(&self, path: &Path) -> Result<String, TextileError> {
        Ok(keys_to_string(self, path)?)
    }

    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        if self.name.trim().is_empty() {
            return Err(checker.wrong("", "name", "the name is empty", "give the textile a name"));
        }
        Tuning::check_gain("gain_db", self.gain_db).map_err(|error| {
            let what = error.to_string().replace(';', ",");
            checker.wrong("", "gain_db", what, "write a number of dB")
        })?;
        if let Some(floor) = self.noise_floor_um2_mm {
            checker.within("", "noise_floor_um2_mm", floor, 0.0..=1e6)?;
        }
        if let Some(appearance) = &self.appearance {
            checker.within("appearance", "px_per_mm", appearance.px_per_mm, 0.1..=200.0)?;
            checker.file_name("appearance", "image", Some(&appearance.image))?;
        }
        for (key, value) in &self.measured {
            measured::check(checker, key, *value)?;
        }
        if let Some(uncertainty) = &self.uncertainty {
            uncertainty.check(checker)?;
        }
        if let Some(provenance) = &self.provenance {
            provenance.check(checker)?;
        }
        checker.file_name("", "friction", self.friction.as_deref())?;
        if self.friction.is_some() && self.source.keys().friction().is_some() {
            let mend = "keep one of both";
            return Err(checker.wrong("", "friction", "the source has friction of its own", mend));
        }
        self.source.check(checker)
    }
}

impl<S> Manifest<S> {
    fn map<T>(self, wrap: impl FnOnce(S) -> T) -> Manifest<T> {
        Manifest {
            name: self.name,
            construction: self.construction,
            fibre: self.fibre,
            gain_db: self.gain_db,
            noise_floor_um2_mm: self.noise_floor_um2_mm,
            licence: self.licence,
            notes: self.notes,
            friction: self.friction,
            source: wrap(self.source),
            appearance: self.appearance,
            measured: self.measured,
            uncertainty: self.uncertainty,
            provenance: self.provenance,
        }
    }
}

/// Reads a manifest whose kind of source is known.
struct Reader<'a> {
    text: &'a str,
    path: &'a Path,
}

impl ReadKind for Reader<'_> {
    type Read = Result<Manifest, FileError>;

    fn read<K: DeserializeOwned>(self, source: impl FnOnce(K) -> Source) -> Self::Read {
        let manifest: Manifest<K> = keys_from_str(self.text, self.path)?;
        Ok(manifest.map(source))
    }
}

/// The kind of the source: read first, so that the keys of that kind can be read with their lines.
fn kind_of(checker: &Checker<'_>) -> Result<String, TextileError> {
    #[derive(Deserialize)]
    struct File {
        source: Option<Tag>,
    }
    #[derive(Deserialize)]
    struct Tag {
        kind: Option<String>,
    }
    let file: File = keys_from_str(checker.text, checker.path)?;
    file.source.and_then(|source| source.kind).ok_or_else(|| {
        let mend = format!("add [source] with kind = one of {}", KINDS.join(", "));
        checker.wrong("source", "kind", "no kind of source", mend)
    })
}

#[cfg(test)]
mod tests;
