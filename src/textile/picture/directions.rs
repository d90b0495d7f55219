//! The directions of the threads: where the maxima of the autocorrelation lie in lines.
//!
//! Seen along a lattice vector of length l the maxima fall onto lines A/l apart (A: area of a
//! cell), most crowded for the shortest vectors. Two measures of that, both reported:
//! *mean concentration* `c(φ) = n⁻² Σ_ij exp(−λ|x_i − x_j|)` of the offsets x from a line in
//! direction φ (Allerkamp et al.), and the votes of a *Hough* transform. Lengths are the first
//! maxima of a smoothed histogram along either direction.

use std::f64::consts::PI;

use super::basis::{Basis, Place, length, mix};
use super::significant::SignificantMaxima;
use selvedge_foundation::numerics::median;

/// Directions tried over half a turn.
const N_DIRECTIONS: usize = 720;
/// Of the maxima that count, the nearest are looked along.
const N_NEAREST: usize = 150;
/// Two directions of a basis differ by at least this, radians.
const MIN_APART: f64 = 0.2;

/// What [`Directions::of`] takes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DirectionOptions {
    /// λ of the mean concentration, 1/px; chosen from the maxima if not said.
    pub lambda_per_px: Option<f64>,
}

/// A measure of every direction and the two best.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The measure at directions 0 … π, evenly.
    pub curve: Vec<f64>,
    /// The two best directions, radians clockwise from x to the right (y is down).
    pub best: Option<[f64; 2]>,
    /// The lattice vectors of these directions and their lengths.
    pub basis: Option<Basis>,
}

/// Directions by both measures.
#[derive(Debug, Clone, PartialEq)]
pub struct Directions {
    /// λ that was used, 1/px.
    pub lambda_per_px: f64,
    /// By mean concentration.
    pub by_concentration: Measured,
    /// By votes of a Hough transform.
    pub by_hough: Measured,
}

impl Directions {
    /// Measures directions.
    pub fn of(significant: &SignificantMaxima, options: DirectionOptions) -> Self {
        let places = looked_along(significant);
        let lambda_per_px = lambda_per_px(&places, options);
        Self {
            lambda_per_px,
            by_concentration: Measured::by_concentration(significant, options),
            by_hough: Measured::by_hough(significant, options),
        }
    }
}

impl Measured {
    /// Directions by mean concentration alone.
    pub fn by_concentration(significant: &SignificantMaxima, options: DirectionOptions) -> Self {
        let places = looked_along(significant);
        let lambda = lambda_per_px(&places, options);
        let concentration = |offsets: &mut [f64]| mean_concentration(offsets, lambda);
        Self::of(&places, &concentration, 1.0 / lambda)
    }

    /// Directions by votes of a Hough transform alone.
    pub fn by_hough(significant: &SignificantMaxima, options: DirectionOptions) -> Self {
        let places = looked_along(significant);
        let width_px = 1.0 / lambda_per_px(&places, options);
        Self::of(&places, &|offsets| votes(offsets, width_px), width_px)
    }

    fn of(places: &[Place], measure: &dyn Fn(&mut [f64]) -> f64, width_px: f64) -> Self {
        let curve = curve(places, measure);
        let best = two_best(&curve);
        let basis = best.and_then(|best| with_lengths(best, places, width_px));
        Self { curve, best, basis }
    }
}

/// The nearest maxima that count, both of d and −d.
fn looked_along(significant: &SignificantMaxima) -> Vec<Place> {
    let half = significant.all().iter().take(N_NEAREST).map(|m| m.place);
    half.flat_map(|p| [p, p.map(|x| -x)]).collect()
}

/// λ that was asked for, or the one that the maxima suggest.
fn lambda_per_px(places: &[Place], options: DirectionOptions) -> f64 {
    let automatic = || 1.0 / automatic_width_px(places);
    options.lambda_per_px.unwrap_or_else(automatic)
}

