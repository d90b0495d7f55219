//! What comes out of every format, and what is refused; files of instruments where they are.

use std::path::{Path, PathBuf};

use super::*;
use crate::metrology::samples::{all, map, sur};
use crate::metrology::text::tests::{TWO_COLUMNS, read_text};
use selvedge_foundation::files::Number;

/// Heights alike to `um`, missing in the same places.
fn assert_alike(read: &Measured, given: &Measured, um: f64, what: &str) {
    let (a, b) = (&read.heights_um, &given.heights_um);
    assert_eq!((a.width(), a.height()), (b.width(), b.height()), "{what}");
    for (i, (a, b)) in a.values().iter().zip(b.values()).enumerate() {
        let is_alike = (a - b).abs() <= um || (a.is_nan() && b.is_nan());
        assert!(is_alike, "{what}, point {i}: {a} against {b} µm");
    }
    for (a, b) in read.step_mm.iter().zip(given.step_mm) {
        assert!((a / b - 1.0).abs() < 1e-6, "{what}: {a} against {b} mm");
    }
}

#[test]
fn every_format_gives_the_same_map() {
    for (name, bytes, asked) in all() {
        let read = Measured::open(&bytes, Path::new(name), &asked).unwrap();
        let um = match name {
            "x3p f64" | "x3p list" | "gwy" | "npy" | "x3p places" => 2e-6,
            "two columns" | "valid" | "matrix" => continue,
            _ => 1e-3,
        };
        let n_missing = if ["png", "tiff"].contains(&name) {
            0
        } else {
            2
        };
        let mut given = map(n_missing);
        if name == "frt" {
            // Counts have no sign.
            given
                .heights_um
                .values_mut()
                .iter_mut()
                .for_each(|z| *z += 10.0);
        }
        if asked.step_mm.is_some() {
            given.step_mm = [0.05; 2];
        }
        assert_alike(&read, &given, um, name);
        assert!((read.sq_um() / given.sq_um() - 1.0).abs() < 1e-3, "{name}");
    }
}

#[test]
fn texts_give_profiles_and_maps_with_the_units_of_their_headings() {
    let of = |wanted: &str| {
        let (_, bytes, _) = all()
            .into_iter()
            .find(|(name, ..)| *name == wanted)
            .unwrap();
        Measured::open(&bytes, Path::new(wanted), &HeightOptions::default()).unwrap()
    };
    let stylus = of("two columns");
    assert!(stylus.is_profile() && stylus.heights_um.width() == 60);
    assert!(
        (stylus.step_mm[0] - 0.001_666_67).abs() < 1e-5,
        "{:?}",
        stylus.step_mm
    );
    assert!((stylus.heights_um.row(0)[1] - 0.3_f64.sin()).abs() < 1e-5);
    let valid = of("valid");
    assert_eq!((valid.n_missing(), valid.step_mm[0]), (5, 0.0005));
    let matrix = of("matrix");
    let size = [matrix.heights_um.width(), matrix.heights_um.height()];
    assert_eq!(size, [6, 60]);
    assert!((matrix.step_mm[0] - 0.01 / 6.0).abs() < 1e-9);
    assert!(
        (matrix.heights_um.row(59)[3] - 3e6).abs() < 1e-3,
        "the first line is the top"
    );
}

#[test]
fn x3p_comes_back_from_every_number_type_binary_and_listed() {
    for number in [Number::I16, Number::I32, Number::F32, Number::F64] {
        for is_list in [false, true] {
            for given in [map(0), map(5)] {
                let path = Path::new("a.x3p");
                let bytes = write_x3p(&given, Coding { number, is_list }, path).unwrap();
                let again = write_x3p(&given, Coding { number, is_list }, path).unwrap();
                assert_eq!(bytes, again, "the same map, the same bytes");
                let read = Measured::open(&bytes, path, &HeightOptions::default()).unwrap();
                let um = if number == Number::I16 { 2e-4 } else { 1e-5 };
                assert_alike(&read, &given, um, &format!("{number:?} {is_list}"));
                assert_eq!(read.warnings, Vec::<String>::new());
                assert_eq!(read.about.comment, "a < b");
                assert_eq!(read.about.instrument, "tester & co");
            }
        }
    }
    assert!(
        write_x3p(
            &map(0),
            Coding {
                number: Number::U8,
                is_list: false
            },
            Path::new("a")
        )
        .is_err()
    );
}

