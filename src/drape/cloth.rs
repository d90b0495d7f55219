//! A cloth in motion: its state, and the steps that it takes.
//!
//! A step neither allocates nor reads a clock. Lengths in m, time in s; y is up.

use super::finger::Finger;
use super::integrator::Integrator;
use super::mesh::Vector;
use super::newton::{Newton, Outcome, Stop};
use super::system::System;
use super::{DrapeError, GRAVITY};

/// What a step has to gain to be solved, as part of the cloth's weight times its length.
pub(crate) const LIVE: f64 = 1e-4;
/// The same where results are compared.
pub(crate) const EXACT: f64 = 1e-7;
/// Most Newton steps of a step.
const MAX_STEPS: u32 = 20;
/// A cloth that moves slower than this, m/s, and no farther than that in a step, m, rests.
const ASLEEP: [f64; 2] = [1e-3, 1e-6];
/// After resting so long it sleeps, s.
const SLEEPS_AFTER_S: f64 = 0.5;

/// What was done since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct DrapeCounters {
    /// Steps taken, asleep or not.
    pub steps: u64,
    /// Steps that were left out because everything rested.
    pub asleep: u64,
    /// Newton steps.
    pub newton: u64,
    /// Iterations of linear systems.
    pub linear: u64,
    /// Steps that were out of budget and done again by implicit Euler.
    pub redone: u64,
    /// Steps that were not solved as far as asked.
    pub unconverged: u64,
    /// Steps in which a yarn was stretched beyond what was measured.
    pub overstretched: u64,
    /// Targets of fingers that were no numbers.
    pub targets_held: u64,
}

/// How steps are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stepping {
    pub(crate) integrator: Integrator,
    pub(crate) step_s: f64,
    /// As part of weight times length.
    pub(crate) gain: f64,
    pub(crate) max_steps: u32,
}

impl Stepping {
    pub(crate) fn new(integrator: Integrator, step_s: f64) -> Self {
        Self {
            integrator,
            step_s,
            gain: LIVE,
            max_steps: MAX_STEPS,
        }
    }
}

/// What is remembered of one instant.
#[derive(Debug, Clone)]
struct Past {
    x: Vec<Vector>,
    v: Vec<Vector>,
    angles: Vec<f64>,
}

/// A cloth and the fingers on it.
#[derive(Debug, Clone)]
pub(crate) struct Cloth {
    pub(crate) system: System,
    pub(crate) newton: Newton,
    pub(crate) stepping: Stepping,
    pub(crate) gravity: Vector,
    pub(crate) x: Vec<Vector>,
    pub(crate) v: Vec<Vector>,
    /// One step ago and two steps ago.
    past: [Past; 2],
    /// Shear angles now, rad.
    angles: Vec<f64>,
    /// How many steps `past` can be relied on.
    n_past: usize,
    touched: bool,
    /// Whether velocities are those between two places, as explicit steps have them.
    is_staggered: bool,
    rests_s: f64,
    pub(crate) counters: DrapeCounters,
    /// Work that hands did, J.
    pub(crate) work_j: f64,
    next: Vec<Vector>,
    trial: Vec<Vector>,
}

impl Cloth {
    /// A cloth at rest in its own plane, fingers where they start.
    pub(crate) fn new(system: System, stepping: Stepping) -> Self {
        let targets = system.fingers.iter().map(|finger| finger.target);
        let x: Vec<Vector> = system.sheet.mesh.at_rest().chain(targets).collect();
        let zeros = vec![Vector::zeros(); x.len()];
        let past = Past {
            x: x.clone(),
            v: zeros.clone(),
            angles: system.sheet.shear.angles.clone(),
        };
        let mut cloth = Self {
            newton: Newton::new(&system),
            system,
            stepping,
            gravity: Vector::new(0.0, -GRAVITY, 0.0),
            v: zeros.clone(),
            angles: past.angles.clone(),
            past: [past.clone(), past],
            n_past: 0,
            touched: false,
            is_staggered: false,
            rests_s: 0.0,
            counters: DrapeCounters::default(),
            work_j: 0.0,
            next: zeros.clone(),
            trial: zeros,
            x,
        };
        cloth.restart();
        cloth
    }

