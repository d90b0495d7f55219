//! Everything that a session presents, made before its first trial so that no trial waits longer
//! than another.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::error::AppError;
use crate::bench::library_view::LibraryView;
use crate::bench::rendering::Rendering;
use crate::bench::settings::build_cache;
use selvedge_engine::PreparedScene;
use selvedge_experiment::StimulusHashes;
use selvedge_experiment::design::{Design, Source};
use selvedge_experiment::layout::Layout;
use selvedge_foundation::files::sha256_hex;
use selvedge_render::RenderError;
use selvedge_render::contact::{Contact, FeltSurface, Tip};
use selvedge_render::scene::{Display, LoadedScene, PlacedTextile, Scene};
use selvedge_render::stylus::{StylusDrive, StylusSettings};
use selvedge_textile::tactile::Tuning;
use selvedge_textile::{Library, Manifest};

/// What a session presents.
#[derive(Debug)]
pub(crate) struct Materials {
    /// Every textile of the design, loaded.
    loaded: LoadedScene,
    rendering: Rendering,
    display: Display,
    tuning: Tuning,
    /// What the textiles were made from.
    pub(crate) hashes: StimulusHashes,
    /// The tip of a stylus on each textile, where one feels them.
    tips: BTreeMap<String, Contact>,
    /// Their pictures.
    pub(crate) library_view: LibraryView,
}

impl Materials {
    /// What is known of the textiles that are presented, with their ids.
    pub(crate) fn manifests(&self) -> impl Iterator<Item = (&str, &Manifest)> {
        let textiles = self.loaded.textiles().iter();
        textiles.map(|textile| (textile.id(), textile.manifest()))
    }

    /// Where they are; `None` is the program.
    pub(crate) fn library(&self) -> Option<PathBuf> {
        let library = self.loaded.library();
        (!library.is_shipped()).then(|| library.root())
    }

    /// Loads the textiles of a design whose file is `path`: takes a while.
    pub(crate) fn gather(
        design: &Design,
        path: &Path,
        (display, rendering): (Display, Rendering),
    ) -> Result<Self, AppError> {
        let scene = all_at_once(design, &display);
        let folder = scene.library_folder(path);
        let library = Library::named_or_shipped(folder.as_deref(), build_cache().as_ref())?;
        let library = Arc::new(library);
        let items = crate::bench::library_shelf::items_of(&library, None);
        let library_view = LibraryView::new(Arc::clone(&library), items);
        let loaded = LoadedScene::load(scene, library)?;
        let accuracy = rendering.accuracy();
        PreparedScene::prepare(&loaded, rendering.method, &accuracy)?;
        let hashes = hashes_of(&loaded)?;
        let stylus = design.composition.presentation.stylus;
        let tips =
            stylus.map_or_else(|| Ok(BTreeMap::new()), |stylus| tips_of(&stylus, &loaded))?;
        let materials = Self {
            tuning: tuning(design, &loaded),
            loaded,
            rendering,
            display,
            hashes,
            tips,
            library_view,
        };
        // What cannot be led is said before the first trial.
        drop(materials.stylus(design, &Layout::to_practise(0), &materials.loaded)?);
        Ok(materials)
    }

    /// SHA-256 of what is felt through: display, gains and compression, how it is rendered.
    /// A stylus stands in the design.
    pub(crate) fn scene_sha256(&self) -> String {
        let through = format!("{:?} {:?} {:?}", self.display, self.tuning, self.rendering);
        sha256_hex([through.as_bytes()])
    }

    /// Gains and compression of the session. What compression leaves alone is the same in every
    /// trial, whatever lies there.
    pub(crate) fn tuning(&self) -> Tuning {
        self.tuning
    }

