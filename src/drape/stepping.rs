//! The steps themselves: explicit, implicit Euler, and the second backward difference formula.

use super::cloth::Cloth;
use super::mesh::Vector;
use super::newton::{Outcome, Stop};
use super::system::System;

impl Cloth {
    /// Semi-implicit Euler: `v += dt M⁻¹ f(x)`, `x += dt v`. The first push is half of one: from
    /// there on velocities are those between two places, and places of second order.
    pub(crate) fn explicit(&mut self) {
        let step_s = self.stepping.step_s;
        let Self { system, x, v, .. } = self;
        system.sheet.begin(&mut system.lag, x, v);
        self.evaluate_at_start();
        // What was evaluated is where the step begins.
        self.angles.copy_from_slice(&self.system.sheet.shear.angles);
        self.remember();
        let push_s = if self.is_staggered {
            step_s
        } else {
            0.5 * step_s
        };
        self.is_staggered = true;
        for node in 0..self.x.len() {
            self.v[node] = self.pushed(node, push_s);
            self.x[node] += self.v[node] * step_s;
        }
        let Self { system, x, .. } = self;
        system.sheet.settle(x, &system.lag);
        for finger in &mut system.fingers {
            finger.settle(&system.sheet.mesh, x);
        }
    }

    /// Forces where an explicit step begins: damping is by the velocity before, `x − x̂ = dt v`.
    pub(crate) fn evaluate_at_start(&mut self) {
        let step_s = self.stepping.step_s;
        let Self { system, x, v, .. } = self;
        (system.lag.mu, system.lag.sigma) = (0.0, 1.0 / step_s);
        for (node, hat) in system.lag.hat.iter_mut().enumerate() {
            *hat = x[node] - v[node] * step_s;
        }
        system.lag.angles.copy_from_slice(&self.past[0].angles);
        for finger in &mut system.fingers {
            finger.begin(&system.lag);
        }
        system.look(x);
        system.evaluate(x, &mut self.newton.grad);
    }

    /// Velocity of a node after what was evaluated has pushed it for so long, m/s.
    pub(crate) fn pushed(&self, node: usize, for_s: f64) -> Vector {
        let system = &self.system;
        if system.is_held(node) {
            return Vector::zeros();
        }
        let push = self.newton.grad[node] / system.mass_kg[node];
        let is_cloth = node < system.sheet.mesh.n_vertices();
        let falls = if is_cloth {
            self.gravity
        } else {
            Vector::zeros()
        };
        self.v[node] + (falls - push) * for_s
    }

    /// Moves what is now into the past.
    pub(crate) fn remember(&mut self) {
        self.past.swap(0, 1);
        let past = &mut self.past[0];
        past.x.copy_from_slice(&self.x);
        past.v.copy_from_slice(&self.v);
        past.angles.copy_from_slice(&self.angles);
    }

    /// An implicit step of first or second order; one that is out of budget is done again.
    pub(crate) fn implicit(&mut self, order: usize) {
        let stop = Stop {
            gain_j: self.stepping.gain * self.system.sheet.scale_j(),
            max_steps: self.stepping.max_steps,
        };
        // What is stored where the step begins, as it was evaluated last.
        let stored_j = if self.is_evaluated {
            self.system.stored_in_cloth_j()
        } else {
            f64::NEG_INFINITY
        };
        let Self { system, x, v, .. } = self;
        system.sheet.begin(&mut system.lag, x, v);
        let mut outcome = self.solve(order, stop, stored_j);
        if !outcome.is_converged && order == 2 {
            // Cut short, the second order gains energy; the first loses some.
            self.counters.redone += 1;
            let again = self.solve(
                1,
                Stop {
                    max_steps: 1,
                    ..stop
                },
                stored_j,
            );
            outcome.n_steps += again.n_steps;
            outcome.n_linear += again.n_linear;
        }
        self.counters.newton += u64::from(outcome.n_steps);
        self.counters.linear += u64::from(outcome.n_linear);
        self.counters.unconverged += u64::from(!outcome.is_converged);
        self.accept();
    }

