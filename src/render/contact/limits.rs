//! What can be held: textbook limits beside the exact eigenvalues, and what follows for a setting.
//!
//! A mass m with damping b, sampled every T, is held by a wall `K, B` whose force is late by a
//! delay `t_d` of whole ticks; velocity is the backward difference. The exact loop is
//! `z^{N+1} P(z) + ((K + B/T) z − B/T) Q(z) = 0`, P and Q of the exactly held plant, N the ticks of
//! delay. Known limits: passive while `b > K (T/2 + t_d) + |B|` (Colgate & Schenkel 1997),
//! stable about while `K < (b + B)/(T/2 + t_d)`, free of limit cycles while
//! `K ≤ min(2b/T, 2f_c/Δ)` (Abbott & Okamura 2005).
//!
//! The same question of a stepper: see the table in [`super::stepper`].

use super::stepper::Stepper;
use selvedge_foundation::named;
use selvedge_foundation::numerics::ode::{LinearSystem, Propagator, StepMethod};
use selvedge_foundation::numerics::{bisected, to_whole};

/// A growth a step that rounding may feign.
const ROUNDING: f64 = 1e-9;
/// Stiffnesses between which a limit is looked for, N/m.
const STIFFNESSES: [f64; 2] = [1e-6, 1e12];
/// Ratio of those that are tried in turn.
const RATIO: f64 = 1.25;
/// Below this a limit is none: rounding feigns it, N/m.
const NO_LIMIT: f64 = 1e-2;
/// A part of 1/ω as long as which a step of a cloth is smooth.
const SMOOTH: f64 = 0.3;
/// Halvings after that.
const HALVINGS: u32 = 60;

named! {
    /// What becomes of a tip on a wall.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum Standing {
        /// The wall never gives more energy than it took.
        Stable = "stable",
        /// Motion stays bounded, but the wall may give energy: it can chatter in a hand.
        Active = "active",
        /// Motion grows.
        Unstable = "unstable",
    }
    /// Its word, for people.
    pub fn word;
}

/// A mass on a wall, and how its force comes about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallCase {
    /// Mass m, kg.
    pub mass_kg: f64,
    /// The device's damping b, N·s/m.
    pub damping_n_s_per_m: f64,
    /// The wall's stiffness K, N/m.
    pub stiffness_n_per_m: f64,
    /// The wall's damping B, N·s/m.
    pub wall_damping_n_s_per_m: f64,
    /// Period of sampling, or step, s.
    pub period_s: f64,
    /// The force is sampled and held, so many ticks late; without this it acts at all times, and
    /// the stepper decides.
    pub delay_ticks: Option<usize>,
    /// The stepper of what acts at all times.
    pub method: Stepper,
}

/// The largest stiffnesses, N/m, by different arguments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffnessLimits {
    /// `2 (b − |B|)/(T + 2 t_d)`: passive.
    pub passive: f64,
    /// `(b + B)/(T/2 + t_d)`: the rule of thumb.
    pub rule: f64,
    /// `min(2b/T, 2f_c/Δ)`: no limit cycles.
    pub quiet: f64,
    /// By the eigenvalues themselves; infinite where every stiffness is held.
    pub exact: f64,
}

impl WallCase {
    /// The same with another stiffness.
    #[must_use]
    pub fn with_stiffness(self, stiffness_n_per_m: f64) -> Self {
        Self {
            stiffness_n_per_m,
            ..self
        }
    }

    /// Whether it is held, by eigenvalues and by energy.
    pub fn standing(&self) -> Standing {
        let is_wall = self.stiffness_n_per_m > 0.0 || self.wall_damping_n_s_per_m > 0.0;
        if self.delay_ticks.is_some() {
            let is_passive = !is_wall || self.needed_damping() <= self.damping_n_s_per_m;
            return match (is_passive, self.is_bounded()) {
                (true, _) => Standing::Stable,
                (false, true) => Standing::Active,
                (false, false) => Standing::Unstable,
            };
        }
        let never_gains = match self.method {
            Stepper::Trapezoid | Stepper::ImplicitEuler | Stepper::Exact | Stepper::Auto => true,
            Stepper::SemiImplicitEuler => self.damping_n_s_per_m >= self.needed_damping(),
            Stepper::ExplicitEuler | Stepper::RungeKutta4 => false,
        };
        match (never_gains, self.is_bounded()) {
            (true, true) => Standing::Stable,
            (false, true) => Standing::Active,
            _ => Standing::Unstable,
        }
    }

    /// The damping of the device that makes it passive, N·s/m.
    fn needed_damping(&self) -> f64 {
        let (k, wall, t) = (
            self.stiffness_n_per_m,
            self.wall_damping_n_s_per_m,
            self.period_s,
        );
        match self.delay_ticks {
            Some(ticks) => k * t * (0.5 + ticks as f64) + wall.abs(),
            // What a step of the damper at its start may overshoot by.
            None => 0.5 * k * t + (0.5 * t * wall * wall / self.mass_kg - wall).max(0.0),
        }
    }

