//! A cloth in motion: its state, and the steps that it takes.
//!
//! A step neither allocates nor reads a clock. Lengths in m, time in s; y is up.

use super::finger::Finger;
use super::integrator::Integrator;
use super::mesh::Vector;
use super::newton::Newton;
use super::projective::Projection;
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
pub(crate) struct Past {
    pub(crate) x: Vec<Vector>,
    pub(crate) v: Vec<Vector>,
    pub(crate) angles: Vec<f64>,
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
    pub(crate) past: [Past; 2],
    /// Shear angles now, rad.
    pub(crate) angles: Vec<f64>,
    /// How many steps `past` can be relied on.
    pub(crate) n_past: usize,
    /// Whether velocities are those between two places, as explicit steps have them.
    pub(crate) is_staggered: bool,
    /// Whether the place now is what was evaluated last.
    pub(crate) is_evaluated: bool,
    rests_s: f64,
    pub(crate) counters: DrapeCounters,
    /// Work that hands did, J.
    pub(crate) work_j: f64,
    pub(crate) next: Vec<Vector>,
    pub(crate) trial: Vec<Vector>,
    /// 1/mass of the cloth's vertices, 0 of pinned ones, 1/kg.
    pub(crate) per_kg: Vec<f64>,
    /// What projective dynamics factors once.
    pub(crate) projection: Option<Projection>,
}

impl Cloth {
    /// A cloth at rest in its own plane, fingers where they start.
    pub(crate) fn new(mut system: System, stepping: Stepping) -> Self {
        if !stepping.integrator.has_touch() {
            system.fingers.iter_mut().for_each(Finger::lead_only);
        }
        let targets = system.fingers.iter().map(|finger| finger.target);
        let x: Vec<Vector> = system.sheet.mesh.at_rest().chain(targets).collect();
        let zeros = vec![Vector::zeros(); x.len()];
        let past = Past {
            x: x.clone(),
            v: zeros.clone(),
            angles: system.sheet.shear.angles.clone(),
        };
        let mesh = &system.sheet.mesh;
        let vertices = mesh.mass_kg.iter().zip(&mesh.is_pinned);
        let per_kg = vertices.map(|(kg, pinned)| if *pinned { 0.0 } else { kg.recip() });
        let is_projective = stepping.integrator == Integrator::Projective;
        let projection = is_projective.then(|| Projection::new(&system.sheet, stepping.step_s));
        let mut cloth = Self {
            per_kg: per_kg.collect(),
            projection: projection.flatten(),
            newton: Newton::new(&system),
            system,
            stepping,
            gravity: Vector::new(0.0, -GRAVITY, 0.0),
            v: zeros.clone(),
            angles: past.angles.clone(),
            past: [past.clone(), past],
            n_past: 0,
            is_staggered: false,
            is_evaluated: false,
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

    /// Puts fingers where they are wanted, at rest; those that would have to be behind the cloth
    /// stand before it.
    pub(crate) fn place_fingers(&mut self, targets: &[Vector]) {
        let n_cloth = self.system.sheet.mesh.n_vertices();
        for (nth, (finger, target)) in self.system.fingers.iter_mut().zip(targets).enumerate() {
            if System::is_finite(&[*target]) {
                finger.target = *target;
                self.x[n_cloth + nth] = *target;
                self.v[n_cloth + nth] = Vector::zeros();
                let cleared = finger.cleared(&self.system.sheet.mesh, &self.x);
                self.x[n_cloth + nth] = cleared.unwrap_or(*target);
            }
        }
        self.restart();
    }

    /// Lays the cloth flat at rest, turned about its upper edge.
    pub(crate) fn tilt(&mut self, degrees: f64) {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let Self { system, x, v, .. } = self;
        let mesh = &system.sheet.mesh;
        let top = mesh.size_m()[1];
        for ((x, v), rest) in x.iter_mut().zip(v).zip(mesh.at_rest()) {
            let down = top - rest.y;
            *x = Vector::new(rest.x, top - down * cosine, down * sine);
            *v = Vector::zeros();
        }
        self.restart();
    }

    /// Pulls what is pinned along the warp so many times as far from the middle.
    pub(crate) fn pull(&mut self, times: f64) {
        let mesh = &self.system.sheet.mesh;
        let middle = 0.5 * mesh.size_m()[0];
        for (x, is_pinned) in self.x.iter_mut().zip(&mesh.is_pinned) {
            if *is_pinned {
                x.x = middle + times * (x.x - middle);
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
        self.is_evaluated = true;
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
        self.holds()?;
        let step_s = self.stepping.step_s;
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
            Integrator::Xpbd => self.pass_constraints(),
            Integrator::Projective => self.project(),
            _ => self.implicit(if self.n_past > 0 { 2 } else { 1 }),
        }
        // What moves by its forces at the start is not evaluated where it ends.
        self.is_evaluated = !matches!(
            self.stepping.integrator,
            Integrator::Explicit | Integrator::Xpbd | Integrator::Projective
        );
        let fingers = self.system.fingers.iter();
        self.work_j += fingers.map(|finger| finger.work_j(step_s)).sum::<f64>();
        self.end(step_s);
        Ok(())
    }

    /// Whether the next step is one that its integrator holds.
    pub(crate) fn holds(&self) -> Result<(), DrapeError> {
        if self.stepping.integrator == Integrator::Explicit {
            let (step_s, limit_s) = (self.stepping.step_s, self.limit_s());
            if step_s > limit_s {
                return Err(DrapeError::Unstable { step_s, limit_s });
            }
        }
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
        // The formula of second order would look back across the event.
        let mut is_new = false;
        for finger in &mut self.system.fingers {
            is_new |= finger.has_come();
        }
        self.n_past = if is_new { 0 } else { (self.n_past + 1).min(2) };
    }

    /// Energy of all, J: in motion, stored, and in the field of gravity.
    pub(crate) fn energy_j(&mut self) -> f64 {
        if !self.is_evaluated {
            if self.is_staggered {
                self.evaluate_at_start();
            } else {
                self.system.evaluate(&self.x, &mut self.newton.grad);
            }
            self.is_evaluated = true;
        }
        // Explicit velocities are those half a step ago.
        let since_s = if self.is_staggered {
            0.5 * self.stepping.step_s
        } else {
            0.0
        };
        let system = &self.system;
        // The motion of a finger that is only led is nobody's energy.
        let n_moving = if self.stepping.integrator.has_touch() {
            self.v.len()
        } else {
            system.sheet.mesh.n_vertices()
        };
        let v = (0..n_moving).map(|node| self.pushed(node, since_s));
        system.kinetic_j(v) + system.energy.stored + system.height_j(&self.x, self.gravity)
    }

    /// The fingers.
    pub(crate) fn fingers(&self) -> &[Finger] {
        &self.system.fingers
    }
}
