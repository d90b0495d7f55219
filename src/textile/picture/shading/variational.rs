//! Least squares on the full reflectance: the heights that make `Σ (E/a − R)² + λ Σ (∇²z)²` least,
//! by Gauss–Newton from the linear inversion on.
//!
//! Slopes are central differences, so that no direction is preferred. Every step is solved by
//! conjugate gradients, preconditioned by the transform of the mean problem; it is halved until it
//! lowers the sum. λ begins high and falls to what was asked for: broad forms are found first,
//! which keeps steep weaves out of wrong valleys. The albedo is fitted between steps.

use std::f64::consts::TAU;

use super::reflectance::{Lambert, across, along, laplacian, residual};
use super::{Found, Light, ShadingError, ShadingOptions, linear};
use crate::numerics::{Grid, PlaneTransform};
use crate::progress::Progress;

/// Weight of squared curvature unless stated, and at first.
const SMOOTHNESS: f64 = 1e-3;
const FIRST_SMOOTHNESS: f64 = 0.3;
/// Share of the iterations over which the weight falls.
const FALLING: f64 = 0.75;
/// Weight of squared heights: keeps what the light does not show near 0.
const TIKHONOV: f64 = 1e-7;
/// Damping of a step, at first, and its limits.
const DAMPING: [f64; 3] = [1e-7, 1e-3, 1e3];
/// Rounds of conjugate gradients, and the share of the first residual (squared) that ends them.
const N_INNER: usize = 20;
const INNER_END: f64 = 1e-4;
/// A step is halved so often at most.
const N_HALVINGS: usize = 10;

/// One surface that is being fitted.
struct Fit<'a> {
    brightness: &'a Grid<f64>,
    matt: Lambert,
    transform: PlaneTransform,
    albedo: f64,
    smoothness: f64,
    damping: f64,
    z: Grid<f64>,
}

/// The reflectance about the surface as it is.
struct Tangent {
    by_p: Grid<f64>,
    by_q: Grid<f64>,
    /// E/a − R.
    missing: Grid<f64>,
}

pub(super) fn solve(
    brightness: &Grid<f64>,
    light: Light,
    options: &ShadingOptions,
    progress: &mut Progress<'_>,
) -> Result<Found, ShadingError> {
    let matt = Lambert::under(light);
    let mut fit = Fit {
        brightness,
        matt,
        transform: PlaneTransform::new(brightness.width(), brightness.height()),
        albedo: options.albedo_for(brightness, light),
        smoothness: FIRST_SMOOTHNESS,
        damping: DAMPING[1],
        z: linear::heights(brightness, light, options),
    };
    let flat = Grid::filled(brightness.width(), brightness.height(), 0.0);
    let mut residuals = vec![residual(brightness, fit.albedo, &flat, matt)];
    let n = options.n_iterations();
    let last = options.regulariser.unwrap_or(SMOOTHNESS);
    for done in 0..n {
        progress.step(done as f64 / n as f64, "fitting heights")?;
        fit.smoothness = smoothness_at(done, n, last);
        if options.albedo.is_none() {
            fit.fit_albedo();
        }
        fit.step(progress, done as f64 / n as f64)?;
        residuals.push(residual(brightness, fit.albedo, &fit.z, matt));
    }
    Ok(Found {
        height_px: fit.z,
        albedo: fit.albedo,
        residuals,
    })
}

/// The weight of curvature at an iteration: falling to the last by equal factors, then the last.
fn smoothness_at(done: usize, n: usize, last: f64) -> f64 {
    let falling = (FALLING * n as f64 - 1.0).max(1.0);
    let share = (done as f64 / falling).min(1.0);
    let is_alone = n == 1;
    let first = if is_alone {
        last
    } else {
        FIRST_SMOOTHNESS.max(last)
    };
    first * (last / first).powf(share)
}

