//! A textile that is loaded: its manifest and its surface; its picture on demand.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use super::store::Store;
use crate::error::TextileError;
use crate::manifest::{MANIFEST, Manifest};
use crate::profile_file;
use crate::recipe::profiles_of_files;
use crate::surface::{
    Direction, FrictionTrace, HeightMap, Profile, ProfileSet, Representation, Surface,
};
use selvedge_foundation::files::{Rgb8Image, sha256_hex};

/// A textile, ready to be felt.
#[derive(Debug, Clone)]
pub struct Textile {
    id: String,
    /// What it is known as, where it is not a textile of the library that was asked.
    known_as: Option<String>,
    manifest: Manifest,
    surface: Arc<Surface>,
    store: Store,
    friction: OnceLock<Arc<FrictionTrace>>,
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
    /// Reads a textile of a store: manifest, profiles, spectra. A model or a height
    /// map that names no profile files is built on the spot, which takes a second or so.
    pub(crate) fn load(store: &Store, id: &str) -> Result<Self, TextileError> {
        let manifest = read_manifest(store, id)?;
        let floor = manifest.noise_floor_um2_mm.unwrap_or(0.0);
        let is_areal = manifest.source.representation() == Representation::Areal;
        let map = if is_areal {
            relief_of(store, id, &manifest)?
        } else {
            None
        };
        let surface = match map {
            Some(map) => Surface::areal(&map, floor),
            None => Surface::from_profiles(profiles_of(store, id, &manifest)?, floor),
        };
        let surface = surface.map_err(|(direction, source)| {
            let files = manifest.source.keys().files();
            let name = files.of(direction).unwrap_or(MANIFEST);
            TextileError::surface(store.path(id, name))(source)
        })?;
        Ok(Self {
            id: id.to_owned(),
            known_as: None,
            manifest,
            surface: Arc::new(surface),
            store: store.clone(),
            friction: OnceLock::new(),
        })
    }

    /// A textile without a surface: a flat one stands in, and none of its files can be asked for.
    pub(crate) fn unread(id: &str, manifest: Manifest) -> Self {
        Self {
            id: id.to_owned(),
            known_as: None,
            manifest,
            surface: Arc::new(Surface::flat()),
            store: Store::Built(Arc::default(), PathBuf::from("a textile that was not read")),
            friction: OnceLock::new(),
        }
    }

    /// The same under the id by which a scene finds it in another library than its own.
    pub(crate) fn known_as(self, id: &str) -> Self {
        Self {
            known_as: Some(id.to_owned()),
            ..self
        }
    }

    /// What scenes call it: the name of its folder, with its library if that is not the scene's.
    pub fn id(&self) -> &str {
        self.known_as.as_ref().unwrap_or(&self.id)
    }

    /// Its manifest.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Its surface, noise floor taken off; shared by all that feel it.
    pub fn surface(&self) -> &Arc<Surface> {
        &self.surface
    }

    /// Which directions were not measured and what is felt there instead, one line each.
    pub fn fall_backs(&self) -> Vec<String> {
        let is_areal = self.surface.representation() == Representation::Areal;
        let note = |direction: Direction| {
            let from = self.surface.taken_from(direction);
            // Heights over an area are felt alike both ways: nothing is missing.
            (from != direction && !is_areal)
                .then(|| format!("no {}: {} is felt there", direction.key(), from.key()))
        };
        Direction::ALL.into_iter().filter_map(note).collect()
    }

    /// Its friction, read when it is first asked for and kept from then on; `None` if the manifest
    /// names none.
    ///
    /// # Errors
    /// A file that is missing, or no friction trace.
    pub fn friction(&self) -> Result<Option<Arc<FrictionTrace>>, TextileError> {
        let Some(name) = self.manifest.friction_file() else {
            return Ok(None);
        };
        if let Some(trace) = self.friction.get() {
            return Ok(Some(Arc::clone(trace)));
        }
        let (text, path) = (
            self.store.text(&self.id, name)?,
            self.store.path(&self.id, name),
        );
        let trace = Arc::new(profile_file::read_friction(&text, &path)?);
        Ok(Some(Arc::clone(self.friction.get_or_init(|| trace))))
    }

    /// Its heights over an area; `None` if its source knows profiles only. Read or built now, which
    /// takes a second or so.
    ///
    /// # Errors
    /// A file that has vanished, heights that are none.
    pub fn height_map(&self) -> Result<Option<HeightMap>, TextileError> {
        relief_of(&self.store, &self.id, &self.manifest)
    }

