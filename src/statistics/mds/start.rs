//! Where a search begins: Torgerson's classical scaling, and chance.

use nalgebra::DMatrix;

use super::fit::Problem;
use selvedge_foundation::numerics::Random;

/// Classical scaling (Torgerson): the eigenvectors of the doubly centred squares. Missing pairs
/// take the shortest way over others. n × k, row by row.
pub(super) fn torgerson(problem: &Problem, k: usize) -> Vec<f64> {
    let n = problem.n;
    let squares = complete(problem).map(|delta| delta * delta);
    let mean_row: Vec<f64> = (0..n).map(|i| squares.row(i).mean()).collect();
    let mean = squares.mean();
    let centred = DMatrix::from_fn(n, n, |i, j| {
        -0.5 * (squares[(i, j)] - mean_row[i] - mean_row[j] + mean)
    });
    let eigen = centred.symmetric_eigen();
    let mut by_size: Vec<usize> = (0..n).collect();
    by_size.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let largest = eigen.eigenvalues[by_size[0]].max(f64::MIN_POSITIVE);
    let mut x = vec![0.0; n * k];
    for (axis, &column) in by_size.iter().take(k).enumerate() {
        // An axis without extent would stay flat for ever.
        let length = eigen.eigenvalues[column].max(1e-4 * largest).sqrt();
        for i in 0..n {
            x[i * k + axis] = length * eigen.eigenvectors[(i, column)];
        }
    }
    x
}

/// All dissimilarities; those that are missing by the shortest way.
fn complete(problem: &Problem) -> DMatrix<f64> {
    let n = problem.n;
    let mut all = DMatrix::from_element(n, n, f64::INFINITY);
    all.fill_diagonal(0.0);
    for (&[i, j], &delta) in problem.pairs.iter().zip(&problem.deltas) {
        all[(i, j)] = delta;
        all[(j, i)] = delta;
    }
    if problem.pairs.len() == n * (n - 1) / 2 {
        return all;
    }
    let mut ways = all.clone();
    for via in 0..n {
        for i in 0..n {
            for j in 0..n {
                let detour = ways[(i, via)] + ways[(via, j)];
                ways[(i, j)] = ways[(i, j)].min(detour);
            }
        }
    }
    all.zip_map(
        &ways,
        |known, way| if known.is_finite() { known } else { way },
    )
}

/// Points thrown at random, normal along every axis.
pub(super) fn thrown(n: usize, k: usize, random: &mut Random) -> Vec<f64> {
    (0..n * k).map(|_| random.normal()).collect()
}

/// A map of one dimension less, with a little chance along the new axis.
pub(super) fn raised(lower: &[f64], k: usize, random: &mut Random) -> Vec<f64> {
    let mut x = Vec::with_capacity(lower.len() / (k - 1).max(1) * k);
    for point in lower.chunks_exact(k - 1) {
        x.extend_from_slice(point);
        x.push(0.05 * random.normal());
    }
    x
}
