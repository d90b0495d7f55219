//! What a camera and a table do to the picture of a cloth: turn, blur, bend, noise, uneven light,
//! few repeats, compression.

use std::f64::consts::{PI, TAU};

use super::drawings::{BINDINGS, Drawing};
use crate::readable::whole;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::picture::{Basis, Place};

/// How a picture is spoilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spoilt {
    /// Signal over noise, dB.
    pub(super) snr_db: f64,
    /// Turn of the first thread, degrees; any if not said.
    pub(super) turn_deg: Option<f64>,
    /// Standard deviation of the blur, px.
    pub(super) blur_px: f64,
    /// Amplitude of the waves that the cloth is bent in, px.
    pub(super) bend_px: f64,
    /// Side of the picture in mean periods; the whole side if not said.
    pub(super) n_repeats: Option<f64>,
    /// The brightest over the darkest light.
    pub(super) light_ratio: f64,
    /// Quality of a JPEG, 1…100; none if not said.
    pub(super) quality: Option<f64>,
    /// Side of the picture, px.
    pub(super) n_px: usize,
}

/// A picture, and the lattice that it was drawn by.
pub(super) struct Spoiled {
    pub(super) luminance: Grid<f64>,
    pub(super) truth: Basis,
    pub(super) is_weave: bool,
}

/// Shortest and longest distance of threads or length of vectors, px.
const PITCH_PX: [f64; 2] = [7.0, 15.0];

impl Spoilt {
    /// A usual picture of `n_px` pixels a side.
    pub(super) fn usual(n_px: usize) -> Self {
        Self {
            snr_db: 6.0,
            turn_deg: None,
            blur_px: 0.7,
            bend_px: 0.3,
            n_repeats: None,
            light_ratio: 1.5,
            quality: None,
            n_px,
        }
    }

    /// The picture of trial `number`: three of four show weaves, the fourth an oblique lattice.
    pub(super) fn picture(&self, number: usize, random: &Random) -> Spoiled {
        let mut random = random.branch(&format!("picture {number}"));
        let any_deg = random.uniform_in(0.0, 180.0);
        let turn = self.turn_deg.unwrap_or(any_deg).to_radians();
        let lengths = [0; 2].map(|_| random.uniform_in(PITCH_PX[0], PITCH_PX[1]));
        let drawing = if number % 4 == 3 {
            Drawing::oblique(lengths.map(|px| 1.5 * px), turn, &mut random)
        } else {
            BINDINGS[(number % 4 + number / 4) % 4].drawing(lengths, turn)
        };
        Spoiled {
            luminance: self.taken(&drawing, &mut random),
            truth: drawing.lattice(),
            is_weave: drawing.is_weave(),
        }
    }

    fn side_px(&self, truth: &Basis) -> usize {
        let of_repeats = |n: f64| whole((n * truth.area().sqrt()).round().max(1.0));
        self.n_repeats.map_or(self.n_px, of_repeats)
    }

    /// The picture of a drawing, in 8 bits.
    pub(super) fn taken(&self, drawing: &Drawing, random: &mut Random) -> Grid<f64> {
        let n = self.side_px(&drawing.lattice());
        let phases = [0; 2].map(|_| random.uniform_in(0.0, TAU));
        let turns = TAU / n as f64;
        let moved = |[x, y]: Place| {
            [
                x + self.bend_px * (turns * y + phases[0]).sin(),
                y + self.bend_px * (turns * x + phases[1]).sin(),
            ]
        };
        let mut picture = blurred(&drawing.drawn(n, moved), self.blur_px);
        let noise = 10.0_f64.powf(-self.snr_db / 20.0);
        let [dark, bright] = [1.0, self.light_ratio].map(|x| 2.0 * x / (1.0 + self.light_ratio));
        for row in 0..n {
            for (column, value) in picture.row_mut(row).iter_mut().enumerate() {
                let along = (0.7 * column as f64 + 0.3 * row as f64) / n as f64;
                let light = dark + (bright - dark) * along;
                let lit = (0.45 + 0.08 * (*value + noise * random.normal())) * light;
                *value = in_8_bits(255.0 * lit) / 255.0;
            }
        }
        match self.quality {
            Some(quality) => compressed(&picture, quality),
            None => picture,
        }
    }
}

pub(super) fn in_8_bits(level: f64) -> f64 {
    level.round().clamp(0.0, 255.0)
}

/// A Gaussian of standard deviation `sigma_px`; edges go on as they end.
pub(super) fn blurred(picture: &Grid<f64>, sigma_px: f64) -> Grid<f64> {
    if sigma_px <= 0.0 {
        return picture.clone();
    }
    let reach = (3.0 * sigma_px).ceil();
    let offsets = (0..=200_u8)
        .map(|i| f64::from(i) - reach)
        .take_while(|x| *x <= reach);
    let weights: Vec<f64> = offsets
        .map(|x| (-0.5 * (x / sigma_px).powi(2)).exp())
        .collect();
    let sum: f64 = weights.iter().sum();
    let half = weights.len() / 2;
    let along = |grid: &Grid<f64>| {
        let (width, height) = (grid.width(), grid.height());
        // Rows become columns, so that doing it twice blurs both ways.
        let mut turned = Grid::filled(height, width, 0.0);
        for row in 0..height {
            let values = grid.row(row);
            for column in 0..width {
                let at = |i: usize| values[(column + i).saturating_sub(half).min(width - 1)];
                let total: f64 = weights.iter().enumerate().map(|(i, w)| w * at(i)).sum();
                turned.row_mut(column)[row] = total / sum;
            }
        }
        turned
    };
    along(&along(picture))
}

