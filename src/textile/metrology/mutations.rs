//! Every reader against files with seeded faults: cut short, bytes changed, sizes blown up, parts
//! doubled. Whatever comes, a reader answers: heights, or one line.

use std::path::Path;

use super::Measured;
use super::samples::all;
use crate::surface::MAX_POINTS;
use selvedge_foundation::numerics::Random;

/// Inputs made of each sample; the environment variable `SELVEDGE_MUTATIONS` sets another number.
const N_EACH: usize = 200;

#[test]
fn every_reader_withstands_faulty_files() {
    let set = std::env::var("SELVEDGE_MUTATIONS").ok();
    let n_each = set.map_or(N_EACH, |n| {
        n.parse().expect("SELVEDGE_MUTATIONS is a number")
    });
    let random = Random::new(20_121_206);
    let (mut n_inputs, mut n_read) = (0, 0);
    for (name, bytes, asked) in all() {
        let mut random = random.branch(name);
        for _ in 0..n_each {
            let faulty = mutated(&bytes, &mut random);
            n_inputs += 1;
            match Measured::open(&faulty, Path::new(name), &asked) {
                Ok(read) => {
                    n_read += 1;
                    assert!(read.heights_um.values().len() <= MAX_POINTS, "{name}");
                    assert!(read.step_mm.iter().all(|step| *step > 0.0), "{name}");
                    assert!(read.sq_um() >= 0.0 || read.sq_um().is_nan(), "{name}");
                }
                Err(error) => {
                    let line = error.to_string();
                    assert!(!line.contains('\n') && line.contains(name), "{line}");
                }
            }
        }
    }
    println!("{n_inputs} faulty files, of which {n_read} could be read");
    assert!(n_read < n_inputs, "the faults did no harm at all");
}

/// One to four faults.
fn mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.index(4) {
        if bytes.is_empty() {
            return bytes;
        }
        let at = random.index(bytes.len());
        match random.index(6) {
            0 => bytes.truncate(at),
            1 => bytes[at] ^= 1 << random.index(8),
            2 => {
                // Sizes and lengths are such words.
                let extremes = [0, 1, 0x7fff_ffff, 0x8000_0000, u32::MAX, 8192];
                let word = extremes[random.index(extremes.len())].to_le_bytes();
                let n = word.len().min(bytes.len() - at);
                bytes[at..at + n].copy_from_slice(&word[..n]);
            }
            3 => {
                let end = at + random.index(bytes.len() - at);
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            4 => {
                let end = at + random.index((bytes.len() - at).min(64));
                bytes.drain(at..end);
            }
            _ => bytes[at] = b"0123456789-.e\"<>/;,\n\0\xff"[random.index(22)],
        }
    }
    bytes
}
