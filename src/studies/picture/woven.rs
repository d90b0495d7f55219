//! Weaves as a camera sees them, and pictures that repeat nowhere.
//!
//! Yarns are shaded round, dive between floats, differ among themselves in brightness and place,
//! and show their twist. Nothing here is drawn by the models of textiles, so that the lattice is
//! judged by pictures that the program did not make.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::drawings::standardised;
use super::spoilt::blurred;
use crate::readable::whole;
use selvedge_foundation::numerics::{Grid, Random, to_whole};
use selvedge_textile::picture::{Basis, Place};

/// A weave: its name and rows of crossings, `X` where the warp lies on top.
pub(super) type Woven = (&'static str, &'static [&'static str]);

/// Weaves of 2 to 18 threads a repeat.
pub(super) const WEAVES: [Woven; 15] = [
    ("plain", &["X.", ".X"]),
    ("twill 2/1", &["XX.", ".XX", "X.X"]),
    ("twill 2/2", &["XX..", ".XX.", "..XX", "X..X"]),
    ("twill 3/1", &["XXX.", ".XXX", "X.XX", "XX.X"]),
    ("twill 1/3", &["X...", ".X..", "..X.", "...X"]),
    (
        "twill 4/4",
        &[
            "XXXX....", ".XXXX...", "..XXXX..", "...XXXX.", "....XXXX", "X....XXX", "XX....XX",
            "XXX....X",
        ],
    ),
    ("satin 5", &[".XXXX", "XXX.X", "X.XXX", "XXXX.", "XX.XX"]),
    ("sateen 5", &["X....", "...X.", ".X...", "....X", "..X.."]),
    (
        "satin 8",
        &[
            ".XXXXXXX", "XXX.XXXX", "XXXXXX.X", "X.XXXXXX", "XXXX.XXX", "XXXXXXX.", "XX.XXXXX",
            "XXXXX.XX",
        ],
    ),
    (
        "satin 7",
        &[
            ".XXXXXX", "XX.XXXX", "XXXX.XX", "XXXXXX.", "X.XXXXX", "XXX.XXX", "XXXXX.X",
        ],
    ),
    ("basket 2/2", &["XX..", "XX..", "..XX", "..XX"]),
    (
        "basket 3/3",
        &["XXX...", "XXX...", "XXX...", "...XXX", "...XXX", "...XXX"],
    ),
    ("warp rib", &["X.", "X.", ".X", ".X"]),
    ("weft rib", &["XX..", "..XX"]),
    ("broken twill", &["XXX.", "X.XX", "XX.X", ".XXX"]),
];

/// A cloth of a weave under the camera.
pub(super) struct Cloth {
    rows: &'static [&'static str],
    /// From thread to thread, px.
    pub(super) threads: Basis,
    /// The two shortest vectors of its repeat, px.
    pub(super) repeat: Basis,
    /// Side of a picture that holds some repeats, px.
    pub(super) side_px: f64,
    /// How much brighter warp is than weft.
    contrast: f64,
    /// How dark a yarn is where it dives.
    dive: f64,
    /// Brightness of its twist.
    twist: f64,
    /// Where the light comes from, radians.
    light: f64,
    /// Brightness and place of ends and picks about their mean.
    yarns: Vec<[f64; 4]>,
}

/// Most floats, threads.
const LONGEST: isize = 8;
/// Yarns that differ; farther ones are as the last.
const N_YARNS: usize = 400;

impl Cloth {
    /// A cloth at 5 to 11 px a thread with so many repeats a side, turned by `turn_rad`.
    pub(super) fn new(
        (_, rows): Woven,
        [fewest, most]: [f64; 2],
        turn_rad: f64,
        random: &mut Random,
    ) -> Self {
        let pitch = random.uniform_in(5.0, 11.0);
        let other = pitch * random.uniform_in(0.8, 1.25);
        let polar = |length: f64, angle: f64| [length * angle.cos(), length * angle.sin()];
        let threads = Basis::new(polar(pitch, turn_rad), polar(other, turn_rad + FRAC_PI_2));
        let [first, second] = repeat(rows);
        let sides = [rows[0].len() as f64 * pitch, rows.len() as f64 * other];
        let side = sides[0].max(sides[1]) * random.uniform_in(fewest, most);
        let [uneven, misplaced] = [random.uniform_in(0.0, 0.06), random.uniform_in(0.0, 0.025)];
        let yarn = |_| {
            let spreads = [uneven, uneven, misplaced, misplaced];
            spreads.map(|spread| spread * random.normal())
        };
        let yarns = (0..N_YARNS).map(yarn).collect();
        Self {
            rows,
            threads,
            repeat: Basis::new(threads.place(first), threads.place(second)).reduced(),
            side_px: side.clamp(if fewest < 4.0 { 40.0 } else { 160.0 }, 420.0),
            contrast: random.uniform_in(0.0, 0.25),
            dive: random.uniform_in(0.15, 0.5),
            twist: random.uniform_in(0.0, 0.05),
            light: random.uniform_in(0.0, TAU),
            yarns,
        }
    }

    fn is_warp(&self, end: isize, pick: isize) -> bool {
        is_warp(self.rows, end, pick)
    }

    fn yarn(&self, number: isize, which: usize) -> f64 {
        let middle = self.yarns.len() / 2;
        let index = middle.saturating_add_signed(number);
        self.yarns[index.min(self.yarns.len() - 1)][which]
    }

    /// How bright it is at a place of the picture, 0 to about 1.
    pub(super) fn at(&self, place: Place) -> f64 {
        let [u, v] = self.threads.coordinates(place);
        let [end, pick] = [u, v].map(|at| to_whole(at.floor()));
        let inside = |at: f64, moved: f64| (2.0 * (at - at.floor() + moved) - 1.0).clamp(-1.0, 1.0);
        let (x, y) = (inside(u, self.yarn(end, 2)), inside(v, self.yarn(pick, 3)));
        let is_warp = self.is_warp(end, pick);
        let goes_on = |n: isize| {
            if is_warp {
                self.is_warp(end, pick + n)
            } else {
                !self.is_warp(end + n, pick)
            }
        };
        let before = (1..=LONGEST).take_while(|n| goes_on(-n)).count() as f64;
        let after = (1..=LONGEST).take_while(|n| goes_on(*n)).count() as f64;
        let (across, along) = if is_warp { (x, y) } else { (y, x) };
        let half = before + after + 1.0;
        // From the middle of its float, in half threads.
        let from_middle = 2.0 * before + 1.0 + along - half;
        let from_end = (half - from_middle.abs()).clamp(0.0, 1.0);
        let slope = if from_end < 1.0 {
            0.6 * from_middle.signum()
        } else {
            0.0
        };
        let normal = if is_warp {
            [across, slope]
        } else {
            [slope, across]
        };
        let lit = 0.18 * (normal[0] * self.light.cos() + normal[1] * self.light.sin());
        let (bright, own, twist) = if is_warp {
            (self.contrast, self.yarn(end, 0), self.yarn(end, 1))
        } else {
            (-0.5 * self.contrast, self.yarn(pick, 1), self.yarn(pick, 0))
        };
        let dark = self.dive * (1.0 - (FRAC_PI_2 * from_end).sin());
        let fibres = self.twist * (TAU * (1.3 * across + 0.9 * from_middle + twist)).sin();
        (0.5 + bright + own) * (0.75 - 0.3 * across * across - dark + lit + fibres)
    }
}

fn is_warp(rows: &[&str], end: isize, pick: isize) -> bool {
    let row = rows[pick.rem_euclid(rows.len().cast_signed()).cast_unsigned()].as_bytes();
    row[end.rem_euclid(row.len().cast_signed()).cast_unsigned()] == b'X'
}

/// The vectors of the smallest repeat of a weave, in threads.
fn repeat(rows: &[&str]) -> [Place; 2] {
    let (width, height) = (rows[0].len().cast_signed(), rows.len().cast_signed());
    let crossings = || (0..height).flat_map(|j| (0..width).map(move |i| [i, j]));
    let repeats = |s: isize, t: isize| {
        crossings().all(|[i, j]| is_warp(rows, i, j) == is_warp(rows, i + s, j + t))
    };
    let shifts = (0..=height).flat_map(|t| (-width..=width).map(move |s| [s, t]));
    let all: Vec<Place> = shifts
        .filter(|&[s, t]| [s, t] != [0, 0] && repeats(s, t))
        .map(|shift| shift.map(|x| x as f64))
        .collect();
    let pairs = all.iter().flat_map(|a| all.iter().map(move |b| [*a, *b]));
    let area = |[a, b]: &[Place; 2]| (a[0] * b[1] - a[1] * b[0]).abs();
    let spans = pairs.filter(|pair| area(pair) > 0.5);
    spans
        .min_by(|a, b| area(a).total_cmp(&area(b)))
        .unwrap_or([[width as f64, 0.0], [0.0, height as f64]])
}

/// Draws a square picture of so many pixels a side.
type Draw = fn(usize, &mut Random) -> Grid<f64>;

/// Pictures that repeat nowhere, by name.
pub(super) const APERIODIC: [(&str, Draw); 9] = [
    ("bumps", bumps),
    ("bumps that keep apart", bumps_apart),
    ("soft noise", |n, random| {
        let size = random.uniform_in(1.0, 4.0);
        soft_noise(n, size, random)
    }),
    ("1/f noise", octaves),
    ("noise of one scale", one_scale),
    ("fibres", fibres),
    ("brushed noise", brushed),
    ("patches", patches),
    ("threads at random distances", random_threads),
];

/// A picture that repeats nowhere, about 0.5.
pub(super) fn aperiodic(draw: Draw, n: usize, random: &mut Random) -> Grid<f64> {
    let mut picture = draw(n, random);
    standardised(&mut picture);
    for value in picture.values_mut() {
        *value = 0.5 + 0.13 * *value;
    }
    picture
}

fn bumps(n: usize, random: &mut Random) -> Grid<f64> {
    let (side, mut picture) = (n as f64, Grid::filled(n, n, 0.0));
    let size = random.uniform_in(3.0, 8.0);
    let area = size * size * random.uniform_in(4.0, 12.0);
    for _ in 0..whole(side * side / area) {
        let place = [0; 2].map(|_| random.uniform_in(0.0, side));
        bump(&mut picture, place, size, random.uniform_in(0.5, 1.0));
    }
    picture
}

fn bumps_apart(n: usize, random: &mut Random) -> Grid<f64> {
    let (side, mut picture) = (n as f64, Grid::filled(n, n, 0.0));
    let apart = random.uniform_in(8.0, 16.0);
    let mut places: Vec<Place> = Vec::new();
    for _ in 0..20_000 {
        let place = [0; 2].map(|_| random.uniform_in(0.0, side));
        let is_free = |other: &Place| (other[0] - place[0]).hypot(other[1] - place[1]) > apart;
        if places.iter().all(is_free) {
            places.push(place);
            bump(&mut picture, place, 0.3 * apart, 1.0);
        }
    }
    picture
}

fn octaves(n: usize, random: &mut Random) -> Grid<f64> {
    let mut picture = Grid::filled(n, n, 0.0);
    let slope = random.uniform_in(0.3, 0.7);
    for octave in [0.0, 1.0, 2.0, 3.0, 4.0, 5.0] {
        let noise = soft_noise(n, 0.7 * 2.0_f64.powf(octave), random);
        let weight = 2.0_f64.powf(slope * octave);
        for (value, noise) in picture.values_mut().iter_mut().zip(noise.values()) {
            *value += weight * noise;
        }
    }
    picture
}

fn one_scale(n: usize, random: &mut Random) -> Grid<f64> {
    let size = random.uniform_in(2.0, 4.0);
    let fine = soft_noise(n, size, random);
    let mut picture = blurred(&fine, 0.8 * size);
    for (value, fine) in picture.values_mut().iter_mut().zip(fine.values()) {
        *value = fine - *value;
    }
    picture
}

fn fibres(n: usize, random: &mut Random) -> Grid<f64> {
    let (side, mut picture) = (n as f64, Grid::filled(n, n, 0.0));
    for _ in 0..600 {
        let [x, y] = [0; 2].map(|_| random.uniform_in(0.0, side));
        let (s, c) = random.uniform_in(0.0, PI).sin_cos();
        let (half, bright) = (random.uniform_in(20.0, 90.0), random.uniform_in(0.1, 0.3));
        for step in 0..whole(2.5 * half) {
            let t = 0.8 * step as f64 - half;
            bump(&mut picture, [x + t * c, y + t * s], 0.9, bright);
        }
    }
    picture
}

fn brushed(n: usize, random: &mut Random) -> Grid<f64> {
    let mut picture = soft_noise(n, 1.0, random);
    for row in 0..n {
        let mut carried = 0.0;
        for value in picture.row_mut(row) {
            carried = 0.85 * carried + *value;
            *value = carried;
        }
    }
    picture
}

fn patches(n: usize, random: &mut Random) -> Grid<f64> {
    let side = n as f64;
    let patch = |random: &mut Random| [side, side, 1.0].map(|most| random.uniform_in(0.0, most));
    let n_patches = whole(random.uniform_in(200.0, 700.0));
    let patches: Vec<[f64; 3]> = (0..n_patches).map(|_| patch(random)).collect();
    Grid::from_fn(n, n, |column, row| {
        let [x, y] = [column, row].map(|at| at as f64);
        let distance = |p: &&[f64; 3]| (p[0] - x).powi(2) + (p[1] - y).powi(2);
        let nearest = patches
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.map_or(0.0, |patch| patch[2])
    })
}

fn random_threads(n: usize, random: &mut Random) -> Grid<f64> {
    let mut threads = || {
        let (mut at, mut all) = (0.0, Vec::new());
        while at < n as f64 {
            all.push([at, random.uniform_in(0.4, 1.0)]);
            at += random.uniform_in(3.0, 18.0);
        }
        all
    };
    let [ends, picks] = [threads(), threads()];
    let bright = |threads: &[[f64; 2]], x: f64| -> f64 {
        let one = |[at, most]: &[f64; 2]| most * (-0.5 * ((x - at) / 1.6).powi(2)).exp();
        threads.iter().map(one).sum()
    };
    Grid::from_fn(n, n, |column, row| {
        bright(&ends, column as f64) + bright(&picks, row as f64)
    })
}

/// Noise of a scale, of spread 1.
fn soft_noise(n: usize, size_px: f64, random: &mut Random) -> Grid<f64> {
    let noise = Grid::from_fn(n, n, |_, _| random.normal());
    let mut soft = blurred(&noise, size_px);
    standardised(&mut soft);
    soft
}

/// Adds a Gaussian of a size and height.
fn bump(picture: &mut Grid<f64>, [x, y]: Place, size: f64, height: f64) {
    let near = |at: f64, n: usize| {
        let index = |x: f64| whole(x).min(n);
        index(at - 3.0 * size)..index(at + 3.0 * size + 1.0)
    };
    let columns = near(x, picture.width());
    for row in near(y, picture.height()) {
        for column in columns.clone() {
            let far = (column as f64 - x).powi(2) + (row as f64 - y).powi(2);
            picture.row_mut(row)[column] += height * (-0.5 * far / (size * size)).exp();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_of_weaves_are_their_smallest() {
        let index = |name: &str| {
            let weave = WEAVES.iter().find(|weave| weave.0 == name).unwrap();
            let [a, b] = repeat(weave.1);
            (a[0] * b[1] - a[1] * b[0]).abs()
        };
        for (name, expected) in [
            ("plain", 2.0),
            ("twill 2/1", 3.0),
            ("twill 4/4", 8.0),
            ("satin 7", 7.0),
            ("basket 2/2", 8.0),
            ("basket 3/3", 18.0),
            ("warp rib", 4.0),
            ("broken twill", 16.0),
        ] {
            assert_eq!(index(name), expected, "{name}");
        }
    }
}
