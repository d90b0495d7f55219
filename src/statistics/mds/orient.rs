//! One way to lay a map down: centred, along its principal axes, signs fixed.

use nalgebra::DMatrix;

/// Centres `x` (n × k), turns it to its principal axes, the longest first, and turns each axis so
/// that the coordinate farthest from 0 is positive (of several as far, the first).
pub(super) fn laid_down(x: &[f64], k: usize) -> Vec<Vec<f64>> {
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
