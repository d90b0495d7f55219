//! A map, and what it says of itself: its stress, point by point and pair by pair, and warnings.

use nalgebra::DMatrix;

use super::fit::{Fit, Loss, Problem};
use super::search::Lowest;
use crate::{Undefined, rank_correlation};

/// A squared loss share below this is degenerate: nothing is left to fit.
const NOTHING_LEFT: f64 = 1e-3;
/// Points nearer than this share of the mean distance stand on one place.
const SAME_PLACE: f64 = 0.01;

/// A map in so many dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Its dimensions.
    pub dims: usize,
    /// Stress-1 of these very points, 0…1.
    pub stress1: f64,
    /// S-stress of these very points, 0…1.
    pub sstress: f64,
    /// Coordinates, a row an object: centred, principal axes, the mean square distance 1.
    pub points: Vec<Vec<f64>>,
    /// Starts that were followed.
    pub n_starts: usize,
    /// Starts that reached the best loss, within 10⁻⁵ of it.
    pub n_reached: usize,
    /// The loss over the pairs of each object alone.
    pub stress_per_point: Vec<f64>,
    /// The share that the pairs of each object have in what is left over; they add up to 1. `None`
    /// where nothing is left over.
    pub share_per_point: Option<Vec<f64>>,
    /// Every pair, by rising dissimilarity.
    pub shepard: Vec<ShepardPoint>,
    /// Rank correlation of distances with dissimilarities (Spearman, mean ranks for ties).
    pub spearman: Result<f64, Undefined>,
    /// What a reader should know before trusting it.
    pub warnings: Vec<String>,
}

/// A pair in Shepard's diagram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShepardPoint {
    /// Indices of the two.
    pub objects: [usize; 2],
    /// How unlike they are.
    pub delta: f64,
    /// How far apart they stand.
    pub distance: f64,
    /// The distance that the order asks for.
    pub disparity: f64,
}

impl Map {
    pub(super) fn of(problem: &Problem, loss: Loss, k: usize, found: &Lowest) -> Self {
        let mut x = found.x.clone();
        problem.normalise(&mut x, k);
        let points = laid_down(&x, k);
        let flat = points.concat();
        let mut fit = Fit::new(problem, k);
        let mut loss_of = |loss| fit.loss(loss, &flat).max(0.0).sqrt();
        let other = match loss {
            Loss::Stress1 => Loss::SStress,
            Loss::SStress => Loss::Stress1,
        };
        let (second, first) = (loss_of(other), loss_of(loss));
        let (stress1, sstress) = match loss {
            Loss::Stress1 => (first, second),
            Loss::SStress => (second, first),
        };
        let shepard = shepard(&fit, loss);
        let (stress_per_point, share_per_point) = per_point(&fit);
        let deltas: Vec<f64> = shepard.iter().map(|pair| pair.delta).collect();
        let distances: Vec<f64> = shepard.iter().map(|pair| pair.distance).collect();
        let warnings = warnings(problem.n, k, first, &distances);
        Self {
            dims: k,
            stress1,
            sstress,
            points,
            n_starts: found.n_starts,
            n_reached: found.n_reached,
            stress_per_point,
            share_per_point,
            spearman: rank_correlation(&deltas, &distances),
            shepard,
            warnings,
        }
    }

    /// The loss of this name.
    pub fn loss(&self, loss: Loss) -> f64 {
        match loss {
            Loss::Stress1 => self.stress1,
            Loss::SStress => self.sstress,
        }
    }
}

fn shepard(fit: &Fit<'_>, loss: Loss) -> Vec<ShepardPoint> {
    let length = |value: f64| match loss {
        Loss::Stress1 => value,
        Loss::SStress => value.max(0.0).sqrt(),
    };
    let problem = fit.problem;
    let point = |p: usize| ShepardPoint {
        objects: problem.pairs[p],
        delta: problem.deltas[p],
        distance: length(fit.d[p]),
        disparity: length(fit.disparities[p]),
    };
    (0..problem.pairs.len()).map(point).collect()
}

