//! The reflectance about a surface as it is: how brightness changes with heights.

use std::f64::consts::TAU;

use super::reflectance::{across, along};
use selvedge_foundation::numerics::Grid;

/// The reflectance about the surface as it is.
pub(super) struct Tangent {
    pub(super) by_p: Grid<f64>,
    pub(super) by_q: Grid<f64>,
    /// E/a − R.
    pub(super) missing: Grid<f64>,
}

impl Tangent {
    /// J: the change of brightness with a change of heights.
    pub(super) fn forth(&self, change: &Grid<f64>) -> Grid<f64> {
        let (mut bright, q) = (along(change), across(change));
        let weights = self.by_p.values().iter().zip(self.by_q.values());
        let pairs = weights.zip(q.values());
        for (value, ((dp, dq), q)) in bright.values_mut().iter_mut().zip(pairs) {
            *value = dp * *value + dq * q;
        }
        bright
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

/// The sum of Jᵀ over the pictures; none of no picture.
pub(super) fn back(tangents: &[Tangent], bright: impl Fn(&Tangent) -> Grid<f64>) -> Grid<f64> {
    let all = tangents
        .iter()
        .map(|tangent| tangent.back(&bright(tangent)));
    let sum = all.reduce(|mut sum, next| {
        add(&mut sum, 1.0, &next);
        sum
    });
    sum.unwrap_or_else(|| Grid::filled(0, 0, 0.0))
}

/// The transform of `JᵀJ` + λ∇⁴ + μ with J's weights in the mean.
pub(super) fn mean_problem(tangents: &[Tangent], smoothness: f64, shift: f64) -> Grid<f64> {
    let size = tangents
        .first()
        .map(|one| [one.by_p.width(), one.by_p.height()]);
    let [width, height] = size.unwrap_or([0; 2]);
    let n = (width * height).max(1) as f64;
    let sum = |of: fn(&Tangent) -> f64| tangents.iter().map(of).sum::<f64>() / n;
    let [pp, qq] = [sum(|one| squares(&one.by_p)), sum(|one| squares(&one.by_q))];
    let pq = sum(|one| dot(&one.by_p, &one.by_q));
    Grid::from_fn(width / 2 + 1, height, |column, row| {
        let x = TAU * column as f64 / width as f64;
        let y = TAU * row as f64 / height as f64;
        let [sx, sy] = [x.sin(), y.sin()];
        let bend = 2.0 * x.cos() + 2.0 * y.cos() - 4.0;
        let slope = pp * sx * sx + qq * sy * sy + 2.0 * pq * sx * sy;
        slope.max(0.0) + smoothness * bend * bend + shift
    })
}

pub(super) fn add(to: &mut Grid<f64>, factor: f64, from: &Grid<f64>) {
    for (value, other) in to.values_mut().iter_mut().zip(from.values()) {
        *value += factor * other;
    }
}

pub(super) fn dot(a: &Grid<f64>, b: &Grid<f64>) -> f64 {
    a.values().iter().zip(b.values()).map(|(a, b)| a * b).sum()
}

pub(super) fn squares(a: &Grid<f64>) -> f64 {
    dot(a, a)
}
