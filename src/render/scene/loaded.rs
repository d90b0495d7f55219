//! A scene together with the textiles that it places.
//!
//! Each textile is loaded once, however often it is placed, and none that is not. Levels are
//! computed from the surfaces themselves: at the one speed of the definition that takes some ten
//! microseconds a textile, less than it would take to find out whether stored ones still hold.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::{PlacedTextile, Scene, SceneError};
use selvedge_foundation::files::{self, FileError};
use selvedge_foundation::progress::Progress;
use selvedge_textile::tactile::{Filters, Levels, Tuning};
use selvedge_textile::{BuildCache, Library, Textile, TextileError, elsewhere, is_of_the_program};

/// The scene of four textiles that is part of the program.
const SHIPPED: &str = include_str!("../../../assets/scenes/four-alternatives.scene.toml");
const SHIPPED_PATH: &str = "four-alternatives.scene.toml";

/// A scene whose textiles are loaded. Cheap to clone: textiles and library are shared.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    scene: Scene,
    library: Arc<Library>,
    textiles: Vec<Arc<Textile>>,
    levels_db: Vec<Option<f64>>,
    /// Ids whose textiles are loaded although they are there.
    fresh: Vec<String>,
    /// Ids of textiles that are placed and were not read, because nothing is felt of them.
    unread: Vec<String>,
    /// What the next scene places under its id in place of a textile of the library.
    lent: Option<Arc<Textile>>,
}

/// Says which textiles placed are to be read, given the tuning with its reference and the gains of
/// their manifests, dB.
type Needed<'a> = dyn Fn(&Scene, &Tuning, &[f64]) -> Vec<bool> + 'a;

impl LoadedScene {
    /// The scene of four textiles that is part of the program.
    pub fn shipped() -> Result<Self, SceneError> {
        Self::from_toml(SHIPPED, Path::new(SHIPPED_PATH))
    }

    /// Reads a scene file and loads what it places. Textiles that are built for it are kept in
    /// `cache`.
    pub fn read(path: &Path, cache: Option<&BuildCache>) -> Result<Self, SceneError> {
        Self::from_text(&files::read_text(path)?, path, cache)
    }

    /// Reads the text of a scene file and loads what it places. The library's folder is relative
    /// to `path`.
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, SceneError> {
        Self::from_text(text, path, None)
    }

    /// The same, with textiles that are built kept in `cache`.
    pub fn from_text(
        text: &str,
        path: &Path,
        cache: Option<&BuildCache>,
    ) -> Result<Self, SceneError> {
        let all = |scene: &Scene, _: &Tuning, _: &[f64]| vec![true; scene.textiles.len()];
        Self::from_text_with(text, path, cache, &all)
    }

    /// The same; of the textiles that it places those that are needed are loaded, of the others the
    /// manifests are read.
    pub(crate) fn from_text_with(
        text: &str,
        path: &Path,
        cache: Option<&BuildCache>,
        needed: &Needed<'_>,
    ) -> Result<Self, SceneError> {
        let scene = Scene::from_toml(text, path)?;
        let wrong = |(table, nth, key), what: String, mend: &str| {
            let line = files::line_of_key(text, table, nth, key);
            SceneError::from(FileError::content(path, line, what, mend))
        };
        let library = match scene.library_folder(path) {
            None => Library::shipped()?.with_cache(cache),
            Some(folder) if !is_of_the_program(&folder) && !folder.exists() => {
                let what = format!("there is no library in {}", folder.display());
                return Err(wrong(("", 0, "library"), what, "name a folder of textiles"));
            }
            Some(folder) => Library::named(&folder, cache)?,
        };
        let mut manifests_db = Vec::with_capacity(scene.textiles.len());
        for (nth, placed) in scene.textiles.iter().enumerate() {
            let error = match library.manifest(&placed.id) {
                Ok(manifest) => {
                    manifests_db.push(manifest.gain_db);
                    continue;
                }
                Err(error) => error,
            };
            let is_unknown = matches!(error, TextileError::Unknown { .. });
            if is_unknown || elsewhere(&placed.id).is_some() {
                let mend = "place a textile that is there";
                return Err(wrong(("textile", nth, "id"), error.to_string(), mend));
            }
            return Err(error.into());
        }
        let nothing = Self::nothing_of(Arc::new(library));
        let mut tuning = nothing.tuning_of(&scene);
        let stated = tuning.compression_reference_db;
        let reference_db = stated.or_else(|| nothing.library_reference_db());
        tuning.compression_reference_db = reference_db;
        let is_needed = needed(&scene, &tuning, &manifests_db);
        nothing.with_needed(scene, &is_needed)
    }

