//! A virtual KES surface tester: what its wire reads when it is drawn over a height map.
//!
//! The Kawabata tester (METHODS: KES-FB4) draws a steel wire of 0.5 mm diameter, 5 mm wide, over
//! the cloth at 1 mm/s and records its height. Here: along every track the surface is dilated by a
//! disc of the wire's radius (it cannot enter narrow valleys); the load is shared along the wire,
//! so it rides at the mean of the heights at which the tracks would let it rest; friction makes it
//! lag and lifts it on climbing flanks, which tells forward from reverse; an instrument adds noise.
//!
//! It knows nothing of what the surface is made of, and rounds nothing.

use selvedge_foundation::numerics::{Grid, Random};

/// A stylus of the virtual tester.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Radius of the wire, mm.
    pub radius_mm: f64,
    /// Width of the wire across the stroke, mm.
    pub width_mm: f64,
    /// Noise of the instrument, µm rms, white over the samples.
    pub noise_um: f64,
    /// Length over which the reading follows the surface, mm.
    pub lag_mm: f64,
    /// Lift on a flank that rises in travel, µm per µm/mm.
    pub climb_mm: f64,
}

impl Default for Probe {
    /// The tester's wire: radius 0.25 mm, 5 mm wide, 0.2 µm of noise, a small friction.
    fn default() -> Self {
        Self {
            radius_mm: 0.25,
            width_mm: 5.0,
            noise_um: 0.2,
            lag_mm: 0.006,
            climb_mm: 0.003,
        }
    }
}

impl Probe {
    /// The tester's wire without friction or noise: geometry alone.
    pub fn ideal() -> Self {
        Self {
            noise_um: 0.0,
            lag_mm: 0.0,
            climb_mm: 0.0,
            ..Self::default()
        }
    }

    /// A wire as wide as a contactor, without friction or noise: what areal spectra are read with.
    /// Each point stands for its own millimetre.
    pub fn contactor() -> Self {
        Self {
            width_mm: 1.0,
            ..Self::ideal()
        }
    }

    /// Samples that a stroke needs beyond either of its ends, `step_mm` apart: where the disc may
    /// touch.
    pub fn margin_samples(&self, step_mm: f64) -> usize {
        offsets(self.radius_mm, step_mm).len() - 1
    }

    /// Height of the wire over a strip, µm. `heights_um`: a row for every track across the wire,
    /// columns `step_mm` apart along the stroke. The answer is shorter than the strip by
    /// [`Probe::margin_samples`] at both ends; empty if nothing is left.
    ///
    /// Along a track `d(x) = max_{|s| ≤ r} (h(x + s) + √(r² − s²) − r)`; over tracks the mean.
    pub fn lift_um(&self, heights_um: &Grid<f64>, step_mm: f64) -> Vec<f64> {
        let drops = offsets(self.radius_mm, step_mm);
        let margin = drops.len() - 1;
        let n = heights_um.width().saturating_sub(2 * margin);
        if n == 0 {
            return Vec::new();
        }
        let mut lift = vec![0.0; n];
        let mut rest = vec![0.0; n];
        for row in 0..heights_um.height() {
            rest_um(heights_um.row(row), &drops, &mut rest);
            for (sum, height) in lift.iter_mut().zip(&rest) {
                *sum += height;
            }
        }
        let scale = 1.0 / heights_um.height().max(1) as f64;
        for sum in &mut lift {
            *sum *= scale;
        }
        lift
    }

    /// What the tester records of a stroke over `lift_um` (samples `step_mm` apart, in forward
    /// order), µm, in travel order.
    pub fn stroke(
        &self,
        lift_um: &[f64],
        step_mm: f64,
        is_reverse: bool,
        random: &mut Random,
    ) -> Vec<f64> {
        let mut travelled = lift_um.to_vec();
        if is_reverse {
            travelled.reverse();
        }
        let follow = if self.lag_mm > 0.0 {
            1.0 - (-step_mm / self.lag_mm).exp()
        } else {
            1.0
        };
        let mut held = travelled.first().copied().unwrap_or(0.0);
        let mut before = held;
        for height in &mut travelled {
            let climb = self.climb_mm * ((*height - before) / step_mm).max(0.0);
            before = *height;
            held += follow * (*height + climb - held);
            *height = held + self.noise_um * random.normal();
        }
        travelled
    }
}

/// How far the wire's underside is above its lowest point at 0, 1, 2 … samples from it, µm.
fn offsets(radius_mm: f64, step_mm: f64) -> Vec<f64> {
    let rise = |k: u32| {
        let s = f64::from(k) * step_mm;
        (s <= radius_mm + 1e-12)
            .then(|| 1000.0 * (radius_mm - (radius_mm * radius_mm - s * s).max(0.0).sqrt()))
    };
    (0..).map_while(rise).collect()
}

