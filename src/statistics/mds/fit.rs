//! How well a configuration fits: distances, disparities, the loss and its gradient.

use std::ops::Range;

use nalgebra::DMatrix;

use super::dissimilarities::Dissimilarities;
use super::monotone::{Regression, Ties};
use selvedge_foundation::named;

named! {
    /// What is made small.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Loss {
        /// Kruskal's stress-1, `√(Σ(d − d̂)² / Σd²)`.
        #[default]
        Stress1 = "stress1",
        /// The loss of ALSCAL, the same of squared distances: `√(Σ(d² − d̂²)² / Σd⁴)`. Large
        /// dissimilarities weigh more.
        SStress = "sstress",
    }
    /// Its name in files and commands.
    pub fn name;
}

/// The pairs in the order of their dissimilarities, and how ties among them are treated.
#[derive(Debug, Clone)]
pub(super) struct Problem {
    pub(super) n: usize,
    pub(super) pairs: Vec<[usize; 2]>,
    pub(super) weights: Vec<f64>,
    pub(super) deltas: Vec<f64>,
    blocks: Vec<Range<usize>>,
    ties: Ties,
    /// For the Guttman transform; `None` where all pairs are there and count alike.
    v_inverse: Option<DMatrix<f64>>,
}

impl Problem {
    pub(super) fn new(data: &Dissimilarities, ties: Ties) -> Self {
        let n = data.n_objects();
        let tied = data.tied_blocks();
        let mut blocks = Vec::with_capacity(tied.len());
        let mut end = 0;
        for block in &tied {
            blocks.push(end..end + block.len());
            end += block.len();
        }
        let flat: Vec<_> = tied.into_iter().flatten().collect();
        let total: f64 = flat.iter().map(|pair| pair.weight).sum();
        let scale = flat.len() as f64 / total;
        let weights: Vec<f64> = flat.iter().map(|pair| pair.weight * scale).collect();
        let pairs: Vec<[usize; 2]> = flat.iter().map(|pair| pair.objects).collect();
        let is_even = weights.iter().all(|w| (w - 1.0).abs() < 1e-12);
        let is_plain = is_even && data.n_missing() == 0;
        let v_inverse = (!is_plain).then(|| inverse(n, &pairs, &weights));
        Self {
            n,
            deltas: flat.iter().map(|pair| pair.delta).collect(),
            pairs,
            weights,
            blocks,
            ties,
            v_inverse,
        }
    }

    /// Coordinates `x` (n × k, row by row) scaled so that the mean square distance is 1.
    pub(super) fn normalise(&self, x: &mut [f64], k: usize) {
        let squares = self.pairs.iter().map(|pair| square_distance(x, *pair, k));
        let sum: f64 = squares.zip(&self.weights).map(|(d2, w)| w * d2).sum();
        let scale = (sum / self.pairs.len() as f64).sqrt();
        if scale > 0.0 {
            for value in x {
                *value /= scale;
            }
        }
    }
}

/// The inverse of the weights' Laplacian with the constants filled in.
fn inverse(n: usize, pairs: &[[usize; 2]], weights: &[f64]) -> DMatrix<f64> {
    let mut v = DMatrix::from_element(n, n, 1.0);
    for (&[i, j], w) in pairs.iter().zip(weights) {
        v[(i, j)] -= w;
        v[(j, i)] -= w;
        v[(i, i)] += w;
        v[(j, j)] += w;
    }
    // The pairs join all objects, so this matrix is positive definite.
    v.try_inverse().unwrap_or_else(|| DMatrix::identity(n, n))
}

fn square_distance(x: &[f64], [i, j]: [usize; 2], k: usize) -> f64 {
    let (a, b) = (&x[i * k..][..k], &x[j * k..][..k]);
    a.iter().zip(b).map(|(p, q)| (p - q) * (p - q)).sum()
}

/// Room to fit configurations of one problem.
#[derive(Debug, Clone)]
pub(super) struct Fit<'a> {
    pub(super) problem: &'a Problem,
    pub(super) k: usize,
    /// Distances, squared for S-stress.
    pub(super) d: Vec<f64>,
    /// Their monotone regression.
    pub(super) disparities: Vec<f64>,
    regression: Regression,
    moved: Vec<f64>,
}