#[test]
fn a_wrong_checksum_is_a_warning_and_a_short_member_an_error() {
    use selvedge_foundation::files::Archive;
    let path = Path::new("a.x3p");
    let bytes = write_x3p(&map(0), Coding::default(), path).unwrap();
    let mut archive = Archive::open(&bytes, path).unwrap();
    let xml = archive.member("main.xml", 1 << 20).unwrap();
    let mut data = archive.member("bindata/data.bin", 1 << 20).unwrap();
    data[7] ^= 1;
    let changed = Archive::pack(&[("main.xml", &xml), ("bindata/data.bin", &data)], path).unwrap();
    let read = Measured::open(&changed, path, &HeightOptions::default()).unwrap();
    assert_eq!(read.warnings.len(), 2, "{:?}", read.warnings);
    assert!(read.warnings[1].contains("does not fit bindata/data.bin"));
    for (data, expected) in [
        (&data[..80], "holds 80 bytes"),
        (&[0; 9999], "more than 672"),
    ] {
        let bytes = Archive::pack(&[("main.xml", &xml), ("bindata/data.bin", data)], path).unwrap();
        let error = Measured::open(&bytes, path, &HeightOptions::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    }
    let giant = String::from_utf8(xml).unwrap().replace(">12<", ">9999999<");
    let giant = giant.replace("<SizeY>7<", "<SizeY>9999999999<");
    let bytes = Archive::pack(&[("main.xml", giant.as_bytes())], path).unwrap();
    let error = Measured::open(&bytes, path, &HeightOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("points where 1 to 64000000 are read"),
        "{error}"
    );
}

#[test]
fn what_is_not_stated_or_wrong_is_asked_for_in_one_line() {
    for (text, expected) in [
        (
            TWO_COLUMNS,
            "the unit of the heights is not stated; give height_unit (--height-unit)",
        ),
        ("1\n2\n3\n", "the unit of the heights is not stated"),
        (
            "# Width: 3 mm\n1 2\n3 4\n",
            "the unit of the heights is not stated",
        ),
        (
            "a;b;c\n3;1;2\n2;4;9\n",
            "3 columns: 1 \"a\", 2 \"b\", 3 \"c\"; say which",
        ),
        ("", "this is no file of measured heights"),
        ("hello\n", "a.txt:1: no numbers"),
        ("1 2\n2 3\n3 4\nx\n", "a.txt:4: not 2 numbers"),
        (
            "1 2\n2 3\n3 4\n4\n5 6\n6 7\n7 8\n",
            "a.txt:4: not 2 numbers",
        ),
        (
            "x_mm,height_um\n0,1\n1,1\n5,1\n",
            "point 2 of 3: the step is 1 where",
        ),
        ("x_mm,height_um\n0,1\n1,1\n3,1\n", "point 2 of 3"),
        (
            "x_mm,height_um\n0,nan\n1,nan\n2,nan\n",
            "every height is missing",
        ),
    ] {
        let error = read_text(text, &HeightOptions::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{text:?}: {error}");
        assert!(
            error.starts_with("a.txt:") && !error.contains('\n'),
            "{error}"
        );
    }
}

#[test]
fn lying_and_foreign_files_are_refused_in_one_line() {
    let path = Path::new("a");
    let mut lying = sur([16, 0]);
    lying[108..116].copy_from_slice(&[0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f]);
    let mut packed = sur([32, 1]);
    packed[516..520].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut colours = sur([16, 0]);
    colours[18] = 13;
    for (bytes, expected) in [
        (lying, "points where 1 to 64000000"),
        (packed, "bytes are missing"),
        (colours, "an object of kind 13"),
        (b"PK\x03\x04nonsense".to_vec(), "the ZIP archive is damaged"),
        (
            b"GIF89a\x01\x02\x00".to_vec(),
            "this is no file of measured heights",
        ),
        (
            b"FRTM_GLIDERV1.00\x00\x00".to_vec(),
            "no block with the grid",
        ),
    ] {
        let error = Measured::open(&bytes, path, &HeightOptions::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected) && error.contains("; "), "{error}");
        assert!(!error.contains('\n'), "{error}");
    }
}

/// A file of the test data: asked for, points missing, Sq in µm, and whose Sq it is:
/// `ST` `SurfaceTopography` 1.27.1, `SFZ` `surfalize` 0.19.2, `RSC` `rosettasciio` 0.15.0, `NP` a
/// plain reading with `numpy` 2.4.6 of a file that the others refuse.
const FILES: [(&str, &str, usize, f64, &str); 20] = [
    (
        "openfmc/ISO5436-sample1.x3p",
        "",
        1,
        610_509.154_542_260_3,
        "SFZ",
    ),
    (
        "openfmc/ISO5436-sample1_bin.x3p",
        "",
        1,
        610_509.154_542_260_2,
        "ST",
    ),
    (
        "openfmc/ISO5436-sample3.x3p",
        "",
        1,
        610_509.154_542_260_3,
        "NP",
    ),
    (
        "openfmc/KautschukInfiniteFocus.x3p",
        "",
        5296,
        3.398_871_810_863_254_5,
        "ST",
    ),
    (
        "x3ptools/sample-land.x3p",
        "",
        25292,
        34.334_274_890_691_21,
        "NP",
    ),
    ("x3ptools/testing.x3p", "", 0, 12_197.857_478_763_815, "NP"),
    (
        "surfacetopography/sur-2.sur",
        "",
        117,
        0.017_517_881_243_588_18,
        "ST",
    ),
    (
        "rosettasciio/test_surface.sur",
        "um",
        0,
        31.301_564_650_477_108,
        "RSC",
    ),
    (
        "rosettasciio/test_profile.pro",
        "um",
        0,
        30.890_499_659_981_337,
        "RSC",
    ),
    (
        "surfacetopography/tmd-1.tmd",
        "",
        0,
        74.341_340_673_521_81,
        "ST",
    ),
    (
        "surfacetopography/frt-2.frt",
        "",
        12314,
        8.826_763_181_113_767,
        "ST",
    ),
    (
        "surfacetopography/matrix-3.txt",
        "",
        0,
        0.035_222_918_750_198_74,
        "ST",
    ),
    (
        "surfacetopography/hfm-1.hfm",
        "",
        0,
        0.905_688_224_386_119_3,
        "ST",
    ),
    (
        "surfacetopography/dektak-1.csv",
        "",
        0,
        4.764_232_930_211_046,
        "ST",
    ),
    (
        "surfacetopography/xy-4.txt",
        "um",
        0,
        0.008_641_846_268_974_015,
        "ST",
    ),
    (
        "navierpy/vectoraux.csv",
        "um",
        0,
        33.859_632_887_241_28,
        "NP",
    ),
    (
        "derived/rubber_alicona.gwy",
        "",
        5296,
        3.398_871_810_863_254_5,
        "ST",
    ),
    ("derived/tmd1.gwy", "", 0, 74.341_340_673_521_83, "ST"),
    (
        "derived/rubber_alicona_um.npy",
        "um",
        5296,
        3.398_871_811_181_442,
        "NP",
    ),
    ("derived/tmd1_um.npy", "um", 0, 74.341_340_689_881_25, "NP"),
];

/// The folder of measured heights, if there is one.
fn test_data() -> Option<PathBuf> {
    let folder = std::env::var_os("SELVEDGE_TEST_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: SELVEDGE_TEST_DATA names no folder");
    }
    Some(folder?.join("heights"))
}

