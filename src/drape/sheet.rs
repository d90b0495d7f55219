//! The cloth as a step's function: elastic energy, damping, hysteresis and air, with forces and
//! tangents.
//!
//! Every implicit step minimises `Φ(x) = (μ/2)|x−y|²_M + E(x) + (σ/2)|x−x̂|²_C`; here is all of it
//! but contact. Knows nothing of integrators: [`Lag`] holds what a step knows beforehand.

use super::fabric::Fabric;
use super::membrane::{Shear, Stretch};
use super::mesh::{Mesh, Vector};
use super::plate::{Bend, Twist};
use super::precondition::{LinePreconditioner, frame};

/// How long shear and bending remember their speed: damping is this times their stiffness, s.
pub(crate) const VISCOSITY_S: f64 = 2e-3;
/// Half the density of air times the drag coefficient of a plate: ½·1.2·1.2 kg/m³.
const DRAG_KG_PER_M3: f64 = 0.5 * 1.2 * 1.2;

/// Energy of a place: what is stored in the cloth, and what a step's function adds for losses.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Energy {
    pub(crate) stored: f64,
    pub(crate) lost: f64,
}

impl std::ops::AddAssign for Energy {
    fn add_assign(&mut self, other: Self) {
        self.stored += other.stored;
        self.lost += other.lost;
    }
}

/// What a step knows before it is solved.
#[derive(Debug, Clone)]
pub(crate) struct Lag {
    /// Weight of the inertia, 1/s².
    pub(crate) mu: f64,
    /// Weight of the damping, 1/s.
    pub(crate) sigma: f64,
    /// Where inertia would take every node, m.
    pub(crate) free: Vec<Vector>,
    /// What velocity is measured from: `v = σ (x − x̂)`.
    pub(crate) hat: Vec<Vector>,
    /// The same for shear angles, rad.
    pub(crate) angles: Vec<f64>,
    /// Normals at the start, where air or hysteresis asks for them.
    pub(crate) normals: Vec<Vector>,
    /// Air's drag along them, N·s/m.
    pub(crate) drag: Vec<f64>,
}

/// What of its losses a cloth has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Losses {
    pub(crate) has_air: bool,
    pub(crate) has_hysteresis: bool,
    pub(crate) viscosity_s: f64,
}

impl Default for Losses {
    fn default() -> Self {
        Self {
            has_air: true,
            has_hysteresis: false,
            viscosity_s: VISCOSITY_S,
        }
    }
}

/// The cloth.
#[derive(Debug, Clone)]
pub(crate) struct Sheet {
    pub(crate) mesh: Mesh,
    pub(crate) fabric: Fabric,
    pub(crate) losses: Losses,
    pub(crate) stretch: [Stretch; 2],
    pub(crate) shear: Shear,
    pub(crate) bend: [Bend; 2],
    pub(crate) twist: Twist,
}

impl Sheet {
    pub(crate) fn new(mesh: Mesh, fabric: &Fabric, losses: Losses) -> Self {
        let viscosity_s = losses.viscosity_s;
        let friction = if losses.has_hysteresis { 1.0 } else { 0.0 };
        let stretch = [0, 1].map(|axis| {
            let loss = friction * fabric.tension_friction_n_per_m[axis];
            Stretch::new(axis, &fabric.tension[axis], loss, &mesh)
        });
        let bend = [0, 1].map(|axis| {
            let loop_n = friction * fabric.bending_loop_n[axis];
            Bend::new(axis, fabric.bending_n_m[axis], loop_n, viscosity_s, &mesh)
        });
        let loops = fabric.shear_loop_n_per_m.map(|width| friction * width);
        let [warp, weft] = fabric.bending_n_m;
        Self {
            shear: Shear::new(fabric.shear_n_per_m, loops, viscosity_s, &mesh),
            twist: Twist {
                rigidity_n_m: (warp * weft).sqrt(),
                viscosity_s,
            },
            stretch,
            bend,
            mesh,
            fabric: *fabric,
            losses,
        }
    }

    /// A lag of the right size, without inertia and damping.
    pub(crate) fn lag(&self, n_nodes: usize) -> Lag {
        let n = self.mesh.n_vertices();
        Lag {
            mu: 0.0,
            sigma: 0.0,
            free: vec![Vector::zeros(); n_nodes],
            hat: vec![Vector::zeros(); n_nodes],
            angles: vec![0.0; self.shear.angles.len()],
            normals: vec![Vector::z(); n],
            drag: vec![0.0; n],
        }
    }

