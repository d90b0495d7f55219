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

use super::kernel::Kernel;
use super::law::{Floor, Spring};
use selvedge_foundation::named;

/// Looks at a solution of an implicit step, or at the end of a contact.
const MAX_LOOKS: u32 = 100;
/// How exactly the end of a contact is located, as a part of its piece.
const EVENT: f64 = 1e-12;
/// Looks that move the same end, after which halves are tried.
const SLOW: i32 = 3;
/// Pieces of one step at which a stiff wall that rings is taken as it is.
const MAX_PIECES: u32 = 1_000_000;
/// How long a piece may be, as a part of 1/ω: an eighth of a period.
const PIECE: f64 = 0.785;

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

/// How a contact stands to the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Touch {
    Away,
    /// Deeper than 0, but leaving so fast that the damper would pull.
    Loose,
    Pressed,
    /// At the force ceiling.
    Full,
}

/// A linear piece: `m z̈ + c ż + k z = f + g t`, t from the start of the step.
#[derive(Debug, Clone, Copy, Default)]
struct Piece {
    k: f64,
    c: f64,
    f: f64,
    g: f64,
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
            Stepper::ImplicitEuler => self.solved(from, h, 1.0, |end| self.force_n(2, end)),
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

/// The ends, nearer than `near` or to rounding, between which a function crosses 0, from two places where its values have
/// different signs: by the chord, the value of an end that stays too long halved (Illinois), and by
/// halves where that is slow, as from an end that is all but a crossing itself.
fn crossing(
    [mut low, mut high]: [(f64, f64); 2],
    near: f64,
    value: impl Fn(f64) -> f64,
) -> [f64; 2] {
    let mut kept: i32 = 0;
    for _ in 0..MAX_LOOKS {
        let chord = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let is_between = chord > low.0 && chord < high.0 && kept.abs() < SLOW;
        let middle = if is_between {
            chord
        } else {
            0.5 * (low.0 + high.0)
        };
        let at = value(middle);
        if at == 0.0 {
            return [middle; 2];
        }
        let moved = if (at < 0.0) == (low.1 < 0.0) { -1 } else { 1 };
        let is_again = kept.signum() == moved;
        kept = if !is_again || kept.abs() >= SLOW {
            moved
        } else {
            kept + moved
        };
        let (end, other) = if moved < 0 {
            (&mut low, &mut high)
        } else {
            (&mut high, &mut low)
        };
        *end = (middle, at);
        other.1 *= if is_again { 0.5 } else { 1.0 };
        if high.0 - low.0 <= near + 4.0 * f64::EPSILON * (low.0.abs() + high.0.abs()) {
            break;
        }
    }
    [low.0, high.0]
}

impl Touch {
    /// By depth, force of spring and damper, and ceiling.
    fn of([depth_m, force_n, ceiling_n]: [f64; 3]) -> Self {
        if depth_m <= 0.0 {
            Self::Away
        } else if force_n < 0.0 {
            Self::Loose
        } else if force_n >= ceiling_n {
            Self::Full
        } else {
            Self::Pressed
        }
    }

    /// How far that is from its end; below 0 beyond it.
    fn left(self, [depth_m, force_n, ceiling_n]: [f64; 3]) -> f64 {
        match self {
            Self::Away => -depth_m,
            Self::Loose => depth_m.min(-force_n),
            // It leaves without force before it leaves the depth.
            Self::Pressed => force_n.min(ceiling_n - force_n),
            Self::Full => force_n - ceiling_n,
        }
    }
}

impl Column<'_> {
    /// How fast a contact's surface rises over a step: evenly.
    fn rise_m_per_s(&self, contact: usize, step_s: f64) -> f64 {
        (self.floors[2][contact].height_m - self.floors[0][contact].height_m) / step_s
    }

    /// Depth, force and ceiling of a contact at a time after the start of a step.
    fn figures(&self, contact: usize, at: Motion, (t_s, step_s): (f64, f64)) -> [f64; 3] {
        let floor = &self.floors[0][contact];
        let rise_m_per_s = self.rise_m_per_s(contact, step_s);
        let depth_m = floor.height_m + rise_m_per_s * t_s - at.z_m;
        let damper_n = self.spring.b * (rise_m_per_s - at.v_m_per_s);
        let force_n = self.spring.k * depth_m + damper_n;
        [depth_m, force_n, self.spring.ceiling_n(floor)]
    }