#[test]
fn files_of_instruments_have_the_sq_that_independent_readers_find() {
    let Some(folder) = test_data() else { return };
    for (name, unit, n_missing, sq_um, whose) in FILES {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let asked = HeightOptions {
            height_unit: LengthUnit::of(unit),
            step_mm: (unit == "um" && !name.starts_with("rosettasciio")).then_some(0.01),
            column: name.ends_with("aux.csv").then(|| "iso1661029_a".to_owned()),
            ..HeightOptions::default()
        };
        let read = Measured::open(&bytes, Path::new(name), &asked).unwrap();
        let off = (read.sq_um() / sq_um - 1.0).abs();
        println!(
            "{name}: Sq {} µm, {off:.1e} from {whose}; {:?}",
            read.sq_um(),
            read.warnings
        );
        assert!(
            off <= 1e-6,
            "{name}: {} against {sq_um} µm ({whose})",
            read.sq_um()
        );
        assert_eq!(read.n_missing(), n_missing, "{name}");
    }
    for (name, expected) in [
        ("openfmc/ISO5436-sample2.x3p", "a cloud of points (PCL)"),
        ("rosettasciio/test_RGBSURFACE.sur", "an object of kind 13"),
        (
            "surfacetopography/xy-4.txt",
            "the unit of the heights is not stated",
        ),
        ("navierpy/vectoraux.csv", "9 columns: 1, 2 \"iso1661029_a\""),
    ] {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let error = Measured::open(&bytes, Path::new(name), &HeightOptions::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{name}: {error}");
    }
}

#[test]
fn a_text_in_utf_16_reads_like_any_other() {
    let text = "x µm;z µm\n0,0;1,5\n0,1;2,5\n0,2;3\n";
    let plain = read_text(text, &HeightOptions::default()).unwrap();
    assert_eq!(plain.heights_um.row(0), [1.5, 2.5, 3.0]);
    for unit in [u16::to_le_bytes, u16::to_be_bytes] {
        let units = format!("\u{feff}{text}");
        let bytes: Vec<u8> = units.encode_utf16().flat_map(unit).collect();
        let read = Measured::open(&bytes, Path::new("a.txt"), &HeightOptions::default());
        assert_eq!(read.unwrap(), plain);
    }
    assert!(
        Measured::open(
            b"\xff\xfe\x00\xd8",
            Path::new("a.txt"),
            &HeightOptions::default()
        )
        .is_err()
    );
}