/// Where a disc comes to rest over a track, µm, for every place that it has room around.
///
/// Offset by offset over the whole track, not place by place: neighbours are then worked on at
/// once, and which of the heights holds the disc does not depend on the order.
fn rest_um(track: &[f64], drops: &[f64], rest: &mut [f64]) {
    let middle = drops.len() - 1;
    rest.fill(f64::NEG_INFINITY);
    for shift in 0..=2 * middle {
        let drop = drops[shift.abs_diff(middle)];
        for (best, height) in rest.iter_mut().zip(&track[shift..]) {
            let candidate = height - drop;
            *best = if candidate > *best { candidate } else { *best };
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::surface::Profile;

    const STEP_MM: f64 = 1.0 / 230.0;

    /// The wire's heights over 20 mm of a surface that is the same on every track.
    fn over(probe: &Probe, height_um: impl Fn(f64) -> f64) -> Vec<f64> {
        let margin = probe.margin_samples(STEP_MM);
        let n = 4600 + 2 * margin;
        let track: Vec<f64> = (0..n)
            .map(|i| height_um((i as f64 - margin as f64) * STEP_MM))
            .collect();
        let tracks = Grid::from_rows(n, [track.clone(), track].concat()).unwrap();
        probe.lift_um(&tracks, STEP_MM)
    }

    /// Amplitude at a whole number of cycles in 20 mm.
    fn amplitude(heights_um: &[f64], per_mm: f64) -> f64 {
        let phase = |i: usize| TAU * per_mm * i as f64 * STEP_MM;
        let part = |f: fn(f64) -> f64| {
            heights_um
                .iter()
                .enumerate()
                .map(|(i, h)| h * f(phase(i)))
                .sum::<f64>()
        };
        2.0 * part(f64::sin).hypot(part(f64::cos)) / heights_um.len() as f64
    }

    #[test]
    fn a_gentle_sine_passes_unchanged() {
        // Curvature a(2πν)² of 0.32 and 3.2 per mm; the wire follows up to 1/r = 4 per mm.
        for (a_um, per_mm) in [(2.0, 2.0), (9.0, 3.0)] {
            let curvature = a_um / 1000.0 * (TAU * per_mm).powi(2);
            assert!(curvature < 4.0, "{curvature}");
            let lift = over(&Probe::ideal(), |x| a_um * (TAU * per_mm * x).sin());
            let highest = lift.iter().copied().fold(f64::MIN, f64::max);
            let lowest = lift.iter().copied().fold(f64::MAX, f64::min);
            assert!(
                (highest - lowest - 2.0 * a_um).abs() < 0.01 * a_um,
                "{highest} {lowest}"
            );
            if curvature < 0.4 {
                // The wire leans the flanks by ½ r slope²: a second harmonic, and no less of
                // the first to this order.
                let second = 0.25 * 250.0 * (a_um / 1000.0 * TAU * per_mm).powi(2);
                assert!(
                    (amplitude(&lift, 2.0 * per_mm) - second).abs() < 0.1 * second,
                    "{second}"
                );
                assert!(
                    (amplitude(&lift, per_mm) - a_um).abs() < 0.01 * a_um,
                    "{a_um}"
                );
                let smd = Profile::new(STEP_MM, lift).unwrap().smd_um();
                assert!((smd - 2.0 * a_um / PI).abs() < 0.01 * a_um, "{smd}");
            }
        }
    }

    #[test]
    fn a_steep_sine_loses_its_troughs() {
        let lift = over(&Probe::ideal(), |x| 30.0 * (TAU * 4.0 * x).cos());
        let lowest = lift.iter().copied().fold(f64::MAX, f64::min);
        // Crests 0.25 mm apart hold the wire; half-way it sags by less than r − √(r² − 0.125²).
        let sag = 250.0 - (250.0_f64.powi(2) - 125.0_f64.powi(2)).sqrt();
        assert!(
            lowest > 30.0 - sag - 1e-9 && lowest < 30.0 - 1.0,
            "{lowest}"
        );
    }

    #[test]
    fn a_narrow_slit_is_closed() {
        let lift = over(&Probe::ideal(), |x| {
            if (x - 10.0).abs() < 0.05 { -500.0 } else { 0.0 }
        });
        let lowest = lift.iter().copied().fold(f64::MAX, f64::min);
        let sag = 250.0 - (250.0_f64.powi(2) - 50.0_f64.powi(2)).sqrt();
        assert!(
            (lowest + sag).abs() < 0.6,
            "{lowest} where the wire sags by {sag}"
        );
        assert_eq!(lift[0], 0.0);
    }

    #[test]
    fn the_load_is_shared_over_the_tracks() {
        let margin = Probe::ideal().margin_samples(STEP_MM);
        let n = 2 * margin + 3;
        let mut tracks = Grid::filled(n, 4, 0.0);
        tracks.row_mut(1).fill(8.0);
        assert_eq!(Probe::ideal().lift_um(&tracks, STEP_MM), [2.0; 3]);
        assert!(
            Probe::ideal()
                .lift_um(&Grid::filled(5, 1, 0.0), STEP_MM)
                .is_empty()
        );
    }

    #[test]
    fn noise_is_as_strong_as_said_and_never_the_same_twice() {
        let probe = Probe::default();
        let mut random = Random::new(1);
        let flat = vec![0.0; 20_000];
        let first = probe.stroke(&flat, STEP_MM, false, &mut random);
        let second = probe.stroke(&flat, STEP_MM, false, &mut random);
        let rms = (first.iter().map(|h| h * h).sum::<f64>() / 20_000.0).sqrt();
        assert!((rms - 0.2).abs() < 0.005, "{rms}");
        assert_ne!(first, second);
    }

    #[test]
    fn reverse_is_travelled_backwards_and_friction_tells() {
        let saw = |x: f64| 20.0 * (x.fract() - 0.5).abs();
        let lift = over(&Probe::ideal(), saw);
        let mut random = Random::new(1);
        let backwards = Probe::ideal().stroke(&lift, STEP_MM, true, &mut random);
        assert!(
            backwards.iter().eq(lift.iter().rev()),
            "without friction only the order differs"
        );
        let probe = Probe {
            noise_um: 0.0,
            ..Probe::default()
        };
        let forward = probe.stroke(&lift, STEP_MM, false, &mut random);
        let mut reverse = probe.stroke(&lift, STEP_MM, true, &mut random);
        reverse.reverse();
        let apart = forward
            .iter()
            .zip(&reverse)
            .map(|(a, b)| (a - b).abs())
            .sum::<f64>()
            / 4600.0;
        assert!(apart > 0.05 && apart < 1.0, "mean difference {apart} µm");
    }
}
