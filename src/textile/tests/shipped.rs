//! What the shipped library promises.

use std::path::{Path, PathBuf};

use crate::library::index_of;
use crate::tactile::{Filters, Levels};
use crate::*;
use selvedge_foundation::numerics::median;

/// The shipped textiles with their levels.
fn shipped() -> Vec<(std::sync::Arc<Textile>, Levels)> {
    let library = Library::shipped().unwrap();
    let load = |id: &String| {
        let textile = library.load(id).unwrap();
        let levels = Levels::of(textile.surface(), &Filters::default());
        (textile, levels)
    };
    library.ids().iter().map(load).collect()
}

fn range(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::MIN, f64::max);
    highest - values.iter().copied().fold(f64::MAX, f64::min)
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let mean = |x: &[f64]| x.iter().sum::<f64>() / n;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let dot = |x: &[f64], p: f64, y: &[f64], q: f64| {
        x.iter().zip(y).map(|(x, y)| (x - p) * (y - q)).sum::<f64>()
    };
    dot(a, mean_a, b, mean_b) / (dot(a, mean_a, a, mean_a) * dot(b, mean_b, b, mean_b)).sqrt()
}

#[test]
fn the_shipped_library_is_eight_woven_and_eight_knitted() {
    let textiles = shipped();
    let count = |is: &dyn Fn(&Manifest) -> bool| {
        textiles
            .iter()
            .filter(|(textile, _)| is(textile.manifest()))
            .count()
    };
    assert_eq!(count(&|m| m.construction == Construction::Woven), 8);
    assert_eq!(count(&|m| m.construction == Construction::Knitted), 8);
    assert_eq!(
        count(&|m| ["silk", "wool", "jute"].contains(&m.fibre.as_str())),
        3
    );
    assert_eq!(
        count(&|m| ["polyester", "polyamide"].contains(&m.fibre.as_str())),
        11
    );
    assert_eq!(count(&|m| m.fibre.contains('/')), 2);
    assert_eq!(
        count(&|m| m.licence == "CC0-1.0" && m.notes.starts_with("Model of")),
        16
    );
    for (textile, _) in &textiles {
        assert!(textile.appearance().unwrap().is_some(), "{}", textile.id());
        assert!(textile.fall_backs().is_empty(), "{}", textile.id());
    }
}

#[test]
fn the_shipped_textiles_span_what_the_originals_spanned() {
    let textiles = shipped();
    let tuning = Library::shipped().unwrap().default_tuning();
    let reference = tuning.compression_reference_db.unwrap();
    let level = |b: usize| -> Vec<f64> {
        textiles
            .iter()
            .map(|(_, levels)| 20.0 * levels.mean_um[b].log10())
            .collect()
    };
    let tuned = |b: usize| -> Vec<f64> {
        let gain = |levels: &Levels| tuning.compression_gain_db(levels.level_db(), reference);
        let of = |(_, levels): &(_, Levels)| {
            20.0 * levels.mean_um[b].log10() + gain(levels) + tuning.gain_db
        };
        textiles.iter().map(of).collect()
    };
    let (plain, compressed) = ([level(0), level(1)], [tuned(0), tuned(1)]);
    let ranges = compressed.each_ref().map(|band| range(band));
    println!(
        "tuned ranges {ranges:?} dB, untuned {:?}",
        plain.each_ref().map(|b| range(b))
    );
    assert!(
        (14.0..=18.0).contains(&ranges[0]),
        "A40 spans {} dB",
        ranges[0]
    );
    assert!(
        (10.5..=13.5).contains(&ranges[1]),
        "A320 spans {} dB",
        ranges[1]
    );
    for b in [0, 1] {
        assert!(
            range(&plain[b]) > 1.3 * ranges[b],
            "compression does little in band {b}"
        );
    }
    let loudest = compressed
        .iter()
        .flatten()
        .copied()
        .fold(f64::MIN, f64::max);
    assert!(
        (19.0..=24.5).contains(&loudest),
        "the loudest mean is {loudest} dB re 1 µm"
    );
    for pair in [&plain, &compressed] {
        let r = correlation(&pair[0], &pair[1]);
        println!("correlation {r}");
        assert!(r < 0.9, "A40 against A320 is a line: {r}");
    }
}

