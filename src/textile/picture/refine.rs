//! Lattice vectors to a small fraction of a pixel: those for which the mean cell varies most.
//!
//! The variance of the folded tile is the sum of the powers of its harmonics. The harmonics of the
//! strongest few are summed over blocks of the picture once; for slightly other vectors the blocks
//! only turn in phase, so that a search costs next to nothing.

use std::f64::consts::TAU;

use super::basis::{Basis, Place, length};
use super::light::mean_and_variance;
use super::tile::Tile;
use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform, in_pieces};

/// Harmonics that are followed.
const N_HARMONICS: usize = 12;
/// Blocks along either side of the picture.
const N_BLOCKS: usize = 16;
/// Rounds: folding, and searching near the last vectors.
const N_ROUNDS: usize = 2;
/// Another round must promise more of the variance than this.
const MIN_GAIN: f64 = 1e-3;
/// A round ends when the vectors are known to this share of a pixel at the picture's edge.
const FINEST_PX: f64 = 1e-3;

impl Tile {
    /// The tile whose vectors near `basis` make the folded variance of a picture largest, and the
    /// share of the picture's variance that it explains.
    ///
    /// Never less than the tile of `basis`. `step` hears how far it is, 0…1, and may stop it.
    ///
    /// # Errors
    /// Those of `step`.
    pub fn refine<E>(
        luminance: &Grid<f64>,
        basis: Basis,
        n_threads: usize,
        mut step: impl FnMut(f64) -> Result<(), E>,
    ) -> Result<(Self, f64), E> {
        step(0.0)?;
        let mut best = Self::fold(luminance, basis, n_threads);
        let mut explained = best.explained_variance(luminance, n_threads);
        for round in 0..N_ROUNDS {
            let share = |part: f64| 0.2 + 0.8 * (round as f64 + part) / N_ROUNDS as f64;
            step(share(0.0))?;
            let harmonics = strongest(&best);
            let blocks = Blocks::of(luminance, &best.basis(), &harmonics, n_threads);
            step(share(0.5))?;
            let tile = Self::fold(luminance, blocks.search(), n_threads);
            let now = tile.explained_variance(luminance, n_threads);
            if now <= explained {
                break;
            }
            let gain = now - explained;
            (best, explained) = (tile, now);
            if gain < MIN_GAIN {
                break;
            }
        }
        Ok((best, explained))
    }
}