fn per_point(fit: &Fit<'_>) -> (Vec<f64>, Option<Vec<f64>>) {
    let problem = fit.problem;
    let mut sums = vec![[0.0; 2]; problem.n];
    for (p, objects) in problem.pairs.iter().enumerate() {
        let (w, d, h) = (problem.weights[p], fit.d[p], fit.disparities[p]);
        for &object in objects {
            sums[object][0] += w * (d - h) * (d - h);
            sums[object][1] += w * d * d;
        }
    }
    let own = |[left, whole]: &[f64; 2]| {
        if *whole > 0.0 {
            (left / whole).sqrt()
        } else {
            0.0
        }
    };
    let total: f64 = sums.iter().map(|[left, _]| left).sum();
    let whole: f64 = sums.iter().map(|[_, whole]| whole).sum();
    let shares = || sums.iter().map(|[left, _]| left / total).collect();
    let is_left = total > 1e-20 * whole;
    (sums.iter().map(own).collect(), is_left.then(shares))
}

/// What makes a map worth little although its stress is low.
fn warnings(n: usize, k: usize, loss: f64, distances: &[f64]) -> Vec<String> {
    let mut out = Vec::new();
    if n <= 2 * k + 2 {
        out.push(format!(
            "{n} objects fit into {k} dimensions almost whatever the data are: low stress means \
             nothing here"
        ));
    } else if n < 4 * k + 1 {
        let least = 4 * k + 1;
        out.push(format!(
            "{k} dimensions ask for at least {least} objects, and there are {n}"
        ));
    }
    if loss < NOTHING_LEFT {
        out.push(
            "hardly any stress is left: the order of the dissimilarities may hold by few clusters \
             of points (degenerate); look at the map and at Shepard's diagram"
                .to_owned(),
        );
    }
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    let n_same = distances.iter().filter(|d| **d < SAME_PLACE * mean).count();
    let n_pairs = distances.len();
    if n_same * 5 > n_pairs {
        out.push(format!(
            "{n_same} of {n_pairs} pairs stand on one place: the points fall into clusters, and \
             what lies inside them is not shown"
        ));
    }
    out
}

/// Centres `x` (n × k), turns it to its principal axes, the longest first, and turns each axis so
/// that the coordinate farthest from 0 is positive (of several as far, the first).
fn laid_down(x: &[f64], k: usize) -> Vec<Vec<f64>> {
    let n = x.len() / k;
    let mut points = DMatrix::from_row_slice(n, k, x);
    for mut axis in points.column_iter_mut() {
        let mean = axis.mean();
        axis.add_scalar_mut(-mean);
    }
    let eigen = (points.transpose() * &points).symmetric_eigen();
    let mut by_size: Vec<usize> = (0..k).collect();
    by_size.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let turn = DMatrix::from_fn(k, k, |i, j| eigen.eigenvectors[(i, by_size[j])]);
    let mut turned = points * turn;
    for mut axis in turned.column_iter_mut() {
        let farthest = axis.amax();
        let is_far = |value: &&f64| value.abs() >= farthest * (1.0 - 1e-9);
        if axis.iter().find(is_far).is_some_and(|value| *value < 0.0) {
            axis.neg_mut();
        }
    }
    let rows = turned.row_iter();
    rows.map(|row| row.iter().copied().collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_and_mirrored_map_is_laid_down_alike() {
        let x = [0.0, 0.0, 5.0, 0.5, 9.0, -1.0, 3.0, 2.0, -1.0, -1.5];
        let (sin, cos) = 1.1_f64.sin_cos();
        let mut turned = Vec::new();
        for p in x.chunks_exact(2) {
            turned.push(7.0 + p[0] * cos - p[1] * sin);
            turned.push(-(p[0] * sin + p[1] * cos));
        }
        let (a, b) = (laid_down(&x, 2), laid_down(&turned, 2));
        for (p, q) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((p - q).abs() < 1e-12, "{a:?}\n{b:?}");
        }
        let spread = |axis: usize| a.iter().map(|p| p[axis].powi(2)).sum::<f64>();
        let across: f64 = a.iter().map(|p| p[0] * p[1]).sum();
        assert!(spread(0) > spread(1) && across.abs() < 1e-10, "{a:?}");
    }
}
