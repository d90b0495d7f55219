//! A force split at the bandwidth of the device that gives it (Wall & Harwin 1999).
//!
//! Below, the device gives it; above, it is the drive of a vibrating end effector: a low-pass of
//! second order (Butterworth, by the bilinear transform) and what it leaves of the force. Both add
//! up to the force at every sample.

use std::f64::consts::{PI, SQRT_2};

/// A crossover of one force, sample by sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossover {
    forward: [f64; 3],
    back: [f64; 2],
    state: Option<[f64; 2]>,
}

impl Crossover {
    /// A crossover at a frequency, of samples at a rate, both Hz. At half the rate and above all is
    /// the device's; at 0 all is vibration.
    pub fn new(crossover_hz: f64, rate_hz: f64) -> Self {
        let turned = PI * (crossover_hz / rate_hz).max(0.0);
        if turned >= 0.5 * PI || turned == 0.0 {
            let slow = if turned > 0.0 { 1.0 } else { 0.0 };
            return Self {
                forward: [slow, 0.0, 0.0],
                back: [0.0; 2],
                state: None,
            };
        }
        let warped = turned.tan();
        let scale = 1.0 / (1.0 + SQRT_2 * warped + warped * warped);
        let gain = warped * warped * scale;
        Self {
            forward: [gain, 2.0 * gain, gain],
            back: [
                2.0 * (warped * warped - 1.0) * scale,
                (1.0 - SQRT_2 * warped + warped * warped) * scale,
            ],
            state: None,
        }
    }

    /// The device's part of a force and the vibration's, N. The first force is taken as one that
    /// has been there for long.
    pub fn split_n(&mut self, force_n: f64) -> [f64; 2] {
        let [b0, b1, b2] = self.forward;
        let [a1, a2] = self.back;
        let [first, second] = self.state.unwrap_or_else(|| {
            // Of a constant: what is left after b0.
            let second = (b2 - a2) * force_n;
            [(b1 - a1) * force_n + second, second]
        });
        let slow_n = b0 * force_n + first;
        self.state = Some([
            b1 * force_n - a1 * slow_n + second,
            b2 * force_n - a2 * slow_n,
        ]);
        [slow_n, force_n - slow_n]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Gains of both parts at a frequency, from a second of steady sine.
    fn gains(hz: f64) -> [f64; 2] {
        let mut crossover = Crossover::new(10.0, 1000.0);
        let mut peaks = [0.0_f64; 2];
        for nth in 0..20_000 {
            let force = (TAU * hz * f64::from(nth) / 1000.0).sin();
            let parts = crossover.split_n(force);
            assert!((parts[0] + parts[1] - force).abs() < 1e-12, "{nth}");
            if nth > 10_000 {
                peaks = [0, 1].map(|i| peaks[i].max(parts[i].abs()));
            }
        }
        peaks
    }

    #[test]
    fn half_the_power_is_the_devices_at_the_crossover_and_little_above() {
        assert!((gains(10.0)[0] - 0.5_f64.sqrt()).abs() < 1e-3);
        assert!(gains(100.0)[0] < 0.0101 && gains(1.0)[0] > 0.999);
        assert!(gains(1.0)[1] < 0.15 && gains(100.0)[1] > 0.95);
    }

    #[test]
    fn a_constant_force_is_the_devices_from_the_start() {
        let mut crossover = Crossover::new(10.0, 1000.0);
        for _ in 0..100 {
            let [slow, fast] = crossover.split_n(2.0);
            assert!((slow - 2.0).abs() < 1e-12 && fast.abs() < 1e-12);
        }
        let all_slow = Crossover::new(600.0, 1000.0).split_n(3.0);
        assert_eq!(all_slow, [3.0, 0.0]);
    }
}
