//! Friction on an electrovibration screen: the voltage that a finger feels a textile by.
//!
//! `V(s, t) = b f(s) Y(t)` (Cai et al. 2021, section 3.2): f is the coefficient of friction where
//! the finger is, b an amplification in V, Y a carrier. A square carrier goes from 0 to 1, a sine
//! from −½ to ½, so that b f is peak to peak for both. The screen pulls by the square of the
//! voltage: a sine is felt at twice its frequency, a square from 0 to 1 at its own.
//!
//! The current limit of such a screen (0.5 mA) is its hardware's; voltage and frequency are limited
//! here, in one place. Knows nothing of pictures or networks.

use std::f64::consts::TAU;

use selvedge_foundation::named;
use serde::{Deserialize, Serialize};

named! {
    /// The shape of the carrier.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Carrier {
        /// 1 for half a period, then 0: felt more strongly below 60 Hz.
        Square = "square",
        /// A sine.
        Sine = "sine",
    }
    /// Its name on the command line and in files.
    pub fn word;
}

/// How friction becomes a voltage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Electrovibration {
    /// Amplification b, V.
    pub amplification_v: f64,
    /// Frequency of the carrier, Hz.
    pub carrier_hz: f64,
    /// Its shape.
    pub carrier: Carrier,
}

impl Default for Electrovibration {
    /// A square that is felt as such, far from the limit on any cloth.
    fn default() -> Self {
        Self {
            amplification_v: 120.0,
            carrier_hz: 100.0,
            carrier: Carrier::Square,
        }
    }
}

/// A voltage at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Driven {
    /// The voltage, V.
    pub v: f64,
    /// Peak to peak, V.
    pub peak_to_peak_v: f64,
    /// Whether the limit took something away, or friction was none (negative, not a number).
    pub is_limited: bool,
}

impl Electrovibration {
    /// Frequencies that a carrier may have, Hz.
    pub const CARRIER_HZ: [f64; 2] = [10.0, 1000.0];
    /// The largest voltage, peak to peak, V.
    pub const MAX_V: f64 = 255.0;
    /// The largest amplification, V: four times what listeners chose at most.
    pub const MAX_AMPLIFICATION_V: f64 = 1000.0;
    /// What people chose for a fabric, with square carriers: Cai et al. (2021), table 3, means of
    /// twelve; by the authors' names, F seen in training, N unseen.
    pub const PRESETS: [(&str, Self); 8] = {
        const fn of(amplification_v: f64, carrier_hz: f64) -> Electrovibration {
            Electrovibration {
                amplification_v,
                carrier_hz,
                carrier: Carrier::Square,
            }
        }
        [
            ("velvet (F1)", of(216.25, 26.25)),
            ("chiffon (F5)", of(98.33, 45.42)),
            ("wool (F6)", of(133.33, 93.58)),
            ("linen (F9)", of(210.0, 120.83)),
            ("silk (F10)", of(150.83, 293.33)),
            ("fiber (N1)", of(110.42, 57.08)),
            ("wool (N2)", of(146.25, 85.83)),
            ("silk (N3)", of(131.67, 173.33)),
        ]
    };

    /// The same within the limits; what is no number is as at first.
    #[must_use]
    pub fn within_limits(self) -> Self {
        let or = |value: f64, first: f64| if value.is_nan() { first } else { value };
        let ([low, high], first) = (Self::CARRIER_HZ, Self::default());
        let amplification_v = or(self.amplification_v, first.amplification_v);
        Self {
            amplification_v: amplification_v.clamp(0.0, Self::MAX_AMPLIFICATION_V),
            carrier_hz: or(self.carrier_hz, first.carrier_hz).clamp(low, high),
            ..self
        }
    }

    /// The voltage at a time, s, where the coefficient of friction is `mu`, whatever stands here.
    pub fn driven(&self, mu: f64, t_s: f64) -> Driven {
        let within = self.within_limits();
        let wanted_v = within.amplification_v * mu;
        // Also what is not a number.
        let is_friction = mu >= 0.0 && wanted_v.is_finite();
        let peak_to_peak_v = if is_friction {
            wanted_v.min(Self::MAX_V)
        } else {
            0.0
        };
        let turn = (within.carrier_hz * t_s).rem_euclid(1.0);
        let carrier = match self.carrier {
            Carrier::Square if turn < 0.5 => 1.0,
            Carrier::Square => 0.0,
            Carrier::Sine => 0.5 * (TAU * turn).sin(),
        };
        Driven {
            v: if t_s.is_finite() {
                peak_to_peak_v * carrier
            } else {
                0.0
            },
            peak_to_peak_v,
            is_limited: !is_friction || wanted_v > Self::MAX_V,
        }
    }
}

/// Where voltages go: a screen's driver, or a simulated one.
pub trait VoltageSink {
    /// Takes a voltage, V, for a time, s. Voltages come in order, within
    /// ±[`Electrovibration::MAX_V`].
    fn hold(&mut self, v: f64, time_s: f64);
}

