//! One contactor as a linear system in each of its regimes, and its response in closed form.
//!
//! ```text
//!           ┌─ stem ─┐
//!  volts ─▶ beam     pin ─ skin        x = [x_beam, v_beam, x_pin, v_pin, u_amp]
//!  (m, k, c)        (3 mg, 1e5 N/m)        m,   m/s,    m,     m/s,   V
//! ```
//!
//! Displacements count from the rest under the preload. The stem and its pin are an assumption:
//! they stand for whatever sits between beam and skin, and they make the system stiff.

use std::f64::consts::{PI, TAU};

use super::{Bimorph, SAMPLES_PER_S, Skin, within};
use crate::device::Load;
use crate::{BridgeError, FULL_CODE};
use selvedge_foundation::numerics::Complex;
use selvedge_foundation::numerics::ode::LinearSystem;

/// Indices into the state.
pub(super) const V_BEAM: usize = 1;
pub(super) const X_PIN: usize = 2;
pub(super) const V_PIN: usize = 3;
pub(super) const U_AMP: usize = 4;
/// Number of states.
pub(super) const N_STATES: usize = 5;
/// Inputs: what drives the amplifier, and 1 (the preload that is missing while the skin is off).
pub(super) const N_INPUTS: usize = 2;

/// The carriers, Hz.
const CARRIERS_HZ: [f64; 2] = [40.0, 320.0];

/// Everything that is assumed of a contactor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactorModel {
    /// The beam.
    pub bimorph: Bimorph,
    /// Quality factor of the free beam, up to [`Self::MAX_QUALITY`]. 40 is an assumption.
    pub quality: f64,
    /// Mass of the pin, mg.
    pub pin_mg: f64,
    /// Stiffness between beam and pin, N/m.
    pub stem_n_per_m: f64,
    /// Quality factor of the pin on its stem.
    pub stem_quality: f64,
    /// The finger.
    pub skin: Skin,
    /// What drives the beam.
    pub amplifier: Amplifier,
    /// Drive peak at full code, V.
    pub full_scale_v: f64,
}

impl Default for ContactorModel {
    fn default() -> Self {
        Self {
            bimorph: Bimorph::default(),
            quality: 40.0,
            pin_mg: 3.0,
            stem_n_per_m: 1e5,
            stem_quality: 50.0,
            skin: Skin::LIGHT,
            amplifier: Amplifier::default(),
            full_scale_v: 50.0,
        }
    }
}

/// Whether skin lies on the pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Contact {
    On,
    Off,
}

/// What the amplifier does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Drive {
    /// It nears the voltage that is its input.
    Follows,
    /// It goes as fast as it can: the slope is its input.
    Slews,
}

impl ContactorModel {
    /// The highest quality factor that a model takes.
    pub const MAX_QUALITY: f64 = 1000.0;

    /// The place of the pin's displacement in m among the states of [`system`](Self::system).
    pub const PIN: usize = X_PIN;

    /// Refuses a model that is no contactor.
    pub fn check(&self) -> Result<(), BridgeError> {
        self.bimorph.check()?;
        self.skin.check()?;
        let ranges = [
            ("quality factor", self.quality, [0.1, Self::MAX_QUALITY], ""),
            ("full scale in V", self.full_scale_v, [1e-3, 1e4], ""),
        ];
        within("contactor", &ranges)
    }

    /// Damping of the beam alone, N s/m.
    fn beam_damping(&self) -> f64 {
        (self.bimorph.stiffness_n_per_m() * self.bimorph.mass_kg()).sqrt() / self.quality
    }

    fn pin_kg(&self) -> f64 {
        1e-6 * self.pin_mg
    }

    /// Damping of the stem, N s/m: beam and pin swing against each other.
    fn stem_damping(&self) -> f64 {
        let (beam_kg, pin_kg) = (self.bimorph.mass_kg(), self.pin_kg());
        let both_kg = beam_kg * pin_kg / (beam_kg + pin_kg);
        (self.stem_n_per_m * both_kg).sqrt() / self.stem_quality
    }

