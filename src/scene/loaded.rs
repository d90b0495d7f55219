//! A scene together with the textiles that it places.
//!
//! Each textile is loaded once, however often it is placed, and none that is not. Levels are
//! computed from the surfaces themselves: at the one speed of the definition that takes some ten
//! microseconds a textile, less than it would take to find out whether stored ones still hold.

use std::path::Path;
use std::sync::Arc;

use super::{Scene, SceneError};
use crate::files::{self, FileError};
use crate::tactile::{Filters, Levels, Tuning};
use crate::textile::{Library, Textile, TextileError};

/// The scene of four textiles that is part of the program.
const SHIPPED: &str = include_str!("../../assets/scenes/four-alternatives.scene.toml");
const SHIPPED_PATH: &str = "four-alternatives.scene.toml";

/// A scene whose textiles are loaded. Cheap to clone: textiles and library are shared.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    library: Arc<Library>,
    textiles: Vec<Arc<Textile>>,
    levels_db: Vec<Option<f64>>,
}

impl LoadedScene {
    /// The scene of four textiles that is part of the program.
    pub fn shipped() -> Result<Self, SceneError> {
        Self::from_toml(SHIPPED, Path::new(SHIPPED_PATH))
    }

    /// Reads a scene file and loads what it places.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::from_toml(&files::read_text(path)?, path)
    }

    /// Reads the text of a scene file and loads what it places. The library's folder is relative
    /// to `path`.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, SceneError> {
        let scene = Scene::from_toml(text, path)?;
        let wrong = |(table, nth, key), what: String, mend: &str| {
            let line = files::line_of_key(text, table, nth, key);
            SceneError::from(FileError::content(path, line, what, mend))
        };
        let library = match scene.library_folder(path) {
            None => Library::shipped()?,
            Some(folder) if !folder.is_dir() => {
                let what = format!("there is no library in {}", folder.display());
                return Err(wrong(("", 0, "library"), what, "name a folder of textiles"));
            }
            Some(folder) => Library::open(&folder)?,
        };
        let unknown = scene.textiles.iter().enumerate().find_map(|(nth, placed)| {
            let error = library.manifest(&placed.id).err()?;
            matches!(error, TextileError::Unknown { .. }).then_some((nth, error))
        });
        if let Some((nth, error)) = unknown {
            let mend = "place a textile that is there";
            return Err(wrong(("textile", nth, "id"), error.to_string(), mend));
        }
        Self::load(scene, Arc::new(library))
    }

    /// Loads what a scene places from this library, whatever library the scene itself names.
    pub fn load(scene: Scene, library: Arc<Library>) -> Result<Self, SceneError> {
        let nothing = Self {
            scene: Scene::default(),
            library,
            textiles: Vec::new(),
            levels_db: Vec::new(),
        };
        nothing.with_scene(scene)
    }

    /// Another scene over the same library: textiles that are loaded already are kept.
    pub fn with_scene(&self, scene: Scene) -> Result<Self, SceneError> {
        scene.check()?;
        let mut textiles: Vec<Arc<Textile>> = Vec::with_capacity(scene.textiles.len());
        for placed in &scene.textiles {
            let is_it = |textile: &&Arc<Textile>| textile.id() == placed.id;
            let known = textiles
                .iter()
                .find(is_it)
                .or_else(|| self.textiles.iter().find(is_it));
            let textile = match known {
                Some(textile) => Arc::clone(textile),
                None => self.library.load(&placed.id)?,
            };
            textiles.push(textile);
        }
        let levels_db = levels_db(&textiles, &scene.filters);
        Ok(Self {
            scene,
            library: Arc::clone(&self.library),
            textiles,
            levels_db,
        })
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where its textiles come from.
    pub fn library(&self) -> &Arc<Library> {
        &self.library
    }

    /// The textiles in order of placement; one that is placed twice is there twice.
    pub fn textiles(&self) -> &[Arc<Textile>] {
        &self.textiles
    }

    /// The levels of the textiles placed, dB re 1 µm, with the scene's filters and no gain; `None`
    /// for a textile that is silent in a band.
    pub fn levels_db(&self) -> &[Option<f64>] {
        &self.levels_db
    }

    /// The tuning to begin with: the scene's own, else the library's default.
    pub fn tuning(&self) -> Tuning {
        self.scene
            .tuning
            .unwrap_or_else(|| self.library.default_tuning())
    }

    /// The level that compression leaves alone when the tuning states none, dB re 1 µm: the
    /// library's. Without it the mean level of the textiles placed stands in.
    pub fn library_reference_db(&self) -> Option<f64> {
        self.library.default_tuning().compression_reference_db
    }
}

/// Levels in order of placement, each textile's computed once.
fn levels_db(textiles: &[Arc<Textile>], filters: &Filters) -> Vec<Option<f64>> {
    let mut levels_db: Vec<Option<f64>> = Vec::with_capacity(textiles.len());
    for (index, textile) in textiles.iter().enumerate() {
        let first = textiles[..index]
            .iter()
            .position(|other| Arc::ptr_eq(other, textile));
        levels_db.push(match first {
            Some(first) => levels_db[first],
            None => Levels::of(textile.surface(), filters).level_db(),
        });
    }
    levels_db
}
