//! A shape to the fingertip: files, manifests, and what is refused.

use std::path::Path;

use super::*;
use crate::import::to_textile;
use crate::recipe::{HeightsFile as _, ProfileFiles, SourceKeys as _};
use crate::sources::picture::{PictureSource, Synthesis};
use crate::surface::{Direction, Representation, smd_um};
use crate::{
    BuiltFile, HeightScale, Library, Manifest, PictureTextile, Source, TextileError, write,
};
use selvedge_foundation::files::FileError;
use selvedge_scratch::ScratchFolder;

const NAME: &str = "cotton-plain";

fn found() -> Shape {
    let e = Truth::plain_weave(48, 0.1, 0.1).picture(45.0, 30.0);
    shape(&e, light(45.0, 30.0), Method::Variational).unwrap()
}

fn about(scale: HeightScale) -> PictureTextile {
    PictureTextile {
        name: "Cotton, plain".to_owned(),
        px_per_mm: 24.0,
        scale,
        picture: Some(["scan.png".to_owned(), "ab".repeat(32)]),
        lattice_px: Some([[24.0, 0.0], [0.0, 24.0]]),
        ..PictureTextile::default()
    }
}

fn made(scale: HeightScale) -> Result<Vec<BuiltFile>, TextileError> {
    to_textile(&found(), &about(scale), None).map(|made| made.files)
}

fn manifest_of(files: &[BuiltFile]) -> Manifest {
    let file = files.last().unwrap();
    assert_eq!(file.name, "textile.toml");
    let text = String::from_utf8(file.bytes.clone()).unwrap();
    Manifest::from_toml(&text, Path::new("textile.toml")).unwrap()
}

fn source(manifest: &Manifest) -> PictureSource {
    match &manifest.source {
        Source::Picture(keys) => (**keys).clone(),
        other => unreachable!("{other:?}"),
    }
}

/// A library of one textile in a folder of its own.
fn library(test: &str, files: &[BuiltFile]) -> (ScratchFolder, Library) {
    let folder = ScratchFolder::new(test);
    write(files, &folder.join(NAME)).unwrap();
    let library = Library::open(&folder).unwrap();
    (folder, library)
}

/// The files with the manifest changed.
fn with_source(files: &[BuiltFile], change: impl FnOnce(&mut PictureSource)) -> Vec<BuiltFile> {
    let mut files = files.to_vec();
    let mut manifest = manifest_of(&files);
    let mut keys = source(&manifest);
    change(&mut keys);
    manifest.source = Source::Picture(Box::new(keys));
    let text = manifest.to_toml(Path::new("textile.toml")).unwrap();
    files.last_mut().unwrap().bytes = text.into_bytes();
    files
}

#[test]
fn a_textile_of_a_picture_says_how_it_was_found_and_is_felt() {
    let files = made(HeightScale::ReliefUm(250.0)).unwrap();
    let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
    let wanted = [
        "heights.png",
        "warp_forward.csv",
        "warp_reverse.csv",
        "weft_forward.csv",
        "weft_reverse.csv",
        "appearance.png",
        "textile.toml",
    ];
    assert_eq!(names, wanted);
    assert_eq!(
        files,
        made(HeightScale::ReliefUm(250.0)).unwrap(),
        "the same bytes"
    );
    let manifest = manifest_of(&files);
    let keys = source(&manifest);
    assert_eq!((keys.relief_um, keys.smd_um), (250.0, None));
    assert_eq!(keys.method, Method::Variational);
    assert!((2..=16).contains(&keys.iterations), "{}", keys.iterations);
    assert_eq!((keys.light(), keys.px_per_mm), (light(45.0, 30.0), 24.0));
    assert_eq!(keys.picture.as_deref(), Some("scan.png"));
    assert_eq!(keys.lattice_px, Some([[24.0, 0.0], [0.0, 24.0]]));
    let hash = Some(manifest.source.recipe_hash(Path::new("a")).unwrap());
    assert_eq!(keys.recipe_hash, hash);
    let text = String::from_utf8(files.last().unwrap().bytes.clone()).unwrap();
    assert!(
        text.contains("kind = \"picture\"") && !text.contains("= nan"),
        "{text}"
    );
    let (_folder, library) = library("felt", &files);
    let textile = library.load(NAME).unwrap();
    for direction in Direction::ALL {
        let profile = textile.surface().profile(direction).unwrap();
        assert!(profile.smd_um() > 1.0, "{direction:?}");
        assert!(profile.heights_um().len() as f64 * profile.step_mm() >= 19.99);
    }
    assert!(textile.fall_backs().is_empty());
    assert!(textile.appearance().unwrap().is_some());
}

#[test]
fn the_map_alone_gives_the_same_strokes_and_an_areal_surface() {
    let files = made(HeightScale::ReliefUm(250.0)).unwrap();
    let alone = with_source(&files, |keys| {
        keys.set_files(ProfileFiles::default(), None);
    });
    let (_whole_folder, whole) = library("whole", &files);
    let (_map_folder, map) = library("alone", &alone);
    let [a, b] = [&whole, &map].map(|library| library.load(NAME).unwrap());
    for direction in Direction::ALL {
        let [a, b] = [&a, &b].map(|textile| textile.surface().profile(direction).unwrap());
        let pairs = a.heights_um().iter().zip(b.heights_um());
        assert!(
            pairs.into_iter().all(|(a, b)| (a - b).abs() < 2e-3),
            "to a nanometre"
        );
    }
    let areal = with_source(&files, |keys| keys.representation = Representation::Areal);
    let (_areal_folder, areal) = library("areal", &areal);
    let surface = areal.load(NAME).unwrap();
    assert_eq!(surface.surface().representation(), Representation::Areal);
}

