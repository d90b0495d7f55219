//! How well two pictures of cloth match under a similarity, and what shift is left.
//!
//! Spectra are whitened, so that the few waves of the weave, which fit from thread to thread, count
//! as little as they are many; what tells a place from the next one is all the others. To first
//! order a matt relief Z shows `−i(l·κ)Z` under a light l. In a picture that is turned back by
//! θ the light stands θ elsewhere, so that the product of both spectra has the sign of
//! `cos θ + cos(2φ − ψ)`, φ being the wave's direction and ψ unknown. The correlation is therefore
//! taken thrice, plain and weighed by cos 2φ and sin 2φ: `cos θ·C + |C_c, C_s|` is the best over
//! all ψ. Albedo correlates plainly; the better of both counts, in deviations of chance.

use std::borrow::Cow;
use std::f64::consts::PI;

use super::super::basis::Place;
use super::super::source::between;
use super::similarity::Similarity;
use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform, QuadraticPeak, median};

/// Waves that are correlated: cycles a side at least, cycles a sample at most.
const MIN_CYCLES: f64 = 2.5;
const MAX_PER_SAMPLE: f64 = 0.35;
/// Finer ones are noise; so many times their power a wave must have to count in full.
const NOISE_PER_SAMPLE: f64 = 0.4;
const NOISE_TIMES: f64 = 3.0;
/// Another peak lies farther off than this, samples.
const APART: usize = 3;

/// A similarity as it matches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Matched {
    /// With the shift that was left taken up.
    pub(super) map: Similarity,
    /// The peak, deviations of chance.
    pub(super) height: f64,
    /// The next peak.
    pub(super) next: f64,
}

impl Matched {
    pub(super) fn nothing(map: Similarity) -> Self {
        Self {
            map,
            height: 0.0,
            next: 0.0,
        }
    }
}

/// A picture, halved as often as samples this far apart allow.
struct Halved<'a> {
    values: Cow<'a, Grid<f64>>,
    px: f64,
}

impl<'a> Halved<'a> {
    fn of(picture: &'a Grid<f64>, step_px: f64) -> Self {
        let (mut values, mut px) = (Cow::Borrowed(picture), 1.0);
        while step_px / px >= 2.0 {
            let four = |column: usize, row: usize| {
                let pair =
                    |row: usize| values.row(row)[2 * column] + values.row(row)[2 * column + 1];
                0.25 * (pair(2 * row) + pair(2 * row + 1))
            };
            let half = Grid::from_fn(values.width() / 2, values.height() / 2, four);
            values = Cow::Owned(half);
            px *= 2.0;
        }
        Self { values, px }
    }

    /// The value at a place of the picture; `None` outside.
    fn at(&self, place: Place) -> Option<f64> {
        let at = place.map(|x| (x - 0.5 * (self.px - 1.0)) / self.px);
        let size = [self.values.width(), self.values.height()];
        let is_inside = (0..2).all(|axis| (0.0..=size[axis] as f64 - 1.0).contains(&at[axis]));
        is_inside.then(|| between(&self.values, at, |a, b, t| a + (b - a) * t))
    }
}

/// A square of the first picture, and what other ones are sampled by.
pub(super) struct Level<'a> {
    other: Halved<'a>,
    middle: Place,
    n: usize,
    step_px: f64,
    window: Vec<f64>,
    transform: PlaneTransform,
    /// Of every bin: cycles a sample, cosine and sine of twice its direction.
    waves: Vec<[f64; 3]>,
    first: Grid<Complex>,
}

