//! Files that hold what no surface and no picture can be.

use std::fs;
use std::path::Path;

use super::case::{Case, Verdict, cases, failed, refused, verdict};
use selvedge_foundation::files::Rgb8Image;
use selvedge_textile::Library;
use selvedge_textile::surface::{Direction, LocalSpectra, Profile};

/// Textiles and pictures.
pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for spelt in ["NaN", "inf", "-inf"] {
        let text = format!("{}2.0,{spelt}\n", profile(2000, 1e-3));
        cases.extend(cases! { "files";
            format!("a height of {spelt} in a file") => "refused at load, with row and count",
                move || refused(load(&text), &["warp.csv:2002", "2001"]);
        });
    }
    for (n_samples, words) in [
        (0, &["warp.csv"][..]),
        (1, &["warp.csv"]),
        (999, &["999", "1000"]),
    ] {
        cases.extend(cases! { "files";
            format!("a profile of {n_samples} samples") => "refused at load, with the count",
                move || refused(load(&profile(n_samples, 1.0 / 230.0)), words);
        });
    }
    cases.extend(cases! { "files"; "a profile of 1000 samples" => "one point", one_window; });
    let range = &["the step is", "0.0005 to 0.5 mm"];
    for step_mm in [0.000_49, 0.51] {
        cases.extend(cases! { "files";
            format!("a step of {step_mm} mm") => "refused at load",
                move || refused(load(&profile(2000, step_mm)), range);
        });
    }
    for step_mm in [f64::NAN, f64::INFINITY, 0.0, -0.01] {
        cases.extend(cases! { "files";
            format!("heights {step_mm} mm apart") => "refused",
                move || refused(Profile::new(step_mm, vec![1.0; 2000]), &["the step is"]);
        });
    }
    cases.extend(pictures());
    cases
}

/// What is said of a picture that is none.
const INTACT: &[&str] = &["intact PNG"];

fn pictures() -> Vec<Case> {
    cases! { "pictures";
        "a picture of 100,000 × 100,000" => "refused before it is decoded", huge_picture;
        "a picture that is cut off" => "refused", || {
            let bytes = small_png()?;
            refused(decoded(&bytes[..bytes.len() / 2]), INTACT)
        };
        "a picture that is none" => "refused",
            || refused(decoded(b"x_mm,height_um\n0,1\n"), INTACT);
        "an empty file for a picture" => "refused", || refused(decoded(&[]), INTACT);
    }
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
    picture.to_png(Path::new("a.png")).map_err(failed)
}

fn decoded(bytes: &[u8]) -> Result<usize, String> {
    let picture = Rgb8Image::from_png(bytes, Path::new("a.png"));
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
