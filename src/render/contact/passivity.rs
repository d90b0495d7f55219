//! The passivity observer and controller of Hannaford & Ryu (2002).
//!
//! A surface may store energy and waste it, not make it. The observer counts what it gave,
//! `−Σ F_{k−1}·(x_k − x_{k−1})`: exact for a force that is held. Whenever more came out than went
//! in, the controller adds just the damping that takes the rest back over the next period,
//! `α = −W/(T v²)`; never more than half a mass a period, which a held force could not brake.

/// Counts the energy of a held force, and damps what it made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passivity {
    /// What the surface took, less what it gave, J; below 0 it is active.
    energy_j: f64,
    held_n: [f64; 3],
    place_mm: Option<[f64; 3]>,
    /// The largest damping, N·s/m.
    max_damping: f64,
    is_controller: bool,
}

impl Passivity {
    /// An observer, which is a controller too if it may change forces, of a mass that is sampled
    /// with a period.
    pub fn new(mass_kg: f64, period_s: f64, is_controller: bool) -> Self {
        Self {
            energy_j: 0.0,
            held_n: [0.0; 3],
            place_mm: None,
            max_damping: 0.5 * mass_kg / period_s,
            is_controller,
        }
    }

    /// Forgets what was observed.
    pub(super) fn forget(&mut self) {
        (self.energy_j, self.held_n, self.place_mm) = (0.0, [0.0; 3], None);
    }

    /// What the surface took so far, less what it gave, J.
    pub fn energy_j(&self) -> f64 {
        self.energy_j
    }

    /// The force to hold from this place on, instead of the one that was asked for, N.
    pub(super) fn pass(
        &mut self,
        place_mm: [f64; 3],
        asked_n: [f64; 3],
        period_s: f64,
    ) -> [f64; 3] {
        let before_mm = self.place_mm.unwrap_or(place_mm);
        let moved_m = [0, 1, 2].map(|axis| 1e-3 * (place_mm[axis] - before_mm[axis]));
        let work_j: f64 = (0..3).map(|axis| self.held_n[axis] * moved_m[axis]).sum();
        self.energy_j -= work_j;
        self.place_mm = Some(place_mm);
        let moved2: f64 = moved_m.iter().map(|m| m * m).sum();
        self.held_n = asked_n;
        if self.is_controller && self.energy_j < 0.0 && moved2 > 0.0 {
            let damping = (-self.energy_j * period_s / moved2).min(self.max_damping);
            self.held_n = [0, 1, 2].map(|axis| asked_n[axis] - damping * moved_m[axis] / period_s);
        }
        self.held_n
    }
}