    /// SHA-256 of its manifest and of the files that its surface comes from: what a textile that
    /// is made from it names.
    ///
    /// # Errors
    /// A file that has vanished.
    pub fn content_hash(&self) -> Result<String, TextileError> {
        let content = content_of(&self.store, &self.id)?;
        // The first part is the id, under which the textile may not be found for ever.
        Ok(sha256_hex(content.iter().skip(1).map(Vec::as_slice)))
    }

    /// Its picture, decoded now; `None` if the manifest names none.
    pub fn appearance(&self) -> Result<Option<Appearance>, TextileError> {
        read_appearance(&self.store, &self.id, &self.manifest)
    }
}

/// Reads the picture that a manifest names; `None` if it names none.
pub(crate) fn read_appearance(
    store: &Store,
    id: &str,
    manifest: &Manifest,
) -> Result<Option<Appearance>, TextileError> {
    let Some(keys) = &manifest.appearance else {
        return Ok(None);
    };
    let bytes = store.read(id, &keys.image)?;
    let image = Rgb8Image::from_png(&bytes, &store.path(id, &keys.image))?;
    Ok(Some(Appearance {
        image,
        px_per_mm: keys.px_per_mm,
    }))
}

/// Reads the manifest of a textile.
pub(crate) fn read_manifest(store: &Store, id: &str) -> Result<Manifest, TextileError> {
    let path = store.path(id, MANIFEST);
    Manifest::from_toml(&store.text(id, MANIFEST)?, &path)
}

/// The heights over an area that a manifest's source knows; `None` if it knows profiles only.
fn relief_of(
    store: &Store,
    id: &str,
    manifest: &Manifest,
) -> Result<Option<HeightMap>, TextileError> {
    if let Some(heights) = manifest.source.keys().heights_file() {
        let (bytes, path) = (
            store.read(id, heights.name())?,
            store.path(id, heights.name()),
        );
        return heights.height_map(&bytes, &path).map(Some);
    }
    let map = manifest.source.height_map().transpose();
    map.map_err(TextileError::surface(store.path(id, MANIFEST)))
}

/// The profiles that a manifest names, or those of its model.
fn profiles_of(store: &Store, id: &str, manifest: &Manifest) -> Result<ProfileSet, TextileError> {
    let keys = manifest.source.keys();
    if !keys.files().is_empty() {
        return read_profiles(store, id, manifest);
    }
    if let Some(model) = keys.model()? {
        return profiles_of_files(&model.profile_files()?);
    }
    match keys.heights_file() {
        Some(heights) => heights.profiles(
            &store.read(id, heights.name())?,
            &store.path(id, heights.name()),
        ),
        None => read_profiles(store, id, manifest),
    }
}

fn read_profiles(store: &Store, id: &str, manifest: &Manifest) -> Result<ProfileSet, TextileError> {
    let files = manifest.source.keys().files();
    let mut profiles = ProfileSet::default();
    for direction in Direction::ALL {
        let Some(name) = files.of(direction) else {
            continue;
        };
        let profile = Profile::read(&store.text(id, name)?, &store.path(id, name))?;
        profiles[direction.index()] = Some(profile);
    }
    Ok(profiles)
}

/// The files that a textile's surface is made from, besides its manifest.
pub(super) fn content_names(manifest: &Manifest) -> Vec<String> {
    let mut names: Vec<String> = manifest
        .source
        .keys()
        .files()
        .0
        .into_iter()
        .flatten()
        .collect();
    let is_areal = manifest.source.representation() == Representation::Areal;
    if let Some(heights) = manifest.source.keys().heights_file()
        && (names.is_empty() || is_areal)
    {
        names.push(heights.name().to_owned());
    }
    names
}

/// What the figures of an index are made from: id, manifest and surface.
pub(super) fn content_of(store: &Store, id: &str) -> Result<Vec<Vec<u8>>, TextileError> {
    let manifest = read_manifest(store, id)?;
    let mut content = vec![
        id.as_bytes().to_vec(),
        store.read(id, MANIFEST)?.into_owned(),
    ];
    for name in content_names(&manifest) {
        content.push(store.read(id, &name)?.into_owned());
    }
    Ok(content)
}
