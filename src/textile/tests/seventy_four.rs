//! What the library of seventy-four promises, and files of recipes in general.
//!
//! Few are built here; all of them when `SELVEDGE_ALL_TEXTILES` is set.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::library::{IndexEntry, SEVENTY_FOUR, index_of};
use crate::recipe::Side;
use crate::tactile::{Filters, Levels};
use crate::*;
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::progress::Progress;
use selvedge_scratch::ScratchFolder;

fn seventy_four() -> Library {
    Library::named(Path::new(SEVENTY_FOUR), None).unwrap()
}

fn levels(library: &Library, id: &str) -> Levels {
    Levels::of(library.load(id).unwrap().surface(), &Filters::default())
}

#[test]
fn there_are_53_textiles_and_21_of_them_have_two_sides() {
    let library = seventy_four();
    let (backs, faces): (Vec<&String>, Vec<&String>) =
        library.ids().iter().partition(|id| id.ends_with("-back"));
    assert_eq!(
        (library.ids().len(), faces.len(), backs.len()),
        (74, 53, 21)
    );
    let mut seeds = BTreeSet::new();
    let mut fibres = BTreeSet::new();
    for id in &faces {
        let manifest = library.manifest(id).unwrap();
        assert!(manifest.notes.starts_with("Model of"), "{id}");
        assert_eq!(manifest.licence, "CC0-1.0", "{id}");
        let seed = match &manifest.source {
            Source::Weave(keys) => keys.seed,
            Source::Knit(keys) => keys.seed,
            _ => panic!("{id} is no cloth of yarns"),
        };
        assert!(seeds.insert(seed), "{id} has another's seed");
        fibres.extend(manifest.fibre.split('/').map(str::to_owned));
    }
    assert!(fibres.len() >= 12, "{fibres:?}");
    for back in backs {
        let face = back.strip_suffix("-back").unwrap();
        let (face, back) = (library.manifest(face), library.manifest(back));
        let mut turned = back.unwrap();
        match &mut turned.source {
            Source::Weave(keys) => keys.side = Side::Face,
            Source::Knit(keys) => keys.side = Side::Face,
            _ => {}
        }
        assert_eq!(turned.source, face.unwrap().source, "the same cloth");
    }
}

#[test]
fn every_family_is_there() {
    let library = seventy_four();
    let mut kinds = BTreeSet::new();
    for id in library.ids() {
        kinds.extend(kind_of(&library.manifest(id).unwrap()));
    }
    assert_eq!(kinds.len(), 16, "{kinds:?}");
    assert!(!kinds.contains("other weave"), "{kinds:?}");
}

#[test]
fn the_main_library_is_in_it_unchanged() {
    let (main, library) = (Library::shipped().unwrap(), seventy_four());
    for id in main.ids() {
        let recipe = library.manifest(id).unwrap();
        let mut shipped = main.manifest(id).unwrap();
        shipped.source = shipped.source.recipe();
        shipped.appearance = None;
        shipped.measured.clear();
        assert_eq!(recipe, shipped, "{id}");
    }
    let is_all = std::env::var_os("SELVEDGE_ALL_TEXTILES").is_some();
    for id in main.ids().iter().take(if is_all { 16 } else { 1 }) {
        for file in build(&library.manifest(id).unwrap(), Path::new(id)).unwrap() {
            let shipped = main.store_of(id).unwrap().read(id, &file.name).unwrap();
            assert!(shipped == file.bytes, "{id}/{} differs", file.name);
        }
    }
}

#[test]
fn the_most_typical_of_each_kind_are_the_main_library() {
    let typical = Library::most_typical(&seventy_four()).unwrap();
    assert_eq!(
        typical,
        Library::most_typical(&seventy_four()).unwrap(),
        "again"
    );
    let chosen: BTreeSet<String> = typical.into_iter().map(|(_, id)| id).collect();
    let main = Library::shipped().unwrap();
    assert_eq!(chosen, main.ids().iter().cloned().collect());
    let scratch = ScratchFolder::made("no-index");
    let bare = Library::open(&scratch.0).unwrap();
    let error = Library::most_typical(&bare).unwrap_err().to_string();
    assert!(error.contains("library.toml"), "{error}");
}

