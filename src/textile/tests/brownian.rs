//! The five Brownian surfaces that come with the program.

use std::path::{Path, PathBuf};

use crate::build::build;
use crate::library::index_of;
use crate::{Hurst, Index, Library, Source};

fn library() -> Library {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../textiles/brownian");
    Library::open(&folder).unwrap()
}

#[test]
fn five_brownian_surfaces_are_equally_rough_and_their_exponents_come_back() {
    let library = library();
    let mut exponents = Vec::new();
    for id in library.ids() {
        let textile = library.load(id).unwrap();
        let manifest = textile.manifest();
        let Source::Brownian(recipe) = &manifest.source else {
            unreachable!("{id} is not Brownian");
        };
        assert!((textile.surface().smd_um() - 6.0).abs() < 0.001, "{id}");
        let hash = manifest.source.recipe_hash(Path::new(id)).unwrap();
        assert_eq!(
            recipe.recipe_hash,
            Some(hash),
            "{id} was not built from this recipe"
        );
        let heights = |direction| textile.surface().profile(direction).unwrap().heights_um();
        let lines = [
            heights(crate::surface::Direction::WarpForward),
            heights(crate::surface::Direction::WeftForward),
        ];
        let found = Hurst::of_lines(&lines).unwrap();
        assert!(
            (found.exponent - recipe.hurst).abs() < 0.1_f64.max(3.0 * found.error),
            "{id}: {found:?}"
        );
        let said = manifest.measured["hurst"];
        assert!(
            (said - found.exponent).abs() < 0.002,
            "{id} says {said}: {found:?}"
        );
        assert_eq!(manifest.licence, "CC0-1.0");
        exponents.push(recipe.hurst);
    }
    assert_eq!(exponents, [0.1, 0.3, 0.5, 0.7, 0.9]);
    let index = library.index().unwrap();
    assert_eq!(index_of(&library, index.tuning, 2).unwrap(), *index);
}

#[test]
fn a_brownian_surface_is_rebuilt_byte_for_byte() {
    let (library, id) = (library(), "brownian-h5");
    let recipe = library.manifest(id).unwrap();
    for file in build(&recipe, Path::new(id)).unwrap() {
        let shipped = library.store_of(id).unwrap().read(id, &file.name).unwrap();
        assert!(shipped == file.bytes, "{id}/{} differs", file.name);
    }
}

#[test]
#[ignore = "writes the five surfaces; set SELVEDGE_LIBRARY_OUT to the folder"]
fn rebuild_the_brownian_library() {
    let out = std::env::var_os("SELVEDGE_LIBRARY_OUT")
        .map(PathBuf::from)
        .unwrap();
    let library = library();
    let tuning = library.index().unwrap().tuning;
    let index = selvedge_foundation::progress::Progress::unheard(|progress| {
        Index::build(&library, &out, tuning, 2, progress)
    });
    assert_eq!(index.unwrap().textiles.len(), 5);
}

#[test]
fn the_scene_of_five_names_the_five() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes");
    let text = std::fs::read_to_string(folder.join("five-brownian.scene.toml")).unwrap();
    for id in library().ids() {
        assert!(text.contains(&format!("id = \"{id}\"")), "{id} is missing");
    }
}
