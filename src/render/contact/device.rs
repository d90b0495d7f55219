//! The device that holds the stylus: what it must tell and take, and one that is simulated.

use super::stepper::{Column, Motion, Stepper};
use crate::RenderError;

/// What a device is, along each of its axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeviceSpec {
    /// Apparent mass at the tip, kg.
    pub mass_kg: f64,
    /// Its own damping b, N·s/m.
    pub damping_n_s_per_m: f64,
    /// Its own Coulomb friction `f_c`, N: along z, and together along x and y.
    pub friction_n: f64,
    /// Resolution Δ of its encoders, mm; 0 is without steps.
    pub resolution_mm: f64,
    /// The largest force that it gives, N.
    pub max_force_n: f64,
    /// Axes along which it gives force: x, y, z.
    pub axes: [bool; 3],
    /// Frequency up to which it gives force, Hz: faster changes are for a vibrating end effector.
    pub bandwidth_hz: f64,
}

impl Default for DeviceSpec {
    /// The moving mass and force of a desk-top arm with three axes, without friction or steps. Wall
    /// and Harwin (1999) drove theirs up to 10 Hz.
    fn default() -> Self {
        Self {
            mass_kg: 0.075,
            damping_n_s_per_m: 0.0,
            friction_n: 0.0,
            resolution_mm: 0.0,
            max_force_n: f64::INFINITY,
            axes: [true; 3],
            bandwidth_hz: 10.0,
        }
    }
}

impl DeviceSpec {
    /// Refuses what has no mass, or is no number.
    pub(super) fn check(&self) -> Result<(), RenderError> {
        RenderError::within(("mass", self.mass_kg, "kg"), [1e-6, 1e3])?;
        for (name, value, unit) in [
            ("device's damping", self.damping_n_s_per_m, "N·s/m"),
            ("device's friction", self.friction_n, "N"),
            ("resolution", self.resolution_mm, "mm"),
            ("bandwidth", self.bandwidth_hz, "Hz"),
        ] {
            RenderError::within((name, value, unit), [0.0, 1e6])?;
        }
        if self.max_force_n.is_nan() || self.max_force_n <= 0.0 {
            let mend = "give a largest force above 0 N";
            return Err(RenderError::stylus("the device gives no force", mend));
        }
        Ok(())
    }

    /// A force as far as the device can give it.
    pub(super) fn given_n(&self, force_n: [f64; 3]) -> [f64; 3] {
        let masked = [0, 1, 2].map(|axis| if self.axes[axis] { force_n[axis] } else { 0.0 });
        let size = masked.iter().map(|n| n * n).sum::<f64>().sqrt();
        let share = if size > self.max_force_n {
            self.max_force_n / size
        } else {
            1.0
        };
        masked.map(|n| share * n)
    }
}

/// A force-feedback device as the loop needs it.
///
/// A real device implements two functions; [`HapticLoop`](super::HapticLoop) does the rest at the
/// device's own rate. With a vendor's calls in place of the two `vendor_…` functions:
///
/// ```
/// use selvedge_render::RenderError;
/// use selvedge_render::contact::{DeviceSpec, StylusDevice};
///
/// # fn vendor_position_mm() -> Option<[f64; 3]> { Some([0.0, 0.0, 12.5]) }
/// # fn vendor_set_force_n(_force_n: [f64; 3]) -> bool { true }
/// struct OurArm {
///     spec: DeviceSpec,
/// }
///
/// impl StylusDevice for OurArm {
///     fn spec(&self) -> &DeviceSpec {
///         &self.spec
///     }
///
///     /// The tip's lowest point: x and y along the textile, z up from its mean height.
///     fn read_mm(&mut self) -> Result<[f64; 3], RenderError> {
///         vendor_position_mm().ok_or_else(|| RenderError::Stylus {
///             what: "the arm does not answer".to_owned(),
///             mend: "check its cable and power".to_owned(),
///         })
///     }
///
///     fn hold_n(&mut self, force_n: [f64; 3]) -> Result<(), RenderError> {
///         vendor_set_force_n(force_n).then_some(()).ok_or_else(|| RenderError::Stylus {
///             what: "the arm took no force".to_owned(),
///             mend: "release its dead-man's switch and calibrate it".to_owned(),
///         })
///     }
/// }
///
/// // Mass, damping and friction from a free swing; resolution and force from the data sheet.
/// let spec = DeviceSpec { mass_kg: 0.075, friction_n: 0.04, ..DeviceSpec::default() };
/// let mut arm = OurArm { spec };
/// assert_eq!(arm.read_mm().unwrap()[2], 12.5);
/// arm.hold_n([0.0, 0.0, 0.5]).unwrap();
/// ```
///
/// The thread that calls it at its rate belongs to the lab's program, and so does the switch that
/// takes the force away.
pub trait StylusDevice {
    /// What it is.
    fn spec(&self) -> &DeviceSpec;