#[test]
fn the_seventy_four_span_what_the_originals_spanned() {
    let library = seventy_four();
    let index = library.index().unwrap();
    let tuning = index.default_tuning();
    let reference = tuning.compression_reference_db.unwrap();
    let gain = |entry: &IndexEntry| tuning.compression_gain_db(entry.level_db(), reference);
    let range = |of: &dyn Fn(&IndexEntry) -> f64| {
        let all: Vec<f64> = index.textiles.iter().map(of).collect();
        all.iter().copied().fold(f64::MIN, f64::max) - all.iter().copied().fold(f64::MAX, f64::min)
    };
    let [low, high] = [
        range(&|entry| 20.0 * entry.a40_um.log10() + gain(entry)),
        range(&|entry| 20.0 * entry.a320_um.log10() + gain(entry)),
    ];
    assert!((15.0..=17.0).contains(&low), "A40 spans {low} dB, tuned");
    assert!((11.0..=13.0).contains(&high), "A320 spans {high} dB, tuned");
    assert!(range(&|entry| 20.0 * entry.a40_um.log10()) > 30.0, "before");
}

#[test]
fn cords_and_the_backs_of_satins_differ_strongly_from_direction_to_direction() {
    let library = seventy_four();
    for id in ["viscose-faille", "silk-charmeuse-back"] {
        let [low, high] = levels(&library, id).anisotropy_db;
        assert!(low.max(high) > 12.0, "{id}: {low} and {high} dB");
    }
    let [low, high] = levels(&library, "silk-habotai").anisotropy_db;
    assert!(low.max(high) < 6.0, "{low} and {high} dB");
}

#[test]
fn the_other_side_of_a_cloth_is_another_surface() {
    let library = seventy_four();
    let [nap, smooth] = ["cotton-sweat", "cotton-sweat-back"].map(|id| levels(&library, id));
    assert!(
        smooth.mean_um[1] > 2.0 * nap.mean_um[1],
        "{smooth:?} {nap:?}"
    );
    let index = library.index().unwrap();
    for (id, levels) in [("cotton-sweat", nap), ("cotton-sweat-back", smooth)] {
        let entry = index.entry(id).unwrap();
        let apart = [
            entry.a40_um / levels.mean_um[0],
            entry.a320_um / levels.mean_um[1],
        ];
        assert!(
            apart.iter().all(|ratio| (ratio - 1.0).abs() < 1e-5),
            "{id}: {apart:?}"
        );
    }
}

#[test]
fn what_is_built_is_kept_and_what_is_kept_is_what_is_built() {
    let scratch = ScratchFolder::made("kept");
    let cache = BuildCache::in_folder(&scratch.0.join("cache"));
    let library = Library::named(Path::new(SEVENTY_FOUR), Some(&cache)).unwrap();
    let id = "polyester-honeycomb";
    library.manifest(id).unwrap();
    assert!(
        !scratch.0.join("cache").exists(),
        "nobody asked for a surface"
    );
    let hash = || {
        let store = library.store_of(id).unwrap();
        let names = ["warp_forward.csv", "appearance.png", "textile.toml"];
        sha256_hex(
            names
                .map(|name| store.read(id, name).unwrap())
                .iter()
                .map(AsRef::as_ref),
        )
    };
    let built = hash();
    let entries = || fs::read_dir(scratch.0.join("cache")).unwrap().flatten();
    let paths: Vec<PathBuf> = entries().map(|entry| entry.path()).collect();
    assert_eq!(paths.len(), 1, "{paths:?}");
    let whole = fs::read(&paths[0]).unwrap();
    assert_eq!(hash(), built, "from the cache");
    assert!(library.appearance(id).unwrap().is_some());
    fs::write(&paths[0], &whole[..whole.len() / 2]).unwrap();
    assert_eq!(hash(), built, "built anew");
    assert_eq!(fs::read(&paths[0]).unwrap(), whole, "and kept again");
}