impl<'a> Fit<'a> {
    pub(super) fn new(problem: &'a Problem, k: usize) -> Self {
        let m = problem.pairs.len();
        Self {
            problem,
            k,
            d: vec![0.0; m],
            disparities: vec![0.0; m],
            regression: Regression::new(m),
            moved: vec![0.0; problem.n * k],
        }
    }

    /// Forgets what earlier configurations left.
    pub(super) fn reset(&mut self) {
        self.regression.reset();
    }

    /// The square of the loss of `x`, 0…1; what it is made of stays in `d` and `disparities`.
    pub(super) fn loss(&mut self, loss: Loss, x: &[f64]) -> f64 {
        let [left, whole] = self.sums(loss, x);
        if whole > 0.0 { left / whole } else { 1.0 }
    }

    /// `Σw(d − d̂)²` and `Σwd²`.
    fn sums(&mut self, loss: Loss, x: &[f64]) -> [f64; 2] {
        let problem = self.problem;
        match self.k {
            1 => {
                for (d, &[i, j]) in self.d.iter_mut().zip(&problem.pairs) {
                    *d = (x[i] - x[j]).powi(2);
                }
            }
            k => {
                for (d, &pair) in self.d.iter_mut().zip(&problem.pairs) {
                    *d = square_distance(x, pair, k);
                }
            }
        }
        if loss == Loss::Stress1 {
            for d in &mut self.d {
                *d = d.sqrt();
            }
        }
        let given = (&self.d[..], &problem.weights[..]);
        let fitted = &mut self.disparities;
        self.regression
            .fit(problem.ties, given, &problem.blocks, fitted);
        let mut sums = [0.0; 2];
        for ((d, h), w) in self.d.iter().zip(&self.disparities).zip(&problem.weights) {
            sums[0] += w * (d - h) * (d - h);
            sums[1] += w * d * d;
        }
        sums
    }

    /// The square of the loss, and its gradient. Disparities are the best for the distances, so
    /// that only the distances are differentiated.
    pub(super) fn gradient(&mut self, loss: Loss, x: &[f64], gradient: &mut [f64]) -> f64 {
        let [left, whole] = self.sums(loss, x);
        gradient.fill(0.0);
        if whole <= 0.0 {
            return 1.0;
        }
        let (f, k) = (left / whole, self.k);
        let problem = self.problem;
        for (p, &[i, j]) in problem.pairs.iter().enumerate() {
            let (d, h) = (self.d[p], self.disparities[p]);
            let slope = 2.0 * problem.weights[p] * (d - h - f * d) / whole;
            let factor = match loss {
                Loss::Stress1 if d > 0.0 => slope / d,
                Loss::Stress1 => 0.0,
                Loss::SStress => 2.0 * slope,
            };
            for axis in 0..k {
                let push = factor * (x[i * k + axis] - x[j * k + axis]);
                gradient[i * k + axis] += push;
                gradient[j * k + axis] -= push;
            }
        }
        f
    }

    /// One step of majorisation (Guttman's transform) from `x`, whose distances and disparities
    /// [`Self::loss`] of stress-1 has just left.
    pub(super) fn guttman(&mut self, x: &mut [f64]) {
        let (problem, k) = (self.problem, self.k);
        self.moved.fill(0.0);
        for (p, &[i, j]) in problem.pairs.iter().enumerate() {
            let d = self.d[p];
            if d <= 0.0 {
                continue;
            }
            let factor = problem.weights[p] * self.disparities[p] / d;
            for axis in 0..k {
                let pull = factor * (x[i * k + axis] - x[j * k + axis]);
                self.moved[i * k + axis] += pull;
                self.moved[j * k + axis] -= pull;
            }
        }
        let n = problem.n;
        match &problem.v_inverse {
            None => {
                for (value, moved) in x.iter_mut().zip(&self.moved) {
                    *value = moved / n as f64;
                }
            }
            Some(inverse) => {
                for i in 0..n {
                    for axis in 0..k {
                        let column = |j: usize| inverse[(i, j)] * self.moved[j * k + axis];
                        x[i * k + axis] = (0..n).map(column).sum();
                    }
                }
            }
        }
        problem.normalise(x, k);
    }
}