    /// Looks at where the cloth is, and how fast, when a step begins.
    pub(crate) fn begin(&mut self, lag: &mut Lag, x: &[Vector], v: &[Vector]) {
        if self.losses.has_air || self.losses.has_hysteresis {
            let speeds = v.iter().take(self.mesh.n_vertices());
            for (vertex, v) in speeds.enumerate() {
                let [_, _, normal] = frame(&self.mesh, x, vertex);
                lag.normals[vertex] = normal;
                if self.losses.has_air {
                    let area = self.mesh.mass_kg[vertex] / self.fabric.density_kg_per_m2;
                    lag.drag[vertex] = DRAG_KG_PER_M3 * area * normal.dot(v).abs();
                }
            }
        }
        self.shear.begin();
    }

    /// Its energy at a place; forces are taken from `grad`, tangents are kept.
    pub(crate) fn evaluate(&mut self, x: &[Vector], lag: &Lag, grad: &mut [Vector]) -> Energy {
        let mut energy = Energy::default();
        for stretch in &mut self.stretch {
            energy += stretch.evaluate(&self.mesh, x, grad);
        }
        energy += self.shear.evaluate(&self.mesh, (x, lag), grad);
        for bend in &mut self.bend {
            energy += bend.evaluate(&self.mesh, (x, lag), grad);
        }
        energy += self.twist.evaluate(&self.mesh, (x, lag), grad);
        if self.losses.has_air {
            for (vertex, normal) in lag.normals.iter().enumerate() {
                let drag = lag.sigma * lag.drag[vertex];
                let moved = normal.dot(&(x[vertex] - lag.hat[vertex]));
                energy.lost += 0.5 * drag * moved * moved;
                grad[vertex] += normal * (drag * moved);
            }
        }
        energy
    }

    /// Adds the tangent's product.
    pub(crate) fn product(&self, p: &[Vector], lag: &Lag, out: &mut [Vector]) {
        for stretch in &self.stretch {
            stretch.product(&self.mesh, p, out);
        }
        self.shear.product(&self.mesh, p, out);
        for bend in &self.bend {
            bend.product(&self.mesh, (p, lag), out);
        }
        self.twist.product(&self.mesh, (p, lag), out);
        if self.losses.has_air {
            for (vertex, normal) in lag.normals.iter().enumerate() {
                let pull = lag.sigma * lag.drag[vertex] * normal.dot(&p[vertex]);
                out[vertex] += normal * pull;
            }
        }
    }

    pub(crate) fn precondition(&self, lag: &Lag, lines: &mut LinePreconditioner) {
        for stretch in &self.stretch {
            stretch.precondition(&self.mesh, lines);
        }
        self.shear.precondition(&self.mesh, lines);
        for bend in &self.bend {
            bend.precondition(&self.mesh, lag, lines);
        }
        self.twist.precondition(&self.mesh, lag, lines);
        for (vertex, drag) in lag.drag.iter().enumerate() {
            lines.add_normal(vertex, lag.sigma * drag);
        }
    }

    /// Ends a step at the place that was evaluated last.
    pub(crate) fn settle(&mut self, x: &[Vector], lag: &Lag) {
        if self.losses.has_hysteresis {
            for stretch in &mut self.stretch {
                stretch.settle(&self.mesh, x);
            }
            self.shear.settle();
            for bend in &mut self.bend {
                bend.settle(&self.mesh, x, &lag.normals);
            }
        }
    }

    /// The longest step that semi-implicit Euler holds with what is stretched now, s; `contact` is
    /// the largest stiffness over mass, 1/s², that fingers add.
    ///
    /// `dt² ω² + 2 dt c < 4` of the fastest mode, c its damping.
    pub(crate) fn limit_s(&self, contact: f64) -> f64 {
        let h = self.mesh.h[0].min(self.mesh.h[1]);
        let per_area = 1.0 / (self.fabric.density_kg_per_m2 * h * h);
        let [shear, shear_damped] = self.shear.stiffest_n_per_m();
        let largest = |nth: usize| self.stretch.each_ref().map(|one| one.largest_n_per_m[nth]);
        let stretched = largest(0)[0].max(largest(0)[1]);
        let pulled = largest(1)[0] + largest(1)[1];
        let bend = self.bend.each_ref().map(Bend::stiffest_n_m);
        let [bent, bent_damped] = [0, 1].map(|nth| bend[0][nth].max(bend[1][nth]) / (h * h));
        let modes = [
            [stretched + shear, shear_damped],
            [pulled + 16.0 * bent, 16.0 * bent_damped],
        ];
        let limits = modes.map(|[stiffness, damped]| {
            let omega2 = 4.0 * per_area * stiffness + contact;
            let c = 4.0 * per_area * damped;
            ((c * c + 4.0 * omega2).sqrt() - c) / omega2
        });
        limits[0].min(limits[1])
    }

    /// Mass, kg, and its product with gravity and length, J: what energies are measured by.
    pub(crate) fn scale_j(&self) -> f64 {
        let mass: f64 = self.mesh.mass_kg.iter().sum();
        let [u, w] = self.mesh.size_m();
        mass * super::GRAVITY * u.max(w)
    }
}