    /// The contactor while skin lies on it and the amplifier follows: inputs are the voltage asked
    /// for in V, and 1.
    pub fn system(&self) -> LinearSystem<5, 2> {
        self.regime(Contact::On, Drive::Follows)
    }

    /// The contactor in one of its regimes.
    pub(super) fn regime(&self, contact: Contact, drive: Drive) -> LinearSystem<5, 2> {
        let (beam_kg, pin_kg) = (self.bimorph.mass_kg(), self.pin_kg());
        let (k, c) = (self.bimorph.stiffness_n_per_m(), self.beam_damping());
        let (stem_k, stem_c) = (self.stem_n_per_m, self.stem_damping());
        let (skin_k, skin_c, push_n) = match contact {
            Contact::On => (
                self.skin.stiffness_n_per_m,
                self.skin.damping_n_s_per_m,
                0.0,
            ),
            Contact::Off => {
                let preload_m = 1e-6 * self.skin.preload_um.unwrap_or(0.0);
                (0.0, 0.0, self.skin.stiffness_n_per_m * preload_m)
            }
        };
        let (leak, gain) = match drive {
            Drive::Follows => {
                let rate = 1.0 / self.amplifier.time_constant_s;
                (-rate, rate)
            }
            Drive::Slews => (0.0, 1.0),
        };
        let beam = [
            -(k + stem_k),
            -(c + stem_c),
            stem_k,
            stem_c,
            self.bimorph.force_n_per_v(),
        ];
        let pin = [stem_k, stem_c, -(stem_k + skin_k), -(stem_c + skin_c), 0.0];
        LinearSystem {
            a: [
                [0.0, 1.0, 0.0, 0.0, 0.0],
                beam.map(|force| force / beam_kg),
                [0.0, 0.0, 0.0, 1.0, 0.0],
                pin.map(|force| force / pin_kg),
                [0.0, 0.0, 0.0, 0.0, leak],
            ],
            b: [
                [0.0; 2],
                [0.0; 2],
                [0.0; 2],
                [0.0, push_n / pin_kg],
                [gain, 0.0],
            ],
        }
    }

    /// Displacement of the pin for a sine at the amplifier's input, µm/V, in closed form: skin on
    /// the pin, no limit reached.
    pub fn response_um_per_v(&self, frequency_hz: f64) -> Complex {
        let [_, pin] = self.beam_and_pin_um_per_v(frequency_hz);
        pin
    }

    /// The same of the beam's tip, and of the pin.
    pub(super) fn beam_and_pin_um_per_v(&self, frequency_hz: f64) -> [Complex; 2] {
        let omega = TAU * frequency_hz;
        let spring = |k: f64, c: f64, kg: f64| Complex::new(k - omega * omega * kg, omega * c);
        let stem = spring(self.stem_n_per_m, self.stem_damping(), 0.0);
        let skin = &self.skin;
        let pin = spring(
            skin.stiffness_n_per_m,
            skin.damping_n_s_per_m,
            self.pin_kg(),
        );
        let beam = spring(
            self.bimorph.stiffness_n_per_m(),
            self.beam_damping(),
            self.bimorph.mass_kg(),
        );
        let amplifier = Complex::new(1.0, omega * self.amplifier.time_constant_s);
        // Stem and pin in a row load the beam; of its way the pin gets stem / (stem + pin).
        let way = self.bimorph.force_n_per_v() / amplifier / (beam * (stem + pin) + stem * pin);
        [1e6 * way * (stem + pin), 1e6 * way * stem]
    }

    /// What the DAC's hold leaves of a sine: `sin(πf/8000) / (πf/8000)`, by which
    /// [`response_um_per_v`](Self::response_um_per_v) is multiplied for the line at `f`.
    pub fn hold_droop(frequency_hz: f64) -> f64 {
        let half_turn = PI * frequency_hz / f64::from(SAMPLES_PER_S);
        if half_turn == 0.0 {
            1.0
        } else {
            half_turn.sin() / half_turn
        }
    }

    /// The amplifier's steepest slope into this beam, V/s.
    pub(super) fn steepest_v_per_s(&self) -> f64 {
        self.amplifier
            .steepest_v_per_s(self.bimorph.capacitance_f())
    }

