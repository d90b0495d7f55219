//! What fingers feel between steps that are longer than a millisecond: at 1 kHz, each proxy by
//! itself against what is known of the cloth.
//!
//! At the end of a step the cloth answers proxies with `F − D (x − x_k)`, D the Schur complement of
//! the step's tangent on both. It pushes only, within friction's cone, and is held where it is
//! after two steps without news. Points of a pad are 7.5e6 Pa/m stiff at most, so `D < 1500 N/m`;
//! a tick of 1 ms late, the coupling's damper holds `B/(T/2 + T) = 4200 N/m`.

use nalgebra::{SMatrix, SVector};

use super::cloth::Cloth;
use super::coupling::{Coupling, PROXY_KG, led};
use super::mesh::Vector;

/// Between ticks, s.
pub(crate) const TICK_S: f64 = 1e-3;
/// Steps of the cloth after which its answer is held.
const HELD_AFTER: f64 = 2.0;
/// Times that a tick is solved, each with what was found to be clipped.
const N_PASSES: usize = 3;

/// The proxies between steps of the cloth.
#[derive(Debug, Clone)]
pub(crate) struct Local {
    fingers: Vec<LocalFinger>,
    /// What moving them takes at most, N/m.
    met: SMatrix<f64, 6, 6>,
    since_s: f64,
}

/// A proxy, and what the cloth answered it last.
#[derive(Debug, Clone, Copy)]
struct LocalFinger {
    x: Vector,
    v: Vector,
    target: Vector,
    coupling: Coupling,
    /// Place and force of the last step.
    known_at: Vector,
    known_n: Vector,
    normal: Option<Vector>,
    friction: f64,
    /// The force where it is not that of D, N.
    clipped_n: Option<Vector>,
    /// The force at the last tick, N.
    answered_n: Vector,
}

impl Local {
    /// Proxies where those of a cloth are.
    pub(crate) fn new(cloth: &Cloth) -> Self {
        let n_cloth = cloth.system.sheet.mesh.n_vertices();
        let fingers = cloth.fingers().iter().zip(&cloth.x[n_cloth..]);
        let fingers = fingers.map(|(finger, x)| LocalFinger {
            x: *x,
            v: Vector::zeros(),
            target: finger.target,
            coupling: Coupling::default(),
            known_at: *x,
            known_n: Vector::zeros(),
            normal: None,
            friction: finger.friction,
            clipped_n: None,
            answered_n: Vector::zeros(),
        });
        Self {
            fingers: fingers.collect(),
            met: SMatrix::zeros(),
            since_s: 0.0,
        }
    }

    /// Learns what the cloth answers after a step.
    pub(crate) fn learn(&mut self, cloth: &mut Cloth) {
        let n_cloth = cloth.system.sheet.mesh.n_vertices();
        let is_touched = cloth.fingers().iter().any(|finger| finger.press_n() > 0.0);
        self.met = SMatrix::zeros();
        if is_touched {
            let Cloth {
                system, newton, x, ..
            } = cloth;
            // Of the last evaluation are the forces, too.
            for (node, own) in self.fingers.iter_mut().enumerate() {
                let lag = &system.lag;
                let inertia = (x[n_cloth + node] - lag.free[n_cloth + node]) * lag.mu;
                let coupled = system.fingers[node].coupling.force;
                let all = newton.grad[n_cloth + node];
                own.known_n = inertia * PROXY_KG + coupled - all;
            }
            let met = newton.met_by_fingers(system, x);
            self.met = SMatrix::from_fn(|row, column| 0.5 * (met[row][column] + met[column][row]));
        }
        for ((own, finger), x) in self
            .fingers
            .iter_mut()
            .zip(cloth.fingers())
            .zip(&cloth.x[n_cloth..])
        {
            own.known_at = *x;
            own.normal = finger.normal();
            if own.normal.is_none() {
                own.known_n = Vector::zeros();
            }
        }
        self.since_s = 0.0;
    }

