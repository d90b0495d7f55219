//! The materials of Wall & Harwin that come with the program.

use std::path::Path;

use crate::{Library, Source};

/// Standard deviations that the recipes state, µm.
const SPREADS_UM: [(&str, f64); 5] = [
    ("mouse-mat", 45.0),
    ("sandpaper", 59.0),
    ("cardboard", 11.0),
    ("wood-with-grain", 34.8),
    ("wood-against-grain", 20.7),
];

#[test]
fn materials_have_fifty_harmonics_and_the_spreads_that_are_stated() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let library = Library::named(&root.join("textiles/wall-harwin.toml"), None).unwrap();
    let scene = root.join("assets/scenes/wall-harwin.scene.toml");
    let scene = std::fs::read_to_string(scene).unwrap();
    let mut ids = library.ids().iter();
    for (id, spread_um) in SPREADS_UM {
        assert_eq!(ids.next().unwrap(), id);
        assert!(scene.contains(&format!("id = \"{id}\"")), "{id}");
        let manifest = library.manifest(id).unwrap();
        assert_eq!(manifest.licence, "CC0-1.0");
        let Source::Fourier(recipe) = &manifest.source else {
            panic!("{id} is of another kind");
        };
        let template = &recipe.template;
        assert_eq!(template.harmonics([0.0, 1000.0]).len(), 50, "{id}");
        let kept = template.harmonics([recipe.lowest_per_m, recipe.highest_per_m]);
        assert_eq!((kept[0], kept.len()), (5, 46), "100 to 1000 cycles/m");
        let square = |n: &usize| template.sd_cos_um[n - 1].powi(2);
        let found_um = kept.iter().map(square).sum::<f64>().sqrt();
        assert!((found_um - spread_um).abs() < 0.01, "{id}: {found_um}");
        // One drawing of few strong harmonics is not its mean.
        let map = manifest.source.height_map().unwrap().unwrap();
        let drawn = map.sq_um() / spread_um;
        assert!((0.7..1.4).contains(&drawn), "{id}: {drawn} of it");
        assert!(map.is_periodic(), "{id} goes on mirrored");
    }
    assert_eq!(ids.next(), None);
}
