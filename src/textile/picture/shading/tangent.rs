//! The reflectance about a surface: its derivatives, and the normal equations of least squares.

use std::f64::consts::TAU;

use super::reflectance::{Lambert, across, across_row, along, along_row, laplacian_row};
use selvedge_foundation::numerics::Grid;

/// The reflectance about the surface as it is.
pub(super) struct Tangent {
    by_p: Grid<f64>,
    by_q: Grid<f64>,
    /// E/a − R.
    pub(super) missing: Grid<f64>,
}

impl Tangent {
    /// Of brightness under an albedo, about heights.
    pub(super) fn of(
        brightness: &Grid<f64>,
        albedo: f64,
        (z, matt): (&Grid<f64>, Lambert),
    ) -> Self {
        let (mut by_p, mut by_q) = (along(z), across(z));
        let mut missing = brightness.clone();
        let slopes = by_p.values_mut().iter_mut().zip(by_q.values_mut());
        for (e, (p, q)) in missing.values_mut().iter_mut().zip(slopes) {
            let [bright, dp, dq] = matt.with_slopes(*p, *q);
            *e = *e / albedo - bright;
            (*p, *q) = (dp, dq);
        }
        Self {
            by_p,
            by_q,
            missing,
        }
    }

    /// Jᵀ. Central differences over what repeats are their own transpose with the other sign.
    fn back(&self, bright: &Grid<f64>) -> Grid<f64> {
        let weighted = |by: &Grid<f64>| {
            let mut product = bright.clone();
            for (value, weight) in product.values_mut().iter_mut().zip(by.values()) {
                *value *= -weight;
            }
            product
        };
        let mut change = along(&weighted(&self.by_p));
        add(&mut change, 1.0, &across(&weighted(&self.by_q)));
        change
    }
}

/// The way down: the sum of `Jᵀ` of what is missing over the pictures.
pub(super) fn down(tangents: &[Tangent], [width, height]: [usize; 2]) -> Grid<f64> {
    let mut sum = Grid::filled(width, height, 0.0);
    for tangent in tangents {
        add(&mut sum, 1.0, &tangent.back(&tangent.missing));
    }
    sum
}

/// One over the transform of the sum of `JᵀJ` over the pictures + λ∇⁴ + μ with J's weights in the
/// mean.
pub(super) fn mean_problem(tangents: &[Tangent], smoothness: f64, shift: f64) -> Grid<f64> {
    let [width, height] =
        (tangents.first()).map_or([0; 2], |one| [one.by_p.width(), one.by_p.height()]);
    let n = (width * height).max(1) as f64;
    let sum = |of: fn(&Tangent) -> f64| tangents.iter().map(of).sum::<f64>() / n;
    let [pp, qq] = [sum(|one| squares(&one.by_p)), sum(|one| squares(&one.by_q))];
    let pq = sum(|one| dot(&one.by_p, &one.by_q));
    let [xs, ys] = [width, height].map(|n| {
        let wave = |k: usize| (TAU * k as f64 / n as f64).sin_cos();
        (0..n).map(wave).collect::<Vec<_>>()
    });
    Grid::from_fn(xs.len() / 2 + 1, ys.len(), |column, row| {
        let ((sx, cx), (sy, cy)) = (xs[column], ys[row]);
        let bend = 2.0 * cx + 2.0 * cy - 4.0;
        let slope = pp * sx * sx + qq * sy * sy + 2.0 * pq * sx * sy;
        1.0 / (slope.max(0.0) + smoothness * bend * bend + shift)
    })
}

/// The sum of `JᵀJ` over the pictures + λ∇⁴ + μ, and room for its parts.
pub(super) struct Normal<'a> {
    tangents: &'a [Tangent],
    /// λ and μ.
    weights: [f64; 2],
    /// The change of brightness by the derivatives by p and by q; the Laplacian; the product.
    parts: [Grid<f64>; 4],
    /// A row of two differences.
    rows: [Vec<f64>; 2],
}

impl<'a> Normal<'a> {
    pub(super) fn of(tangents: &'a [Tangent], weights: [f64; 2], like: &Grid<f64>) -> Self {
        let (width, height) = (like.width(), like.height());
        Self {
            tangents,
            weights,
            parts: [(); 4].map(|()| Grid::filled(width, height, 0.0)),
            rows: [(); 2].map(|()| vec![0.0; width]),
        }
    }

    /// Its product with a change of heights.
    pub(super) fn times(&mut self, change: &Grid<f64>) -> &Grid<f64> {
        let Self {
            tangents,
            weights,
            parts,
            rows,
        } = self;
        let ([of_p, of_q, bent, product], [p, q]) = (parts, rows);
        for row in 0..change.height() {
            along_row(change, row, p);
            across_row(change, row, q);
            laplacian_row(change, row, bent.row_mut(row));
            let (of_p, of_q) = (of_p.row_mut(row), of_q.row_mut(row));
            of_p.fill(0.0);
            of_q.fill(0.0);
            for tangent in *tangents {
                let by = tangent.by_p.row(row).iter().zip(tangent.by_q.row(row));
                let slopes = p.iter().zip(q.iter());
                let of = of_p.iter_mut().zip(of_q.iter_mut());
                for ((of_p, of_q), ((by_p, by_q), (p, q))) in of.zip(by.zip(slopes)) {
                    let bright = by_p * p + by_q * q;
                    *of_p -= by_p * bright;
                    *of_q -= by_q * bright;
                }
            }
        }
        for row in 0..change.height() {
            let into = product.row_mut(row);
            along_row(of_p, row, into);
            across_row(of_q, row, p);
            laplacian_row(bent, row, q);
            let parts = p.iter().zip(q.iter()).zip(change.row(row));
            for (sum, ((across, bent), z)) in into.iter_mut().zip(parts) {
                *sum += across + weights[0] * bent + weights[1] * z;
            }
        }
        product
    }
}

pub(super) fn add(to: &mut Grid<f64>, factor: f64, from: &Grid<f64>) {
    for (value, other) in to.values_mut().iter_mut().zip(from.values()) {
        *value += factor * other;
    }
}

pub(super) fn dot(a: &Grid<f64>, b: &Grid<f64>) -> f64 {
    product(a.values(), b.values())
}

pub(super) fn squares(a: &Grid<f64>) -> f64 {
    dot(a, a)
}

/// `Σ a·b`, in lanes that do not wait for each other.
pub(super) fn product(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut lanes = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in lanes.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    lanes.iter().sum::<f64>() + rest
}
