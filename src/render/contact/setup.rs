//! All that a run of a stylus is made of, and what can be held with it.

use super::controller::{Sampling, period_s};
use super::device::{DeviceSpec, Hand};
use super::law::ForceParts;
use super::limits::{StiffnessLimits, WallCase};
use super::patch::Contact;
use super::stepper::Stepper;
use crate::RenderError;

/// All that a run is made of.
#[derive(Debug, Clone)]
pub struct StylusSetup {
    /// The tip on its surface.
    pub contact: Contact,
    /// The simulated device.
    pub device: DeviceSpec,
    /// The hand on it.
    pub hand: Hand,
    /// How it is stepped.
    pub method: Stepper,
    /// Steps, or ticks of the controller, a second.
    pub rate_hz: f64,
    /// The force is sampled and held; without this it acts at all times.
    pub sampling: Option<Sampling>,
}

impl StylusSetup {
    /// A usual device in a hand that presses with 1 N, with a force that acts at all times.
    pub fn of(contact: Contact, method: Stepper, rate_hz: f64) -> Self {
        Self {
            contact,
            device: DeviceSpec::default(),
            hand: Hand::pressing(1.0),
            method,
            rate_hz,
            sampling: None,
        }
    }

    /// The same with all of it given as force: no vibration is left for an end effector.
    #[must_use]
    pub fn by_force_alone(mut self) -> Self {
        // From half the rate on the crossover leaves nothing.
        self.device.bandwidth_hz = self.rate_hz;
        self
    }

    /// The case of a wall that this is, for limits and maps.
    pub fn case(&self) -> WallCase {
        let law = self.contact.law();
        WallCase {
            mass_kg: self.device.mass_kg,
            damping_n_s_per_m: self.device.damping_n_s_per_m,
            stiffness_n_per_m: law.stiffness_n_per_m,
            wall_damping_n_s_per_m: law.damping_n_s_per_m,
            period_s: 1.0 / self.rate_hz,
            delay_ticks: self.sampling.map(|sampling| sampling.delay_ticks),
            method: self.method,
        }
    }

    /// The largest stiffnesses that this device is held with.
    pub fn stiffness_limits(&self) -> StiffnessLimits {
        let (friction_n, resolution_mm) = (self.device.friction_n, self.device.resolution_mm);
        self.case().stiffness_limits(friction_n, resolution_mm)
    }

    /// The stepper that is taken, and why: what `auto` chose, or what was asked for.
    pub fn chosen(&self) -> (Stepper, String) {
        if self.method == Stepper::Auto {
            return self.case().choose(self.contact.law().is_linear());
        }
        (self.method, "as asked".to_owned())
    }

    pub(super) fn checked(mut self) -> Result<Self, RenderError> {
        period_s(self.rate_hz)?;
        self.device.check()?;
        self.hand.check()?;
        let mut law = *self.contact.law();
        law.ceiling_n = law.ceiling_n.min(self.device.max_force_n);
        self.contact.set_law(law)?;
        self.method = self.chosen().0;
        if self.method == Stepper::Exact && !law.is_linear() && self.sampling.is_none() {
            return Err(RenderError::stylus(
                "a cloth's compression is not piecewise linear",
                "take method implicit-euler, or leave its figures out",
            ));
        }
        // What is not displayed is no axis of the device.
        let [x, y, z] = &mut self.device.axes;
        *z &= law.parts != ForceParts::Lateral;
        *x &= law.parts != ForceParts::Normal;
        *y &= law.parts != ForceParts::Normal;
        Ok(self)
    }
}
