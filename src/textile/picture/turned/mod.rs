//! The same cloth in another picture, turned in the plane under the same lamp: where it lies, and
//! what it looks like laid over the first.
//!
//! Each picture is matched with the first by [`matching`], coarse to fine; then pieces of it are,
//! and a similarity is fitted to them by least squares.

mod matching;
mod similarity;
#[cfg(test)]
mod tests;
mod together;

pub use similarity::Similarity;

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::PictureError;
use super::basis::{Place, length, mix};
use super::light::{EvenLight, even_light};
use super::source::Picture;
use matching::{Level, Matched};
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::numerics::{Grid, in_pieces, median, to_index};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::fixed;

/// Samples a side of what is matched, coarse to fine.
const SIDES: [usize; 3] = [64, 128, 256];
/// Turns that are tried first, over a whole one, and scales.
const N_TURNS: usize = 180;
const SCALES: [f64; 2] = [0.985, 1.015];
/// What is tried about each of the best so far, on the next two levels: turns either side and their
/// distance, degrees; shares of the scale; how many are kept, and how far apart.
const ABOUT: [(i32, f64, f64, usize); 2] = [(1, 0.8, 0.01, 8), (1, 0.4, 0.005, 2)];
const APART_DEG: f64 = 5.0;
/// A match that stands out less from the next best is none.
const MIN_SCORE: f64 = 0.35;
/// What pictures of different cloths reach, deviations of chance.
const CHANCE: f64 = 14.0;
/// Parts of a picture that are matched: all of it, then the middle.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];
/// Pieces a side that the similarity is fitted to, samples of each, rounds, and what each must
/// reach.
const N_PIECES: usize = 6;
const PIECE: usize = 64;
const N_ROUNDS: usize = 3;
/// Farther from where the whole puts it no piece is believed, px; times that the farthest ones are
/// left out.
const MOST_MOVED_PX: f64 = 6.0;
const N_TRIMMINGS: usize = 4;
const PIECE_CHANCE: f64 = 7.0;
/// Pieces that a fit needs.
const MIN_PIECES: usize = 6;

/// A picture of the cloth, turned, laid over the first.
#[derive(Debug, Clone)]
pub struct Turned {
    /// Its luminance, pixel by pixel as the first has them; beyond its edges their values.
    pub luminance: Grid<f64>,
    /// From the first picture to this.
    pub map: Similarity,
    /// How far the match stands out: 0 as high as the next best, 1 alone.
    pub score: f64,
    /// How far pieces lie from the similarity, px, rms.
    pub residual_px: f64,
    size: [f64; 2],
}

/// A further picture of a cloth, turned under the same lamp; it need not be there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TurnedPicture {
    /// Its file name.
    pub picture: String,
    /// Its SHA-256.
    pub sha256: String,
    /// By how much the cloth is turned in it, degrees counter-clockwise.
    pub turn_deg: f64,
    /// How far its match with the first stands out, 0 to 1.
    pub score: f64,
}

impl Turned {
    /// Further pictures at most.
    pub const MAX: usize = 3;

