//! `selvedge picture`, run as a user runs it; on real pictures where they are at hand.

use std::path::PathBuf;

use selvedge_foundation::files::{GrayImage, Rgb8Image};
use selvedge_foundation::progress::Progress;
use selvedge_textile::picture::{
    Analysis, AnalysisOptions, Basis, DirectionOptions, EvenLight, NoLattice, Picture, Place,
};

use crate::program::Lab;

/// A cloth that repeats by (12, 3) and (−2, 9) px, as a PNG of 16 bits.
pub(crate) fn cloth() -> Vec<u8> {
    let basis = Basis::new([12.0, 3.0], [-2.0, 9.0]);
    let turn = std::f64::consts::TAU;
    let values = (0..160 * 140_u16).map(|i| {
        let [u, v] = basis.coordinates([f64::from(i % 160), f64::from(i / 160)]);
        0.5 + 0.15 * (turn * u).cos() + 0.15 * (turn * v).sin() + 0.1 * (turn * (u + v)).cos()
    });
    let picture = GrayImage::of_shares([160, 140], values);
    picture.to_png("cloth.png".as_ref()).unwrap()
}

fn vector(value: &serde_json::Value) -> Place {
    let number = |i: usize| value[i].as_f64().unwrap();
    [number(0), number(1)]
}

#[test]
fn a_picture_becomes_its_lattice_its_tile_and_what_led_there() {
    let lab = Lab::new();
    lab.write("cloth.png", cloth());
    let line = lab.print(&["picture", "cloth.png", "--out", "made", "--px-per-mm", "20"]);
    assert!(
        line.starts_with("made: repeats by ") && line.contains(" mm, confidence "),
        "{line}"
    );
    let json: serde_json::Value = serde_json::from_str(&lab.read("made/periodicity.json")).unwrap();
    assert_eq!(json["image"]["width"], 160);
    assert_eq!(json["image"]["height"], 140);
    let lattice = &json["lattice"];
    let found = Basis::new(vector(&lattice["p1_px"]), vector(&lattice["p2_px"]));
    let truth = Basis::new([12.0, 3.0], [-2.0, 9.0]);
    assert!(found.distance_to(&truth) < 0.02, "{found:?}");
    assert!(lattice["confidence"].as_f64().unwrap() > 0.9, "{lattice}");
    assert!(lattice["method"].is_string(), "{lattice}");
    let mm = vector(&json["p1_mm"]);
    assert!((mm[0] * 20.0 - found.p1[0]).abs() < 1e-9, "{mm:?}");
    assert!(
        json["explained_variance"].as_f64().unwrap() > 0.98,
        "{json}"
    );
    assert!(json["reason"].is_null(), "{json}");
    for name in [
        "autocorrelation.png",
        "tile.png",
        "synthesized.png",
        "residual.png",
        "overlay.png",
    ] {
        let bytes = std::fs::read(lab.path(&format!("made/{name}"))).unwrap();
        assert_eq!(&bytes[1..4], b"PNG", "{name}");
    }
    let header = "rank,dx_px,dy_px,correlation,dominance_px\n";
    assert!(
        lab.read("made/maxima.csv").starts_with(header),
        "the maxima"
    );
}

/// The command with more options.
fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["picture", "cloth.png", "--out", "made"], more].concat()
}

#[test]
fn regions_corners_and_scales_are_taken_and_checked() {
    let lab = Lab::new();
    lab.write("cloth.png", cloth());
    lab.print(&with(&[
        "--region",
        "20,10,120,100",
        "--dpi",
        "600",
        "--even-light",
        "off",
    ]));
    let json: serde_json::Value = serde_json::from_str(&lab.read("made/periodicity.json")).unwrap();
    assert_eq!(json["image"]["width"], 120);
    assert!(
        (json["px_per_mm"].as_f64().unwrap() - 600.0 / 25.4).abs() < 1e-12,
        "{json}"
    );
    lab.print(&with(&[
        "--corners",
        "0,0,160,0,160,140,0,140",
        "--lambda",
        "1.5",
    ]));
    let outside = lab.refuse(&with(&["--region", "100,100,100,100"]));
    assert!(
        outside.contains("is not inside the picture of 160 × 140 pixels"),
        "{outside}"
    );
    for more in [
        ["--region", "1,2,3"],
        ["--px-per-mm", "0"],
        ["--dpi", "NaN"],
        ["--even-light", "bright"],
        ["--corners", "1,2,3,4"],
    ] {
        assert_eq!(lab.run(&with(&more)).code, 2, "{more:?}");
    }
}

/// A bitmap file that only says how large it is.
fn empty_bitmap(side: u32) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for number in [
        58_u32,
        0,
        54,
        40,
        side,
        side,
        0x0018_0001,
        0,
        4,
        0,
        0,
        0,
        0,
        0,
    ] {
        bytes.extend(number.to_le_bytes());
    }
    bytes
}