    /// What lies in a layout, ready for the engine, and the stylus that feels it, if one does.
    pub(crate) fn prepare(
        &self,
        design: &Design,
        layout: &Layout,
        tuning: Tuning,
    ) -> Result<(PreparedScene, Option<StylusDrive>), AppError> {
        let all = self.loaded.textiles().iter().zip(self.loaded.levels_db());
        let levels_db: Vec<(&str, Option<f64>)> = all
            .map(|(textile, level_db)| (textile.id(), *level_db))
            .collect();
        let level_db = |id: &str| levels_db.iter().find(|(of, _)| *of == id)?.1;
        let scene = layout.scene(design, (&self.display, tuning), level_db);
        let loaded = self.loaded.with_scene(scene)?;
        let (method, accuracy) = (self.rendering.method, self.rendering.accuracy());
        let prepared = PreparedScene::prepare(&loaded, method, &accuracy)?;
        Ok((prepared, self.stylus(design, layout, &loaded)?))
    }

    /// The stylus of a design over what lies in a layout, which is loaded.
    fn stylus(
        &self,
        design: &Design,
        layout: &Layout,
        loaded: &LoadedScene,
    ) -> Result<Option<StylusDrive>, RenderError> {
        let Some(stylus) = design.composition.presentation.stylus else {
            return Ok(None);
        };
        // Whatever a stylus feels is a textile: there are as many as places.
        let placed = layout.places.iter().zip(loaded.textiles());
        let led = placed.map(|(place, textile)| {
            let setup = self.tips.get(textile.id()).map(|tip| {
                let setup = stylus.setup(tip.clone());
                match design.stimuli.get(place.stimulus).map(|one| &one.source) {
                    Some(Source::Textile { variant, .. }) if variant.is_force_alone => {
                        setup.by_force_alone()
                    }
                    _ => setup,
                }
            });
            (Arc::clone(textile.surface()), setup)
        });
        let drive = stylus.drive(led.collect(), &loaded.scene().filters);
        drive.map(Some)
    }
}

/// A scene with every textile of a design, one upon the other.
fn all_at_once(design: &Design, display: &Display) -> Scene {
    let mut ids: Vec<&String> = Vec::new();
    for stimulus in &design.stimuli {
        if let Source::Textile { id, .. } = &stimulus.source
            && !ids.contains(&id)
        {
            ids.push(id);
        }
    }
    let placed = |id: &String| PlacedTextile {
        id: id.clone(),
        size_mm: [100.0; 2],
        ..PlacedTextile::default()
    };
    Scene {
        name: "Session".to_owned(),
        library: design.library.clone(),
        size_mm: [100.0; 2],
        textiles: ids.into_iter().map(placed).collect(),
        displays: vec![display.clone()],
        ..Scene::default()
    }
}

/// A tip on each textile: rolling it there may take a second each.
fn tips_of(
    stylus: &StylusSettings,
    loaded: &LoadedScene,
) -> Result<BTreeMap<String, Contact>, AppError> {
    let tip = Tip::stylus(stylus.radius_mm);
    let mut tips = BTreeMap::new();
    for textile in loaded.textiles() {
        let felt = FeltSurface::of_textile(textile, &tip)?;
        tips.insert(textile.id().to_owned(), felt.contact(tip.clone())?);
    }
    Ok(tips)
}

fn tuning(design: &Design, loaded: &LoadedScene) -> Tuning {
    let default = loaded.library().default_tuning();
    let mut tuning = design.tuning.unwrap_or(default);
    let levels_db: Vec<f64> = loaded.levels_db().iter().copied().flatten().collect();
    let mean_db = || {
        let n = u32::try_from(levels_db.len()).unwrap_or(u32::MAX);
        (n > 0).then(|| levels_db.iter().sum::<f64>() / f64::from(n))
    };
    tuning.compression_reference_db = tuning
        .compression_reference_db
        .or(default.compression_reference_db)
        .or_else(mean_db);
    tuning
}

fn hashes_of(loaded: &LoadedScene) -> Result<StimulusHashes, AppError> {
    let mut textiles = Vec::new();
    for textile in loaded.textiles() {
        textiles.push((textile.id().to_owned(), textile.content_hash()?));
    }
    Ok(StimulusHashes::of(textiles))
}
