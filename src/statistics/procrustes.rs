//! How alike two configurations are after moving, turning and scaling: orthogonal Procrustes.
//!
//! Both are centred; `X` (n × k) is turned by the orthogonal `R` (reflections allowed) and scaled
//! by `s` so that `Σ|s·X·R − Y|²` is smallest: with `XᵀY = UΣVᵀ`, `R = UVᵀ` and
//! `s = trace(Σ)/|X|²`. `m² = 1 − (trace Σ)²/(|X|²|Y|²)` is the same both ways.

use nalgebra::DMatrix;

use crate::{Undefined, undefined};
use selvedge_foundation::numerics::Random;

/// One configuration laid over another.
#[derive(Debug, Clone, PartialEq)]
pub struct Procrustes {
    /// What is left over, 0 (alike) … 1.
    pub m2: f64,
    /// Factor by which the moved one was scaled.
    pub scale: f64,
    /// The turn, k × k, row by row: moved = scale · centred · turn + shift.
    pub turn: Vec<Vec<f64>>,
    /// The moved one, over the target.
    pub moved: Vec<Vec<f64>>,
}

impl Procrustes {
    /// Lays `source` over `target`: as many points; fewer axes are filled up with 0.
    ///
    /// # Errors
    /// Unequal numbers of points, none, numbers that are not finite, or all points on one place.
    pub fn of(source: &[Vec<f64>], target: &[Vec<f64>]) -> Result<Self, Undefined> {
        let k = width(source).max(width(target));
        let (x, _) = centred(source, k)?;
        let (y, middle) = centred(target, k)?;
        if x.nrows() != y.nrows() {
            let (n, m) = (x.nrows(), y.nrows());
            return undefined(format!("{n} points against {m}"));
        }
        let svd = (x.transpose() * &y).svd(true, true);
        let (Some(u), Some(v)) = (svd.u, svd.v_t) else {
            return undefined("the configurations have no turn");
        };
        let trace = svd.singular_values.sum();
        let turn = u * v;
        let (xx, yy) = (x.norm_squared(), y.norm_squared());
        let scale = trace / xx;
        let mut moved = &x * &turn * scale;
        for (mut axis, mean) in moved.column_iter_mut().zip(&middle) {
            axis.add_scalar_mut(*mean);
        }
        Ok(Self {
            m2: (1.0 - trace * trace / (xx * yy)).clamp(0.0, 1.0),
            scale,
            turn: rows(&turn),
            moved: rows(&moved),
        })
    }

    /// How often chance lays the points as well (PROTEST, Jackson 1995): rows of `source` are dealt
    /// anew `n_permutations` times; (b + 1)/(N + 1).
    ///
    /// # Errors
    /// As [`Procrustes::of`].
    pub fn protest(
        source: &[Vec<f64>],
        target: &[Vec<f64>],
        n_permutations: usize,
        random: &mut Random,
    ) -> Result<f64, Undefined> {
        let own = Self::of(source, target)?.m2;
        let mut dealt = source.to_vec();
        let mut n_as_good = 0;
        for _ in 0..n_permutations {
            random.shuffle(&mut dealt);
            if Self::of(&dealt, target)?.m2 <= own + 1e-12 {
                n_as_good += 1;
            }
        }
        Ok(f64::from(n_as_good + 1) / (n_permutations + 1) as f64)
    }
}

fn width(points: &[Vec<f64>]) -> usize {
    points.iter().map(Vec::len).max().unwrap_or(0)
}

