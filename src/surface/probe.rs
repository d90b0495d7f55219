//! A virtual KES surface tester: what its wire reads when it is drawn over a height map.
//!
//! The Kawabata tester (METHODS: KES-FB4) draws a steel wire of 0.5 mm diameter, 5 mm wide, over
//! the cloth at 1 mm/s and records its height. Here: along every track the surface is dilated by a
//! disc of the wire's radius (it cannot enter narrow valleys); the load is shared along the wire,
//! so it rides at the mean of the heights at which the tracks would let it rest; friction makes it
//! lag and lifts it on climbing flanks, which tells forward from reverse; an instrument adds noise.
//!
//! It knows nothing of what the surface is made of, and rounds nothing.

use crate::numerics::{Grid, Random};

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
        let mut lift = vec![0.0; n];
        for row in 0..heights_um.height() {
            let track = heights_um.row(row);
            for (i, sum) in lift.iter_mut().enumerate() {
                *sum += rest_um(&track[i..=i + 2 * margin], &drops);
            }
        }
        let scale = 1.0 / heights_um.height().max(1) as f64;
        lift.iter_mut().for_each(|sum| *sum *= scale);
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

/// Where a disc centred over the middle of `track` comes to rest, µm.
fn rest_um(track: &[f64], drops: &[f64]) -> f64 {
    let middle = drops.len() - 1;
    let (left, right) = track.split_at(middle);
    let right = right.iter().zip(drops);
    let left = left.iter().rev().zip(&drops[1..]);
    let highest = |best: f64, (height, drop): (&f64, &f64)| best.max(height - drop);
    left.fold(right.fold(f64::NEG_INFINITY, highest), highest)
}
