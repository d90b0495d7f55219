//! What holds a stylus and how it is computed: chosen in a window, kept per user, or stated by a
//! design.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::StylusDrive;
use crate::RenderError;
use crate::contact::{
    Contact, ContactLaw, DeviceSpec, ForceParts, Hand, Sampling, Standing, Stepper, StylusSetup,
    WallCase,
};
use selvedge_foundation::numerics::to_index;
use selvedge_textile::surface::Surface;
use selvedge_textile::tactile::Filters;

/// Everything that is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StylusSettings {
    /// Stiffness K of the wall, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping B of the wall, N·s/m.
    pub damping_n_s_per_m: f64,
    /// Steps, or ticks of the controller, a second.
    pub rate_hz: f64,
    /// Ticks by which a sampled force is late, a whole number.
    pub delay_ticks: f64,
    /// Radius of the tip, mm.
    pub radius_mm: f64,
    /// Mass at the tip, kg.
    pub mass_kg: f64,
    /// The device's own damping b, N·s/m.
    pub own_damping_n_s_per_m: f64,
    /// With what force the hand presses down, N.
    pub press_n: f64,
    /// What a N of its vibration drives a device with, µm.
    pub um_per_n: f64,
    /// How it is stepped.
    pub method: Stepper,
    /// Whether the force is sampled and held; else it acts at all times.
    #[serde(rename = "sampled")]
    pub is_sampled: bool,
    /// Whether forces along the surface are given too.
    #[serde(rename = "along_surface")]
    pub is_lateral: bool,
}

impl Default for StylusSettings {
    /// A desk-top arm that follows a wall of 1 N/mm without ringing for long.
    fn default() -> Self {
        Self {
            stiffness_n_per_m: 1000.0,
            damping_n_s_per_m: 5.0,
            rate_hz: 1000.0,
            delay_ticks: 0.0,
            radius_mm: 0.5,
            mass_kg: DeviceSpec::default().mass_kg,
            own_damping_n_s_per_m: 0.5,
            press_n: 0.3,
            um_per_n: 200.0,
            method: Stepper::Auto,
            is_sampled: false,
            is_lateral: true,
        }
    }
}

impl StylusSettings {
    /// All of it in a line.
    pub fn words(&self) -> String {
        let controller = if self.is_sampled {
            format!("sampled, {} ticks late", self.delay_ticks)
        } else {
            "continuous".to_owned()
        };
        format!(
            "K {} N/m, B {} N·s/m, {} Hz, {controller}, method {}, tip {} mm, mass {} kg, device b \
             {} N·s/m, hand {} N, drive {} µm/N, force along the surface {}",
            self.stiffness_n_per_m,
            self.damping_n_s_per_m,
            self.rate_hz,
            self.method.name(),
            self.radius_mm,
            self.mass_kg,
            self.own_damping_n_s_per_m,
            self.press_n,
            self.um_per_n,
            if self.is_lateral { "on" } else { "off" }
        )
    }

    /// The case of a wall that this is.
    pub fn case(&self) -> WallCase {
        WallCase {
            mass_kg: self.mass_kg,
            damping_n_s_per_m: self.own_damping_n_s_per_m,
            stiffness_n_per_m: self.stiffness_n_per_m,
            wall_damping_n_s_per_m: self.damping_n_s_per_m,
            period_s: 1.0 / self.rate_hz,
            delay_ticks: self.sampling().map(|sampling| sampling.delay_ticks),
            method: self.method,
        }
    }

    fn sampling(&self) -> Option<Sampling> {
        self.is_sampled.then(|| Sampling {
            delay_ticks: to_index(self.delay_ticks),
            is_kept_passive: false,
        })
    }

    /// Why it should not be applied unasked: a line with the limit; `None` if it can be held.
    pub fn warning(&self) -> Option<String> {
        let case = self.case();
        (case.standing() == Standing::Unstable).then(|| case.advice())
    }

    /// Refuses what no tip can be led with: numbers that are none, and what cannot be held.
    ///
    /// # Errors
    /// The first of them, with how to mend it.
    pub fn check(&self) -> Result<(), RenderError> {
        for (name, value, unit, range) in [
            ("stiffness", self.stiffness_n_per_m, "N/m", [0.0, 1e9]),
            ("damping", self.damping_n_s_per_m, "N·s/m", [0.0, 1e6]),
            ("rate", self.rate_hz, "Hz", [250.0, 40_000.0]),
            ("delay", self.delay_ticks, "ticks", [0.0, 20.0]),
            ("radius of the tip", self.radius_mm, "mm", [0.02, 2.0]),
            ("mass", self.mass_kg, "kg", [0.001, 1.0]),
            (
                "device's damping",
                self.own_damping_n_s_per_m,
                "N·s/m",
                [0.0, 1e3],
            ),
            ("hand's force", self.press_n, "N", [0.0, 100.0]),
            ("drive", self.um_per_n, "µm/N", [0.0, 1e6]),
        ] {
            RenderError::within((name, value, unit), range)?;
        }
        if self.delay_ticks.fract() > 0.0 {
            let what = format!("the delay is {} ticks", self.delay_ticks);
            return Err(RenderError::stylus(what, "give a whole number of ticks"));
        }
        match self.warning() {
            Some(why) => Err(RenderError::stylus("the stylus cannot be held", why)),
            None => Ok(()),
        }
    }

    /// What drives a device by its vibration on such textiles.
    ///
    /// # Errors
    /// As [`StylusDrive::prepare`].
    pub fn drive(
        &self,
        on: Vec<(Arc<Surface>, Option<StylusSetup>)>,
        filters: &Filters,
    ) -> Result<StylusDrive, RenderError> {
        StylusDrive::prepare(on, (self.rate_hz, self.um_per_n), filters)
    }

    /// All of a run of a tip on a surface.
    pub fn setup(&self, mut contact: Contact) -> StylusSetup {
        // Numbers that are checked are a law; any other leaves the default, which holds.
        let law = ContactLaw {
            stiffness_n_per_m: self.stiffness_n_per_m,
            damping_n_s_per_m: self.damping_n_s_per_m,
            parts: if self.is_lateral {
                ForceParts::Both
            } else {
                ForceParts::Normal
            },
            ..*contact.law()
        };
        drop(contact.set_law(law));
        StylusSetup {
            contact,
            device: DeviceSpec {
                mass_kg: self.mass_kg,
                damping_n_s_per_m: self.own_damping_n_s_per_m,
                ..DeviceSpec::default()
            },
            hand: Hand {
                press_n: self.press_n,
                leads: None,
            },
            method: self.method,
            rate_hz: self.rate_hz,
            sampling: self.sampling(),
        }
    }
}
