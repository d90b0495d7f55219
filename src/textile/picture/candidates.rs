//! Lattices that the maxima of the autocorrelation may lie on, and how well they do.
//!
//! A lattice explains the maxima if they lie on it (`cover`) and if its points are maxima
//! (`hit`): a finer one than the true one misses maxima, a coarser one leaves them over. The
//! harmonic mean of the two ranks candidates from the directions and from all pairs of near,
//! lonely and high maxima.

use super::basis::{Basis, Place, length, mix};
use super::maxima::Maxima;
use super::significant::{SHORTEST_PX, Significant, SignificantMaxima};
use selvedge_foundation::named;

/// A lattice whose angle has a smaller sine than this is no lattice of threads.
pub(super) const MIN_SINE: f64 = 0.2;
/// Shares are raised to this power, so that maxima as high as the highest count most.
const POWER: i32 = 4;
/// A candidate is judged as far out as this many times its longer vector.
const JUDGED_PERIODS: f64 = 6.0;
/// Maxima taken by each rule to make pairs of.
const N_NEAR: usize = 30;
const N_LONELY: usize = 14;
const N_HIGH: usize = 14;

named! {
    /// What proposed a lattice.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Method {
        /// Directions by mean concentration, lengths by histogram.
        MeanConcentration = "mean concentration",
        /// Directions by Hough transform, lengths by histogram.
        Hough = "hough",
        /// A pair of maxima.
        Pair = "pair of maxima",
    }
    /// Its name in files.
    pub fn name;
}

/// A lattice fitted to the maxima, and how well it explains them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    pub(super) basis: Basis,
    /// Weighted share of the maxima that lie on the lattice.
    pub(super) cover: f64,
    /// Share of its points that are maxima.
    pub(super) hit: f64,
}

impl Candidate {
    /// Harmonic mean of cover and hit, 0…1.
    pub(super) fn score(&self) -> f64 {
        let sum = self.cover + self.hit;
        if sum > 0.0 {
            2.0 * self.cover * self.hit / sum
        } else {
            0.0
        }
    }
}

/// How far a maximum may be from a lattice point, px.
pub(super) fn tolerance_px(basis: &Basis) -> f64 {
    (0.15 * basis.shorter()).clamp(0.6, 4.0)
}

/// Fits a basis to the maxima near its points, from the origin outwards to `reach` px, so that a
/// slight error of the start does not lose count far out. Weights are the heights.
pub(super) fn fit(maxima: &Maxima, start: Basis, reach: f64, tolerance: f64) -> Basis {
    let mut basis = start;
    let mut radius = 1.6 * basis.longer();
    loop {
        let within = radius.min(reach);
        // Normal equations of Σ w |i·p1 + j·p2 − x|².
        let mut sums = [0.0; 7];
        for [i, j] in basis.indices_within(within) {
            let (i, j) = (i as f64, j as f64);
            if let Some((found, _)) = maxima.nearest(basis.place([i, j]), tolerance) {
                let (w, [x, y]) = (found.height, found.place);
                let terms = [i * i, i * j, j * j, i * x, i * y, j * x, j * y];
                for (sum, term) in sums.iter_mut().zip(terms) {
                    *sum += w * term;
                }
            }
        }
        let [ii, ij, jj, ix, iy, jx, jy] = sums;
        let determinant = ii * jj - ij * ij;
        if determinant > 1e-6 * (ii + jj).powi(2) {
            let solve = |a: f64, b: f64| {
                [
                    (jj * a - ij * b) / determinant,
                    (ii * b - ij * a) / determinant,
                ]
            };
            let ([x1, x2], [y1, y2]) = (solve(ix, jx), solve(iy, jy));
            basis = Basis::new([x1, y1], [x2, y2]);
        }
        if radius >= reach {
            return basis;
        }
        radius *= 1.5;
    }
}

/// Fits and judges a start; `None` if what comes out is no lattice of threads.
pub(super) fn judge(
    maxima: &Maxima,
    significant: &SignificantMaxima,
    start: Basis,
    longest: f64,
) -> Option<Candidate> {
    let start = start.reduced();
    let is_sound =
        |b: &Basis| b.shorter() >= SHORTEST_PX && b.longer() <= longest && b.sine() >= MIN_SINE;
    if !is_sound(&start) {
        return None;
    }
    let reach = significant.reach_px().min(JUDGED_PERIODS * start.longer());
    let basis = fit(maxima, start, reach, tolerance_px(&start)).reduced();
    if !is_sound(&basis) {
        return None;
    }
    let tolerance = tolerance_px(&basis);
    let (mut on, mut all) = (0.0, 0.0);
    for maximum in significant
        .all()
        .iter()
        .take_while(|m| length(m.place) <= reach)
    {
        let weight = maximum.share.powi(POWER);
        all += weight;
        if is_on(&basis, maximum.place, tolerance) {
            on += weight;
        }
    }
    let points = basis.indices_within(reach);
    let is_hit = |&&[i, j]: &&[isize; 2]| {
        maxima
            .nearest(basis.place([i as f64, j as f64]), tolerance)
            .is_some()
    };
    let n_hit = points.iter().filter(is_hit).count();
    (all > 0.0 && !points.is_empty()).then(|| Candidate {
        basis,
        cover: on / all,
        hit: n_hit as f64 / points.len() as f64,
    })
}

/// Whether a place is a point of a lattice other than the origin.
fn is_on(basis: &Basis, place: Place, tolerance: f64) -> bool {
    let index = basis.coordinates(place).map(f64::round);
    let is_origin = index.iter().all(|x| x.abs() < 0.5);
    !is_origin && length(mix(place, 1.0, basis.place(index), -1.0)) <= tolerance
}

/// Candidates from all pairs of the maxima that are nearest, dominate most or are highest at their
/// distance.
pub(super) fn pairs(significant: &SignificantMaxima) -> Vec<Basis> {
    let all = significant.all();
    let mut chosen: Vec<usize> = (0..all.len().min(N_NEAR)).collect();
    let mut best_by = |key: &dyn Fn(&Significant) -> f64, n: usize| {
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|&a, &b| key(&all[b]).total_cmp(&key(&all[a])));
        chosen.extend(order.into_iter().take(n));
    };
    best_by(&|m| m.dominance_px, N_LONELY);
    best_by(&|m| m.share, N_HIGH);
    chosen.sort_unstable();
    chosen.dedup();
    let mut bases: Vec<Basis> = Vec::new();
    for (n, &i) in chosen.iter().enumerate() {
        for &j in &chosen[..n] {
            let basis = Basis::new(all[i].place, all[j].place).reduced();
            let is_known = |known: &Basis| {
                let near = |a: Place, b: Place| length(mix(a, 1.0, b, -1.0)) < 0.5;
                near(known.p1, basis.p1) && near(known.p2, basis.p2)
            };
            if !bases.iter().any(is_known) {
                bases.push(basis);
            }
        }
    }
    bases
}
