//! Files that hold what no surface and no picture can be.

use std::fs;
use std::path::Path;

use super::case::{Case, Verdict, failed, refused, verdict};
use selvedge_foundation::files::{Rgb8Image, decode_png, encode_png};
use selvedge_textile::Library;
use selvedge_textile::surface::{Direction, LocalSpectra, Profile};

/// Textiles and pictures.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |tried: String, should, run: Box<dyn FnOnce() -> Verdict + Send>| {
        cases.push(Case::new("files", tried, should, run));
    };
    for spelt in ["NaN", "inf", "-inf"] {
        let text = format!("{}2.0,{spelt}\n", profile(2000, 1e-3));
        add(
            format!("a height of {spelt} in a file"),
            "refused at load, with row and count",
            Box::new(move || refused(load(&text), &["warp.csv:2002", "2001"])),
        );
    }
    for n_samples in [0_u16, 1, 999] {
        let words: &[&str] = match n_samples {
            999 => &["999", "1000"],
            _ => &["warp.csv"],
        };
        add(
            format!("a profile of {n_samples} samples"),
            "refused at load, with the count",
            Box::new(move || refused(load(&profile(n_samples, 1.0 / 230.0)), words)),
        );
    }
    let tried = "a profile of 1000 samples".to_owned();
    add(tried, "one point", Box::new(one_window));
    for step_mm in [0.000_49, 0.51] {
        let words = &["the step is", "0.0005 to 0.5 mm"];
        let run = move || refused(load(&profile(2000, step_mm)), words);
        let tried = format!("a step of {step_mm} mm");
        add(tried, "refused at load", Box::new(run));
    }
    for step_mm in [f64::NAN, f64::INFINITY, 0.0, -0.01] {
        let run = move || refused(Profile::new(step_mm, vec![1.0; 2000]), &["the step is"]);
        add(
            format!("heights {step_mm} mm apart"),
            "refused",
            Box::new(run),
        );
    }
    cases.extend(pictures());
    cases
}

/// What is said of a picture that is none.
const INTACT: &[&str] = &["intact PNG"];

fn pictures() -> [Case; 4] {
    let case =
        |tried: &str, should, run: fn() -> Verdict| Case::new("pictures", tried, should, run);
    [
        case(
            "a picture of 100,000 × 100,000",
            "refused before it is decoded",
            huge_picture,
        ),
        case("a picture that is cut off", "refused", || {
            let bytes = small_png()?;
            refused(decoded(&bytes[..bytes.len() / 2]), INTACT)
        }),
        case("a picture that is none", "refused", || {
            refused(decoded(b"x_mm,height_um\n0,1\n"), INTACT)
        }),
        case("an empty file for a picture", "refused", || {
            refused(decoded(&[]), INTACT)
        }),
    ]
}

/// A profile file of this many samples.
fn profile(n_samples: u16, step_mm: f64) -> String {
    let row = |i: u16| format!("{},{}\n", f64::from(i) * step_mm, i % 7);
    let rows: String = (0..n_samples).map(row).collect();
    format!("x_mm,height_um\n{rows}")
}

/// Loads a textile with this profile from a library on disk; tells how many points it has.
fn load(profile: &str) -> Result<usize, String> {
    let folder = tempfile::tempdir().map_err(failed)?;
    let place = folder.path().join("cloth");
    fs::create_dir_all(&place).map_err(failed)?;
    fs::write(place.join("textile.toml"), MANIFEST).map_err(failed)?;
    fs::write(place.join("warp.csv"), profile).map_err(failed)?;
    let library = Library::open(folder.path()).map_err(failed)?;
    let textile = library.load("cloth").map_err(|error| {
        let text = error.to_string();
        text.replace(&format!("{}/", place.display()), "")
    })?;
    Ok(textile.surface().spectra(Direction::WarpForward).n_points())
}

const MANIFEST: &str = "name = \"Cloth\"\nconstruction = \"other\"\nfibre = \"none\"\n\
    licence = \"CC0-1.0\"\n[source]\nkind = \"profiles\"\nwarp_forward = \"warp.csv\"\n";

fn one_window() -> Verdict {
    let n_loaded = load(&profile(1000, 1.0 / 230.0))?;
    let alone = Profile::new(1.0 / 230.0, vec![1.0; 1000]).map_err(failed)?;
    let n_alone = LocalSpectra::of(&alone, false).map_err(failed)?.n_points();
    verdict((n_loaded, n_alone) == (1, 1), format!("{n_loaded} point"))
}

/// A picture of one pixel.
fn small_png() -> Result<Vec<u8>, String> {
    let picture = Rgb8Image {
        width: 1,
        height: 1,
        pixels: vec![[1, 2, 3]],
    };
    encode_png(&picture, Path::new("a.png")).map_err(failed)
}

fn decoded(bytes: &[u8]) -> Result<usize, String> {
    let picture = decode_png(bytes, Path::new("a.png"));
    picture
        .map(|picture| picture.pixels.len())
        .map_err(|error| error.to_string())
}

/// The header of one pixel says 10¹⁰: its size stands at byte 16, its checksum at byte 29.
fn huge_picture() -> Verdict {
    let mut bytes = small_png()?;
    for at in [16, 20] {
        bytes[at..at + 4].copy_from_slice(&100_000_u32.to_be_bytes());
    }
    let checksum = crc32(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
    refused(decoded(&bytes), &["64 million"])
}

/// The checksum of a PNG chunk, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let bit = |crc: u32, _| {
        if crc & 1 == 1 {
            0xedb8_8320 ^ (crc >> 1)
        } else {
            crc >> 1
        }
    };
    let byte = |crc: u32, byte: &u8| (0..8).fold(crc ^ u32::from(*byte), bit);
    !bytes.iter().fold(u32::MAX, byte)
}
