use std::fs;
use std::path::{Path, PathBuf};

use super::build::index_of;
use super::*;
use crate::surface::{BIN_SPACING_PER_MM, Direction, Surface};
use crate::tactile::{Filters, Levels};

/// A cloth with little irregularity; `keys` go to the source, `yarn` to every yarn.
fn weave(interlacing: &str, per_cm: [f64; 2], keys: &str, yarn: &str) -> String {
    let [warp, weft] = per_cm;
    let yarn = format!(
        "width_um = {}\nthickness_um = 180.0\ncolour = \"#806040\"\n{yarn}",
        7000.0 / warp.max(weft)
    );
    format!(
        "name = \"W\"\nconstruction = \"woven\"\nfibre = \"silk\"\n[source]\nkind = \"weave\"\n\
         seed = 5\ninterlacing = \"{interlacing}\"\nwarp_per_cm = {warp}\nweft_per_cm = {weft}\n\
         compaction = 0.7\n{keys}\n[source.warp]\n{yarn}\n[source.weft]\n{yarn}\n"
    )
}

fn knit(structure: &str, per_cm: [f64; 2], keys: &str) -> String {
    let [wales, courses] = per_cm;
    format!(
        "name = \"K\"\nconstruction = \"knitted\"\nfibre = \"wool\"\n[source]\nkind = \"knit\"\n\
         seed = 6\nstructure = \"{structure}\"\nwales_per_cm = {wales}\n\
         courses_per_cm = {courses}\nloop_depth_um = 80.0\n{keys}\n[source.yarn]\n\
         width_um = {}\nthickness_um = 150.0\ncolour = \"#806040\"\n",
        3300.0 / wales
    )
}

const REGULAR: &str = "pitch_cv = 0.0\ntension_drift = 0.0";
const IRREGULAR: &str = "pitch_cv = 0.06\ntension_drift = 0.2\nbow_um = 100.0";

fn surface_of(recipe: &str) -> Surface {
    let manifest = Manifest::from_toml(recipe, Path::new("recipe.toml")).unwrap();
    let model = model::Model::of(&manifest.source).unwrap();
    let profiles = model::profiles_of_files(&model.profile_files().unwrap()).unwrap();
    Surface::from_profiles(profiles, 0.0).unwrap()
}

/// Mean power by bin (bin k in slot k − 1), µm².
fn mean_powers(surface: &Surface, direction: Direction) -> Vec<f64> {
    let spectra = surface.spectra(direction);
    let n = spectra.n_points();
    let mut mean = vec![0.0; 60];
    for point in 0..n {
        for (sum, power) in mean.iter_mut().zip(spectra.powers_um2(point)) {
            *sum += power / n as f64;
        }
    }
    mean
}

/// How far the highest bin within one of a wavenumber stands above the median of the six around
/// it, dB.
fn rise_db(powers: &[f64], per_mm: f64) -> f64 {
    let centre = (1..powers.len())
        .min_by(|&a, &b| {
            let off = |k: usize| (k as f64 * BIN_SPACING_PER_MM - per_mm).abs();
            off(a).total_cmp(&off(b))
        })
        .unwrap();
    let at = |k: usize| powers[k - 1];
    let peak = (centre - 1..=centre + 1).map(at).fold(0.0, f64::max);
    let mut around: Vec<f64> = (centre.saturating_sub(4)..=centre + 4)
        .filter(|k| k.abs_diff(centre) > 1 && *k > 0)
        .map(at)
        .collect();
    10.0 * (peak / crate::numerics::median(&mut around)).log10()
}

#[test]
fn woven_pitch_and_harmonics_stand_in_the_spectra() {
    for interlacing in [
        "plain",
        "twill-2-2",
        "basket-2-2",
        "satin-5",
        "warp-rib",
        "crepe",
    ] {
        let surface = surface_of(&weave(interlacing, [22.0, 18.0], REGULAR, ""));
        for (direction, pitch) in [(Direction::WarpForward, 1.8), (Direction::WeftReverse, 2.2)] {
            let powers = mean_powers(&surface, direction);
            let rises = [1.0, 2.0, 3.0].map(|h| rise_db(&powers, h * pitch));
            assert!(
                rises[0] > 6.0,
                "{interlacing} {direction:?}: pitch {rises:?}"
            );
            assert!(
                rises[1].max(rises[2]) > 6.0,
                "{interlacing} {direction:?}: {rises:?}"
            );
        }
    }
}