    /// Whether no eigenvalue lies beyond the unit circle.
    fn is_bounded(&self) -> bool {
        match self.delay_ticks {
            Some(ticks) => {
                let all = self.characteristic(ticks);
                all.is_some_and(|all| is_left(&all))
            }
            None => self
                .step_growth()
                .is_some_and(|growth| growth <= 1.0 + ROUNDING),
        }
    }

    /// Coefficients of the characteristic polynomial of the sampled loop in y, the constant first;
    /// `z = (1 + y)/(1 − y)`. Roots near z = 1, of which there are three in a fast loop, are near
    /// y = 0, where no digit of them is lost.
    fn characteristic(&self, ticks: usize) -> Option<Vec<f64>> {
        let t = self.period_s;
        let held = self.plant(0.0, self.damping_n_s_per_m, StepMethod::ExactHold)?;
        let ([[_, p], _], [[near], [speed]]) = (held.state, held.input);
        let lost = -(-self.damping_n_s_per_m * t / self.mass_kg).exp_m1();
        let far = near * lost + p * speed;
        // With x = z − 1 = 2y/(1 − y): x (x + lost) z^{N+1} + (K + (K + B/T) x) (near x + far).
        let (k, wall) = (self.stiffness_n_per_m, self.wall_damping_n_s_per_m / t);
        let mut free = vec![0.0, 2.0 * lost, 2.0 * (2.0 - lost)];
        let mut held = times(&[k, k + 2.0 * wall], &[far, 2.0 * near - far]);
        for _ in 0..=ticks {
            free = times(&free, &[1.0, 1.0]);
            held = times(&held, &[1.0, -1.0]);
        }
        Some(free.iter().zip(&held).map(|(a, b)| a + b).collect())
    }

    /// A step of a mass on a spring by a method.
    fn plant(&self, k: f64, c: f64, method: StepMethod) -> Option<Propagator<2, 1>> {
        let m = self.mass_kg;
        let system = LinearSystem {
            a: [[0.0, 1.0], [-k / m, -c / m]],
            b: [[0.0], [1.0 / m]],
        };
        system.propagator::<3>(method, self.period_s)
    }

    /// The largest |eigenvalue| of a stepper in contact.
    fn step_growth(&self) -> Option<f64> {
        let (m, b, k, t) = (
            self.mass_kg,
            self.damping_n_s_per_m,
            self.stiffness_n_per_m,
            self.period_s,
        );
        let wall = self.wall_damping_n_s_per_m;
        let [[a, x], [y, d]] = match self.method {
            Stepper::ExplicitEuler => [[1.0, t], [-t * k / m, 1.0 - t * (b + wall) / m]],
            Stepper::SemiImplicitEuler => {
                let inertia = m + t * b;
                let kept = (m - t * wall) / inertia;
                [
                    [1.0 - t * t * k / inertia, t * kept],
                    [-t * k / inertia, kept],
                ]
            }
            Stepper::RungeKutta4 => self.plant(k, b + wall, StepMethod::RungeKutta4)?.state,
            Stepper::Trapezoid | Stepper::ImplicitEuler | Stepper::Exact | Stepper::Auto => {
                return Some(1.0);
            }
        };
        // Of λ² − (a + d) λ + (a d − x y).
        let (half, product) = (0.5 * (a + d), a * d - x * y);
        let inside = half * half - product;
        let growth = if inside < 0.0 {
            product.max(0.0).sqrt()
        } else {
            half.abs() + inside.sqrt()
        };
        growth.is_finite().then_some(growth)
    }

    /// The largest stiffnesses that are held, for a device of this Coulomb friction, N, and
    /// resolution, mm.
    pub fn stiffness_limits(&self, friction_n: f64, resolution_mm: f64) -> StiffnessLimits {
        let (b, wall) = (self.damping_n_s_per_m, self.wall_damping_n_s_per_m);
        let late_s = self.period_s * (0.5 + self.delay_ticks.unwrap_or(0) as f64);
        let by_friction = if resolution_mm > 0.0 {
            2e3 * friction_n / resolution_mm
        } else {
            f64::INFINITY
        };
        StiffnessLimits {
            passive: ((b - wall.abs()) / late_s).max(0.0),
            rule: (b + wall) / late_s,
            quiet: (2.0 * b / self.period_s).min(by_friction),
            exact: self.largest_stiffness(),
        }
    }

    /// The stiffness above which eigenvalues leave the unit circle, N/m.
    fn largest_stiffness(&self) -> f64 {
        let is_held = |k: f64| self.with_stiffness(k).is_bounded();
        let [mut below, last] = STIFFNESSES;
        if !is_held(below) {
            return 0.0;
        }
        while below < last {
            if !is_held(below * RATIO) {
                let limit = bisected([below, below * RATIO], HALVINGS, is_held);
                return if limit < NO_LIMIT { 0.0 } else { limit };
            }
            below *= RATIO;
        }
        f64::INFINITY
    }