#[test]
fn what_is_no_picture_is_refused_in_one_line() {
    let lab = Lab::new();
    let whole = cloth();
    lab.write("cut.png", &whole[..whole.len() / 2]);
    lab.write("text.png", "not a picture");
    lab.write("large.bmp", empty_bitmap(20_000));
    for (file, what) in [
        ("cut.png", "this picture is damaged or cut short"),
        ("text.png", "no picture of a known format"),
        (
            "large.bmp",
            "20000 × 20000 pixels where 1 to 64 million are read",
        ),
        ("none.png", "cannot read none.png"),
    ] {
        let line = lab.refuse(&["picture", file, "--out", "made"]);
        assert!(line.contains(file) && line.contains(what), "{line}");
    }
}

#[test]
fn no_lattice_is_an_answer_with_its_reason() {
    let lab = Lab::new();
    let one = |side: usize| Rgb8Image {
        width: side,
        height: side,
        pixels: vec![[90, 80, 70]; side * side],
    };
    lab.write("made/tile.png", "of an earlier picture");
    for (side, what) in [(1, "too small to hold repeats"), (100, "of one colour")] {
        lab.write("a.png", one(side).to_png("a.png".as_ref()).unwrap());
        let line = lab.print(&["picture", "a.png", "--out", "made"]);
        assert!(
            line.starts_with("made: no lattice: ") && line.contains(what),
            "{line}"
        );
        let json: serde_json::Value =
            serde_json::from_str(&lab.read("made/periodicity.json")).unwrap();
        assert!(json["lattice"].is_null(), "{json}");
        assert!(json["reason"].as_str().unwrap().contains(what), "{json}");
        assert!(!lab.path("made/tile.png").exists(), "what is old is gone");
    }
}

/// A weave of soft bumps, 24 px a repeat, lit from 45° and the upper right, as a PNG.
fn lit_weave() -> Vec<u8> {
    let n = 24.0 / std::f64::consts::TAU;
    let values = (0..168 * 168_u16).map(|i| {
        let (x, y) = (f64::from(i % 168) / n, -f64::from(i / 168) / n);
        // z = 1.5 sin x sin y + 0.5 sin x, y up; the light leans by (cos 30°, sin 30°).
        let p = (1.5 * x.cos() * y.sin() + 0.5 * x.cos()) / n;
        let q = 1.5 * x.sin() * y.cos() / n;
        let facing = 1.0 - p * 30_f64.to_radians().cos() - q * 30_f64.to_radians().sin();
        0.8 * facing.max(0.0) / ((1.0 + p * p + q * q).sqrt() * 2_f64.sqrt())
    });
    let picture = GrayImage::of_shares([168, 168], values);
    picture.to_png("weave.png".as_ref()).unwrap()
}

const FELT: [&str; 18] = [
    "picture",
    "weave.png",
    "--out",
    "made",
    "--px-per-mm",
    "16",
    "--light",
    "45,30",
    "--relief-um",
    "180",
    "--textile",
    "textiles/lit-weave",
    "--name",
    "Lit weave",
    "--shading",
    "variational",
    "--relief-of",
    "cell",
];

#[test]
fn a_lit_weave_becomes_a_textile_that_is_shown_and_rendered() {
    let lab = Lab::with_scene();
    lab.write("weave.png", lit_weave());
    let described = lab.print(&FELT);
    for part in [
        "slant 45.0°, tilt 30.0°",
        "180.0 µm",
        "textiles/lit-weave: the textile",
    ] {
        assert!(described.contains(part), "{described}");
    }
    let json: serde_json::Value = serde_json::from_str(&lab.read("made/periodicity.json")).unwrap();
    let shading = &json["shading"];
    assert_eq!(shading["method"], "variational");
    assert_eq!(shading["light_estimated"], false);
    assert_eq!(shading["height_um"]["relief"], 180.0);
    let number = |key: &str| shading[key].as_f64().unwrap();
    assert!(
        number("residual") < 0.2 * number("residual_of_level"),
        "{shading}"
    );
    // The truth's rms is 0.79 px of a relief of 4 px.
    let span = &shading["height_px"];
    let share = span["rms"].as_f64().unwrap() / span["relief"].as_f64().unwrap();
    assert!((share - 0.21).abs() < 0.02, "{span}");
    let manifest = lab.read("textiles/lit-weave/textile.toml");
    for part in [
        "picture = \"weave.png\"",
        "picture_sha256",
        "lattice_px",
        "slant_deg = 45",
    ] {
        assert!(manifest.contains(part), "{part}: {manifest}");
    }
    let map = lab.print(&["textile", "show", "lit-weave", "--library", "textiles"]);
    assert!(map.contains("Lit weave"), "{map}");
    let scene = lab
        .read("a.scene.toml")
        .replace("\"fine\"", "\"lit-weave\"");
    lab.write("a.scene.toml", scene);
    lab.print(&[
        "render",
        "a.scene.toml",
        "--path",
        "a.csv",
        "--out",
        "a.bin",
    ]);
    assert!(!std::fs::read(lab.path("a.bin")).unwrap().is_empty());
}