#[test]
fn knitted_pitch_and_harmonics_stand_in_the_spectra() {
    // Courses are 1/1.8 mm apart and wales 1/1.4; what repeats across a rib is two wales, in a
    // piqué two courses of tucks and two wales.
    for (structure, along, across) in [
        ("jersey", 1.8, 1.4),
        ("reverse-jersey", 1.8, 1.4),
        ("rib-1-1", 1.8, 0.7),
        ("interlock", 1.8, 1.4),
        ("pique", 0.9, 0.7),
    ] {
        let surface = surface_of(&knit(structure, [14.0, 18.0], REGULAR));
        for (direction, pitch) in [
            (Direction::WarpReverse, along),
            (Direction::WeftForward, across),
        ] {
            let powers = mean_powers(&surface, direction);
            let rises = [1.0, 2.0, 3.0].map(|h| rise_db(&powers, h * pitch));
            assert!(rises[0] > 6.0, "{structure} {direction:?}: pitch {rises:?}");
            assert!(
                rises[1].max(rises[2]) > 6.0,
                "{structure} {direction:?}: {rises:?}"
            );
        }
    }
}

#[test]
fn irregular_cloth_varies_from_place_to_place_and_regular_cloth_hardly() {
    let filters = Filters::default();
    let slubs = "slubs_per_m = 10\nslub_gain = 0.6\ncount_cv = 0.1\nband_cv = 0.05";
    let regular = Levels::of(
        &surface_of(&weave("plain", [22.0; 2], REGULAR, "")),
        &filters,
    );
    let varied = Levels::of(
        &surface_of(&weave("plain", [22.0; 2], IRREGULAR, slubs)),
        &filters,
    );
    assert!(regular.cv[1] < 0.08, "{regular:?}");
    assert!(
        varied.cv[0] > 0.2 && varied.cv[1] > 2.0 * regular.cv[1],
        "{varied:?}"
    );
    assert!(
        varied.mean_um[0] > 5.0 * regular.mean_um[0],
        "slubs are slow: {varied:?}"
    );
}

#[test]
fn a_recipe_is_one_cloth_and_a_seed_another() {
    let recipe = knit("jersey", [14.0, 18.0], IRREGULAR);
    let heights = |recipe: &str, direction| {
        surface_of(recipe)
            .profile(direction)
            .unwrap()
            .heights_um()
            .to_vec()
    };
    let first = heights(&recipe, Direction::WarpForward);
    assert_eq!(first, heights(&recipe, Direction::WarpForward));
    assert_ne!(
        first,
        heights(
            &recipe.replace("seed = 6", "seed = 7"),
            Direction::WarpForward
        )
    );
}

#[test]
fn reverse_strokes_cover_the_same_cloth_and_differ() {
    let surface = surface_of(&weave(
        "twill-2-2",
        [22.0, 18.0],
        IRREGULAR,
        "count_cv = 0.1",
    ));
    let heights = |direction| surface.profile(direction).unwrap().heights_um();
    let forward = heights(Direction::WarpForward);
    let reverse = heights(Direction::WarpReverse);
    let apart = |reverse: &mut dyn Iterator<Item = &f64>| {
        forward
            .iter()
            .zip(reverse)
            .map(|(a, b)| (a - b).abs())
            .sum::<f64>()
            / 4600.0
    };
    let along = apart(&mut reverse.iter().rev());
    let against = apart(&mut reverse.iter());
    assert_eq!(forward.len(), 4600);
    assert!(
        along > 0.1 && along < 0.3 * against,
        "{along} where unrelated is {against}"
    );
}

/// A folder of its own for a test, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("selvedge-{name}-{}", std::process::id()));
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

#[test]
fn a_made_textile_is_a_library_entry_with_a_picture() {
    let scratch = Scratch::new("made");
    let recipe = weave("basket-2-2", [12.0; 2], "", "");
    let made = make(&recipe, Path::new("recipe.toml"), &scratch.0.join("w")).unwrap();
    let library = Library::open(&scratch.0).unwrap();
    assert_eq!(library.ids(), ["w"]);
    let textile = library.load("w").unwrap();
    assert_eq!(*textile.manifest(), made);
    assert_eq!(textile.fall_backs(), Vec::<String>::new());
    let picture = textile.appearance().unwrap().unwrap();
    assert!(picture.image.width >= 220 && picture.px_per_mm == 10.0);
    let again = build(&made, Path::new("t.toml")).unwrap();
    for file in again {
        let path = scratch.0.join("w").join(&file.name);
        assert_eq!(fs::read(path).unwrap(), file.bytes, "{}", file.name);
    }
}