impl<'a> Level<'a> {
    /// About a place of the first picture, n × n samples so far apart.
    pub(super) fn of(
        [first, other]: [&'a Grid<f64>; 2],
        middle: Place,
        (n, step_px): (usize, f64),
    ) -> Self {
        let share = |i: usize| (i as f64 + 0.5) / n as f64;
        let mut level = Self {
            other: Halved::of(other, step_px),
            middle,
            n,
            step_px,
            window: (0..n).map(|i| (PI * share(i)).sin().powi(2)).collect(),
            transform: PlaneTransform::new(n, n),
            waves: (0..(n / 2 + 1) * n).map(|i| wave(i, n)).collect(),
            first: Grid::filled(n / 2 + 1, n, Complex::default()),
        };
        level.first = level.whitened(&Halved::of(first, step_px), |place| place);
        level
    }

    /// The whitened spectrum of a picture's square.
    fn whitened(&self, picture: &Halved<'_>, place: impl Fn(Place) -> Place) -> Grid<Complex> {
        let n = self.n;
        let half = 0.5 * (n as f64 - 1.0);
        let at = |column: usize, row: usize| {
            let [x, y] = [column, row].map(|i| (i as f64 - half) * self.step_px);
            picture.at(place([self.middle[0] + x, self.middle[1] + y]))
        };
        let values = Grid::from_fn(n, n, at);
        let weight = |i: usize| self.window[i % n] * self.window[i / n];
        let known = || values.values().iter().enumerate();
        let known = || known().filter_map(|(i, value)| Some((i, (*value)?)));
        let (sum, all) = known().fold((0.0, 1e-12), |(sum, all), (i, value)| {
            (sum + weight(i) * value, all + weight(i))
        });
        let mut cut = Grid::filled(n, n, 0.0);
        for (i, value) in known() {
            cut.values_mut()[i] = weight(i) * (value - sum / all);
        }
        let mut spectrum = self.transform.forward(&cut);
        let waves = spectrum.values().iter().zip(&self.waves);
        let fine = waves.filter(|(_, wave)| wave[0] > NOISE_PER_SAMPLE);
        let mut noise: Vec<f64> = fine.map(|(f, _)| f.norm_sqr()).collect();
        let noise = NOISE_TIMES * median(&mut noise) + f64::MIN_POSITIVE;
        for (f, wave) in spectrum.values_mut().iter_mut().zip(&self.waves) {
            let is_used = (MIN_CYCLES / n as f64..=MAX_PER_SAMPLE).contains(&wave[0]);
            let scale = if is_used {
                1.0 / (f.norm_sqr() + noise).sqrt()
            } else {
                0.0
            };
            *f *= scale;
        }
        spectrum
    }

    /// Matches the other picture under a similarity.
    pub(super) fn matched(&self, map: Similarity) -> Matched {
        let other = self.whitened(&self.other, |place| map.at(place));
        let mut products = [0; 3].map(|_| self.first.clone());
        for (i, g) in other.values().iter().enumerate() {
            let product = self.first.values()[i].conj() * g;
            let [_, cos, sin] = self.waves[i];
            for (to, weight) in products.iter_mut().zip([1.0, cos, sin]) {
                to.values_mut()[i] = product * weight;
            }
        }
        let [plain, cos, sin] = products.map(|product| self.transform.inverse(product));
        let square = plain.values().iter().map(|c| c * c).sum::<f64>();
        let chance = (square / plain.values().len() as f64).sqrt().max(1e-300);
        let turn = map.turn_deg().to_radians().cos();
        let deviation = (turn * turn + 0.5).sqrt();
        let waves = cos.values().iter().zip(sin.values());
        let pairs = plain.values().iter().zip(waves);
        let heights =
            pairs.map(|(c, (cos, sin))| c.max((turn * c + cos.hypot(*sin)) / deviation) / chance);
        let heights = Grid::from_rows(self.n, heights.collect());
        match heights {
            Some(heights) => self.peak(&heights, map),
            None => Matched::nothing(map),
        }
    }

    /// The highest peak of a match, and the next one.
    fn peak(&self, heights: &Grid<f64>, map: Similarity) -> Matched {
        let n = self.n;
        let values = heights.values();
        let best = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b]));
        let [x, y] = best.map_or([0; 2], |i| [i % n, i / n]);
        let near = |row: usize, column: usize| {
            heights.row((y + row + n - 1) % n)[(x + column + n - 1) % n]
        };
        let nine = [0, 1, 2].map(|row| [0, 1, 2].map(|column| near(row, column)));
        let top = QuadraticPeak::of(&nine);
        let round = |i: usize, from: usize| i.abs_diff(from).min(n - i.abs_diff(from));
        let is_apart = |i: &usize| round(i % n, x).max(round(i / n, y)) > APART;
        let others = (0..values.len()).filter(is_apart).map(|i| values[i]);
        let signed = |i: usize| {
            let shift = i as f64;
            if i > n / 2 { shift - n as f64 } else { shift }
        };
        let shift = [signed(x) + top.offset[0], signed(y) + top.offset[1]];
        Matched {
            map: map.shifted(shift.map(|samples| samples * self.step_px)),
            height: nine[1][1],
            next: others.fold(0.0, f64::max),
        }
    }
}

/// Of a bin: cycles a sample, cosine and sine of twice its direction.
fn wave(i: usize, n: usize) -> [f64; 3] {
    let columns = n / 2 + 1;
    let [x, y] = [i % columns, i / columns].map(|k| k as f64 / n as f64);
    let y = if y > 0.5 { y - 1.0 } else { y };
    let square = (x * x + y * y).max(f64::MIN_POSITIVE);
    [
        square.sqrt(),
        (x * x - y * y) / square,
        2.0 * x * y / square,
    ]
}
