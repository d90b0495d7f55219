//! Tsai & Shah, "Shape from shading using linear approximation", Image and Vision Computing 12(8),
//! 1994: the published iteration, with the constants of the authors' program.
//!
//! Z is a depth there, so that its reflectance has `+ p·Ps + q·Qs`: heights are −Z under the same
//! light. Backward differences; every point takes one Newton step on `f = E − R` with its
//! neighbours held (Jacobi), damped by a scalar Kalman gain: `1/S` grows by `f'²/W` a step, so the
//! steps become a running average and end long before Newton would.

use super::Light;
use super::error::ShadingError;
use super::reflectance::before;
use super::shape::{Edges, Found, ShadingOptions};
use selvedge_foundation::numerics::Grid;
use selvedge_foundation::progress::Progress;

/// The published noise W and first variance S.
const W: f64 = 1e-8;
const S0: f64 = 0.01;
/// Lights nearer to Ps + Qs = 0 than the (0.01, 0.01) that ports take for frontal light.
const MIN_LEAN: f64 = 0.02;

/// Whether the derivative is 0 on a flat surface, so that nothing ever moves.
pub(super) fn is_singular(light: Light) -> bool {
    let [ps, qs] = light.lean();
    (ps + qs).abs() < MIN_LEAN
}

/// Depth and variance of every point.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) depth: Grid<f64>,
    variance: Grid<f64>,
}

impl State {
    pub(super) fn flat(width: usize, height: usize) -> Self {
        Self {
            depth: Grid::filled(width, height, 0.0),
            variance: Grid::filled(width, height, S0),
        }
    }

    /// One step of every point; hands back the mean |E − R| before it.
    pub(super) fn step(&mut self, e: &Grid<f64>, [ps, qs]: [f64; 2], edges: Edges) -> f64 {
        let (width, height) = (e.width(), e.height());
        let norm = (1.0 + ps * ps + qs * qs).sqrt();
        let old = self.depth.clone();
        let mut sum = 0.0;
        for row in 0..height {
            let (here, below) = (old.row(row), old.row(before(row, height)));
            for column in 0..width {
                let is_edge = edges == Edges::Published && (row == 0 || column == 0);
                let [p, q] = if is_edge {
                    [0.0; 2]
                } else {
                    let z = here[column];
                    [z - here[before(column, width)], z - below[column]]
                };
                let g = 1.0 + p * p + q * q;
                let facing = 1.0 + p * ps + q * qs;
                let bright = (facing / (g.sqrt() * norm)).max(0.0);
                let f = e.row(row)[column] - bright;
                let slope =
                    (p + q) * facing / (g * g.sqrt() * norm) - (ps + qs) / (g.sqrt() * norm);
                let variance = &mut self.variance.row_mut(row)[column];
                let gain = *variance * slope / (W + slope * *variance * slope);
                *variance *= 1.0 - gain * slope;
                self.depth.row_mut(row)[column] = here[column] - gain * f;
                sum += f.abs();
            }
        }
        sum / (width * height) as f64
    }
}

pub(super) fn solve(
    brightness: &Grid<f64>,
    light: Light,
    options: &ShadingOptions,
    progress: &mut Progress<'_>,
) -> Result<Found, ShadingError> {
    let albedo = options.albedo_for(brightness, light);
    let target = brightness.map(|e| e / albedo);
    let mut state = State::flat(target.width(), target.height());
    let n = options.n_iterations();
    let mut residuals = Vec::with_capacity(n + 1);
    for done in 0..n {
        progress.step(done as f64 / n as f64, "Tsai & Shah")?;
        residuals.push(state.step(&target, light.lean(), options.edges));
    }
    let height_px = state.depth.map(|z| -z);
    residuals.push(state.step(&target, light.lean(), options.edges));
    Ok(Found {
        height_px,
        albedo,
        residuals,
        n_rounds: 0,
    })
}