    /// Capacitance of the beam while it cannot move, F: what moving adds is in its speed.
    pub(super) fn held_capacitance_f(&self) -> f64 {
        let by_moving = 1e-6 * self.bimorph.force_n_per_v() * self.bimorph.free_um_per_v();
        self.bimorph.capacitance_f() - by_moving
    }

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
        let amplifier = 1.0 / Complex::new(1.0, omega * tau_s);
        let [beam, _] = self.beam_and_pin_um_per_v(frequency_hz);
        let charge = capacitance_f * amplifier + 1e-6 * self.bimorph.force_n_per_v() * beam;
        let carrier = 0.5 * (omega * droop * charge.norm()).powi(2);
        (capacitance_f.powi(2) * (slopes - smooth) + carrier).sqrt()
    }
}

/// An amplifier that follows its input until slope, current or rails say no.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplifier {
    /// Time constant of its pole, s.
    pub(crate) time_constant_s: f64,
    /// Steepest slope of its output, V/µs.
    pub slew_v_per_us: f64,
    /// Largest current into its load, mA: with a capacitance, another limit of the slope.
    pub(crate) current_limit_ma: f64,
}

impl Default for Amplifier {
    fn default() -> Self {
        Self {
            time_constant_s: 20e-6,
            slew_v_per_us: 2.2,
            current_limit_ma: 10.0,
        }
    }
}

impl Amplifier {
    /// The steepest slope into `capacitance_f` farads, V/s.
    pub(crate) fn steepest_v_per_s(&self, capacitance_f: f64) -> f64 {
        (1e6 * self.slew_v_per_us).min(1e-3 * self.current_limit_ma / capacitance_f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A contactor of the beam alone, with hardly a pin and a fast amplifier.
    fn bare(skin: Skin) -> ContactorModel {
        ContactorModel {
            pin_mg: 1e-6,
            stem_n_per_m: 1e9,
            skin,
            amplifier: Amplifier {
                time_constant_s: 1e-12,
                ..Amplifier::default()
            },
            ..ContactorModel::default()
        }
    }

    #[test]
    fn loads_give_the_printed_gains() {
        let rows = [
            (Skin::FREE, [0.90, 1.94]),
            (Skin::LIGHT, [0.55, 0.78]),
            (Skin::bonded(500.0, 0.2), [0.35, 0.37]),
            (Skin::FIRM, [0.21, 0.18]),
        ];
        for (skin, printed) in rows {
            for (frequency_hz, printed) in [40.0, 320.0].into_iter().zip(printed) {
                let found = bare(skin).response_um_per_v(frequency_hz).norm();
                assert!(
                    (found - printed).abs() <= 0.005 + 1e-3,
                    "{skin} at {frequency_hz} Hz: {found}, printed {printed}"
                );
            }
        }
    }

    #[test]
    fn the_system_and_the_closed_form_respond_alike() {
        for skin in [Skin::FREE, Skin::LIGHT, Skin::FIRM, Skin::bonded(1e5, 0.0)] {
            for quality in [0.5, 40.0, ContactorModel::MAX_QUALITY] {
                let model = ContactorModel {
                    quality,
                    skin,
                    ..ContactorModel::default()
                };
                for frequency_hz in [0.0, 1.0, 40.0, 320.0, 435.0, 8000.0, 3e4] {
                    let states = model.system().response(TAU * frequency_hz).unwrap();
                    let (found, wanted) = (
                        1e6 * states[X_PIN][0],
                        model.response_um_per_v(frequency_hz),
                    );
                    assert!(
                        (found - wanted).norm() <= 1e-9 * wanted.norm(),
                        "{skin}, Q {quality}, {frequency_hz} Hz: {found}, not {wanted}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_model_that_is_no_contactor_is_refused() {
        for quality in [0.0, -1.0, 2000.0, f64::NAN] {
            let model = ContactorModel {
                quality,
                ..ContactorModel::default()
            };
            assert!(model.check().is_err(), "Q {quality}");
        }
        ContactorModel::default().check().unwrap();
    }
}