/// A simulated screen under a finger: two plates, of which the skin slides on one.
///
/// `F = ½ ε₀ A (V / g)²` with the gap `g = d₁/ε₁ + d₂ + d₃/ε₃` of insulator, air between the skin's
/// ridges and outer skin, and friction µ (N + F). Charge that leaks through the skin at low
/// frequencies is left out. The thicknesses are assumed: 1 µm of glass film (ε 3.9), 3 µm of air,
/// 0.2 mm of moist skin (ε 1000); 100 V then pull by 0.37 N.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedScreen {
    /// How hard the finger presses, N.
    pub press_n: f64,
    /// Coefficient of friction of skin on the bare screen.
    pub bare_mu: f64,
    time_s: f64,
    /// Time, s, and friction, N, of everything held.
    felt: Vec<[f64; 2]>,
}

/// Area of contact, m².
const CONTACT_M2: f64 = 1e-4;
/// ε₀, F/m.
const VACUUM_F_PER_M: f64 = 8.854e-12;
/// Thickness over permittivity of the layers, m.
const GAP_M: f64 = 1e-6 / 3.9 + 3e-6 + 2e-4 / 1000.0;

impl SimulatedScreen {
    /// A finger that presses so hard.
    pub fn new(press_n: f64, bare_mu: f64) -> Self {
        Self {
            press_n,
            bare_mu,
            time_s: 0.0,
            felt: Vec::new(),
        }
    }

    /// By how much the screen pulls at a voltage, N.
    pub fn pull_n(v: f64) -> f64 {
        0.5 * VACUUM_F_PER_M * CONTACT_M2 * (v / GAP_M).powi(2)
    }

    /// Time, s, and friction, N, of everything held so far.
    pub fn felt(&self) -> &[[f64; 2]] {
        &self.felt
    }
}

impl VoltageSink for SimulatedScreen {
    fn hold(&mut self, v: f64, time_s: f64) {
        let friction_n = self.bare_mu * (self.press_n + Self::pull_n(v));
        self.felt.push([self.time_s, friction_n]);
        self.time_s += time_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::RealTransform;

    fn wave(carrier: Carrier) -> Electrovibration {
        Electrovibration {
            carrier,
            ..Electrovibration::default()
        }
    }

    #[test]
    fn a_voltage_is_amplification_times_friction_times_carrier() {
        let square = wave(Carrier::Square);
        assert_eq!(square.driven(0.5, 0.0).v, 60.0);
        assert_eq!(square.driven(0.5, 0.006).v, 0.0);
        let sine = wave(Carrier::Sine);
        assert!((sine.driven(0.5, 0.0025).v - 30.0).abs() < 1e-9);
        assert!((sine.driven(0.5, 0.0075).v + 30.0).abs() < 1e-9);
        assert!(!sine.driven(0.5, 0.1).is_limited);
    }

    #[test]
    fn nothing_leaves_the_limits() {
        let loud = Electrovibration {
            amplification_v: 1e9,
            ..wave(Carrier::Square)
        };
        for (mu, v) in [(0.255, 255.0), (0.3, 255.0), (0.0, 0.0), (1e300, 255.0)] {
            let driven = loud.driven(mu, 0.0);
            assert_eq!((driven.v, driven.is_limited), (v, mu > 0.2551), "{mu}");
        }
        for mu in [f64::NAN, -0.1, f64::INFINITY] {
            let driven = loud.driven(mu, 0.0);
            assert_eq!((driven.v, driven.is_limited), (0.0, true), "{mu}");
        }
        assert_eq!(loud.driven(0.1, f64::NAN).v, 0.0);
        for (v, hz, within) in [
            (-1.0, 50.0, [0.0, 50.0]),
            (f64::NAN, 9.9, [120.0, 10.0]),
            (f64::INFINITY, f64::NAN, [1000.0, 100.0]),
            (1.0, 1000.1, [1.0, 1000.0]),
        ] {
            let asked = Electrovibration {
                amplification_v: v,
                carrier_hz: hz,
                ..loud
            };
            let found = asked.within_limits();
            assert_eq!([found.amplification_v, found.carrier_hz], within);
            assert_eq!(asked.driven(0.2, 0.001), found.driven(0.2, 0.001));
        }
        for (name, preset) in Electrovibration::PRESETS {
            assert_eq!(preset.within_limits(), preset, "{name}");
        }
    }

    #[test]
    fn a_sine_is_felt_at_twice_its_frequency_and_a_square_at_its_own() {
        for (carrier, hz) in [(Carrier::Sine, 200), (Carrier::Square, 100)] {
            let wave = wave(carrier);
            let mut screen = SimulatedScreen::new(1.0, 0.3);
            for sample in 0..10_000 {
                screen.hold(wave.driven(0.4, 1e-4 * f64::from(sample)).v, 1e-4);
            }
            let friction: Vec<f64> = screen.felt().iter().map(|[_, n]| n - 0.3).collect();
            let mean = friction.iter().sum::<f64>() / 10_000.0;
            let about: Vec<f64> = friction.iter().map(|n| n - mean).collect();
            let spectrum = RealTransform::new(10_000).forward(&about);
            let strongest = (0..spectrum.len())
                .max_by(|&a, &b| spectrum[a].norm().total_cmp(&spectrum[b].norm()));
            // A second of samples: bins are 1 Hz apart.
            assert_eq!(strongest, Some(hz), "{carrier:?}");
            assert!(mean > 0.0, "{mean}");
        }
        let pull_n = SimulatedScreen::pull_n(100.0);
        assert!((0.3..0.45).contains(&pull_n), "{pull_n}");
    }
}