#[test]
fn the_shipped_textiles_vary_over_the_surface_and_little_with_direction() {
    let textiles = shipped();
    let mut all = Vec::new();
    for b in [0, 1] {
        let mut cvs: Vec<f64> = textiles.iter().map(|(_, levels)| levels.cv[b]).collect();
        all.extend_from_slice(&cvs);
        let median = median(&mut cvs);
        assert!(
            (0.2..=0.6).contains(&median),
            "median in band {b}: {median}"
        );
    }
    let usual = all.iter().filter(|cv| (0.15..=0.65).contains(*cv)).count();
    assert!(usual * 10 >= all.len() * 7, "{usual} of {}", all.len());
    for (textile, levels) in &textiles {
        let worst = levels.anisotropy_db[0].max(levels.anisotropy_db[1]);
        assert!(worst < 4.5, "{}: {:?}", textile.id(), levels.anisotropy_db);
    }
}

#[test]
fn the_shipped_textiles_are_as_rough_as_such_cloth() {
    for (id, low, high) in [
        ("silk-crepe", 1.0, 3.0),
        ("polyester-satin", 1.0, 3.0),
        ("polyamide-taffeta", 1.0, 6.0),
        ("wool-twill", 3.0, 7.0),
        ("denim", 5.0, 12.0),
        ("polyester-panama", 3.0, 12.0),
        ("jute-plain", 15.0, 30.0),
        ("wool-rib", 5.0, 20.0),
        ("polyamide-rib", 5.0, 20.0),
        ("polyester-fleece", 5.0, 20.0),
        ("polyester-terry", 5.0, 20.0),
    ] {
        let textile = Library::shipped().unwrap().load(id).unwrap();
        let smd = textile.surface().smd_um();
        assert!((low..=high).contains(&smd), "{id}: SMD {smd} µm");
        let said = textile.manifest().measured["smd_um"];
        assert!((said - smd).abs() < 0.006, "{id} says {said}, is {smd}");
    }
}

#[test]
fn the_shipped_index_is_what_its_profiles_give() {
    let library = Library::shipped().unwrap();
    let index = library.index().unwrap();
    assert_eq!(index_of(&library, index.tuning, 2).unwrap(), *index);
    for id in library.ids() {
        let manifest = library.manifest(id).unwrap();
        let hash = manifest.source.recipe_hash(Path::new(id)).unwrap();
        let said = match &manifest.source {
            Source::Weave(keys) => keys.recipe_hash.clone(),
            Source::Knit(keys) => keys.recipe_hash.clone(),
            _ => None,
        };
        assert_eq!(said, Some(hash), "{id} was not built from this recipe");
    }
}

#[test]
fn two_shipped_textiles_are_rebuilt_byte_for_byte() {
    let library = Library::shipped().unwrap();
    for id in ["denim", "polyamide-rib"] {
        let recipe = library.manifest(id).unwrap();
        for file in build(&recipe, Path::new(id)).unwrap() {
            let shipped = library.store_of(id).unwrap().read(id, &file.name).unwrap();
            assert!(shipped == file.bytes, "{id}/{} differs", file.name);
        }
    }
}

#[test]
#[ignore = "writes the shipped library; set SELVEDGE_LIBRARY_OUT to the folder"]
fn rebuild_the_shipped_library() {
    let out = std::env::var_os("SELVEDGE_LIBRARY_OUT")
        .map(PathBuf::from)
        .unwrap();
    let library = Library::shipped().unwrap();
    let tuning = library.index().unwrap().tuning;
    let index = selvedge_foundation::progress::Progress::unheard(|progress| {
        Index::build(&library, &out, tuning, 2, progress)
    });
    assert_eq!(index.unwrap().textiles.len(), 16);
}