    /// Leads proxies towards where hands are for a millisecond.
    pub(crate) fn tick(&mut self, targets: &[Vector], step_s: f64) {
        self.since_s += TICK_S;
        let is_held = self.since_s > HELD_AFTER * step_s + 1e-9;
        for (own, target) in self.fingers.iter_mut().zip(targets) {
            let moved = led(own.target, *target, TICK_S);
            own.target += moved;
            own.coupling = Coupling::new((own.target, moved / TICK_S), own.x, TICK_S.recip());
            own.clipped_n = is_held.then_some(own.answered_n);
        }
        let mut x = self.at();
        for _ in 0..N_PASSES {
            x = self.solved(x);
            let answered = self.answered(x);
            let mut is_done = true;
            for (nth, own) in self.fingers.iter_mut().enumerate() {
                let free: Vector = answered.fixed_rows::<3>(3 * nth).into();
                let held = own.within_cone(free);
                if own.clipped_n.is_none() && held != free {
                    own.clipped_n = Some(held);
                    is_done = false;
                }
            }
            let is_bounded = self.fingers.iter().any(|own| own.coupling.is_at_limit());
            if is_done && !is_bounded {
                break;
            }
        }
        let answered = self.answered(x);
        for (nth, own) in self.fingers.iter_mut().enumerate() {
            let free = answered.fixed_rows::<3>(3 * nth).into();
            own.answered_n = own.clipped_n.unwrap_or(free);
            let to: Vector = x.fixed_rows::<3>(3 * nth).into();
            own.coupling.pull(to);
            own.v = (to - own.x) / TICK_S;
            own.x = to;
        }
    }

    /// Force on a hand, N.
    pub(crate) fn force_n(&self, finger: usize) -> Vector {
        self.fingers
            .get(finger)
            .map_or_else(Vector::zeros, |own| own.coupling.force)
    }

    fn at(&self) -> SVector<f64, 6> {
        let mut x = SVector::<f64, 6>::zeros();
        for (nth, own) in self.fingers.iter().enumerate() {
            x.fixed_rows_mut::<3>(3 * nth).copy_from(&own.x);
        }
        x
    }

    /// `F − D (x − x_k)` of all.
    fn answered(&self, x: SVector<f64, 6>) -> SVector<f64, 6> {
        let (mut known, mut moved) = (SVector::<f64, 6>::zeros(), x);
        for (nth, own) in self.fingers.iter().enumerate() {
            known.fixed_rows_mut::<3>(3 * nth).copy_from(&own.known_n);
            let mut part = moved.fixed_rows_mut::<3>(3 * nth);
            part -= own.known_at;
        }
        known - self.met * moved
    }

    /// Implicit Euler over a tick: inertia, coupling as it pulls at `x`, and the cloth's answer.
    fn solved(&mut self, x: SVector<f64, 6>) -> SVector<f64, 6> {
        let weight = PROXY_KG / (TICK_S * TICK_S);
        let (mut matrix, mut side) = (self.met, self.answered(SVector::zeros()));
        for (nth, own) in self.fingers.iter_mut().enumerate() {
            own.coupling.pull(x.fixed_rows::<3>(3 * nth).into());
            let first = 3 * nth;
            if let Some(held) = own.clipped_n {
                matrix.fixed_rows_mut::<3>(first).fill(0.0);
                side.fixed_rows_mut::<3>(first).copy_from(&held);
            }
            let free =
                (own.x + own.v * TICK_S) * weight + own.coupling.centre * own.coupling.tangent;
            let mut part = side.fixed_rows_mut::<3>(first);
            part += free;
            for side in first..first + 3 {
                matrix[(side, side)] += weight + own.coupling.tangent;
            }
        }
        for rest in 3 * self.fingers.len()..6 {
            matrix[(rest, rest)] = 1.0;
        }
        matrix.lu().solve(&side).unwrap_or(x)
    }
}

impl LocalFinger {
    /// What of a force the cloth can give: it pushes only, and holds as far as friction does.
    fn within_cone(&self, force: Vector) -> Vector {
        let Some(normal) = self.normal else {
            return Vector::zeros();
        };
        let pushed = normal.dot(&force);
        if pushed <= 0.0 {
            return Vector::zeros();
        }
        let along = force - normal * pushed;
        let (most, length) = (self.friction * pushed, along.norm());
        if length <= most {
            return force;
        }
        normal * pushed + along * (most / length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cloth_pushes_only_and_holds_as_far_as_friction_does() {
        let mut own = LocalFinger {
            x: Vector::zeros(),
            v: Vector::zeros(),
            target: Vector::zeros(),
            coupling: Coupling::default(),
            known_at: Vector::zeros(),
            known_n: Vector::zeros(),
            normal: Some(Vector::z()),
            friction: 0.5,
            clipped_n: None,
            answered_n: Vector::zeros(),
        };
        for (force, expected) in [
            ([0.3, 0.0, 1.0], [0.3, 0.0, 1.0]),
            ([0.0, -2.0, 1.0], [0.0, -0.5, 1.0]),
            ([0.1, 0.0, -1.0], [0.0, 0.0, 0.0]),
        ] {
            assert_eq!(own.within_cone(force.into()), Vector::from(expected));
        }
        own.normal = None;
        assert_eq!(own.within_cone(Vector::z()), Vector::zeros());
    }
}
