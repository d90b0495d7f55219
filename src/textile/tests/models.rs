//! What the models, the builder and folder libraries promise.

use std::fs;
use std::path::Path;

use crate::library::Index;
use crate::surface::{BIN_SPACING_PER_MM, Direction, Surface};
use crate::tactile::{Filters, Levels};
use crate::*;
use selvedge_scratch::ScratchFolder;

/// A textile with little irregularity; `keys` go to the source, `yarn` to every yarn.
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
    let model = manifest.source.keys().model().unwrap().unwrap();
    let profiles = recipe::profiles_of_files(&model.profile_files().unwrap()).unwrap();
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
    10.0 * (peak / selvedge_foundation::numerics::median(&mut around)).log10()
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
    // Courses are 1/1.8 mm apart and wales 1/1.4; what repeats across a rib is two
    // wales.
    for (structure, along, across) in [
        ("jersey", 1.8, 1.4),
        ("reverse-jersey", 1.8, 1.4),
        ("rib-1-1", 1.8, 0.7),
        ("interlock", 1.8, 1.4),
        ("pique", 1.8, 1.4),
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

#[test]
fn a_made_textile_is_a_library_entry_with_a_picture() {
    let scratch = ScratchFolder::made("made");
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
    let scratch = ScratchFolder::made("lazy");
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
        (
            "2.0\n",
            "2.0\n[[textile]]\nid = \"a\"\na40_um = 1.0\na320_um = 2.0\n",
            "library.toml:10: textile \"a\" twice",
        ),
        (
            "2.0\n",
            "2.0\n[[textile]]\nid = \"b\"\na40_um = 1.0\na320_um = -2.0\n",
            "library.toml:12: a320_um is -2",
        ),
    ] {
        let error = read(&good.replace(from, to)).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
    }
}
