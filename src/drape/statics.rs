//! Where a cloth comes to rest: Newton's method from coarse to fine.
//!
//! A cloth that may move in its own plane has no stiffness there at first, so every solution is
//! anchored to the last by a little inertia, which is let go as it settles.

use super::DrapeError;
use super::cloth::{Cloth, EXACT, Stepping};
use super::integrator::Integrator;
use super::mesh::{Mesh, Vector};
use super::newton::Stop;
use super::place::Spot;
use super::sheet::Sheet;
use super::system::System;

/// Sides of fewer vertices are solved at once.
const LEAST_SIDE: usize = 9;
/// The first pseudo-step, s, and how much longer each next one is.
const FIRST_S: f64 = 0.02;
const LONGER: f64 = 3.0;
/// At this one inertia no longer tells, s.
const LONGEST_S: f64 = 300.0;
/// Most pseudo-steps.
const MAX_PSEUDO: u32 = 200;

impl Cloth {
    /// Lets it hang until it rests; says whether it does.
    ///
    /// # Errors
    /// A grid that cannot be.
    pub(crate) fn settle_to_rest(&mut self) -> Result<bool, DrapeError> {
        let mesh = &self.system.sheet.mesh;
        if mesh.n.iter().all(|n| *n >= LEAST_SIDE) {
            self.start_from(mesh.n.map(|n| n.div_ceil(2)))?;
        }
        let rests = self.relax();
        self.v.fill(Vector::zeros());
        self.restart();
        Ok(rests)
    }

    /// Solves on a coarser grid of the same cloth and takes its shape.
    fn start_from(&mut self, n: [usize; 2]) -> Result<(), DrapeError> {
        let fine = &self.system.sheet;
        let size_m = fine.mesh.size_m();
        let density = fine.fabric.density_kg_per_m2;
        let none = super::mesh::Pins::None;
        let mut mesh = Mesh::new(n, size_m, density, &none)?;
        // A coarse vertex is held where the fine one nearest to it is.
        for vertex in 0..mesh.n_vertices() {
            let at = [vertex % mesh.n[0], vertex / mesh.n[0]];
            let near = [0, 1].map(|side| {
                let last = (fine.mesh.n[side] - 1) as f64;
                let share = at[side] as f64 / (mesh.n[side] - 1) as f64;
                selvedge_foundation::numerics::to_index((share * last).round())
            });
            mesh.is_pinned[vertex] = fine.mesh.is_pinned[near[1] * fine.mesh.n[0] + near[0]];
        }
        let sheet = Sheet::new(mesh, &fine.fabric, fine.losses);
        let step = Stepping::new(Integrator::ImplicitEuler, 1e-3);
        let mut cloth = Self::new(System::new(sheet, Vec::new()), step);
        cloth.gravity = self.gravity;
        cloth.settle_to_rest()?;
        let fine = &self.system.sheet.mesh;
        for (vertex, rest) in fine.at_rest().enumerate() {
            let place = [rest.x.min(size_m[0]), rest.y.min(size_m[1])];
            let spot = Spot::new(&cloth.system.sheet.mesh, &cloth.x, place);
            if let Some(spot) = spot.filter(|_| !fine.is_pinned[vertex]) {
                self.x[vertex] = spot.at(&cloth.x);
            }
        }
        Ok(())
    }

    /// Pseudo-steps without damping until nothing is left to gain; says whether that was reached.
    pub(crate) fn relax(&mut self) -> bool {
        let stop = Stop {
            gain_j: 1e-3 * EXACT * self.system.sheet.scale_j(),
            max_steps: 60,
        };
        let (mut step_s, mut n_calm) = (FIRST_S, 0);
        self.v.fill(Vector::zeros());
        for _ in 0..MAX_PSEUDO {
            let Self { system, x, v, .. } = self;
            system.sheet.begin(&mut system.lag, x, v);
            system.lag.mu = 1.0 / (step_s * step_s);
            system.lag.sigma = 0.0;
            let n_cloth = system.sheet.mesh.n_vertices();
            for (node, x) in x.iter().enumerate() {
                let fall = if node < n_cloth {
                    self.gravity
                } else {
                    Vector::zeros()
                };
                system.lag.free[node] = x + fall * (step_s * step_s);
                system.lag.hat[node] = *x;
            }
            for finger in &mut system.fingers {
                finger.begin(&system.lag);
            }
            let outcome = self.newton.minimise(system, (x, None), stop);
            self.counters.newton += u64::from(outcome.n_steps);
            self.counters.linear += u64::from(outcome.n_linear);
            let is_calm = outcome.is_converged && outcome.n_steps <= 1 && step_s >= LONGEST_S;
            n_calm = if is_calm { n_calm + 1 } else { 0 };
            if n_calm > 1 {
                let Self { system, x, .. } = self;
                system.sheet.settle(x, &system.lag);
                return true;
            }
            let change = if outcome.is_converged { LONGER } else { 0.3 };
            step_s = (step_s * change).clamp(1e-4, LONGEST_S);
        }
        false
    }
}