    /// Where the tip's lowest point is, mm, as its encoders tell.
    fn read_mm(&mut self) -> Result<[f64; 3], RenderError>;

    /// Gives a force, N, until the next.
    fn hold_n(&mut self, force_n: [f64; 3]) -> Result<(), RenderError>;
}

/// Somebody's hand on the stylus.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hand {
    /// How hard it presses down, N.
    pub press_n: f64,
    /// How stiffly it leads the stylus along the surface, N/m, with its damping, N·s/m; without it
    /// the tip is where the path is.
    pub leads: Option<[f64; 2]>,
}

/// A simulated device in a hand: a mass with damping, Coulomb friction and encoders.
#[derive(Debug, Clone)]
pub struct SimulatedDevice {
    pub(super) spec: DeviceSpec,
    pub(super) hand: Hand,
    method: Stepper,
    /// How long a force is held, s.
    pub(super) period_s: f64,
    /// Where the hand leads it next, mm.
    pub(super) target_mm: [f64; 2],
    pub(super) along: Along,
    pub(super) upright: Motion,
}

/// Place and velocity along the surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Along {
    pub(super) place_mm: [f64; 2],
    pub(super) velocity_m_per_s: [f64; 2],
}

/// What acts along the surface over a step: `m v' = force − drag v − stiffness (moved)`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pull {
    pub(super) force_n: [f64; 2],
    /// N·s/m.
    pub(super) drag: f64,
    pub(super) stiffness: [f64; 2],
    /// What the device's own Coulomb friction takes at most, N.
    pub(super) friction_n: f64,
}

impl Hand {
    /// A hand that presses down, N, and leads the tip where the path is.
    pub fn pressing(press_n: f64) -> Self {
        let leads = None;
        Self { press_n, leads }
    }

    pub(super) fn check(&self) -> Result<(), RenderError> {
        let [stiffness, damping] = self.leads.unwrap_or_default();
        RenderError::within(("hand's force", self.press_n, "N"), [0.0, 1e6])?;
        RenderError::within(("hand's stiffness", stiffness, "N/m"), [0.0, 1e6])?;
        RenderError::within(("hand's damping", damping, "N·s/m"), [0.0, 1e6])
    }

    /// The tip after a step along the surface towards a target, by velocities at the step's end:
    /// stable at any step.
    pub(super) fn led(
        &self,
        from: Along,
        (mass_kg, pull): (f64, &Pull),
        target_mm: [f64; 2],
        step_s: f64,
    ) -> Along {
        let target_m_per_s =
            [0, 1].map(|axis| 1e-3 * (target_mm[axis] - from.place_mm[axis]) / step_s);
        let Some([stiffness, damping]) = self.leads else {
            return Along {
                place_mm: target_mm,
                velocity_m_per_s: target_m_per_s,
            };
        };
        let momentum = [0, 1].map(|axis| {
            // The hand's spring is taken at the step's end, its damper against the device's frame.
            let away_m = 1e-3 * (target_mm[axis] - from.place_mm[axis]);
            let drive_n = pull.force_n[axis] + stiffness * away_m;
            mass_kg * from.velocity_m_per_s[axis] + step_s * drive_n
        });
        // Dry friction at the step's end: all of the momentum, or as much as it can take.
        let size = momentum[0].hypot(momentum[1]);
        let kept = (1.0 - step_s * pull.friction_n / size).max(0.0);
        let velocity_m_per_s = [0, 1].map(|axis| {
            let inertia = mass_kg
                + step_s * (pull.drag + damping)
                + step_s * step_s * (stiffness + pull.stiffness[axis]);
            kept * momentum[axis] / inertia
        });
        Along {
            place_mm: [0, 1]
                .map(|axis| from.place_mm[axis] + 1e3 * step_s * velocity_m_per_s[axis]),
            velocity_m_per_s,
        }
    }
}

