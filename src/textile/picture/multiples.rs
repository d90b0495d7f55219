//! Whether a lattice is too fine or too coarse by a small factor, and which one is right.
//!
//! A plain weave repeats *nearly* from thread to thread, and exactly from every second to every
//! second, like the black fields of a chess board. Finer lattices are tried by what the
//! autocorrelation is at halves and thirds of the vectors. A coarser one shows itself in two ways:
//! the highest maxima stand out by a clear gap and span it; or the heights at lattice points
//! alternate. The latter is a sum `S(q) = Σ ρ(d) cos 2π(q·index)` that peaks at a fraction q. A
//! slow decay with distance makes no such peak, however steep.

use std::f64::consts::{PI, TAU};

use super::autocorrelation::Autocorrelation;
use super::basis::{Basis, Place, generated, length, mix};
use super::candidates::{fit, tolerance_px};
use super::maxima::Maxima;
use super::significant::SignificantMaxima;

/// The coset of a finer lattice must be this share as high as the lattice itself.
const FINER_SHARE: f64 = 0.93;
/// The largest factor that alternating heights are looked for.
const MAX_FACTOR: isize = 6;
/// What alternation must add to the mean height, as a share of it: from every second point to every
/// second, and for each point skipped where it is more.
const MIN_GAIN_OF_TWO: f64 = 0.12;
const MIN_GAIN: f64 = 0.08;
/// How much higher the lowest of the high maxima must be than the highest of the others.
const CLEAR_GAP: f64 = 1.1;
/// Heights alternate within a Gaussian window that fades over this many periods.
const WINDOW_PERIODS: f64 = 14.0;
/// Rounds of making coarser.
const MAX_ROUNDS: usize = 4;

/// What a lattice is compared on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Evidence<'a> {
    pub(super) rho: &'a Autocorrelation,
    pub(super) maxima: &'a Maxima,
    pub(super) significant: &'a SignificantMaxima,
}

impl Evidence<'_> {
    /// The farthest shift that a lattice is judged by, px.
    fn farthest(&self) -> f64 {
        0.98 * self.rho.radius() - 2.0
    }

    /// Mean correlation at the lattice points within `reach`, each moved by `shift` (the origin
    /// too when moved); NaN of none.
    pub(super) fn level(&self, basis: &Basis, reach: f64, shift: Place) -> f64 {
        let mut places: Vec<Place> = basis
            .indices_within(reach)
            .iter()
            .map(|&[i, j]| basis.place([i as f64, j as f64]))
            .collect();
        if length(shift) > 0.0 {
            places.push([0.0; 2]);
        }
        let moved = places.into_iter().map(|p| mix(p, 1.0, shift, 1.0));
        let (n, sum) = moved
            .filter_map(|p| self.rho.between(p))
            .fold((0.0, 0.0), |(n, sum), x| (n + 1.0, sum + x));
        sum / n
    }

    /// How far the nearest few periods are, px.
    pub(super) fn near(&self, basis: &Basis) -> f64 {
        (3.2 * basis.longer()).min(0.95 * self.farthest())
    }

    /// Fits a basis anew, after its lattice was changed.
    fn refit(&self, basis: Basis) -> Basis {
        let reach = self
            .significant
            .reach_px()
            .max(3.0 * basis.longer())
            .min(self.farthest());
        fit(self.maxima, basis, reach, tolerance_px(&basis)).reduced()
    }
}

/// The finest lattice whose points are as high as those of `basis`: halves and thirds are tried.
pub(super) fn finer(evidence: &Evidence<'_>, basis: Basis) -> Basis {
    let mut basis = basis;
    for _ in 0..MAX_ROUNDS {
        let reach = evidence.near(&basis);
        let level = evidence.level(&basis, reach, [0.0; 2]);
        let fractions = [
            (2.0, [1.0, 0.0]),
            (2.0, [0.0, 1.0]),
            (2.0, [1.0, 1.0]),
            (3.0, [1.0, 0.0]),
            (3.0, [0.0, 1.0]),
            (3.0, [1.0, 1.0]),
            (3.0, [1.0, -1.0]),
        ];
        let found = fractions.iter().find_map(|&(n, [i, j])| {
            let part = basis.place([i / n, j / n]);
            let is_maximum = evidence
                .maxima
                .nearest(part, tolerance_px(&basis))
                .is_some();
            let is_high = evidence.level(&basis, reach, part) >= FINER_SHARE * level;
            let other = if i > 0.0 { basis.p2 } else { basis.p1 };
            let next = Basis::new(part, other).reduced();
            // The midpoints of the new vectors must be lower, or a ridge would be cut to pieces.
            let middle = evidence.level(&next, reach, part.map(|x| 0.5 * x));
            (is_maximum && is_high && middle < 0.8 * level).then_some(next)
        });
        match found {
            Some(next) => basis = evidence.refit(next),
            None => break,
        }
    }
    basis
}

/// The coarser lattice that the heights at the points of `basis` ask for, or `basis` itself.
pub(super) fn coarser(evidence: &Evidence<'_>, basis: Basis) -> Basis {
    let mut basis = basis;
    for _ in 0..MAX_ROUNDS {
        let rows = by_gap(evidence, &basis).or_else(|| by_alternation(evidence, &basis));
        let Some(next) = rows.map(|rows| basis.coarser(rows)) else {
            break;
        };
        if next.longer() > evidence.farthest() {
            break;
        }
        basis = evidence.refit(next);
    }
    basis
}