/// `n⁻² Σ_ij exp(−λ|x_i − x_j|)`, exactly, in O(n log n): with the offsets sorted,
/// `S_i = exp(−λ(x_i − x_{i−1}))·(1 + S_{i−1})` sums all terms before i. Sorts in place; 0 of none.
pub(crate) fn mean_concentration(offsets: &mut [f64], lambda: f64) -> f64 {
    offsets.sort_by(f64::total_cmp);
    let n = offsets.len() as f64;
    let (mut sum, mut before) = (0.0, 0.0);
    for pair in offsets.windows(2) {
        before = (-lambda * (pair[1] - pair[0])).exp() * (1.0 + before);
        sum += before;
    }
    if n > 0.0 {
        (n + 2.0 * sum) / (n * n)
    } else {
        0.0
    }
}

/// Mean square share of votes in bins of `width`, each offset voting for the two nearest bins.
fn votes(offsets: &mut [f64], width: f64) -> f64 {
    offsets.sort_by(f64::total_cmp);
    let n = offsets.len() as f64;
    let (mut sum, mut here, mut next, mut bin) = (0.0, 0.0, 0.0, f64::NEG_INFINITY);
    for &offset in offsets.iter() {
        let (at, share) = ((offset / width).floor(), (offset / width).fract());
        let share = if share < 0.0 { share + 1.0 } else { share };
        while at > bin {
            sum += f64::powi(here, 2);
            (here, next) = (next, 0.0);
            bin = if here > 0.0 { bin + 1.0 } else { at };
        }
        here += 1.0 - share;
        next += share;
    }
    (sum + here * here + next * next) / (n * n).max(1.0)
}

/// 1/λ that the maxima suggest: a tenth of their usual distance, at least the width of a peak.
fn automatic_width_px(places: &[Place]) -> f64 {
    let nearest = |p: &Place| {
        let others = places.iter().map(|q| length(mix(*p, 1.0, *q, -1.0)));
        let first = others.filter(|&d| d > 1e-9).fold(f64::INFINITY, f64::min);
        first.min(length(*p))
    };
    let mut distances: Vec<f64> = places
        .iter()
        .map(nearest)
        .filter(|d| d.is_finite())
        .collect();
    let usual = median(&mut distances);
    if usual.is_finite() {
        (0.1 * usual).max(0.3)
    } else {
        1.0
    }
}

fn unit(angle: f64) -> Place {
    [angle.cos(), angle.sin()]
}

fn curve(places: &[Place], measure: &dyn Fn(&mut [f64]) -> f64) -> Vec<f64> {
    let mut offsets = vec![0.0; places.len()];
    let mut at = |i: usize| {
        let [c, s] = unit(PI * i as f64 / N_DIRECTIONS as f64);
        for (offset, place) in offsets.iter_mut().zip(places) {
            *offset = c * place[1] - s * place[0];
        }
        measure(&mut offsets)
    };
    (0..N_DIRECTIONS).map(&mut at).collect()
}

/// The two highest local maxima of a curve over half a turn that are far enough apart, refined by a
/// parabola.
fn two_best(curve: &[f64]) -> Option<[f64; 2]> {
    let n = curve.len();
    let value = |i: usize| curve[i % n];
    let is_peak = |&i: &usize| value(i) > value(i + n - 1) && value(i) >= value(i + 1);
    let mut peaks: Vec<usize> = (0..n).filter(is_peak).collect();
    peaks.sort_by(|&a, &b| value(b).total_cmp(&value(a)));
    let refined = |i: usize| {
        let (a, b, c) = (value(i + n - 1), value(i), value(i + 1));
        let bend = a - 2.0 * b + c;
        let shift = if bend < 0.0 {
            0.5 * (a - c) / bend
        } else {
            0.0
        };
        PI * (i as f64 + shift.clamp(-0.5, 0.5)) / n as f64
    };
    let first = refined(*peaks.first()?);
    let apart = |angle: f64| {
        let between = (angle - first).rem_euclid(PI);
        between.min(PI - between)
    };
    let mut others = peaks.into_iter().skip(1).map(refined);
    let second = others.find(|&angle| apart(angle) >= MIN_APART)?;
    Some([first, second])
}