/// The quantisation table for luminance of quality 50 (ITU-T T.81, annex K).
const TABLE: [[f64; 8]; 8] = [
    [16.0, 11.0, 10.0, 16.0, 24.0, 40.0, 51.0, 61.0],
    [12.0, 12.0, 14.0, 19.0, 26.0, 58.0, 60.0, 55.0],
    [14.0, 13.0, 16.0, 24.0, 40.0, 57.0, 69.0, 56.0],
    [14.0, 17.0, 22.0, 29.0, 51.0, 87.0, 80.0, 62.0],
    [18.0, 22.0, 37.0, 56.0, 68.0, 109.0, 103.0, 77.0],
    [24.0, 35.0, 55.0, 64.0, 81.0, 104.0, 113.0, 92.0],
    [49.0, 64.0, 78.0, 87.0, 103.0, 121.0, 120.0, 101.0],
    [72.0, 92.0, 95.0, 98.0, 112.0, 100.0, 103.0, 99.0],
];

type Block = [[f64; 8]; 8];

fn product(a: &Block, b: &Block) -> Block {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..8).map(|k| a[i][k] * b[k][j]).sum()))
}

fn turned(a: &Block) -> Block {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// What the quantisation of a JPEG leaves of a picture: cosine transforms of 8 × 8 pixels, rounded
/// to the steps of a quality. Coding itself loses nothing and is left out.
pub(super) fn compressed(picture: &Grid<f64>, quality: f64) -> Grid<f64> {
    let scale = if quality < 50.0 {
        50.0 / quality.max(1.0)
    } else {
        (2.0 - quality / 50.0).max(0.01)
    };
    let basis: Block = std::array::from_fn(|k| {
        std::array::from_fn(|i| {
            let norm = if k == 0 { 0.125_f64.sqrt() } else { 0.5 };
            norm * (PI * (2.0 * i as f64 + 1.0) * k as f64 / 16.0).cos()
        })
    });
    let across = turned(&basis);
    let (width, height) = (picture.width(), picture.height());
    let mut out = picture.clone();
    for top in (0..height).step_by(8) {
        for left in (0..width).step_by(8) {
            let at = |j: usize, i: usize| {
                let row = picture.row((top + j).min(height - 1));
                row[(left + i).min(width - 1)] * 255.0 - 128.0
            };
            let block: Block = std::array::from_fn(|j| std::array::from_fn(|i| at(j, i)));
            let mut spectrum = product(&product(&basis, &block), &across);
            for (x, step) in spectrum.iter_mut().flatten().zip(TABLE.iter().flatten()) {
                let step = (step * scale).round().max(1.0);
                *x = (*x / step).round() * step;
            }
            let again = product(&product(&across, &spectrum), &basis);
            for (j, values) in again.iter().enumerate().take(height - top) {
                for (i, x) in values.iter().enumerate().take(width - left) {
                    out.row_mut(top + j)[left + i] = in_8_bits(x + 128.0) / 255.0;
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_worse_quality_is_farther_from_the_picture_and_the_best_is_near() {
        let spoilt = Spoilt::usual(60);
        let picture = spoilt.picture(3, &Random::new(2)).luminance;
        let apart = |quality: f64| {
            let found = compressed(&picture, quality);
            let pairs = found.values().iter().zip(picture.values());
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let [best, middle, worst] = [100.0, 50.0, 5.0].map(apart);
        assert!(
            best < 0.02 && best < middle && middle < worst,
            "{best}, {middle}, {worst}"
        );
    }

    #[test]
    fn a_blur_keeps_the_mean_and_takes_the_contrast() {
        let step = |i: usize| if i % 40 < 20 { 0.2 } else { 0.8 };
        let picture = Grid::from_rows(40, (0..1600).map(step).collect()).unwrap();
        let soft = blurred(&picture, 4.0);
        let mean = soft.values().iter().sum::<f64>() / 1600.0;
        assert!((mean - 0.5).abs() < 1e-9, "{mean}");
        let edge = soft.row(20)[20] - soft.row(20)[19];
        assert!(edge > 0.0 && edge < 0.1, "{edge}");
    }

    #[test]
    fn drawings_repeat_by_their_lattices_and_by_nothing_between() {
        let mut random = Random::new(7);
        let mut drawings: Vec<Drawing> = BINDINGS.map(|w| w.drawing([9.0, 7.0], 0.3)).into();
        drawings.extend((0..3).map(|_| Drawing::oblique([12.0, 17.0], 0.4, &mut random)));
        for (number, drawing) in drawings.iter().enumerate() {
            let lattice = drawing.lattice();
            let apart = |shift: Place| {
                let places = (0..50_u8)
                    .map(|i| [0.31 + 1.37 * f64::from(i), 0.57 + 2.11 * f64::from(i % 7)]);
                let pair =
                    |p: Place| drawing.at(p) - drawing.at([p[0] + shift[0], p[1] + shift[1]]);
                places.map(|p| pair(p).abs()).fold(0.0, f64::max)
            };
            let most = apart(lattice.p1).max(apart(lattice.p2));
            assert!(most < 1e-9, "{number}: {most}");
            for [u, v] in [[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]] {
                assert!(apart(lattice.place([u, v])) > 0.05, "{number} between");
            }
        }
    }
}