#[test]
fn samples_that_are_not_quite_pixels_keep_the_size_of_the_cloth() {
    let about = PictureTextile {
        size_px: Some([48.6, 47.1]),
        ..about(HeightScale::ReliefUm(100.0))
    };
    let files = to_textile(&found(), &about, None).unwrap().files;
    let keys = source(&manifest_of(&files));
    let map = keys
        .map()
        .height_map(&files[0].bytes, Path::new("heights.png"))
        .unwrap();
    let [width_mm, height_mm] = map.size_mm();
    assert!((width_mm - 48.6 / 24.0).abs() < 1e-9 && (height_mm - 47.1 / 24.0).abs() < 1e-9);
    for size_px in [[f64::NAN, 1.0], [0.0, 40.0], [-3.0, 5.0], [1e9, 40.0]] {
        let about = PictureTextile {
            size_px: Some(size_px),
            ..about.clone()
        };
        assert!(to_textile(&found(), &about, None).is_err(), "{size_px:?}");
    }
}

#[test]
fn another_map_than_the_one_hashed_is_refused() {
    let files = made(HeightScale::ReliefUm(250.0)).unwrap();
    let other = to_textile(&found(), &about(HeightScale::ReliefUm(80.0)), None);
    let other = other.unwrap().files;
    let mut mixed = with_source(&files, |keys| {
        keys.set_files(ProfileFiles::default(), None);
    });
    mixed[0] = other[0].clone();
    let (_folder, library) = library("mixed", &mixed);
    let error = library.load(NAME).unwrap_err().to_string();
    assert!(error.contains("sha256"), "{error}");
}

#[test]
fn the_tester_reads_the_smd_asked_for_on_what_is_felt_synthesized_or_not() {
    let synthesis = Synthesis {
        size_mm: [20.0; 2],
        cell_mm: None,
        seed: 3,
    };
    for asked_um in [2.0, 6.0, 15.0] {
        for synthesis in [None, Some(synthesis)] {
            let about = about(HeightScale::SmdUm(asked_um));
            let made = to_textile(&found(), &about, synthesis).unwrap();
            let read_um = smd_um(&made.profiles);
            assert!(
                (read_um / asked_um - 1.0).abs() < 5e-3,
                "{read_um} where {asked_um} was asked, {synthesis:?}"
            );
            let manifest = manifest_of(&made.files);
            assert_eq!(source(&manifest).smd_um, Some(asked_um));
            assert!(source(&manifest).relief_um > 2.0 * asked_um);
        }
    }
    let error = made(HeightScale::SmdUm(0.01)).unwrap_err().to_string();
    assert!(error.contains("own noise"), "{error}");
}

#[test]
fn without_a_scale_no_textile_is_made_and_impossible_ones_are_refused() {
    let error = made(HeightScale::Unscaled).unwrap_err().to_string();
    assert!(
        error.contains("unscaled") && error.contains("say the scale"),
        "{error}"
    );
    for scale in [
        HeightScale::ReliefUm(0.0),
        HeightScale::ReliefUm(f64::NAN),
        HeightScale::ReliefUm(1e9),
        HeightScale::SmdUm(-1.0),
        HeightScale::SmdUm(f64::INFINITY),
    ] {
        let error = made(scale).unwrap_err();
        assert!(
            matches!(error, TextileError::Shading(ShadingError::Option { .. })),
            "{error}"
        );
    }
    for px_per_mm in [0.0, 1.9, 1e4, f64::NAN] {
        let about = PictureTextile {
            px_per_mm,
            ..about(HeightScale::ReliefUm(100.0))
        };
        let error = to_textile(&found(), &about, None).unwrap_err().to_string();
        assert!(error.contains("px/mm"), "{error}");
    }
    let flat = shape(&Grid::filled(8, 8, 0.5), light(45.0, 0.0), Method::Linear).unwrap();
    let error = to_textile(&flat, &about(HeightScale::ReliefUm(100.0)), None).unwrap_err();
    assert!(error.to_string().contains("flat"), "{error}");
    let row = shape(&Grid::filled(8, 1, 0.5), light(45.0, 0.0), Method::Linear).unwrap();
    let error = to_textile(&row, &about(HeightScale::ReliefUm(100.0)), None).unwrap_err();
    assert!(error.to_string().contains("2 × 2"), "{error}");
    let nameless = PictureTextile {
        name: " ".to_owned(),
        ..about(HeightScale::ReliefUm(100.0))
    };
    assert!(to_textile(&found(), &nameless, None).is_err());
}

#[test]
fn wrong_keys_are_told_with_their_line() {
    let files = made(HeightScale::ReliefUm(250.0)).unwrap();
    let text = String::from_utf8(files.last().unwrap().bytes.clone()).unwrap();
    let line_of = |key: &str| {
        let line = text.lines().position(|line| line.starts_with(key));
        line.unwrap() + 1
    };
    for (key, wrong) in [
        ("px_per_mm", "px_per_mm = 0.5"),
        ("slant_deg", "slant_deg = 90.0"),
        ("relief_um", "relief_um = -1.0"),
        ("lattice_px", "lattice_px = [[1.0, 1.0], [2.0, 2.0]]"),
        ("method", "method = \"magic\""),
        ("file", "file = \"../heights.png\""),
    ] {
        let line = text.lines().nth(line_of(key) - 1).unwrap();
        let changed = text.replacen(line, wrong, 1);
        let error = Manifest::from_toml(&changed, Path::new("t.toml")).unwrap_err();
        let at = format!("t.toml:{}: ", line_of(key));
        assert!(error.to_string().starts_with(&at), "{error} not at {at}");
        assert!(matches!(
            error,
            TextileError::File(FileError::Content { .. })
        ));
    }
}