/// The points as a matrix about their middle, and the middle.
fn centred(points: &[Vec<f64>], k: usize) -> Result<(DMatrix<f64>, Vec<f64>), Undefined> {
    if points.is_empty() || k == 0 {
        return undefined("there are no points");
    }
    let at = |i: usize, axis: usize| points[i].get(axis).copied().unwrap_or(0.0);
    let mut matrix = DMatrix::from_fn(points.len(), k, at);
    if matrix.iter().any(|x| !x.is_finite()) {
        return undefined("a coordinate is not finite");
    }
    let size = matrix.amax();
    let mut middle = Vec::with_capacity(k);
    for mut axis in matrix.column_iter_mut() {
        let mean = axis.mean();
        axis.add_scalar_mut(-mean);
        middle.push(mean);
    }
    if matrix.amax() <= 1e-14 * size {
        return undefined("all points stand on one place");
    }
    Ok((matrix, middle))
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let row = |i: usize| matrix.row(i).iter().copied().collect();
    (0..matrix.nrows()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thrown(n: usize, seed: u64) -> Vec<Vec<f64>> {
        let mut random = Random::new(seed);
        (0..n)
            .map(|_| vec![random.normal(), random.normal()])
            .collect()
    }

    #[test]
    fn a_turned_mirrored_and_scaled_map_is_laid_over_itself() {
        let target = thrown(9, 1);
        let (sin, cos) = 0.7_f64.sin_cos();
        let source: Vec<Vec<f64>> = target
            .iter()
            .map(|p| {
                vec![
                    3.0 + 0.2 * (p[0] * cos + p[1] * sin),
                    0.2 * (p[0] * sin - p[1] * cos),
                ]
            })
            .collect();
        let found = Procrustes::of(&source, &target).unwrap();
        assert!(
            found.m2 < 1e-12 && (found.scale - 5.0).abs() < 1e-12,
            "{found:?}"
        );
        for (p, q) in found.moved.iter().flatten().zip(target.iter().flatten()) {
            assert!((p - q).abs() < 1e-12, "{p} or {q}");
        }
    }

    /// Independent: in a plane the best turn by trying 20 000 of them, both ways round.
    #[test]
    fn no_turn_leaves_less_over_and_both_ways_are_alike() {
        let (a, b) = (thrown(7, 2), thrown(7, 3));
        let found = Procrustes::of(&a, &b).unwrap();
        let back = Procrustes::of(&b, &a).unwrap();
        assert!(
            (found.m2 - back.m2).abs() < 1e-12,
            "{} {}",
            found.m2,
            back.m2
        );
        let (x, _) = centred(&a, 2).unwrap();
        let (y, _) = centred(&b, 2).unwrap();
        let mut least = f64::INFINITY;
        for step in 0..20_000 {
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 20_000.0).sin_cos();
            for side in [1.0, -1.0] {
                let turn = DMatrix::from_row_slice(2, 2, &[cos, sin * side, -sin, cos * side]);
                let turned = &x * turn;
                let scale = turned.dot(&y) / x.norm_squared();
                least = least.min((turned * scale - &y).norm_squared() / y.norm_squared());
            }
        }
        assert!(
            found.m2 <= least && least - found.m2 < 1e-6,
            "{} {least}",
            found.m2
        );
    }

    #[test]
    fn chance_rarely_lays_a_noisy_copy_as_well_but_often_a_stranger() {
        let target = thrown(12, 4);
        let mut random = Random::new(5);
        let noisy: Vec<Vec<f64>> = target
            .iter()
            .map(|p| p.iter().map(|x| x + 0.2 * random.normal()).collect())
            .collect();
        let p = Procrustes::protest(&noisy, &target, 199, &mut random).unwrap();
        assert!((p - 1.0 / 200.0).abs() < 1e-12, "{p}");
        let n_low = (0..40)
            .filter(|i| {
                Procrustes::protest(&thrown(8, 100 + i), &target[..8], 39, &mut random).unwrap()
                    <= 0.1
            })
            .count();
        assert!((1..=9).contains(&n_low), "{n_low} of 40 at the 10 % level");
    }

    #[test]
    fn what_has_no_answer_says_why() {
        let points = thrown(4, 1);
        assert!(Procrustes::of(&points, &points[..3]).is_err(), "unequal");
        assert!(Procrustes::of(&[], &[]).is_err(), "none");
        let one_place = vec![vec![2.0, 1.0]; 4];
        let error = Procrustes::of(&one_place, &points).unwrap_err();
        assert!(error.reason.contains("one place"), "{error}");
    }
}