/// Orders (m, n) of the strongest harmonics of a tile, one of ± each, without the mean.
fn strongest(tile: &Tile) -> Vec<[f64; 2]> {
    let (nu, nv) = (tile.values.width(), tile.values.height());
    let spectrum = PlaneTransform::new(nu, nv).forward(&tile.values);
    let mut all: Vec<(f64, [f64; 2])> = Vec::new();
    for l in 0..nv {
        let n = if l <= nv / 2 {
            l as f64
        } else {
            l as f64 - nv as f64
        };
        for (k, x) in spectrum.row(l).iter().enumerate() {
            let is_half = k > 0 || n > 0.0;
            if is_half {
                all.push((x.norm_sqr(), [k as f64, n]));
            }
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all.into_iter()
        .take(N_HARMONICS)
        .map(|(_, order)| order)
        .collect()
}

/// A complex number for every harmonic, side by side so that all turn at once.
#[derive(Clone, Copy)]
struct Phasors {
    re: [f64; N_HARMONICS],
    im: [f64; N_HARMONICS],
}

impl Phasors {
    fn of(numbers: impl Iterator<Item = Complex>) -> Self {
        let mut all = Self {
            re: [0.0; N_HARMONICS],
            im: [0.0; N_HARMONICS],
        };
        for ((re, im), number) in all.re.iter_mut().zip(&mut all.im).zip(numbers) {
            (*re, *im) = (number.re, number.im);
        }
        all
    }

    /// `Σ (value − mean)·phasor`, the phasors turned by a step after every value.
    fn sum(mut self, steps: &Self, values: &[f64], mean: f64) -> Self {
        let mut sums = Self::of(std::iter::empty());
        for value in values {
            let value = value - mean;
            for h in 0..N_HARMONICS {
                sums.re[h] += value * self.re[h];
                sums.im[h] += value * self.im[h];
                let re = self.re[h] * steps.re[h] - self.im[h] * steps.im[h];
                self.im[h] = self.re[h] * steps.im[h] + self.im[h] * steps.re[h];
                self.re[h] = re;
            }
        }
        sums
    }
}

/// The sums of the strongest harmonics over blocks.
struct Blocks<'a> {
    basis: Basis,
    harmonics: &'a [[f64; 2]],
    centres: Vec<Place>,
    /// For every block, a number a harmonic.
    sums: Vec<Complex>,
    /// Half the diagonal of the picture, px.
    radius: f64,
}

impl<'a> Blocks<'a> {
    fn of(
        luminance: &Grid<f64>,
        basis: &Basis,
        harmonics: &'a [[f64; 2]],
        n_threads: usize,
    ) -> Self {
        let (width, height) = (luminance.width(), luminance.height());
        let side = [width.div_ceil(N_BLOCKS), height.div_ceil(N_BLOCKS)];
        let n = [width.div_ceil(side[0]), height.div_ceil(side[1])];
        let mean = mean_and_variance(luminance).0;
        let mut sums = vec![Complex::default(); n[0] * n[1] * harmonics.len()];
        let turn = |order: &[f64; 2], at: Place| {
            let [u, v] = basis.coordinates(at);
            Complex::from_polar(1.0, -TAU * (order[0] * u + order[1] * v).fract())
        };
        let steps = Phasors::of(harmonics.iter().map(|order| turn(order, [1.0, 0.0])));
        let piece = (n[0] * harmonics.len()).max(1);
        let work = |(): &mut (), band: usize, sums: &mut [Complex]| {
            for row in band * side[1]..((band + 1) * side[1]).min(height) {
                for (block, values) in luminance.row(row).chunks(side[0]).enumerate() {
                    let first = [(block * side[0]) as f64, row as f64];
                    let phasors = Phasors::of(harmonics.iter().map(|order| turn(order, first)));
                    let part = phasors.sum(&steps, values, mean);
                    let sums = &mut sums[block * harmonics.len()..];
                    for (h, sum) in sums.iter_mut().take(harmonics.len()).enumerate() {
                        *sum += Complex::new(part.re[h], part.im[h]);
                    }
                }
            }
        };
        in_pieces(&mut sums, piece, n_threads, || (), work);
        let middle = |k: usize, side: usize, whole: usize| {
            0.5 * (k * side + ((k + 1) * side).min(whole)) as f64
        };
        let blocks = (0..n[1]).flat_map(|j| (0..n[0]).map(move |i| (i, j)));
        let centres = blocks.map(|(i, j)| [middle(i, side[0], width), middle(j, side[1], height)]);
        Self {
            basis: *basis,
            harmonics,
            centres: centres.collect(),
            sums,
            radius: 0.5 * (width as f64).hypot(height as f64),
        }
    }

    /// The folded variance, up to a constant, with other vectors.
    fn variance(&self, basis: &Basis) -> f64 {
        let mut totals = [Complex::default(); N_HARMONICS];
        for (centre, sums) in self
            .centres
            .iter()
            .zip(self.sums.chunks(self.harmonics.len().max(1)))
        {
            let (then, now) = (self.basis.coordinates(*centre), basis.coordinates(*centre));
            let moved = [now[0] - then[0], now[1] - then[1]];
            for ((total, sum), order) in totals.iter_mut().zip(sums).zip(self.harmonics) {
                let turns = order[0] * moved[0] + order[1] * moved[1];
                *total += sum * Complex::from_polar(1.0, -TAU * turns);
            }
        }
        totals.iter().map(Complex::norm_sqr).sum()
    }

    /// Climbs from the first vectors with ever smaller steps, one coordinate after the other.
    fn search(&self) -> Basis {
        let mut at = self.basis;
        let mut best = self.variance(&at);
        // A step moves the lattice at the picture's edge by this much, px.
        let mut edge_px = 0.25 * at.shorter();
        while edge_px > FINEST_PX {
            let mut is_better = false;
            for axis in 0..4 {
                for sign in [1.0, -1.0] {
                    let mut next = at;
                    let vector = if axis < 2 { &mut next.p1 } else { &mut next.p2 };
                    let n_periods = (self.radius / length(*vector)).max(1.0);
                    vector[axis % 2] += sign * edge_px / n_periods;
                    let value = self.variance(&next);
                    if value > best {
                        (at, best, is_better) = (next, value, true);
                    }
                }
            }
            if !is_better {
                edge_px *= 0.5;
            }
        }
        at
    }
}
