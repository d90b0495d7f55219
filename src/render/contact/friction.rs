//! Friction along the surface: Coulomb's with stick and slip, and a viscous part.
//!
//! The model of Dahl with the Stribeck curve of `LuGre` (Canudas de Wit et al. 1995, without its
//! bristle damping): bristles bend by ζ, `ζ' = v − σ|v|/g(v) ζ`, `F = −σ ζ − c v`,
//! `g(v) = N (µ_k + (µ_s − µ_k) exp(−(v/v_s)²))`. A step takes the decay at its end,
//! `ζ⁺ = (ζ + h v)/(1 + h σ|v|/g)`, which is bounded by g/σ at any step, and bristles never bend
//! farther than the load of the moment holds: when it falls, energy is lost, never won.

use std::sync::Arc;

use crate::RenderError;
use selvedge_foundation::numerics::at_place;
use selvedge_textile::surface::FrictionTrace;

/// How a tip rubs.
#[derive(Debug, Clone)]
pub struct Friction {
    /// Coefficient at rest, `µ_s`.
    pub at_rest: f64,
    /// Coefficient when sliding, `µ_k`.
    pub sliding: f64,
    /// Speed `v_s` at which rest gives way to sliding, mm/s.
    pub stribeck_mm_per_s: f64,
    /// Stiffness σ of the bristles, N/m.
    pub bristle_n_per_m: f64,
    /// Viscous friction c, N·s/m.
    pub viscous_n_s_per_m: f64,
    /// The measured coefficient along u, which then takes the place of both: rest is as many times
    /// above sliding as said.
    pub trace: Option<Arc<FrictionTrace>>,
}

impl Friction {
    /// None at all.
    pub fn none() -> Self {
        Self::coulomb(0.0)
    }

    /// Coulomb friction of one coefficient, rest a tenth above sliding.
    pub fn coulomb(mu: f64) -> Self {
        Self {
            at_rest: 1.1 * mu,
            sliding: mu,
            stribeck_mm_per_s: 5.0,
            bristle_n_per_m: 10_000.0,
            viscous_n_s_per_m: 0.0,
            trace: None,
        }
    }

    /// Refuses what is no friction.
    pub(super) fn check(&self) -> Result<(), RenderError> {
        for (name, value, unit, range) in [
            ("friction", self.sliding, "N/N", [0.0, 10.0]),
            ("friction at rest", self.at_rest, "N/N", [0.0, 10.0]),
            (
                "Stribeck speed",
                self.stribeck_mm_per_s,
                "mm/s",
                [1e-6, 1e6],
            ),
            (
                "bristles' stiffness",
                self.bristle_n_per_m,
                "N/m",
                [1e-6, 1e9],
            ),
            (
                "viscous friction",
                self.viscous_n_s_per_m,
                "N·s/m",
                [0.0, 1e6],
            ),
        ] {
            RenderError::within((name, value, unit), range)?;
        }
        Ok(())
    }

    /// Coefficients at rest and sliding at a place, u in mm.
    fn coefficients(&self, u_mm: f64) -> [f64; 2] {
        let Some(trace) = &self.trace else {
            return [self.at_rest, self.sliding];
        };
        let n = trace.mu().len() as f64;
        // There and back, as a profile goes on.
        let folded = (u_mm / trace.step_mm()).rem_euclid(2.0 * n);
        let place = folded.min(2.0 * n - 1.0 - folded).max(0.0);
        let mu = at_place(trace.mu(), place).max(0.0);
        let ratio = self.at_rest / self.sliding;
        [mu * if ratio.is_finite() { ratio } else { 1.0 }, mu]
    }

    /// What holds a tip under a load at a place, N, by its speed.
    fn holds_n(&self, load_n: f64, u_mm: f64, speed_m_per_s: f64) -> f64 {
        let [rest, sliding] = self.coefficients(u_mm);
        let slip = 1e3 * speed_m_per_s / self.stribeck_mm_per_s;
        load_n * (sliding + (rest - sliding) * (-slip * slip).exp())
    }
}

/// The bent bristles of a tip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Bristles {
    bend_m: [f64; 2],
    /// The friction of the latest step, N.
    force_n: [f64; 2],
}

/// Friction over one step as a function of the velocity at its end: `−(held + c v⁺)` on each axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hold {
    pub(super) held_n: [f64; 2],
    /// N·s/m.
    pub(super) drag: f64,
    decay: f64,
    most_m: f64,
}

impl Bristles {
    /// What holds the tip over a step of `step_s` that begins with a velocity under a load.
    pub(super) fn hold(
        &self,
        friction: &Friction,
        (load_n, u_mm): (f64, f64),
        velocity_m_per_s: [f64; 2],
        step_s: f64,
    ) -> Hold {
        let speed = velocity_m_per_s[0].hypot(velocity_m_per_s[1]);
        let holds_n = friction.holds_n(load_n, u_mm, speed);
        let sigma = friction.bristle_n_per_m;
        let most_m = holds_n / sigma;
        if most_m <= 0.0 {
            return Hold {
                held_n: [0.0; 2],
                drag: friction.viscous_n_s_per_m,
                decay: f64::INFINITY,
                most_m: 0.0,
            };
        }
        let decay = 1.0 + step_s * speed / most_m;
        Hold {
            held_n: self.bend_m.map(|bend| sigma * bend / decay),
            drag: friction.viscous_n_s_per_m + step_s * sigma / decay,
            decay,
            most_m,
        }
    }

    /// Bends the bristles by the velocity at the step's end and gives the friction there, N.
    pub(super) fn bend(
        &mut self,
        friction: &Friction,
        hold: &Hold,
        velocity_m_per_s: [f64; 2],
        step_s: f64,
    ) -> [f64; 2] {
        let moved =
            [0, 1].map(|axis| (self.bend_m[axis] + step_s * velocity_m_per_s[axis]) / hold.decay);
        let length = moved[0].hypot(moved[1]);
        let kept = if length > hold.most_m {
            hold.most_m / length
        } else {
            1.0
        };
        self.bend_m = moved.map(|bend| kept * bend);
        self.force_n = [0, 1].map(|axis| {
            let bristles = friction.bristle_n_per_m * self.bend_m[axis];
            -bristles - friction.viscous_n_s_per_m * velocity_m_per_s[axis]
        });
        self.force_n
    }

    /// How large the friction of the latest step was, N.
    pub(super) fn size_n(&self) -> f64 {
        self.force_n[0].hypot(self.force_n[1])
    }
}