    fn piece(&self, at: Motion, (t_s, step_s): (f64, f64)) -> Piece {
        let mut piece = Piece {
            c: self.damping,
            f: self.push_n,
            ..Piece::default()
        };
        let Spring { k, b, .. } = *self.spring;
        for (contact, floor) in self.floors[0].iter().enumerate() {
            match Touch::of(self.figures(contact, at, (t_s, step_s))) {
                Touch::Away | Touch::Loose => {}
                Touch::Full => piece.f += self.spring.ceiling_n(floor),
                Touch::Pressed => {
                    let rise_m_per_s = self.rise_m_per_s(contact, step_s);
                    piece.k += k;
                    piece.c += b;
                    piece.f += k * floor.height_m + b * rise_m_per_s;
                    piece.g += k * rise_m_per_s;
                }
            }
        }
        piece
    }

    /// Whether no contact changes how it touches until the step is over: about the even motion that
    /// spring and surface lead to, `½ m ẏ² + ½ k y²` only falls, so a ringing never swings wider
    /// than it does now.
    fn is_calm(&self, piece: &Piece, at: Motion, (t_s, step_s): (f64, f64)) -> bool {
        let v_m_per_s = piece.g / piece.k;
        let led = |t_s: f64| Motion {
            z_m: (piece.f + piece.g * t_s - piece.c * v_m_per_s) / piece.k,
            v_m_per_s,
        };
        let away_m = at.z_m - led(t_s).z_m;
        let faster = at.v_m_per_s - v_m_per_s;
        let twice_j = self.mass_kg * faster * faster + piece.k * away_m * away_m;
        let Spring { k, b, .. } = *self.spring;
        let swing_m = (twice_j / piece.k).sqrt();
        let swing_n = ((k * k / piece.k + b * b / self.mass_kg) * twice_j).sqrt();
        (0..self.floors[0].len()).all(|contact| {
            let now = Touch::of(self.figures(contact, at, (t_s, step_s)));
            [t_s, step_s].into_iter().all(|t_s| {
                let [depth_m, force_n, ceiling_n] = self.figures(contact, led(t_s), (t_s, step_s));
                let swings = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
                swings.into_iter().all(|(m, n)| {
                    let then = [depth_m + m * swing_m, force_n + n * swing_n, ceiling_n];
                    Touch::of(then) == now
                })
            })
        })
    }

    /// Piece after piece until the step is over.
    fn exact(&self, from: Motion, step_s: f64) -> Motion {
        let (mut at, mut t_s) = (from, 0.0);
        for _ in 0..MAX_PIECES {
            let (start, begun_s) = (at, t_s);
            let piece = self.piece(start, (begun_s, step_s));
            let left_s = step_s - begun_s;
            let rings_s = PIECE * (self.mass_kg / piece.k).sqrt();
            let is_calm = left_s > rings_s && self.is_calm(&piece, start, (begun_s, step_s));
            let is_whole = is_calm || left_s <= rings_s;
            let length_s = if is_whole { left_s } else { rings_s };
            let motion = |after_s: f64| self.along(&piece, start, begun_s, after_s);
            // How far the contact that changes first is from that.
            let left = |after_s: f64, motion: Motion| {
                let of = |contact: usize| {
                    let before = self.figures(contact, start, (begun_s, step_s));
                    let now = self.figures(contact, motion, (begun_s + after_s, step_s));
                    Touch::of(before).left(now)
                };
                (0..self.floors[0].len())
                    .map(of)
                    .fold(f64::INFINITY, f64::min)
            };
            (at, t_s) = (motion(length_s), begun_s + length_s);
            let at_end = left(length_s, at);
            if at_end < 0.0 {
                let ends = [(0.0, left(0.0, start)), (length_s, at_end)];
                // At 0 it has not changed yet.
                let beyond = |s: f64| left(s, motion(s)) + f64::MIN_POSITIVE;
                let [_, event_s] = crossing(ends, EVENT * length_s, beyond);
                (at, t_s) = (motion(event_s), begun_s + event_s);
            }
            if t_s >= step_s || (at_end >= 0.0 && is_whole) {
                return at;
            }
        }
        at
    }

    /// Along a piece from an instant of the step, for so long.
    fn along(&self, piece: &Piece, from: Motion, t_s: f64, length_s: f64) -> Motion {
        let m = self.mass_kg;
        let kernel = Kernel::new(piece.c / m, piece.k / m, length_s);
        let Motion { z_m, v_m_per_s: v } = from;
        let pull = (piece.f + piece.g * t_s - piece.k * z_m) / m;
        // The damper's part of the acceleration is in the kernel.
        let [gone_m, speed] = kernel.moved(v, pull, piece.g / m);
        Motion {
            z_m: z_m + gone_m,
            v_m_per_s: speed,
        }
    }
}