    /// Finds where the step leads, into `next`.
    fn solve(&mut self, order: usize, stop: Stop, stored_j: f64) -> Outcome {
        self.prepare(order);
        let known = self.guess(stored_j);
        let Self {
            system,
            newton,
            next,
            ..
        } = self;
        newton.minimise(system, (next, known), stop)
    }

    /// What the step knows: weights, free motion, what velocity is measured from.
    pub(crate) fn prepare(&mut self, order: usize) {
        let step_s = self.stepping.step_s;
        let Self {
            system,
            x,
            v,
            past,
            gravity,
            ..
        } = self;
        let lag = &mut system.lag;
        let n_cloth = system.sheet.mesh.n_vertices();
        let share = if order == 2 { 2.0 / 3.0 } else { 1.0 };
        // Both formulas are x = x̂ + share dt v, v = v̂ + share dt a.
        let reach_s = share * step_s;
        lag.mu = 1.0 / (reach_s * reach_s);
        lag.sigma = 1.0 / reach_s;
        for node in 0..x.len() {
            let back = |now: Vector, before: Vector| {
                if order == 2 {
                    (now * 4.0 - before) / 3.0
                } else {
                    now
                }
            };
            let hat = back(x[node], past[0].x[node]);
            let fall = if node < n_cloth {
                *gravity * reach_s
            } else {
                Vector::zeros()
            };
            lag.hat[node] = hat;
            lag.free[node] = hat + (back(v[node], past[0].v[node]) + fall) * reach_s;
        }
        let angles = self.angles.iter().zip(&past[0].angles);
        for (angle, (now, before)) in lag.angles.iter_mut().zip(angles) {
            *angle = if order == 2 {
                (now * 4.0 - before) / 3.0
            } else {
                *now
            };
        }
        for finger in &mut system.fingers {
            finger.begin(&system.lag);
        }
    }

    /// The lowest of where its velocity leads, where its last steps lead and where it is; its value
    /// if it was the last to be evaluated. Where it is, inertia and what is stored are the least
    /// that it can be: mostly that is above the others already.
    fn guess(&mut self, stored_j: f64) -> Option<f64> {
        let step_s = self.stepping.step_s;
        let (mut lowest, mut last) = (f64::INFINITY, f64::INFINITY);
        let least_j = stored_j + self.system.inertia_j(&self.x);
        for guess in [1, 2, 0] {
            if guess == 2 && self.n_past < 2 || guess == 0 && least_j > lowest {
                continue;
            }
            for node in 0..self.x.len() {
                let (now, v) = (self.x[node], self.v[node]);
                let is_held = self.system.is_held(node);
                self.trial[node] = match guess {
                    0 => now,
                    _ if is_held => now,
                    1 => now + v * step_s,
                    _ => (now - self.past[0].x[node]) * 3.0 + self.past[1].x[node],
                };
            }
            self.system.look(&self.trial);
            let value = self.system.evaluate(&self.trial, &mut self.newton.grad);
            last = value;
            if value < lowest {
                lowest = value;
                self.next.copy_from_slice(&self.trial);
            }
        }
        (last <= lowest && last.is_finite()).then_some(last)
    }

    /// Takes what was found, with what fingers hold there.
    fn accept(&mut self) {
        if self.take() {
            let Self { system, x, .. } = self;
            for finger in &mut system.fingers {
                finger.settle(&system.sheet.mesh, x);
            }
        }
    }

    /// Moves to where was found; keeps the old where it is no number. Says whether it moved.
    pub(crate) fn take(&mut self) -> bool {
        if !System::is_finite(&self.next) {
            self.next.copy_from_slice(&self.x);
            self.restart();
            return false;
        }
        self.remember();
        let Self {
            system, x, v, next, ..
        } = self;
        self.angles.copy_from_slice(&system.sheet.shear.angles);
        let lag = &system.lag;
        for node in 0..x.len() {
            v[node] = (next[node] - lag.hat[node]) * lag.sigma;
            x[node] = next[node];
        }
        system.sheet.settle(x, &system.lag);
        true
    }
}
