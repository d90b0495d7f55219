//! The current that a contactor takes of its amplifier, in closed form: what STATUS tells without
//! a plant that runs.

use std::f64::consts::TAU;

use super::{ContactorModel, SAMPLES_PER_S};
use crate::FULL_CODE;
use crate::device::Load;

/// The carriers, Hz.
const CARRIERS_HZ: [f64; 2] = [40.0, 320.0];

impl ContactorModel {
    /// The current for each carrier's codes while they stay, skin on the pin and no limit of the
    /// amplifier reached.
    pub(crate) fn load(&self) -> Load {
        let full = f64::from(FULL_CODE);
        Load {
            ma_per_code: CARRIERS_HZ
                .map(|hz| 1e3 * self.full_scale_v * self.rms_a_per_v(hz) / full),
        }
    }

    /// Root mean square of the current for a sine of 1 V peak through the DAC's hold, A/V.
    ///
    /// The DAC moves in steps of `2 sin(ωT/2)` that the amplifier's pole rounds, into the held
    /// capacitance; at the carrier itself the moving beam adds its charge.
    fn rms_a_per_v(&self, frequency_hz: f64) -> f64 {
        let omega = TAU * frequency_hz;
        let sample_s = 1.0 / f64::from(SAMPLES_PER_S);
        let tau_s = self.amplifier.time_constant_s;
        let capacitance_f = self.held_capacitance_f();
        let rest = (-sample_s / tau_s).exp();
        let turn = omega * sample_s;
        // What is left of a step when the next one comes adds to it.
        let left = 1.0 - 2.0 * rest * turn.cos() + rest * rest;
        let step = 2.0 * (0.5 * turn).sin().powi(2) / left;
        let slopes = step * (1.0 - rest * rest) / (2.0 * tau_s * sample_s);
        let droop = Self::hold_droop(frequency_hz);
        let output = droop / (1.0 + (omega * tau_s).powi(2)).sqrt();
        let smooth = 0.5 * (omega * output).powi(2);
        // Beam and amplifier share a phase but for the beam's own lag.
        let amplifier = 1.0 / selvedge_foundation::numerics::Complex::new(1.0, omega * tau_s);
        let [beam, _] = self.beam_and_pin_um_per_v(frequency_hz);
        let charge = capacitance_f * amplifier + 1e-6 * self.bimorph.force_n_per_v() * beam;
        let carrier = 0.5 * (omega * droop * charge.norm()).powi(2);
        (capacitance_f.powi(2) * (slopes - smooth) + carrier).sqrt()
    }
}