    /// Loads what a scene places from this library, whatever library the scene itself names.
    pub fn load(scene: Scene, library: Arc<Library>) -> Result<Self, SceneError> {
        Self::nothing_of(library).with_scene(scene)
    }

    fn nothing_of(library: Arc<Library>) -> Self {
        Self {
            scene: Scene::default(),
            library,
            textiles: Vec::new(),
            levels_db: Vec::new(),
            fresh: Vec::new(),
            unread: Vec::new(),
            lent: None,
        }
    }

    /// Another scene over the same library: textiles that are loaded already are kept.
    pub fn with_scene(&self, scene: Scene) -> Result<Self, SceneError> {
        let all = vec![true; scene.textiles.len()];
        self.with_needed(scene, &all)
    }

    /// The same; of textiles that are not needed at any of their places only the manifest is read.
    fn with_needed(&self, scene: Scene, is_needed: &[bool]) -> Result<Self, SceneError> {
        scene.check()?;
        let (mut fresh, mut unread): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
        // Those that are needed somewhere first.
        for wanted in [true, false] {
            let placed = scene.textiles.iter().zip(is_needed);
            for (PlacedTextile { id, .. }, _) in placed.filter(|(_, is)| **is == wanted) {
                if !self.knows(id) && !fresh.contains(id) && !unread.contains(id) {
                    if wanted { &mut fresh } else { &mut unread }.push(id.clone());
                }
            }
        }
        let mut fresh = Progress::unheard(|progress| self.library.load_all(&fresh, progress))?;
        for id in &unread {
            fresh.push(self.library.unread(id)?);
        }
        let find = |placed: &PlacedTextile| {
            let mut known = self.lent.iter().chain(&fresh).chain(&self.textiles);
            known
                .find(|textile| textile.id() == placed.id)
                .map(Arc::clone)
        };
        let textiles: Vec<_> = scene.textiles.iter().filter_map(find).collect();
        let levels_db = levels_db(&textiles, &scene.filters);
        Ok(Self {
            scene,
            library: Arc::clone(&self.library),
            textiles,
            levels_db,
            // The library's own comes back with the scene after.
            fresh: self.lent.iter().map(|one| one.id().to_owned()).collect(),
            unread,
            lent: None,
        })
    }

    /// Whether a scene that places this textile finds it loaded.
    pub fn knows(&self, id: &str) -> bool {
        let is_in = |ids: &[String]| ids.iter().any(|other| other == id);
        let is_it = |textile: &Arc<Textile>| textile.id() == id;
        let is_there = self.textiles.iter().any(is_it);
        let is_own = is_there && !is_in(&self.fresh) && !is_in(&self.unread);
        self.lent.as_ref().is_some_and(is_it) || is_own
    }

    /// Ids of textiles that are placed and were not read, because nothing is felt of them: they
    /// have no surface.
    pub fn unread(&self) -> &[String] {
        &self.unread
    }

    /// Takes textiles that are placed from now on from another library, which must have those that
    /// are placed already.
    pub fn use_library(&mut self, library: &Arc<Library>) {
        self.library = Arc::clone(library);
    }

    /// Lets the next scene place a textile that lies in no library; the one after places what the
    /// library has under that id, unless it is lent again.
    pub fn lend(&mut self, textile: Arc<Textile>) {
        self.lent = Some(textile);
    }

