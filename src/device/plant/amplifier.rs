//! The high-voltage amplifier of a contactor: one pole, and the limits of its slope.

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
