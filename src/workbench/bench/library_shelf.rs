//! A library as the window knows it: what it is called, where it lies, what stands in it, and by
//! which ids a scene finds that.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bench::view::LibraryEntry;
use selvedge_textile::{
    BuildCache, Library, LibraryFolder, MeasuredFigure, elsewhere, id_in, kind_of,
};

/// A library in sight.
#[derive(Debug, Clone)]
pub(crate) struct Shelf {
    /// What people call it.
    pub(crate) title: Arc<str>,
    /// How scenes name it; `None` for the scene's own library.
    name: Option<PathBuf>,
    /// Its textiles.
    pub(crate) library: Arc<Library>,
    /// What their manifests say, under the ids by which the scene finds them.
    pub(crate) items: Arc<[LibraryEntry]>,
}

impl Shelf {
    /// The library of the scene, with what its manifests say.
    pub(crate) fn of_scene(library: Arc<Library>, items: Vec<LibraryEntry>) -> Self {
        Self {
            title: title_of(&library),
            name: None,
            library,
            items: items.into(),
        }
    }

    /// The library that has this name. The user's own folder is there from now on.
    ///
    /// # Errors
    /// It cannot be read, in one line.
    pub(crate) fn open(
        (title, name): (&str, &Path),
        cache: Option<&BuildCache>,
    ) -> Result<Self, String> {
        if title == OWN && !name.exists() {
            let failed = |error| format!("{}: cannot be made ({error})", name.display());
            std::fs::create_dir_all(name).map_err(failed)?;
        }
        let library = Library::named(name, cache).map_err(|error| error.to_string())?;
        Ok(Self {
            title: title.into(),
            items: items_of(&library, Some((title, name))).into(),
            name: Some(name.to_owned()),
            library: Arc::new(library),
        })
    }

    /// The same with its textiles as they are now.
    pub(crate) fn renewed(&self, library: Arc<Library>) -> Self {
        let title = &*self.title;
        let name = self.name.as_deref().map(|name| (title, name));
        Self {
            items: items_of(&library, name).into(),
            library,
            ..self.clone()
        }
    }

    /// How scenes name it; `None` for the scene's own library.
    pub(crate) fn name(&self) -> Option<&Path> {
        self.name.as_deref()
    }

    /// By which id the scene finds a textile of this library.
    pub(crate) fn key_of(&self, id: &str) -> String {
        let name = self.name.as_deref();
        name.map_or_else(|| id.to_owned(), |name| id_in(name, id))
    }

    /// The folder that can be changed, if it is one.
    pub(crate) fn folder(&self) -> Option<LibraryFolder> {
        let root = self.library.root();
        root.is_dir().then(|| LibraryFolder::at(&root))
    }

    /// Where it lies, for people.
    pub(crate) fn place(&self) -> String {
        let root = self.library.root();
        if root.exists() {
            return root.display().to_string();
        }
        "part of the program".to_owned()
    }
}

/// What the user's own library is called.
pub(crate) const OWN: &str = "Own";
/// The libraries of the program: what people call them, and how scenes do.
pub(crate) const SHIPPED: [(&str, &str); 2] =
    [("Shipped 16", "sixteen"), ("Shipped 74", "seventy-four")];

/// The id in its library of a textile that the scene finds by this one.
pub(crate) fn plain_id(key: &str) -> &str {
    elsewhere(key).map_or(key, |(_, id)| id)
}

/// What people call the library of a scene.
fn title_of(library: &Library) -> Arc<str> {
    let root = library.root();
    if library.is_shipped() {
        return SHIPPED[0].0.into();
    }
    if root == Path::new(SHIPPED[1].1) {
        return SHIPPED[1].0.into();
    }
    let name = root.file_name().unwrap_or(root.as_os_str());
    format!("{}, the scene’s", name.to_string_lossy()).into()
}

/// What the manifests of a library say, under the ids by which a scene finds them that has another
/// library, if this one has a `name`; one that cannot be read is listed with the reason.
pub(crate) fn items_of(library: &Library, name: Option<(&str, &Path)>) -> Vec<LibraryEntry> {
    let title = title_of(library);
    let home: Arc<str> = name.map_or(title, |(title, _)| title.into());
    let item = |id: &String| {
        let entry = library.index().and_then(|index| index.entry(id));
        let (level_db, mean_um) = entry.map_or((None, [0.0; 2]), |entry| {
            (entry.level_db(), [entry.a40_um, entry.a320_um])
        });
        let key = name.map_or_else(|| id.clone(), |(_, name)| id_in(name, id));
        match library.manifest(id) {
            Ok(manifest) => LibraryEntry {
                id: key,
                home: Arc::clone(&home),
                kind: kind(manifest.construction.word(), &manifest.fibre),
                construction: manifest.construction.word(),
                structure: kind_of(&manifest),
                measured: MeasuredFigure::all_of(&manifest.measured),
                name: manifest.name,
                gain_db: manifest.gain_db,
                level_db,
                mean_um,
                flaw: None,
            },
            Err(error) => LibraryEntry {
                id: key,
                home: Arc::clone(&home),
                name: id.clone(),
                kind: String::new(),
                construction: "",
                structure: None,
                measured: Vec::new(),
                gain_db: 0.0,
                level_db,
                mean_um,
                flaw: Some(error.to_string()),
            },
        }
    };
    library.ids().iter().map(item).collect()
}

fn kind(construction: &str, fibre: &str) -> String {
    [construction, fibre]
        .into_iter()
        .filter(|word| !word.is_empty() && *word != "other")
        .collect::<Vec<_>>()
        .join(" · ")
}
