//! What holds the stylus and how it is computed, as it is kept per user and told in a line.

use serde::{Deserialize, Serialize};

use selvedge_render::contact::{DeviceSpec, Stepper};

/// Everything that is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct StylusSettings {
    /// Stiffness K of the wall, N/m.
    pub(crate) stiffness_n_per_m: f64,
    /// Damping B of the wall, N·s/m.
    pub(crate) damping_n_s_per_m: f64,
    /// Steps, or ticks of the controller, a second.
    pub(crate) rate_hz: f64,
    /// Ticks by which a sampled force is late, a whole number.
    pub(crate) delay_ticks: f64,
    /// Radius of the tip, mm.
    pub(crate) radius_mm: f64,
    /// Mass at the tip, kg.
    pub(crate) mass_kg: f64,
    /// The device's own damping b, N·s/m.
    pub(crate) own_damping_n_s_per_m: f64,
    /// With what force the hand presses down, N.
    pub(crate) press_n: f64,
    /// What a N of its vibration drives a device with, µm.
    pub(crate) um_per_n: f64,
    /// How it is stepped.
    pub(crate) method: Stepper,
    /// Whether the force is sampled and held; else it acts at all times.
    #[serde(rename = "sampled")]
    pub(crate) is_sampled: bool,
    /// Whether forces along the surface are given too.
    #[serde(rename = "along_surface")]
    pub(crate) is_lateral: bool,
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
    pub(crate) fn words(&self) -> String {
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
}
