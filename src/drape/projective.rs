//! Projective dynamics: `A = M/dt² + Σ k SᵀS` factored once, `x −= A⁻¹ ∇Φ`.
//!
//! A knows springs as stiff across as along them, so each pass holds back whatever turns: where
//! `K dt² ≫ ρh²` a cloth hardly swings. Here to compare, not to use; fingers are led, and touch
//! nothing.

use super::cloth::Cloth;
use super::mesh::Vector;
use super::sheet::Sheet;
use selvedge_foundation::numerics::GridFactor;

/// Passes of a step.
const N_PASSES: usize = 10;

/// What is factored once.
#[derive(Debug, Clone)]
pub(crate) struct Projection {
    factor: GridFactor,
    scratch: Vec<[f64; 3]>,
}

impl Projection {
    /// The matrix of a cloth for steps of a length; `None` if it has no inverse.
    pub(crate) fn new(sheet: &Sheet, step_s: f64) -> Option<Self> {
        let mesh = &sheet.mesh;
        let n = mesh.n_vertices();
        let mut entries: Vec<(usize, usize, f64)> = Vec::new();
        let per_s2 = (step_s * step_s).recip();
        for (vertex, mass) in mesh.mass_kg.iter().enumerate() {
            entries.push((vertex, vertex, mass * per_s2));
        }
        let mut join = |stencil: &[(usize, f64)], stiffness: f64| {
            let free = || {
                stencil
                    .iter()
                    .filter(|(vertex, _)| !mesh.is_pinned[*vertex])
            };
            for (a, of_a) in free() {
                entries.extend(free().map(|(b, of_b)| (*a, *b, stiffness * of_a * of_b)));
            }
        };
        for axis in 0..2 {
            let (h, stride) = (mesh.h[axis], mesh.stride(axis));
            let pulled = sheet.stretch[axis].stiffest_n_per_m() / h;
            for (_, a, width) in mesh.lines(axis, 1) {
                join(&[(a, -1.0), (a + stride, 1.0)], pulled * width);
            }
            let [rigid, damped] = sheet.bend[axis].stiffest_n_m();
            let bent = (rigid + damped / step_s) / h.powi(3);
            for (_, a, width) in mesh.lines(axis, 2) {
                let stencil = [(a, 1.0), (a + stride, -2.0), (a + 2 * stride, 1.0)];
                join(&stencil, bent * width);
            }
        }
        let [rigid, damped] = sheet.shear.stiffest_n_per_m();
        let [h_u, h_w] = mesh.h;
        // |∂γ/∂x|² of both diagonals together, each taken for all directions.
        let sheared = 0.5 * (rigid + damped / step_s) * (h_u / h_w + h_w / h_u);
        let twist = sheet.twist.rigidity_n_m * (1.0 + sheet.twist.viscosity_s / step_s);
        let twisted = 2.0 * twist / (h_u * h_w);
        for [c00, c10, c01, c11] in mesh.cells() {
            join(&[(c00, -1.0), (c11, 1.0)], sheared);
            join(&[(c10, -1.0), (c01, 1.0)], sheared);
            join(&[(c00, 1.0), (c10, -1.0), (c01, -1.0), (c11, 1.0)], twisted);
        }
        Some(Self {
            factor: GridFactor::new(mesh.n, 2, entries)?,
            scratch: vec![[0.0; 3]; n],
        })
    }
}

impl Cloth {
    /// One step of implicit Euler's function by so many passes of the factored matrix.
    pub(crate) fn project(&mut self) {
        let step_s = self.stepping.step_s;
        let Self { system, x, v, .. } = self;
        system.sheet.begin(&mut system.lag, x, v);
        self.prepare(1);
        let Self {
            system,
            newton,
            projection,
            next,
            ..
        } = self;
        for (node, next) in next.iter_mut().enumerate() {
            let led = system
                .fingers
                .get(node.wrapping_sub(system.sheet.mesh.n_vertices()));
            *next = led.map_or(self.x[node] + self.v[node] * step_s, |finger| finger.target);
        }
        for _ in 0..N_PASSES {
            system.evaluate_cloth(next, &mut newton.grad);
            let Some(Projection { factor, scratch }) = projection else {
                break;
            };
            let (pinned, grad) = (&system.sheet.mesh.is_pinned, &newton.grad);
            let read = |vertex: usize| {
                let slope = if pinned[vertex] {
                    Vector::zeros()
                } else {
                    grad[vertex]
                };
                slope.into()
            };
            factor.solve(read, scratch, |vertex, step| {
                next[vertex] -= Vector::from(step);
            });
        }
        self.counters.newton += N_PASSES as u64;
        self.take();
    }
}