/// The lattice vectors along two directions: every maximum is `s·d1 + t·d2`, and the first high
/// peak of the histogram of s (of t) is the length along d1 (d2).
fn with_lengths(best: [f64; 2], places: &[Place], width_px: f64) -> Option<Basis> {
    let frame = Basis::new(unit(best[0]), unit(best[1]));
    let along = |i: usize| {
        let all: Vec<f64> = places
            .iter()
            .map(|&p| frame.coordinates(p)[i].abs())
            .collect();
        first_peak(&all, width_px)
    };
    let (s, t) = (along(0)?, along(1)?);
    Some(Basis::new(frame.p1.map(|x| x * s), frame.p2.map(|x| x * t)))
}

/// The first local maximum of a histogram smoothed by a Gaussian that is at least 0.6 as high as
/// the highest; what lies within three widths of 0 is no period.
fn first_peak(values: &[f64], width: f64) -> Option<f64> {
    let longest = values.iter().copied().fold(0.0, f64::max);
    let step = 0.25 * width;
    let density = |x: f64| -> f64 {
        let term = |v: &f64| (-0.5 * ((v - x) / width).powi(2)).exp();
        values.iter().map(term).sum()
    };
    let n = (longest / step).min(4000.0);
    let places = (1..).map(|i| 3.0 * width + f64::from(i) * step);
    let curve: Vec<[f64; 2]> = places
        .take_while(|&x| x < step * n)
        .map(|x| [x, density(x)])
        .collect();
    let highest = curve.iter().map(|p| p[1]).fold(0.0, f64::max);
    let peak = curve.windows(3).find(|w| {
        let is_peak = w[1][1] > w[0][1] && w[1][1] >= w[2][1];
        is_peak && w[1][1] >= 0.6 * highest
    });
    peak.map(|w| w[1][0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    #[test]
    fn mean_concentration_is_the_double_sum() {
        let mut random = Random::new(4);
        let mut offsets: Vec<f64> = (0..40).map(|_| random.uniform_in(-9.0, 9.0)).collect();
        let pairs = offsets
            .iter()
            .flat_map(|a| offsets.iter().map(move |b| (a - b).abs()));
        let slow = pairs.map(|d| (-0.7 * d).exp()).sum::<f64>() / 1600.0;
        let fast = mean_concentration(&mut offsets, 0.7);
        assert!((fast - slow).abs() < 1e-13, "{fast} and {slow}");
        assert_eq!(mean_concentration(&mut [], 1.0), 0.0);
    }

    #[test]
    fn both_measures_find_the_shortest_vectors_of_scattered_lattices() {
        for (p1, p2) in [
            ([12.0, 0.0], [0.0, 12.0]),
            ([9.0, 1.0], [-3.0, 25.0]),
            ([20.0, 3.0], [8.0, 19.0]),
            ([11.0, 6.0], [-11.0, 7.0]),
        ] {
            let truth = Basis::new(p1, p2);
            let mut random = Random::new(9);
            let mut jitter = |p: Place| p.map(|x| x + 0.3 * random.normal());
            let inside = truth.indices_within(110.0).into_iter();
            let half: Vec<Place> = inside
                .map(|[i, j]| jitter(truth.place([i as f64, j as f64])))
                .collect();
            let places: Vec<Place> = half.iter().flat_map(|&p| [p, p.map(|x| -x)]).collect();
            let width = automatic_width_px(&places);
            for measure in [
                &(|x: &mut [f64]| mean_concentration(x, 1.0 / width)) as &dyn Fn(&mut [f64]) -> f64,
                &|x: &mut [f64]| votes(x, width),
            ] {
                let best = two_best(&curve(&places, measure)).unwrap();
                let found = with_lengths(best, &places, width).unwrap();
                let off = truth.distance_to(&found.reduced());
                assert!(
                    off < 0.06 * truth.shorter(),
                    "{truth:?}: {found:?}, off {off}"
                );
            }
        }
    }
}