    /// The lowest rate at which it is held, Hz, up to 1 MHz.
    fn needed_rate_hz(&self) -> Option<f64> {
        let at = |rate_hz: f64| {
            let case = Self {
                period_s: 1.0 / rate_hz,
                ..*self
            };
            case.is_bounded()
        };
        let start_hz = 1.0 / self.period_s;
        let rates = (1..=100).map(|n| start_hz * RATIO.powi(n));
        let held_hz = rates.take_while(|hz| *hz <= 1e6).find(|hz| at(*hz))?;
        Some(bisected([held_hz / RATIO, held_hz], 30, |hz| !at(hz)))
    }

    /// What a person should know of the setting: one line.
    pub fn advice(&self) -> String {
        let (k, hz) = (
            rounded(self.stiffness_n_per_m),
            rounded(1.0 / self.period_s),
        );
        let limit = rounded(self.largest_stiffness());
        let is_sampled = self.delay_ticks.is_some();
        let name = self.method.name();
        match (self.standing(), is_sampled) {
            (Standing::Stable, true) => format!("{k} N/m sampled at {hz} Hz is passive"),
            (Standing::Stable, false) => format!("{name} holds {k} N/m at {hz} Hz"),
            (Standing::Active, true) => format!(
                "{k} N/m sampled at {hz} Hz is stable up to {limit} N/m but not passive (the \
                 device would need {} N·s/m of damping): it may chatter in a hand",
                rounded(self.needed_damping())
            ),
            (Standing::Active, false) => format!(
                "{name} keeps {k} N/m at {hz} Hz bounded, up to {limit} N/m, but may give energy \
                 at contact; exact and implicit-euler never do"
            ),
            (Standing::Unstable, true) => {
                let rate = self.needed_rate_hz().map_or_else(
                    || "; no rate up to 1 MHz helps".to_owned(),
                    |hz| format!(", or sample at {} Hz or more", rounded(hz.ceil())),
                );
                format!(
                    "no method can hold {k} N/m sampled at {hz} Hz: the loop itself grows above \
                     {limit} N/m; lower the stiffness or add damping{rate}"
                )
            }
            (Standing::Unstable, false) => format!(
                "{name} cannot hold {k} N/m in steps of 1/{hz} s: it is stable up to {limit} N/m; \
                 exact, trapezoid and implicit-euler hold any stiffness"
            ),
        }
    }

    /// Which stepper `auto` takes, and why, for a law that is piecewise linear or not.
    pub fn choose(&self, is_linear: bool) -> (Stepper, String) {
        let turned = self.period_s * (self.stiffness_n_per_m / self.mass_kg).sqrt();
        let phase = format!("h √(K/m) = {}", rounded(turned));
        let (method, why) = if self.delay_ticks.is_some() {
            let why = "a held force leaves a linear plant, which is stepped exactly";
            return (Stepper::Exact, why.to_owned());
        } else if is_linear {
            let why = "the wall is piecewise linear, so its solution is known";
            (Stepper::Exact, why)
        } else if turned <= SMOOTH {
            let why = "the cloth is not linear, but smooth within such a step";
            (Stepper::Trapezoid, why)
        } else {
            let why = "the cloth is not linear, and too stiff for such a step but by its end";
            (Stepper::ImplicitEuler, why)
        };
        (method, format!("{phase}; {why}"))
    }
}

/// The product of two polynomials.
fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            product[i + j] += x * y;
        }
    }
    product
}

/// Whether no root of a polynomial, the constant first, has a positive real part (Routh). A root
/// at 0 is that of a mass that nothing holds in its place.
fn is_left(all: &[f64]) -> bool {
    let all = if all[0] == 0.0 { &all[1..] } else { all };
    let of = |first: usize| all.iter().rev().skip(first).step_by(2).copied().collect();
    let (mut above, mut row): (Vec<f64>, Vec<f64>) = (of(0), of(1));
    while let Some(&first) = row.first() {
        let ratio = above[0] / first;
        if !(ratio > 0.0 && ratio.is_finite()) {
            return false;
        }
        let at = |of: &[f64], i: usize| of.get(i).copied().unwrap_or(0.0);
        let next = (1..above.len())
            .map(|i| above[i] - ratio * at(&row, i))
            .collect();
        above = std::mem::replace(&mut row, next);
    }
    true
}

/// A number with four digits at most.
fn rounded(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = 3 - to_whole::<i32>(x.abs().log10().floor().clamp(-9.0, 9.0));
    let scale = 10.0_f64.powi(digits);
    let four = (x * scale).round() / scale;
    if (1e-3..1e7).contains(&x.abs()) {
        format!("{four}")
    } else {
        format!("{x:.3e}")
    }
}
