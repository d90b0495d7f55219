//! A parallel bimorph cantilever of PZT-5A: its stiffness, stroke, resonance and capacitance.
//!
//! Smits, Dalke & Cooney, "The constituent equations of piezoelectric bimorphs", Sensors and
//! Actuators A 28 (1991), the symmetric case of two layers. These are design-sheet values: glue,
//! electrodes and clamping take their share in a real one.

use std::f64::consts::TAU;

use super::within;
use crate::BridgeError;

/// Strain for a field, m/V.
const D31_M_PER_V: f64 = 171e-12;
/// Compliance, m²/N.
const S11_M2_PER_N: f64 = 16.4e-12;
/// Permittivity at constant stress, F/m.
const EPSILON_F_PER_M: f64 = 1700.0 * 8.854_187_812_8e-12;
/// Density, kg/m³.
const DENSITY_KG_PER_M3: f64 = 7750.0;
/// The first root of `cosh x · cos x = −1`.
const FIRST_MODE: f64 = 1.875_104_068_711_961;

/// The bare beam between its clamp and its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bimorph {
    /// Free length in mm.
    pub length_mm: f64,
    /// Width in mm.
    pub width_mm: f64,
    /// Thickness of both layers together in mm.
    pub thickness_mm: f64,
}

impl Default for Bimorph {
    fn default() -> Self {
        Self {
            length_mm: 25.0,
            width_mm: 1.5,
            thickness_mm: 0.6,
        }
    }
}

impl Bimorph {
    /// Refuses what is no beam: 1–200 mm long, 0.1–50 mm wide, 0.02–10 mm thick.
    pub fn check(&self) -> Result<(), BridgeError> {
        let ranges = [
            ("length", self.length_mm, [1.0, 200.0], " mm"),
            ("width", self.width_mm, [0.1, 50.0], " mm"),
            ("thickness", self.thickness_mm, [0.02, 10.0], " mm"),
        ];
        within("bimorph", &ranges)
    }

    /// Length, width and the thickness of one layer, m.
    fn metres(&self) -> [f64; 3] {
        [self.length_mm, self.width_mm, 0.5 * self.thickness_mm].map(|mm| 1e-3 * mm)
    }

    /// Force at the tip for its deflection, `2 w h³ / (s₁₁ L³)`, N/m.
    pub fn stiffness_n_per_m(&self) -> f64 {
        let [length, width, layer] = self.metres();
        2.0 * width * (layer / length).powi(3) / S11_M2_PER_N
    }

    /// Free deflection of the tip at rest, `3 d₃₁ L² / (4 h²)`, µm/V, both layers across the
    /// voltage.
    pub(crate) fn free_um_per_v(&self) -> f64 {
        let [length, _, layer] = self.metres();
        1e6 * 0.75 * D31_M_PER_V * (length / layer).powi(2)
    }

    /// Force of the held tip, N/V; also the charge for its deflection, C/m.
    pub(crate) fn force_n_per_v(&self) -> f64 {
        1e-6 * self.stiffness_n_per_m() * self.free_um_per_v()
    }

    /// Capacitance at constant stress, `2 ε₃₃ w L / h`, F.
    pub(crate) fn capacitance_f(&self) -> f64 {
        let [length, width, layer] = self.metres();
        2.0 * EPSILON_F_PER_M * width * length / layer
    }

    /// First resonance of the free beam, Hz.
    pub fn resonance_hz(&self) -> f64 {
        let [length, _, layer] = self.metres();
        let speed = (1.0 / (S11_M2_PER_N * DENSITY_KG_PER_M3)).sqrt();
        // √(EI/ρA) of a rectangle is its thickness over √12 times the speed of sound.
        let bending = 2.0 * layer / 12.0_f64.sqrt() * speed;
        FIRST_MODE.powi(2) * bending / (TAU * length * length)
    }

    /// The mass at the tip that has this stiffness and resonance, kg.
    pub fn mass_kg(&self) -> f64 {
        self.stiffness_n_per_m() / (TAU * self.resonance_hz()).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asserts that a value is what was printed, to half of the last digit.
    fn assert_printed(name: &str, value: f64, printed: f64, digit: f64) {
        assert!(
            (value - printed).abs() <= 0.5 * digit + 1e-12,
            "{name}: {value}, printed {printed}"
        );
    }

    #[test]
    fn four_geometries_have_the_printed_stiffness_stroke_resonance_and_capacitance() {
        let rows = [
            (
                [30.0, 2.0, 0.6],
                [244.0, 1.28, 64.0, 15.6, 302.0, 6.0, 0.61],
            ),
            (
                [25.0, 1.5, 0.6],
                [316.0, 0.89, 45.0, 14.1, 435.0, 3.8, 0.38],
            ),
            (
                [20.0, 1.5, 0.5],
                [357.0, 0.82, 41.0, 14.7, 566.0, 3.6, 0.36],
            ),
            (
                [32.0, 1.5, 0.7],
                [239.0, 1.07, 54.0, 12.8, 310.0, 4.1, 0.42],
            ),
        ];
        for ([length_mm, width_mm, thickness_mm], printed) in rows {
            let bimorph = Bimorph {
                length_mm,
                width_mm,
                thickness_mm,
            };
            bimorph.check().unwrap();
            let current_ma = 1e3 * TAU * 320.0 * 50.0 * bimorph.capacitance_f();
            let found = [
                ("N/m", bimorph.stiffness_n_per_m(), 1.0),
                ("µm/V", bimorph.free_um_per_v(), 0.01),
                ("free µm at 50 V", 50.0 * bimorph.free_um_per_v(), 1.0),
                ("blocked mN at 50 V", 5e4 * bimorph.force_n_per_v(), 0.1),
                ("Hz", bimorph.resonance_hz(), 1.0),
                ("nF", 1e9 * bimorph.capacitance_f(), 0.1),
                ("mA", current_ma, 0.01),
            ];
            for ((name, value, digit), printed) in found.into_iter().zip(printed) {
                assert_printed(name, value, printed, digit);
            }
        }
    }

    #[test]
    fn what_is_no_beam_is_refused() {
        for bad in [0.0, -25.0, f64::NAN, f64::INFINITY, 1e6] {
            let bimorph = Bimorph {
                length_mm: bad,
                ..Bimorph::default()
            };
            let error = bimorph.check().unwrap_err().to_string();
            assert!(
                error.contains("length") && error.contains("1 to 200 mm"),
                "{error}"
            );
        }
    }
}