#[test]
fn what_is_measured_is_no_recipe() {
    let text = "name = \"A\"\nconstruction = \"other\"\nfibre = \"paper\"\n[source]\n\
        kind = \"profiles\"\nwarp_forward = \"w.csv\"\n";
    let error = make(text, Path::new("t.toml"), Path::new("/nowhere"))
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("t.toml: a source of kind \"profiles\""),
        "{error}"
    );
}

#[test]
fn libraries_read_only_what_is_asked_for_and_name_what_is_missing() {
    let scratch = Scratch::new("lazy");
    let root = &scratch.0;
    let heights: String = (0..1000).fold("x_mm,height_um\n".to_owned(), |text, i| {
        text + &format!("{},{}\n", f64::from(i) * 0.005, (f64::from(i) * 0.3).sin())
    });
    let manifest = "name = \"A\"\nconstruction = \"other\"\nfibre = \"paper\"\n[source]\n\
        kind = \"profiles\"\nwarp_forward = \"w.csv\"\n";
    for id in ["b", "a", "broken"] {
        fs::create_dir(root.join(id)).unwrap();
        fs::write(root.join(id).join("textile.toml"), manifest).unwrap();
        fs::write(root.join(id).join("w.csv"), &heights).unwrap();
    }
    fs::write(root.join("broken/w.csv"), "x_mm,height_um\n0,NaN\n").unwrap();
    fs::create_dir(root.join("no-textile")).unwrap();
    let library = Library::open(root).unwrap();
    assert_eq!(library.ids(), ["a", "b", "broken"]);
    let textile = library.load("a").unwrap();
    assert_eq!(textile.fall_backs().len(), 3, "{:?}", textile.fall_backs());
    let failed = |id: &str| library.load(id).unwrap_err().to_string();
    assert!(
        failed("broken").contains("w.csv:2: height_um is \"NaN\""),
        "{}",
        failed("broken")
    );
    assert!(
        failed("silk").contains("no textile \"silk\""),
        "{}",
        failed("silk")
    );
    assert!(failed("../a").contains("no textile"), "{}", failed("../a"));
    fs::remove_dir_all(root.join("b")).unwrap();
    assert!(failed("b").starts_with("cannot read"), "{}", failed("b"));
    let nowhere = Library::open(&root.join("nowhere"))
        .unwrap_err()
        .to_string();
    assert!(nowhere.starts_with("cannot read"), "{nowhere}");
}

#[test]
fn a_wrong_index_names_its_line() {
    let good = "content_hash = \"\"\ncompression_reference_db = 1.0\n[tuning]\n\
        compression = 0.5\n[[textile]]\nid = \"a\"\na40_um = 1.0\na320_um = 2.0\n";
    let read = |text: &str| Index::from_toml(text, Path::new("library.toml"));
    let tuning = read(good).unwrap().default_tuning();
    assert_eq!(
        (tuning.compression, tuning.compression_reference_db),
        (0.5, Some(1.0))
    );
    for (from, to, expected) in [
        ("0.5", "1.5", "library.toml:4: compression is 1.5"),
        (
            "a40_um = 1.0",
            "a40_um = nan",
            "library.toml:7: a40_um is NaN",
        ),
        ("a320_um", "a330_um", "library.toml:8: unknown field"),
        (
            "db = 1.0",
            "db = inf",
            "library.toml:2: compression_reference_db is inf",
        ),
    ] {
        let error = read(&good.replace(from, to)).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
    }
}

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
        (23.0..=28.5).contains(&loudest),
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
        let median = crate::numerics::median(&mut cvs);
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
    assert_eq!(index_of(&library, index.tuning).unwrap(), *index);
    for id in library.ids() {
        let manifest = library.manifest(id).unwrap();
        let hash = manifest.source.recipe_hash(Path::new(id)).unwrap();
        let said = match &manifest.source {
            Source::Weave(keys) => keys.recipe_hash.clone(),
            Source::Knit(keys) => keys.recipe_hash.clone(),
            Source::Profiles(_) => None,
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
            let shipped = library.file(id, &file.name).unwrap();
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
    let index =
        crate::progress::unheard(|progress| build_library(&library, &out, tuning, progress));
    assert_eq!(index.unwrap().textiles.len(), 16);
}