#[test]
fn a_textile_of_a_picture_keeps_a_band_and_claims_no_measurement() {
    let lab = Lab::new();
    lab.write("weave.png", lit_weave());
    let described = lab.print(&FELT[..14]);
    let manifest = lab.read("textiles/lit-weave/textile.toml");
    for part in ["[uncertainty]", "levels = ["] {
        assert!(manifest.contains(part), "{part}: {manifest}");
    }
    assert!(!manifest.contains("[measured]"), "{manifest}");
    let shown = lab.print(&["textile", "show", "lit-weave", "--library", "textiles"]);
    assert!(shown.contains("dB along the warp"), "{shown}");
    let levels = lab.print(&["textile", "levels", "--library", "textiles"]);
    let levels = crate::program::Rows::parse(&levels);
    let [low, high] = ["low40_db", "high40_db"].map(|column| levels.numbers(column)[0]);
    assert!(low < high && high - low < 40.0, "{low} to {high}");
    // The weave is drawn by light alone.
    assert!(described.contains("heights by variational"), "{described}");
    let open = [&FELT[..6], &FELT[8..14]].concat();
    let open = lab.print(&open);
    let unknown = lab.read("textiles/lit-weave/textile.toml");
    assert!(
        unknown.contains("light_is_estimated = true") && unknown != manifest,
        "{open}"
    );
}

#[test]
fn all_bytes_are_the_same_whatever_the_threads_and_old_heights_go() {
    let lab = Lab::new();
    lab.write("weave.png", lit_weave());
    let all = || -> Vec<(PathBuf, Vec<u8>)> {
        let mut files: Vec<PathBuf> = ["made", "textiles/lit-weave"]
            .iter()
            .flat_map(|folder| std::fs::read_dir(lab.path(folder)).unwrap())
            .map(|entry| entry.unwrap().path())
            .collect();
        files.sort();
        let read = |path: PathBuf| (path.clone(), std::fs::read(path).unwrap());
        files.into_iter().map(read).collect()
    };
    lab.print(&[&FELT[..], &["--threads", "1"]].concat());
    let first = all();
    assert!(first.len() >= 14, "{}", first.len());
    lab.print(&[&FELT[..], &["--threads", "2"]].concat());
    let again = all();
    let names = |files: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        files.iter().map(|(path, _)| path.clone()).collect()
    };
    assert_eq!(names(&first), names(&again));
    for ((path, a), (_, b)) in first.iter().zip(&again) {
        assert!(a == b, "{}", path.display());
    }
    let one = Rgb8Image {
        width: 50,
        height: 50,
        pixels: vec![[90, 80, 70]; 2500],
    };
    lab.write("a.png", one.to_png("a.png".as_ref()).unwrap());
    lab.print(&["picture", "a.png", "--out", "made"]);
    assert!(!lab.path("made/height.png").exists(), "what is old is gone");
}

#[test]
fn a_picture_alone_gives_heights_without_a_scale_and_says_so() {
    let lab = Lab::new();
    lab.write("weave.png", lit_weave());
    let described = lab.print(&["picture", "weave.png", "--out", "made"]);
    assert!(
        described.contains("estimated: ") && described.contains("px, unscaled"),
        "{described}"
    );
    let json: serde_json::Value = serde_json::from_str(&lab.read("made/periodicity.json")).unwrap();
    assert_eq!(json["shading"]["light_estimated"], true);
    assert!(json["shading"]["height_um"].is_null(), "{json}");
    let bytes = std::fs::read(lab.path("made/height.png")).unwrap();
    let height = GrayImage::from_png(&bytes, "height.png".as_ref(), 1 << 20).unwrap();
    assert_eq!(height.text("Gwy::ZUnit"), Some("px"));
    assert_eq!(height.text("Gwy::XYUnit"), Some("px"));
    let scaled = ["--dpi", "600", "--relief-um", "100"];
    lab.print(&[&["picture", "weave.png", "--out", "made"], &scaled[..]].concat());
    let bytes = std::fs::read(lab.path("made/height.png")).unwrap();
    let height = GrayImage::from_png(&bytes, "height.png".as_ref(), 1 << 20).unwrap();
    let number = |key: &str| height.text(key).unwrap().parse::<f64>().unwrap();
    assert!((number("Gwy::ZMax") - number("Gwy::ZMin") - 1e-4).abs() < 1e-12);
    assert_eq!(height.text("Gwy::ZUnit"), Some("m"));
}

