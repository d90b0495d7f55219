//! Lattice vectors to a small fraction of a pixel: those for which the mean cell varies most.
//!
//! The variance of the folded tile is the sum of the powers of its harmonics. The first and the
//! strongest few are summed over blocks of the picture once; for slightly other vectors the blocks
//! only turn in phase, so that a search costs next to nothing.

use std::f64::consts::TAU;

use super::basis::{Basis, Place, length, mix};
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
/// No wave moves by more turns than this over the longer vector: that would be another lattice.
const MAX_MOVE: f64 = 0.25;
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
            let harmonics = followed(&best);
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

/// Orders (m, n) of harmonics of a tile, one of ± each, without the mean: the first ones, without
/// which a vector along strong ribs would be free, and the strongest.
fn followed(tile: &Tile) -> Vec<[f64; 2]> {
    let (nu, nv) = (tile.values.width(), tile.values.height());
    let spectrum = PlaneTransform::new(nu, nv).forward(&tile.values);
    let mut all: Vec<(bool, f64, [f64; 2])> = Vec::new();
    for l in 0..nv {
        let n = if l <= nv / 2 {
            l as f64
        } else {
            l as f64 - nv as f64
        };
        for (k, x) in spectrum.row(l).iter().enumerate() {
            let is_half = k > 0 || n > 0.0;
            if is_half {
                all.push((k <= 1 && n.abs() <= 1.0, x.norm_sqr(), [k as f64, n]));
            }
        }
    }
    all.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.total_cmp(&a.1)));
    let orders = all.into_iter().map(|(_, _, order)| order);
    orders.take(N_HARMONICS).collect()
}

/// How far the two waves of a lattice are moved, turns a pixel along x and y.
type Waves = [Place; 2];

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

/// The sums of the harmonics that are followed over blocks.
struct Blocks<'a> {
    basis: Basis,
    harmonics: &'a [[f64; 2]],
    /// Where the columns and the rows of blocks have their middles, px.
    middles: [Vec<f64>; 2],
    /// For every block, row by row, a number a harmonic.
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
        let middles = [(n[0], side[0], width), (n[1], side[1], height)].map(|(n, side, whole)| {
            let ends = (0..n).map(|k| k * side + ((k + 1) * side).min(whole));
            ends.map(|ends| 0.5 * ends as f64).collect()
        });
        Self {
            basis: *basis,
            harmonics,
            middles,
            sums,
            radius: 0.5 * (width as f64).hypot(height as f64),
        }
    }

    /// The folded variance, up to a constant, with waves moved by so many turns a pixel, of
    /// harmonics of orders up to `max_order`.
    fn variance(&self, moved: &Waves, max_order: f64) -> f64 {
        let [columns, rows] = [0, 1].map(|axis| {
            let phasors = self.middles[axis].iter().map(|middle| {
                Phasors::of(self.harmonics.iter().map(|order| {
                    if order[0].max(order[1].abs()) > max_order {
                        return Complex::default();
                    }
                    let turns = mix(moved[0], order[0], moved[1], order[1])[axis] * middle;
                    Complex::from_polar(1.0, -TAU * turns)
                }))
            });
            phasors.collect::<Vec<_>>()
        });
        let mut blocks = self.sums.iter();
        let mut totals = Phasors::of(std::iter::empty());
        for row in &rows {
            let mut along = Phasors::of(std::iter::empty());
            for column in &columns {
                for (h, sum) in blocks.by_ref().take(self.harmonics.len()).enumerate() {
                    along.re[h] += sum.re * column.re[h] - sum.im * column.im[h];
                    along.im[h] += sum.re * column.im[h] + sum.im * column.re[h];
                }
            }
            for h in 0..N_HARMONICS {
                totals.re[h] += along.re[h] * row.re[h] - along.im[h] * row.im[h];
                totals.im[h] += along.re[h] * row.im[h] + along.im[h] * row.re[h];
            }
        }
        let powers = totals.re.iter().zip(&totals.im);
        powers.map(|(re, im)| re * re + im * im).sum()
    }

    /// Climbs from the first vectors with ever smaller steps, one coordinate of the two waves after
    /// the other: what lies along strong ribs is then found apart from them. A harmonic counts from
    /// where a step moves it by less than half a turn at the picture's edge.
    fn search(&self) -> Basis {
        let mut moved = [[0.0; 2]; 2];
        let (shorter_px, longer_px) = (self.basis.shorter(), self.basis.longer());
        let mut turns = 0.25;
        while turns * shorter_px > FINEST_PX {
            let max_order = 0.5 / turns;
            let mut best = self.variance(&moved, max_order);
            let mut is_better = true;
            while is_better {
                is_better = false;
                for axis in 0..4 {
                    for sign in [1.0, -1.0] {
                        let mut next = moved;
                        next[axis / 2][axis % 2] += sign * turns / self.radius;
                        if length(next[axis / 2]) * longer_px > MAX_MOVE {
                            continue;
                        }
                        let value = self.variance(&next, max_order);
                        if value > best {
                            (moved, best, is_better) = (next, value, true);
                        }
                    }
                }
            }
            turns *= 0.5;
        }
        let waves = self.basis.dual();
        Basis::new(
            mix(waves.p1, 1.0, moved[0], 1.0),
            mix(waves.p2, 1.0, moved[1], 1.0),
        )
        .dual()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn strong_ribs_leave_the_vector_along_them_neither_free_nor_far_away() {
        // Ribs of twelve harmonics across, a faint repeat along them.
        let mut random = Random::new(5);
        let (across, along) = (16.7, 15.6);
        let places = (0..300 * 300).map(|i| [f64::from(i % 300), f64::from(i / 300)]);
        let values = places.map(|[x, y]| {
            let ribs: f64 = (1..=14_u8)
                .map(|n| (TAU * f64::from(n) * y / across).cos() / f64::from(n))
                .sum();
            0.5 + 0.1 * ribs + 0.01 * (TAU * x / along).cos() + 0.05 * random.normal()
        });
        let picture = Grid::from_rows(300, values.collect()).unwrap();
        let about = Basis::new([along + 0.3, 0.1], [0.4, across - 0.1]);
        let refined = Tile::refine(&picture, about, 2, |_| Ok::<_, ()>(()));
        let (tile, _) = refined.unwrap();
        let off = |vector: Place, to: Place| length(mix(vector, 1.0, to, -1.0));
        assert!(off(tile.p1_px, [along, 0.0]) < 0.1, "{:?}", tile.p1_px);
        assert!(off(tile.p2_px, [0.0, across]) < 0.1, "{:?}", tile.p2_px);
    }
}
