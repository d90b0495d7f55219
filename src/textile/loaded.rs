//! A textile that is loaded: its manifest and its surface; its picture on demand.

use std::path::Path;

use super::cloth::profiles as strokes;
use super::library::Store;
use super::manifest::{Manifest, Source};
use super::{TextileError, profile_file};
use crate::files::{FileError, Rgb8Image, decode_png};
use crate::numerics::Random;
use crate::surface::{Direction, Probe, Profile, ProfileSet, Surface};

/// A textile, ready to be felt.
#[derive(Debug, Clone)]
pub struct Textile {
    id: String,
    manifest: Manifest,
    surface: Surface,
    store: Store,
}

/// What a textile looks like.
#[derive(Debug, Clone)]
pub struct Appearance {
    /// The picture; it is tiled from the textile's origin, its lower left corner.
    pub image: Rgb8Image,
    /// Its scale, pixels a mm.
    pub px_per_mm: f64,
}

impl Textile {
    /// Reads a textile of a store: manifest, profiles, spectra. A model that names no profile
    /// files is built on the spot, which takes a second or so.
    pub(crate) fn load(store: &Store, id: &str) -> Result<Self, TextileError> {
        let manifest = read_manifest(store, id)?;
        let profiles = match made_profiles(&manifest.source) {
            Some(heights) if manifest.source.files().is_empty() => from_heights(heights())?,
            _ => read_profiles(store, id, &manifest)?,
        };
        let floor = manifest.noise_floor_um2_mm.unwrap_or(0.0);
        let surface = Surface::from_profiles(profiles, floor).map_err(|(direction, source)| {
            let files = manifest.source.files();
            let name = files.of(direction).unwrap_or(MANIFEST);
            TextileError::Surface {
                path: store.path(id, name),
                source,
            }
        })?;
        Ok(Self {
            id: id.to_owned(),
            manifest,
            surface,
            store: store.clone(),
        })
    }

    /// What scenes call it: the name of its folder.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// Its manifest.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Its surface, noise floor taken off.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Which directions were not measured and what is felt there instead, one line each.
    pub fn fall_backs(&self) -> Vec<String> {
        let note = |direction: Direction| {
            let from = self.surface.taken_from(direction);
            (from != direction)
                .then(|| format!("no {}: {} is felt there", direction.key(), from.key()))
        };
        Direction::ALL.into_iter().filter_map(note).collect()
    }

    /// Its picture, decoded now; `None` if the manifest names none.
    pub fn appearance(&self) -> Result<Option<Appearance>, TextileError> {
        let Some(keys) = &self.manifest.appearance else {
            return Ok(None);
        };
        let bytes = self.store.read(&self.id, &keys.image)?;
        let image = decode_png(&bytes, &self.store.path(&self.id, &keys.image))?;
        Ok(Some(Appearance {
            image,
            px_per_mm: keys.px_per_mm,
        }))
    }
}

/// The name of a manifest in its textile's folder.
pub(crate) const MANIFEST: &str = "textile.toml";

/// Reads the manifest of a textile.
pub(crate) fn read_manifest(store: &Store, id: &str) -> Result<Manifest, TextileError> {
    let path = store.path(id, MANIFEST);
    let bytes = store.read(id, MANIFEST)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()]
            .iter()
            .filter(|&&b| b == b'\n')
            .count()
            + 1;
        FileError::content(
            &path,
            line,
            "this is not UTF-8 text",
            "save the file as UTF-8",
        )
    })?;
    Manifest::from_toml(text, &path)
}

fn read_profiles(store: &Store, id: &str, manifest: &Manifest) -> Result<ProfileSet, TextileError> {
    let files = manifest.source.files();
    let mut profiles = ProfileSet::default();
    for direction in Direction::ALL {
        let Some(name) = files.of(direction) else {
            continue;
        };
        let bytes = store.read(id, name)?;
        profiles[direction.index()] = Some(profile_file::read(&bytes, &store.path(id, name))?);
    }
    Ok(profiles)
}

/// The strokes over a model's cloth, µm by direction, to be computed when called; `None` for a
/// source that is no model.
pub(crate) fn made_profiles(source: &Source) -> Option<impl Fn() -> [Vec<f64>; 4]> {
    let (seed, noise_um) = match source {
        Source::Profiles(_) => return None,
        Source::Weave(weave) => (weave.seed, weave.noise_um),
        Source::Knit(knit) => (knit.seed, knit.noise_um),
    };
    let probe = Probe {
        noise_um,
        ..Probe::default()
    };
    let random = Random::new(u64::from(seed)).branch("probe");
    Some(move || match source {
        Source::Weave(weave) => strokes(&weave.cloth(), &probe, &random),
        Source::Knit(knit) => strokes(&knit.cloth(), &probe, &random),
        Source::Profiles(_) => Default::default(),
    })
}

/// Profiles of made heights, rounded as files would hold them.
fn from_heights(heights: [Vec<f64>; 4]) -> Result<ProfileSet, TextileError> {
    let mut profiles = ProfileSet::default();
    for (direction, heights) in Direction::ALL.into_iter().zip(heights) {
        let path = Path::new(direction.key());
        let bytes = profile_file::write(&heights, STEP_MM, path)?;
        let profile: Profile = profile_file::read(&bytes, path)?;
        profiles[direction.index()] = Some(profile);
    }
    Ok(profiles)
}

/// Distance of a model's samples, mm.
pub(crate) const STEP_MM: f64 = 1.0 / 230.0;