#[test]
fn what_cannot_go_together_is_refused_in_one_line() {
    let lab = Lab::new();
    lab.write("weave.png", lit_weave());
    for (more, what) in [
        (&["--textile", "a"][..], "--px-per-mm, --dpi or"),
        (
            &["--textile", "a", "--dpi", "600"],
            "--relief-um or --smd-um",
        ),
        (&["--smd-um", "5"], "--smd-um needs the picture's scale"),
        (
            &["--shading", "linear", "--iterations", "3"],
            "leave --iterations out",
        ),
        (&["--iterations", "0"], "1 to 10000"),
        (&["--light", "1,0"], "light from the front"),
        (
            &["--light", "45,135", "--shading", "tsai-shah"],
            "turn the picture",
        ),
    ] {
        let line = lab.refuse(&[&["picture", "weave.png", "--out", "made"], more].concat());
        assert!(line.contains(what), "{more:?}: {line}");
        assert!(
            !lab.path("made").exists() && !lab.path("a").exists(),
            "{more:?}"
        );
    }
    for more in [
        &["--light", "95,0"][..],
        &["--light", "45"],
        &["--relief-um", "5", "--smd-um", "5"],
        &["--name", "A"],
        &["--shading", "guess"],
    ] {
        let args = [&["picture", "weave.png", "--out", "made"], more].concat();
        assert_eq!(lab.run(&args).code, 2, "{more:?}");
    }
}

/// Real pictures, by name, and vectors that span their lattice; none where it must be refused.
const REAL: [(&str, Option<[Place; 2]>); 12] = [
    ("licensed/hsst_2024_12_10_13_13_40_804_256_128.jpg", None),
    ("licensed/hsst_2024_9_11_14_28_3_725_1792_0.jpg", None),
    ("licensed/hsst_2024_9_11_14_6_16_612_3072_488.jpg", None),
    (
        "licensed/gimp_greyweave.png",
        Some([[60.0, 60.0], [-60.0, 60.0]]),
    ),
    (
        "licensed/materialx_cloth.png",
        Some([[80.1, 80.1], [-80.1, 80.1]]),
    ),
    (
        "licensed/krita_02b_WoofTissue.png",
        Some([[16.0, 0.0], [0.0, 16.0]]),
    ),
    (
        "licensed/inkscape_cloth.png",
        Some([[4.1, -4.5], [4.3, 4.3]]),
    ),
    (
        "no-licence-stated/fk006_height.png",
        Some([[0.0, 16.0], [16.0, 8.0]]),
    ),
    (
        "no-licence-stated/glsr_A2R1.jpg",
        Some([[7.9, 1.9], [1.1, 8.0]]),
    ),
    (
        "no-licence-stated/glsr_model3.jpg",
        Some([[0.3, -22.1], [23.2, -0.3]]),
    ),
    (
        "no-licence-stated/yav_Sa10.png",
        Some([[9.0, -7.9], [9.2, 9.2]]),
    ),
    (
        "no-licence-stated/yav_Sa22.png",
        Some([[9.3, 8.0], [-8.5, 9.2]]),
    ),
];

/// The analysis of a picture of a real cloth; why there is none, where that is not at hand.
pub(crate) fn real_analysis(name: &str) -> Result<Analysis, String> {
    let data = std::env::var_os("SELVEDGE_TEST_DATA").map(PathBuf::from);
    let data = data.ok_or("SELVEDGE_TEST_DATA does not name a folder with real pictures")?;
    let path = data.join("fabric-images").join(name);
    let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let options = AnalysisOptions {
        light: EvenLight::Auto,
        directions: DirectionOptions::default(),
        n_threads: 2,
    };
    let picture = Picture::load(&bytes, &path).unwrap();
    Ok(Progress::unheard(|p| Analysis::of(picture, &options, p)).unwrap())
}

#[test]
fn real_pictures_have_the_lattices_that_eyes_see_in_them() {
    for (name, expected) in REAL {
        let analysis = match real_analysis(name) {
            Ok(analysis) => analysis,
            Err(why) => {
                println!("skipped: {why}");
                continue;
            }
        };
        match (analysis.found, expected) {
            (
                Err(
                    NoLattice::NotResolved { .. }
                    | NoLattice::Weak { .. }
                    | NoLattice::NotPredicted { .. }
                    | NoLattice::OneDirection,
                ),
                None,
            ) => {}
            (Ok(found), Some([p1, p2])) => {
                let off = found.lattice.basis().distance_to(&Basis::new(p1, p2));
                assert!(off < 0.4, "{name}: {:?}, off {off}", found.lattice);
            }
            (found, expected) => panic!("{name}: {:?} for {expected:?}", found.map(|f| f.lattice)),
        }
    }
}
