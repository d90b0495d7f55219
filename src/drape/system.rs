//! A step's function as a whole: inertia, the cloth, and the fingers on it.

use super::coupling::PROXY_KG;
use super::finger::Finger;
use super::mesh::Vector;
use super::newton::dot;
use super::precondition::LinePreconditioner;
use super::sheet::{Energy, Lag, Sheet};

/// The nodes that a step is solved for: the cloth's vertices, then a proxy of each finger.
#[derive(Debug, Clone)]
pub(crate) struct System {
    pub(crate) sheet: Sheet,
    pub(crate) fingers: Vec<Finger>,
    pub(crate) lag: Lag,
    pub(crate) mass_kg: Vec<f64>,
    /// Energy of the place that was evaluated last.
    pub(crate) energy: Energy,
    /// Value, energy and gradient there without fingers.
    of_cloth: (f64, Energy),
    grad_of_cloth: Vec<Vector>,
}

impl System {
    pub(crate) fn new(sheet: Sheet, fingers: Vec<Finger>) -> Self {
        let mut mass_kg = sheet.mesh.mass_kg.clone();
        mass_kg.extend(fingers.iter().map(|_| PROXY_KG));
        let lag = sheet.lag(mass_kg.len());
        Self {
            sheet,
            fingers,
            lag,
            grad_of_cloth: vec![Vector::zeros(); mass_kg.len()],
            mass_kg,
            energy: Energy::default(),
            of_cloth: (0.0, Energy::default()),
        }
    }

    pub(crate) fn n_nodes(&self) -> usize {
        self.mass_kg.len()
    }

    /// Whether a node is held where it is.
    pub(crate) fn is_held(&self, node: usize) -> bool {
        self.sheet
            .mesh
            .is_pinned
            .get(node)
            .is_some_and(|pinned| *pinned)
    }

    /// Finds what fingers touch now; says whether any touches.
    pub(crate) fn look(&mut self, x: &[Vector]) -> bool {
        let sheet = &self.sheet;
        let mut touches = false;
        for finger in &mut self.fingers {
            touches |= finger.look(&sheet.mesh, x);
        }
        touches
    }

    /// Its value and gradient; that of held nodes is 0.
    pub(crate) fn evaluate(&mut self, x: &[Vector], grad: &mut [Vector]) -> f64 {
        let value = self.evaluate_cloth(x, grad);
        self.of_cloth = (value, self.energy);
        if !self.fingers.is_empty() {
            self.grad_of_cloth.copy_from_slice(grad);
        }
        self.add_fingers(x, grad)
    }

    /// The same at the same place, once fingers have found anew what they touch.
    pub(crate) fn evaluate_touch(&mut self, x: &[Vector], grad: &mut [Vector]) -> f64 {
        grad.copy_from_slice(&self.grad_of_cloth);
        self.add_fingers(x, grad)
    }

    fn add_fingers(&mut self, x: &[Vector], grad: &mut [Vector]) -> f64 {
        let (mut value, energy) = self.of_cloth;
        self.energy = energy;
        for finger in &mut self.fingers {
            let energy = finger.evaluate(x, grad);
            self.energy += energy;
            value += energy.stored + energy.lost;
        }
        for (grad, pinned) in grad.iter_mut().zip(&self.sheet.mesh.is_pinned) {
            if *pinned {
                *grad = Vector::zeros();
            }
        }
        value
    }

    /// Value and gradient of the cloth alone, with what pins hold against.
    pub(crate) fn evaluate_cloth(&mut self, x: &[Vector], grad: &mut [Vector]) -> f64 {
        let lag = &self.lag;
        let mut inertia = 0.0;
        for (node, grad) in grad.iter_mut().enumerate() {
            let off = x[node] - lag.free[node];
            let weight = lag.mu * self.mass_kg[node];
            inertia += 0.5 * weight * off.norm_squared();
            *grad = off * weight;
        }
        self.energy = self.sheet.evaluate(x, lag, grad);
        inertia + self.energy.stored + self.energy.lost
    }

    /// Energy that was stored in the cloth where it was evaluated last, J.
    pub(crate) fn stored_in_cloth_j(&self) -> f64 {
        self.of_cloth.1.stored
    }

    /// What inertia takes to be at `x`, J.
    pub(crate) fn inertia_j(&self, x: &[Vector]) -> f64 {
        let off = |(x, free): (&Vector, &Vector)| (x - free).norm_squared();
        let squares = x.iter().zip(&self.lag.free).map(off);
        let each = squares.zip(&self.mass_kg);
        0.5 * self.lag.mu * each.map(|(square, kg)| square * kg).sum::<f64>()
    }

    /// The tangent's product; held nodes neither move nor answer.
    pub(crate) fn product(&self, p: &[Vector], out: &mut [Vector]) {
        for (node, out) in out.iter_mut().enumerate() {
            *out = p[node] * (self.lag.mu * self.mass_kg[node]);
        }
        self.sheet.product(p, &self.lag, out);
        for finger in &self.fingers {
            finger.product(p, out);
        }
        for (out, pinned) in out.iter_mut().zip(&self.sheet.mesh.is_pinned) {
            if *pinned {
                *out = Vector::zeros();
            }
        }
    }

    /// What a finger's node meets by its own inertia and its coupling, N/m.
    pub(crate) fn own_stiffness(&self, finger: usize) -> f64 {
        self.lag.mu * PROXY_KG + self.fingers[finger].coupling.tangent
    }

    pub(crate) fn precondition(&self, x: &[Vector], lines: &mut LinePreconditioner) {
        let mesh = &self.sheet.mesh;
        lines.begin(mesh, x, |node| self.lag.mu * self.mass_kg[node]);
        self.sheet.precondition(&self.lag, lines);
        for (proxy, finger) in self.fingers.iter().enumerate() {
            finger.precondition(proxy, lines);
        }
        lines.factor(&mesh.is_pinned);
    }

    /// Kinetic energy, J.
    pub(crate) fn kinetic_j(&self, v: impl Iterator<Item = Vector>) -> f64 {
        let each = self.mass_kg.iter().zip(v);
        each.map(|(mass, v)| 0.5 * mass * v.norm_squared()).sum()
    }

    /// Energy in the field of gravity, J; 0 at y = 0.
    pub(crate) fn height_j(&self, x: &[Vector], gravity: Vector) -> f64 {
        let cloth = &self.sheet.mesh.mass_kg;
        let weighted = |(mass, at): (&f64, &Vector)| -mass * gravity.dot(at);
        cloth.iter().zip(x).map(weighted).sum()
    }

    /// Whether all places are numbers.
    pub(crate) fn is_finite(x: &[Vector]) -> bool {
        dot(x, x).is_finite()
    }
}
