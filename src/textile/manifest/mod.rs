//! `textile.toml`: what a textile is called, what it is, and where its surface comes from.
//!
//! A source has exactly one kind; a kind is a struct of its own that owns its keys. Every value is
//! checked when the file is read, and errors name the line.

mod checker;
mod profiles;
mod provenance;

pub use checker::Checker;
pub(crate) use profiles::ProfileFiles;
pub use profiles::Profiles;
pub(crate) use profiles::profile_file_keys;
pub use provenance::{Parent, Provenance};

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::TextileError;
use super::brownian::Brownian;
use super::fourier::Fourier;
use super::knit::Knit;
use super::measured;
use super::metrology::Heightmap;
use super::picture::PictureSource;
use super::restoration::Restoration;
use super::weave::Weave;
use crate::surface::{Direction, Representation};
use crate::tactile::check_gain;
use selvedge_foundation::files::{FileError, keys_from_str, keys_to_string, sha256_hex};

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
    /// Where the surface comes from.
    pub source: S,
    /// What it looks like.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub appearance: Option<AppearanceKeys>,
    /// Figures with units in their names, such as `smd_um`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub measured: BTreeMap<String, f64>,
    /// The textiles that it was made from, and by which program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
}

/// How a textile is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Construction {
    /// Two sets of yarns that cross.
    Woven,
    /// Loops.
    Knitted,
    /// Bonded fibres.
    Nonwoven,
    /// Anything else.
    Other,
}

impl Construction {
    /// The word that files use.
    pub fn word(self) -> &'static str {
        match self {
            Self::Woven => "woven",
            Self::Knitted => "knitted",
            Self::Nonwoven => "nonwoven",
            Self::Other => "other",
        }
    }
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

/// Where a surface comes from: exactly one kind.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Source {
    /// Measured profiles.
    Profiles(Profiles),
    /// A model of a woven cloth.
    Weave(Box<Weave>),
    /// A model of a knitted cloth.
    Knit(Box<Knit>),
    /// A surface drawn from a template of harmonics.
    Fourier(Box<Fourier>),
    /// A Brownian surface.
    Brownian(Box<Brownian>),
    /// A surface restored from what repeats in two profiles.
    Restoration(Box<Restoration>),
    /// A file of measured heights.
    Heightmap(Box<Heightmap>),
    /// Heights found on a picture.
    Picture(Box<PictureSource>),
}

/// The kinds of source, as files spell them.
const KINDS: [&str; 9] = [
    "profiles",
    "weave",
    "knit",
    "fourier",
    "brownian",
    "restoration",
    "heightmap",
    "x3p",
    "picture",
];

impl Source {
    /// The kind, as files spell it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Profiles(_) => KINDS[0],
            Self::Weave(_) => KINDS[1],
            Self::Knit(_) => KINDS[2],
            Self::Fourier(_) => KINDS[3],
            Self::Brownian(_) => KINDS[4],
            Self::Restoration(_) => KINDS[5],
            Self::Heightmap(keys) => KINDS[if keys.kind == "x3p" { 7 } else { 6 }],
            Self::Picture(_) => KINDS[8],
        }
    }

    /// The profile files that the manifest names; models may name none.
    pub(crate) fn files(&self) -> ProfileFiles {
        match self {
            Self::Profiles(keys) => ProfileFiles([
                keys.warp_forward.clone(),
                keys.warp_reverse.clone(),
                keys.weft_forward.clone(),
                keys.weft_reverse.clone(),
            ]),
            Self::Weave(keys) => keys.files(),
            Self::Knit(keys) => keys.files(),
            Self::Fourier(keys) => keys.files(),
            Self::Brownian(keys) => keys.files(),
            Self::Restoration(keys) => keys.files(),
            Self::Heightmap(keys) => keys.files(),
            Self::Picture(keys) => keys.files(),
        }
    }

    /// How its surface is laid out.
    pub fn representation(&self) -> Representation {
        match self {
            Self::Profiles(_) | Self::Fourier(_) | Self::Brownian(_) | Self::Restoration(_) => {
                Representation::Economical
            }
            Self::Weave(keys) => keys.representation,
            Self::Knit(keys) => keys.representation,
            Self::Heightmap(keys) => keys.representation,
            Self::Picture(keys) => keys.representation,
        }
    }

    /// The file of heights that it is kept as, if it is, and how that is read.
    pub(crate) fn kept_map(&self) -> Option<Cow<'_, Heightmap>> {
        match self {
            Self::Heightmap(keys) => Some(Cow::Borrowed(keys)),
            Self::Picture(keys) => Some(Cow::Owned(keys.map())),
            _ => None,
        }
    }

    /// The file of the friction trace, if one was measured.
    pub fn friction(&self) -> Option<&str> {
        match self {
            Self::Profiles(keys) => keys.friction.as_deref(),
            _ => None,
        }
    }

    /// The recipe alone: a model without the files that were made from it.
    #[must_use]
    pub fn recipe(&self) -> Self {
        let mut recipe = self.clone();
        recipe.set_files(ProfileFiles::default(), None);
        recipe
    }

    /// Names a model's profile files and the recipe that they came from.
    pub(crate) fn set_files(&mut self, files: ProfileFiles, recipe_hash: Option<String>) {
        match self {
            Self::Profiles(_) => {}
            Self::Weave(keys) => keys.set_files(files, recipe_hash),
            Self::Knit(keys) => keys.set_files(files, recipe_hash),
            Self::Fourier(keys) => keys.set_files(files, recipe_hash),
            Self::Brownian(keys) => keys.set_files(files, recipe_hash),
            Self::Restoration(keys) => keys.set_files(files, recipe_hash),
            Self::Heightmap(keys) => keys.set_files(files, recipe_hash),
            Self::Picture(keys) => keys.set_files(files, recipe_hash),
        }
    }

    /// SHA-256 of the recipe as this program writes it.
    pub fn recipe_hash(&self, path: &Path) -> Result<String, TextileError> {
        let text = keys_to_string(&self.recipe(), path)?;
        Ok(sha256_hex([text.as_bytes()]))
    }

    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        match self {
            Self::Profiles(keys) => {
                if keys.warp_forward.is_none() && keys.warp_reverse.is_none() {
                    let mend = "add warp_forward = \"FILE.csv\"";
                    return Err(checker.wrong("source", "kind", "no warp profile", mend));
                }
                check_name(checker, "source", "friction", keys.friction.as_deref())?;
                keys.imported
                    .as_ref()
                    .map_or(Ok(()), |origin| origin.check(checker))?;
            }
            Self::Weave(keys) => keys.check(checker)?,
            Self::Knit(keys) => keys.check(checker)?,
            Self::Fourier(keys) => keys.check(checker)?,
            Self::Brownian(keys) => keys.check(checker)?,
            Self::Restoration(keys) => keys.check(checker)?,
            Self::Heightmap(keys) => {
                keys.check(checker)?;
                check_name(checker, "source", "file", Some(&keys.file))?;
            }
            Self::Picture(keys) => {
                keys.check(checker)?;
                check_name(checker, "source", "file", Some(&keys.file))?;
            }
        }
        let files = self.files();
        for direction in Direction::ALL {
            check_name(checker, "source", direction.key(), files.of(direction))?;
        }
        Ok(())
    }
}

