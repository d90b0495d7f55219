//! Damaged exports: whatever is done to a file, it is read or refused in one line, and what is read
//! is finite.
//!
//! `SELVEDGE_MUTATIONS` says how many damaged files are tried; 3000 if it does not.

use std::path::Path;

use super::{KesFile, KesOptions, KesReading, ReturnOrder};
use crate::KesImport;
use selvedge_foundation::numerics::Random;

/// How many are tried if nothing is said.
const N_MUTATIONS: usize = 3000;

/// Whole exports, small enough to try many.
fn whole() -> Vec<Vec<u8>> {
    let rows = |row: &dyn Fn(i32) -> String| (0..90).map(row).collect::<String>();
    let z = |i: i32| f64::from((i * 37) % 23 - 11) * 0.5;
    let x = |i: i32| f64::from(i) * 0.1;
    let comma = |value: f64| format!("{value:.2}").replace('.', ",");
    vec![
        format!(
            "KES-FB4\nx mm\theight um\n{}",
            rows(&|i| format!("{:.1}\t{}\n", x(i), z(i)))
        ),
        format!(
            "Probe;7\r\nWeg mm;forward;return\r\n{}",
            rows(&|i| format!("{};{};{}\r\n", comma(x(i)), comma(z(i)), comma(z(i + 1))))
        ),
        rows(&|i| format!("{:.1},{},{}\n", x(i), z(i), z(89 - i))),
        format!(
            "t s  signal V\n{}",
            rows(&|i| format!(" {:.2}  {:e}\n", x(i) * 0.1, z(i)))
        ),
        rows(&|i| format!("{:.1} {}\n", x(i.min(89 - i)), z(i))),
        format!(
            "\u{feff}x,height,mu\n{}",
            rows(&|i| format!("{:.1},{},0.2\n", x(i), z(i)))
        ),
    ]
    .into_iter()
    .map(String::into_bytes)
    .collect()
}

/// Damages a file in a few places.
fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    const PIECES: [&[u8]; 14] = [
        b"NaN",
        b"inf",
        b"1e999",
        b"-",
        b",",
        b";",
        b"\t",
        b"\n",
        b"\0",
        b"\xb5",
        b"9999999999",
        b"\n\n5\n",
        b"V",
        b"x",
    ];
    for _ in 0..=random.index(3) {
        let at = random.index(bytes.len() + 1);
        let end = (at + random.index(30)).min(bytes.len());
        match random.index(8) {
            0 => drop(bytes.splice(at..end, std::iter::empty())),
            1 => drop(bytes.splice(at..at, PIECES[random.index(PIECES.len())].iter().copied())),
            2 => bytes.truncate(at),
            3 => {
                let copied = bytes[at..end].to_vec();
                drop(bytes.splice(at..at, copied));
            }
            4 | 5 if at < bytes.len() => {
                if bytes[at].is_ascii_digit() {
                    bytes[at] = b"0123456789"[random.index(10)];
                }
            }
            6 if !bytes.is_empty() => {
                let at = random.index(bytes.len());
                bytes[at] = bytes[random.index(bytes.len())];
            }
            _ => drop(bytes.splice(at..end, PIECES[random.index(PIECES.len())].iter().copied())),
        }
    }
}

fn options(random: &mut Random) -> KesOptions {
    let mut say = |value: f64| (random.index(3) == 0).then_some(value);
    KesOptions {
        step_mm: say(0.1),
        um_per_volt: say(2.0),
        speed_mm_per_s: say(1.0),
        return_order: say(0.0).map(|_| ReturnOrder::Travel),
        ..KesOptions::default()
    }
}

#[test]
fn damaged_exports_are_read_or_refused_in_one_line() {
    let said = std::env::var("SELVEDGE_MUTATIONS").ok();
    let n_mutations = said
        .and_then(|said| said.parse().ok())
        .unwrap_or(N_MUTATIONS);
    let mut random = Random::new(2026).branch("kes mutations");
    let whole = whole();
    let mut n_read = 0;
    for number in 0..n_mutations {
        let mut bytes = whole[number % whole.len()].clone();
        damage(&mut bytes, &mut random);
        let file = KesFile {
            path: Path::new("warp.txt"),
            bytes: &bytes,
        };
        let read = KesReading::of(&[file], None, &options(&mut random))
            .and_then(|reading| KesImport::new(reading, [None, None], number % 5 == 0));
        match read {
            Ok(import) => {
                n_read += 1;
                let strokes = &import.reading().strokes;
                let mut heights = strokes.iter().flat_map(|stroke| &stroke.heights_um);
                assert!(heights.all(|height| height.is_finite()), "input {number}");
                assert!(
                    import.figures().smd_um.iter().all(|(_, um)| um.is_finite()),
                    "input {number}"
                );
            }
            Err(error) => {
                let error = error.to_string();
                let is_one_line = !error.contains(['\n', '\r', '\0']);
                assert!(
                    is_one_line && error.contains("; "),
                    "input {number}: {error}"
                );
            }
        }
    }
    println!("{n_mutations} damaged exports: {n_read} read, the others refused in one line");
    assert!(
        n_mutations < 100 || (n_read > 0 && n_read < n_mutations),
        "{n_read} read"
    );
}
