//! How a surface pushes back: a spring and a damper that stand on it, and softer cloth above them.
//!
//! Let `d = h − z` be how deep the lowest point of a tip is below the surface at its place. A
//! contact pushes with `f = max(0, s(d) + B ḋ)` for d > 0 along z and with `−f ∇h` along the
//! surface: together along its normal, `F = f (−h_u, −h_w, 1)`. Of that the spring's part is
//! `−∇ ∫ s dd`, so going round in it gives no energy, and the damper's takes `B ḋ²`, never less
//! than 0; on a plane this is the penalty wall `F = max(0, −K z − B ż)`. It never pulls, and |F|
//! stays below a ceiling.
//!
//! `s` is `K d`, or a cloth on top of that wall. Its figures are those of a compression tester
//! (Kawabata KES-FB3: 0.5 to 50 gf/cm²): thickness T0 and TM, linearity LC, resilience RC. With
//! `x = d/(T0 − TM)` up to 1 the cloth's pressure is `P_m xⁿ`, `n = 2/LC − 1`, whose work is WC =
//! `LC P_m (T0 − TM)/2`; what comes back from the deepest `x_m` is the share RC of that:
//! `P_m x_mⁿ (x/x_m)^q` with `q = (n + 1)/RC − 1`. Deeper than T0 − TM the wall takes over. LC = 1
//! and RC = 1 are a linear spring. The deepest is forgotten when the tip leaves.

use super::relief::Spot;
use crate::RenderError;
use selvedge_foundation::named;

/// The largest stiffness that is taken, N/m.
const MAX_STIFFNESS_N_PER_M: f64 = 1e9;
/// Pressure at which a compression tester reads TM: 50 gf/cm² in N/mm².
const TESTER_PRESSURE_N_PER_MM2: f64 = 50.0 * 98.0665e-6;

named! {
    /// Which part of the force is displayed.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum ForceParts {
        /// Up and down alone.
        Normal = "normal",
        /// Along the surface alone: the gradient's force, and friction (Minsky et al. 1990).
        Lateral = "lateral",
        /// Both.
        #[default]
        Both = "both",
    }
    /// Its name on the command line.
    pub fn name;
}

impl std::str::FromStr for ForceParts {
    type Err = &'static str;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let found = Self::ALL.into_iter().find(|one| one.name() == name);
        found.ok_or("use normal, lateral or both")
    }
}

/// The compression of a cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compression {
    /// How far it yields between 0.5 and 50 gf/cm², T0 − TM, mm.
    pub yield_mm: f64,
    /// Linearity LC; 1 is a straight line, less is softer at first.
    pub linearity: f64,
    /// Resilience RC as a share, 0…1.
    pub resilience: f64,
    /// Area that presses, mm².
    pub area_mm2: f64,
}

/// How a surface pushes back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    /// Stiffness K of the wall, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping B of the wall, N·s/m.
    pub damping_n_s_per_m: f64,
    /// No force is larger, N; infinite is no ceiling.
    pub ceiling_n: f64,
    /// Which part is displayed.
    pub parts: ForceParts,
    /// The cloth on the wall, where its figures are known.
    pub cloth: Option<Compression>,
}

impl Default for ContactLaw {
    /// A wall of 1 N/mm that damps nothing, without a ceiling.
    fn default() -> Self {
        Self {
            stiffness_n_per_m: 1000.0,
            damping_n_s_per_m: 0.0,
            ceiling_n: f64::INFINITY,
            parts: ForceParts::Both,
            cloth: None,
        }
    }
}

impl Compression {
    /// The compression of a textile's figures (`t0_mm`, `tm_mm`, `lc`, `rc_percent`) under so many
    /// mm²; `None` where one is missing or makes no curve.
    pub fn of_figures(figure: impl Fn(&str) -> Option<f64>, area_mm2: f64) -> Option<Self> {
        let one = Self {
            yield_mm: figure("t0_mm")? - figure("tm_mm")?,
            linearity: figure("lc")?,
            resilience: 0.01 * figure("rc_percent")?,
            area_mm2,
        };
        one.is_curve().then_some(one)
    }

    fn is_curve(&self) -> bool {
        let is_positive = |x: f64| x > 0.0 && x.is_finite();
        is_positive(self.yield_mm)
            && is_positive(self.area_mm2)
            && (0.05..2.0).contains(&self.linearity)
            && (0.01..=1.0).contains(&self.resilience)
    }

    /// Exponents of the way in and of the way back.
    fn exponents(&self) -> [f64; 2] {
        let way_in = 2.0 / self.linearity - 1.0;
        [way_in, (way_in + 1.0) / self.resilience - 1.0]
    }

    fn most_n(&self) -> f64 {
        TESTER_PRESSURE_N_PER_MM2 * self.area_mm2
    }
}

impl ContactLaw {
    /// Refuses what is no spring: negative, NaN, beyond 10⁹ N/m.
    pub fn check(&self) -> Result<(), RenderError> {
        let (k, b) = (self.stiffness_n_per_m, self.damping_n_s_per_m);
        RenderError::within(("stiffness", k, "N/m"), [0.0, MAX_STIFFNESS_N_PER_M])?;
        RenderError::within(("damping", b, "N·s/m"), [0.0, 1e6])?;
        let most = self.ceiling_n;
        if most.is_nan() || most <= 0.0 {
            let what = format!("the force ceiling is {most} N");
            return Err(RenderError::stylus(what, "give more than 0 N"));
        }
        if let Some(cloth) = self.cloth.filter(|cloth| !cloth.is_curve()) {
            let what = format!("the compression {cloth:?} makes no curve");
            let mend = "give T0 above TM, LC from 0.05 to 2 and RC from 1 to 100 %";
            return Err(RenderError::stylus(what, mend));
        }
        Ok(())
    }

