//! Opening a scene: everything that takes longer than a frame, done on a named thread.
//!
//! What comes back is complete (textiles, tables, the library's names) or one line that says what
//! is wrong; until then, and after a failure, the last scene stays.

use std::path::{Path, PathBuf};

use crate::bench::error::AppError;
use crate::bench::rendering::Rendering;
use crate::bench::settings::build_cache;
use crate::bench::view::LibraryEntry;
use selvedge_engine::PreparedScene;
use selvedge_render::scene::LoadedScene;

/// A scene without textiles over the shipped library.
const EMPTY: &str =
    "name = \"New scene\"\nsize_mm = [260.0, 260.0]\n[[display]]\ngeometry = \"exeter-24\"\n";

/// Where a scene comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Origin {
    /// Nowhere: it has no textiles yet.
    New,
    /// The program.
    Shipped,
    /// A file.
    File(PathBuf),
    /// The text of a scene that was not saved, and its file if it has one.
    Restored(String, Option<PathBuf>),
}

/// A scene that is ready to be shown and felt.
#[derive(Debug)]
pub(crate) struct Opened {
    /// Where it came from.
    pub path: Option<PathBuf>,
    /// The scene with its textiles.
    pub loaded: LoadedScene,
    /// The same, ready for the engine.
    pub prepared: PreparedScene,
    /// How it was prepared.
    pub rendering: Rendering,
    /// That textiles are not what they were when it was saved.
    pub(crate) changed: Option<String>,
    /// The textiles of its library.
    pub(crate) library_view: Vec<LibraryEntry>,
}

/// Opens a scene on this thread.
pub(crate) fn open(origin: Origin, rendering: Rendering) -> Result<Opened, AppError> {
    let loaded = match &origin {
        Origin::New => LoadedScene::from_toml(EMPTY, Path::new("new scene"))?,
        Origin::Shipped => LoadedScene::shipped()?,
        Origin::File(path) => LoadedScene::read(path, build_cache().as_ref())?,
        Origin::Restored(text, path) => {
            let path = path
                .as_deref()
                .unwrap_or_else(|| Path::new("unsaved scene"));
            LoadedScene::from_text(text, path, build_cache().as_ref())?
        }
    };
    let accuracy = rendering.accuracy();
    let prepared = PreparedScene::prepare(&loaded, rendering.method, &accuracy)?;
    Ok(Opened {
        path: match origin {
            Origin::File(path) => Some(path),
            Origin::Restored(_, path) => path,
            Origin::New | Origin::Shipped => None,
        },
        prepared,
        rendering,
        changed: loaded.changed(),
        library_view: crate::bench::library_shelf::items_of(loaded.library(), None),
        loaded,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_scene_has_the_shipped_library_and_nothing_in_it() {
        let opened = open(Origin::New, Rendering::default()).unwrap();
        assert!(opened.loaded.scene().textiles.is_empty() && opened.path.is_none());
        assert_eq!(opened.library_view.len(), 16);
        assert_eq!(opened.prepared.n_contactors(), 24);
    }
}
