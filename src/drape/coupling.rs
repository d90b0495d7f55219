//! Between a hand and its proxy: a spring with a damper that never pulls with more than 5 N, led at
//! most at 1 m/s.

use super::mesh::Vector;

/// Mass of a proxy, kg.
pub(crate) const PROXY_KG: f64 = 0.02;
/// Stiffness of the coupling between hand and proxy, N/m.
const COUPLING_N_PER_M: f64 = 500.0;
/// The largest force that it gives, N.
const MAX_FORCE_N: f64 = 5.0;
/// The fastest that the proxy is led, m/s.
const MAX_SPEED_M_PER_S: f64 = 1.0;

/// The coupling as one spring to one place, in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Coupling {
    stiffness: f64,
    pub(crate) centre: Vector,
    /// Force on the hand, N.
    pub(crate) force: Vector,
    /// Force for each length from the centre, N/m.
    pub(crate) tangent: f64,
}

impl Coupling {
    /// Spring and damper between a hand, here and moving so, and a proxy whose velocity is
    /// `σ (x − hat)`, as one spring.
    pub(crate) fn new((target, speed): (Vector, Vector), hat: Vector, sigma: f64) -> Self {
        let damping = 2.0 * (COUPLING_N_PER_M * PROXY_KG).sqrt();
        let stiffness = COUPLING_N_PER_M + damping * sigma;
        let damped = hat * sigma + speed;
        Self {
            stiffness,
            centre: (target * COUPLING_N_PER_M + damped * damping) / stiffness,
            force: Vector::zeros(),
            tangent: stiffness,
        }
    }

    /// Pulls a proxy that is at `x`; says the energy.
    pub(crate) fn pull(&mut self, x: Vector) -> f64 {
        let off = x - self.centre;
        let (value, tangent) = bounded_spring(self.stiffness, off.norm());
        self.force = off * tangent;
        self.tangent = tangent;
        value
    }

    /// What its spring alone holds, stretched so far, J.
    pub(crate) fn stored_j(stretched_m: f64) -> f64 {
        bounded_spring(COUPLING_N_PER_M, stretched_m).0
    }

    /// Whether it gives the largest force.
    pub(crate) fn is_at_limit(&self) -> bool {
        self.tangent < self.stiffness
    }
}

/// How a place that is led towards another moves in a step, m: not faster than it may, and not at
/// all towards one that is no number.
pub(crate) fn led(from: Vector, to: Vector, step_s: f64) -> Vector {
    let (way, most) = (to - from, MAX_SPEED_M_PER_S * step_s);
    let length = way.norm();
    if !length.is_finite() {
        Vector::zeros()
    } else if length > most {
        way * (most / length)
    } else {
        way
    }
}

/// Energy of a spring that never pulls with more than the largest force, and its force per length.
fn bounded_spring(stiffness: f64, length: f64) -> (f64, f64) {
    if stiffness * length <= MAX_FORCE_N {
        return (0.5 * stiffness * length * length, stiffness);
    }
    let reach = MAX_FORCE_N / stiffness;
    (MAX_FORCE_N * (length - 0.5 * reach), MAX_FORCE_N / length)
}