#[test]
fn one_thread_and_two_make_the_same_bytes() {
    let scratch = ScratchFolder::made("threads");
    let recipes = scratch.0.join("three.toml");
    let source = "source = { kind = \"weave\", seed = 1, interlacing = \"plain\", \
        warp_per_cm = 20, weft_per_cm = 18, warp = { width_um = 300, thickness_um = 150, \
        colour = \"#888888\" }, weft = { width_um = 300, thickness_um = 150, \
        colour = \"#999999\" } }\n";
    let text = format!(
        "[[textile]]\nid = \"a\"\nname = \"A\"\nconstruction = \"woven\"\nfibre = \"wool\"\n\
         sides = [\"face\", \"back\"]\n{source}[[textile]]\nid = \"b\"\nlike = \"a\"\n\
         source.interlacing = \"satin-5\"\n"
    );
    fs::write(&recipes, text).unwrap();
    let library = Library::named(&recipes, None).unwrap();
    assert_eq!(library.ids(), ["a", "a-back", "b"]);
    assert_eq!(library.manifest("b").unwrap().fibre, "wool");
    let built = [1, 2].map(|n_threads| {
        let to = scratch.0.join(n_threads.to_string());
        let tuning = library.default_tuning();
        Progress::unheard(|p| Index::build(&library, &to, tuning, n_threads, p)).unwrap();
        to
    });
    for id in library.ids() {
        for name in ["textile.toml", "weft_reverse.csv", "appearance.png"] {
            let [one, two] = built
                .each_ref()
                .map(|to| fs::read(to.join(id).join(name)).unwrap());
            assert!(one == two, "{id}/{name}");
        }
    }
    let [one, two] = built
        .each_ref()
        .map(|to| fs::read(to.join("library.toml")).unwrap());
    assert_eq!(one, two);
    fs::copy(
        built[0].join("library.toml"),
        scratch.0.join("three.library.toml"),
    )
    .unwrap();
    let again = Library::named(&recipes, None).unwrap();
    assert_eq!(
        again.index().unwrap().textiles.len(),
        3,
        "found beside the recipes"
    );
}

#[test]
fn a_wrong_recipe_is_named_with_its_place() {
    let scratch = ScratchFolder::made("wrong");
    let path = scratch.0.join("r.toml");
    let base = "[[textile]]\nid = \"a\"\nname = \"A\"\nconstruction = \"knitted\"\n\
        fibre = \"wool\"\n[textile.source]\nkind = \"knit\"\nseed = 1\nstructure = \"jersey\"\n\
        wales_per_cm = 12\ncourses_per_cm = 14\nloop_depth_um = 80\n\
        yarn = { width_um = 260, thickness_um = 150, colour = \"#888888\" }\n";
    let other = "[[textile]]\nid = \"b\"\nlike = \"a\"\n";
    for (more, expected) in [
        (
            "source.wales_per_cm = 99",
            "r.toml:15: textile \"b\": wales_per_cm is 99",
        ),
        (
            "source.structure = \"lace\"",
            "r.toml:15: textile \"b\": unknown variant",
        ),
        (
            "source.sise = 1",
            "r.toml:15: textile \"b\": unknown field `sise`",
        ),
        (
            "sides = [\"left\"]",
            "r.toml:17: sides is [\"left\"]; give sides = ",
        ),
        ("sides = []", "r.toml:17: sides is []; give"),
        (
            "[[textile]]\nid = \"c\"\nlike = \"d\"",
            "r.toml:19: textile \"c\" is like \"d\"",
        ),
        (
            "[[textile]]\nid = \"a\"\nlike = \"b\"",
            "r.toml:18: textile \"a\" twice",
        ),
        (
            "[[textile]]\nid = \"../a\"\nlike = \"b\"",
            "r.toml:18: a textile without an id",
        ),
    ] {
        fs::write(&path, format!("{base}{other}{more}\n")).unwrap();
        let error = Library::named(&path, None).unwrap_err().to_string();
        assert!(error.contains(expected) && !error.contains('\n'), "{error}");
    }
    let missing = Library::named(&scratch.0.join("no.toml"), None).unwrap_err();
    assert!(missing.to_string().starts_with("cannot read"), "{missing}");
    let unknown = seventy_four().load("felt-hat").unwrap_err().to_string();
    assert!(
        unknown.contains("no textile \"felt-hat\" in seventy-four"),
        "{unknown}"
    );
}

#[test]
fn the_index_of_the_seventy_four_is_what_they_give() {
    if std::env::var_os("SELVEDGE_ALL_TEXTILES").is_none() {
        println!("skipped: SELVEDGE_ALL_TEXTILES is not set");
        return;
    }
    let library = seventy_four();
    let index = library.index().unwrap();
    let started = std::time::Instant::now();
    assert_eq!(
        index_of(&library, index.tuning, n_threads()).unwrap(),
        *index
    );
    println!(
        "74 built and measured in {:.1} s",
        started.elapsed().as_secs_f64()
    );
    let strong = library.ids().iter().filter(|id| {
        let [low, high] = levels(&library, id).anisotropy_db;
        low.max(high) > 10.0
    });
    let strong: Vec<&String> = strong.collect();
    assert!(strong.len() >= 4, "{strong:?}");
}