impl Fit<'_> {
    /// The albedo that fits the surface as it is best; as before if all of it is dark.
    fn fit_albedo(&mut self) {
        let (p, q) = (along(&self.z), across(&self.z));
        let slopes = p.values().iter().zip(q.values());
        let pairs = self.brightness.values().iter().zip(slopes);
        let (er, rr) = pairs.fold((0.0, 0.0), |(er, rr), (e, (p, q))| {
            let bright = self.matt.of(*p, *q).max(0.0);
            (er + e * bright, rr + bright * bright)
        });
        if er > 0.0 && rr > 0.0 {
            self.albedo = er / rr;
        }
    }

    fn tangent(&self) -> Tangent {
        let (mut by_p, mut by_q) = (along(&self.z), across(&self.z));
        let mut missing = self.brightness.clone();
        let slopes = by_p.values_mut().iter_mut().zip(by_q.values_mut());
        for (e, (p, q)) in missing.values_mut().iter_mut().zip(slopes) {
            let [bright, dp, dq] = self.matt.with_slopes(*p, *q);
            *e = *e / self.albedo - bright;
            (*p, *q) = (dp, dq);
        }
        Tangent {
            by_p,
            by_q,
            missing,
        }
    }

    /// What is made least.
    fn cost(&self, z: &Grid<f64>) -> f64 {
        let (p, q) = (along(z), across(z));
        let slopes = p.values().iter().zip(q.values());
        let pairs = self.brightness.values().iter().zip(slopes);
        let misfit: f64 = pairs
            .map(|(e, (p, q))| (e / self.albedo - self.matt.of(*p, *q).max(0.0)).powi(2))
            .sum();
        misfit + self.smoothness * squares(&laplacian(z)) + TIKHONOV * squares(z)
    }

    /// One Gauss–Newton step, halved until it lowers the cost; none if nothing does.
    fn step(&mut self, progress: &mut Progress<'_>, share: f64) -> Result<(), ShadingError> {
        let tangent = self.tangent();
        let mut down = tangent.back(&tangent.missing);
        let bent = laplacian(&laplacian(&self.z));
        add(&mut down, -self.smoothness, &bent);
        add(&mut down, -TIKHONOV, &self.z);
        let way = self.solved(&tangent, down, progress, share)?;
        let before = self.cost(&self.z);
        let mut length = 1.0;
        for _ in 0..N_HALVINGS {
            let mut z = self.z.clone();
            add(&mut z, length, &way);
            if self.cost(&z) < before {
                self.z = z;
                if length >= 1.0 {
                    self.damping = (self.damping / 3.0).max(DAMPING[0]);
                }
                return Ok(());
            }
            length *= 0.5;
        }
        self.damping = (10.0 * self.damping).min(DAMPING[2]);
        Ok(())
    }

    /// `(JᵀJ + λ∇⁴ + μ) x = right` by conjugate gradients.
    fn solved(
        &self,
        tangent: &Tangent,
        mut right: Grid<f64>,
        progress: &mut Progress<'_>,
        share: f64,
    ) -> Result<Grid<f64>, ShadingError> {
        let shift = TIKHONOV + self.damping;
        let mean = tangent.mean_problem(self.smoothness, shift);
        let mut x = Grid::filled(right.width(), right.height(), 0.0);
        let mut y = self.divided(&right, &mean);
        let mut way = y.clone();
        let first = dot(&right, &y);
        let mut now = first;
        for _ in 0..N_INNER {
            if now <= INNER_END * first || now <= f64::MIN_POSITIVE {
                break;
            }
            progress.step(share, "fitting heights")?;
            let mut image = tangent.back(&tangent.forth(&way));
            add(&mut image, self.smoothness, &laplacian(&laplacian(&way)));
            add(&mut image, shift, &way);
            let length = now / dot(&way, &image);
            if !length.is_finite() {
                break;
            }
            add(&mut x, length, &way);
            add(&mut right, -length, &image);
            y = self.divided(&right, &mean);
            let next = dot(&right, &y);
            let keep = next / now;
            for (w, y) in way.values_mut().iter_mut().zip(y.values()) {
                *w = y + keep * *w;
            }
            now = next;
        }
        Ok(x)
    }

    /// Divided by the transform of the mean problem.
    fn divided(&self, right: &Grid<f64>, mean: &Grid<f64>) -> Grid<f64> {
        let mut spectrum = self.transform.forward(right);
        for (f, weight) in spectrum.values_mut().iter_mut().zip(mean.values()) {
            *f /= *weight;
        }
        self.transform.inverse(spectrum)
    }
}

impl Tangent {
    /// J: the change of brightness with a change of heights.
    fn forth(&self, change: &Grid<f64>) -> Grid<f64> {
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

    /// The transform of `JᵀJ` + λ∇⁴ + μ with J's weights in the mean.
    fn mean_problem(&self, smoothness: f64, shift: f64) -> Grid<f64> {
        let n = self.by_p.values().len().max(1) as f64;
        let [pp, qq] = [&self.by_p, &self.by_q].map(|by| squares(by) / n);
        let pq = dot(&self.by_p, &self.by_q) / n;
        let (width, height) = (self.by_p.width(), self.by_p.height());
        let mut weights = Grid::filled(width / 2 + 1, height, 0.0);
        for row in 0..height {
            let y = TAU * row as f64 / height as f64;
            for (column, weight) in weights.row_mut(row).iter_mut().enumerate() {
                let x = TAU * column as f64 / width as f64;
                let [sx, sy] = [x.sin(), y.sin()];
                let bend = 2.0 * x.cos() + 2.0 * y.cos() - 4.0;
                let slope = pp * sx * sx + qq * sy * sy + 2.0 * pq * sx * sy;
                *weight = slope.max(0.0) + smoothness * bend * bend + shift;
            }
        }
        weights
    }
}

fn add(to: &mut Grid<f64>, factor: f64, from: &Grid<f64>) {
    for (value, other) in to.values_mut().iter_mut().zip(from.values()) {
        *value += factor * other;
    }
}

fn dot(a: &Grid<f64>, b: &Grid<f64>) -> f64 {
    a.values().iter().zip(b.values()).map(|(a, b)| a * b).sum()
}

fn squares(a: &Grid<f64>) -> f64 {
    dot(a, a)
}