    /// Whether force is piecewise linear in depth, so that it can be stepped exactly.
    pub fn is_linear(&self) -> bool {
        self.cloth.is_none()
    }

    /// One of `n` equal contacts that share the load.
    pub(super) fn share(&self, n: usize) -> Spring {
        let share = 1.0 / n.max(1) as f64;
        Spring {
            k: share * self.stiffness_n_per_m,
            b: share * self.damping_n_s_per_m,
            ceiling_n: share * self.ceiling_n,
            cloth: self.cloth.map(|cloth| Soft {
                most_n: share * cloth.most_n(),
                yield_m: 1e-3 * cloth.yield_mm,
                exponents: cloth.exponents(),
            }),
        }
    }
}

/// The law of one contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spring {
    pub(super) k: f64,
    pub(super) b: f64,
    ceiling_n: f64,
    cloth: Option<Soft>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Soft {
    most_n: f64,
    yield_m: f64,
    exponents: [f64; 2],
}

/// A contact's surface at an instant, in m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Floor {
    pub(super) height_m: f64,
    /// How fast the surface rises under the tip, m/s.
    pub(super) rise_m_per_s: f64,
    pub(super) slope: [f64; 2],
    /// The deepest that the tip has been since it came, m.
    pub(super) deepest_m: f64,
}

impl Floor {
    pub(super) fn of(spot: Spot, velocity_m_per_s: [f64; 2], deepest_m: f64) -> Self {
        let [u, w] = spot.slope;
        Self {
            height_m: 1e-3 * spot.height_mm,
            rise_m_per_s: u * velocity_m_per_s[0] + w * velocity_m_per_s[1],
            slope: spot.slope,
            deepest_m,
        }
    }

    /// How much longer a force along the normal is than its part along z.
    pub(super) fn lean(&self) -> f64 {
        (1.0 + self.slope[0] * self.slope[0] + self.slope[1] * self.slope[1]).sqrt()
    }
}

impl Spring {
    /// Nothing that pushes.
    pub(super) const NONE: Self = Self {
        k: 0.0,
        b: 0.0,
        ceiling_n: f64::INFINITY,
        cloth: None,
    };

    /// The largest part along z.
    pub(super) fn ceiling_n(&self, floor: &Floor) -> f64 {
        self.ceiling_n / floor.lean()
    }

    /// The part along z at a place and velocity, N.
    pub(super) fn force_n(&self, floor: &Floor, z_m: f64, v_m_per_s: f64) -> f64 {
        let depth_m = floor.height_m - z_m;
        if depth_m <= 0.0 {
            return 0.0;
        }
        let damper_n = self.b * (floor.rise_m_per_s - v_m_per_s);
        let spring_n = self.spring_n(depth_m, floor.deepest_m);
        (spring_n + damper_n).clamp(0.0, self.ceiling_n(floor))
    }

    /// The spring alone, N.
    fn spring_n(&self, depth_m: f64, deepest_m: f64) -> f64 {
        let Some(soft) = self.cloth else {
            return self.k * depth_m;
        };
        let x = depth_m / soft.yield_m;
        let [way_in, back] = soft.exponents;
        let most = (deepest_m / soft.yield_m).min(1.0);
        let cloth = if x < most {
            most.powf(way_in) * (x / most).powf(back)
        } else {
            x.min(1.0).powf(way_in)
        };
        soft.most_n * cloth + self.k * (depth_m - soft.yield_m).max(0.0)
    }

    pub(super) fn is_linear(&self) -> bool {
        self.cloth.is_none()
    }

    /// The mean of a linear spring between two depths, the deeper above 0, N.
    pub(super) fn mean_n(&self, floor: &Floor, [low_m, high_m]: [f64; 2]) -> f64 {
        let at = |depth_m: f64| {
            let z_m = floor.height_m - depth_m;
            self.energy_j(floor, z_m)
        };
        let ceiling_n = self.ceiling_n(floor);
        if low_m >= 0.0 && self.k * high_m <= ceiling_n {
            return 0.5 * self.k * (low_m + high_m);
        }
        if high_m > low_m {
            (at(high_m) - at(low_m)) / (high_m - low_m)
        } else {
            (self.k * high_m).min(ceiling_n)
        }
    }

    /// What comes back of what was put in, J: the work of the spring on the way out, with the
    /// ceiling.
    pub(super) fn energy_j(&self, floor: &Floor, z_m: f64) -> f64 {
        let depth_m = (floor.height_m - z_m).max(0.0);
        let ceiling_n = self.ceiling_n(floor);
        let wall_j = |depth_m: f64, ceiling_n: f64| {
            let linear_m = depth_m.min(ceiling_n / self.k);
            let linear_j = 0.5 * self.k * linear_m * linear_m;
            if depth_m > linear_m {
                linear_j + ceiling_n * (depth_m - linear_m)
            } else {
                linear_j
            }
        };
        let Some(soft) = self.cloth else {
            return if self.k > 0.0 {
                wall_j(depth_m, ceiling_n)
            } else {
                0.0
            };
        };
        let [way_in, back] = soft.exponents;
        let deepest = (floor.deepest_m.max(depth_m) / soft.yield_m).min(1.0);
        let x = (depth_m / soft.yield_m).min(1.0);
        let cloth_j = if deepest > 0.0 {
            let peak_n = soft.most_n * deepest.powf(way_in);
            peak_n * soft.yield_m * deepest * (x / deepest).powf(back + 1.0) / (back + 1.0)
        } else {
            0.0
        };
        let beyond_m = (depth_m - soft.yield_m).max(0.0);
        cloth_j + soft.most_n * beyond_m + 0.5 * self.k * beyond_m * beyond_m
    }
}
