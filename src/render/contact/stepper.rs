//! Steps of a mass that is pressed onto a surface, by six methods.
//!
//! `m z̈ = Σ f_i(h_i − z, ḣ_i − ż) + push − b ż` with the contacts of [`super::law`]. Where the
//! surface is at the start, in the middle and at the end of a step is known beforehand.
//!
//! | method | how | never gives energy |
//! |---|---|---|
//! | explicit Euler | all at the start | never certain |
//! | semi-implicit Euler | place after velocity, device's damping last | b ≥ K h/2, B ≤ 2m/h |
//! | Runge–Kutta 4 | four looks | never certain: the surface is no smooth force |
//! | trapezoid | spring by its mean over the step, `ΔU/Δd` | always, for linear springs |
//! | implicit Euler | all at the end | always; takes what it should not |
//! | exact | pieces in closed form, ends of contact located to rounding | always: it is the truth |
//!
//! In contact the trapezoid is the trapezoidal rule; where a step crosses the surface that rule
//! alone would pay out more than was put in. With B = 0 it keeps energy to rounding.

use serde::{Deserialize, Serialize};

use super::law::{Floor, Spring};
use selvedge_foundation::named;

/// Looks at a solution of an implicit step, or at the end of a contact.
const MAX_LOOKS: u32 = 100;

named! {
    /// A way to step a stylus.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Stepper {
        /// Euler's rule.
        ExplicitEuler = "explicit-euler",
        /// Velocity first, then place by the new velocity.
        SemiImplicitEuler = "semi-implicit-euler",
        /// The classical method of four stages.
        #[serde(rename = "rk4")]
        RungeKutta4 = "rk4",
        /// The trapezoidal rule, with the spring's mean over the step.
        Trapezoid = "trapezoid",
        /// Euler's rule backwards.
        ImplicitEuler = "implicit-euler",
        /// The solution itself, piece by piece.
        Exact = "exact",
        /// One of these, by stiffness and step.
        #[default]
        Auto = "auto",
    }
    /// Its name on the command line and in files.
    pub fn name;
}

impl std::str::FromStr for Stepper {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|one| one.name() == name);
        found.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("no method {name:?}; use one of {names}")
        })
    }
}

/// Place and velocity along z.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Motion {
    pub(super) z_m: f64,
    pub(super) v_m_per_s: f64,
}

/// What acts on a mass over one step.
#[derive(Debug)]
pub(super) struct Column<'a> {
    pub(super) mass_kg: f64,
    /// The device's own damping b, N·s/m.
    pub(super) damping: f64,
    /// Force that is held, N, up.
    pub(super) push_n: f64,
    pub(super) spring: &'a Spring,
    /// The surface under each contact at the start, in the middle and at the end.
    pub(super) floors: [&'a [Floor]; 3],
}

impl Column<'static> {
    /// A mass that touches nothing.
    pub(super) fn free(mass_kg: f64, damping: f64, push_n: f64) -> Self {
        Self {
            mass_kg,
            damping,
            push_n,
            spring: &Spring::NONE,
            floors: [&[]; 3],
        }
    }
}