    /// Loads textiles with these ids anew when a scene places them next: their files are others.
    pub fn forget(&mut self, ids: &[String]) {
        self.fresh.retain(|id| !ids.contains(id));
        self.fresh.extend_from_slice(ids);
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What its textiles are: the SHA-256 of their content by their ids. One whose files have
    /// vanished since they were loaded is left out, and so is one that was not read.
    pub fn contents(&self) -> BTreeMap<String, String> {
        let content = |textile: &Arc<Textile>| {
            let hash = textile.content_hash().ok()?;
            Some((textile.id().to_owned(), hash))
        };
        let is_read = |textile: &&Arc<Textile>| !self.unread.iter().any(|id| id == textile.id());
        let read = self.textiles.iter().filter(is_read);
        read.filter_map(content).collect()
    }

    /// A sentence on the textiles that are not what they were when the scene was saved; `None` if
    /// all are.
    pub fn changed(&self) -> Option<String> {
        let stated = &self.scene.contents;
        let now = if stated.is_empty() {
            BTreeMap::new()
        } else {
            self.contents()
        };
        let is_other =
            |(id, hash): &(&String, &String)| stated.get(*id).is_some_and(|stated| stated != *hash);
        let ids: Vec<&str> = (now.iter().filter(is_other))
            .map(|(id, _)| id.as_str())
            .collect();
        let (last, others) = ids.split_last()?;
        let (names, are) = match others {
            [] => ((*last).to_owned(), "is not what it was"),
            _ => (
                format!("{} and {last}", others.join(", ")),
                "are not what they were",
            ),
        };
        Some(format!(
            "{names} {are} when the scene was saved: levels may differ; save it to keep them as \
             they are now"
        ))
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
        self.tuning_of(&self.scene)
    }

    fn tuning_of(&self, scene: &Scene) -> Tuning {
        scene
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

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(id: &str) -> PlacedTextile {
        PlacedTextile {
            id: id.to_owned(),
            size_mm: [50.0; 2],
            ..PlacedTextile::default()
        }
    }

    fn with(ids: &[&str]) -> Scene {
        let shipped = LoadedScene::shipped().unwrap().scene;
        Scene {
            textiles: ids.iter().map(|id| placed(id)).collect(),
            ..shipped
        }
    }

    #[test]
    fn a_textile_that_is_another_than_when_the_scene_was_saved_is_named() {
        let mut scene = with(&["denim", "silk-crepe", "jute-plain"]);
        let library = Arc::clone(LoadedScene::shipped().unwrap().library());
        let load = |scene: &Scene| LoadedScene::load(scene.clone(), Arc::clone(&library)).unwrap();
        assert_eq!(load(&scene).changed(), None, "nothing is stated");
        scene.contents = load(&scene).contents();
        assert_eq!(scene.contents.len(), 3);
        let text = scene.to_toml().unwrap();
        let again = Scene::from_toml(&text, Path::new("a.scene.toml")).unwrap();
        assert_eq!(load(&again).changed(), None);
        let other = |scene: &mut Scene, id: &str| {
            let content = scene.contents.get_mut(id).unwrap();
            *content = content.chars().rev().collect();
        };
        other(&mut scene, "denim");
        let words = load(&scene).changed().unwrap();
        assert!(words.starts_with("denim is not what it was"), "{words}");
        other(&mut scene, "silk-crepe");
        let words = load(&scene).changed().unwrap();
        assert!(words.starts_with("denim and silk-crepe are not"), "{words}");
    }

    #[test]
    fn the_shipped_scene_has_four_textiles_and_the_librarys_tuning() {
        let loaded = LoadedScene::shipped().unwrap();
        let labels: Vec<&str> = loaded
            .scene
            .textiles
            .iter()
            .map(|t| t.label.as_str())
            .collect();
        assert_eq!(labels, ["1", "2", "3", "4"]);
        assert_eq!(loaded.tuning(), loaded.library().default_tuning());
        assert_eq!(
            loaded.library_reference_db(),
            loaded.tuning().compression_reference_db
        );
        let stored = loaded.library().index().unwrap();
        for (textile, level_db) in loaded.textiles().iter().zip(loaded.levels_db()) {
            let expected_db = stored.entry(textile.id()).unwrap().level_db().unwrap();
            // The library keeps six digits.
            assert!(
                (level_db.unwrap() - expected_db).abs() < 1e-4,
                "{}",
                textile.id()
            );
        }
    }

    #[test]
    fn a_textile_is_loaded_once_however_often_it_is_placed() {
        let library = Arc::new(Library::shipped().unwrap());
        let loaded = LoadedScene::load(with(&["denim", "silk-crepe", "denim"]), library).unwrap();
        assert!(
            Arc::ptr_eq(&loaded.textiles()[0], &loaded.textiles()[2]),
            "one denim"
        );
        let moved = loaded.with_scene(with(&["jute-plain", "denim"])).unwrap();
        assert!(
            Arc::ptr_eq(&loaded.textiles()[0], &moved.textiles()[1]),
            "still the same"
        );
        assert_eq!(moved.levels_db()[1], loaded.levels_db()[2]);
    }

    #[test]
    fn a_scene_names_a_library_of_the_program_and_builds_what_it_places() {
        let text = "name = \"A\"\nlibrary = \"seventy-four\"\nsize_mm = [60, 60]\n[[textile]]\n\
                    id = \"silk-charmeuse-back\"\norigin_mm = [0, 0]\nsize_mm = [50, 50]\n";
        let loaded = LoadedScene::from_toml(text, Path::new("/nowhere/a.toml")).unwrap();
        assert_eq!(loaded.library().ids().len(), 74);
        let [textile] = loaded.textiles() else {
            panic!("{:?}", loaded.textiles());
        };
        assert_eq!(textile.manifest().name, "Silk charmeuse, back");
        let stored = loaded.library().index().unwrap().entry(textile.id());
        let apart_db = loaded.levels_db()[0].unwrap() - stored.unwrap().level_db().unwrap();
        assert!(apart_db.abs() < 1e-4, "{apart_db} dB");
        let again = Scene::from_toml(&loaded.scene().to_toml().unwrap(), Path::new("b.toml"));
        assert_eq!(again.unwrap().library, Some("seventy-four".into()));
        let moved = text.replace("seventy-four", "./seventy-four");
        let error = LoadedScene::from_toml(&moved, Path::new("/nowhere/a.toml")).unwrap_err();
        let expected = "/nowhere/a.toml:2: there is no library in";
        assert!(error.to_string().starts_with(expected), "{error}");
    }

    #[test]
    fn a_textile_that_is_not_there_is_refused_with_its_line() {
        let text = "name = \"A\"\nsize_mm = [1, 1]\n[[textile]]\norigin_mm = [0, 0]\n\
                    size_mm = [1, 1]\nid = \"felt\"\n";
        let error = LoadedScene::from_toml(text, Path::new("a.toml"))
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("a.toml:6: no textile \"felt\" in "),
            "{error}"
        );
        let library = Arc::new(Library::shipped().unwrap());
        assert!(LoadedScene::load(with(&["felt"]), library).is_err());
    }

    #[test]
    fn a_scene_places_textiles_of_several_libraries_and_moves_with_the_folder_beside_it() {
        let scratch = selvedge_scratch::ScratchFolder::made("several");
        let folder = scratch.join("own");
        let files = Library::shipped().unwrap().files_of("denim").unwrap();
        selvedge_textile::write(&files, &folder.join("mine")).unwrap();
        let path = scratch.join("a.scene.toml");
        let place = |id: &str| {
            format!("[[textile]]\nid = \"{id}\"\norigin_mm = [0, 0]\nsize_mm = [50, 50]\n")
        };
        let ids = ["denim", "./own:mine", "sixteen:silk-crepe"]
            .map(place)
            .concat();
        let text = format!("name = \"A\"\nsize_mm = [60, 60]\n{ids}");
        let loaded = LoadedScene::from_toml(&text, &path).unwrap();
        let mine = selvedge_textile::id_in(&std::path::absolute(&folder).unwrap(), "mine");
        assert_eq!(loaded.textiles()[1].id(), mine);
        let [denim, same] = [0, 1].map(|nth| loaded.levels_db()[nth]);
        assert_eq!(denim, same, "the same cloth under another name");
        loaded.scene().write(&path).unwrap();
        let written = std::fs::read_to_string(&path).unwrap();
        assert!(written.contains("id = \"./own:mine\""), "{written}");
        assert_eq!(Scene::read(&path).unwrap(), *loaded.scene());
        let wrong = text.replace("./own:mine", "./none:mine");
        let error = LoadedScene::from_toml(&wrong, &path)
            .unwrap_err()
            .to_string();
        assert!(error.contains("a.scene.toml:8: "), "{error}");
    }

    #[test]
    fn a_stated_tuning_goes_before_the_librarys() {
        let library = Arc::new(Library::shipped().unwrap());
        let tuning = Tuning {
            gain_db: -6.0,
            ..Tuning::default()
        };
        let scene = Scene {
            tuning: Some(tuning),
            ..with(&[])
        };
        let loaded = LoadedScene::load(scene, library).unwrap();
        assert_eq!(loaded.tuning(), tuning);
        assert!(
            loaded.library_reference_db().is_some(),
            "compression still has a reference"
        );
    }
}
