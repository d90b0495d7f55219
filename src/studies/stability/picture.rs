//! Pictures from which no lattice follows.

use std::path::Path;

use super::case::{Case, Verdict, cases, failed, refused, verdict};
use crate::picture::analysed;
use selvedge_foundation::files::{FileError, Rgb8Image};
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::picture::{NoLattice, Picture};

/// A side of the pictures, px.
const N: usize = 96;

pub(super) fn cases() -> Vec<Case> {
    cases! { "cloth from a picture";
        "a picture of 1 × 1" => "no lattice: too small", || {
            none(&Grid::filled(1, 1, 0.4), |why| matches!(why, NoLattice::TooSmall(..)))
        };
        "a picture of one colour" => "no lattice: one colour", || {
            none(&Grid::filled(N, N, 0.4), |why| matches!(why, NoLattice::OneColour))
        };
        "a picture of 20,000 × 20,000" => "refused by its header",
            || refused(loaded(&bitmap(20_000)), &["64 million"]);
        "a picture that is cut off" => "refused", cut_off;
        "a text for a picture" => "refused",
            || refused(loaded(b"row,height\n1,2\n"), &["no picture"]);
        "stripes" => "no lattice, with a reason",
            || none(&waves([[7.0, 2.0], [0.0, 0.0]]), |_| true);
        "waves 1° apart" => "no lattice, or one that is no line", nearly_parallel;
        "one repeat and a half" => "no lattice, with a reason",
            || none(&waves([[64.0, 0.0], [0.0, 64.0]]), |_| true);
        "less than a period" => "no lattice, with a reason",
            || none(&waves([[400.0, 0.0], [0.0, 300.0]]), |_| true);
        "noise" => "no lattice, with a reason", || {
            let mut random = Random::new(7);
            let values = (0..N * N).map(|_| random.uniform()).collect();
            none(&Grid::from_rows(N, values).ok_or("no grid")?, |_| true)
        };
        "brightness that is no number" => "no lattice, with a reason",
            || none(&Grid::filled(N, N, f64::NAN), |_| true);
    }
}

/// Waves of these periods (px along x and y; 0: none along it).
pub(super) fn waves(periods: [[f64; 2]; 2]) -> Grid<f64> {
    let mut grid = Grid::filled(N, N, 0.5);
    for row in 0..N {
        for (column, value) in grid.row_mut(row).iter_mut().enumerate() {
            for [x, y] in periods {
                let ways = [(column, x), (row, y)].into_iter();
                let ways = ways.filter(|(_, period)| *period > 0.0);
                let turn: f64 = ways.map(|(at, period)| at as f64 / period).sum();
                *value += 0.2 * (std::f64::consts::TAU * turn).cos();
            }
        }
    }
    grid
}

pub(super) type Answer = Result<[[f64; 2]; 2], NoLattice>;

pub(super) fn answer(luminance: &Grid<f64>) -> Result<Answer, String> {
    let found = analysed(luminance)
        .ok_or_else(|| failed("cancelled"))?
        .found;
    Ok(found.map(|found| [found.lattice.p1_px, found.lattice.p2_px]))
}

fn none(luminance: &Grid<f64>, is_it: fn(&NoLattice) -> bool) -> Verdict {
    match answer(luminance)? {
        Ok([p1, p2]) => Err(format!("repeats by {p1:?} and {p2:?}")),
        Err(why) => verdict(is_it(&why), format!("no lattice: {why}")),
    }
}

fn nearly_parallel() -> Verdict {
    match answer(&waves([[9.0, 0.0], [9.0, 515.0]]))? {
        Err(why) => Ok(format!("no lattice: {why}")),
        Ok([a, b]) => {
            let area_px = (a[0] * b[1] - a[1] * b[0]).abs();
            let text = format!("repeats by {a:?} and {b:?}");
            verdict(area_px.is_finite() && area_px > 9.0, text)
        }
    }
}

fn loaded(bytes: &[u8]) -> Result<Picture, FileError> {
    Picture::load(bytes, Path::new("a picture"))
}

/// A bitmap that only says how large it is.
fn bitmap(side: u32) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    let header = [58, 0, 54, 40, side, side, 0x0018_0001, 0, 4, 0, 0, 0, 0, 0];
    bytes.extend(header.iter().flat_map(|number: &u32| number.to_le_bytes()));
    bytes
}

fn cut_off() -> Verdict {
    let picture = Rgb8Image {
        width: N,
        height: N,
        pixels: (0..=u8::MAX)
            .cycle()
            .take(N * N)
            .map(|i| [i, u8::MAX - i, i / 3])
            .collect(),
    };
    let bytes = picture.to_png(Path::new("a.png")).map_err(failed)?;
    refused(loaded(&bytes[..bytes.len() / 2]), &["cut short"])
}
