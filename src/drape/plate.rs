//! Bending along the yarns and twist between them: quadratic, with a constant Hessian.
//!
//! Along a line `d = x₋ − 2x₀ + x₊`, `E = ½ B |d|² b/h³`; of a cell `d = x₀₀ − x₁₀ − x₀₁ + x₁₁`,
//! `E = B_t |d|²/(h_u h_w)`. Hysteresis acts on the curvature about the normal of the step before.

use super::mesh::{Mesh, Vector};
use super::precondition::LinePreconditioner;
use super::sheet::{Energy, Lag};
use super::slip::{SlipElements, SlipLaw};

/// Curvature at which the friction of bending is reached, 1/m.
const REACH_PER_M: f64 = 25.0;

/// Bending of the yarns along one axis.
#[derive(Debug, Clone)]
pub(crate) struct Bend {
    axis: usize,
    pub(crate) rigidity_n_m: f64,
    viscosity_s: f64,
    loops: (SlipElements, SlipLaw),
    /// Slip tangent about the lagged normal, for each place along a line.
    tangents: Vec<f64>,
}

impl Bend {
    pub(crate) fn new(
        axis: usize,
        rigidity: f64,
        loop_n: f64,
        viscosity_s: f64,
        mesh: &Mesh,
    ) -> Self {
        let [rows, columns] = mesh.spans(axis, 2);
        let n = if loop_n > 0.0 { rows * columns } else { 0 };
        Self {
            axis,
            rigidity_n_m: rigidity,
            viscosity_s,
            loops: (
                SlipElements::new(n),
                SlipLaw::reached_in(0.5 * loop_n, REACH_PER_M),
            ),
            tangents: vec![0.0; n],
        }
    }

    /// Stiffness of `|d|²` per width.
    fn per_width(&self, mesh: &Mesh) -> f64 {
        self.rigidity_n_m / mesh.h[self.axis].powi(3)
    }

    /// Index, width and three vertices of every place along the lines.
    fn places<'a>(&self, mesh: &'a Mesh) -> impl Iterator<Item = (usize, f64, [usize; 3])> + 'a {
        let stride = mesh.stride(self.axis);
        let lines = mesh.lines(self.axis, 2);
        lines.map(move |(index, a, width)| (index, width, [a, a + stride, a + 2 * stride]))
    }

    pub(crate) fn evaluate(
        &mut self,
        mesh: &Mesh,
        (x, lag): (&[Vector], &Lag),
        grad: &mut [Vector],
    ) -> Energy {
        let (stiffness, damped) = (self.per_width(mesh), lag.sigma * self.viscosity_s);
        let (h, h2) = (mesh.h[self.axis], mesh.h[self.axis].powi(2));
        let mut energy = Energy::default();
        let ((elements, law), tangents) = (&self.loops, &mut self.tangents);
        let fields = [x, &lag.hat];
        mesh.bend(
            self.axis,
            (fields, grad),
            |[place, middle], [bent, hat], width| {
                let (off, k) = (bent - hat, stiffness * width);
                energy.stored += 0.5 * k * bent.norm_squared();
                energy.lost += 0.5 * k * damped * off.norm_squared();
                let mut force = (bent + off * damped) * k;
                if let Some(kept) = tangents.get_mut(place) {
                    let normal = lag.normals[middle];
                    let slip = elements.at(place, bent.dot(&normal) / h2, *law);
                    let area = width * h;
                    energy.stored += area * slip.stored;
                    energy.lost += area * slip.lost;
                    force += normal * (area * slip.force / h2);
                    *kept = area * slip.tangent / (h2 * h2);
                }
                force
            },
        );
        energy
    }

    pub(crate) fn product(&self, mesh: &Mesh, (p, lag): (&[Vector], &Lag), out: &mut [Vector]) {
        let stiffness = self.per_width(mesh) * (1.0 + lag.sigma * self.viscosity_s);
        mesh.bend(self.axis, ([p], out), |[place, middle], [bent], width| {
            let mut force = bent * (stiffness * width);
            if let Some(tangent) = self.tangents.get(place) {
                let normal = lag.normals[middle];
                force += normal * (tangent * normal.dot(&bent));
            }
            force
        });
    }

    pub(crate) fn precondition(&self, mesh: &Mesh, lag: &Lag, lines: &mut LinePreconditioner) {
        let stiffness = self.per_width(mesh) * (1.0 + lag.sigma * self.viscosity_s);
        for (index, width, [a, b, c]) in self.places(mesh) {
            let tangent = self.tangents.get(index).copied().unwrap_or(0.0);
            for (vertex, share) in [(a, 1.0), (b, 4.0), (c, 1.0)] {
                lines.add_everywhere(vertex, share * stiffness * width);
                lines.add_normal(vertex, share * tangent);
            }
        }
    }

    pub(crate) fn settle(&mut self, mesh: &Mesh, x: &[Vector], normals: &[Vector]) {
        if self.loops.0.is_empty() {
            return;
        }
        let h2 = mesh.h[self.axis].powi(2);
        let places = self.places(mesh);
        let (elements, law) = &mut self.loops;
        for (index, _, [a, b, c]) in places {
            let curvature = (x[a] - x[b] * 2.0 + x[c]).dot(&normals[b]) / h2;
            elements.settle(index, curvature, *law);
        }
    }

    /// The rigidity that a small motion meets, and its damped part, N·m and N·m·s.
    pub(crate) fn stiffest_n_m(&self) -> [f64; 2] {
        let slip = if self.loops.0.is_empty() {
            0.0
        } else {
            self.loops.1.stiffness
        };
        [
            self.rigidity_n_m + slip,
            self.rigidity_n_m * self.viscosity_s,
        ]
    }
}

/// Twist of every cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Twist {
    pub(crate) rigidity_n_m: f64,
    pub(crate) viscosity_s: f64,
}

impl Twist {
    fn stiffness(self, mesh: &Mesh) -> f64 {
        2.0 * self.rigidity_n_m / (mesh.h[0] * mesh.h[1])
    }

    pub(crate) fn evaluate(
        self,
        mesh: &Mesh,
        (x, lag): (&[Vector], &Lag),
        grad: &mut [Vector],
    ) -> Energy {
        let (stiffness, damped) = (self.stiffness(mesh), lag.sigma * self.viscosity_s);
        let mut energy = Energy::default();
        mesh.twist(([x, &lag.hat], grad), |[twisted, hat]| {
            let off = twisted - hat;
            energy.stored += twisted.norm_squared();
            energy.lost += off.norm_squared();
            (twisted + off * damped) * stiffness
        });
        Energy {
            stored: 0.5 * stiffness * energy.stored,
            lost: 0.5 * stiffness * damped * energy.lost,
        }
    }

    pub(crate) fn product(self, mesh: &Mesh, (p, lag): (&[Vector], &Lag), out: &mut [Vector]) {
        let stiffness = self.stiffness(mesh) * (1.0 + lag.sigma * self.viscosity_s);
        mesh.twist(([p], out), |[twisted]| twisted * stiffness);
    }

    pub(crate) fn precondition(self, mesh: &Mesh, lag: &Lag, lines: &mut LinePreconditioner) {
        let stiffness = self.stiffness(mesh) * (1.0 + lag.sigma * self.viscosity_s);
        for corners in mesh.cells() {
            for corner in corners {
                lines.add_everywhere(corner, stiffness);
            }
        }
    }
}