    /// Reads another picture and lays it over the first, in even light as that is; with what a
    /// textile keeps of it. `path` names it.
    ///
    /// # Errors
    /// A file that is no picture; as [`Self::of`].
    pub fn read(
        first: &Grid<f64>,
        (bytes, path): (&[u8], &Path),
        even: EvenLight,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(Self, TurnedPicture), PictureError> {
        let (luminance, _) = even_light(Picture::load(bytes, path)?.luminance, even);
        let turned = Self::of(first, (&luminance, path), n_threads, progress)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let hundredths = |x: f64| (100.0 * x).round() / 100.0;
        let kept = TurnedPicture {
            picture: name.into_owned(),
            sha256: sha256_hex([bytes]),
            turn_deg: hundredths(turned.map.turn_deg()),
            score: hundredths(turned.score),
        };
        Ok((turned, kept))
    }

    /// Finds the cloth of the first picture in another, both in even light. `path` names that in
    /// errors.
    ///
    /// # Errors
    /// A picture that is too small, is not of the same cloth, or fits in several places. Cancelled.
    fn of(
        first: &Grid<f64>,
        (other, path): (&Grid<f64>, &Path),
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, PictureError> {
        let sides = [first.width(), first.height(), other.width(), other.height()];
        let side = sides.into_iter().min().unwrap_or(0) as f64;
        let path = path.display();
        if side < SIDES[0] as f64 {
            let what = format!("{path}: the smaller side of both pictures has {side} px");
            return Err(PictureError::Input(format!("{what}; give 64 px or more")));
        }
        let mut best: Option<(Matched, f64)> = None;
        for part in PARTS {
            let side = part * side;
            if part < 1.0 && side < SIDES[2] as f64 {
                break;
            }
            progress.step(1.0 - part, "laying pictures over each other")?;
            let found = found([first, other], side, n_threads);
            let is_better = |(_, score): &(Matched, f64)| found.1 > *score;
            if best.as_ref().is_none_or(is_better) {
                best = Some(found);
            }
            if best.as_ref().is_some_and(|(_, score)| *score >= MIN_SCORE) {
                break;
            }
        }
        let Some((matched, score)) = best.filter(|(_, score)| *score >= MIN_SCORE) else {
            let [height, score] = best.map_or([0.0; 2], |(one, score)| [one.height, score]);
            let what = if height < CHANCE {
                "does not show the cloth of the first picture"
            } else {
                "fits the first picture in several places"
            };
            let score = fixed(score.max(0.0), 2);
            let mend = "give the same piece of cloth, turned, at the same scale";
            return Err(PictureError::Input(format!(
                "{path}: it {what} (match {score}, {MIN_SCORE} is needed); {mend}"
            )));
        };
        let (map, residual_px) = refined([first, other], matched.map, n_threads);
        let size = [other.width(), other.height()].map(|n| n as f64);
        Ok(Self {
            luminance: map.laid(other, [first.width(), first.height()], n_threads),
            map,
            score,
            residual_px,
            size,
        })
    }

    /// How it lies over the first, in a line.
    pub fn words(&self, name: &str) -> String {
        let turn = fixed(self.map.turn_deg(), 1);
        let (score, within) = (fixed(self.score, 2), fixed(self.residual_px, 2));
        format!("{name} shows it turned by {turn}° (match {score}, within {within} px)")
    }

    fn shows(&self, place: Place) -> bool {
        let at = self.map.at(place);
        (0..2).all(|axis| (0.0..=self.size[axis] - 1.0).contains(&at[axis]))
    }

    /// A part of the first picture that all of them show: its left, top, width and height, px.
    ///
    /// # Errors
    /// It is smaller than 64 px a side.
    pub fn common(all: &[Self]) -> Result<[usize; 4], PictureError> {
        let first = all.first();
        let size = first.map_or([0.0; 2], |one| {
            [one.luminance.width(), one.luminance.height()].map(|n| n as f64)
        });
        let is_shown = |place: Place| {
            let is_inside = (0..2).all(|axis| (0.0..=size[axis] - 1.0).contains(&place[axis]));
            is_inside && all.iter().all(|one| one.shows(place))
        };
        let shares = || (0..32).map(|i| (f64::from(i) + 0.5) / 32.0);
        let places = shares().flat_map(|y| shares().map(move |x| [x * size[0], y * size[1]]));
        let shown: Vec<Place> = places.filter(|place| is_shown(*place)).collect();
        let n = shown.len().max(1) as f64;
        let middle = [0, 1].map(|axis| shown.iter().map(|place| place[axis]).sum::<f64>() / n);
        let fits = |half: Place| {
            let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
            corners
                .iter()
                .all(|[x, y]| is_shown([middle[0] + x * half[0], middle[1] + y * half[1]]))
        };
        let short = size[0].min(size[1]);
        let largest = [size, [short; 2]].map(|size| {
            let halves = (0..100).map(|i| size.map(|n| 0.5 * n * (1.0 - 0.01 * f64::from(i))));
            halves
                .into_iter()
                .find(|half| fits(*half))
                .unwrap_or([0.0; 2])
        });
        let [a, b] = largest;
        let half = if a[0] * a[1] >= b[0] * b[1] { a } else { b };
        let corner = [0, 1].map(|axis| to_index((middle[axis] - half[axis]).max(0.0).ceil()));
        let [w, h] = half.map(|half| to_index(2.0 * half));
        if w.min(h) < SIDES[0] {
            let what = format!("all pictures together show {w} × {h} px of the cloth");
            let mend = "turn it about the middle of the picture";
            return Err(PictureError::Input(format!(
                "{what}, 64 px are needed; {mend}"
            )));
        }
        Ok([corner[0], corner[1], w, h])
    }
}

/// The best match of the middle of both pictures, a square of this side, and how far it stands out.
fn found(pictures: [&Grid<f64>; 2], side_px: f64, n_threads: usize) -> (Matched, f64) {
    let [from, to] = pictures.map(middle_of);
    let turns = (0..N_TURNS).map(|i| 360.0 * i as f64 / N_TURNS as f64);
    let maps = turns.flat_map(|deg| SCALES.map(|scale| Similarity::new([from, to], deg, scale)));
    let mut tried = tried(pictures, (SIDES[0], side_px), maps.collect(), n_threads);
    for (n, (n_turns, step_deg, step, n_kept)) in SIDES.into_iter().skip(1).zip(ABOUT) {
        if side_px < n as f64 {
            break;
        }
        let about = |one: Matched| {
            let turns = (-n_turns..=n_turns).map(move |i| f64::from(i) * step_deg);
            let scales = [1.0 - step, 1.0, 1.0 + step];
            turns.flat_map(move |deg| scales.map(|scale| one.map.changed(deg, scale)))
        };
        let maps = apart(&tried, n_kept).into_iter().flat_map(about);
        tried = self::tried(pictures, (n, side_px), maps.collect(), n_threads);
    }
    let kept = apart(&tried, 2);
    let best = kept[0];
    let other = kept.get(1).map_or(0.0, |other| other.height);
    let is_seen = best.height > PIECE_CHANCE;
    let score = 1.0 - best.next.max(other) / best.height.max(PIECE_CHANCE);
    (best, if is_seen { score } else { 0.0 })
}

/// The best ones whose turns are apart, best first.
fn apart(tried: &[Matched], n: usize) -> Vec<Matched> {
    let mut kept: Vec<Matched> = Vec::new();
    for one in tried {
        let is_apart = |other: &Matched| one.map.turn_from(&other.map) > APART_DEG;
        if kept.len() < n && kept.iter().all(is_apart) {
            kept.push(*one);
        }
    }
    kept
}

/// Matches all similarities, best first.
fn tried(
    pictures: [&Grid<f64>; 2],
    (n, side_px): (usize, f64),
    maps: Vec<Similarity>,
    n_threads: usize,
) -> Vec<Matched> {
    let level = Level::of(pictures, middle_of(pictures[0]), (n, side_px / n as f64));
    let mut all: Vec<Matched> = maps.into_iter().map(Matched::nothing).collect();
    in_pieces(
        &mut all,
        1,
        n_threads,
        || (),
        |(), _, one| {
            one[0] = level.matched(one[0].map);
        },
    );
    all.sort_by(|a, b| b.height.total_cmp(&a.height));
    all
}

fn middle_of(picture: &Grid<f64>) -> Place {
    [picture.width(), picture.height()].map(|n| 0.5 * (n as f64 - 1.0))
}

/// The similarity fitted to pieces, and how far they lie from it, px rms. As it was, within a
/// sample, if too few of them match.
fn refined(pictures: [&Grid<f64>; 2], map: Similarity, n_threads: usize) -> (Similarity, f64) {
    let size = [pictures[0].width(), pictures[0].height()].map(|n| n as f64);
    let shares = || (0..N_PIECES).map(|i| (i as f64 + 0.5) / N_PIECES as f64);
    let places = shares().flat_map(|y| shares().map(move |x| [x * size[0], y * size[1]]));
    let places: Vec<Place> = places.collect();
    let (mut map, mut residual_px) = (map, 1.0);
    for _ in 0..N_ROUNDS {
        let mut pairs: Vec<Option<[Place; 2]>> = vec![None; places.len()];
        in_pieces(
            &mut pairs,
            1,
            n_threads,
            || (),
            |(), i, pair| {
                let matched = Level::of(pictures, places[i], (PIECE, 1.0)).matched(map);
                let moved = length(mix(matched.map.at(places[i]), 1.0, map.at(places[i]), -1.0));
                let is_sure = matched.height > PIECE_CHANCE && moved < MOST_MOVED_PX;
                pair[0] = is_sure.then(|| [places[i], matched.map.at(places[i])]);
            },
        );
        let mut pairs: Vec<[Place; 2]> = pairs.into_iter().flatten().collect();
        if pairs.len() < MIN_PIECES {
            break;
        }
        let off = |map: &Similarity, [a, b]: &[Place; 2]| length(mix(map.at(*a), 1.0, *b, -1.0));
        // A piece may lie a thread off: what lies farthest is left out, over and over.
        map = Similarity::fitted(&pairs);
        for _ in 0..N_TRIMMINGS {
            let mut all: Vec<f64> = pairs.iter().map(|pair| off(&map, pair)).collect();
            let limit = 2.5 * median(&mut all).max(0.1);
            pairs.retain(|pair| off(&map, pair) <= limit);
            map = Similarity::fitted(&pairs);
        }
        let squares = pairs.iter().map(|pair| off(&map, pair).powi(2));
        residual_px = (squares.sum::<f64>() / pairs.len().max(1) as f64).sqrt();
    }
    (map, residual_px)
}