impl Column<'_> {
    /// The motion after `step_s`. `Auto` steps exactly.
    pub(super) fn step(&self, method: Stepper, from: Motion, step_s: f64) -> Motion {
        let Motion { z_m, v_m_per_s: v } = from;
        let (m, b, h) = (self.mass_kg, self.damping, step_s);
        match method {
            Stepper::ExplicitEuler => Motion {
                z_m: z_m + h * v,
                v_m_per_s: v + h / m * (self.force_n(0, from) + self.push_n - b * v),
            },
            Stepper::SemiImplicitEuler => {
                let next = (m * v + h * (self.force_n(0, from) + self.push_n)) / (m + h * b);
                Motion {
                    z_m: z_m + h * next,
                    v_m_per_s: next,
                }
            }
            Stepper::RungeKutta4 => self.runge_kutta_4(from, h),
            Stepper::Trapezoid => self.solved(from, h, 0.5, |end| self.mean_n(from, end, h)),
            Stepper::ImplicitEuler => self.solved(from, h, 1.0, |end| self.end_n(end, h)),
            Stepper::Exact | Stepper::Auto => self.exact(from, h),
        }
    }

    /// The contacts' force with the surface of an instant, N.
    pub(super) fn force_n(&self, instant: usize, at: Motion) -> f64 {
        let floors = self.floors[instant].iter();
        floors
            .map(|floor| self.spring.force_n(floor, at.z_m, at.v_m_per_s))
            .sum()
    }

    /// The force at the end of a step, whose damper knows how far the surface rose over it: by the
    /// rise of the last instant it would pay out more than was put in.
    fn end_n(&self, end: Motion, h: f64) -> f64 {
        let pairs = self.floors[0].iter().zip(self.floors[2]);
        pairs
            .map(|(before, after)| {
                let rise_m_per_s = (after.height_m - before.height_m) / h;
                let floor = Floor {
                    rise_m_per_s,
                    ..*after
                };
                self.spring.force_n(&floor, end.z_m, end.v_m_per_s)
            })
            .sum()
    }

    fn runge_kutta_4(&self, from: Motion, h: f64) -> Motion {
        let rate = |instant: usize, at: Motion| {
            let force_n = self.force_n(instant, at) + self.push_n - self.damping * at.v_m_per_s;
            [at.v_m_per_s, force_n / self.mass_kg]
        };
        let along = |by_s: f64, rate: [f64; 2]| Motion {
            z_m: from.z_m + by_s * rate[0],
            v_m_per_s: from.v_m_per_s + by_s * rate[1],
        };
        let first = rate(0, from);
        let second = rate(1, along(0.5 * h, first));
        let third = rate(1, along(0.5 * h, second));
        let fourth = rate(2, along(h, third));
        let mean = [0, 1].map(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
        along(h, mean)
    }

    /// The mean force over a step: the spring's work over its way, and the damper where it touches.
    fn mean_n(&self, from: Motion, end: Motion, h: f64) -> f64 {
        let pairs = self.floors[0].iter().zip(self.floors[2]);
        pairs
            .map(|(before, after)| {
                if !self.spring.is_linear() {
                    let first = self.spring.force_n(before, from.z_m, from.v_m_per_s);
                    let last = self.spring.force_n(after, end.z_m, end.v_m_per_s);
                    return 0.5 * (first + last);
                }
                let depths = [before.height_m - from.z_m, after.height_m - end.z_m];
                let gone_m = depths[1] - depths[0];
                let [low, high] = [depths[0].min(depths[1]), depths[0].max(depths[1])];
                if high <= 0.0 {
                    return 0.0;
                }
                let touching = if low >= 0.0 { 1.0 } else { high / (high - low) };
                let mean_n = self.spring.mean_n(after, [low, high]);
                let damper_n = touching * self.spring.b * gone_m / h;
                (mean_n + damper_n).clamp(0.0, self.spring.ceiling_n(after))
            })
            .sum()
    }

    /// The end of an implicit step that takes so much of the end and the rest of the start: the
    /// velocity between that of no contact and that of the force which this would meet.
    fn solved(&self, from: Motion, h: f64, theta: f64, force_n: impl Fn(Motion) -> f64) -> Motion {
        let (m, b, v) = (self.mass_kg, self.damping, from.v_m_per_s);
        let end = |next: f64| Motion {
            z_m: from.z_m + h * (theta * next + (1.0 - theta) * v),
            v_m_per_s: next,
        };
        let inertia = m + theta * h * b;
        let free = (m * v + h * (self.push_n - (1.0 - theta) * b * v)) / inertia;
        let by = |next: f64| free + h / inertia * force_n(end(next));
        let (low, high) = (free, by(free));
        if high <= low {
            return end(low);
        }
        // Below, what the force makes of a velocity lies above it; above, below it.
        let miss = |next: f64| next - by(next);
        let [low, high] = crossing([(low, low - high), (high, miss(high))], 0.0, miss);
        end(0.5 * (low + high))
    }
}

/// The ends, nearer than `near` or to rounding, between which a function crosses 0, from two places
/// where its values have different signs: by the parabola through the last three places where it
/// rises or falls throughout, else by halves (Chandrupatla 1997).
pub(super) fn crossing(
    [mut near_end, mut far_end]: [(f64, f64); 2],
    near: f64,
    value: impl Fn(f64) -> f64,
) -> [f64; 2] {
    let chord = near_end.1 / (near_end.1 - far_end.1);
    let mut share = if chord.is_finite() { chord } else { 0.5 };
    for _ in 0..MAX_LOOKS {
        let width = far_end.0 - near_end.0;
        let least = near + 4.0 * f64::EPSILON * (near_end.0.abs() + far_end.0.abs());
        if width.abs() <= least {
            break;
        }
        let edge = (least / width.abs()).min(0.5);
        let place = near_end.0 + share.clamp(edge, 1.0 - edge) * width;
        let at = value(place);
        if at == 0.0 {
            return [place; 2];
        }
        // The end of the same sign gives way.
        let gone = if (at < 0.0) == (near_end.1 < 0.0) {
            near_end
        } else {
            std::mem::replace(&mut far_end, near_end)
        };
        near_end = (place, at);
        let [of_places, of_values] = [
            (near_end.0 - far_end.0) / (gone.0 - far_end.0),
            (near_end.1 - far_end.1) / (gone.1 - far_end.1),
        ];
        let is_even = of_values * of_values < of_places
            && (1.0 - of_values) * (1.0 - of_values) < 1.0 - of_places;
        share = if is_even {
            let (a, b, c) = (near_end, far_end, gone);
            let by_chord = a.1 / (b.1 - a.1) * (c.1 / (b.1 - c.1));
            let bent = (c.0 - a.0) / (b.0 - a.0) * (a.1 / (c.1 - a.1)) * (b.1 / (c.1 - b.1));
            by_chord + bent
        } else {
            0.5
        };
    }
    [near_end.0.min(far_end.0), near_end.0.max(far_end.0)]
}