    /// Puts fingers where they are wanted, at rest.
    pub(crate) fn place_fingers(&mut self, targets: &[Vector]) {
        let n_cloth = self.system.sheet.mesh.n_vertices();
        for (nth, (finger, target)) in self.system.fingers.iter_mut().zip(targets).enumerate() {
            if System::is_finite(&[*target]) {
                finger.target = *target;
                self.x[n_cloth + nth] = *target;
                self.v[n_cloth + nth] = Vector::zeros();
            }
        }
        self.restart();
    }

    /// Forgets what was before: places or velocities were set from outside.
    pub(crate) fn restart(&mut self) {
        self.n_past = 0;
        self.is_staggered = false;
        self.rests_s = 0.0;
        let Self {
            system, x, newton, ..
        } = self;
        system.lag.sigma = 0.0;
        for finger in &mut system.fingers {
            finger.begin(&system.lag);
        }
        system.look(x);
        system.evaluate(x, &mut newton.grad);
        self.angles.copy_from_slice(&system.sheet.shear.angles);
        for past in &mut self.past {
            past.x.copy_from_slice(x);
            past.angles.copy_from_slice(&self.angles);
        }
    }

    /// Takes a step with fingers led towards `targets`.
    ///
    /// # Errors
    /// An explicit step beyond its limit; nothing has moved then.
    pub(crate) fn step(&mut self, targets: &[Vector]) -> Result<(), DrapeError> {
        let step_s = self.stepping.step_s;
        if self.stepping.integrator == Integrator::Explicit {
            let limit_s = self.limit_s();
            if step_s > limit_s {
                return Err(DrapeError::Unstable { step_s, limit_s });
            }
        }
        self.counters.steps += 1;
        if self.sleeps(targets) {
            self.counters.asleep += 1;
            return Ok(());
        }
        for (finger, target) in self.system.fingers.iter_mut().zip(targets) {
            self.counters.targets_held += u64::from(!System::is_finite(&[*target]));
            finger.lead(*target, step_s);
        }
        match self.stepping.integrator {
            Integrator::Explicit => self.explicit(),
            Integrator::ImplicitEuler => self.implicit(1),
            _ => self.implicit(if self.n_past > 0 { 2 } else { 1 }),
        }
        let fingers = self.system.fingers.iter();
        self.work_j += fingers.map(|finger| finger.work_j(step_s)).sum::<f64>();
        self.end(step_s);
        Ok(())
    }

    /// The longest explicit step, s.
    pub(crate) fn limit_s(&self) -> f64 {
        let density = self.system.sheet.fabric.density_kg_per_m2;
        let fingers = self.system.fingers.iter();
        let contact = fingers.map(|finger| finger.stiffness_per_kg(density)).sum();
        self.system.sheet.limit_s(contact)
    }

    /// Whether everything rests, and nobody comes near.
    fn sleeps(&self, targets: &[Vector]) -> bool {
        let fingers = self.system.fingers.iter().zip(targets);
        let mut calls =
            fingers.map(|(finger, target)| finger.target != *target || finger.is_near());
        self.rests_s >= SLEEPS_AFTER_S && !calls.any(|calls| calls)
    }

    /// Ends a step: counts, and learns whether the cloth rests.
    fn end(&mut self, step_s: f64) {
        let sheet = &self.system.sheet;
        let mut strained = sheet.stretch.iter();
        let is_over = strained.any(|one| one.largest_strain > one.tension.max_strain);
        self.counters.overstretched += u64::from(is_over);
        let [slow, near] = ASLEEP;
        let moves = |(node, v): (usize, &Vector)| {
            let moved = self.x[node] - self.past[0].x[node];
            v.norm() > slow || moved.norm() > near
        };
        let is_moving = self.v.iter().enumerate().any(moves);
        self.rests_s = if is_moving {
            0.0
        } else {
            self.rests_s + step_s
        };
        let touched = self
            .system
            .fingers
            .iter()
            .any(|finger| finger.press_n() > 0.0);
        // The formula of second order would look back across the event.
        let is_new = touched && !self.touched;
        self.n_past = if is_new { 0 } else { (self.n_past + 1).min(2) };
        self.touched = touched;
    }