/// The lattice of the highest maxima on this one, if they stand out from all others by a gap.
fn by_gap(evidence: &Evidence<'_>, basis: &Basis) -> Option<[[isize; 2]; 2]> {
    let tolerance = tolerance_px(basis);
    let mut on: Vec<([isize; 2], f64)> = Vec::new();
    for [i, j] in basis.indices_within(evidence.farthest()) {
        let place = basis.place([i as f64, j as f64]);
        if let Some((found, _)) = evidence.maxima.nearest(place, tolerance) {
            on.push(([i, j], found.height));
        }
    }
    on.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut high: Vec<[isize; 2]> = Vec::new();
    for n in 1..on.len() {
        high.push(on[n - 1].0);
        if on[n - 1].1 < CLEAR_GAP * on[n].1 || n < 2 {
            continue;
        }
        let rows = generated(&high)?;
        let [[a, b], [_, d]] = rows;
        let is_part = |&[i, j]: &[isize; 2]| i % a == 0 && (j - i / a * b) % d == 0;
        let is_whole = on[n..].iter().all(|(index, _)| !is_part(index));
        if a * d > 1 && is_whole {
            return Some(rows);
        }
    }
    None
}

/// A lattice coarser by at most [`MAX_FACTOR`] by which the heights alternate.
fn by_alternation(evidence: &Evidence<'_>, basis: &Basis) -> Option<[[isize; 2]; 2]> {
    let heights = Heights::of(evidence, basis);
    let mean = heights.sum([0.0; 2]);
    if mean.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
        return None;
    }
    let mut found: Vec<(f64, isize, [[isize; 2]; 2])> = Vec::new();
    for factor in 2..=MAX_FACTOR {
        for rows in sublattices(factor) {
            let gains: Vec<f64> = fractions(rows)
                .iter()
                .map(|&q| heights.peak(q) / mean)
                .collect();
            let gain: f64 = gains.iter().sum();
            let lowest = gains.iter().copied().fold(f64::INFINITY, f64::min);
            let min = if factor == 2 {
                MIN_GAIN_OF_TWO
            } else {
                MIN_GAIN * factor as f64
            };
            if gain > min && lowest > -0.02 {
                found.push((gain, factor, rows));
            }
        }
    }
    let best = found.iter().map(|f| f.0).fold(0.0, f64::max);
    // The smallest factor that explains most of it: its multiples explain as much.
    found.into_iter().find(|f| f.0 >= 0.8 * best).map(|f| f.2)
}

/// Heights at lattice points in a window that fades.
struct Heights {
    points: Vec<(Place, f64)>,
    total: f64,
    /// The width of a peak of [`Self::sum`], and a bit.
    apart: Place,
}

impl Heights {
    fn of(evidence: &Evidence<'_>, basis: &Basis) -> Self {
        let wanted = evidence
            .significant
            .reach_px()
            .max(WINDOW_PERIODS * basis.longer());
        let holds = evidence.significant.fading_px().max(4.0 * basis.longer());
        let reach = wanted.min(holds).min(evidence.farthest());
        let mut points = Vec::new();
        let mut total = 0.0;
        for [i, j] in basis.indices_within(reach) {
            let index = [i as f64, j as f64];
            let place = basis.place(index);
            if let Some(height) = evidence.rho.between(place) {
                let weight = (-2.0 * (length(place) / reach).powi(2)).exp();
                points.push((index, weight * height));
                total += weight;
            }
        }
        let apart = [basis.p1, basis.p2].map(|p| 0.9 * length(p) / reach);
        Self {
            points,
            total,
            apart,
        }
    }

    fn sum(&self, q: Place) -> f64 {
        let term = |([i, j], h): &(Place, f64)| h * (TAU * (q[0] * i + q[1] * j)).cos();
        self.points.iter().map(term).sum::<f64>() / self.total
    }

    /// How much `S` is higher at q than anywhere around it.
    fn peak(&self, q: Place) -> f64 {
        let around = (0..8_u8).map(|i| {
            let (s, c) = (PI / 4.0 * f64::from(i)).sin_cos();
            self.sum([q[0] + self.apart[0] * c, q[1] + self.apart[1] * s])
        });
        self.sum(q) - around.fold(0.0, f64::max)
    }
}

/// All lattices of whole numbers that are coarser by a factor.
pub(super) fn sublattices(factor: isize) -> Vec<[[isize; 2]; 2]> {
    let divisors = (1..=factor).filter(|a| factor % a == 0);
    let rows = divisors.flat_map(|a| (0..factor / a).map(move |b| [[a, b], [0, factor / a]]));
    rows.collect()
}

/// The fractions q, other than 0, for which `q·index` is whole at every point of a coarser lattice.
fn fractions([[a, b], [_, d]]: [[isize; 2]; 2]) -> Vec<Place> {
    let (a, b, d) = (a as f64, b as f64, d as f64);
    let mut all = Vec::new();
    let mut l = 0.0;
    while l < d {
        let mut m = 0.0;
        while m < a {
            if l + m > 0.0 {
                all.push([(m - b * l / d) / a, l / d]);
            }
            m += 1.0;
        }
        l += 1.0;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_coarser_lattice_is_tried_and_its_fractions_are_whole_on_it() {
        let n: Vec<usize> = (2..=6).map(|factor| sublattices(factor).len()).collect();
        assert_eq!(n, [3, 4, 7, 6, 12]);
        for rows in sublattices(6) {
            let all = fractions(rows);
            assert_eq!(all.len(), 5);
            for q in all {
                for [i, j] in rows {
                    let turns = q[0] * i as f64 + q[1] * j as f64;
                    assert!((turns - turns.round()).abs() < 1e-12, "{rows:?}, {q:?}");
                }
            }
        }
    }
}
