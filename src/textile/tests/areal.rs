//! Textiles that are felt at every point of their area.

use std::path::Path;

use crate::surface::{Direction, Probe, Representation, Surface};
use crate::tactile::{Filters, Levels, Tuning};
use crate::*;
use selvedge_scratch::ScratchFolder;

/// A twill with its profiles named, as the shipped ones have them, but for `keys` of its source.
fn twill(keys: &str) -> Manifest {
    let yarn = "width_um = 310.0\nthickness_um = 190.0\ncolour = \"#806040\"";
    let text = format!(
        "name = \"T\"\nconstruction = \"woven\"\nfibre = \"wool\"\n[source]\nkind = \"weave\"\n\
         seed = 12\ninterlacing = \"twill-2-2\"\nwarp_per_cm = 26.0\nweft_per_cm = 24.0\n\
         compaction = 0.4\nbow_um = 120.0\n{keys}\n[source.warp]\n{yarn}\n\
         [source.weft]\n{yarn}\n"
    );
    Manifest::from_toml(&text, Path::new("t.toml")).unwrap()
}

#[test]
fn economical_is_the_default_and_changes_no_recipe() {
    let path = Path::new("t.toml");
    let (silent, said) = (twill(""), twill("representation = \"economical\""));
    assert_eq!(silent, said);
    assert!(!silent.to_toml(path).unwrap().contains("representation"));
    let areal = twill("representation = \"areal\"");
    assert_eq!(areal.source.representation(), Representation::Areal);
    let written = areal.to_toml(path).unwrap();
    assert_eq!(Manifest::from_toml(&written, path).unwrap(), areal);
    let hash = |manifest: &Manifest| manifest.source.recipe_hash(path).unwrap();
    assert_ne!(hash(&areal), hash(&silent));
    let wrong = written.replace("\"areal\"", "\"ideal\"");
    let error = Manifest::from_toml(&wrong, path).unwrap_err().to_string();
    assert!(
        error.contains("economical") && !error.contains('\n'),
        "{error}"
    );
}

#[test]
fn an_areal_textile_is_loaded_felt_and_indexed_like_any_other() {
    let folder = ScratchFolder::new("areal");
    let path = Path::new("t.toml");
    for (id, keys) in [("along", ""), ("areal", "representation = \"areal\"")] {
        let recipe = twill(keys).to_toml(path).unwrap();
        make(&recipe, path, &folder.join(id)).unwrap();
    }
    let library = Library::open(&folder).unwrap();
    let [along, areal] = ["along", "areal"].map(|id| library.load(id).unwrap());
    assert_eq!(along.surface().representation(), Representation::Economical);
    assert_eq!(areal.surface().representation(), Representation::Areal);
    assert_eq!(areal.fall_backs(), Vec::<String>::new());
    let [n_along, n_across] = areal.surface().spectra(Direction::WarpForward).shape();
    assert!(n_along >= 10 && n_across >= 10, "{n_along} × {n_across}");
    let index = library::index_of(&library, Tuning::default(), 1).unwrap();
    let [a, b] = [0, 1].map(|nth: usize| index.textiles[nth].level_db().unwrap());
    assert!((a - b).abs() < 12.0, "the same cloth: {a} and {b} dB");
}

#[test]
fn the_levels_of_both_agree_where_the_wire_is_the_same() {
    let map = twill("").source.height_map().unwrap().unwrap();
    assert!(map.is_periodic());
    let wire = Probe::contactor();
    let middle_mm = map.size_mm().map(|mm| 0.5 * mm);
    let random = selvedge_foundation::numerics::Random::new(1);
    let [warp, _, weft, _] = map.strokes(&wire, middle_mm, &random).unwrap();
    let economical = Surface::from_profiles([warp, None, weft, None], 0.0).unwrap();
    let areal = Surface::areal(&map, 0.0).unwrap();
    let [one, all] = [&economical, &areal].map(|s| Levels::of(s, &Filters::default()));
    for b in 0..2 {
        let ratio = one.mean_um[b] / all.mean_um[b];
        assert!((0.6..1.6).contains(&ratio), "band {b}: {ratio}");
    }
}
