//! Newton's method for a step's function: conjugate gradients, preconditioned, and a line search.
//!
//! Works on anything that can say its value, gradient and tangent; allocates nothing once made.

use super::mesh::Vector;
use super::precondition::LinePreconditioner;
use super::system::System;

/// How far a linear system is solved: Newton corrects the rest.
const LINEAR: f64 = 1e-2;
/// The same of how the cloth gives way to a finger.
const GIVES_WAY: f64 = 0.05;
/// Most iterations of one linear system.
const MAX_LINEAR: u32 = 600;
/// A step has to gain this share of what its slope promises (Armijo).
const GAIN: f64 = 1e-4;
/// Most halvings of a step.
const MAX_HALVINGS: u32 = 24;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stop {
    /// What a step still has to gain, J.
    pub(crate) gain_j: f64,
    pub(crate) max_steps: u32,
}

/// What it took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Outcome {
    pub(crate) n_steps: u32,
    pub(crate) n_linear: u32,
    pub(crate) is_converged: bool,
}

/// Memory of the method.
#[derive(Debug, Clone)]
pub(crate) struct Newton {
    pub(crate) lines: LinePreconditioner,
    pub(crate) grad: Vec<Vector>,
    delta: Vec<Vector>,
    trial: Vec<Vector>,
    r: Vec<Vector>,
    z: Vec<Vector>,
    p: Vec<Vector>,
    product: Vec<Vector>,
}

impl Newton {
    pub(crate) fn new(system: &System) -> Self {
        let zeros = vec![Vector::zeros(); system.n_nodes()];
        Self {
            lines: LinePreconditioner::new(&system.sheet.mesh, system.fingers.len()),
            grad: zeros.clone(),
            delta: zeros.clone(),
            trial: zeros.clone(),
            r: zeros.clone(),
            z: zeros.clone(),
            p: zeros.clone(),
            product: zeros,
        }
    }

    /// Goes from `x` to the lowest place of the system's function; `known` is its value there, if
    /// `x` is what was evaluated last, into `grad`.
    pub(crate) fn minimise(
        &mut self,
        system: &mut System,
        (x, known): (&mut [Vector], Option<f64>),
        stop: Stop,
    ) -> Outcome {
        let mut outcome = Outcome::default();
        let mut value = known.unwrap_or_else(|| {
            system.look(x);
            system.evaluate(x, &mut self.grad)
        });
        while outcome.n_steps < stop.max_steps {
            outcome.n_linear += self.solve(system, x, LINEAR);
            outcome.n_steps += 1;
            let gain: f64 = -dot(&self.grad, &self.delta);
            if !gain.is_finite() || gain < 0.0 {
                break;
            }
            let Some(reached) = self.search(system, x, (value, gain)) else {
                // Nothing lower is left but rounding.
                outcome.is_converged = gain < stop.gain_j.max(1e-12 * value.abs());
                system.evaluate(x, &mut self.grad);
                break;
            };
            value = reached;
            if system.look(x) {
                value = system.evaluate_touch(x, &mut self.grad);
            }
            if gain < stop.gain_j {
                outcome.is_converged = true;
                break;
            }
        }
        outcome
    }

    /// Backtracks along the step until the value falls; moves `x` there and says the value.
    fn search(
        &mut self,
        system: &mut System,
        x: &mut [Vector],
        (value, gain): (f64, f64),
    ) -> Option<f64> {
        let mut share = 1.0;
        let slack = 1e-14 * value.abs();
        for _ in 0..MAX_HALVINGS {
            for ((trial, at), delta) in self.trial.iter_mut().zip(&*x).zip(&self.delta) {
                *trial = at + delta * share;
            }
            let reached = system.evaluate(&self.trial, &mut self.grad);
            if reached <= value - GAIN * share * gain + slack {
                x.copy_from_slice(&self.trial);
                return Some(reached);
            }
            share *= 0.5;
        }
        None
    }

    /// Iterations that a first step from `x` takes to a thousandth, with the lines solved or not.
    pub(crate) fn iterations(&mut self, system: &mut System, x: &[Vector], lines: bool) -> u32 {
        system.evaluate(x, &mut self.grad);
        self.lines.is_coupled = lines;
        self.solve(system, x, 1e-3)
    }

    /// Solves for the step by conjugate gradients as far as asked; says how many iterations it
    /// took.
    fn solve(&mut self, system: &System, x: &[Vector], reach: f64) -> u32 {
        system.precondition(x, &mut self.lines);
        for (r, grad) in self.r.iter_mut().zip(&self.grad) {
            *r = -grad;
        }
        self.conjugate(system, (reach, system.n_nodes()))
    }

    /// What the fingers' nodes meet in the cloth when they move, N/m: the Schur complement of the
    /// tangent at `x` on them, without their own inertia and coupling. Entry `[b][a]` is the force
    /// that moving along a takes along b; three a finger.
    pub(crate) fn met_by_fingers(&mut self, system: &System, x: &[Vector]) -> [[f64; 6]; 6] {
        let n_cloth = system.sheet.mesh.n_vertices();
        system.precondition(x, &mut self.lines);
        let mut met = [[0.0; 6]; 6];
        for along in 0..3 * system.fingers.len() {
            self.p.fill(Vector::zeros());
            self.p[n_cloth + along / 3][along % 3] = 1.0;
            system.product(&self.p, &mut self.product);
            let own = system.own_stiffness(along / 3);
            let direct = self.product[n_cloth..]
                .iter()
                .flat_map(|force| force.iter());
            for (row, force) in met.iter_mut().zip(direct) {
                row[along] = *force;
            }
            met[along][along] -= own;
            self.r.copy_from_slice(&self.product);
            // The cloth gives way; its energy is exact to the square of what is left.
            self.conjugate(system, (GIVES_WAY, n_cloth));
            system.product(&self.delta, &mut self.product);
            let back = self.product[n_cloth..]
                .iter()
                .flat_map(|force| force.iter());
            for (row, force) in met.iter_mut().zip(back) {
                row[along] -= force;
            }
        }
        met
    }

    /// Conjugate gradients for `r`, into `delta`, as far as asked; nodes from a number on are held.
    fn conjugate(&mut self, system: &System, (reach, held_from): (f64, usize)) -> u32 {
        let held = held_from.min(self.r.len())..;
        self.delta.fill(Vector::zeros());
        self.r[held.clone()].fill(Vector::zeros());
        self.lines.apply(&self.r, &mut self.z);
        self.p.copy_from_slice(&self.z);
        let mut rho = dot(&self.r, &self.z);
        let target = reach * reach * rho;
        for iteration in 0..MAX_LINEAR {
            if rho <= target || rho == 0.0 {
                return iteration;
            }
            system.product(&self.p, &mut self.product);
            let curvature = dot(&self.p, &self.product);
            if curvature.is_nan() || curvature <= 0.0 {
                return iteration;
            }
            let alpha = rho / curvature;
            for index in 0..self.delta.len() {
                self.delta[index] += self.p[index] * alpha;
                self.r[index] -= self.product[index] * alpha;
            }
            self.r[held.clone()].fill(Vector::zeros());
            self.lines.apply(&self.r, &mut self.z);
            let next = dot(&self.r, &self.z);
            let beta = next / rho;
            rho = next;
            for (p, z) in self.p.iter_mut().zip(&self.z) {
                *p = z + *p * beta;
            }
        }
        MAX_LINEAR
    }
}

pub(crate) fn dot(a: &[Vector], b: &[Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