impl Manifest {
    /// Reads a manifest. `path` only names it in errors.
    ///
    /// # Errors
    /// Unknown or missing keys, values out of range: one line with file, line and mend.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, TextileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let checker = Checker { text, path, nth: 0 };
        let manifest = match kind_of(&checker)?.as_str() {
            "profiles" => read::<Profiles>(text, path)?.map(Source::Profiles),
            "weave" => read::<Box<Weave>>(text, path)?.map(Source::Weave),
            "knit" => read::<Box<Knit>>(text, path)?.map(Source::Knit),
            "fourier" => read::<Box<Fourier>>(text, path)?.map(Source::Fourier),
            "brownian" => read::<Box<Brownian>>(text, path)?.map(Source::Brownian),
            "restoration" => read::<Box<Restoration>>(text, path)?.map(Source::Restoration),
            "heightmap" | "x3p" => read::<Box<Heightmap>>(text, path)?.map(Source::Heightmap),
            "picture" => read::<Box<PictureSource>>(text, path)?.map(Source::Picture),
            other => {
                let mend = format!("the kinds are {}", KINDS.join(", "));
                let what = format!("unknown kind of source \"{other}\"");
                return Err(checker.wrong("source", "kind", what, mend));
            }
        };
        manifest.check(&checker)?;
        Ok(manifest)
    }

    /// The manifest as TOML. `path` only names it in errors.
    pub fn to_toml(&self, path: &Path) -> Result<String, TextileError> {
        Ok(keys_to_string(self, path)?)
    }

    fn check(&self, checker: &Checker<'_>) -> Result<(), TextileError> {
        if self.name.trim().is_empty() {
            return Err(checker.wrong("", "name", "the name is empty", "give the textile a name"));
        }
        check_gain("gain_db", self.gain_db).map_err(|error| {
            let what = error.to_string().replace(';', ",");
            checker.wrong("", "gain_db", what, "write a number of dB")
        })?;
        if let Some(floor) = self.noise_floor_um2_mm {
            checker.within("", "noise_floor_um2_mm", floor, 0.0..=1e6)?;
        }
        if let Some(appearance) = &self.appearance {
            checker.within("appearance", "px_per_mm", appearance.px_per_mm, 0.1..=200.0)?;
            check_name(checker, "appearance", "image", Some(&appearance.image))?;
        }
        for (key, value) in &self.measured {
            measured::check(checker, key, *value)?;
        }
        if let Some(provenance) = &self.provenance {
            provenance.check(checker)?;
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
            source: wrap(self.source),
            appearance: self.appearance,
            measured: self.measured,
            provenance: self.provenance,
        }
    }
}

fn read<S: DeserializeOwned>(text: &str, path: &Path) -> Result<Manifest<S>, FileError> {
    keys_from_str(text, path)
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

/// Refuses file names that lead out of the textile's folder.
fn check_name(
    checker: &Checker<'_>,
    table: &str,
    key: &str,
    name: Option<&str>,
) -> Result<(), TextileError> {
    use std::path::Component::Normal;

    let Some(name) = name else { return Ok(()) };
    let mut parts = Path::new(name).components();
    if matches!((parts.next(), parts.next()), (Some(Normal(_)), None)) {
        return Ok(());
    }
    let mend = "name a file in the textile's own folder";
    Err(checker.wrong(table, key, format!("{key} is \"{name}\""), mend))
}

#[cfg(test)]
mod tests;