/// What Coulomb friction leaves of a velocity after a step.
pub(super) fn rubbed(v_m_per_s: f64, friction_n: f64, mass_kg: f64, step_s: f64) -> f64 {
    let taken = friction_n * step_s / mass_kg;
    v_m_per_s.signum() * (v_m_per_s.abs() - taken).max(0.0)
}

impl SimulatedDevice {
    /// A device at rest at a place, mm, whose forces are held for a period and which is stepped by
    /// a method meanwhile.
    ///
    /// # Errors
    /// A device or a hand that is none.
    pub fn new(
        spec: DeviceSpec,
        hand: Hand,
        (method, period_s): (Stepper, f64),
        place_mm: [f64; 3],
    ) -> Result<Self, RenderError> {
        spec.check()?;
        hand.check()?;
        if !place_mm.iter().all(|mm| mm.abs() <= 1e9) {
            let what = "the stylus starts nowhere";
            return Err(RenderError::stylus(what, "give finite places in mm"));
        }
        let mut device = Self {
            spec,
            hand,
            method,
            period_s,
            target_mm: [0.0; 2],
            along: Along::default(),
            upright: Motion {
                z_m: 0.0,
                v_m_per_s: 0.0,
            },
        };
        device.put_at(place_mm);
        Ok(device)
    }

    /// Puts it at rest at a place, mm.
    pub(super) fn put_at(&mut self, [x_mm, y_mm, z_mm]: [f64; 3]) {
        self.target_mm = [x_mm, y_mm];
        self.along = Along {
            place_mm: [x_mm, y_mm],
            velocity_m_per_s: [0.0; 2],
        };
        self.upright = Motion {
            z_m: 1e-3 * z_mm,
            v_m_per_s: 0.0,
        };
    }

    /// Where the hand leads the stylus until the next force, mm.
    pub fn lead_to(&mut self, target_mm: [f64; 2]) {
        self.target_mm = target_mm;
    }

    /// Whether Coulomb friction keeps it where it is against a force along z.
    pub(super) fn sticks(&self, force_n: f64) -> bool {
        self.spec.friction_n > 0.0
            && self.upright.v_m_per_s == 0.0
            && force_n.abs() <= self.spec.friction_n
    }

    /// Takes what Coulomb friction takes in a step.
    pub(super) fn rub(&mut self) {
        let (friction_n, mass_kg) = (self.spec.friction_n, self.spec.mass_kg);
        let v = self.upright.v_m_per_s;
        self.upright.v_m_per_s = rubbed(v, friction_n, mass_kg, self.period_s);
    }

    fn quantised_mm(&self, mm: f64) -> f64 {
        let step_mm = self.spec.resolution_mm;
        if step_mm > 0.0 {
            step_mm * (mm / step_mm).round()
        } else {
            mm
        }
    }
}

impl StylusDevice for SimulatedDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn read_mm(&mut self) -> Result<[f64; 3], RenderError> {
        let [x_mm, y_mm] = self.along.place_mm;
        Ok([x_mm, y_mm, 1e3 * self.upright.z_m].map(|mm| self.quantised_mm(mm)))
    }

    /// Holds the force, and lets the period pass.
    fn hold_n(&mut self, force_n: [f64; 3]) -> Result<(), RenderError> {
        let [x_n, y_n, z_n] = self.spec.given_n(force_n);
        let mass_kg = self.spec.mass_kg;
        let pull = Pull {
            force_n: [x_n, y_n],
            drag: self.spec.damping_n_s_per_m,
            friction_n: self.spec.friction_n,
            ..Pull::default()
        };
        self.along = self
            .hand
            .led(self.along, (mass_kg, &pull), self.target_mm, self.period_s);
        let push_n = z_n - self.hand.press_n;
        if !self.spec.axes[2] || self.sticks(push_n) {
            return Ok(());
        }
        let column = Column::free(mass_kg, self.spec.damping_n_s_per_m, push_n);
        self.upright = column.step(self.method, self.upright, self.period_s);
        self.rub();
        Ok(())
    }
}