    /// Semi-implicit Euler: `v += dt M⁻¹ f(x)`, `x += dt v`. The first push is half of one: from
    /// there on velocities are those between two places, and places of second order.
    fn explicit(&mut self) {
        let step_s = self.stepping.step_s;
        let Self { system, x, v, .. } = self;
        system.lag.mu = 0.0;
        system.lag.sigma = 1.0 / step_s;
        system.sheet.begin(&mut system.lag, x, v);
        // Velocity for damping is the last step's: x − x̂ = dt v.
        for (node, hat) in system.lag.hat.iter_mut().enumerate() {
            *hat = x[node] - v[node] * step_s;
        }
        system.lag.angles.copy_from_slice(&self.past[0].angles);
        for finger in &mut system.fingers {
            finger.begin(&system.lag);
        }
        system.look(x);
        system.evaluate(x, &mut self.newton.grad);
        // What was evaluated is where the step begins.
        self.angles.copy_from_slice(&self.system.sheet.shear.angles);
        self.remember();
        let push_s = if self.is_staggered {
            step_s
        } else {
            0.5 * step_s
        };
        self.is_staggered = true;
        let Self { system, x, v, .. } = self;
        for node in 0..x.len() {
            if system.is_held(node) {
                v[node] = Vector::zeros();
                continue;
            }
            let mass = system.mass_kg[node];
            let is_cloth = node < system.sheet.mesh.n_vertices();
            let gravity = if is_cloth {
                self.gravity
            } else {
                Vector::zeros()
            };
            v[node] += (gravity - self.newton.grad[node] / mass) * push_s;
            x[node] += v[node] * step_s;
        }
        system.sheet.settle(x, &system.lag);
        for finger in &mut system.fingers {
            finger.settle(&system.sheet.mesh, x);
        }
    }

    /// Moves what is now into the past.
    fn remember(&mut self) {
        self.past.swap(0, 1);
        let past = &mut self.past[0];
        past.x.copy_from_slice(&self.x);
        past.v.copy_from_slice(&self.v);
        past.angles.copy_from_slice(&self.angles);
    }

    /// An implicit step of first or second order; one that is out of budget is done again.
    fn implicit(&mut self, order: usize) {
        let stop = Stop {
            gain_j: self.stepping.gain * self.system.sheet.scale_j(),
            max_steps: self.stepping.max_steps,
        };
        let Self { system, x, v, .. } = self;
        system.sheet.begin(&mut system.lag, x, v);
        let mut outcome = self.solve(order, stop);
        if !outcome.is_converged && order == 2 {
            // Cut short, the second order gains energy; the first loses some.
            self.counters.redone += 1;
            let again = self.solve(
                1,
                Stop {
                    max_steps: 1,
                    ..stop
                },
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
    fn solve(&mut self, order: usize, stop: Stop) -> Outcome {
        self.prepare(order);
        self.guess();
        let Self {
            system,
            newton,
            next,
            ..
        } = self;
        newton.minimise(system, next, stop)
    }

    /// What the step knows: weights, free motion, what velocity is measured from.
    fn prepare(&mut self, order: usize) {
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

    /// The lowest of where it is, where its velocity leads and where its last steps lead.
    fn guess(&mut self) {
        let step_s = self.stepping.step_s;
        let mut lowest = f64::INFINITY;
        let n_guesses = if self.n_past > 1 { 3 } else { 2 };
        for guess in 0..n_guesses {
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
            if value < lowest {
                lowest = value;
                self.next.copy_from_slice(&self.trial);
            }
        }
    }

    /// Takes what was found; keeps the old where it is no number.
    fn accept(&mut self) {
        if !System::is_finite(&self.next) {
            self.next.copy_from_slice(&self.x);
            self.restart();
            return;
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
        for finger in &mut system.fingers {
            finger.settle(&system.sheet.mesh, x);
        }
    }

    /// Energy of all, J: in motion, stored, and in the field of gravity.
    pub(crate) fn energy_j(&mut self) -> f64 {
        let Self {
            system, x, newton, ..
        } = self;
        system.evaluate(x, &mut newton.grad);
        system.kinetic_j(&self.v) + system.energy.stored + system.height_j(x, self.gravity)
    }

    /// The fingers.
    pub(crate) fn fingers(&self) -> &[Finger] {
        &self.system.fingers
    }
}
